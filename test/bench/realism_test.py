#!/usr/bin/python3
"""The figures of bench/realism against closed forms: planes, steps, ramps, holes of known size, and noise of known
standard deviation and correlation length."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import types
import unittest

import numpy as np
from scipy import ndimage

sys.dont_write_bytecode = True
PATH = str(pathlib.Path(__file__).resolve().parents[2] / "bench/realism")
LOADER = importlib.machinery.SourceFileLoader("realism", PATH)
realism = importlib.util.module_from_spec(importlib.util.spec_from_loader("realism", LOADER))
LOADER.exec_module(realism)
FOCAL = 422.2


def plane(rows=80, columns=80, slope=0.0, depth=400.0):
    return np.full((rows, columns), depth) + slope * (np.arange(columns) - columns / 2)


def noise(shape, sigma, seed=1):
    return np.random.default_rng(seed).normal(0, sigma, shape)


class Figures(unittest.TestCase):
    def test_a_plane_has_no_error(self):
        image = plane(slope=0.5)
        for figure in (realism.second_difference, realism.broken_neighbours, realism.mid_air, realism.missing_share,
                       realism.hole_count, realism.flat_rms):
            self.assertAlmostEqual(figure(image, FOCAL), 0, 9, figure.__name__)

    def test_white_noise(self):
        image = plane(400, 400) + noise((400, 400), 0.7)
        self.assertAlmostEqual(realism.second_difference(image, FOCAL) / (0.7 * np.sqrt(12 / np.pi)), 1, delta=0.015)
        patch = plane(41, 41, 0.3) + noise((41, 41), 0.7)
        self.assertAlmostEqual(realism.flat_rms(patch, FOCAL) / 0.7, 1, delta=0.06)  # 3.5 sigma of 1681 samples
        self.assertAlmostEqual(realism.flat_correlation(patch, FOCAL), 1 - np.exp(-1), delta=0.08)

    def test_correlated_noise_falls_to_one_over_e_at_twice_the_filters_sigma(self):
        lengths = [realism.flat_correlation(plane(41, 41) + ndimage.gaussian_filter(noise((81, 81), 5, seed), 1.5)[20:61, 20:61],
                                            FOCAL) for seed in range(20)]
        self.assertAlmostEqual(np.mean(lengths), 3, delta=0.2)

    def test_steep_planes_keep_their_noise(self):
        image = plane(80, 40, slope=np.tan(np.radians(68)) * 400 / FOCAL) + noise((80, 40), 0.3)
        median = np.sqrt(21.34 / 22)  # of sqrt(chi2 / 22) with 22 degrees of freedom
        self.assertAlmostEqual(realism.steep_residual(image, FOCAL) / (0.3 * median), 1, delta=0.04)
        self.assertTrue(np.isnan(realism.steep_residual(plane(slope=np.tan(np.radians(45)) * 400 / FOCAL), FOCAL)))

    def test_width_of_steps(self):
        sharp = np.where(np.arange(80) < 40, 400.0, 440.0) * np.ones((5, 1))
        self.assertEqual(realism.step_width(sharp, FOCAL), 0)
        ramp = np.interp(np.arange(80), [35, 44], [400.0, 440.0]) * np.ones((5, 1))
        self.assertEqual(realism.step_width(ramp, FOCAL), 8)  # of ninths of the step, all but 0 and 1
        self.assertTrue(np.isnan(realism.step_width(plane(), FOCAL)))

    def test_broken_neighbours(self):
        image = np.where(np.arange(20) < 7, 400.0, 410.0) * np.ones((30, 1))
        self.assertAlmostEqual(realism.broken_neighbours(image, FOCAL), 1e4 * 30 / (30 * 19 + 29 * 20))
        image[:, 7:] += 15
        self.assertEqual(realism.broken_neighbours(image, FOCAL), 0)

    def test_a_point_in_mid_air(self):
        image = plane()
        image[40, 40] -= 50
        self.assertAlmostEqual(realism.mid_air(image, FOCAL), 1e4 / 6400)

    def test_gaps_beside_a_near_part(self):
        image = plane(depth=450)
        image[:, 40:60] = 400
        image[:, 35:40] = image[:, 60:63] = np.nan
        self.assertEqual(realism.missing_left(image, FOCAL), 5)
        self.assertEqual(realism.missing_right(image, FOCAL), 3)

    def test_holes(self):
        image = plane(20, 20)
        image[4, 4] = image[8:10, 8:10] = image[13:16, 3:6] = np.nan
        self.assertAlmostEqual(realism.missing_share(image, FOCAL), 14 / 400)
        self.assertAlmostEqual(realism.hole_count(image, FOCAL), 1e4 * 3 / 400)
        self.assertEqual(realism.hole_size(image, FOCAL), 4)
        image[0, :3] = np.nan  # reaches the border: not a hole, and before the first measured pixel
        self.assertEqual(realism.hole_size(image, FOCAL), 4)
        self.assertAlmostEqual(realism.missing_share(image, FOCAL), 14 / 397)

    def test_a_valley(self):
        image = plane(5, 40)
        image[:, 10:15] = 420
        self.assertAlmostEqual(realism.valley_width(image, FOCAL), 6 * 400 / FOCAL)
        image[:, 10:15] = 407
        self.assertTrue(np.isnan(realism.valley_width(image, FOCAL)))


class Separation(unittest.TestCase):
    def test_area_under_the_curve(self):
        values = np.arange(5.0)
        self.assertEqual(realism.separation(values, values), 0.5)
        self.assertEqual(realism.separation(values, values - 9), 1)

    def test_the_classifier_sees_a_difference_and_no_other(self):
        def images(sigma, seed):
            return [plane(128, 128) + noise((128, 128), sigma, seed + i) for i in range(4)]
        self.assertGreater(realism.classify(images(0.5, 0), images(1.0, 10), FOCAL), 0.95)
        self.assertLess(realism.classify(images(0.5, 0), images(0.5, 10), FOCAL), 0.85)  # 3.5 sigma of 16 + 16 tiles


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.image = plane(50, 60, 0.5)
        self.image[7:9, 11] = np.nan
        row, column = np.mgrid[:50, :60]
        z = self.image / 1e3
        self.cloud = np.stack([(column - 19.8) * z / FOCAL, (row - 13.7) * z / FOCAL, z], 2).reshape(-1, 3)
        self.there = np.isfinite(self.cloud).all(1)

    def file(self, name, content):
        path = pathlib.Path(self.folder.name) / name
        path.write_bytes(content)
        return str(path)

    def check(self, name, content):
        options = types.SimpleNamespace(focal=FOCAL, unit=0, crop=None, scale=1e-3)
        np.testing.assert_allclose(realism.read(self.file(name, content), options), self.image, atol=1e-3)

    def test_ply(self):
        rows = self.cloud[self.there] * [1, -1, -1]  # as OpenGL has them
        text = "".join("%.7f %.7f %.7f\n" % tuple(row) for row in rows)
        head = "ply\nformat %s 1.0\ncomment x\nelement vertex %d\n%send_header\n"
        axes = "property float x\nproperty float y\nproperty float z\n"
        self.check("ascii.ply", (head % ("ascii", len(rows), axes) + text).encode())
        for name, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
            data = np.zeros(len(rows), [("c", "u1"), ("x", order + "f8"), ("y", order + "f4"), ("z", order + "f4")])
            data["x"], data["y"], data["z"] = rows.T
            fields = "property uchar c\nproperty double x\nproperty float y\nproperty float z\n"
            self.check(name + ".ply", (head % (name, len(rows), fields)).encode() + data.tobytes())

    def test_organised_pcd(self):
        head = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal label\nSIZE 4 4 4 4 2\nTYPE F F F F U\nCOUNT 1 1 1 3 1\n"
                "WIDTH 60\nHEIGHT 50\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3000\nDATA %s\n")
        data = np.zeros(3000, [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("n", "<f4", 3), ("l", "<u2")])
        data["x"], data["y"], data["z"] = self.cloud.T
        self.check("binary.pcd", (head % "binary").encode() + data.tobytes())
        text = "".join("%s %s %s 0 0 1 7\n" % tuple(row) for row in self.cloud)
        self.check("ascii.pcd", (head % "ascii" + text).encode())

    def test_compressed_pcd(self):
        head = ("VERSION 0.7\nFIELDS label x y z\nSIZE 2 4 4 4\nTYPE U F F F\nCOUNT 1 1 1 1\n"
                "WIDTH 60\nHEIGHT 50\nPOINTS 3000\nDATA binary_compressed\n").encode()
        label = bytes(6000)
        axes = np.ascontiguousarray(self.cloud.T, "<f4").tobytes()

        def literal(data):
            return b"".join(bytes([len(data[k:k + 32]) - 1]) + data[k:k + 32] for k in range(0, len(data), 32))

        # A byte of the labels, then as many repeats of it as one control holds.
        packed = bytes([0, 0, 0xE0, 255, 0]) * 22 + literal(label[22 * 265:] + axes)
        size = np.array([len(packed), len(label) + len(axes)], "<u4").tobytes()
        self.check("compressed.pcd", head + size + packed)
        with self.assertRaises(realism.BadFile):
            options = types.SimpleNamespace(focal=FOCAL, unit=0, crop=None, scale=1e-3)
            realism.read(self.file("damaged.pcd", head + size + packed[:-5]), options)

    def test_depth_image(self):
        counts = np.nan_to_num(np.round(self.image * 100), nan=0).astype(np.uint16)
        path = str(pathlib.Path(self.folder.name) / "depth.png")
        realism.Image.fromarray(counts).save(path)
        options = types.SimpleNamespace(focal=FOCAL, unit=0, crop=None, scale=1e-5)
        np.testing.assert_allclose(realism.read(path, options), self.image, atol=0.006)

    def test_broken_files_are_named(self):
        options = types.SimpleNamespace(focal=FOCAL, unit=0, crop=None, scale=1e-3)
        for name, content in (("a.ply", b"plx\n"), ("b.ply", b"ply\nformat ascii 1.0\nelement vertex 9\nend_header\n"),
                              ("c.pcd", b"FIELDS x y z\nDATA binary_compressed\n"), ("d.png", b"no picture"), ("e.ply", b"")):
            with self.assertRaises(realism.BadFile) as caught:
                realism.read(self.file(name, content), options)
            self.assertIn(name, str(caught.exception))


class Verdicts(unittest.TestCase):
    def test_a_figure_out_of_range_names_its_factor_and_keys(self):
        rows = [("step_width", 10.0, 8.0, 11.0, 2.0, 1.0), ("flat_rms", 1.0, 0.6, 3.0, 0.7, 0.8)]
        off, fine = realism.verdicts(rows)
        self.assertTrue(off["off"])
        self.assertAlmostEqual(off["factor"], 0.2)
        self.assertIn("stereo.window", off["keys"])
        self.assertFalse(fine["off"])
        self.assertEqual(fine["keys"], [])

    def test_one_real_file_has_no_range(self):
        off, fine = realism.verdicts([("step_width", 10.0, 10.0, 10.0, 6.0, 1.0), ("flat_rms", 1.0, 1.0, 1.0, 1.4, 0.8)])
        self.assertTrue(off["off"])
        self.assertFalse(fine["off"])

    def test_each_figure_has_keys(self):
        self.assertEqual(set(realism.KEYS), {figure.__name__ for figure in realism.FIGURES})


if __name__ == "__main__":
    unittest.main()
