#!/usr/bin/env python3
"""Dull things that machines check: layout (clang-format), slips in C++ (clang-tidy), in shell and in Python."""
import concurrent.futures
import importlib.machinery
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# What is GLSL alone is laid out by hand: clang-format breaks a buffer's block over five lines.
BY_HAND = re.compile(r"shaders/(?!shared/sphere/)")
# clang-tidy takes seconds a file: of these layers, which all others use.
TIDY = ("src/core/", "src/scene/")
TIDY_FLAGS = ["-std=c++17", "-Iinclude", "-Isrc", "-Ishaders", "-isystem", "/usr/include/eigen3"]


def tree():
    """Paths of the tree as scripts/check_layers sees it, which needs no git."""
    loader = importlib.machinery.SourceFileLoader("check_layers", str(ROOT / "scripts/check_layers"))
    script = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_layers", loader))
    loader.exec_module(script)
    return sorted(file.relative_to(ROOT).as_posix() for file in script.files(ROOT))


def scripts(suffix, program):
    """Files with that suffix, or whose first line names the program."""
    for path in PATHS:
        with open(ROOT / path, "rb") as file:
            first = file.readline(80)
        if path.endswith(suffix) or re.match(rb"#!.*\b" + program, first):
            yield path


def complaints(command):
    """Of one call in the root of the tree; empty if it is content."""
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    return "" if run.returncode == 0 else run.stdout + run.stderr


class Style(unittest.TestCase):
    maxDiff = None

    def program(self, name):
        self.assertTrue(shutil.which(name), name + " is missing: run scripts/install_deps")
        return name

    def test_layout(self):
        program = self.program("clang-format")
        version = re.search(r"version (\d+)", subprocess.check_output([program, "--version"], text=True))[1]
        if version != "14":
            self.skipTest("clang-format %s lays out otherwise than 14, which Debian 12 has" % version)
        files = [p for p in PATHS if p.endswith((".cpp", ".hpp", ".h", ".comp")) and not BY_HAND.match(p)]
        self.assertGreater(len(files), 400)
        self.assertEqual(complaints([program, "--dry-run", "-Werror", *files]), "", "run clang-format -i on these")

    def test_slips_in_cpp(self):
        program = self.program("clang-tidy")
        files = [p for p in PATHS if p.startswith(TIDY) and p.endswith(".cpp")]
        self.assertGreater(len(files), 10)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            found = pool.map(lambda path: complaints(
                [program, "--quiet", "--warnings-as-errors=*", path, "--", *TIDY_FLAGS]), files)
        self.assertEqual("".join(found), "")

    def test_slips_in_shell(self):
        files = list(scripts(".sh", b"bash"))
        self.assertGreater(len(files), 10)
        self.assertEqual(complaints([self.program("shellcheck"), "-x", "-f", "gcc", *files]), "")

    def test_slips_in_python(self):
        files = list(scripts(".py", b"python3"))
        self.assertGreater(len(files), 40)
        self.assertEqual(complaints([self.program("pyflakes3"), *files]), "")


if __name__ == "__main__":
    PATHS = tree()
    unittest.main()
