#!/usr/bin/python3
"""Data sets that grow, shards that come while others are made, splits, and heaps that are taken out until none is left.

    growth_test.py TOOL
"""
import json
import os
import re
import shutil
import signal
import subprocess
import time

import data_set
from data_set import DataSetTest

from bin_scenes_data import Shards

SMALL = "shard_size: 6\n"  # three scenes of two images


class Growth(DataSetTest):
    def test_a_data_set_grows_to_what_it_would_have_been_at_once(self):
        more = SMALL + "split: {train: 0.7, val: 0.3}\n"
        large = self.plan(scenes=13, more=more, name="large.yaml")
        self.make(large, "once")
        self.make(self.plan(scenes=8, more=more), "grown")
        before = {path: os.stat(path).st_mtime_ns for path in (self.folder / "grown/scenes").rglob("scene.json")}
        self.make(large, "grown")
        self.assertEqual(before, {path: os.stat(path).st_mtime_ns for path in before})
        self.assert_same("once", "grown")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "grown").stdout)
        self.assertIn("8 of 13", self.make("plan.yaml", "grown", code=2).stderr)  # it does not shrink

    def test_growing_survives_kills(self):
        large = self.plan(scenes=9, outputs="json, shards", more=SMALL, name="large.yaml")
        self.make(large, "once")
        self.make(self.plan(scenes=5, outputs="json, shards", more=SMALL), "grown")
        for pause in (0.0, 0.02, 0.05, 0.1, 0.2, 0.4):
            process = subprocess.Popen(self.command("dataset", large, "--out", "grown", "--workers", 2), cwd=self.folder,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(pause)
            process.send_signal(signal.SIGKILL)
            process.wait()
        self.make(large, "grown")
        self.assert_same("once", "grown")

    def test_a_run_stopped_before_its_first_shard_tells_of_the_later_ones(self):
        plan = self.plan(scenes=8, outputs="json, shards", more="shard_size: 4\n")  # two scenes of two images
        self.make(plan, "once")
        shutil.copytree(self.folder / "once", self.folder / "stopped")
        # As Ctrl-C leaves it while one worker still makes heap 0 and the other one has filled shards.
        for path in ("scenes/scene_000000", "scenes/scene_000001"):
            shutil.rmtree(self.folder / "stopped" / path)
        for path in (self.folder / "stopped/shards").glob("shard-000000.*"):
            path.unlink()
        self.make(plan, "stopped")
        self.assert_same("once", "stopped")

    def test_what_is_removed_from_a_finished_set_is_made_again(self):
        plan = self.plan(scenes=4, outputs="json, shards", more=SMALL + "depletion: {steps: 1, take: 1}\n")
        self.make(plan, "once")
        for lost in ("scenes/scene_000004", "shards/shard-000001.tar"):  # of a heap in two shards; a shard of two heaps
            with self.subTest(lost=lost):
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                shutil.copytree(self.folder / "once", self.folder / "out")
                subprocess.run(["rm", "-r", self.folder / "out" / lost], check=True)
                self.make(plan, "out")
                self.assert_same("once", "out")
        (self.folder / "out/shards/shard-000001.json").unlink()  # alone
        told = self.make(plan, "out", code=2).stderr
        self.assertRegex(told, r"out/shards/shard-000001.json: is missing or damaged \(remove out/shards/shard-000001.tar,")
        (self.folder / "out/shards/shard-000001.tar").unlink()
        self.make(plan, "out")
        self.assert_same("once", "out")

    def test_a_share_that_is_the_whole_set_is_merged(self):
        plan = self.plan(scenes=5, outputs="json, shards", more=SMALL)
        self.make(plan, "share", "--shard", "0/1")
        self.run_tool("dataset", "merge", "share", "--out", "merged")
        self.assert_same("share", "merged")
        lost = self.folder / "share/shards/shard-000000.json"
        offsets = lost.read_text()
        lost.unlink()
        self.assertIn("remove share/shards/shard-000000.tar", self.run_tool("dataset", "merge", "share", "--out", "lost", code=2).stderr)
        lost.write_text(offsets)
        self.make(plan, "other", "--shard", "1/2")  # its samples are not packed
        self.run_tool("dataset", "merge", "other", "share", "--out", "both")
        self.assert_same("share", "both")

    def test_shards_can_be_read_while_the_rest_is_made(self):
        plan = self.plan(scenes=60, outputs="json, shards", more=SMALL)
        process = subprocess.Popen(self.command("dataset", plan, "--out", "out", "--workers", 1), cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        map_path = self.folder / "out/shards/key_to_shard.json"
        while not map_path.exists() and process.poll() is None:
            time.sleep(0.01)
        self.assertIsNone(process.poll(), "no shard came before the end")
        shards = Shards(self.folder / "out")
        self.assertEqual(shards.keys[:2], ["000000_000000", "000000_000001"])
        self.assertEqual(shards[0].depth.shape, (72, 96))
        process.send_signal(signal.SIGINT)
        process.wait(timeout=60)

    def test_a_split_is_by_heaps_and_the_same_for_every_reader(self):
        more = "split: {train_pbr: 0.5, val: 0.25, test: 0.25}\ndepletion: {steps: 1, take: 1}\n"
        self.make(self.plan(scenes=8, outputs="json, bop, shards", more=more), "out")
        folders = {split: sorted(path.name for path in (self.folder / "out/bop" / split).iterdir()) for split in ("train_pbr", "val", "test")}
        for split, share in (("train_pbr", 0.5), ("val", 0.25), ("test", 0.25)):
            self.assertLessEqual(abs(len(folders[split]) / 2 - 8 * share), 1)
        for split, scenes in folders.items():
            heaps = {int(scene) // 2 for scene in scenes}
            self.assertEqual(len(scenes), 2 * len(heaps), "both scenes of a heap are in one split")
            keys = Shards(self.folder / "out", split=split).keys
            self.assertEqual(sorted({key.split("_")[0] for key in keys}), scenes)
            self.assertEqual([sample.key for sample in Shards(self.folder / "out", split=split)], keys)
        with self.assertRaisesRegex(ValueError, "train_pbr, val, test"):
            Shards(self.folder / "out", split="train")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "out").stdout)

    def test_splits_that_cannot_be_are_refused(self):
        for split, words in (("{train: 0.5, val: 0.4}", "add up to 0.9"), ("{train: 1.5, val: -0.5}", "-0.5"),
                             ("{../train: 1}", "../train"), ("[0.5, 0.5]", "map")):
            done = self.make(self.plan(more="split: " + split), "out", code=2)
            self.assertRegex(done.stderr, r"plan.yaml:\d+: 'split'.*" + re.escape(words))


class Depletion(DataSetTest):
    def test_an_empty_bin_is_a_sample_and_the_last_of_its_heap(self):
        plan = self.plan(scenes=3, more="depletion: {steps: 4, take: {uniform: [2, 3]}}")
        self.make(plan, "out")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "out").stdout)
        lengths = []
        for heap in range(3):
            left = []
            for path in sorted((self.folder / "out/scenes").iterdir()):
                if int(path.name[6:]) // 5 == heap:
                    left.append(sum(part["pose"] is not None for part in json.loads((path / "scene.json").read_text())["parts"]))
            self.assertEqual(left, sorted(set(left), reverse=True))
            self.assertEqual(left[-1], 0)
            lengths.append(len(left))
        self.assertLess(min(lengths), 5)
        shards = Shards(self.folder / "out")
        self.assertEqual(len(shards), 2 * sum(lengths))
        empty = [sample for sample in shards if not sample.info]
        self.assertEqual(len(empty), 6)
        for sample in empty:
            for kind in ("mask", "mask_visib"):
                self.assertEqual(sample.masks(kind).shape, (0,) + sample.depth.shape)
        # A folder whose index is lost knows that these heaps are whole.
        (self.folder / "out/index.sqlite").unlink()
        before = {path: os.stat(path).st_mtime_ns for path in (self.folder / "out/scenes").rglob("scene.json")}
        self.make(plan, "out")
        self.assertEqual(before, {path: os.stat(path).st_mtime_ns for path in (self.folder / "out/scenes").rglob("scene.json")})

    def test_a_step_that_may_take_nothing_is_refused(self):
        done = self.make(self.plan(more="depletion: {steps: 2, take: {uniform: [0, 2]}}"), "out", code=2)
        self.assertIn("depletion.take", done.stderr)


if __name__ == "__main__":
    data_set.main()
