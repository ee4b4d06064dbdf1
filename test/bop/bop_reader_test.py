#!/usr/bin/python3
"""BOP's two layouts against each other, and against rays of our own through the true boxes: an independent reader.

    bop_reader_test.py TOOL
"""
import json
import pathlib
import struct
import subprocess
import sys
import time
import unittest
import unittest.mock
import zlib

import numpy as np
from PIL import PngImagePlugin

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
import data_set  # noqa: E402
from data_set import BAR, BOX, DataSetTest, ROOT
from bin_scenes_data import Shards, read_png, read_tiff

TOLERANCE = 0.0015  # m, the default of a plan with visible: measured
MEASURED = "bop: {visible: measured}"


def ray_depth(size, pose, rays):
    """Depth along the optical axis of a box at `pose` (model to camera) for rays with z = 1; inf where it is missed."""
    turn, shift = pose[:3, :3], pose[:3, 3]
    origin, directions = -turn.T @ shift, rays @ turn
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.stack([(sign * np.array(size) / 2 - origin) / directions for sign in (-1, 1)])
    near, far = ends.min(0).max(-1), ends.max(0).min(-1)
    return np.where((near <= far) & (near > 0), near, np.inf)


def png(width, height, bits, colour, rows):
    """A PNG file of rows that carry their filter byte."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Images(unittest.TestCase):
    def test_grey_of_16_bits_is_read_as_it_stands(self):
        values = np.array([[0, 1, 256], [40000, 65535, 7]], np.uint16)
        rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in values)
        image = read_png(png(3, 2, 16, 0, rows))
        self.assertEqual(image.dtype, np.uint16)
        np.testing.assert_array_equal(image, values)
        # From 10.3 on Pillow opens such files with 16 bits a pixel, not 32; an older one does so in the file's order of bytes.
        with unittest.mock.patch.dict(PngImagePlugin._MODES, {(16, 0): ("I;16B", "I;16B")}):
            image = read_png(png(3, 2, 16, 0, rows))
        self.assertEqual(image.dtype, np.uint16)
        np.testing.assert_array_equal(image, values)

    def test_rgb_of_8_bits(self):
        np.testing.assert_array_equal(read_png(png(2, 1, 8, 2, b"\0\1\2\3\4\5\6")), [[[1, 2, 3], [4, 5, 6]]])

    def test_rgb_of_16_bits_keeps_them(self):
        values = np.array([[[0, 1, 256], [40000, 65535, 7]], [[513, 0, 255], [3, 65535, 40001]], [[9, 8, 7], [6, 5, 300]]], np.uint16)
        stored = [np.frombuffer(row.astype(">u2").tobytes(), np.uint8) for row in values]
        below = [b"\0" + stored[0].tobytes(), b"\2" + (stored[1] - stored[0]).tobytes(), b"\2" + (stored[2] - stored[1]).tobytes()]
        image = read_png(png(2, 3, 16, 2, b"".join(below)))
        self.assertEqual(image.dtype, np.uint16)
        np.testing.assert_array_equal(image, values)

    def test_what_it_cannot_read_is_refused(self):
        whole, colours = png(64, 64, 8, 0, bytes(range(65)) * 64), png(2, 1, 16, 2, b"\0" + bytes(range(12)))
        filtered, short = png(1, 1, 16, 2, b"\4" + bytes(6)), png(1, 2, 16, 2, bytes(7))
        for data in (b"", b"no picture", whole[:-40], colours[:-20], filtered, short, png(1, 1, 8, 6, bytes(5))):
            with self.assertRaises(ValueError):
                read_png(data)
        with self.assertRaises(ValueError):
            read_tiff(whole)


class Bop(DataSetTest):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"

    def images(self, more="", noisy=False):
        plan = self.plan(scenes=4, more=more)
        if noisy:
            path = self.folder / plan
            path.write_text(path.read_text().replace("    - {name: camera, width: 96, height: 72}", """    - {name: camera, model: structured_light, width: 96,
       height: 72, fov: 0.6, projector: {baseline: 0.15, fov: 0.8}}"""))
        self.make(plan, "out")
        for scene in sorted((self.out / "bop/train").iterdir()):
            files = {name: json.loads((scene / (name + ".json")).read_text())
                     for name in ("scene_gt", "scene_gt_info", "scene_camera")}
            for key in files["scene_gt"]:
                yield scene, int(key), *(files[name][key] for name in ("scene_gt", "scene_gt_info", "scene_camera"))

    def test_counts_boxes_and_fractions_agree_with_rays_of_our_own(self):
        compared = 0
        for scene, key, truth, infos, camera in self.images(MEASURED):
            counts = read_png((scene / "depth" / ("%06d.png" % key)).read_bytes())
            k = np.array(camera["cam_K"]).reshape(3, 3)
            height, width = counts.shape
            rows, columns = np.mgrid[-height:2 * height, -width:2 * width]
            rays = np.stack([(columns - k[0, 2]) / k[0, 0], (rows - k[1, 2]) / k[1, 1], np.ones(rows.shape)], -1)
            inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
            norm = np.linalg.norm(rays, axis=-1)
            measured = np.zeros(rows.shape)
            measured[inside] = counts.ravel() * camera["depth_scale"] / 1e3
            for number, (part, info) in enumerate(zip(truth, infos)):
                pose = np.eye(4)
                pose[:3, :3] = np.array(part["cam_R_m2c"]).reshape(3, 3)
                pose[:3, 3] = np.array(part["cam_t_m2c"]) / 1e3
                alone = ray_depth((BOX, BAR)[part["obj_id"] - 1], pose, rays)
                whole = np.isfinite(alone)
                visible = whole & inside & ((measured == 0) | ((alone - measured) * norm <= TOLERANCE))
                with self.subTest(scene=scene.name, image=key, part=number):
                    self.assertLessEqual(abs(int(whole.sum()) - info["px_count_all"]), 2 + 0.005 * whole.sum())
                    self.assertLessEqual(abs(int(visible.sum()) - info["px_count_visib"]), 2 + 0.005 * whole.sum())
                    self.assertAlmostEqual(info["visib_fract"], visible.sum() / whole.sum(), delta=0.02)
                    if visible.any():
                        ys, xs = rows[visible], columns[visible]
                        box = [xs.min(), ys.min(), xs.max() - xs.min(), ys.max() - ys.min()]
                        self.assertLessEqual(max(abs(a - b) for a, b in zip(box, info["bbox_visib"])), 1)
                    else:
                        self.assertEqual(info["bbox_visib"], [-1, -1, -1, -1])
                    compared += 1
        self.assertGreater(compared, 20)

    def masks(self, scene, kind, key, parts):
        return [read_png((scene / kind / ("%06d_%06d.png" % (key, i))).read_bytes()) > 0 for i in range(parts)]

    def test_visible_is_what_is_truly_seen_whatever_the_sensor_measures(self):
        missing = 0
        for scene, key, truth, infos, _ in self.images(noisy=True):
            folder = self.out / ("scenes/scene_" + scene.name)
            name = ("camera", "side")[key]
            labels = read_png((folder / (name + "_truth_labels.png")).read_bytes())
            missing += (read_png((folder / (name + "_depth.png")).read_bytes()) == 0).sum()
            seen, whole = (self.masks(scene, kind, key, len(truth)) for kind in ("mask_visib", "mask"))
            for part, info, visible, alone in zip(truth, infos, seen, whole):
                np.testing.assert_array_equal(visible, labels == part["id"] + 1)
                self.assertFalse((visible & ~alone).any())
                self.assertEqual(info["px_count_visib"], visible.sum())
                self.assertGreaterEqual(info["px_count_all"], alone.sum())
                if visible.any():
                    rows, columns = visible.nonzero()
                    self.assertEqual(info["bbox_visib"], [columns.min(), rows.min(), np.ptp(columns), np.ptp(rows)])
            self.assertLessEqual(np.sum(seen, 0).max(initial=0), 1)
        self.assertGreater(missing, 100, "the sensor misses something")
        self.assertEqual(json.loads((self.out / "dataset.json").read_text())["bop_visible"], "truth")

    def test_visible_by_what_was_measured_is_had_by_a_key(self):
        several = sum((np.sum(self.masks(scene, "mask_visib", key, len(truth)), 0) > 1).sum()
                      for scene, key, truth, _, _ in self.images(MEASURED, noisy=True))
        self.assertGreater(several, 0, "where nothing is measured, every part counts as visible")
        facts = json.loads((self.out / "dataset.json").read_text())
        self.assertEqual((facts["bop_visible"], facts["bop_tolerance_m"]), ("measured", TOLERANCE))

    def test_shards_hold_what_the_folders_hold(self):
        for scene, key, truth, infos, camera in self.images(noisy=True):
            shards = Shards(self.out)
            self.assertEqual(len(shards), 8)
            sample = shards["%s_%06d" % (scene.name, key)]
            name = "%06d.png" % key
            self.assertEqual(sample.raw("depth.png"), (scene / "depth" / name).read_bytes())
            np.testing.assert_array_equal(sample.gray, read_tiff((scene / "gray" / ("%06d.tiff" % key)).read_bytes()))
            truth_png = self.out / ("scenes/scene_%s/%s_truth_" % (scene.name, ("camera", "side")[key]))
            np.testing.assert_array_equal(sample.labels, read_png(truth_png.with_name(truth_png.name + "labels.png").read_bytes()))
            snr = read_png(truth_png.with_name(truth_png.name.replace("truth_", "snr.png")).read_bytes())
            np.testing.assert_allclose(sample.snr, snr / 10, rtol=1e-6)
            np.testing.assert_array_equal(sample.channel("snr"), snr)
            np.testing.assert_array_equal(sample.snr > 0, np.isfinite(sample.depth))
            normals = read_png(truth_png.with_name(truth_png.name + "normal.png").read_bytes())
            there = normals.any(-1)
            np.testing.assert_array_equal(np.isfinite(sample.normals).all(-1), there)
            np.testing.assert_allclose(sample.normals[there], normals[there] / 127.5 - 1, atol=1e-6)
            self.assertLess(abs(np.linalg.norm(sample.normals[there], axis=-1) - 1).max(), 0.01)
            np.testing.assert_array_equal(sample.ids, [part["id"] for part in truth])
            self.assertEqual(sample.info, infos)
            self.assertEqual(sample.objects.tolist(), [part["obj_id"] for part in truth])
            self.assertEqual(sample.camera_matrix.ravel().tolist(), camera["cam_K"])
            for kind in ("mask", "mask_visib"):
                for i, mask in enumerate(sample.masks(kind)):
                    png = read_png((scene / kind / ("%06d_%06d.png" % (key, i))).read_bytes())
                    np.testing.assert_array_equal(mask, png > 0)

    def test_symmetries_and_diameters_are_those_of_boxes(self):
        list(self.images())
        info = json.loads((self.out / "bop/models/models_info.json").read_text())
        for number, size, others in ((1, BOX, 3), (2, BAR, 7)):  # a box; a bar with a square end
            self.assertAlmostEqual(info[str(number)]["diameter"], 1e3 * np.linalg.norm(size), places=3)
            self.assertEqual(len(info[str(number)]["symmetries_discrete"]), others)
            self.assertNotIn("symmetries_continuous", info[str(number)])

    def test_shards_keep_16_bits_and_bop_tells_that_it_does_not(self):
        plan = self.plan(scenes=1)
        path, camera = self.folder / plan, "    - {name: camera, width: 96, height: 72"
        image = ", model: image, image: {samples: 1, bits: 16%s}"
        text = path.read_text().replace(camera, camera + image % ", colour: true")
        path.write_text(text.replace("width: 64, height: 48", "width: 64, height: 48" + image % ""))
        told = self.make(plan, "out").stderr
        self.assertEqual(told.count("BOP's files hold the upper 8 bits of pictures of 16"), 1, told)
        scene = self.out / "scenes/scene_000000"
        for sample, sensor, shape in zip(Shards(self.out), ("camera", "side"), ((72, 96, 3), (48, 64))):
            picture = sample.picture
            self.assertEqual((picture.shape, picture.dtype), (shape, np.uint16))
            self.assertGreater(len(np.unique(picture)), 256)  # no picture of 8 bits, stretched
            self.assertEqual(sample.raw("image.png"), (scene / (sensor + "_image.png")).read_bytes())
            bytes_of = sample.rgb if picture.ndim == 3 else sample.gray
            self.assertEqual(bytes_of.dtype, np.uint8)
            self.assertLessEqual(abs(bytes_of.astype(int) - picture / 257).max(), 1)
        self.run_tool("dataset", "verify", "out")

    def test_pictures_of_8_bits_are_those_of_bop(self):
        plan = self.plan(scenes=1, outputs="json, shards")
        path, camera = self.folder / plan, "    - {name: camera, width: 96, height: 72"
        path.write_text(path.read_text().replace(camera, camera + ", model: image, image: {samples: 1, colour: true}"))
        self.assertNotIn("bits", self.make(plan, "out").stderr)
        colour, depth = Shards(self.out)
        np.testing.assert_array_equal(colour.picture, colour.rgb)
        np.testing.assert_array_equal(depth.picture, depth.gray)

    def test_the_example_shows_a_batch(self):
        list(self.images())
        done = subprocess.run([sys.executable, ROOT / "python/examples/show_batch.py", self.out, "--size", "3"],
                              capture_output=True, text=True, env={"PYTHONPATH": str(ROOT / "python")})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 3)

    def test_samples_come_in_order_and_at_random(self):
        list(self.images())
        shards = Shards(self.out)
        self.assertEqual([sample.key for sample in shards], shards.keys)
        self.assertEqual(shards[-1].key, shards.keys[-1])
        with self.assertRaises(KeyError):
            shards["999999_000000"]
        with self.assertRaisesRegex(KeyError, "image %s has no rgb.png; there are camera.json" % shards.keys[0]):
            shards[0].rgb
        begin = time.monotonic()
        depths = [sample.depth for sample in shards]
        print("%d samples of up to 96 x 72 decoded in %.3f s" % (len(depths), time.monotonic() - begin))
        self.assertTrue(all(np.isfinite(depth).any() for depth in depths))


if __name__ == "__main__":
    data_set.main()
