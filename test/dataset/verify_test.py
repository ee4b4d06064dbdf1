#!/usr/bin/python3
"""`bin_scenes dataset verify` finds each of many seeded corruptions by the invariant that it breaks, and nothing in a
sound data set.

    verify_test.py TOOL
"""
import fcntl
import json
import os
import pathlib
import re
import shutil
import sqlite3
import sys

import numpy as np

import data_set
from data_set import DataSetTest
from bin_scenes_data import read_png

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bop"))
from industrial_test import CORRUPTIONS as INDUSTRIAL  # noqa: E402

SCENE = "scenes/scene_000001/"
BOP = "bop/train/000001/"


def edit_json(path, change):
    value = json.loads(path.read_text())
    change(value)
    path.write_text(json.dumps(value))


def scene(change):
    return lambda root: edit_json(root / (SCENE + "scene.json"), change)


def bop(name, change):
    return lambda root: edit_json(root / (BOP + name + ".json"), lambda value: change(value["0"]))


def index(sql):
    def change(root):
        with sqlite3.connect(root / "index.sqlite") as database:
            database.execute(sql)
    return change


def flip(name, at=-20):
    def change(root):
        data = bytearray((root / name).read_bytes())
        data[at] ^= 1
        (root / name).write_bytes(data)
    return change


def replace(name, other):
    return lambda root: shutil.copy(root / other, root / name)


def cut(name):
    return lambda root: (root / name).write_bytes((root / name).read_bytes()[:20_000])


def put(name, text="x"):
    return lambda root: (root / name).write_text(text)


def remove(name):
    return lambda root: (root / name).unlink()


def swap_keys(root):
    edit_json(root / "shards/key_to_shard.json", lambda keys: keys.update({"000001_000000": 7}))


def rename_key(root):
    """An image gets the key of a scene that is not there. Its digits have the same sum, so that the tar stays whole."""
    path = root / "shards/shard-000000.tar"
    path.write_bytes(path.read_bytes().replace(b"000001_000001.", b"000010_000001."))


def change_in_shard(name, change):
    """Changes bytes of a file of image 000001_000000 in place: its length stays."""
    def corrupt(root):
        path = root / "shards/shard-000000.tar"
        offset, size = json.loads(path.with_suffix(".json").read_text())["000001_000000"][name]
        data = bytearray(path.read_bytes())
        text = data[offset:offset + size]
        change(text)
        data[offset:offset + size] = text
        path.write_bytes(data)
    return corrupt


def longer_run(text):
    """One pixel more in a run of a mask."""
    at = text.index(b'"counts":[') + 10
    text[at] = ord("8") if text[at] != ord("8") else ord("7")


def shifted_run(text):
    """A pixel more before the first run of ones and one less behind it: counts stay, places do not."""
    found = max(re.finditer(rb'"counts":\[(\d+),(\d+),(\d+)', text), key=lambda match: int(match[2]))
    for group, step in ((1, 1), (3, -1)):
        begin, end = found.span(group)
        changed = str(int(found[group]) + step).encode()
        assert len(changed) == end - begin
        text[begin:end] = changed


