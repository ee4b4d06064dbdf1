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
TIDY_FLAGS = ["-std=c++17", "-Iinclude", "-Isrc", "-Ishaders", "-isystem", "/usr/include/eigen3",
              '-DBIN_SCENES_SOURCE_DIR=""', '-DBIN_SCENES_INSTALL_DIR=""']

# Parameters and lines of a function; test programs list what they try, and may be longer.
MOST_PARAMETERS, MOST_LINES = 7, 60
# Bullet prescribes its parameters.
OF_A_LIBRARY = {"src/solver/bullet/contact_solver.cpp solveGroupCacheFriendlyIterations"}


def bare(text):
    """C++ or GLSL without comments, texts and lines of the preprocessor; each line keeps its number."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])
    text = re.sub(r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"', blank, text, flags=re.S)
    text = re.sub(r"\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])'", lambda m: '"' + " " * (len(m[0]) - 2) + '"', text)
    return re.sub(r"(?m)^\s*#(?:[^\n]*\\\n)*[^\n]*", blank, text)


def parameters(text):
    """How many there are up to the parenthesis that closes; text begins behind the one that opens."""
    depth, in_template, count = 1, 0, 0
    for at, sign in enumerate(text):
        if sign in "([{":
            depth += 1
        elif sign in ")]}":
            depth -= 1
        elif sign in "<>":
            in_template += 1 if sign == "<" else -1
        elif sign == "," and depth == 1 and in_template <= 0:
            count += 1
        if depth == 0:
            return count + bool(text[:at].strip())
    return 0


def functions(text):
    """Name, parameters and lines of the body of each function that stands in no other one."""
    text, begins, start = bare(text), [], 0
    name = re.compile(r"\s*(?:template\s*<[^{]*?>\s*)?(?!(?:if|for|while|switch|return|else|do|catch)\b)"
                      r"[\w:<>,&*\s\[\]~]*?([~\w]+|operator\S+)\s*\(")
    for mark in re.finditer(r"[{};]", text):
        at = mark.start()
        if mark[0] == "{":
            head = text[start:at]
            found = None if any(begins) else name.match(head)
            if found and found[1].isupper():  # a macro: no statement
                found = None
            begins.append((found[1], parameters(head[found.end():]), text.count("\n", 0, at)) if found else None)
        elif mark[0] == "}" and begins:
            begun = begins.pop()
            if begun:
                yield begun[0], begun[1], max(0, text.count("\n", 0, at) - begun[2] - 1)
        start = at + 1


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


def named_classes(text):
    """(Namespace, name) of each class that is defined outside of functions, classes and nameless namespaces."""
    spaces, depths, depth = [], [], 0
    for line in bare(text).splitlines():
        space = re.match(r"\s*(?:inline )?namespace\b *([\w:]*) *\{", line)
        name = re.match(r"(?:class|struct)\s+(\w+)(?:\s+final)?\s*(?::(?!:)[^;]*)?\{", line)
        if name and all(spaces) and len(spaces) == depth:
            yield "::".join(spaces), name[1]
        if space:
            spaces.append(space[1])
            depths.append(depth)
        depth += line.count("{") - line.count("}")
        while depths and depth <= depths[-1]:
            depths.pop()
            spaces.pop()


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

    def test_functions_are_read(self):
        code = "template <class T>\nint f(const std::map<int, T>& m, int b = g(1, 2)) {\n  if (b) {\n  }\n\n}\nvoid h() {}\n"
        self.assertEqual(list(functions(code)), [("f", 2, 3), ("h", 0, 0)])

    def test_functions_are_small(self):
        large, count = set(), 0
        for path in PATHS:
            if not path.endswith((".cpp", ".hpp", ".h", ".comp")):
                continue
            for name, given, lines in functions((ROOT / path).read_text()):
                count += 1
                if given > MOST_PARAMETERS or lines > MOST_LINES and not path.startswith("test/"):
                    large.add(path + " " + name)
        self.assertGreater(count, 5000)
        self.assertLessEqual(OF_A_LIBRARY, large)
        self.assertEqual(large, OF_A_LIBRARY, "above %d parameters or %d lines" % (MOST_PARAMETERS, MOST_LINES))

    def test_classes_of_one_name_share_no_namespace(self):
        """Two in different files would be one to the linker: whichever's vector<> it takes, the other writes beyond."""
        found = {}
        for path in PATHS:
            if path.startswith(("src/", "include/")) and path.endswith((".cpp", ".hpp")):
                for space, name in named_classes((ROOT / path).read_text()):
                    found.setdefault((space, name), set()).add(path)
        self.assertGreater(len(found), 400)
        self.assertEqual({name: files for name, files in found.items() if len(files) > 1}, {})

    def test_long_files_say_what_they_do(self):
        for path in PATHS:
            if path.endswith(".cpp") and path.startswith(("src/", "bench/")):
                text = (ROOT / path).read_text()
                self.assertTrue(text.startswith("///") or text.count("\n") <= 150, path + " begins without saying what it does")

    def test_scripts_can_be_started(self):
        """Git keeps whether a file may be executed; CTest starts the tests' scripts by their names alone."""
        started = [p for p in PATHS if (ROOT / p).read_bytes()[:2] == b"#!"]
        self.assertGreater(len(started), 40)
        self.assertEqual([p for p in started if not os.access(ROOT / p, os.X_OK)], [])

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
