#!/usr/bin/env python3
"""`bin_scenes dataset` where something is wrong with the plan or the machine: what it says, and how soon.

    faults_test.py TOOL
"""
import json
import os
import signal
import sqlite3
import subprocess
import time

import data_set
from data_set import DataSetTest, children


class Faults(DataSetTest):
    def write(self, text):
        (self.folder / "plan.yaml").write_text(text)
        return "plan.yaml"

    def heaps_set_apart(self):
        return {path.name.split("_attempt_")[0] for path in (self.folder / "out/set_apart").iterdir()}

    def test_a_fault_that_no_draw_cures_ends_the_run_at_once(self):
        up = "sensors: [{name: camera, width: 32, height: 24, pose: [0, 0, 0.6, 0, 0, 0, 1]}]"
        for request, words in (("{parts: [{model: box.stl, scale: 1000, count: 2}]}", "too large"),
                               ("{parts: [{model: box.stl, count: 2}], solver: {type: bullet}, %s}" % up, "looks away from the bin")):
            for attempts in (1, 3):
                with self.subTest(words=words, attempts=attempts):
                    plan = self.write("scenes: 30\nattempts: %d\noutputs: [png]\nrequest: %s\n"
                                      "draw: {'parts[0].friction': {uniform: [0.3, 0.6]}}\n" % (
                                          attempts, request if "sensors" in request else request[:-1] + ", sensors: [{name: camera, width: 32, height: 24}]}"))
                    done = self.make(plan, "out", "--workers", 1, code=2)
                    self.assertIn(words, done.stderr)
                    self.assertIn("two draws", done.stderr)
                    self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
                    self.assertLessEqual(self.heaps_set_apart(), {"scene_000000"})
                    self.run_tool("dataset", plan, "--out", "out", code=2)  # and again: nothing was learnt
                subprocess.run(["rm", "-r", str(self.folder / "out")], check=True)

    def test_parts_that_find_no_room_are_counted_and_refused(self):
        text = """scenes: 3
request: {bin: {inner_size: [0.1, 0.1, 0.06]}, solver: {type: bullet}, parts: [{model: box.stl}]}
amount: {parts: %s}
%s"""
        done = self.make(self.write(text % (150, "")), "out", "--workers", 1, code=2)
        self.assertRegex(done.stderr, r"\d+ of 150 parts found no room, more than 5 %")
        self.assertIn("amount", done.stderr)
        deep = (text % ("{uniform: [2, 30]}", "attempts: 1\n")).replace("0.06]", "0.15]").replace("scenes: 3", "scenes: 5")
        self.make(self.write("seed: 2\n" + deep), "some", "--workers", 1, code=1)
        apart = list((self.folder / "some/set_apart").glob("*/reasons.txt"))
        self.assertTrue(0 < len(apart) < 5)
        for path in apart:
            self.assertRegex(path.read_text(), r"^\d+ of \d+ parts found no room, more than 5 %")
        done = self.make(self.write(text % (150, "not_poured: 1\n")), "all", "--workers", 1)
        scenes = [json.loads(path.read_text()) for path in (self.folder / "all/scenes").glob("*/scene.json")]
        missing = sum(len(scene["report"]["not_poured"]) for scene in scenes)
        self.assertGreater(missing, 100)
        self.assertIn("%d of 450 parts found no room" % missing, done.stderr)
        self.assertNotIn("no room", self.make(self.write(text % (2, "")), "few").stderr)
        self.assertIn("not_poured", self.make(self.write(text % (2, "not_poured: 5\n")), "bad", code=2).stderr)

    def test_a_worker_that_is_killed_leaves_a_line(self):
        plan = self.plan(scenes=30, outputs="json")
        process = subprocess.Popen(self.command("dataset", plan, "--out", "out", "--workers", 2), cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not list((self.folder / "out/scenes").glob("scene_*")):
            time.sleep(0.01)
        victim = children(process.pid)[0]
        os.kill(victim, signal.SIGKILL)
        _, errors = process.communicate(timeout=300)
        self.assertEqual(process.returncode, 0, errors)
        self.assertRegex(errors, r"worker %d was killed by signal 9 while it made heap \d+, which is made again" % victim)

    def test_a_finished_folder_holds_no_journal(self):
        self.make(self.plan(scenes=2, outputs="json"), "out")
        self.assertEqual([path.name for path in (self.folder / "out").glob("index.sqlite*")], ["index.sqlite"])
        with sqlite3.connect("file:%s?mode=ro" % (self.folder / "out/index.sqlite"), uri=True) as index:
            self.assertEqual(index.execute("select count(*) from scenes").fetchone(), (2,))


if __name__ == "__main__":
    data_set.main()
