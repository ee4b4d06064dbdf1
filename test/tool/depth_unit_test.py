#!/usr/bin/python3
"""Depth in every file of a scene is a multiple of the sensor's depth_unit: PNG, BOP, PLY, PCD, ROS bag and MCAP; true
depth is not. Usage: depth_unit_test.py BIN_SCENES MODEL.stl"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

UNIT = 0.002
REQUEST = """seed: 3
bin: {inner_size: [0.28, 0.19, 0.06]}
parts: [{model: %s, unit: mm, count: 4}]
sensors:
  - {name: camera, model: stereo, width: 96, height: 64, depth_unit: %g, stereo: {disparity_step: 0}}
"""


def points(path, begin, fields):
    """z of a binary cloud whose header ends with the line `begin`."""
    content = path.read_bytes()
    at = content.index(begin) + len(begin)
    return np.frombuffer(content[at:], fields)["z"]


def ply(path):
    kinds = {"float": "<f4", "uint": "<u4", "ushort": "<u2", "uchar": "u1"}
    head = path.read_bytes().split(b"end_header")[0].decode().split("\n")
    fields = [line.split()[1:] for line in head if line.startswith("property")]
    return points(path, b"end_header\n", np.dtype([(name, kinds[kind]) for kind, name in fields]))


def pcd(path):
    head = {line.split()[0]: line.split()[1:] for line in path.read_bytes().split(b"DATA")[0].decode().split("\n") if line}
    kinds = [kind.lower() + size for kind, size in zip(head["TYPE"], head["SIZE"])]
    return points(path, b"DATA binary\n", np.dtype(list(zip(head["FIELDS"], ["<" + kind for kind in kinds]))))


def clouds_and_depths(path):
    """Depth of the topics of a bag, by their types."""
    import rosbag  # pylint: disable=import-outside-toplevel
    for topic, message, _ in rosbag.Bag(str(path)).read_messages():
        if topic.endswith("points"):
            kind = np.dtype({"names": [f.name for f in message.fields], "formats": ["<f4" if f.datatype == 7 else "<u2" for f in
                             message.fields], "offsets": [f.offset for f in message.fields], "itemsize": message.point_step})
            yield topic, np.frombuffer(message.data, kind)["z"]
        elif topic.endswith("depth/image_rect"):
            yield topic, np.frombuffer(message.data, "<f4")


def check(name, depth, multiple=True):
    depth = np.asarray(depth, float)
    depth = depth[np.isfinite(depth) & (depth != 0)]
    assert len(depth) > 1000, f"{name}: {len(depth)} depths"
    off = np.abs(depth / UNIT - np.round(depth / UNIT))
    assert (off < 1e-3).all() == multiple, f"{name}: {off.max()} of a unit from a multiple"


def main():
    tool, model = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        request = pathlib.Path(folder) / "request.yaml"
        request.write_text(REQUEST % (os.path.abspath(model), UNIT), encoding="utf-8")
        ros = subprocess.run([tool, "doctor"], capture_output=True, text=True, check=False).stdout.count("ROS") > 0
        formats = "json,png,pcd,ply,bop" + (",bag" if ros and "--no-ros" not in sys.argv else "")
        subprocess.run([tool, "generate", request, "--out", out, "--formats", formats], check=True, stdout=subprocess.DEVNULL)
        scene = out / "scene_000000"
        scale = json.loads((scene / "scene.json").read_text(encoding="utf-8"))["sensors"][0]["depth_scale"]
        check("camera_depth.png", np.array(Image.open(scene / "camera_depth.png")) * scale)
        check("camera_truth_depth.png", np.array(Image.open(scene / "camera_truth_depth.png")) * scale, multiple=False)
        bop = next(out.glob("bop/train/000000"))
        bop_scale = json.loads((bop / "scene_camera.json").read_text(encoding="utf-8"))["0"]["depth_scale"] / 1e3
        check("bop depth", np.array(Image.open(bop / "depth" / "000000.png")) * bop_scale)
        check("camera.ply", ply(scene / "camera.ply"))
        check("camera.pcd", pcd(scene / "camera.pcd"))
        if "bag" in formats:
            found = dict(clouds_and_depths(scene / "scene.bag"))
            assert len(found) == 2, found.keys()
            for topic, depth in found.items():
                check(topic, depth)
    print("depth is a multiple of its unit in", formats)


if __name__ == "__main__":
    main()
