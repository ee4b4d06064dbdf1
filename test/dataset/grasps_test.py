#!/usr/bin/python3
"""Data sets with output `grasps`: files, shards, and bins that are emptied by their own grasps."""
import json
import pickle

import numpy as np

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

    def check_arrays(self, arrays, told):
        """Matrices against points turned by quaternions, one by one."""
        grasps, point = told["grasps"], np.array([0.01, 0.02, 0.03])
        self.assertEqual([told["grippers"][i]["name"] for i in arrays["gripper"]], [g["gripper"] for g in grasps])
        for name in ("part", "width", "score", "free"):
            np.testing.assert_array_equal(arrays[name], [g[name] for g in grasps])
        np.testing.assert_array_equal(arrays["proved"], -np.ones(len(grasps)))
        for camera in ("camera", "side"):
            np.testing.assert_array_equal(arrays["visible"][camera], [g["visible"][camera] for g in grasps])
        for i, grasp in enumerate(grasps):
            for matrix, pose in ((arrays["pose"][i], grasp["pose"]),
                                 (arrays["in_camera"]["side"][i], grasp["pose_in_camera"]["side"])):
                v, w = np.array(pose["orientation_xyzw"][:3]), pose["orientation_xyzw"][3]
                turned = point + 2 * np.cross(v, np.cross(v, point) + w * point) + pose["position"]
                np.testing.assert_allclose((matrix @ [*point, 1])[:3], turned, rtol=0, atol=1e-12)

    def test_shards_hold_the_grasps_of_their_scene(self):
        from bin_scenes_data import Shards
        self.make(self.plan(scenes=2, outputs="json, shards, grasps"), "out")
        shards = Shards(self.folder / "out")
        self.assertEqual(len(shards), 4)  # two cameras
        for key in shards.keys:
            told = self.grasps("out", int(key[:6]))
            self.assertEqual(shards[key].grasps, told)
            self.check_arrays(shards[key].grasp_arrays, told)
            self.assertIn("camera", shards[key].grasps["grasps"][0]["pose_in_camera"])
        self.run_tool("dataset", "verify", "out")

    def test_what_is_seen_of_a_contact_does_not_depend_on_the_calibration(self):
        seen = []
        for number, errors in enumerate(("{}", "{rotation: 0.02, position: 0.005}")):
            plan = self.plan(scenes=2, outputs="json, grasps")
            text = (self.folder / plan).read_text()
            sensor = "height: 72, model: structured_light, calibration: %s}" % errors
            (self.folder / plan).write_text(text.replace("height: 72}", sensor))
            self.make(plan, "out%d" % number)
            grasps = [g for scene in (0, 1) for g in self.grasps("out%d" % number, scene)["grasps"]]
            seen.append(np.mean([g["visible"]["camera"] for g in grasps]))
        self.assertGreater(seen[0], 0.1)
        self.assertLess(abs(seen[1] - seen[0]), 0.1 * seen[0])

    def test_arrays_of_a_bin_without_grasps_are_empty(self):
        from bin_scenes_data import Sample
        data = json.dumps({"grasps": [], "grippers": [{"name": "two"}]}).encode()
        arrays = pickle.loads(pickle.dumps(Sample("000000_000000", {"grasps.json": (0, len(data))}, data, 0).grasp_arrays))
        self.assertEqual([arrays["pose"].shape, arrays["in_camera"]["camera"].shape], [(0, 4, 4)] * 2)
        self.assertEqual([arrays["score"].shape, arrays["visible"]["camera"].shape], [(0,)] * 2)

    def test_grippers_tell_all_that_labels_depend_on(self):
        both = {"clearance": 0.002, "friction": 0.4, "tilt": 0.7, "most": 50, "force": 30.0, "stroke": 0.02}
        two, cup = {"name": "two", "pad_give": 1e-4, **both}, {"name": "cup", "type": "suction", "lip": 0.002, "stiffness": 150.0, **both}
        self.make(self.plan("  grippers: %s\n  sensors:" % json.dumps([two, cup]), scenes=1, outputs="json, grasps"), "out")
        for given, told in zip((two, cup), self.grasps("out", 0)["grippers"]):
            self.assertEqual({key: told.get(key) for key in given}, given)

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

    def test_graspnet_reads_the_free_grasps_of_two_fingers(self):
        """Columns of graspnetAPI's GraspGroup. Its gripper: x approaches, y closes, the fingers end at depth along x."""
        self.make(self.plan(scenes=1, outputs="json, grasps"), "out")
        told = self.grasps("out", 0)
        free = [grasp for grasp in told["grasps"] if grasp["free"] and grasp["gripper"] == "two"]
        self.assertGreater(len(free), 10)
        gripper = next(gripper for gripper in told["grippers"] if gripper["name"] == "two")
        for camera in ("camera", "side"):
            rows = np.load(self.folder / ("out/scenes/scene_000000/%s_grasps_two.npy" % camera))
            self.assertEqual((rows.shape, rows.dtype), ((len(free), 17), np.float32))
            for row, grasp in zip(rows, free):
                pose = grasp["pose_in_camera"][camera]
                x, y, z, w = pose["orientation_xyzw"]
                close = [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)]
                approach = [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)]
                rotation = np.column_stack([approach, close, np.cross(approach, close)])
                expected = [1.1 - grasp["friction"], min(gripper["stroke"], grasp["width"] + 2 * gripper["opening"]),
                            gripper["finger_width"], gripper["pad_length"] / 2, *rotation.ravel(), *pose["position"], grasp["part"]]
                np.testing.assert_allclose(row, expected, rtol=0, atol=1e-6)
                self.assertAlmostEqual(np.linalg.det(row[4:13].reshape(3, 3)), 1, 5)

    def test_cups_and_layers_are_maps_of_pixels(self):
        """Rows of suctionnetAPI's SuctionGroup; maps against poses and labels of the same scene."""
        from PIL import Image
        self.make(self.plan(scenes=1, outputs="json, png, grasps"), "out")
        told, folder = self.grasps("out", 0), self.folder / "out/scenes/scene_000000"
        free = [grasp for grasp in told["grasps"] if grasp["free"] and grasp["gripper"] == "cup_10mm"]
        self.assertGreater(len(free), 10)
        rows = np.load(folder / "side_grasps_cup_10mm.npy")
        self.assertEqual((rows.shape, rows.dtype), ((len(free), 8), np.float32))
        for row, grasp in zip(rows, free):
            pose = grasp["pose_in_camera"]["side"]
            x, y, z, w = pose["orientation_xyzw"]
            away = [-2 * (x * z + y * w), -2 * (y * z - x * w), -1 + 2 * (x * x + y * y)]
            np.testing.assert_allclose(row, [grasp["score"], *away, *pose["position"], grasp["part"]], rtol=0, atol=1e-6)
        labels, layers, cups = (np.array(Image.open(folder / ("side_%s.png" % name))) for name in ("truth_labels", "layers",
                                                                                                  "suction_cup_10mm"))
        for part in told["parts"]:
            expected = 1 if part["slight"] or str(part["id"]) not in told["blocked_by"] else 2 if part["overlap"]["share"] < 0.5 else 3
            self.assertEqual(set(layers[labels == part["id"] + 1]) - {expected}, set())
        self.assertEqual(set(layers[labels == 0]), {0})
        self.assertTrue((cups > 0).any())
        for part in {row for row in labels[cups > 0]}:  # scores of free grasps of the part that is seen
            scores = {round(65535 * grasp["score"]) for grasp in free if grasp["part"] == part - 1}
            self.assertEqual(set(cups[labels == part].tolist()) - scores - {0}, set())

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
