#!/usr/bin/python3
"""bin_scenes realism: images of one simulated sensor, saved in each format, are the real files of the same or of another
sensor; which figures are off, by what factor, and that the named keys exist."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image

TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
MODELS = pathlib.Path(__file__).resolve().parents[2] / "models"
REQUEST = """
seed: 3
scenes: 2
seconds: 0.3
bin: {inner_size: [0.24, 0.18, 0.06]}
parts: [{model: MODELS/bracket_l.stl, unit: mm, count: 6}]
sensors:
  - {name: other, model: ideal, width: 64, height: 48}
  - {name: camera, model: stereo, width: 200, height: 160, fov: 0.5, near: 0.2, far: 2, pose: [0, 0, 0.6, 1, 0, 0, 0],
     depth_unit: 0.001, stereo: {baseline: 0.05, disparities: 64, matcher: census, window: 9}}
"""


def call(*words, **options):
    return subprocess.run([TOOL, *words], capture_output=True, text=True, check=False, **options)


class Realism(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        cls.request = str(cls.path / "request.yaml")
        model = MODELS / "bracket_l.stl"
        pathlib.Path(cls.request).write_text(REQUEST.replace("MODELS/bracket_l.stl", str(model)), encoding="utf-8")
        run = call("generate", cls.request, "--out", str(cls.path / "real"), "--formats", "json,png,pcd,ply")
        assert run.returncode in (0, 1), run.stderr
        cls.scenes = [cls.path / "real" / ("scene_00000%d" % i) for i in (0, 1)]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def compare(self, files, *words):
        run = call("realism", *map(str, files), "--request", self.request, "--sensor", "camera", "--json", *words)
        self.assertIn(run.returncode, (0,), run.stderr)
        return {row["figure"]: row for row in json.loads(run.stdout)["figures"]}

    def check_like_itself(self, files, *words):
        figures = self.compare(files, *words)
        self.assertEqual(len(figures), 13)
        for row in figures.values():
            if row["factor"] is not None:
                self.assertAlmostEqual(row["factor"], 1, delta=0.05, msg=str(row))
                self.assertFalse(row["off"], str(row))
        self.assertIsNotNone(figures["second_difference"]["factor"])

    def test_a_camera_is_like_itself_in_each_format(self):
        scale = json.loads((self.scenes[0] / "scene.json").read_text(encoding="utf-8"))["sensors"][1]["depth_scale"]
        self.check_like_itself([s / "camera_depth.png" for s in self.scenes], "--scale", str(scale))
        self.check_like_itself([s / "camera.pcd" for s in self.scenes])
        self.check_like_itself([s / "camera.ply" for s in self.scenes])

    def test_what_differs_is_named_with_its_factor_and_keys(self):
        figures = self.compare([s / "camera.pcd" for s in self.scenes], "--set", "sensors[1].depth_unit=0.004", "--unit", "0")
        row = figures["second_difference"]
        self.assertTrue(row["off"])
        self.assertGreater(row["factor"], 1.5)
        self.assertIn("depth_unit", row["keys"])
        reference = call("reference").stdout
        for named in figures.values():
            for key in named["keys"]:
                self.assertIn("| `%s` |" % key.split(".")[-1], reference, key)

    def test_the_table_for_people(self):
        run = call("realism", str(self.scenes[0] / "camera.pcd"), "--request", self.request, "--sensor", "camera")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("second_difference", run.stdout)
        self.assertRegex(run.stdout, r"\d+ of 13 figures are in the range")

    def test_mistakes(self):
        cloud = str(self.scenes[0] / "camera.pcd")
        broken = self.path / "broken.ply"
        broken.write_text("no cloud", encoding="ascii")
        for words, message in ((["nothing.ply", "--request", self.request], "nothing.ply"),
                               ([cloud, "--request", str(self.path / "none.yaml")], "none.yaml"),
                               ([cloud, "--request", self.request, "--sensor", "camra"], "camra"),
                               ([str(broken), "--request", self.request, "--sensor", "camera"], "broken.ply")):
            run = call("realism", *words)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn(message, run.stderr)
        self.assertEqual(call("realism", cloud).returncode, 2)

    def test_no_folder_stays_behind(self):
        with tempfile.TemporaryDirectory() as folder:
            run = call("realism", str(self.scenes[0] / "camera.pcd"), "--request", self.request, "--sensor", "camera",
                       env={**os.environ, "TMPDIR": folder})
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual([p for p in os.listdir(folder) if "realism" in p], [])

    def test_points_that_are_nan_are_missing(self):
        depth = np.array(Image.open(self.scenes[0] / "camera_depth.png"))
        self.assertGreater((depth == 0).sum(), 100, "the images above have missing pixels")


if __name__ == "__main__":
    unittest.main()
