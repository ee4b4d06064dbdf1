"""Samples of shards: tar files with an index that gives the place of each file."""
import collections
import functools
import json
import pathlib

import numpy as np

from .images import read_png, read_tiff


def run_lengths_to_mask(run_lengths):
    """COCO's uncompressed run lengths, column by column, zeros first, to a boolean image."""
    height, width = run_lengths["size"]
    values = np.arange(len(run_lengths["counts"])) % 2 == 1
    return np.repeat(values, run_lengths["counts"]).reshape(width, height).T


def matrices(poses):
    """(N, 4, 4) of poses as they stand in JSON."""
    poses = list(poses)
    made = np.tile(np.eye(4), (len(poses), 1, 1))
    for matrix, pose in zip(made, poses):
        x, y, z, w = pose["orientation_xyzw"]
        matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                          [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                          [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        matrix[:3, 3] = pose["position"]
    return made


class Sample:
    """One image with its truth."""

    def __init__(self, key, files, data, begin):
        self.key = key  #: "SCENE_IMAGE", six digits each
        self._files, self._data, self._begin = files, data, begin

    def raw(self, name):
        """Bytes of a file: depth.png, gray.tiff, rgb.png, camera.json, gt.json, gt_info.json, mask.json, mask_visib.json,
        snr.png, truth_labels.png, truth_normal.png, of pictures of 16 bits image.png, or of plans with output `grasps` grasps.json."""
        if name not in self._files:
            raise KeyError("image %s has no %s; there are %s" % (self.key, name, " ".join(sorted(self._files))))
        offset, size = self._files[name]
        return self._data[offset - self._begin:offset - self._begin + size]

    def _json(self, name):
        return json.loads(self.raw(name))

    @property
    def camera_matrix(self):
        """3 x 3, pixels."""
        return np.array(self._json("camera.json")["cam_K"]).reshape(3, 3)

    @property
    def depth(self):
        """m along the optical axis, float32; NaN where nothing was measured."""
        counts = read_png(self.raw("depth.png"))
        depth = counts.astype(np.float32) * np.float32(self._json("camera.json")["depth_scale"] / 1e3)
        depth[counts == 0] = np.nan
        return depth

    @property
    def gray(self):
        """Intensity, 8 bits."""
        return read_tiff(self.raw("gray.tiff"))

    @property
    def rgb(self):
        """(rows, columns, 3), 8 bits: of a sensor that takes colour images."""
        return read_png(self.raw("rgb.png"))

    @property
    def picture(self):
        """(rows, columns[, 3]): the counts of a sensor `image` as it gave them, uint16 of 16 bits; of others `gray`."""
        if "image.png" in self._files:
            return read_png(self.raw("image.png"))
        return self.rgb if "rgb.png" in self._files else self.gray

    def channel(self, name):
        """Counts of a channel by its name (see "Channels" of docs/use/outputs.md): (rows, columns[, 3]), uint8 or uint16."""
        return read_png(self.raw(name + ".png"))

    @property
    def snr(self):
        """Signal over the noise that the sensor's model predicts, float32, to 0.05; 0 where nothing was measured."""
        return self.channel("snr").astype(np.float32) / np.float32(10)

    @property
    def labels(self):
        """What is truly seen, measured or not: 0 background and bin, id + 1 a part; uint16."""
        return self.channel("truth_labels")

    @property
    def normals(self):
        """(rows, columns, 3), float32: true normals towards the camera, to 1/127; NaN where there is nothing."""
        counts = self.channel("truth_normal")
        normals = counts.astype(np.float32) / np.float32(127.5) - 1
        normals[~counts.any(-1)] = np.nan
        return normals

    @property
    def poses(self):
        """(parts, 4, 4): from the model's frame to the camera's, m."""
        truth = self._json("gt.json")
        poses = np.tile(np.eye(4), (len(truth), 1, 1))
        for pose, part in zip(poses, truth):
            pose[:3, :3] = np.array(part["cam_R_m2c"]).reshape(3, 3)
            pose[:3, 3] = np.array(part["cam_t_m2c"]) / 1e3
        return poses

    @property
    def objects(self):
        """Numbers of the models, one a part."""
        return np.array([part["obj_id"] for part in self._json("gt.json")], int)

    @property
    def ids(self):
        """Of the parts, as labels and scene.json have them."""
        return np.array([part["id"] for part in self._json("gt.json")], int)

    @property
    def info(self):
        """Boxes, counts of pixels and visible fraction, a dict a part: see BOP's scene_gt_info."""
        return self._json("gt_info.json")

    @property
    def grasps(self):
        """Grasps of the scene, a dict with the structure of grasps.json; poses in the bin and in each camera."""
        return self._json("grasps.json")

    @property
    def grasp_arrays(self):
        """The same as arrays, a row each: `pose` (N, 4, 4) in the bin (m), `part`, `gripper` (a row of
        grasps["grippers"]), `width` (m), `score`, `free`, `proved` (1: lifted, 0: failed, -1: not tried), and by name of
        a camera `in_camera` (N, 4, 4) and `visible` (N,), the share of the contact that it sees."""
        stored = self.grasps
        grasps, names = stored["grasps"], [gripper["name"] for gripper in stored["grippers"]]
        cameras = list(grasps[0]["pose_in_camera"]) if grasps else []
        column = lambda kind, value: np.array([value(grasp) for grasp in grasps], kind)
        made = {"pose": matrices(grasp["pose"] for grasp in grasps),
                "part": column(int, lambda g: g["part"]), "gripper": column(int, lambda g: names.index(g["gripper"])),
                "width": column(float, lambda g: g["width"]), "score": column(float, lambda g: g["score"]),
                "free": column(bool, lambda g: g["free"]),
                "proved": column(int, lambda g: g["proof"]["success"] if "proof" in g else -1),
                "in_camera": {name: matrices(g["pose_in_camera"][name] for g in grasps) for name in cameras},
                "visible": {name: column(float, lambda g: g["visible"][name]) for name in cameras}}
        if not grasps:  # then no camera is known: each name has empty arrays
            for name, shape in (("in_camera", (0, 4, 4)), ("visible", (0,))):
                made[name] = collections.defaultdict(functools.partial(np.zeros, shape))
        return made

    def masks(self, name="mask_visib"):
        """(parts, rows, columns), boolean: what is visible, or with `mask` the whole silhouettes."""
        masks = self._json(name + ".json")
        if not masks:  # an empty bin
            return np.zeros((0,) + self.labels.shape, bool)
        return np.stack([run_lengths_to_mask(masks[str(i)]) for i in range(len(masks))])


def split_of(facts, scene):
    """Name of the split that a scene belongs to; `facts`: the content of dataset.json. As in src/dataset/data_folder.cpp."""
    heap = scene // (facts["depletion_steps"] + 1)
    place, total = (heap * 0.6180339887498949) % 1.0, 0.0
    for name, share in facts["split"].items():
        total += share
        if place < total:
            return name
    return name


class Shards:
    """The shards of a data set, finished or in the making, or one of its splits."""

    def __init__(self, directory, split=None):
        self.directory = pathlib.Path(directory) / "shards"
        if not (self.directory / "key_to_shard.json").is_file():
            raise FileNotFoundError("%s has no key_to_shard.json: name a data set with output `shards` that has at least one" % self.directory)
        self._shard_of = json.loads((self.directory / "key_to_shard.json").read_text())
        if split is not None:
            facts = json.loads((pathlib.Path(directory) / "dataset.json").read_text())
            if split not in facts["split"]:
                raise ValueError("no split '%s': there are %s" % (split, ", ".join(facts["split"])))
            self._shard_of = {key: shard for key, shard in self._shard_of.items() if split_of(facts, int(key.split("_")[0])) == split}
        self.keys = sorted(self._shard_of)
        self._offsets = {}

    def __len__(self):
        return len(self.keys)

    def _path(self, shard):
        return self.directory / ("shard-%06d.tar" % shard)

    def _offsets_of(self, shard):
        if shard not in self._offsets:
            if len(self._offsets) >= 16:  # a million images have a thousand shards; a reader needs a few at a time
                self._offsets.clear()
            self._offsets[shard] = json.loads(self._path(shard).with_suffix(".json").read_text())
        return self._offsets[shard]

    @staticmethod
    def _read(file, key, files):
        begin = min(offset for offset, _ in files.values())
        end = max(offset + size for offset, size in files.values())
        file.seek(begin)
        return Sample(key, files, file.read(end - begin), begin)

    def __getitem__(self, which):
        """By number (negative ones count from the end) or key; raises IndexError or KeyError."""
        key = which if isinstance(which, str) else self.keys[which]
        shard = self._shard_of[key]
        with open(self._path(shard), "rb") as file:
            return self._read(file, key, self._offsets_of(shard)[key])

    def __iter__(self):
        for shard in sorted(set(self._shard_of.values())):
            with open(self._path(shard), "rb") as file:
                for key, files in self._offsets_of(shard).items():
                    if key in self._shard_of:
                        yield self._read(file, key, files)
