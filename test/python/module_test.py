#!/usr/bin/python3
"""The Python module: the same bits as the command line, arrays without copies, heaps, bad input."""
import json
import os
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import unittest

from python_scenes import CONROD, NUT, PACKAGES, ROOT, TOOL, nuts

import numpy as np

import bin_scenes
from bin_scenes import Error, Generator

STEREO = {"name": "stereo", "model": "structured_light", "preset": "structured_light_0.7m_750mm", "width": 200, "height": 150}
TIMES = ("wall_s", "stages_ms", "counters")  # of the report, which two runs do not share


def without_times(text):
    scene = json.loads(text)
    for key in TIMES:
        del scene["report"][key]
    return json.dumps(scene)


class Bits(unittest.TestCase):
    """The same request by the command line and by the module."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="bin_scenes_python_")
        folder = pathlib.Path(cls.folder.name)
        cls.request = str(folder / "request.yaml")
        cls.keys = nuts(sensors=[{"name": "camera", "width": 160, "height": 120}, STEREO])
        pathlib.Path(cls.request).write_text(json.dumps(cls.keys))
        cls.out = folder / "out"
        done = subprocess.run([TOOL, "generate", cls.request, "--out", cls.out, "--scenes", "2", "--first", "5", "--set",
                               "parts[0].count=12", "--formats", "json,png,pcd"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        with Generator() as g:
            cls.scenes = list(g.generate(cls.request, scenes=2, first=5, parts__0__count=12, prefetch=1))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_scene_json_is_the_same_text(self):
        self.assertEqual([s.index for s in self.scenes], [5, 6])
        for scene in self.scenes:
            written = (self.out / ("scene_%06d/scene.json" % scene.index)).read_text()
            self.assertEqual(without_times(scene.json()), without_times(written))
            self.assertEqual(scene.json().count("\n"), written.count("\n"))

    def test_poses_have_the_same_bits(self):
        for scene in self.scenes:
            parts = json.loads((self.out / ("scene_%06d/scene.json" % scene.index)).read_text())["parts"]
            poses = np.array([p["pose"]["position"] + p["pose"]["orientation_xyzw"] for p in parts])
            self.assertEqual(scene.poses.shape, (12, 7))
            self.assertEqual(scene.poses.tobytes(), poses.tobytes())
            self.assertEqual(scene.ids.tolist(), [p["id"] for p in parts])
            self.assertEqual(scene.models, [p["model"] for p in parts])
            self.assertEqual(scene.states, [p["state"] for p in parts])

    def test_clouds_have_the_same_bytes(self):
        """A PCD holds all that a pixel has, unrounded: depth is z of its points."""
        point = np.dtype([("points", "<f4", 3), ("normals", "<f4", 3), ("intensity", "<f4"), ("label", "<u4"),
                          ("validity", "u1"), ("truth_normals", "<f4", 3), ("snr", "<f4")])
        for scene in self.scenes:
            for name, image in scene.images.items():
                pcd = (self.out / ("scene_%06d/%s.pcd" % (scene.index, name))).read_bytes()
                cloud = np.frombuffer(pcd.partition(b"DATA binary\n")[2], point).reshape(image.height, image.width)
                for field in point.names:
                    ours = getattr(image, field)
                    self.assertEqual(ours.astype(cloud[field].dtype).tobytes(), cloud[field].tobytes(), (name, field))
                self.assertEqual(image.depth.tobytes(), np.ascontiguousarray(cloud["points"][..., 2]).tobytes())
                self.assertTrue(0 < np.isfinite(image.depth).sum() <= image.depth.size)

    def test_truth_is_that_of_the_pictures(self):
        from PIL import Image
        for scene in self.scenes:
            for name, image in scene.images.items():
                base = str(self.out / ("scene_%06d" % scene.index) / name)
                counts = np.asarray(Image.open(base + "_truth_depth.png")).astype(float)
                seen = np.isfinite(image.truth_depth)
                self.assertTrue((seen == (counts > 0)).all())
                # half a count, and what a float of 32 bits rounds
                off = np.abs(image.truth_depth[seen] - counts[seen] * image.depth_scale)
                self.assertLess(off.max(), 0.5 * image.depth_scale + 1e-6)
                self.assertTrue((image.truth_label == np.asarray(Image.open(base + "_truth_labels.png"))).all())
                for channel in "depth truth_depth truth_normal labels truth_labels snr validity".split():
                    np.testing.assert_array_equal(image.channel(channel), np.asarray(Image.open(base + "_%s.png" % channel)))
                self.assertIsNone(image.channel("image"), "a range sensor takes no picture")
                with self.assertRaisesRegex(bin_scenes.Error, "truth_depth"):
                    image.channel("truth")

    def test_pictures_have_the_counts_of_the_files(self):
        from PIL import Image
        camera = {"model": "image", "width": 48, "height": 36}
        cameras = [{**camera, "name": "grey8", "image": {"samples": 1}},
                   {**camera, "name": "grey16", "image": {"samples": 1, "bits": 16}},
                   {**camera, "name": "colour", "image": {"samples": 1, "colour": True}}]
        keys = nuts(3, sensors=[*cameras, {"name": "camera", "width": 48, "height": 36}])
        keys["parts"][0]["surface"] = {"colour": [1, 0.5, 0.2]}
        with tempfile.TemporaryDirectory() as folder, Generator() as g:
            request = pathlib.Path(folder) / "request.yaml"
            request.write_text(json.dumps(keys))
            subprocess.run([TOOL, "generate", request, "--out", folder, "--formats", "png"], check=True, capture_output=True)
            images = next(g.generate(keys)).images
            for name, kind, shape in (("grey8", "u1", (36, 48)), ("grey16", "u2", (36, 48)), ("colour", "u1", (36, 48, 3))):
                picture = images[name].picture
                self.assertEqual((picture.dtype, picture.shape), (np.dtype(kind), shape), name)
                self.assertFalse(picture.flags.owndata, name)
                written = np.asarray(Image.open(pathlib.Path(folder) / ("scene_000000/%s_image.png" % name)))
                np.testing.assert_array_equal(picture, written)
                self.assertGreater(picture.max(), 100)
            self.assertGreater(images["grey16"].picture.max(), 255)
            self.assertIsNone(images["camera"].picture)

    def test_grey_images_are_made_where_they_are_wanted(self):
        from PIL import Image
        light = {"name": "light", "preset": "structured_light_0.65m_590mm", "width": 64, "height": 48}
        keys = nuts(3, sensors=[light, {"name": "camera", "width": 48, "height": 36}])
        with tempfile.TemporaryDirectory() as folder, Generator() as g:
            request = pathlib.Path(folder) / "request.yaml"
            request.write_text(json.dumps(keys))
            subprocess.run([TOOL, "generate", request, "--out", folder, "--formats", "gray"], check=True, capture_output=True)
            without, images = next(g.generate(keys)).images, next(g.generate(keys, gray=True)).images
            for name in ("light", "camera"):
                written = np.asarray(Image.open(pathlib.Path(folder) / ("scene_000000/%s_gray.png" % name)))
                np.testing.assert_array_equal(images[name].gray, written)
                self.assertGreater(written.max(), 100)
                np.testing.assert_array_equal(images[name].depth, without[name].depth)
            self.assertIsNone(without["light"].gray)
            heap = g.heap(keys)
            heap.settle()
            self.assertIsNone(heap.scene().images["light"].gray)
            np.testing.assert_array_equal(heap.scene(gray=True).images["light"].gray, images["light"].gray)

    def test_grasps_are_those_of_the_file(self):
        keys = nuts(4, grippers=["robotiq_2f_85"])
        with tempfile.TemporaryDirectory() as folder, Generator() as g:
            request = pathlib.Path(folder) / "request.yaml"
            request.write_text(json.dumps(keys))
            subprocess.run([TOOL, "generate", request, "--out", folder, "--formats", "grasps"], check=True, capture_output=True)
            written = json.loads((pathlib.Path(folder) / "scene_000000/grasps.json").read_text())
            scene = next(g.generate(keys, grasps=True))
            self.assertEqual(scene.grasps, written)
            self.assertGreater(len(written["grasps"]), 10)
            self.assertIsNone(next(g.generate(keys)).grasps)
            heap = g.heap(keys)
            heap.settle()
            self.assertEqual(heap.scene(grasps=True).grasps, written)

    def test_a_dict_is_the_same_request(self):
        with Generator() as g:
            keys = dict(self.keys, parts=[dict(self.keys["parts"][0], count=12)])
            again = list(g.generate(keys, scenes=2, first=np.int64(5)))
        self.assertEqual([without_times(s.json()) for s in again], [without_times(s.json()) for s in self.scenes])

    def test_made_ahead_or_one_by_one_is_the_same(self):
        def depths(**how):
            with Generator() as g:
                return [s.images["camera"].depth.tobytes() + s.poses.tobytes() for s in g.generate(nuts(), scenes=6, **how)]
        self.assertEqual(depths(), depths(prefetch=4))


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with Generator() as g:
            cls.scene = next(g.generate(nuts()))

    def test_nothing_is_copied(self):
        image = self.scene.images["camera"]
        for owner, names in ((image, "depth label intensity snr validity points normals truth_depth truth_label truth_normals"),
                             (self.scene, "poses velocities ids lines")):
            for name in names.split():
                one, other = getattr(owner, name), getattr(owner, name)
                self.assertFalse(one.flags.owndata, name)
                self.assertEqual(one.ctypes.data, other.ctypes.data, name)
                self.assertTrue(one.flags.writeable, name)
        image.truth_normals[0, 0] = 2.0
        self.assertEqual(self.scene.images["camera"].truth_normals[0, 0, 2], 2.0)

    def test_pickling_says_what_to_send_instead(self):
        for shown, advice in ((self.scene, "scene.json()"), (self.scene.images["camera"], "image.depth")):
            with self.assertRaises(TypeError) as caught:
                pickle.dumps(shown)
            self.assertIn(advice, str(caught.exception))
        sent = {"poses": self.scene.poses, "json": self.scene.json(), "depth": self.scene.images["camera"].depth}
        again = pickle.loads(pickle.dumps(sent))
        np.testing.assert_array_equal(again["poses"], self.scene.poses)
        np.testing.assert_array_equal(again["depth"], self.scene.images["camera"].depth)

    def test_arrays_outlive_scene_and_generator(self):
        with Generator() as g:
            scene = next(g.generate(nuts()))
            depth, poses = scene.images["camera"].depth, scene.poses
            expected = depth.copy(), poses.copy()
            del scene
        with Generator() as g:  # takes memory that may have been freed
            list(g.generate(nuts(), scenes=3, seed=8))
        np.testing.assert_array_equal(depth, expected[0])
        np.testing.assert_array_equal(poses, expected[1])

    def test_shapes_and_types(self):
        image = self.scene.images["camera"]
        shapes = {"depth": ((120, 160), "f4"), "label": ((120, 160), "u2"), "validity": ((120, 160), "u1"),
                  "points": ((120, 160, 3), "f4"), "truth_normals": ((120, 160, 3), "f4"), "K": ((3, 3), "f8"),
                  "distortion": ((5,), "f8"), "pose": ((7,), "f8"), "visible_pixels": ((10,), "i8")}
        for name, (shape, kind) in shapes.items():
            self.assertEqual((getattr(image, name).shape, getattr(image, name).dtype), (shape, np.dtype(kind)), name)
        self.assertEqual(self.scene.velocities.shape, (10, 6))
        np.testing.assert_allclose(self.scene.visible_fraction["camera"], image.visible_pixels / image.total_pixels)
        self.assertEqual((image.truth_label == 3).sum(), image.visible_pixels[2])
        self.assertEqual(self.scene.report["solver"], "sphere")
        self.assertIs(self.scene.accepted, True)

    def test_points_lie_on_their_rays(self):
        image = self.scene.images["camera"]
        rows, columns = np.mgrid[:120, :160]
        rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(image.K).T
        np.testing.assert_allclose(image.points, rays * image.depth[..., None], atol=1e-6)

    def test_no_images(self):
        with Generator() as g:
            self.assertEqual(next(g.generate(nuts(), images=False)).images, {})
            self.assertEqual(next(g.generate(nuts(sensors=[]))).images, {})


class Heaps(unittest.TestCase):
    def test_a_heap_is_picked_from_and_poured_onto(self):
        with Generator() as g:
            heap = g.heap(nuts())
            self.assertTrue(heap.settle())
            before = heap.scene()
            self.assertEqual(before.poses.tobytes(), next(g.generate(nuts())).poses.tobytes())
            heap.remove(before.ids[3:4])
            self.assertTrue(heap.settle())
            picked = heap.scene()
            self.assertEqual(picked.states[3], "removed")
            self.assertTrue(np.isnan(picked.poses[3, :3]).all())
            self.assertNotIn(4, picked.images["camera"].truth_label)
            self.assertEqual(before.states[3], "resting")  # a snapshot
            self.assertEqual(heap.add({"model": NUT, "unit": "mm", "count": 2}).tolist(), [10, 11])
            given = np.array([[0, 0, 0.3, 0, 0, 0, 1.0]])
            self.assertEqual(heap.add([{"model": CONROD, "unit": "mm", "poses": given}]).tolist(), [12])
            heap.settle()
            self.assertEqual(heap.scene(images=False).states.count("resting"), 12)

    def test_lift_and_gravity(self):
        with Generator() as g:
            heap = g.heap(nuts(4))
            heap.settle()
            height = heap.scene(False).poses[1, 2]
            heap.lift(1, distance=0.03)
            self.assertAlmostEqual(heap.scene(False).poses[1, 2], height + 0.03, 3)
            heap.settle()
            heap.set_gravity([8.0, 0.0, -6.0])  # steeper than friction holds
            heap.settle()
            self.assertGreater(heap.scene(False).poses[:, 0].mean(), 0.03)  # along the wall of x > 0

    def test_a_dropped_heap_disturbs_nobody(self):
        with Generator() as g:
            heap = g.heap(nuts(3))
            other = g.heap(nuts(3))
            del heap
            self.assertTrue(other.settle())


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.g = Generator()
        cls.heap = cls.g.heap(nuts(2))

    @classmethod
    def tearDownClass(cls):
        cls.g.close()

    def refused(self, call, what, where, remedy=""):
        with self.assertRaises(Error) as caught:
            call()
        error = caught.exception
        self.assertIn(what, error.what)
        self.assertEqual(error.where, where)
        self.assertIn(remedy, error.remedy)
        self.assertTrue(error.remedy)
        self.assertEqual(error.kind, "input")
        for text in (error.what, error.where):
            self.assertIn(text, str(error))
        self.assertNotIn("\n", str(error))

    def test_unknown_keys_name_the_nearest(self):
        self.refused(lambda: self.g.generate(nuts(sedd=1)), "'sedd'", "request", "'seed'")
        self.refused(lambda: self.g.generate(nuts(), solver={"typ": "bullet"}), "'solver.typ'", "argument solver", "'type'")
        self.refused(lambda: self.g.generate(nuts(), pour__patern="grid"), "'pour.patern'", "argument pour__patern", "'pattern'")
        self.refused(lambda: self.heap.add({"model": NUT, "cont": 3}), "cont", "request", "'count'")

    def test_values(self):
        self.refused(lambda: self.g.generate(nuts(), scenes=-1), "-1", "argument scenes")
        self.refused(lambda: self.g.generate(nuts(), seed="x"), "'x'", "argument seed")
        self.refused(lambda: self.g.generate(nuts(), seconds=float("nan")), "", "argument seconds")
        self.refused(lambda: self.g.generate(nuts(), bin=object()), "object", "argument bin")
        self.refused(lambda: self.g.generate(nuts(), prefetch=-1), "-1", "Generator.generate")
        self.refused(lambda: self.g.generate(7), "int", "request", "dict")
        self.refused(lambda: self.g.generate("nowhere.yaml"), "no such", "nowhere.yaml")
        self.refused(lambda: self.g.generate({"parts": [{"model": "\udcff.stl"}]}), "no text of UTF-8", "request")
        self.refused(lambda: self.g.generate(nuts(), images="camera"), "'camera'", "Generator.generate")
        self.refused(lambda: self.g.generate(nuts(), grasps=True), "no grippers", "Generator.generate", "grippers=")
        self.refused(lambda: self.heap.scene(grasps=True), "no grippers", "Heap.scene", "grippers=")
        self.refused(lambda: self.g.generate({"parts": [{"model": "nowhere.stl"}]}), "nowhere.stl", "request")
        self.refused(lambda: next(self.g.generate(nuts(), memory_budget=1000)), "needs about", "memory_budget")
        cycle = nuts()
        cycle["parts"].append(cycle)
        self.refused(lambda: self.g.generate(cycle), "Circular", "request")

    def test_a_file_may_have_a_name_of_any_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            request = pathlib.Path(folder) / os.fsdecode(b"\xff.yaml")
            request.write_text(json.dumps(nuts(2)))
            self.assertEqual(next(self.g.generate(request, images=False)).poses.shape, (2, 7))

    def test_arrays_of_wrong_shape(self):
        for poses in (np.zeros((2, 6)), np.zeros(7), np.zeros((1, 1, 7))):
            request = nuts(parts=[{"model": NUT, "unit": "mm", "poses": poses}], pour={"pattern": "given"})
            self.refused(lambda: self.g.generate(request), "'parts[0].poses[0]", "request")
        self.refused(lambda: self.heap.remove([[1]]), "(1, 1)", "Heap.remove")
        self.refused(lambda: self.heap.remove(1.5), "float64", "Heap.remove")
        self.refused(lambda: self.heap.remove([7]), "7", "ids")
        self.refused(lambda: self.heap.remove([2 ** 31]), "2147483648", "Heap.remove")
        self.refused(lambda: self.heap.lift([0], direction=[0, 1]), "(2,)", "Heap.lift: direction")
        self.refused(lambda: self.heap.lift([0], distance="a"), "'a'", "Heap.lift: distance")
        self.refused(lambda: self.heap.lift([0], distance=[1]), "[1]", "Heap.lift: distance")
        self.refused(lambda: self.heap.set_gravity([0, 0, -1e9]), "1e+09", "Heap.set_gravity")
        self.refused(lambda: self.heap.set_gravity([0, np.inf, 1]), "not finite", "Heap.set_gravity")
        self.refused(lambda: self.heap.set_gravity("down"), "'down'", "Heap.set_gravity")
        self.refused(lambda: self.heap.add([]), "no part line", "Heap.add")
        self.refused(lambda: self.heap.add(None), "NoneType", "Heap.add")

    def test_a_closed_generator(self):
        g = Generator()
        heap, scenes = g.heap(nuts(2)), g.generate(nuts(2), scenes=3)
        next(scenes)
        g.close()
        g.close()
        for call, where in ((heap.settle, "Heap.settle"), (heap.scene, "Heap.scene"), (g.__enter__, "Generator"),
                            (lambda: next(scenes), "Generator.generate"), (lambda: g.heap(nuts()), "Generator"),
                            (lambda: g.generate(nuts()), "Generator")):
            self.refused(call, "closed", where)

    def test_errors_travel_between_processes(self):
        with self.assertRaises(Error) as caught:
            self.g.generate(nuts(sedd=1))
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((again.what, again.where, again.remedy, str(again)), (
            caught.exception.what, caught.exception.where, caught.exception.remedy, str(caught.exception)))
        self.assertEqual(str(Error("torn", "a.yaml:3", "sew it")), "a.yaml:3: torn (sew it)")


class Package(unittest.TestCase):
    def test_names(self):
        self.assertEqual(sorted(bin_scenes.__all__), dir(bin_scenes))
        for name in bin_scenes.__all__:
            self.assertIsNotNone(getattr(bin_scenes, name))
        with self.assertRaisesRegex(AttributeError, "no attribute 'Genrator'"):
            bin_scenes.Genrator
        self.assertIn("VERSION " + bin_scenes.__version__, (ROOT / "CMakeLists.txt").read_text())

    def test_the_example_of_the_docs(self):
        code = re.search(r"```python\n(.*?)```", (ROOT / "docs/use/python.md").read_text(), re.S)[1]
        done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, env={**os.environ, "PYTHONPATH": PACKAGES},
                              capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        lines = done.stdout.splitlines()
        self.assertEqual([line.rsplit(" ", 1)[0] for line in lines[:3]], ["%d True (20, 7)" % i for i in range(3)])
        self.assertEqual(lines[3:], ["removed"])

    def test_the_example_of_a_training_loop(self):
        request = ROOT / "config/throughput_plan.yaml"  # a plan: refused with a reason
        example = [sys.executable, ROOT / "python/examples/live_dataset.py"]
        told = subprocess.run([*example, request], env={**os.environ, "PYTHONPATH": PACKAGES}, capture_output=True, text=True)
        self.assertIn("pass it to the command bin_scenes dataset", told.stderr.splitlines()[-1])
        with tempfile.TemporaryDirectory() as folder:
            request = pathlib.Path(folder) / "request.yaml"
            request.write_text(json.dumps(nuts(5)))
            done = subprocess.run([*example, request, "--scenes", "6", "--work", "0"], capture_output=True, text=True,
                                  env={**os.environ, "PYTHONPATH": PACKAGES})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([line.split(":")[0] for line in done.stdout.splitlines()], ["scene %d" % i for i in range(6)])

    @unittest.skipUnless(pathlib.Path(PACKAGES, "bin_scenes/msg/__init__.py").exists(), "built without ROS")
    def test_messages_are_beside_and_load_no_module(self):
        code = "import sys, bin_scenes.msg, bin_scenes.srv, bin_scenes.cfg; bin_scenes.msg.Scene; print('bin_scenes._core' in sys.modules)"
        path = os.pathsep.join([PACKAGES, os.environ.get("PYTHONPATH", "")])
        done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True)
        self.assertEqual((done.stdout, done.stderr), ("False\n", ""))

    def test_the_reader_of_data_sets_is_both_names(self):
        import bin_scenes_data
        self.assertIs(bin_scenes.data.Shards, bin_scenes_data.Shards)
        self.assertEqual(bin_scenes.data.__all__, bin_scenes_data.__all__)


if __name__ == "__main__":
    unittest.main()
