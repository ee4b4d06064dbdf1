#!/usr/bin/env python3
"""Signals bin_scenes at random moments of requests that keep it busy in every phase.

    stop_test.py TOOL [--signals N] [--seed S] [--report]

Each time the process has to end by itself, with exit code 130 (or as it would have ended, where it was faster), without
a child and without anything half-written that the next run does not remove. --report prints how long it took, by
request: wall time, so run it on an idle machine. As a test only a stop that never comes fails, since a busy machine may
take any time.
"""
import argparse
import os
import pathlib
import random
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

ENDLESS = 120  # s after which a stop counts as disobeyed


def sphere_stl(path, rings, radius=0.02, bumps=0.0):
    """ASCII STL of a ball, with bumps that make it concave."""
    import math
    def point(i, k):
        polar, turn = math.pi * i / rings, math.pi * k / rings
        r = radius * (1 + bumps * math.sin(7 * turn) * math.sin(polar) ** 2 * math.sin(5 * polar))
        return (r * math.sin(polar) * math.cos(turn), r * math.sin(polar) * math.sin(turn), r * math.cos(polar))
    with open(path, "w") as out:
        out.write("solid ball\n")
        for i in range(rings):
            for k in range(2 * rings):
                a, b = point(i, k), point(i + 1, k)
                c, d = point(i + 1, (k + 1) % (2 * rings)), point(i, (k + 1) % (2 * rings))
                for triangle in ([a, b, c] if i + 1 < rings else None, [a, c, d] if i > 0 else None):
                    if triangle is None:
                        continue
                    out.write("facet normal 0 0 0\nouter loop\n")
                    for v in triangle:
                        out.write("vertex %.9g %.9g %.9g\n" % v)
                    out.write("endloop\nendfacet\n")
        out.write("endsolid\n")


def requests(folder):
    """Name -> (request text, options, whether the cache is off): each is busy elsewhere."""
    sphere_stl(folder / "ball.stl", 8)
    sphere_stl(folder / "fine.stl", 200, bumps=0.05)
    sphere_stl(folder / "bumpy.stl", 24, bumps=0.15)
    overlap = "bin: {floor: true}\npour: {pattern: given}\nparts:\n  - {model: ball.stl, unit: m, count: %d, poses: [%s]}\n"

    def within_each_other(count):
        poses = ("[%.4f, %.4f, 0.1, 0, 0, 0, 1]" % (1e-4 * (i % 100), 1e-4 * (i // 100)) for i in range(count))
        return overlap % (count, ", ".join(poses))

    heap = "bin: {inner_size: [0.3, 0.3, 0.3]}\nparts: [{model: %s, unit: m, count: %d}]\n"
    return {
        "parsing": ("seed: 1\nparts:\n" + "  - {model: ball.stl, unit: m}\n" * 60000, [], False),
        "loading": (heap % ("fine.stl", 3), [], True),
        "decomposition": (heap % ("bumpy.stl", 3) + "solver: {type: bullet}\n", [], True),
        "overlap, sphere": (within_each_other(5000), ["--solver", "sphere", "--set", "solver.sphere.device=cpu"], False),
        "overlap, bullet": (within_each_other(700), ["--solver", "bullet"], False),
        "many scenes": (heap % ("ball.stl", 20), ["--scenes", "200000000", "--solver", "bullet"], False),
        "judging": (heap % ("fine.stl", 30), ["--solver", "sphere", "--seconds", "0.05"], False),
        "rendering": (heap % ("ball.stl", 60), ["--solver", "bullet", "--formats", "png,bop", "--seconds", "0.1", "--set",
                      "sensors=[{name: a, width: 1600, height: 1200}]"], False),
        "writing": (heap % ("ball.stl", 5), ["--scenes", "500", "--solver", "bullet", "--formats", "png,pcd,bop", "--seconds",
                    "0.01", "--set", "sensors=[{name: a, width: 640, height: 480}]"], False),
        "shaders": (heap % ("ball.stl", 5), ["--solver", "sphere", "--set", "solver.sphere.device=gpu"], True),
        "thesis": (heap % ("ball.stl", 5), ["--solver", "sphere", "--set", "solver.preset=thesis"], True),
    }


def of_session(session):
    """Processes that are left of a session."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            fields = (entry / "stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(fields[3]) == session and fields[0] != "Z":
            found.append(int(entry.name))
    return found


def obey_signals():
    """A shell that starts this test in the background has it ignore SIGINT, and its children with it."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


def stop_once(tool, folder, name, request, options, cold, rng):
    (folder / "request.yaml").write_text(request)
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    environment = dict(os.environ, XDG_CACHE_HOME=str(folder / ("cold" if cold else "warm")), BIN_SCENES_GL="software")
    if cold:
        shutil.rmtree(folder / "cold", ignore_errors=True)
    process = subprocess.Popen([tool, "generate", "request.yaml", "--out", "out"] + options, cwd=folder,
                               env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=obey_signals)
    time.sleep(0.05 + rng.random() ** 2 * 6.0)  # the handler is there; the middle of some phase, mostly an early one
    number = rng.choice([signal.SIGINT, signal.SIGTERM])
    begin = time.monotonic()
    process.send_signal(number)
    try:
        error = process.communicate(timeout=ENDLESS)[1]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return None, name + ": does not stop after signal %d" % number
    seconds = time.monotonic() - begin
    time.sleep(0.05)
    left = of_session(process.pid)
    if left:
        return seconds, "%s: processes are left: %s" % (name, left)
    # 0 and 1: it was done before; -2 and -15: the signal came before main() had begun.
    if process.returncode not in (130, 0, 1, -int(signal.SIGINT), -int(signal.SIGTERM)):
        return seconds, "%s: exit code %d: %s" % (name, process.returncode, error)
    if process.returncode == 130 and error.count("\n") != 1:
        return seconds, "%s: not one line: %s" % (name, error)
    for scene in out.glob("scene_*"):
        if not (scene / "scene.json").is_file():
            return seconds, "%s: half a scene: %s" % (name, scene)
    return seconds, None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", type=os.path.abspath)
    parser.add_argument("--signals", type=int, default=11)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--report", action="store_true")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="bin_scenes_stop_"))
    failures, times = [], {}
    try:
        cases = requests(folder)
        names = list(cases)
        for i in range(options.signals):
            name = names[i % len(names)]
            seconds, failure = stop_once(options.tool, folder, name, *cases[name], rng)
            if failure:
                failures.append(failure)
                print(failure, flush=True)
            if seconds is not None:
                times.setdefault(name, []).append(seconds)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if options.report:
        print("%-18s %5s %8s %8s" % ("request", "n", "median s", "max s"))
        for name, values in times.items():
            print("%-18s %5d %8.3f %8.3f" % (name, len(values), statistics.median(values), max(values)))
    if failures:
        sys.exit(1)


if __name__ == "__main__":
    main()
