#!/usr/bin/python3
"""`bin_scenes view`: one page that shows a scene in a browser without a network; pictures of it are looked at pixel by
pixel. What needs a browser is skipped where there is no Chromium.

    view_page_test.py TOOL [--keep PNG]
"""
import base64
import colorsys
import html
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
from data_set import box_stl, option  # noqa: E402

TOOL = os.path.abspath(sys.argv.pop(1))
KEEP = option("--keep")
CHROMIUM = shutil.which("chromium")
PANEL = 340  # pixels of the page's right side

REQUEST = """seed: 5
bin: {inner_size: [0.24, 0.2, 0.15]}
solver: {type: bullet}
parts: [{model: box.stl, unit: mm, count: 6}, {model: bar.stl, unit: mm, count: 4}]
sensors:
%s
"""
SENSORS = """  - {name: camera, model: structured_light, width: 160, height: 120, fov: 0.6, projector: {baseline: 0.15, fov: 0.8}}
  - {name: side, width: 64, height: 48, pose: [0.3, 0, 0.5, 0.9272, 0, -0.3746, 0]}"""
TABLE = "table: {height: -0.005, surface: {albedo: 0.3}}\n"

# Lists texts of the panel that lie beyond their place or over each other. Of options, which a browser draws itself, the
# element that contains them counts.
LAYOUT = """<script>{
const panel = document.getElementById("panel"), view = document.getElementById("view").getBoundingClientRect(), texts = [], faults = [];
const place = panel.getBoundingClientRect(), walker = document.createTreeWalker(panel, NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
  const node = walker.currentNode, range = document.createRange();
  range.selectNodeContents(node);
  if (node.parentElement.tagName !== "OPTION" && node.data.trim())
    for (const box of range.getClientRects()) if (box.width > 0) texts.push([node.data.trim(), box]);
}
for (const control of panel.querySelectorAll("select, input, .bar, .swatch"))
  if (control.getClientRects().length) texts.push([control.id || control.className, control.getBoundingClientRect()]);
texts.forEach(([text, box], i) => {
  if (box.left < place.left || box.right > place.left + panel.clientWidth + panel.clientLeft) faults.push(text + " is cut off");
  for (const [other, its] of texts.slice(0, i)) {
    const wide = Math.min(box.right, its.right) - Math.max(box.left, its.left), tall = Math.min(box.bottom, its.bottom) - Math.max(box.top, its.top);
    if (wide > 1 && tall > 4) faults.push(text + " lies over " + other);
  }
});
if (panel.scrollWidth > panel.clientWidth) faults.push("the panel is too wide");
if (place.right > innerWidth || document.documentElement.scrollWidth > innerWidth) faults.push("the page is too wide");
document.body.dataset.layout = JSON.stringify({faults, texts: texts.length, view: [view.width, view.height]});
}</script>"""


