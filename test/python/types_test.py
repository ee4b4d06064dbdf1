#!/usr/bin/python3
"""The types of the Python module: mypy reads package, examples and a program of a user; the stubs are those of what was built."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from python_scenes import PACKAGES, ROOT

USER = '''
from typing import Dict, List
import numpy as np
import numpy.typing as npt
import bin_scenes

def poses(request: Dict[str, object]) -> List["npt.NDArray[np.float64]"]:
    with bin_scenes.Generator() as g:
        heap = g.heap(request)
        rests: bool = heap.settle()
        return [s.poses for s in g.generate(request, scenes=3, prefetch=2)] if rests else []

def wrong(g: bin_scenes.Generator) -> None:
    for s in g.generate("a.yaml", scenes="three"):
        s.pose
    g.heap(7)
'''


def mypy(*arguments, path):
    return subprocess.run(["mypy", "--strict", "--no-error-summary", "--cache-dir", os.devnull, *arguments], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env={**os.environ, "MYPYPATH": path})


@unittest.skipUnless(shutil.which("mypy"), "mypy is missing: run scripts/install_deps")
class Types(unittest.TestCase):
    def test_the_package_is_typed(self):
        # of the reader of data sets, the names alone
        done = mypy("--allow-untyped-calls", "--follow-imports=silent", "-p", "bin_scenes", path=str(ROOT / "python"))
        self.assertEqual(done.stdout, "")
        self.assertTrue((ROOT / "python/bin_scenes/py.typed").exists())

    def test_a_user_is_told_what_is_wrong(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "program.py"
            program.write_text(USER)
            done = mypy("--follow-imports=silent", str(program), path=str(ROOT / "python"))
            lines = [line.split(":", 1)[1] for line in done.stdout.splitlines() if ": error:" in line]
        self.assertEqual([line.split("error:")[1].split("[")[-1] for line in lines], ["arg-type]", "attr-defined]", "arg-type]"], done.stdout)
        self.assertEqual([int(line.split(":")[0]) for line in lines], [14, 15, 16], done.stdout)

    def test_stubs_are_those_of_the_module(self):
        with tempfile.TemporaryDirectory() as folder:  # where a cache is left
            done = subprocess.run(["stubtest", "bin_scenes._core", "--concise"], text=True, stdout=subprocess.PIPE, cwd=folder,
                                  stderr=subprocess.STDOUT, env={**os.environ, "PYTHONPATH": PACKAGES, "MYPYPATH": PACKAGES})
        # What pybind11 makes: a metaclass of its own, and constructors that take anything to refuse it.
        told = [line for line in done.stdout.splitlines()
                if not line.endswith(("is inconsistent, metaclass differs", 'stub does not have *args argument "args"'))]
        self.assertIn("bin_scenes._core.Heap is inconsistent, metaclass differs", done.stdout)  # it has looked
        self.assertEqual(told, [])

    def test_all_that_users_call_is_documented(self):
        import bin_scenes
        for kind in (bin_scenes.Generator, bin_scenes.Heap):
            for name in [n for n in vars(kind) if not n.startswith("_")] + ["__doc__"]:
                self.assertTrue(getattr(kind, name) if name == "__doc__" else getattr(kind, name).__doc__, name)


if __name__ == "__main__":
    unittest.main()
