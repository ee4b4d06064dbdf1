#!/usr/bin/python3
"""Data sets with output `grasps`: files, shards, and bins that are emptied by their own grasps."""
import json

from data_set import DataSetTest, main

GRIPPERS = "  grippers: [cup_10mm, {name: two, stroke: 0.06}]\n  sensors:"


class Grasps(DataSetTest):
    def plan(self, grippers=GRIPPERS, **options):
        name = super().plan(**options)
        text = (self.folder / name).read_text()
        (self.folder / name).write_text(text.replace("  sensors:", grippers))
        return name

    def grasps(self, out, scene):
        return json.loads((self.folder / out / ("scenes/scene_%06d/grasps.json" % scene)).read_text())

    def scene(self, out, scene):
        return json.loads((self.folder / out / ("scenes/scene_%06d/scene.json" % scene)).read_text())

    def test_shards_hold_the_grasps_of_their_scene(self):
        from bin_scenes_data import Shards
        self.make(self.plan(scenes=2, outputs="json, shards, grasps"), "out")
        shards = Shards(self.folder / "out")
        self.assertEqual(len(shards), 4)  # two cameras
        for key in shards.keys:
            self.assertEqual(shards[key].grasps, self.grasps("out", int(key[:6])))
            self.assertIn("camera", shards[key].grasps["grasps"][0]["pose_in_camera"])
        self.run_tool("dataset", "verify", "out")

    def test_as_many_grasps_are_proved_as_the_plan_asks_for(self):
        from bin_scenes_data import Shards
        self.make(self.plan(GRIPPERS.replace("  sensors:", "  prove: 3\n  sensors:"), scenes=1, outputs="json, shards, grasps",
                            more="depletion: {steps: 1, take: {order: grasp}}"), "out")
        for scene in range(2):
            told = self.grasps("out", scene)["grasps"]
            proofs = [grasp["proof"] for grasp in told if "proof" in grasp]
            self.assertEqual(len(proofs), min(3, sum(grasp["free"] for grasp in told)))
            self.assertGreater(len(proofs), 0)
            best = max(grasp["score"] for grasp in told if grasp["free"])
            self.assertIn(best, [grasp["score"] for grasp in told if "proof" in grasp])
            for proof in proofs:
                self.assertEqual(proof["success"], proof["outcome"] == "lifted")
                self.assertLess(proof["slip"], 0.1)
        self.assertIn("proof", json.dumps(Shards(self.folder / "out")[0].grasps))

    def test_a_bin_is_emptied_by_its_own_grasps(self):
        more = "depletion: {steps: 3, take: {order: grasp}}"
        self.make(self.plan(scenes=1, outputs="json, grasps", more=more), "out")
        for step in range(3):
            told = self.grasps("out", step)
            free = {grasp["part"] for grasp in told["grasps"] if grasp["free"]}
            gone = [part["id"] for before, part in zip(self.scene("out", step)["parts"], self.scene("out", step + 1)["parts"])
                    if part["state"] == "removed" and before["state"] != "removed"]
            picked = [part for part in told["removal_order"] if part in free] or told["removal_order"]
            self.assertEqual(gone, picked[:1])

    def test_mistakes_are_told_before_anything_is_poured(self):
        for words, grippers, more in (("the request has no grippers", "  sensors:", ""),
                                      ("expected {order: grasp}", GRIPPERS, "depletion: {steps: 1, take: {order: height}}")):
            done = self.make(self.plan(grippers, outputs="json, grasps", more=more), "out", code=2)
            self.assertIn(words, done.stderr)
            self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    main()
