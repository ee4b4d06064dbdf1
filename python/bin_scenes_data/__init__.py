"""Reads data sets that `bin_scenes dataset` made with output `shards`. Needs numpy and Pillow.

    from bin_scenes_data import Shards
    shards = Shards("DIR")
    for sample in shards:                     # in the order of the files: as fast as the disk
        depth = sample.depth                  # m, NaN where nothing was measured
    sample = shards[17]                       # by number, or shards["000017_000000"] by key: one seek
    masks = sample.masks("mask_visib")        # one boolean image a part
    Shards("DIR", split="train")              # of a plan with `split`

Lengths are in m, poses those of the model in the camera's optical frame (x right, y down, z forward). A sample decodes
what is asked for, and nothing else.
"""
from .images import read_png, read_tiff
from .shards import Sample, Shards, run_lengths_to_mask

__all__ = ["Sample", "Shards", "read_png", "read_tiff", "run_lengths_to_mask"]
