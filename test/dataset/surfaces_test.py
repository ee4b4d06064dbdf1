#!/usr/bin/python3
"""A plan's key `surfaces`: parts of one line with surfaces of their own, in heaps that are otherwise the same.

    surfaces_test.py TOOL
"""
import json

import data_set
from data_set import DataSetTest

PLAN = """seed: 3
scenes: 3
outputs: [json, bop]
%s
request:
  bin: {inner_size: [0.24, 0.2, 0.15]}
  solver: {type: bullet}
  parts:
    - {model: box.stl, count: 7, surface: {albedo: 0.4}}
    - {model: bar.stl, count: 5}
  sensors: [{name: camera, width: 96, height: 72}]
draw:
  parts[0].surface.albedo: {uniform: [0.1, 0.9]}
  parts[0].surface.texture.scratches: {uniform: [0.0, 0.5]}
  parts[1].friction: {uniform: [0.3, 0.7]}
"""


class Surfaces(DataSetTest):
    def scenes(self, keys, out, *options):
        (self.folder / "plan.yaml").write_text(PLAN % keys)
        self.make("plan.yaml", out, *options)
        return [json.loads((self.folder / out / "scenes" / ("scene_%06d" % i) / "scene.json").read_text()) for i in range(3)]

    def lines(self, out, scene):
        """A scene's own request as flat text."""
        return (self.folder / out / "scenes" / ("scene_%06d" % scene) / "request.yaml").read_text()

    def test_parts_of_one_line_have_several_surfaces(self):
        one = self.scenes("", "one")
        many = self.scenes("surfaces: 4", "many")
        for index, (a, b) in enumerate(zip(one, many)):
            count = {}
            for name, scene in (("one", a), ("many", b)):
                count[name] = sorted(part["model"].rsplit("/", 1)[-1] for part in scene["parts"])
            self.assertEqual(count["one"], count["many"])
            albedos = [line.split("albedo:")[1].strip(" ,}").split(",")[0].split("}")[0]
                       for line in self.lines("many", index).splitlines() if "albedo:" in line]
            self.assertGreaterEqual(len(set(albedos)), 5, albedos)  # four kinds, and the bin's
            self.assertTrue(all(0.1 <= float(value) <= 0.9 for value in albedos), albedos)
            truth = json.loads((self.folder / "many/bop/train" / ("%06d" % index) / "scene_gt.json").read_text())["0"]
            self.assertEqual({part["obj_id"] for part in truth}, {1, 2})  # a model is one object, whatever its surfaces
        self.run_tool("dataset", "verify", "many")

    def test_surfaces_are_shared_by_amount_and_repeat(self):
        keys = "surfaces: 3\namount: {parts: 12, shares: [1, 2]}"
        for scene in self.scenes(keys, "two"):
            self.assertEqual(len(scene["parts"]), 12)
        self.scenes(keys, "three", "--workers", "2")
        self.assert_same("two", "three")

    def test_wrong_values_are_refused(self):
        for value in ("0", "101", "some"):
            (self.folder / "plan.yaml").write_text(PLAN % ("surfaces: " + value))
            self.assertIn("'surfaces'", self.make("plan.yaml", "set", code=2).stderr)


if __name__ == "__main__":
    data_set.main()
