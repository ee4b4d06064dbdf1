#!/usr/bin/python3
"""What a person at a terminal sees: completion in real shells, and the line of progress, in pseudo-terminals.

    terminal_test.py TOOL
"""
import fcntl
import os
import pathlib
import pty
import re
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from data_set import box_stl  # noqa: E402
from stop_test import sphere_stl  # noqa: E402

TOOL = os.path.abspath(sys.argv.pop(1))
SOURCE = pathlib.Path(__file__).resolve().parents[2] / "src/tool"
ENDLESS = 120  # s after which a shell counts as hung


def terminals():
    """Whether there are any: a root without /dev/pts has none."""
    try:
        for end in pty.openpty():
            os.close(end)
    except OSError:
        return False
    return True


class Terminal:
    """A program in a pseudo-terminal."""

    def __init__(self, command, columns=100, **options):
        own, other = pty.openpty()
        fcntl.ioctl(other, termios.TIOCSWINSZ, struct.pack("HHHH", 30, columns, 0, 0))
        self.own, self.text = own, ""
        self.process = subprocess.Popen(command, stdin=other, stderr=other, start_new_session=True,
                                        stdout=options.pop("stdout", other), **options)
        os.close(other)

    def send(self, text):
        os.write(self.own, text.encode())

    def read(self, until=None):
        """All text up to the end, or up to what matches `until`."""
        end = time.monotonic() + ENDLESS
        while not (until and re.search(until, self.text)):
            if not select.select([self.own], [], [], max(0.0, end - time.monotonic()))[0]:
                raise AssertionError("no answer; so far: %r" % self.text)
            try:
                more = os.read(self.own, 65536)
            except OSError:  # the other end is closed
                more = b""
            if not more:
                break
            self.text += more.decode(errors="replace")
        return self.text

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.own)


@unittest.skipUnless(terminals(), "there are no pseudo-terminals (/dev/pts)")
class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="bin_scenes_terminal_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)


class Completion(Folder):
    """The line that is left after words and tabs, as the shell would run it."""

    def setUp(self):
        super().setUp()
        for name in ("heap.yaml", "heap.txt", "two words.yaml", "nut.STEP"):
            (self.folder / name).write_text("")
        (self.folder / "more").mkdir()
        (self.folder / "path").mkdir()
        (self.folder / "path/bin_scenes").symlink_to(TOOL)

    def shell(self, command, beginning):
        environment = dict(os.environ, TERM="dumb", PS1="", PROMPT="", INPUTRC="/dev/null", HOME=str(self.folder),
                           PATH="%s:%s" % (self.folder / "path", os.environ["PATH"]))
        terminal = Terminal(command, 400, cwd=self.folder, env=environment)
        self.addCleanup(terminal.close)
        terminal.send(beginning + "; echo REA''DY\n")
        terminal.read("READY")
        return terminal

    def left(self, terminal, typed):
        """The words of the line, after `typed` was typed. The line is then run with printf in front of it."""
        terminal.text = ""
        terminal.send(typed + "\x01printf '<%s>' RES''ULT \x05; echo E''ND\n")
        text = terminal.read("END")
        return re.search("<RESULT>((?:<[^<>]*>)*)END", text)[1][1:-1].split("><")[1:]

    def expect_completions(self, terminal):
        for typed, expected in [
            ("gener\t", ["generate"]),
            ("dataset ver\t", ["dataset", "verify"]),
            ("generate --verb\t", ["generate", "--verbose"]),
            ("new nut.STEP --sensor laser\t", ["new", "nut.STEP", "--sensor", "laser_line_0.5m_350mm"]),
            ("new nut.STEP --unit i\t", ["new", "nut.STEP", "--unit", "inch"]),
            ("generate h\t--out more", ["generate", "heap.yaml", "--out", "more"]),  # heap.txt is no request
            ("generate tw\t", ["generate", "two words.yaml"]),
            ("inspect n\t", ["inspect", "nut.STEP"]),
            ("generate x.yaml --out mo\t", ["generate", "x.yaml", "--out", "more"]),
            ("generate x.yaml --formats json,pn\t", ["generate", "x.yaml", "--formats", "json,png"]),
            ("generate x.yaml --set solver.ty\tbul\t", ["generate", "x.yaml", "--set", "solver.type=bullet"]),
            ("generate x.yaml --set=solver.type=bul\t", ["generate", "x.yaml", "--set=solver.type=bullet"]),
            ("generate x.yaml --set parts[3].un\tin\t", ["generate", "x.yaml", "--set", "parts[3].unit=inch"]),
            ("generate x.yaml --set bin.surface.mat\tbras\t",
             ["generate", "x.yaml", "--set", "bin.surface.material=brass"]),
            ("nonsense\t", ["nonsense"]),
        ]:
            with self.subTest(typed):
                left = self.left(terminal, "bin_scenes " + typed)
                self.assertEqual([word.rstrip("/") for word in left], expected)  # zsh takes the slash of a folder back

    def test_bash(self):
        self.expect_completions(self.shell(["bash", "--norc", "--noprofile", "-i"],
                                           "source <(bin_scenes completion bash)"))

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh(self):
        shutil.copy(SOURCE / "completion.zsh", self.folder / "path/_bin_scenes")  # as it is installed
        self.expect_completions(self.shell(["zsh", "-f", "-i"], "bindkey -e; fpath=(path $fpath); "
                                           "autoload -Uz compinit; compinit -D -u; unset zle_bracketed_paste"))

    def test_all_that_is_named_is_found(self):
        """Every option that is known by name to the completion has values, and every command options."""
        def ask(*words):
            return subprocess.run([TOOL, "complete", "--", *words], capture_output=True, text=True, check=True).stdout.split()
        commands = [word for word in ask("") if not word.startswith("file:")]
        self.assertIn("new", commands)
        self.assertIn("reference", commands)
        self.assertNotIn("complete", commands)
        for command in commands:
            self.assertIn("--help", ask(command, "-"))
        for command, option in [("generate", "--set"), ("generate", "--formats"), ("generate", "--solver"),
                                ("generate", "--out"), ("inspect", "--unit"), ("new", "--sensor"), ("sensor", "")]:
            self.assertTrue(ask(command, option, "") if option else ask(command, ""), (command, option))
            self.assertTrue(not option or option in ask(command, "-"), (command, option))


