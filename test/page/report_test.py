#!/usr/bin/env python3
"""`bin_scenes report`: one page that opens in a browser without a network; skipped where there is no Chromium.

    report_test.py TOOL [--keep PNG]
"""
import colorsys
import json
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
import data_set  # noqa: E402
from data_set import DataSetTest, option

KEEP = option("--keep")
CHROMIUM = shutil.which("chromium")


def colour_of_part(index):
    """As src/scene/palette.hpp states it."""
    rgb = colorsys.hsv_to_rgb((0.08 + 0.6180339887498949 * index) % 1, 0.42 + 0.09 * (index % 3), 0.97 - 0.07 * (index // 3 % 3))
    return "#" + "".join("%02x" % round(255 * channel) for channel in rgb)


class Report(DataSetTest):
    def browse(self, *options, at=""):
        command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                   "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=8000",
                   "--user-data-dir=%s" % (self.folder / "profile"), *options, "file://%s%s" % (self.folder / "out/report.html", at)]
        return subprocess.run(command, capture_output=True, text=True, timeout=300)

    def make_report(self):
        draw = "  pour: {choice: [{limit: 0.05, rest_window: 0.04}, {limit: 20}]}"
        self.make(self.plan(scenes=5, draw=draw), "out", code=None)
        done = self.run_tool("report", "out")
        page = self.folder / "out/report.html"
        self.assertLess(page.stat().st_size, 5_000_000)
        return done, page.read_text()

    def test_the_page_holds_everything_itself(self):
        _, page = self.make_report()
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:)[^"]*"', page), [])
        self.assertIn("not at rest", page)
        self.assertIn("parts[0].friction", page)
        data = json.loads(re.search(r'type="application/json">(.*?)</script>', page, re.S)[1].replace("<\\/", "</"))
        for index, part in enumerate(data["scene3d"]["parts"]):
            self.assertEqual(part[-1], colour_of_part(index))

    def test_a_model_that_is_cut_off_is_named(self):
        self.make(self.plan(scenes=1, outputs="bop"), "out")
        for path in sorted((self.folder / "out/bop/models").glob("*.ply")):
            whole = path.read_bytes()
            for left in (0, 60, len(whole) - 1, 2 * len(whole) // 3):
                path.write_bytes(whole[:left])
                self.assertRegex(self.run_tool("report", "out", code=2).stderr, path.name + ".*is no whole PLY")
            path.write_bytes(whole)
        self.run_tool("report", "out")

    def test_published_figures_stand_beside_those_of_the_images(self):
        path = self.folder / self.plan(scenes=3, outputs="json, bop")
        path.write_text(path.read_text().replace("    - {name: camera, width: 96, height: 72}", """    - {name: camera, model: structured_light,
       width: 96, height: 72, fov: 0.6, projector: {baseline: 0.15, fov: 0.8}}"""))
        self.make("plan.yaml", "out")
        self.run_tool("report", "out")
        page = (self.folder / "out/report.html").read_text()
        data = json.loads(re.search(r'type="application/json">(.*?)</script>', page, re.S)[1].replace("<\\/", "</"))
        here = {row[0]: row[1] for row in data["published"]}
        seen, depths, shares = [], [], []
        for scene in (self.folder / "out/scenes").iterdir():
            sensor = json.loads((scene / "scene.json").read_text())["sensors"][0]
            of_image = [part for part in sensor["truth"] if part["visible_fraction"] >= 0.1]
            seen.append(len(of_image))
            depths += [1e3 * part["pose_in_camera"]["position"][2] for part in of_image]
            shares += [part["px_count_measured"] / part["px_count_visib"] for part in of_image]
        self.assertEqual(here["camera: instances visible by 10 % and more, an image"], "%.1f" % (sum(seen) / len(seen)))
        self.assertEqual(here["camera: depth of these instances"], "%.0f to %.0f mm" % (min(depths), max(depths)))
        classes = [sum(s < 0.9 for s in shares), sum(0.9 <= s <= 0.99 for s in shares), sum(s > 0.99 for s in shares)]
        self.assertEqual(here["camera: instances with depth in less than 0.90, up to 0.99, more of their visible pixels"],
                         ", ".join("%.1f" % (100 * c / len(shares)) for c in classes) + " %")
        self.assertLess(min(shares), 0.9, "structured light has gaps")
        ideal = [value for name, value in here.items() if name.startswith("side: instances with depth")]
        self.assertEqual(ideal, ["0.0, 0.0, 100.0 %"])

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_it_opens_in_a_browser_without_a_network(self):
        done, _ = self.make_report()
        # The 3-D view is drawn once a frame shows it: beside other work the browser may end before that frame.
        for _ in range(5):
            dom = self.browse("--dump-dom", at="#three").stdout  # scrolled to the 3-D view
            if "data-drawn" in dom or "no 3-D view" in done.stderr:
                break
        self.assertIn('data-ready="yes"', dom, "the page's script did not reach its end")
        self.assertEqual(len(re.findall(r'<svg viewBox="0 0 330', dom)), 6)
        self.assertGreater(len(re.findall(r"<figcaption>scene \d+", dom)), 2)
        self.assertIn("attempt 0", dom)
        if "no 3-D view" not in done.stderr:
            self.assertTrue(re.search(r'data-drawn="\d+"', dom), "the 3-D view was not drawn in five visits")
        if KEEP:
            self.browse("--window-size=1240,2300", "--screenshot=%s" % KEEP)

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_grasps_of_the_scene_in_3d_are_counted_and_drawn(self):
        path = self.folder / self.plan(scenes=1, outputs="json, bop, grasps")
        path.write_text(path.read_text().replace("  sensors:", "  grippers: [cup_10mm, {name: two, stroke: 0.06}]\n  sensors:"))
        self.make("plan.yaml", "out")
        done = self.run_tool("report", "out")
        free = [g for g in json.loads((self.folder / "out/scenes/scene_000000/grasps.json").read_text())["grasps"] if g["free"]]
        for _ in range(5):
            dom = self.browse("--dump-dom", at="#three").stdout
            if "data-drawn" in dom or "no 3-D view" in done.stderr:
                break
        for gripper in ("cup_10mm", "two"):
            row = '<b>%s</b>: %d of ' % (gripper, sum(g["gripper"] == gripper for g in free))
            self.assertTrue(row in dom, row)
        if "no 3-D view" not in done.stderr:
            self.assertTrue('data-grasps="%d"' % min(10, len(free)) in dom, "the grasps were not drawn")
        if KEEP:
            self.browse("--window-size=1240,1700", "--screenshot=%s" % KEEP)

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_it_opens_with_ten_thousand_scenes(self):
        self.make(self.plan(scenes=2, outputs="json, bop"), "out")
        with sqlite3.connect(self.folder / "out/index.sqlite") as index:
            index.executemany("insert into heaps select ?, state, attempts, wall_s, cpu_s, memory_mb, stages_ms, made_at "
                              "from heaps where heap = 1", [(i,) for i in range(2, 10_000)])
            index.executemany("insert into scenes select ?, ?, state, verdict, path, sha256, summary from scenes where scene = 1",
                              [(i, i) for i in range(2, 10_000)])
        picture = self.folder / "out/bop/train/000001/gray/000000.tiff"
        for scene in range(2, 10_000):
            folder = self.folder / ("out/bop/train/%06d/gray" % scene)
            folder.mkdir(parents=True)
            os.link(picture, folder / "000000.tiff")
        self.run_tool("report", "out")
        self.assertLess((self.folder / "out/report.html").stat().st_size, 5_000_000)
        dom = self.browse("--dump-dom").stdout
        self.assertIn('data-ready="yes"', dom, "the page's script did not reach its end")
        self.assertRegex(dom, r"\d{3} of 10000 scenes, first 60 shown")
        self.assertEqual(len(re.findall("<figcaption>", dom)), 60)


if __name__ == "__main__":
    data_set.main()
