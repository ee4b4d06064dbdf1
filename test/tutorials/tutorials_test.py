#!/usr/bin/env python3
"""A tutorial's commands work as they are printed.
    tutorials_test.py BUILD_FOLDER PAGE.md
The blocks ```bash of the page run in order, in one shell that stops at the first error, in an empty folder. A block
without a language shows output of the block before: each of its lines must be there, whatever its figures are.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
MARK = "== block %d =="


def blocks(page):
    """(Language, text) of each fenced block."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text(), re.M | re.S)


def free_port():
    code = "import socket; s = socket.socket(); s.bind(('127.0.0.1', 0)); print(s.getsockname()[1])"
    return subprocess.check_output([sys.executable, "-c", code], text=True).strip()


def script(build, page):
    setup = build / "devel/setup.bash"
    lines = ["source %s" % setup if setup.exists() else "export PYTHONPATH=%s" % (build / "python"), "set -e"]
    for number, (language, text) in enumerate(blocks(page)):
        if language == "bash":
            lines += ["echo '%s'" % (MARK % number), text]
    return "\n".join(lines)


def without_figures(text):
    return re.sub(r"\s+", " ", re.sub(r"\d[\d.]*(e[-+]?\d+)?", "#", text)).strip()


def missing_lines(page, output):
    """Lines that the page shows and the commands did not print."""
    printed = dict(re.findall(r"^== block (\d+) ==\n(.*?)(?=^== block|\Z)", output, re.M | re.S))
    last = None
    for number, (language, text) in enumerate(blocks(page)):
        if language == "bash":
            last = without_figures(printed.get(str(number), ""))
        elif language == "":
            for line in text.splitlines():
                if line.strip() and without_figures(line) not in last:
                    yield line


def main():
    build, page = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "bin").mkdir()
        (folder / "bin/python3").symlink_to("/usr/bin/python3")  # Debian's, which has numpy
        (folder / "work").mkdir()
        environment = {**os.environ, "BIN_SCENES": str(ROOT), "LP_NUM_THREADS": "0", "PYTHONDONTWRITEBYTECODE": "1",
                       "PATH": "%s/bin:%s/src/tool:%s" % (folder, build, os.environ["PATH"]),
                       "ROS_MASTER_URI": "http://127.0.0.1:" + free_port(), "ROS_IP": "127.0.0.1",
                       "ROS_LOG_DIR": str(folder / "log"), "TUTORIAL_BUILD": str(build)}
        environment.pop("ROS_HOSTNAME", None)
        shell = subprocess.Popen(["bash", "-c", script(build, page)], cwd=folder / "work", env=environment, text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            output, _ = shell.communicate()
        finally:
            try:
                os.killpg(shell.pid, signal.SIGTERM)  # what a failed page left running
            except ProcessLookupError:
                pass
    print(output)
    if shell.returncode:
        sys.exit("%s: a command ended with code %d, see above" % (page.name, shell.returncode))
    missing = list(missing_lines(page, output))
    if missing:
        sys.exit("%s shows what was not printed:\n%s" % (page.name, "\n".join(missing)))


if __name__ == "__main__":
    main()