class View(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="bin_scenes_view_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "models").mkdir()
        box_stl(self.folder / "models/box.stl", (30, 40, 50))
        box_stl(self.folder / "models/bar.stl", (80, 20, 20))
        self.scene = self.folder / "out/scene_000000"

    def run_tool(self, *words, code=0, **environment):
        done = subprocess.run([TOOL, *map(str, words)], cwd=self.folder, capture_output=True, text=True,
                              env=dict(os.environ, LP_NUM_THREADS="0", **environment))
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def make(self, formats, sensors=SENSORS, more=""):
        text = REQUEST % sensors if sensors else REQUEST.partition("sensors")[0]
        text += more
        (self.folder / "request.yaml").write_text(text.replace("model: b", "model: models/b"))
        self.run_tool("generate", "request.yaml", "--out", "out", "--formats", formats, "--overwrite")

    def view(self, *options):
        self.run_tool("view", self.scene, *options)
        return (self.scene / "view.html").read_text()

    def data(self, page):
        return json.loads(re.search(r'type="application/json">(.*?)</script>', page, re.S)[1].replace("<\\/", "</"))

    def refused(self, words, *parts, code=2, **environment):
        error = self.run_tool("view", *words, code=code, **environment).stderr
        self.assertEqual(error.count("\n"), 1, error)
        for part in parts:
            self.assertIn(part, error)

    def browse(self, *options, at=""):
        command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                   "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=8000",
                   "--hide-scrollbars", "--user-data-dir=%s" % (self.folder / "profile"), *options,
                   "file://%s%s" % (self.scene / "view.html", at)]
        return subprocess.run(command, capture_output=True, text=True, timeout=300).stdout

    def picture(self, at):
        """What the page shows, left of the panel."""
        path = self.folder / "picture.png"
        self.browse("--window-size=%d,480" % (640 + PANEL), "--screenshot=%s" % path, at=at)
        return numpy.asarray(Image.open(path).convert("RGB"))[:, :-PANEL]

    def image(self, name):
        return numpy.asarray(Image.open(self.scene / name)).astype(int)

    def test_the_page_holds_everything_itself(self):
        self.make("json,png,ply")
        page = self.view()
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:)[^"]*"', page), [])
        data = self.data(page)
        self.assertEqual(len(data["parts"]), 10)
        self.assertEqual(len(data["meshes"]), 2)
        vertices = numpy.frombuffer(base64.b64decode(data["meshes"][0]["vertices"]), "<f4").reshape(-1, 3)
        self.assertLess(numpy.abs(vertices.max(0) - vertices.min(0) - [0.03, 0.04, 0.05]).max(), 1e-8)
        self.assertEqual([cloud["source"] for cloud in data["clouds"]], ["camera.ply", "side.ply"])
        self.assertEqual(data["report"], json.loads((self.scene / "scene.json").read_text())["report"])

    def test_the_best_free_grasps_of_different_parts(self):
        sensors = SENSORS + "\ngrippers: [cup_10mm, {name: two, stroke: 0.06}]"
        self.make("json,grasps", sensors)
        page = self.view()
        data, told = self.data(page), json.loads((self.scene / "grasps.json").read_text())
        free = [grasp for grasp in told["grasps"] if grasp["free"]]
        self.assertEqual(len(data["grasps"]), min(10, len(free)))
        self.assertGreater(len(free), 0)
        self.assertEqual(len({g["part"] for g in data["grasps"]}), min(10, len({g["part"] for g in free})))
        self.assertEqual(data["grasps"][0]["score"], max(g["score"] for g in free))
        self.assertEqual([g["name"] for g in data["grippers"]], ["cup_10mm", "two"])
        for row in data["counts"]:
            of_gripper = [grasp for grasp in told["grasps"] if grasp["gripper"] == row["gripper"]]
            self.assertEqual(sum(v for k, v in row.items() if k != "gripper"), len(of_gripper))
            self.assertEqual(row["free"], sum(grasp["free"] for grasp in of_gripper))
            self.assertEqual(row["approach"], sum(grasp["reason"].endswith(": approach") for grasp in of_gripper))
        if CHROMIUM:
            self.assertIn('data-grasps="%d"' % len(data["grasps"]), self.browse("--dump-dom"))
            for width in (1400, 700):
                self.check_layout(width)

    def check_layout(self, width, at=""):
        """No text of the panel is cut off or lies over another text, and the view has a place beside or above it."""
        page = self.scene / "view.html"
        whole = page.read_text()
        page.write_text(whole.replace("</body>", LAYOUT + "</body>"))
        dom = self.browse("--window-size=%d,900" % width, "--dump-dom", at=at)
        page.write_text(whole)
        layout = json.loads(html.unescape(re.search(r'data-layout="([^"]*)"', dom)[1]))
        self.assertEqual(layout["faults"], [], "%d px" % width)
        self.assertGreater(layout["texts"], 20)
        self.assertGreaterEqual(min(layout["view"]), 300, "the view is too small at %d px" % width)
        if KEEP:
            self.browse("--window-size=%d,900" % width, "--screenshot=%s" % KEEP.replace(".png", "_%d.png" % width), at=at)

    def cloud(self, page):
        cloud = self.data(page)["clouds"][0]
        unpacked = {key: numpy.frombuffer(base64.b64decode(cloud[key]), kind) for key, kind in
                    (("points", "<f4"), ("labels", "<u2"), ("validity", "u1"), ("errors", "<f4")) if key in cloud}
        unpacked["points"] = unpacked["points"].reshape(-1, 3)
        return cloud["source"], unpacked

    def test_clouds_of_all_files_are_the_same(self):
        self.make("json,png,ply,pcd")
        shown = {}
        for name in ("ply", "pcd", "png"):
            source, shown[name] = self.cloud(self.view())
            self.assertEqual(source, "camera." + name if name != "png" else "camera_depth.png")
            for path in self.scene.glob("*." + name):
                path.unlink()
        for name in ("pcd", "png"):
            for key in ("labels", "validity"):
                self.assertTrue((shown[name][key] == shown["ply"][key]).all(), key)
            # 0.5 counts of 0.01 mm, and float
            self.assertLess(numpy.abs(shown[name]["points"] - shown["ply"]["points"]).max(), 7e-6)
        self.assertTrue((shown["pcd"]["errors"][shown["pcd"]["validity"] == 0] ==
                         shown["ply"]["errors"][shown["ply"]["validity"] == 0]).all())

    def test_points_lie_where_sensor_and_truth_say(self):
        self.make("json,png,ply")
        _, cloud = self.cloud(self.view())
        depth, truth = self.image("camera_depth.png"), self.image("camera_truth_depth.png")
        valid = self.image("camera_validity.png")
        sensor = json.loads((self.scene / "scene.json").read_text())["sensors"][0]
        scale, height = sensor["depth_scale"], sensor["pose"]["position"][2]
        self.assertEqual(sensor["pose"]["orientation_xyzw"], [1, 0, 0, 0], "it looks straight down")
        there = (depth > 0) | (truth > 0)
        self.assertEqual(len(cloud["points"]), there.sum())
        shown = numpy.where(depth > 0, depth, truth)[there] * scale
        self.assertLess(numpy.abs(height - cloud["points"][:, 2] - shown).max(), scale)
        self.assertTrue((cloud["validity"] == valid[there]).all())
        self.assertTrue((cloud["labels"] == self.image("camera_labels.png")[there]).all())
        errors = numpy.where(depth > 0, (depth - truth) * scale, numpy.nan)[there]
        self.assertTrue((numpy.isnan(errors) == numpy.isnan(cloud["errors"])).all())
        self.assertLess(numpy.nanmax(numpy.abs(errors - cloud["errors"])), 1.1 * scale)
        self.assertGreater(numpy.nanmedian(numpy.abs(cloud["errors"])), 0, "structured light is noisy")

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_a_browser_shows_parts_where_the_labels_say(self):
        self.make("json,png,ply")
        self.view()
        dom = self.browse("--dump-dom")
        self.assertIn('data-ready="yes"', dom, "the page's script did not reach its end")
        self.assertIn('data-drawn="10"', dom)
        seen = set(self.image("camera_labels.png").flat) | set(self.image("side_labels.png").flat)
        self.assertIn('data-labels="%d"' % len(seen - {0}), dom)
        self.assertIn("penetration.median", dom)

        labels = self.image("camera_truth_labels.png").repeat(4, 0).repeat(4, 1)  # the view is 640 x 480
        inside = labels.copy()
        for shift in ((0, 6), (0, -6), (6, 0), (-6, 0)):  # away from borders
            inside[numpy.roll(labels, shift, (0, 1)) != labels] = 0
        picture = self.picture("#through=camera&colour=none")
        for label in set(labels.flat) - {0}:
            colours = picture[inside == label]
            if len(colours) < 30:
                continue
            hues = numpy.array([colorsys.rgb_to_hsv(*(c / 255))[0] for c in colours])
            wrong = numpy.abs((hues - 0.08 - (label - 1) * 0.618034 + 0.5) % 1 - 0.5) > 0.03
            self.assertLess(wrong.mean(), 0.02, "part %d is not where it has to be" % (label - 1))
        self.assertGreater((inside > 0).mean(), 0.05)
        outside = picture[(labels == 0) & (numpy.arange(480) > 0)[:, None]]
        saturation = (outside.max(1).astype(int) - outside.min(1)) / numpy.maximum(outside.max(1), 1)
        self.assertLess((saturation > 0.25).mean(), 0.02, "colours of parts where there are none")
        if KEEP:
            self.browse("--window-size=1280,860", "--screenshot=%s" % KEEP, at="#colour=error")

    def test_parts_have_the_colours_of_the_picture(self):
        self.make("json,png", sensors="  - {name: camera, width: 160, height: 120, fov: 0.6}")
        labels, picture = self.image("camera_truth_labels.png"), self.image("camera.png")
        inside = labels.copy()
        for axis in (0, 1):  # without outlines
            for shift in (1, -1):
                inside[numpy.roll(labels, shift, axis) != labels] = 0
        compared = 0
        for part in self.data(self.view())["parts"]:
            shown = picture[inside == part["id"] + 1]
            if len(shown) < 20:
                continue
            compared += 1
            colour = numpy.array([int(part["colour"][i:i + 2], 16) for i in (1, 3, 5)])
            brightest = shown[shown.max(1).argmax()]  # the picture shades by brightness alone, in whole levels
            self.assertLess(numpy.abs(brightest / brightest.max() - colour / colour.max()).max(), 2 / brightest.max(), part["id"])
        self.assertGreater(compared, 5)

    def test_a_table_is_shown_at_its_height(self):
        self.make("json", sensors="  - {name: camera, width: 64, height: 48, pose: [0, 0, 1, 1, 0, 0, 0], fov: 1.0}", more=TABLE)
        data = self.data(self.view())
        table = json.loads((self.scene / "scene.json").read_text())["table"]
        self.assertEqual((table["height"], table["surface"]["albedo"]), (-0.005, 0.3))
        self.assertEqual(data["table"]["height"], -0.005)
        if not CHROMIUM:
            return
        plain = "#through=camera&colour=none&frusta=0&grasps=0&bin=0&parts=0"
        hidden, shown = self.picture(plain + "&table=0"), self.picture(plain)
        self.assertEqual(len(numpy.unique(hidden.reshape(-1, 3), axis=0)), 1)
        drawn = (shown != hidden).any(2)
        # A square of 2 * 1.5 * 0.24 m, seen from 1.005 m; 480 rows show 2 * tan(0.5) * 48 / 64 at a distance of 1.
        rows = 0.72 / 1.005 * 480 / (2 * numpy.tan(0.5) * 48 / 64)
        self.assertAlmostEqual(drawn.any(1).sum() / rows, 1.0, delta=0.02)
        self.assertGreater(drawn[240, 320 - int(rows / 2) + 5:320 + int(rows / 2) - 5].mean(), 0.99)
        self.make("json", sensors="", more="")
        self.assertNotIn("table", self.data(self.view()))

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_nothing_is_cut_off_in_narrow_and_wide_windows(self):
        long_name = "camera_with_a_name_that_is_longer_than_its_panel_is_wide"
        sensors = SENSORS.replace("name: side", "name: " + long_name) + "\ngrippers: [cup_10mm]"
        text = (REQUEST % sensors).replace("model: b", "model: models/b").replace("bullet", "sphere, sphere: {device: cpu}")
        (self.folder / "request.yaml").write_text(text + TABLE)
        self.run_tool("generate", "request.yaml", "--out", "out", "--formats", "json,png,ply,grasps", "--trace", "heap.jsonl",
                      "--trace-rate", "5")
        self.view("--trace", "heap.jsonl")
        for width in (1400, 700):
            for colouring in ("depth", "validity"):
                self.check_layout(width, "#colour=" + colouring)

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_a_browser_shows_the_cloud_in_each_colouring(self):
        self.make("json,png,ply")
        self.view()
        empty = self.picture("#through=camera&parts=0&bin=0&colour=none")
        self.assertEqual(len(numpy.unique(empty.reshape(-1, 3), axis=0)), 1, "nothing is to be seen")
        pictures = [self.picture("#through=camera&parts=0&bin=0&sensor=camera&colour=" + way)
                    for way in ("depth", "label", "validity", "error")]
        measured = (self.image("camera_depth.png") > 0).repeat(4, 0).repeat(4, 1)
        for picture in pictures:
            drawn = (picture != empty[0, 0]).any(2)
            # points of 2.5 pixels, one every 4 pixels
            self.assertGreater(drawn[measured].mean(), 0.2)
        of_parts = (self.image("camera_labels.png") > 0).repeat(4, 0).repeat(4, 1)
        drawn = (self.picture("#through=camera&parts=0&bin=0&sensor=camera&labelled=1") != empty[0, 0]).any(2)
        self.assertGreater(drawn[of_parts].mean(), 0.2)
        self.assertLess(drawn[~of_parts].mean(), 0.02)
        for i, a in enumerate(pictures):
            for b in pictures[:i]:
                self.assertGreater((a != b).any(2)[measured].mean(), 0.05)

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_a_browser_shows_the_cameras(self):
        self.make("json")
        self.view()
        picture = self.picture("#parts=0&bin=0")
        hidden = self.picture("#parts=0&bin=0&frusta=0")
        self.assertEqual(len(numpy.unique(hidden.reshape(-1, 3), axis=0)), 1)
        drawn = picture[(picture != hidden).any(2)] / 255
        for hue in (0.58, 0.961):  # of the first and the second sensor
            near = [abs((colorsys.rgb_to_hsv(*rgb)[0] - hue + 0.5) % 1 - 0.5) < 0.05 for rgb in drawn]
            self.assertGreater(sum(near), 200)

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_a_scene_without_sensors_is_a_page_without_cloud(self):
        self.make("json", sensors="")
        done = self.run_tool("view", self.scene / "scene.json", "--out", self.scene / "view.html")
        self.assertIn("no cloud, since the scene has no sensors", done.stderr)
        dom = self.browse("--dump-dom")
        self.assertIn('data-ready="yes"', dom)
        self.assertIn('data-drawn="10"', dom)
        self.assertIn('data-labels="0"', dom)

    def test_a_bin_that_is_a_mesh_and_a_laser_are_shown(self):
        box_stl(self.folder / "models/slab.stl", (300, 300, 10))
        (self.folder / "request.yaml").write_text("""bin: {mesh: models/slab.stl, unit: mm, pose: [0, 0, -0.005, 0, 0, 0, 1]}
solver: {type: bullet}
parts: [{model: models/box.stl, unit: mm, scale: 0.5, count: 1, poses: [[0, 0, 0.013, 0, 0, 0, 1]]}]
pour: {pattern: given}
sensors:
  - {name: laser, model: laser_line, width: 160, height: 120, fov: 0.6, scan: {direction: [1, 0, 0], step: 0.004, profiles: 50}}
""")
        self.run_tool("generate", "request.yaml", "--out", "out", "--formats", "json,png,ply")
        page = self.view()
        shape = self.data(page)["bin"]["shape"]
        vertices = numpy.frombuffer(base64.b64decode(shape["vertices"]), "<f4").reshape(-1, 3)
        self.assertLess(numpy.abs(vertices.max(0) - [0.15, 0.15, 0.005]).max(), 1e-8)
        source, cloud = self.cloud(page)
        self.assertEqual(source, "laser.ply")
        self.assertNotIn("errors", cloud, "its true depth is no image of profiles")
        floor = cloud["points"][cloud["labels"] == 0]
        self.assertGreater(len(floor), 100)
        self.assertLess(numpy.median(numpy.abs(floor[:, 2])), 0.001)
        for path in self.scene.glob("laser.ply"):
            path.unlink()
        self.assertEqual(self.data(self.view())["clouds"], [], "profiles are no image of rays")

    def test_models_are_found_by_their_bytes(self):
        self.make("json")
        self.assertIn("no file of one is there", self.run_tool("view", self.scene).stderr)
        shutil.move(self.folder / "models", self.folder / "elsewhere")
        self.refused([self.scene], "models/box.stl", "not found beside or above the scene", "--models DIR")
        self.refused([self.scene, "--models", "out"], "models/box.stl", "out", "--models DIR")
        self.view("--models", "elsewhere")
        box_stl(self.folder / "elsewhere/bar.stl", (90, 20, 20))
        self.refused([self.scene, "--models", "elsewhere"], "bar.stl", "has changed since the scene was made")

    def test_the_page_beside_a_scene_changes_nothing(self):
        self.make("json")
        self.view()
        before = (self.scene / "scene.json").stat().st_mtime_ns
        self.run_tool("generate", "request.yaml", "--out", "out", "--formats", "json", "--verify")
        self.assertEqual((self.scene / "scene.json").stat().st_mtime_ns, before, "made anew")
        self.assertTrue((self.scene / "view.html").exists())

    def traced(self, *options):
        """The scene with its trace, 50 samples a second, by the default solver; returns the samples."""
        text = (REQUEST % SENSORS).replace("model: b", "model: models/b").replace("bullet", "sphere, sphere: {device: cpu}")
        (self.folder / "request.yaml").write_text(text)
        self.run_tool("generate", "request.yaml", "--out", "out", "--overwrite", "--trace", "heap.jsonl",
                      "--trace-rate", "50", *options)
        lines = [json.loads(line) for line in (self.folder / "heap.jsonl").read_text().splitlines()]
        self.assertEqual(lines[0]["format"], "bin_scenes/trace/1")
        return lines[0]["weight"], lines[1:]

    def test_a_trace_ends_where_the_scene_is_and_its_forces_carry_the_heap(self):
        weight, samples = self.traced()
        self.assertAlmostEqual(weight, min(0.03 * 0.04 * 0.05, 0.08 * 0.02 * 0.02) * 1000 * 9.81, 6)
        data = self.data(self.view("--trace", "heap.jsonl"))
        trace, parts = data["trace"], data["parts"]
        self.assertEqual(trace["times"], [sample["time"] for sample in samples])
        self.assertEqual(trace["ids"], [part["id"] for part in parts])
        unpacked = {key: numpy.frombuffer(base64.b64decode(trace[key]), kind) for key, kind in
                    (("poses", "<f4"), ("contacts", "<f4"), ("actions", "u1"), ("pairs", "<i4"))}
        poses = unpacked["poses"].reshape(len(samples), len(parts), 7)
        last = numpy.array([part["pose"]["position"] + part["pose"]["orientation_xyzw"] for part in parts])
        self.assertLess(numpy.abs(poses[-1] - last).max(), 1e-6)
        inside = (~numpy.isnan(poses[:, :, 0])).sum(1)
        self.assertLess(inside[0], 10, "parts come in one after the other")
        self.assertEqual(list(inside), [len(sample["parts"]) for sample in samples])
        self.assertEqual(trace["counts"], [len(sample["contacts"]) for sample in samples])

        contacts, pairs = unpacked["contacts"].reshape(-1, 9), unpacked["pairs"].reshape(-1, 2)
        at_rest = slice(sum(trace["counts"][:-1]), None)
        self.assertEqual(set(unpacked["actions"][at_rest]), {0}, "all contacts rest at the end")
        self.assertEqual(trace["action_names"], ["resting", "sliding", "pushed apart", "impact"])
        self.assertGreater(len(set(unpacked["actions"])), 2, "parts hit each other and slide before they rest")
        # What a part gets from its contacts carries it: closed form of the rest.
        forces = numpy.zeros((len(parts), 3))
        for (a, b), contact in zip(pairs[at_rest], contacts[at_rest]):
            forces[a] -= contact[6:]
            if b >= 0:
                forces[b] += contact[6:]
        for part, force in zip(parts, forces):
            own = 1000 * 9.81 * (0.03 * 0.04 * 0.05 if "box" in part["model"] else 0.08 * 0.02 * 0.02)
            self.assertLess(numpy.linalg.norm(force - [0, 0, own]), 2e-3 * own, part["id"])

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_a_browser_shows_a_trace_at_any_time(self):
        _, samples = self.traced()
        self.view("--trace", "heap.jsonl")
        early = next(i for i, sample in enumerate(samples) if sample["contacts"])
        self.assertLess(len(samples[0]["parts"]), len(samples[early]["parts"]))
        for i in (0, early, len(samples) - 1):
            dom = self.browse("--dump-dom", at="#time=%d" % i)
            self.assertIn('data-ready="yes"', dom)
            self.assertIn('data-present="%d"' % len(samples[i]["parts"]), dom)
            self.assertIn('data-contacts="%d"' % len(samples[i]["contacts"]), dom)
            self.assertEqual(float(re.search(r'data-time="([^"]*)"', dom)[1]), samples[i]["time"])
        plain = "#through=camera&colour=none&frusta=0&grasps=0&contacts=0"
        first, last = self.picture(plain + "&time=%d" % early), self.picture(plain)
        self.assertGreater((first != last).any(2).mean(), 0.01, "the slider moves the parts")
        self.assertTrue((last == self.picture(plain + "&time=%d" % (len(samples) - 1))).all(), "it begins at the end")
        shown = self.picture(plain.replace("contacts=0", "contacts=1"))
        drawn = shown[(shown != last).any(2)]
        self.assertGreater(len(drawn), 100)
        green = numpy.abs(drawn.astype(int) - [0x2a, 0x9d, 0x55]).max(1) < 8
        self.assertGreater(green.sum(), 50, "points of contacts that rest")
        if KEEP:
            for name, i in (("early", early), ("last", len(samples) - 1)):
                self.browse("--window-size=1280,860", "--screenshot=%s" % KEEP.replace(".png", "_%s.png" % name),
                            at="#colour=none&frusta=0&time=%d" % i)

    def test_a_bad_trace_is_one_clear_error(self):
        weight, samples = self.traced()
        file = self.folder / "heap.jsonl"
        whole = file.read_text()
        self.refused([self.scene, "--trace", "nowhere.jsonl"], "nowhere.jsonl", "there is no such trace")
        for text, part in (("", "is no trace"), ("time,id,x\n", "is damaged"), (whole.partition("\n")[0], "holds no sample"),
                           (whole[:-20], "is damaged"), (whole.replace('"parts"', '"part"'), "is no trace"),
                           ('{"format": "bin_scenes/trace/2"}\n', "is no trace"),
                           (whole.partition("\n")[0] + '\n{"time": 0, "parts": [], "contacts": []}', "another scene")):
            file.write_text(text)
            self.refused([self.scene, "--trace", "heap.jsonl"], "heap.jsonl", part, "--trace FILE.jsonl")

    def test_bad_input_is_one_clear_error(self):
        self.make("json,ply")
        self.refused(["nowhere"], "nowhere", "there is no scene", "scene.json")
        self.refused([self.folder], "there is no scene")
        self.refused([self.scene], "three.js", "libjs-three", code=3, BIN_SCENES_THREE="/nowhere")
        cloud = self.scene / "camera.ply"
        whole = cloud.read_bytes()
        for broken in (b"", whole[:200], whole[:-1], whole + b"x", whole.replace(b"num_cols 160", b"num_cols 99999999999"),
                       struct.pack("<4f", 1, 2, 3, 4)):
            cloud.write_bytes(broken)
            self.refused([self.scene], "camera.ply")
        cloud.write_bytes(whole)
        file = self.scene / "scene.json"
        scene = json.loads(file.read_text())

        def without(change):
            broken = json.loads(json.dumps(scene))
            change(broken)
            file.write_text(json.dumps(broken))
            self.refused([self.scene], "scene.json")
        without(lambda s: s["sensors"][0].pop("K"))
        without(lambda s: s["sensors"][0]["K"].pop())
        without(lambda s: s.pop("models"))
        without(lambda s: s["parts"][0].update(line=7))
        without(lambda s: s["parts"][0].update(pose=3))
        without(lambda s: s.pop("bin"))
        scene["models"][0].pop("unit")  # as version 0.2 wrote it
        file.write_text(json.dumps(scene))
        self.refused([self.scene], "box.stl", "earlier version", "make the scene anew")
        file.write_text("{")
        self.refused([self.scene], "scene.json", "incomplete")


if __name__ == "__main__":
    unittest.main()
