#!/usr/bin/env python3
"""`bin_scenes dataset`: plans and their errors, repeatability whatever happens on the way, depletion, retries.

    dataset_test.py TOOL
"""
import json
import os
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import time

import data_set
from data_set import DataSetTest, box_stl, children, processor_time


class Plans(DataSetTest):
    def errors(self, text):
        (self.folder / "bad.yaml").write_text(text)
        done = self.make("bad.yaml", "out", code=2)
        self.assertFalse((self.folder / "out").exists())
        return done.stderr.splitlines()

    def test_all_errors_are_told_at_once_with_their_lines(self):
        lines = self.errors("""seed: -1
scenes: 2
outputs: [json, exr]
request:
  bin: {inner_sise: [0.2, 0.2, 0.2]}
  parts: [{model: box.stl, count: many}]
draw:
  parts[0].friction: {uniform: [0.5, 0.2]}
  parts[0].density: {normal: [1000]}
colour: red
""")
        for line, words in ((1, "seed"), (3, "exr"), (5, "inner_sise"), (6, "count"), (8, "minimum is above"),
                            (9, "normal needs"), (10, "colour")):
            found = [text for text in lines if "bad.yaml:%d: " % line in text and words in text]
            self.assertEqual(len(found), 1, "line %d, '%s':\n%s" % (line, words, "\n".join(lines)))
        self.assertEqual(len(lines), 7, lines)

    def test_ranges_that_cannot_be_are_found_before_the_first_scene(self):
        lines = self.errors("""scenes: 2
request: {parts: [{model: box.stl}]}
draw:
  parts[0].friction: {uniform: [-0.5, 0.2]}
  parts[0].cuont: {choice: [1, 2]}
  parts[0].model: {choice: [box.stl, missing.stl]}
  pour.finish: {choice: [settled, perfect]}
""")
        for line, words in ((4, "-0.5"), (5, "count"), (6, "missing.stl"), (7, "perfect")):
            self.assertEqual(len([t for t in lines if "bad.yaml:%d: " % line in t and words in t]), 1, "\n".join(lines))

    def test_a_count_is_not_drawn_and_set_by_amount(self):
        text = """scenes: 1
request: {parts: [{model: box.stl%s}, {model: bar.stl}]}
draw: {'parts[0].count': {choice: [1]}}
amount: {parts: 3}
"""
        lines = self.errors(text % "")
        self.assertIn("bad.yaml:3: 'draw.parts[0].count': amount sets this value as well (remove one of both)", "\n".join(lines))
        self.assertEqual(len(lines), 1, lines)
        (self.folder / "fixed.yaml").write_text(text % ", fixed: true, poses: [[0, 0, 0.1, 0, 0, 0, 1]]")  # which amount leaves alone
        self.make("fixed.yaml", "out")

    def test_symmetries_of_no_model_of_the_plan_are_refused(self):
        (self.folder / "parts").mkdir()
        (self.folder / "box.stl").rename(self.folder / "parts/box.stl")
        text = "scenes: 1\noutputs: [bop]\nrequest: {parts: [{model: parts/box.stl}], sensors: [{name: camera}]}\nbop: {symmetries: %s}\n"
        turn = "{continuous: [[0, 0, 1]]}"
        self.assertRegex(self.errors(text % ("{box.stl: %s}" % turn))[0], "bad.yaml:4: .*'box.stl' is no model.*'parts/box.stl'")
        self.assertRegex(self.errors(text % ("[%s]" % turn))[0], "bad.yaml:4: .*expected a map by model")

    def test_grasps_without_grippers_have_their_own_remedy(self):
        text = "scenes: 1\noutputs: [json, grasps]\nrequest: {parts: [{model: box.stl}], sensors: [{name: camera}]}\n"
        self.assertRegex(self.errors(text)[0], r"no grippers \(add for instance `grippers:")

    def test_a_choice_of_many_models_leaves_none_out(self):
        models = ["box_%02d.stl" % i for i in range(66)]
        for i, model in enumerate(models):
            box_stl(self.folder / model, (0.03, 0.04, 0.02 + 1e-4 * i))
        self.make(self.plan(scenes=1, outputs="bop", draw="  parts[0].model: {choice: [%s]}" % ", ".join(models)), "out")
        self.assertEqual(len(list((self.folder / "out/bop/models").glob("obj_*.ply"))), 2 + len(models))

    def test_a_folder_of_another_plan_or_of_something_else_is_refused(self):
        self.make(self.plan(scenes=1, outputs="json"), "out")
        other = self.plan(scenes=1, outputs="json", draw="  parts[1].friction: {uniform: [0.3, 0.7]}", name="other.yaml")
        self.assertIn("another plan", self.make(other, "out", code=2).stderr)
        facts = self.folder / "out/dataset.json"
        facts.write_text(facts.read_text().replace('"version": "', '"version": "9.'))
        self.assertIn("version 9.", self.make("plan.yaml", "out", code=2).stderr)
        (self.folder / "full").mkdir()
        (self.folder / "full/thesis.txt").write_text("mine")
        self.assertIn("no data set", self.make("plan.yaml", "full", code=2).stderr)
        self.assertIn("not a directory", self.make("plan.yaml", "plan.yaml", code=2).stderr)
        self.assertIn("--shard", self.make("plan.yaml", "out2", "--shard", "3/2", code=2).stderr)
        self.run_tool("dataset", "plan.yaml", code=2)

    def test_a_folder_goes_on_elsewhere_but_not_with_other_files(self):
        box_stl(self.folder / "floor.stl", (0.3, 0.3, 0.01))

        def made(picture):
            (self.folder / "sky.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + picture)
        made(b"\x40\x40\x40\x81" * 2)
        (self.folder / "plan.yaml").write_text("""scenes: 1
outputs: [json, png]
request:
  bin: {mesh: floor.stl, unit: m}
  solver: {type: bullet}
  pour: {pattern: given}
  parts: [{model: box.stl, poses: [[0, 0, 0.04, 0, 0, 0, 1]]}]
  sensors: [{name: camera, model: image, width: 32, height: 24, lamps: [{type: dome, picture: sky.hdr}]}]
""")
        self.make("plan.yaml", "out")
        moved = self.folder.parent / (self.folder.name + "_moved")
        self.addCleanup(shutil.rmtree, moved, True)
        shutil.copytree(self.folder, moved)
        self.make(moved / "plan.yaml", moved / "out")
        made(b"\x80\x40\x40\x81" * 2)
        self.assertIn("another plan", self.make("plan.yaml", "out", code=2).stderr)

    def test_a_request_file_keeps_its_own_keys_to_itself(self):
        (self.folder / "request.yaml").write_text("seed: 7\nscenes: 5\nparts: [{model: box.stl, count: 2}]\nsolver: {type: bullet}\n")
        (self.folder / "plan.yaml").write_text("seed: 3\nscenes: 1\nrequest: request.yaml\n")
        done = self.make("plan.yaml", "out")
        self.assertEqual([line.split(" of ")[0] for line in done.stderr.splitlines()],
                         ["bin_scenes: note: 'seed'", "bin_scenes: note: 'scenes'"])
        self.assertEqual(json.loads((self.folder / "out/scenes/scene_000000/scene.json").read_text())["seed"], 3)

    def test_a_request_is_no_plan(self):
        self.assertIn("not a plan of a data set", self.errors("parts: [{model: box.stl, count: 1}]\n")[0])

    def test_what_bop_cannot_hold_is_refused_before_the_first_scene(self):
        one, other = "{name: a, width: 32, height: 24}", "{name: b, model: laser_line, width: 32, height: 24}"
        lines = self.errors("""scenes: 2
outputs: [json, bop]
request: {parts: [{model: box.stl, count: 1}], sensors: [%s]}
draw:
  sensors: {choice: [[%s], [%s, {name: b, width: 32, height: 24}]]}
  sensors[0].model: {choice: [ideal, laser_line]}
""" % (one, one, one))
        for line, words in ((5, "same number of images"), (6, "laser_line")):
            self.assertEqual(len([t for t in lines if "bad.yaml:%d: " % line in t and words in t]), 1, "\n".join(lines))
        lines = self.errors("scenes: 2\noutputs: [shards]\nrequest: {parts: [{model: box.stl, count: 1}], sensors: [%s]}\n" % other)
        self.assertIn("laser_line", lines[0])
        bent = "{name: a, width: 32, height: 24, distortion: [-0.1, 0, 0, 0, 0]}"
        text = "scenes: 2\noutputs: [%s]\nrequest: {parts: [{model: box.stl, count: 1}], sensors: [%s]}\ndraw: {%s}\n"
        draw = "'sensors[0].distortion': {choice: [[0, 0, 0, 0, 0], [-0.1, 0, 0, 0, 0]]}"
        for plan in (text % ("bop", bent, ""), text % ("shards", bent, ""), text % ("shards", one, draw)):
            lines = self.errors(plan)
            self.assertEqual(len([t for t in lines if "distort" in t]), 1, "\n".join(lines))

    def test_a_mistyped_distribution_is_answered_with_those_there_are(self):
        text = "scenes: 2\nrequest: {parts: [{model: box.stl, count: 1}]}\ndraw: {'parts[0].friction': {%s: [0.3, 0.6]}}\n"
        self.assertRegex(self.errors(text % "unifrom")[0], "'unifrom'.*uniform.*normal.*choice")
        self.assertRegex(self.errors(text % "between")[0], "found a map.*uniform.*normal.*choice")
        (self.folder / "bad.yaml").write_text("scenes: 1\nrequest: {parts: [{model: box.stl}]}\namount: {parts: {unifrom: [2, 3]}}\n")
        self.assertRegex(self.make("bad.yaml", "out", code=2).stderr, "'unifrom'.*uniform")

    def test_a_disk_that_is_too_small_is_told_before_the_first_scene(self):
        # A billion scenes: what is looked through before is what is there, not what is asked for.
        (self.folder / "plan.yaml").write_text("""scenes: 1000000000
outputs: [png, bop, shards]
request: {parts: [{model: box.stl, count: 1}], sensors: [{name: camera, width: 4000, height: 3000}]}
""")
        done = self.make("plan.yaml", "out", code=3)
        self.assertRegex(done.stderr, r"need about [\d.]+ GB, [\d.]+ GB are free")
        self.assertEqual(list((self.folder / "out/scenes").iterdir()), [])

    def test_a_small_disk_has_figures_too(self):
        (self.folder / "small").mkdir()
        own = ["unshare", "--user", "--map-root-user", "--mount"]
        if subprocess.run(own + ["mount", "-t", "tmpfs", "tmpfs", self.folder / "small"], capture_output=True).returncode:
            self.skipTest("no file system can be mounted here")
        tool = self.command("dataset", self.plan(scenes=40), "--out", "small/out")
        done = subprocess.run(own + ["sh", "-c", 'mount -t tmpfs -o size=600k tmpfs small && exec "$@"', "sh"] + tool,
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 3, done.stderr)
        needed, free = map(float, re.search(r"need about ([\d.]+) MB, ([\d.]+) MB are free", done.stderr).groups())
        self.assertTrue(0.1 < free < 0.7 < needed, done.stderr)

    def test_draws_follow_their_distributions(self):
        self.make(self.plan(scenes=12, outputs="json"), "out", "--workers", 2)
        frictions, counts, distances = set(), [], []
        for path in sorted((self.folder / "out/scenes").iterdir()):
            text = (path / "request.yaml").read_text()
            scene = json.loads((path / "scene.json").read_text())
            frictions.update(line.split(":")[1] for line in text.splitlines() if line.startswith("    friction:"))
            counts.append(len(scene["parts"]))
            distances.append(sum(x * x for x in scene["sensors"][0]["pose"]["position"]) ** 0.5)
        self.assertGreater(len(frictions), 6)
        self.assertTrue(all(3 <= n <= 6 for n in counts) and len(set(counts)) > 2, counts)
        self.assertTrue(all(0.5 <= d <= 0.6 for d in distances), distances)

    def test_a_fill_goes_by_the_volume_of_the_models_drawn(self):
        # Of one file, at two scales that only differ after the sixth digit.
        box_stl(self.folder / "huge.stl", (1e5, 1e5, 1e5))
        (self.folder / "plan.yaml").write_text("""scenes: 6
outputs: [json]
request:
  bin: {inner_size: [0.24, 0.2, 0.15]}
  solver: {type: bullet}
  parts: [{model: huge.stl, count: 1}]
  sensors: [{name: camera, width: 32, height: 24}]
draw: {'parts[0].scale': {choice: [3.0e-7, 4.0e-7]}}
amount: {fill: 0.05}
""")
        self.make("plan.yaml", "out", "--workers", 1)
        counts = set()
        for path in (self.folder / "out/scenes").iterdir():
            scale = re.search("scale: (.*)", (path / "request.yaml").read_text()).group(1)
            counts.add((float(scale), len(json.loads((path / "scene.json").read_text())["parts"])))
        self.assertEqual(counts, {(3e-7, 14), (4e-7, 6)})


class Repeatability(DataSetTest):
    def test_workers_shares_kills_and_full_disks_change_no_byte(self):
        plan = self.plan(scenes=8)
        self.make(plan, "one", "--workers", 1)
        self.make(plan, "three", "--workers", 3)
        self.assert_same("one", "three")

        shares = ["share_%d" % i for i in range(3)]
        for i, share in enumerate(shares):
            self.make(plan, share, "--shard", "%d/3" % i, "--workers", 1)
        self.run_tool("dataset", "merge", *shares[:2], "--out", "merged", code=1)
        self.kill_at_random(5, 0.05, "dataset", "merge", *shares, "--out", "merged")
        self.run_tool("dataset", "merge", *shares, "--out", "merged")
        self.assert_same("one", "merged")

        # A limit of file sizes stands for a full disk: the write fails, the run ends with 3 and goes on later.
        for kilobytes in (8, 48):
            full = self.run_tool("dataset", plan, "--out", "full", "--workers", 2, before="ulimit -f %d;" % kilobytes, code=3)
            self.assertEqual(full.stderr.count("\n"), 1, full.stderr)
        self.make(plan, "full")
        self.assert_same("one", "full")

        self.kill_at_random(8, 0.5, "dataset", plan, "--out", "killed", "--workers", 2)
        self.make(plan, "killed")
        self.assert_same("one", "killed")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "killed").stdout)

    def kill_at_random(self, kills, whole, *words):
        """SIGKILL for the process, or for one of its workers, at instants drawn from `whole` processor seconds."""
        dice = random.Random(7)
        for _ in range(kills):
            process = subprocess.Popen(self.command(*words), cwd=self.folder, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            limit = dice.uniform(0.0, whole)
            while process.poll() is None and processor_time(process.pid) < limit:
                time.sleep(0.002)
            victims = [process.pid] + children(process.pid)
            try:
                os.kill(dice.choice(victims), signal.SIGKILL)
            except ProcessLookupError:
                pass
            time.sleep(0.05)
            process.kill()
            process.wait()

    def test_the_index_is_made_again_from_the_scenes(self):
        plan = self.plan(scenes=3, outputs="json")
        self.make(plan, "out")
        (self.folder / "out/index.sqlite").unlink()
        before = {p: os.stat(p).st_mtime_ns for p in (self.folder / "out/scenes").rglob("scene.json")}
        self.make(plan, "out")
        self.assertEqual(before, {p: os.stat(p).st_mtime_ns for p in (self.folder / "out/scenes").rglob("scene.json")})
        with sqlite3.connect(self.folder / "out/index.sqlite") as index:
            self.assertEqual(index.execute("select count(*), min(verdict) from scenes").fetchone(), (3, "accepted"))

    def test_sigint_ends_with_130_and_the_run_goes_on_later(self):
        plan = self.plan(scenes=40, outputs="json")
        process = subprocess.Popen(self.command("dataset", plan, "--out", "out", "--workers", 2), cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        scenes = self.folder / "out/scenes"
        while not (scenes.is_dir() and any(not p.name.startswith(".") for p in scenes.iterdir())):
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual([p.name for p in scenes.iterdir() if p.name.startswith(".")], [])
        done = self.make(plan, "out", "--json-progress")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual((lines[-1]["accepted"], lines[-1]["finished"]), (40, True))


class Heaps(DataSetTest):
    def test_rejected_attempts_are_kept_apart_and_made_again(self):
        draw = "  pour: {choice: [{limit: 0.05, rest_window: 0.04}, {limit: 20}]}"
        plan = self.plan(scenes=6, outputs="json", draw=draw)
        self.make(plan, "out", code=None)
        apart = sorted((self.folder / "out/set_apart").iterdir())
        self.assertGreater(len(apart), 1)
        for path in apart:
            self.assertIn("rest", (path / "reasons.txt").read_text())
            self.assertIn("limit: 0.05", (path / "request.yaml").read_text())
        self.make(plan, "again", "--workers", 1, code=None)
        self.assert_same("out", "again")
        self.assertEqual(self.run_tool("dataset", "verify", "out", code=None).stdout.count("rejected_kept:"), 0)

    def test_depletion_takes_the_highest_parts_out(self):
        plan = self.plan(scenes=2, outputs="json, bop", more="depletion: {steps: 2, take: 1}")
        self.make(plan, "out")
        scenes = [json.loads((self.folder / ("out/scenes/scene_%06d/scene.json" % i)).read_text()) for i in range(6)]
        for heap in (0, 3):
            before = scenes[heap]
            for step in (1, 2):
                after = scenes[heap + step]
                self.assertEqual(after["index"], heap + step)
                gone = [p["id"] for p, q in zip(after["parts"], before["parts"])
                        if p["state"] == "removed" and q["state"] != "removed"]
                there = [p for p in before["parts"] if p["pose"]]
                highest = max(there, key=lambda p: p["pose"]["position"][2])
                self.assertEqual(gone, [highest["id"]])
                before = after
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "out").stdout)


if __name__ == "__main__":
    data_set.main()
