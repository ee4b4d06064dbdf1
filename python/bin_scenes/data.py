"""The reader of data sets, bin_scenes_data, under the name of this package; see there."""
from bin_scenes_data import Sample, Shards, read_png, read_tiff, run_lengths_to_mask

__all__ = ["Sample", "Shards", "read_png", "read_tiff", "run_lengths_to_mask"]
