#!/usr/bin/python3
"""Distractors: parts in the heap and on the table that images show and the ground truth does not list.

    distractors_test.py TOOL
"""
import json

import numpy as np
from PIL import Image

import data_set
from data_set import BAR, DataSetTest

PLAN = """seed: 6
scenes: 2
outputs: [json, png, bop, shards]
%(more)s
request:
  bin: {inner_size: [0.24, 0.2, 0.15], wall_thickness: 0.004}
  %(table)s
  solver: {type: bullet}
  parts:
    - {model: box.stl, count: 6, surface: {albedo: 0.4}}
    - {model: bar.stl, count: 5, %(poured)s}
    - {model: bar.stl, count: 4, %(lying)s}
  sensors:
    - {name: camera, width: 320, height: 240, fov: 0.8, pose: [0, 0, 0.6, 1, 0, 0, 0]}
    - {name: noisy, model: structured_light, width: 320, height: 240, fov: 0.8, pose: [0, 0, 0.6, 1, 0, 0, 0],
       projector: {baseline: 0.15, fov: 0.9}}
"""
USUAL = {"more": "", "table": "table: {height: -0.01, surface: {albedo: 0.3}, mottle: 0.3}", "poured": "distractor: true",
         "lying": "distractor: true, on_table: 0.1"}