class Progress(Folder):
    def setUp(self):
        super().setUp()
        sphere_stl(self.folder / "fine.stl", 200, bumps=0.05)
        (self.folder / "heaps.yaml").write_text(
            "bin: {inner_size: [0.3, 0.3, 0.3]}\nsolver: {type: bullet}\nparts: [{model: box.stl, unit: mm, count: 20}]\n")
        box_stl(self.folder / "box.stl", (20, 20, 20))

    def run_in(self, columns, *arguments, **variables):
        environment = {**os.environ, "TERM": "xterm", "XDG_CACHE_HOME": str(self.folder / "cache"), **variables}
        environment = {name: value for name, value in environment.items() if value}
        terminal = Terminal([TOOL, *arguments], columns, cwd=self.folder, env=environment, stdout=subprocess.DEVNULL)
        self.addCleanup(terminal.close)
        return terminal

    def long_job(self, columns, **variables):
        """A job that is killed before it ends. Each has a folder of its own, so that none finds scenes of another."""
        return self.run_in(columns, "generate", "heaps.yaml", "--out", f"out_{columns}", "--scenes", "30000", **variables)

    def test_how_far_and_how_long(self):
        terminal = self.long_job(100, NO_COLOR="")
        text = terminal.read(r"scene [1-9]\d* \w+[^\r]*, \d+:\d\d left")
        self.assertIn("\033[32m#" if "#" in text else "[....", text)
        self.assertNotIn("\n", text)

    def test_a_narrow_terminal_has_one_line(self):
        for columns in (70, 50, 24):
            terminal = self.long_job(columns, NO_COLOR="1")
            text = terminal.read("(\033\\[K[^\033]+){12}")
            lines = text.split("\r\033[K")[1:]
            self.assertGreater(len(lines), 10, text)
            for line in lines:
                self.assertLess(len(line), columns, line)
                self.assertNotIn("\033", line)  # NO_COLOR
            self.assertIn("left", "".join(lines) if columns > 40 else "left")

    def test_one_stage_after_the_other(self):
        terminal = self.run_in(100, "inspect", "fine.stl", "--unit", "m")
        terminal.read("(reading fine.stl|symmetries|distance field|convex hulls).*, \\d+:\\d\\d")

    def test_the_line_goes_when_the_job_ends(self):
        terminal = self.run_in(100, "sensor", "stereo_0.7m_1200mm")
        text = terminal.read()
        self.assertEqual(terminal.process.wait(), 0)
        self.assertTrue(text == "" or text.endswith("\r\033[K"), text[-80:])

    def test_nothing_where_it_cannot_be_drawn(self):
        for variables in ({"TERM": "dumb"}, {"TERM": ""}):
            terminal = self.run_in(100, "sensor", "stereo_0.7m_1200mm", **variables)
            self.assertEqual(terminal.read(), "")

    def lines(self, seconds):
        """What a job prints into a pipe."""
        environment = {**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache"), "BIN_SCENES_PROGRESS": seconds}
        run = subprocess.run([TOOL, "generate", "heaps.yaml", "--out", "out", "--scenes", "2", "--overwrite"], cwd=self.folder,
                             env=environment, capture_output=True, text=True, check=True)
        return run.stderr.splitlines()

    def test_lines_where_there_is_no_terminal(self):
        lines = self.lines("1e-9")
        self.assertGreater(len(lines), 2)
        for line in lines:
            self.assertRegex(line, r"^bin_scenes: ( *\d+ % )?\S.*, \d+:\d\d( left)?$")
        self.assertTrue(any("scene 1" in line for line in lines), lines)
        self.assertEqual(self.lines("0"), [])
        self.assertEqual(self.lines("3600"), [])  # an hour has not passed


if __name__ == "__main__":
    unittest.main(verbosity=2)
