#!/usr/bin/python3
"""Scenes for a training loop, made while it runs: an IterableDataset of PyTorch, which works without PyTorch, too.

    python3 python/examples/live_dataset.py config/conrods.yaml --scenes 8 [--prefetch 4] [--work 0.1]

The loop trains nothing: it sleeps --work seconds a scene, and says how long it waited for the next one. With PyTorch:

    loader = torch.utils.data.DataLoader(LiveScenes("config/conrods.yaml", 1000), batch_size=None, num_workers=2,
                                         multiprocessing_context="spawn")
"""
import argparse
import time

import numpy as np

import bin_scenes

try:
    from torch.utils.data import IterableDataset, get_worker_info
except ImportError:
    IterableDataset = object

    def get_worker_info():
        return None


class LiveScenes(IterableDataset):
    """Samples of scenes first to first + scenes - 1 of a request: depth (H, W) in m, 0 where nothing was measured; label
    (H, W), part id + 1; poses (N, 7) in the bin frame, and ids (N,). Each worker of a DataLoader makes a share of its own."""

    def __init__(self, request, scenes, first=0, sensor="camera", prefetch=4, **overrides):
        super().__init__()
        self.request, self.scenes, self.first, self.sensor = request, scenes, first, sensor
        self.prefetch, self.overrides = prefetch, overrides

    def __iter__(self):
        worker = get_worker_info()
        number, workers = (worker.id, worker.num_workers) if worker else (0, 1)
        begin, end = (self.scenes * i // workers for i in (number, number + 1))
        if begin == end:
            return
        with bin_scenes.Generator() as generator:  # here, in the worker's own process
            for scene in generator.generate(self.request, first=self.first + begin, scenes=end - begin,
                                            prefetch=self.prefetch, **self.overrides):
                if scene.accepted:
                    image = scene.images[self.sensor]
                    yield {"index": scene.index, "depth": np.nan_to_num(image.depth), "label": image.label.astype(np.int32),
                           "poses": scene.poses, "ids": scene.ids}

    def __len__(self):
        return self.scenes  # at most


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("request")
    parser.add_argument("--scenes", type=int, default=8)
    parser.add_argument("--prefetch", type=int, default=4)
    parser.add_argument("--work", type=float, default=0.1, help="s that the loop takes for a scene")
    options = parser.parse_args()

    asked = time.perf_counter()
    for sample in LiveScenes(options.request, options.scenes, prefetch=options.prefetch):
        waited = time.perf_counter() - asked
        print("scene %d: waited %.3f s; depth %s of %s, %.3f to %.3f m; %d parts, %d visible" % (
            sample["index"], waited, sample["depth"].dtype, sample["depth"].shape, sample["depth"][sample["depth"] > 0].min(),
            sample["depth"].max(), len(sample["ids"]), len(np.unique(sample["label"])) - 1))
        time.sleep(options.work)
        asked = time.perf_counter()


if __name__ == "__main__":
    main()
