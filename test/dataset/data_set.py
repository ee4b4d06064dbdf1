"""What tests of data sets share: a folder with a part and a plan, the tool, and trees of files to compare."""
import hashlib
import itertools
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

TOOL = None  # set by main()

PLAN = """seed: 5
scenes: %(scenes)d
outputs: [%(outputs)s]
attempts: 4
request:
  bin: {inner_size: [0.24, 0.2, 0.15]}
  solver: {type: bullet}
  parts:
    - {model: box.stl, count: 3, surface: {albedo: 0.4}}
    - {model: bar.stl, count: 2}
  sensors:
    - {name: camera, width: 96, height: 72}
    - {name: side, width: 64, height: 48, pose: [0.3, 0, 0.5, 0.9272, 0, -0.3746, 0]}
draw:
  parts[0].friction: {uniform: [0.3, 0.7]}
  parts[1].density: {normal: [1500, 200], min: 1000, max: 2000}
  bin.inner_size: {times: {uniform: [0.95, 1.05]}}
  sensors[0].pose: {view: {distance: {uniform: [0.5, 0.6]}, tilt: {uniform: [0, 0.2]}, turn: {uniform: [0, 6.28]}}}
%(draw)s
amount: {parts: {uniform: [3, 6]}, shares: [2, 1]}
%(more)s
"""


def box_stl(path, size):
    """Binary STL of a box around its origin (m), outward triangles."""
    half = [s / 2 for s in size]
    corners = [[(2 * b - 1) * h for b, h in zip(bits, half)] for bits in itertools.product((0, 1), repeat=3)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    with open(path, "wb") as out:
        out.write(b"\0" * 80 + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            out.write(struct.pack("<3f", 0, 0, 0))
            for corner in triangle:
                out.write(struct.pack("<3f", *corners[corner]))
            out.write(b"\0\0")


BOX, BAR = (0.03, 0.04, 0.05), (0.08, 0.02, 0.02)


def children(parent):
    """Processes that this one has started."""
    try:
        return [int(child) for thread in os.listdir("/proc/%d/task" % parent)
                for child in pathlib.Path("/proc/%d/task/%s/children" % (parent, thread)).read_text().split()]
    except OSError:
        return []  # it has ended


def processor_time(process):
    """Seconds that a process and its children have run until now."""
    used = 0
    for pid in [process] + children(process):
        try:
            used += sum(int(path.read_text().split()[0]) for path in pathlib.Path("/proc/%d/task" % pid).glob("*/schedstat"))
        except OSError:
            pass
    return used / 1e9


def tree_of(root):
    """Path -> digest of every file of a data set that has to be the same however it was made."""
    return {path.relative_to(root).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(root.rglob("*"))
            if path.is_file() and not path.name.startswith("index.sqlite") and ".shares" not in path.parts}


class DataSetTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="bin_scenes_dataset_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        box_stl(self.folder / "box.stl", BOX)
        box_stl(self.folder / "bar.stl", BAR)

    def plan(self, scenes=4, outputs="json, png, bop, shards", draw="", more="", name="plan.yaml"):
        (self.folder / name).write_text(PLAN % {"scenes": scenes, "outputs": outputs, "draw": draw, "more": more})
        return name

    def command(self, *words):
        return [TOOL, *map(str, words)]

    def run_tool(self, *words, code=0, before=None):
        command = self.command(*words)
        if before:
            command = ["bash", "-c", before + ' exec "$@"', "bash"] + command
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, env=self.environment())
        if code is not None:
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def environment(self):
        return dict(os.environ, LP_NUM_THREADS="0")

    def make(self, plan, out, *options, code=0):
        return self.run_tool("dataset", plan, "--out", out, *options, code=code)

    def tree(self, name):
        return tree_of(self.folder / name)

    def assert_same(self, a, b):
        a, b = self.tree(a), self.tree(b)
        self.assertEqual(sorted(a), sorted(b))
        self.assertEqual([path for path in a if a[path] != b[path]], [], "files differ")


def option(name):
    """Value of an option that this program has and unittest has not; none if it is not given."""
    if name not in sys.argv:
        return None
    at = sys.argv.index(name)
    value = sys.argv[at + 1]
    del sys.argv[at:at + 2]
    return value


def main():
    global TOOL
    TOOL = os.path.abspath(sys.argv.pop(1))
    __import__("data_set").TOOL = TOOL
    unittest.main()