def flip_png(text):
    """A bit of the packed image, so that it no longer unpacks to the same."""
    text[len(text) // 2] ^= 1


def overlap(root):
    """A part is said to be visible where another one is: its mask becomes the union of both."""
    folder = root / BOP / "mask_visib"
    infos = json.loads((root / BOP / "scene_gt_info.json").read_text())["0"]
    first, second = [i for i, info in enumerate(infos) if info["px_count_visib"] > 20][:2]
    shutil.copy(folder / ("000000_%06d.png" % first), folder / ("000000_%06d.png" % second))


def visible_of(infos):
    return next(i for i, info in enumerate(infos) if info["px_count_visib"] > 20)


def set_info(key, value):
    def change(infos):
        info = infos[visible_of(infos)]
        info[key] = value(info[key]) if callable(value) else value
    return bop("scene_gt_info", change)


def more(number):
    return number + 3


CORRUPTIONS = [
    ("plan_unchanged", put("plan.yaml", "scenes: 9\n")),
    ("no_leftovers", put("scenes/.scene_000009.tmp-1-0@host")),
    ("heap_known", index("delete from heaps where heap = 1")),
    ("scene_there", lambda root: shutil.rmtree(root / SCENE)),
    ("scene_known", lambda root: shutil.copytree(root / SCENE, root / "scenes/scene_000007")),
    ("index_digest", index("update scenes set sha256 = '00' where scene = 1")),
    ("rejected_kept", index("insert into rejected values (1, 0, 'set_apart/scene_000001_attempt_0', '[]')")),
    ("scenes_differ", replace(SCENE + "scene.json", "scenes/scene_000000/scene.json")),
    ("manifest", put(SCENE + "files.json", "{")),
    ("file_there", remove(SCENE + "camera_depth.png")),
    ("file_size", put(SCENE + "camera.png", "short")),
    ("file_digest", flip(SCENE + "camera_labels.png")),
    ("file_listed", put(SCENE + "notes.txt")),
    ("scene_json", scene(lambda s: s.pop("report"))),
    ("scene_number", scene(lambda s: s.update(index=2))),
    ("request_there", remove(SCENE + "request.yaml")),
    ("scene_accepted", scene(lambda s: s["report"].update(accepted=False))),
    ("part_ids", scene(lambda s: s["parts"][1].update(id=0))),
    ("part_turn", scene(lambda s: s["parts"][0]["pose"].update(orientation_xyzw=[0, 0, 0.5, 0.5]))),
    ("part_place", scene(lambda s: s["parts"][0]["pose"].update(position=[3, 0, 0]))),
    ("fraction_range", scene(lambda s: s["parts"][0]["visible_fraction"].update(camera=1.2))),
    ("truth_counts", scene(lambda s: s["sensors"][0]["truth"][0].update(visible_fraction=0.123))),
    ("truth_boxes", scene(lambda s: s["sensors"][0]["truth"][0].update(bbox_visib=[90, 70, 20, 20]))),
    ("image_size", replace(SCENE + "camera_truth_labels.png", SCENE + "side_truth_labels.png")),
    ("label_range", replace(SCENE + "camera_truth_labels.png", SCENE + "camera_depth.png")),
    ("label_counts", replace(SCENE + "camera_truth_labels.png", "scenes/scene_000000/camera_truth_labels.png")),
    ("label_boxes", scene(lambda s: s["sensors"][0]["truth"][0].update(bbox_visib=[0, 0, 2, 2]))),
    ("depth_range", scene(lambda s: s["sensors"][0].update(far=0.1))),
    ("validity_codes", replace(SCENE + "camera_validity.png", BOP + "mask/000000_000000.png")),
    ("label_measured", replace(SCENE + "camera_labels.png", SCENE + "camera_depth.png")),
    ("bop_json", put(BOP + "scene_gt.json", "[")),
    ("bop_parts", bop("scene_gt", lambda gt: gt.pop())),
    ("bop_rotation", bop("scene_gt", lambda gt: gt[0].update(cam_R_m2c=[-x for x in gt[0]["cam_R_m2c"]]))),
    ("bop_pose", bop("scene_gt", lambda gt: gt[0].update(cam_t_m2c=[x + 1 for x in gt[0]["cam_t_m2c"]]))),
    ("bop_camera", lambda root: edit_json(root / (BOP + "scene_camera.json"), lambda cameras: cameras["0"].update(depth_scale=3))),
    ("bop_object", bop("scene_gt", lambda gt: gt[0].update(obj_id=77))),
    ("bop_image", remove(BOP + "depth/000000.png")),
    ("bop_mask_there", remove(BOP + "mask_visib/000000_000000.png")),
    ("bop_mask_count", set_info("px_count_visib", more)),
    ("bop_mask_box", set_info("bbox_visib", lambda box: [box[0] + 4] + box[1:])),
    ("bop_mask_inside", replace(BOP + "mask/000000_000000.png", BOP + "mask/000000_000001.png")),
    ("bop_fraction", set_info("visib_fract", 0.0123)),
    ("bop_unseen", set_info("bbox_visib", [-1, -1, -1, -1])),
    ("bop_reprojection", set_info("bbox_obj", lambda box: [box[0] + 9] + box[1:])),
    ("bop_root", put("bop/test_targets_bop24.json", "[]")),
    ("model_eval", remove("bop/models_eval/obj_000001.ply")),
    ("model_info", lambda root: edit_json(root / "bop/models/models_info.json", lambda m: m["1"].update(diameter=1.0))),
    ("shard_tar", cut("shards/shard-000000.tar")),
    ("shard_keys", swap_keys),
    ("shard_complete", rename_key),
    ("shard_offsets", put("shards/shard-000000.json", "{}")),
    ("shard_masks", change_in_shard("mask_visib.json", longer_run)),
    ("shard_size", lambda root: edit_json(root / "dataset.json", lambda facts: facts.update(shard_size=2))),
    ("shard_labels", change_in_shard("mask_visib.json", shifted_run)),
    ("shard_images", change_in_shard("truth_normal.png", flip_png)),
    ("bop_pinhole", scene(lambda s: s["sensors"][0].update(distortion=[0.1, 0, 0, 0, 0]))),
    ("bop_disjoint", overlap),
    ("bop_labels", replace(BOP + "mask_visib/000000_000000.png", BOP + "mask_visib/000000_000001.png")),
]


class Verify(DataSetTest):
    def test_each_corruption_is_found_by_the_invariant_that_it_breaks(self):
        self.make(self.plan(scenes=3), "sound")
        (self.folder / "sound" / SCENE / "view.html").write_text("as bin_scenes view makes it")
        done = self.run_tool("dataset", "verify", "sound")
        self.assertIn(" 0 findings", done.stdout)
        names = [line.split()[0] for line in self.run_tool("dataset", "verify", "--list").stdout.splitlines()]
        self.assertGreaterEqual(len(names), 30)
        for check, corrupt in CORRUPTIONS:
            with self.subTest(check=check):
                broken = self.folder / "broken"
                shutil.rmtree(broken, ignore_errors=True)
                shutil.copytree(self.folder / "sound", broken)
                corrupt(broken)
                found = self.run_tool("dataset", "verify", "broken", code=1).stdout
                self.assertIn("\n" + check + ": ", "\n" + found)
        others = {check for check, _ in INDUSTRIAL}
        self.assertEqual(sorted(set(names) - {check for check, _ in CORRUPTIONS} - others), [])

    def test_what_filters_took_away_has_codes(self):
        plan = self.plan(scenes=2, outputs="json, png, shards")
        text = (self.folder / plan).read_text()
        filters = "{outlier: {neighbours: 20}, reflection: {step: 0.0001}}"
        (self.folder / plan).write_text(
            text.replace("height: 72}", "height: 72, model: structured_light, filter: %s}" % filters))
        self.make(plan, "filtered")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "filtered").stdout)

    def test_boxes_of_a_camera_that_errs_are_those_of_its_masks(self):
        plan = self.plan(scenes=2, outputs="json, bop")
        text = (self.folder / plan).read_text()
        errs = "calibration: {rotation: 0.02, position: 0.002, focal: 1, center: 1}"
        (self.folder / plan).write_text(text.replace("height: 72}", "height: 72, model: structured_light, %s}" % errs))
        self.make(plan, "erring")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "erring").stdout)
        boxes = 0
        for scene in (self.folder / "erring/bop/train").iterdir():
            for i, info in enumerate(json.loads((scene / "scene_gt_info.json").read_text())["0"]):
                rows, columns = np.nonzero(read_png((scene / ("mask/000000_%06d.png" % i)).read_bytes()))
                mask = [columns.min(), rows.min(), np.ptp(columns), np.ptp(rows)]
                if 0 < mask[0] and mask[0] + mask[2] < 95 and 0 < mask[1] and mask[1] + mask[3] < 71 and info["px_count_visib"]:
                    self.assertEqual(info["bbox_obj"], mask)
                    boxes += 1
            truth = json.loads((self.folder / "erring/scenes" / ("scene_" + scene.name) / "scene.json").read_text())["sensors"][0]["truth"]
            for part in truth:
                if part["px_count_visib"]:
                    (x, y, w, h), (left, top, width, height) = part["bbox_visib"], part["bbox_obj"]
                    self.assertTrue(left <= x and top <= y and x + w <= left + width and y + h <= top + height, part)
        self.assertGreater(boxes, 3)

    def test_a_share_is_judged_by_what_belongs_to_it(self):
        plan = self.plan(scenes=4)
        self.make(plan, "share", "--shard", "1/2")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "share").stdout)
        (self.folder / "share/samples/000001/000001_000000.gt.json").write_text("[]")
        self.assertIn("file_size: share/samples/000001", self.run_tool("dataset", "verify", "share", code=1).stdout)
        self.make(plan, "share", "--shard", "0/2")
        shutil.rmtree(self.folder / "share/scenes/scene_000002")
        self.assertIn("scene_there: share/scenes/scene_000002", self.run_tool("dataset", "verify", "share", code=1).stdout)
        self.run_tool("dataset", "merge", "share", "--out", "merged", code=None)
        self.make(plan, "other", "--shard", "0/2")
        self.run_tool("dataset", "merge", "other", "--out", "half", code=1)
        self.assertIn("nothing is known of heap 1", self.run_tool("dataset", "verify", "half", code=1).stdout)

    def test_a_run_that_goes_on_is_told(self):
        self.make(self.plan(scenes=1, outputs="json"), "out")
        self.assertEqual(self.run_tool("dataset", "verify", "out").stderr, "")
        folder = os.open(self.folder / "out", os.O_RDONLY)
        self.addCleanup(os.close, folder)
        fcntl.flock(folder, fcntl.LOCK_EX)  # as a run has it
        self.assertIn("note: another process works in out", self.run_tool("dataset", "verify", "out").stderr)

    def test_what_is_no_data_set_is_refused(self):
        (self.folder / "empty").mkdir()
        self.assertIn("is no data set", self.run_tool("dataset", "verify", "empty", code=2).stderr)


if __name__ == "__main__":
    data_set.main()
