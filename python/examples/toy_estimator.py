#!/usr/bin/python3
"""A toy estimator of poses on BOP scenes, and its score: ICP from the truth moved by a known amount.

    PYTHONPATH=python python/examples/toy_estimator.py DIR/bop --sensor scanner --out toy_mybins-test_pose.csv

Put an estimator of your own in place of `icp`. It reads depth, visible masks and intrinsics of each image of split `test`
and writes what bop_toolkit's eval_bop24_pose.py reads. The score printed is the share of targets (visible by 10 % and
more) whose MSSD - the largest distance between model points in estimated and true pose, by the best of the model's
symmetries - is below 5, 10, ... 50 % of the diameter, averaged. Needs numpy and Pillow.
"""
import argparse
import csv
import json
import pathlib

import numpy as np

from bin_scenes_data import read_png

POINTS = 400      # of the depth image, a part
SAMPLES = 3000    # of the model's surface
STEPS = 25
KEPT = 0.8        # share of the points with the smallest distances: the others lie on neighbours or are noise
LEAST = 30        # points; fewer do not determine a pose
SHARES = np.arange(0.05, 0.51, 0.05)  # of the diameter: thresholds of bop24


def load(path):
    return json.loads(path.read_text())


def read_ply(path):
    """Vertices (mm) and triangles of a binary PLY as bin_scenes writes it: x y z first, faces of three."""
    head, _, body = path.read_bytes().partition(b"end_header\n")
    lines = [line.split() for line in head.decode().splitlines()]
    counts = {line[1]: int(line[2]) for line in lines if line[0] == "element"}
    width = sum(line[:2] == ["property", "float"] for line in lines)
    vertices = np.frombuffer(body, "<f4", width * counts["vertex"]).reshape(-1, width)[:, :3]
    faces = np.frombuffer(body, np.dtype([("n", "u1"), ("v", "<i4", 3)]), counts["face"], 4 * width * counts["vertex"])
    return vertices.astype(float), faces["v"]


def rotation(axis, angle):
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


class Model:
    """Points and normals all over a surface, and the turns after which it looks the same (mm)."""

    def __init__(self, path, info, random):
        self.vertices, faces = read_ply(path)
        self.diameter, self.symmetries = info["diameter"], list(self.turns(info))
        a, b, c = (self.vertices[faces[:, i]] for i in range(3))
        across = np.cross(b - a, c - a)
        area = np.linalg.norm(across, axis=1)
        chosen = random.choice(len(faces), SAMPLES, p=area / area.sum())
        u, v = random.random((2, SAMPLES, 1))
        u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
        self.points = a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen]
        self.normals = across[chosen] / area[chosen, None]

    @staticmethod
    def turns(info):
        yield np.eye(3), np.zeros(3)
        for m in info.get("symmetries_discrete", []):
            m = np.array(m).reshape(4, 4)
            yield m[:3, :3], m[:3, 3]
        for axis in info.get("symmetries_continuous", []):
            for angle in np.linspace(0, 2 * np.pi, 64)[1:-1]:
                turn = rotation(axis["axis"], angle)
                yield turn, np.array(axis["offset"]) - turn @ axis["offset"]

    def mssd(self, a, b):
        """Largest distance of a vertex between poses a and b (rotation, translation in mm), by the best symmetry."""
        there = self.vertices @ a[0].T + a[1]
        return min(np.linalg.norm((self.vertices @ turn.T + shift) @ b[0].T + b[1] - there, axis=1).max()
                   for turn, shift in self.symmetries)


def points_of(depth, mask, k):
    """Measured points (mm) of a part in the camera's frame; depth in mm, 0 where nothing was measured."""
    rows, columns = (mask & (depth > 0)).nonzero()
    z = depth[rows, columns]
    return np.stack([(columns - k[0, 2]) / k[0, 0] * z, (rows - k[1, 2]) / k[1, 1] * z, z], 1)


