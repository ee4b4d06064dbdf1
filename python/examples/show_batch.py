#!/usr/bin/python3
"""Shows a batch of a data set as a training loop would see it; trains nothing.

    PYTHONPATH=python python/examples/show_batch.py DIR [--size 4] [--seed 0]
"""
import argparse

import numpy as np

from bin_scenes_data import Shards


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory")
    parser.add_argument("--size", type=int, default=4)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()

    shards = Shards(options.directory)
    chosen = np.random.default_rng(options.seed).choice(len(shards), min(options.size, len(shards)), replace=False)
    for number in chosen:
        sample = shards[int(number)]
        depth, masks = sample.depth, sample.masks()
        fractions = np.array([part["visib_fract"] for part in sample.info])
        print("%s: depth %d x %d, %.3f to %.3f m, %.0f %% measured; %d parts of objects %s, %d more than half visible" % (
            sample.key, depth.shape[1], depth.shape[0], np.nanmin(depth), np.nanmax(depth),
            100 * np.isfinite(depth).mean(), len(masks), sorted(set(sample.objects.tolist())), (fractions > 0.5).sum()))


if __name__ == "__main__":
    main()
