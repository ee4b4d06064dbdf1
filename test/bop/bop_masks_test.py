#!/usr/bin/python3
"""Masks as run lengths hold what PNG files hold, and crowded images are reported and left out of the targets.

    bop_masks_test.py TOOL
"""
import json
import pathlib
import sys

import numpy as np
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
import data_set  # noqa: E402
from data_set import DataSetTest

try:
    from pycocotools import coco, mask as coco_mask
except ImportError:  # not packaged by Debian
    coco = coco_mask = None


def decoded(runs):
    """A mask from uncompressed COCO run lengths: column by column, the first run of zeros."""
    height, width = runs["size"]
    values = np.arange(len(runs["counts"])) % 2
    return np.repeat(values, runs["counts"]).reshape(width, height).T.astype(bool)


class BopMasks(DataSetTest):
    def read(self, *place):
        return json.loads(self.folder.joinpath(*place).read_text())

    def test_run_lengths_hold_the_same_masks_in_fewer_files(self):
        for layout in ("classic", "industrial"):
            with self.subTest(layout):
                self.make(self.plan(scenes=2, outputs="json, bop", more="bop: {layout: %s}" % layout), "png_" + layout)
                self.make(self.plan(scenes=2, outputs="json, bop", more="bop: {layout: %s, masks: rle}" % layout),
                          "rle_" + layout)
                self.run_tool("dataset", "verify", "rle_" + layout)
                png, rle = (self.folder / (kind + layout) / "bop/train" for kind in ("png_", "rle_"))
                self.assertEqual(list(rle.glob("*/mask*/*")), [])
                seen = 0
                for path in sorted(png.glob("*/mask*/*.png")):
                    kind, _, sensor = path.parent.name.replace("mask_visib", "mask-visib").partition("_")
                    kind, suffix = kind.replace("-", "_"), "_" + sensor if sensor else ""
                    image, entry = (str(int(number)) for number in path.stem.split("_"))
                    scene = rle / path.parent.parent.name
                    masks = json.loads((scene / ("scene_%s%s.json" % (kind, suffix))).read_text())
                    if entry not in masks[image]:  # PNG files that the classic layout stores under the id as well
                        continue
                    np.testing.assert_array_equal(decoded(masks[image][entry]), np.asarray(Image.open(path)) > 0)
                    seen += 1
                    if coco_mask:
                        height, width = masks[image][entry]["size"]
                        compressed = coco_mask.frPyObjects(masks[image][entry], height, width)
                        np.testing.assert_array_equal(coco_mask.decode(compressed) > 0, np.asarray(Image.open(path)) > 0)
                self.assertGreater(seen, 20)
                for path in rle.glob("*/scene_gt_coco*.json"):
                    content = json.loads(path.read_text())
                    for annotation in content["annotations"]:
                        self.assertEqual(decoded(annotation["segmentation"]).sum(), annotation["area"])
                    if coco:
                        data = coco.COCO(str(path))
                        for annotation in data.loadAnns(data.getAnnIds()):
                            self.assertEqual(data.annToMask(annotation).sum(), annotation["area"])
                self.assertEqual(len(list(rle.glob("*/scene_gt_coco*.json"))), 2 * (1 if layout == "classic" else 2))
                if layout == "classic":
                    self.assertLess(len(list(rle.rglob("*"))), 0.5 * len(list(png.rglob("*"))))

    def test_audit_and_verify_read_run_lengths(self):
        self.make(self.plan(scenes=2, outputs="json, bop", more="bop: {masks: rle}"), "set")
        measures = {m["key"]: m for m in json.loads(self.run_tool("audit", "set", "--json").stdout)["measures"]}
        self.assertEqual(measures["mask"]["max"], 0)
        self.assertGreater(measures["mask"]["count"], 5)
        path = self.folder / "set/bop/train/000000/scene_mask_visib.json"
        masks = json.loads(path.read_text())
        part = max(masks["0"], key=lambda entry: decoded(masks["0"][entry]).sum())
        lost = masks["0"].pop(part)
        path.write_text(json.dumps(masks))
        result = json.loads(self.run_tool("audit", "set", "--json", code=1).stdout)
        worst = result["worst_parts"][0]
        self.assertEqual((worst["image"], worst["entry"]), (0, int(part)))
        self.assertIn("its mask_visib is missing", worst["faults"][0])
        self.assertIn("bop_mask_there", self.run_tool("dataset", "verify", "set", code=1).stdout)
        if coco_mask:  # compressed run lengths are read as well
            height, width = lost["size"]
            compressed = coco_mask.frPyObjects(lost, height, width)
            masks["0"][part] = {"size": compressed["size"], "counts": compressed["counts"].decode()}
            path.write_text(json.dumps(masks))
            self.run_tool("audit", "set")

    def test_crowded_images_are_reported_and_left_out(self):
        for limit, left in ((None, 4), (5, None), (1, 0)):
            more = "split: {test: 1}" + ("\nbop: {most_targets: %d}" % limit if limit else "")
            out = "set_%s" % limit
            self.make(self.plan(scenes=2, outputs="json, bop", more=more), out)
            truth = {}
            for scene in (0, 1):
                folder = self.folder / out / "bop/test" / ("%06d" % scene)
                for image, info in json.loads((folder / "scene_gt_info.json").read_text()).items():
                    truth[scene, int(image)] = sum(part["visib_fract"] >= 0.1 for part in info)
            expected = {place for place, count in truth.items() if not limit or count <= limit}
            if left is not None:
                self.assertEqual(len(expected), left)
            for name in ("test_targets_bop19.json", "test_targets_bop24.json"):
                targets = self.read(out, "bop", name)
                self.assertEqual({(t["scene_id"], t["im_id"]) for t in targets}, expected)
            self.run_tool("dataset", "verify", out)
            self.assertEqual(self.run_tool("dataset", "toolkit", out, "--name", "mine").stderr, "")

    def test_more_parts_than_estimates_are_warned_of(self):
        (self.folder / "plan.yaml").write_text("""seed: 1
scenes: 1
outputs: [json, bop]
request:
  bin: {inner_size: [1.2, 1.0, 0.1]}
  solver: {type: bullet}
  parts: [{model: box.stl, count: 210}]
  sensors: [{name: camera, width: 320, height: 260}]
""")
        done = self.make("plan.yaml", "set")
        self.assertIn("a heap may have 210 parts, and bop_toolkit keeps 100 estimates an image", done.stderr)
        self.assertIn("1 of 1 target images have more than 100 visible parts, up to ", done.stderr)
        done = self.run_tool("dataset", "toolkit", "set", "--name", "mine")
        self.assertIn("bop_toolkit keeps 100 estimates", done.stderr)
        self.assertIn("bop: {most_targets: 100}", done.stderr)
        self.assertIn("more than 200 visible", self.run_tool("dataset", "toolkit", "set", "--name", "xyzibd").stderr)

    def test_wrong_values_are_refused(self):
        for more, text in (("bop: {masks: jpg}", "expected png or rle"), ("bop: {most_targets: 0}", "must be at least 1"),
                           ("bop: {most_targets: many}", "'bop.most_targets': expected"), ("bop: {mask: rle}", "masks, most_targets")):
            self.assertIn(text, self.make(self.plan(more=more), "set", code=2).stderr)


if __name__ == "__main__":
    data_set.main()
