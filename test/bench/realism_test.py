#!/usr/bin/python3
"""The figures of bench/realism against closed forms: planes, steps, ramps, holes of known size, and noise of known
standard deviation and correlation length."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
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
    def test_a_cloud_becomes_the_image_that_it_came_from(self):
        image = plane(30, 40, 0.5)
        image[7:9, 11] = np.nan
        row, column = np.nonzero(np.isfinite(image))
        z = image[row, column] / 1e3
        points = np.stack([(column - 19.8) * z / FOCAL, -(row - 13.7) * z / FOCAL, -z], 1)
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/cloud.ply"
            with open(path, "w", encoding="ascii") as file:
                file.write("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nend_header\n" % len(points))
                np.savetxt(file, points, "%.6f")
            np.testing.assert_allclose(realism.read_ply(path, FOCAL), image, atol=1e-3)


if __name__ == "__main__":
    unittest.main()
