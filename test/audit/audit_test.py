#!/usr/bin/python3
"""`bin_scenes audit` on scenes with known faults, on a set of this project, and on what is no BOP data set.

    audit_test.py TOOL
"""
import json
import pathlib
import shutil
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
import data_set  # noqa: E402
from data_set import DataSetTest

CUBE = 40.0  # mm
CAMERA = {"cam_K": [100, 0, 47.5, 0, 100, 35.5, 0, 0, 1], "depth_scale": 0.1, "cam_R_w2c": [1, 0, 0, 0, -1, 0, 0, 0, -1],
          "cam_t_w2c": [0, 0, 600]}  # 600 mm above the floor, looking down


def cube_ply(path, edge=CUBE):
    corners = [[(2 * (i >> axis & 1) - 1) * edge / 2 for axis in range(3)] for i in range(8)]
    faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2),
             (1, 3, 7), (1, 7, 5)]
    path.write_text("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 12\nproperty list uchar int vertex_indices\nend_header\n"
                    + "".join("%g %g %g\n" % tuple(c) for c in corners) + "".join("3 %d %d %d\n" % f for f in faces))


def turn_about_y(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


class Audit(DataSetTest):
    def scene(self, world, camera=CAMERA, info=None, number=0):
        """A scene of cubes at world positions (mm), or (position, rotation)."""
        root = self.folder / "bop"
        (root / "models").mkdir(parents=True, exist_ok=True)
        cube_ply(root / "models/obj_000001.ply")
        (root / "models/models_info.json").write_text(json.dumps({"1": {"diameter": CUBE * 3 ** 0.5}}))
        scene = root / ("test/%06d" % number)
        scene.mkdir(parents=True, exist_ok=True)
        entries = []
        turn, shift = np.array(CAMERA["cam_R_w2c"]).reshape(3, 3), np.array(CAMERA["cam_t_w2c"])
        for place in world:
            position, rotation = place if isinstance(place, tuple) else (place, np.eye(3))
            entries.append({"obj_id": 1, "cam_R_m2c": (turn @ rotation).ravel().tolist(),
                            "cam_t_m2c": (turn @ position + shift).tolist()})
        (scene / "scene_gt.json").write_text(json.dumps({"0": entries}))
        (scene / "scene_camera.json").write_text(json.dumps({"0": camera}))
        if info:
            (scene / "scene_gt_info.json").write_text(json.dumps({"0": info}))
        return scene

    def audit(self, *words, where="bop"):
        done = self.run_tool("audit", where, "--json", *words, code=None)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        told = json.loads(done.stdout)
        self.assertEqual(done.returncode, 1 if told["exceeded"] else 0)
        return told

    def measures(self, *words, where="bop"):
        return {(m["name"], m["unit"]): m for m in self.audit(*words, where=where)["measures"]}

    def refused(self, *texts, where="bop", words=()):
        done = self.run_tool("audit", where, *words, code=2)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in texts:
            self.assertIn(text, done.stderr)

    def test_overlap_free_fall_and_sinking_are_as_deep_as_they_were_made(self):
        self.scene([[0, 0, 20], [38, 0, 20],  # 2 mm into each other
                    [0, 100, 23],             # 3 mm above the floor
                    [0, -100, 19.5],          # 0.5 mm in it
                    [150, 100, -60]])         # below it
        for words, lies_in in ((("--bin", "0.5,0.4,0.2"), "a bin of 0.5 x 0.4 x 0.2 m"), (("--floor", "0"), "a table at z = 0 m")):
            told = self.audit(*words)
            self.assertIn(lies_in, told["lies_in"])
            self.assertEqual((told["parts"], told["escaped"]), (5, 1))
            by = {(m["name"], m["unit"]): m for m in told["measures"]}
            self.assertAlmostEqual(by["overlap with another part", "mm"]["max"], 2, places=3)
            self.assertAlmostEqual(by["overlap with another part", "mm"]["above"], 2 / 5)
            self.assertAlmostEqual(by["free fall", "mm"]["max"], 3, places=3)
            self.assertAlmostEqual(by["overlap with bin or table", "mm"]["max"], 0.5, places=3)
            self.assertAlmostEqual(by["drift in 0.5 s", "mm"]["max"], 3, delta=0.2)

    def test_a_heap_at_rest_stays_and_one_that_tips_turns(self):
        self.scene([[0, 0, 20], [0, 0, 60], [100, 0, 20]])
        by = self.measures()
        self.assertLess(by["drift in 0.5 s", "mm"]["max"], 0.1)
        self.assertLess(by["turn in 0.5 s", "degree"]["max"], 0.1)
        self.scene([([0, 0, 20 * 2 ** 0.5], turn_about_y(np.pi / 4 + 0.05)), [100, 0, 20]])  # on an edge
        self.assertGreater(self.measures("--floor", "0")["turn in 0.5 s", "degree"]["max"], 20)

    def test_table_and_bin_are_fitted(self):
        self.scene([[0, 0, 520], [60, 0, 520], [30, 0, 560]])
        for words in ((), ("--bin", "fitted")):
            by = self.measures(*words)
            self.assertLess(by["overlap with bin or table", "mm"]["max"], 0.01)
            self.assertLess(by["drift in 0.5 s", "mm"]["max"], 0.1)
        leaning = ([-12, 0, 20 * 2 ** 0.5 - 1], turn_about_y(0.6))  # its walls hold it
        self.scene([leaning, [60, 0, 20]])
        self.assertGreater(self.measures("--floor", "0")["turn in 0.5 s", "degree"]["max"], 3)

    def test_without_a_world_up_is_given(self):
        camera = {key: value for key, value in CAMERA.items() if "w2c" not in key}
        self.scene([[0, 0, 20], [0, 100, 20]], camera=camera)
        told = self.audit()
        self.assertFalse(told["world_stated"])
        self.assertLess(max(m["max"] for m in told["measures"]), 0.1)  # the camera looks straight down
        tipped = self.measures("--up", "0,-1,0")
        self.assertGreater(tipped["drift in 0.5 s", "mm"]["max"], 50)

    def test_views_of_one_heap_are_one_heap_and_their_disagreement_is_told(self):
        scene = self.scene([[0, 0, 20], [100, 0, 20]])
        truth = json.loads((scene / "scene_gt.json").read_text())
        camera = json.loads((scene / "scene_camera.json").read_text())
        truth["1"], camera["1"] = json.loads(json.dumps(truth["0"])), camera["0"]
        truth["1"][0]["cam_t_m2c"][0] += 0.5
        (scene / "scene_gt.json").write_text(json.dumps(truth))
        (scene / "scene_camera.json").write_text(json.dumps(camera))
        told = self.audit()
        self.assertEqual((told["heaps"], told["parts"]), (1, 2))
        by = {(m["name"], m["unit"]): m for m in told["measures"]}
        self.assertAlmostEqual(by["views disagree on a part's place", "mm"]["max"], 0.5, places=6)

    def test_own_set_is_clean_and_known_noise_shows(self):
        self.make(self.plan(scenes=3, outputs="json, bop"), "own")
        own = self.measures(where="own")
        self.assertLess(own["overlap with another part", "% of diagonal"]["max"], 1)
        self.assertLess(own["drift in 0.5 s", "% of diagonal"]["p95"], 1)
        self.assertLess(own["visible fraction stated, off from own", ""]["max"], 0.03)
        self.assertEqual(own["pixels of mask_visib stated, off from it", "%"]["max"], 0)
        shutil.copytree(self.folder / "own", self.folder / "noisy")
        random = np.random.default_rng(3)
        for path in (self.folder / "noisy/bop/train").glob("*/scene_gt.json"):
            truth = json.loads(path.read_text())
            for part in truth["0"]:
                axis, move = random.normal(size=(2, 3))
                axis *= np.radians(1) / np.linalg.norm(axis)
                skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
                turn = np.linalg.qr(np.eye(3) + skew)[0]
                turn *= np.sign(np.diag(turn))
                part["cam_R_m2c"] = (np.array(part["cam_R_m2c"]).reshape(3, 3) @ turn).ravel().tolist()
                part["cam_t_m2c"] = (np.array(part["cam_t_m2c"]) + 0.5 * move / np.linalg.norm(move)).tolist()
            truth["1"] = []
            path.write_text(json.dumps(truth))
        noisy = self.measures("--most", "1", where="noisy")
        deep = noisy["overlap with bin or table", "mm"]
        self.assertGreater(deep["max"], 0.1)
        self.assertLess(deep["max"], 3)
        self.assertGreater(noisy["drift in 0.5 s", "mm"]["p50"], 5 * own["drift in 0.5 s", "mm"]["p50"])

    def test_the_page_and_the_table_say_the_same(self):
        self.scene([[0, 0, 20], [38, 0, 20]])
        done = self.run_tool("audit", "bop", "--out", "audit.html", code=1)
        page = (self.folder / "audit.html").read_text()
        self.assertIn("overlap with another part", done.stdout)
        for text in ("overlap with another part", "100 %", "<svg", "1 heaps, 2 parts", "Worst parts"):
            self.assertIn(text, page)

    def test_what_is_no_bop_set_or_makes_no_sense_is_refused(self):
        (self.folder / "empty").mkdir()
        self.refused("no scene_gt.json", where="empty")
        scene = self.scene([[0, 0, 20], [100, 0, 20]])
        self.refused("expected x,y,z", "--bin", words=("--bin", "3"))
        self.refused("there are: (none)", words=("--sensor", "cam9"))
        truth = json.loads((scene / "scene_gt.json").read_text())

        def with_truth(change):
            changed = json.loads(json.dumps(truth))
            change(changed["0"][1])
            (scene / "scene_gt.json").write_text(json.dumps(changed))
        with_truth(lambda part: part.update(cam_R_m2c=[1, 0, 0, 0, 1, 0, 0, 0, -1]))
        self.refused("no rotation", "image 0, entry 1")
        with_truth(lambda part: part.update(cam_t_m2c=[x / 1000 for x in part["cam_t_m2c"]]))
        self.refused("not all in millimetres", "object 1, 69.3 mm across")
        with_truth(lambda part: part.update(obj_id=7))
        self.refused("does not describe object 7")
        with_truth(lambda part: part.pop("cam_t_m2c"))
        self.refused("is not as BOP has it", "cam_t_m2c")
        (scene / "scene_gt.json").write_text("[")
        self.refused("is no JSON map", "scene_gt.json")
        self.scene([[0, 0, 20], [100, 0, 20]])
        (self.folder / "bop/models/obj_000001.ply").unlink()
        self.refused("is missing", "obj_000001.ply")
        self.scene([[0, 0, 20], [100, 0, 20]])
        (scene / "scene_camera.json").unlink()
        self.refused("is missing", "scene_camera.json")
        shutil.move(self.folder / "bop/models", self.folder / "elsewhere")
        self.refused("no folder models", "--models")

    def test_masks_of_another_size_are_refused(self):
        self.make(self.plan(scenes=1, outputs="json, bop"), "own")
        masks = self.folder / "own/bop/train/000000/mask_visib"
        shutil.copy(masks / "000001_000000.png", masks / "000000_000001.png")
        self.refused("other masks are 96 x 72", "000000_000001.png", where="own")


if __name__ == "__main__":
    data_set.main()