class Distractors(DataSetTest):
    def plan_of(self, **changes):
        (self.folder / "plan.yaml").write_text(PLAN % {**USUAL, **changes})
        return "plan.yaml"

    def scene(self, out, index):
        return json.loads((self.folder / out / "scenes" / ("scene_%06d" % index) / "scene.json").read_text())

    def image(self, out, index, name):
        return np.asarray(Image.open(self.folder / out / "scenes" / ("scene_%06d" % index) / name)).astype(int)

    def test_they_are_seen_and_not_labelled(self):
        self.make(self.plan_of(), "set")
        compared = 0
        for index in (0, 1):
            scene = self.scene("set", index)
            parts = scene["parts"]
            self.assertEqual([p.get("distractor", False) for p in parts], 6 * [False] + 9 * [True])
            self.assertEqual([p["state"] for p in parts[11:]], 4 * ["fixed"])
            self.assertEqual([t["id"] for t in scene["sensors"][0]["truth"]], list(range(6)))
            self.assertTrue(all("camera" not in p["visible_fraction"] for p in parts[6:]))
            bop = self.folder / "set/bop/train" / ("%06d" % index)
            truth = json.loads((bop / "scene_gt.json").read_text())
            self.assertEqual([[e["id"] for e in image] for image in truth.values()], 2 * [list(range(6))])
            self.assertEqual({e["obj_id"] for e in truth["0"]}, {1})
            self.assertEqual(len(list((bop / "mask_visib").glob("000000_*.png"))), 6)
            labels, depth = self.image("set", index, "camera_truth_labels.png"), self.image("set", index, "camera_depth.png")
            self.assertTrue(set(np.unique(labels)) <= set(range(7)))
            self.assertGreater(depth.min(), 0)  # the table is behind all
            # On the table each is seen at its own place, unless the bin hides it.
            camera = scene["sensors"][0]
            for part in parts[11:]:
                x, y, z = part["pose"]["position"]
                distance = max(abs(x) - 0.124, abs(y) - 0.104)
                self.assertGreater(distance, 0)
                self.assertLess(distance, 0.1 + np.linalg.norm(BAR))
                self.assertLess(min(abs(z + 0.01 - side / 2) for side in BAR), 1e-6)  # it lies on a face
                depth_of_top = 0.6 - (z + z + 0.01)
                column = camera["K"][2] + camera["K"][0] * x / depth_of_top
                row = camera["K"][5] - camera["K"][4] * y / depth_of_top
                at_rim = (0.6 - 0.15) / depth_of_top
                if 2 < column < 317 and 2 < row < 237 and (abs(x) * at_rim > 0.13 or abs(y) * at_rim > 0.11):
                    compared += 1
                    pixel = round(row), round(column)
                    self.assertAlmostEqual(depth[pixel] * camera["depth_scale"], depth_of_top, delta=2e-4)
                    self.assertEqual(labels[pixel], 0)
        self.assertGreater(compared, 2)
        info = json.loads((self.folder / "set/bop/models/models_info.json").read_text())
        self.assertEqual(list(info), ["1"])
        self.run_tool("dataset", "verify", "set")

    def test_they_hide_what_is_below_them_and_the_audit_knows(self):
        self.make(self.plan_of(), "set")
        self.make(self.plan_of(poured="distractor: false", lying="on_table: 0.1"), "labelled")
        hidden = 0
        for index in (0, 1):
            own, other = self.scene("set", index), self.scene("labelled", index)
            self.assertEqual([p["pose"] for p in own["parts"]], [p["pose"] for p in other["parts"]])
            for name in ("camera_depth.png", "noisy_depth.png", "camera_truth_depth.png"):
                np.testing.assert_array_equal(self.image("set", index, name), self.image("labelled", index, name))
            labels, all_labels = (self.image(out, index, "camera_truth_labels.png") for out in ("set", "labelled"))
            np.testing.assert_array_equal(labels, np.where(all_labels > 6, 0, all_labels))
            self.assertEqual(own["sensors"][0]["truth"], other["sensors"][0]["truth"][:6])
            hidden += sum(t["px_count_all"] - t["px_count_visib"] for t in own["sensors"][0]["truth"])
        self.assertGreater(hidden, 300)
        done = self.run_tool("audit", "set", "--json", code=None)
        result = json.loads(done.stdout)
        self.assertEqual((result["exceeded"], result["faults"], result["parts"]), ([], [], 12), done.stdout)
        without = self.run_tool("audit", "set/bop", "--bin", "0.24,0.2,0.15", "--json", code=None)
        self.assertNotEqual(json.loads(without.stdout)["exceeded"], [], "their occlusion matters in this heap")

    def test_a_scene_file_suffices_to_make_the_surroundings_again(self):
        self.make(self.plan_of(), "set")
        for index in (0, 1):
            scene = self.scene("set", index)
            bin, table = scene["bin"], scene["table"]
            self.assertEqual((table["height"], table["surface"]["albedo"], table["mottle"]), (-0.01, 0.3, 0.3))
            camera = scene["sensors"][0]
            lines = [{"model": p["model"], "unit": scene["models"][p["line"]].get("unit", "m"), "count": 1, "fixed": True,
                      "poses": [p["pose"]["position"] + p["pose"]["orientation_xyzw"]]} for p in scene["parts"] if p["pose"]]
            request = {"seed": 1, "bin": {key: bin[key] for key in ("inner_size", "wall_thickness")}, "table": table,
                       "parts": lines, "sensors": [{"name": "camera", "width": camera["width"], "height": camera["height"],
                                                    "k": camera["K"], "pose": [0, 0, 0.6, 1, 0, 0, 0]}]}
            (self.folder / "again.yaml").write_text(json.dumps(request))
            self.run_tool("generate", "again.yaml", "--out", "again%d" % index, "--formats", "json,png")
            again = np.asarray(Image.open(self.folder / ("again%d/scene_000000/camera_depth.png" % index))).astype(int)
            np.testing.assert_array_equal(again, self.image("set", index, "camera_depth.png"))

    def test_amounts_are_of_the_others(self):
        self.make(self.plan_of(more="amount: {parts: 3}"), "set")
        lines = [p["line"] for p in self.scene("set", 0)["parts"]]
        self.assertEqual([lines.count(line) for line in range(3)], [3, 5, 4])

    def test_mistakes_are_named(self):
        for changes, text in (({"table": ""}, "needs a table"),
                              ({"table": "table: {mottle: 0.5}"}, "table.height"),
                              ({"table": "table: {height: 0.0}"}, "above the underside of the bin"),
                              ({"lying": "on_table: 0.1"}, "comes after distractors"),
                              ({"lying": "distractor: true, on_table: -1"}, "on_table")):
            self.assertIn(text, self.make(self.plan_of(**changes), "none", code=2).stderr)


if __name__ == "__main__":
    data_set.main()