def icp(points, model, pose):
    """Point-to-plane ICP of measured points against a model. Returns the pose and the mean distance left (mm)."""
    turn, shift = pose
    distance = np.inf
    for _ in range(STEPS):
        own = (points - shift) @ turn                      # in the model's frame
        seen = model.normals @ (turn.T @ -shift) > 0       # samples that look at the camera, roughly
        surface, normals = model.points[seen], model.normals[seen]
        if len(surface) < 6:
            break
        squared = (own ** 2).sum(1)[:, None] - 2 * own @ surface.T + (surface ** 2).sum(1)
        near = squared.argmin(1)
        off = ((own - surface[near]) * normals[near]).sum(1)
        kept = squared.min(1) <= np.quantile(squared.min(1), KEPT)
        distance = np.abs(off[kept]).mean()
        rows = np.hstack([np.cross(own[kept], normals[near[kept]]), normals[near[kept]]])
        step = np.linalg.lstsq(rows, off[kept], rcond=1e-6)[0]  # how the model turns and moves in its own frame
        angle = np.linalg.norm(step[:3])
        shift = shift + turn @ step[3:]
        if angle > 0:
            turn = turn @ rotation(step[:3] / angle, angle)
        if angle < 1e-5 and np.linalg.norm(step[3:]) < 1e-3:
            break
    return (turn, shift), distance


def moved(pose, move, turn, random):
    """A pose off by `move` (mm) and `turn` (degree) in random directions, about the part's own origin."""
    a, b = random.normal(size=(2, 3))
    return pose[0] @ rotation(a / np.linalg.norm(a), np.radians(turn)), pose[1] + move * b / np.linalg.norm(b)


def estimates(root, split, sensor, models, options, random):
    """Of each part with enough points: scene, image, entry of scene_gt, true pose, start, estimate, distance left."""
    suffix = "_" + sensor if sensor else ""
    for scene in sorted((root / split).iterdir()):
        truth, infos, cameras = (load(scene / (name + suffix + ".json")) for name in ("scene_gt", "scene_gt_info", "scene_camera"))
        for image, parts in truth.items():
            k = np.array(cameras[image]["cam_K"]).reshape(3, 3)
            name = "%06d" % int(image)
            depth = read_png((scene / ("depth" + suffix) / (name + ".png")).read_bytes()) * cameras[image]["depth_scale"]
            for entry, (part, info) in enumerate(zip(parts, infos[image])):
                pose = np.array(part["cam_R_m2c"]).reshape(3, 3), np.array(part["cam_t_m2c"])
                start = moved(pose, options.move, options.turn, random)
                mask = read_png((scene / ("mask_visib" + suffix) / ("%s_%06d.png" % (name, entry))).read_bytes()) > 0
                points = points_of(depth, mask, k)
                found, left = start, np.inf
                if len(points) >= LEAST:
                    chosen = random.choice(len(points), min(POINTS, len(points)), replace=False)
                    found, left = icp(points[chosen], models[part["obj_id"]], start)
                yield int(scene.name), int(image), part["obj_id"], info["visib_fract"], pose, start, found, left


def score(errors):
    """Mean over the thresholds of the share of targets below; errors as shares of the diameter."""
    return np.mean([(np.array(errors) < share).mean() for share in SHARES])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path, help="the folder bop of a data set")
    parser.add_argument("--split", default="test")
    parser.add_argument("--sensor", default="", help="of layout industrial")
    parser.add_argument("--move", type=float, default=10, help="mm between truth and start")
    parser.add_argument("--turn", type=float, default=10, help="degree between truth and start")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("toy_mybins-test_pose.csv"))
    options = parser.parse_args()

    splits = sorted(path.parent.parent.name for path in options.root.glob("*/*/scene_gt*.json") if "info" not in path.name)
    if options.split not in splits:
        parser.error("%s has no split '%s'; there are: %s" % (options.root, options.split, ", ".join(sorted(set(splits))) or "none"))
    random = np.random.default_rng(0)
    infos = load(options.root / "models/models_info.json")
    models = {int(key): Model(options.root / ("models_eval/obj_%06d.ply" % int(key)), info, random) for key, info in infos.items()}
    before, after = [], []
    with open(options.out, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["scene_id", "im_id", "obj_id", "score", "R", "t", "time"])
        for scene, image, object_id, visible, truth, start, found, left in estimates(
                options.root, options.split, options.sensor, models, options, random):
            rows.writerow([scene, image, object_id, "%.4f" % (1 / (1 + left)), " ".join("%.9g" % x for x in found[0].ravel()),
                           " ".join("%.6f" % x for x in found[1]), -1])
            if visible >= 0.1:
                model = models[object_id]
                before.append(model.mssd(truth, start) / model.diameter)
                after.append(model.mssd(truth, found) / model.diameter)
    if not after:
        raise SystemExit("no part of split '%s' is visible by 10 %%" % options.split)
    print("%d targets; MSSD of the start: median %.1f %% of the diameter, score %.3f; after ICP: median %.1f %%, score %.3f; %s" % (
        len(after), 100 * np.median(before), score(before), 100 * np.median(after), score(after), options.out))


if __name__ == "__main__":
    main()
