#!/usr/bin/env python3
"""bench/publish, bench/all and bench/compare_results on small results of their own."""
import ast
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TABLE = """# benchmark: scenes
# command: bin_scenes_bench --filter scenes
# cpu: some CPU
# cores: 2
# gl: llvmpipe
# driver: Mesa
# version: 1
# commit: abc
# date: 2020-01-01
# roles: key key measure spread measure spread info
part,solver,time_s,time_s_spread,error_rel,error_rel_spread,status
ring,sphere,1.25,0.5,0.00123,,
ring,bullet,,,,,"stopped, too slow"
tee,sphere,0,0,12345,,
"""
DOC = """before
<!-- bench: scenes
%scolumns: part; solver; time_s = s; error_rel = error | %%
-->
<!-- /bench -->
after
"""


class Scripts(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="bin_scenes_scripts_"))
        self.addCleanup(shutil.rmtree, self.root)
        for folder in ("bench/plots", "bench/results/device", "docs/lab"):
            (self.root / folder).mkdir(parents=True)
        for script in ("publish", "compare_results"):
            shutil.copy(ROOT / "bench" / script, self.root / "bench")
        (self.root / "bench/results/device/scenes.csv").write_text(TABLE)
        (self.root / "docs/lab/accuracy.md").write_text(DOC % "")

    def run_script(self, name, *arguments, **environment):
        return subprocess.run([self.root / "bench" / name, *arguments], env={**os.environ, **environment},
                              capture_output=True, text=True)

    def doc(self):
        return (self.root / "docs/lab/accuracy.md").read_text()

    def test_publish_fills_the_tables(self):
        self.run_script("publish")
        text = self.doc()
        self.assertIn("| part | solver | s | error |", text)
        self.assertIn("| ring | sphere | 1.25 ± 0.25 | 0.123 % |", text)
        self.assertIn("| ring | bullet | - | stopped, too slow |", text)
        self.assertIn("| tee | sphere | 0 | 1234500 % |", text)
        self.assertIn("`bin_scenes_bench --filter scenes` on some CPU, 2 cores", text)
        self.assertIn("[scenes.csv](../../bench/results/device/scenes.csv)", text)
        self.assertTrue(text.startswith("before\n") and text.endswith("after\n"))

    def refusal(self, *commits):
        """What publish says of a file whose rows are of these commits; it writes nothing."""
        lines = TABLE.replace("status\n", "status,commit\n").splitlines()
        lines[-3:] = ["part_%d,sphere,1,,,,,%s" % of for of in enumerate(commits)]
        (self.root / "bench/results/device/mixed.csv").write_text("\n".join(lines))
        for arguments in ((), ("--check",)):
            run = self.run_script("publish", *arguments)
            self.assertEqual(run.returncode, 1)
            self.assertEqual(self.doc(), DOC % "")
        return run.stderr

    def test_publish_refuses_what_is_not_of_one_commit(self):
        self.assertIn("bench/results/device/mixed.csv: made by a tree with uncommitted changes (0123456789-dirty)",
                      self.refusal("0123456789-dirty"))
        self.assertIn("bench/results/device/mixed.csv: rows of 2 commits (0123456789, 9876543210)",
                      self.refusal("9876543210", "0123456789", "9876543210"))

    def test_publish_takes_what_is_of_one_commit(self):
        lines = TABLE.replace("status\n", "status,commit\n").splitlines()
        lines[-3:] = ["ring,sphere,1,,,,,0123456789", "tee,sphere,1,,,,,0123456789"]
        (self.root / "bench/results/device/scenes.csv").write_text("\n".join(lines))
        self.assertEqual(self.run_script("publish").returncode, 0)
        self.assertIn("commit 0123456789", self.doc())

    def test_publish_chooses_rows(self):
        (self.root / "docs/lab/accuracy.md").write_text(DOC % "where: solver=sphere part=r*\n")
        self.run_script("publish")
        self.assertIn("| ring | sphere |", self.doc())
        self.assertNotIn("bullet", self.doc())
        self.assertNotIn("tee", self.doc())

    def test_publish_adds_rows_up(self):
        counts = (TABLE.split("part,")[0].replace("key key measure spread measure spread info", "key key key exact exact")
                  + "theme,row,solver,tried,survived\n")
        (self.root / "bench/results/device/stress.csv").write_text(
            counts + "size,small,sphere,4,3\nsize,large,sphere,2,2\nsize,small,bullet,4,4\n")
        (self.root / "docs/lab/stress.md").write_text(
            "<!-- bench: stress\nsum: theme; solver\ncolumns: theme; solver; survived; tried\n-->\n<!-- /bench -->\n")
        self.run_script("publish")
        text = (self.root / "docs/lab/stress.md").read_text()
        self.assertIn("| size | sphere | 5 | 6 |\n| size | bullet | 4 | 4 |\n", text)

    def test_publish_names_the_worst_of_all_rows(self):
        goals = TABLE.split("part,")[0].replace("scenes", "goals").replace("key key measure spread measure spread info",
                                                                         "key measure exact exact")
        (self.root / "bench/results/device/goals.csv").write_text(
            goals + "part,error_rel,at_rest,scenes\nring,0.002,9,10\ntee,0.004,10,10\nold,,,\n")
        (self.root / "docs/lab/goals.md").write_text("""<!-- worst
of: all = goals; rings = goals part=r*
error, largest: error_rel | % | at most 1 %
at rest: at_rest of scenes | | all
-->
<!-- /worst -->
""")
        self.run_script("publish")
        text = (self.root / "docs/lab/goals.md").read_text()
        self.assertIn("| goal | limit | all | rings |", text)
        self.assertIn("| error, largest | at most 1 % | 0.4 % (tee) | 0.2 % (ring) |", text)
        self.assertIn("| at rest | all | 19 of 20 | 9 of 10 |", text)

    def test_check_tells_stale_tables(self):
        stale = self.run_script("publish", "--check")
        self.assertEqual(stale.returncode, 1)
        self.assertIn("docs/lab/accuracy.md", stale.stderr)
        self.run_script("publish")
        self.assertEqual(self.run_script("publish", "--check").returncode, 0)

    def git(self, *words):
        return subprocess.run(["git", "-C", self.root, "-c", "user.name=a", "-c", "user.email=a@b", *words], check=True,
                              capture_output=True, text=True).stdout.strip()

    def test_publish_marks_results_that_are_older_than_their_code(self):
        source = self.root / "src/sensor/light.cpp"
        source.parent.mkdir(parents=True)
        source.write_text("one\n")
        self.git("init")
        self.git("add", "src")
        self.git("commit", "-m", "one")
        head = "# commit: %s\n# measures: src/sensor src/solver" % self.git("rev-parse", "--short=10", "HEAD")
        (self.root / "bench/results/device/scenes.csv").write_text(TABLE.replace("# commit: abc", head))
        self.run_script("publish")
        self.assertNotIn("Stale", self.doc())
        source.write_text("two\n")
        check = self.run_script("publish", "--check")
        self.assertEqual(check.returncode, 1)
        self.assertIn("docs/lab/accuracy.md", check.stderr)
        self.git("commit", "-am", "two")
        self.run_script("publish")
        self.assertIn("scenes.csv). Stale: changed since then: src/sensor\n", self.doc())
        self.assertEqual(self.run_script("publish", "--check").returncode, 0)

    def comparison(self, before, after, *arguments):
        """Code and text of bench/compare_results for two folders with the same table of these rows."""
        for folder, rows in (("before", before), ("after", after)):
            (self.root / folder).mkdir(exist_ok=True)
            (self.root / folder / "scenes.csv").write_text(
                "# benchmark: scenes\n# cpu: some CPU\n# roles: key measure spread exact info\n"
                "part,time_s,time_s_spread,escaped,note\n" + "\n".join(rows) + "\n")
        run = self.run_script("compare_results", self.root / "before", self.root / "after", *arguments)
        return run.returncode, run.stdout

    def test_compare_names_what_moved_beyond_noise(self):
        for before, after, moved in (
                ("ring,1.1,0.2,0,", "ring,1.2,0.2,0,", ""),              # within the spread
                ("ring,1.1,0.2,0,", "ring,1.5,0.2,0,", "time_s 1.1 -> 1.5 (+36.4 %)"),
                ("ring,1,0,0,", "ring,1.02,0,0,", ""),                   # less than the floor
                ("ring,1,,0,", "ring,1.2,,0,", ""),                      # one sample may be a quarter off
                ("ring,1,,0,", "ring,1.4,,0,", "time_s 1 -> 1.4"),
                ("ring,1,0,0,", "ring,1,0,1,", "escaped 0 -> 1"),
                ("ring,1,0,0,a", "ring,1,0,0,b", ""),                    # for readers only
                ("ring,1,0,0,", "ring,,,0,", "time_s 1 -> ")):           # gone
            with self.subTest(before=before, after=after):
                code, text = self.comparison([before], [after])
                self.assertEqual(code, 1 if moved else 0, text)
                self.assertEqual(text.strip() if not moved else "", "")
                self.assertIn(moved, text)
        self.assertEqual(self.comparison(["ring,1,0,0,"], ["ring,1.02,0,0,"], "--floor", "0.01")[0], 1)

    def test_compare_names_rows_of_one_side_and_what_is_missing(self):
        code, text = self.comparison(["ring,1,0,0,", "bolt,2,0,0,"], ["tee,3,0,0,", "ring,1,0,0,"])
        self.assertEqual((code, text), (0, "gone: scenes: part=bolt\nnew: scenes: part=tee\n"))
        missing = self.run_script("compare_results", self.root / "before", self.root / "nowhere")
        self.assertEqual(missing.returncode, 2)
        self.assertIn("neither a file nor a folder", missing.stderr)

    def figure(self, **environment):
        """Publishes a page that shows a figure."""
        (self.root / "docs/lab/images").mkdir()
        (self.root / "docs/lab/accuracy.md").write_text("![A figure](images/scenes.svg) ![A photo](images/photo.svg)\n")
        (self.root / "bench/plots/style.gp").write_text("set datafile separator ','\n")
        (self.root / "bench/plots/scenes.gp").write_text(
            "# needs: scenes.csv\n# size: 900,560\nplot results.'/scenes.csv' using (column('time_s')) with points\n")
        return self.run_script("publish", **environment)

    def test_publish_says_when_gnuplot_is_missing(self):
        tools = self.root / "tools"
        tools.mkdir()
        (tools / "python3").symlink_to(sys.executable)
        outcome = self.figure(PATH=str(tools))
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("gnuplot-nox", outcome.stderr)

    @unittest.skipUnless(shutil.which("gnuplot"), "no gnuplot here")
    def test_publish_draws_the_figures_that_pages_show(self):
        outcome = self.figure()
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertTrue((self.root / "docs/lab/images/scenes.svg").read_text().rstrip().endswith("</svg>"))

    def test_scripts_hand_over_all_that_a_table_of_results_needs(self):
        """They do so after minutes of measuring."""
        tree = ast.parse((ROOT / "bench/datasets/results.py").read_text())
        needed = next(len(f.args.args) for f in tree.body if isinstance(f, ast.FunctionDef) and f.name == "put")
        calls = 0
        for path in (ROOT / "bench/datasets").iterdir():
            if not path.is_file() or not path.read_bytes().startswith(b"#!/usr/bin/python3"):
                continue
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.Call) and ast.unparse(node.func) == "results.put":
                    self.assertEqual(len(node.args) + len(node.keywords), needed, path.name)
                    calls += 1
        self.assertGreaterEqual(calls, 4)

    def test_all_makes_everything_and_names_what_failed(self):
        shutil.copy(ROOT / "bench/all", self.root / "bench")
        for folder in ("test/stress", "build/bench", "bench/datasets"):
            (self.root / folder).mkdir(parents=True)
        for name, code in (("build/bench/bin_scenes_bench", 0), ("test/stress/soak", 1), ("bench/publish", 0),
                           ("test/stress/inspect_all", 0), ("bench/datasets/measure", 0), ("bench/datasets/audit", 0),
                           ("bench/datasets/calibration", 0), ("bench/datasets/overlaps", 0), ("build/bin_scenes", 0)):
            script = self.root / name
            script.unlink(missing_ok=True)
            script.write_text("#!/bin/bash\necho did %s $*\nexit %d\n" % (name, code))
            script.chmod(0o755)
        outcome = self.run_script("all", QUICK="")
        self.assertEqual(outcome.returncode, 1)
        self.assertEqual(outcome.stderr, "bench/all: failed: test/stress/soak\n")
        did = [line for line in outcome.stdout.splitlines() if line.startswith("did ") and "inspect_all" not in line]
        self.assertEqual(did, ["did build/bench/bin_scenes_bench --results bench/results", "did test/stress/soak build",
                               *("did bench/datasets/measure %s --tool build/bin_scenes" % part
                                 for part in ("throughput", "masks", "growth")),
                               "did bench/datasets/audit build/bin_scenes --stock build/bench/bin_scenes_bench_stock",
                               "did bench/datasets/calibration --tool build/bin_scenes",
                               "did bench/datasets/overlaps --tool build/bin_scenes", "did bench/publish"])
        missing = self.run_script("all", "nowhere")
        self.assertEqual(missing.returncode, 2)
        self.assertIn("scripts/build", missing.stderr)


class InspectAll(unittest.TestCase):
    """test/stress/inspect_all on tools that say what is given."""

    def ends(self, report, code=0):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "models").mkdir()
            (root / "models/part.stl").touch()
            tool = root / "tool"
            tool.write_text("#!/bin/sh\ncat <<'END'\n%s\nEND\nexit %d\n" % (report, code))
            tool.chmod(0o755)
            run = subprocess.run([ROOT / "test/stress/inspect_all", tool, root / "models"], capture_output=True, text=True)
            return run.returncode, run.stdout

    def test_a_report_of_figures_is_good(self):
        self.assertEqual(self.ends('{"watertight": true, "size": [1.5, 2]}')[0], 0)

    def test_a_figure_that_is_none_fails_and_is_named(self):
        for none in ("null", "NaN", "Infinity"):
            code, text = self.ends('{"watertight": true, "proxies": {"hulls": {"error": [0.1, %s]}}}' % none)
            self.assertEqual(code, 1)
            self.assertIn("no figure: proxies.hulls.error[1]", text)

    def test_no_report_fails(self):
        self.assertEqual(self.ends("hulls 63")[0], 1)
        self.assertEqual(self.ends("{}", 9)[0], 1)


if __name__ == "__main__":
    unittest.main()
