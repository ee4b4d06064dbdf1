#!/usr/bin/env python3
"""Hostile models and requests below 1 MB: each is answered, or refused by one printable line; none crashes or goes on.

    megabyte_test.py TOOL            the quick ones
    megabyte_test.py TOOL --all      all of them, with a table of processor times
"""
import itertools
import math
import os
import pathlib
import random
import resource
import struct
import subprocess
import sys
import tempfile

SIZE = 1_000_000
LIMIT_S = 120  # processor time of each: guards against endless loops, judges nothing
DRAW = random.Random(1)


def stl(triangles):
    return b"\0" * 80 + struct.pack("<I", len(triangles)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *[c for corner in t for c in corner], 0) for t in triangles)


def place(half=0.05):
    return [DRAW.uniform(-half, half) for _ in range(3)]


def box(middle, half):
    v = [[m + s * half for m, s in zip(middle, signs)] for signs in itertools.product((-1, 1), repeat=3)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return [(v[a], v[b], v[c]) for f in faces for a, b, c in ((f[0], f[1], f[2]), (f[0], f[2], f[3]))]


def ball(rows, columns, radius, noise):
    points = {}

    def point(i, j):
        if i in (0, rows):
            return (0, 0, radius if i == 0 else -radius)
        if (i, j % columns) not in points:
            a, b, r = math.pi * i / rows, 2 * math.pi * j / columns, radius * (1 + DRAW.uniform(-noise, noise))
            points[i, j % columns] = (r * math.sin(a) * math.cos(b), r * math.sin(a) * math.sin(b), r * math.cos(a))
        return points[i, j % columns]
    return [t for i in range(rows) for j in range(columns)
            for t in ([(point(i, j), point(i + 1, j), point(i, j + 1))] if i > 0 else []) +
            ([(point(i, j + 1), point(i + 1, j), point(i + 1, j + 1))] if i < rows - 1 else [])]


def models():
    """(name, bytes, whether it is quick)"""
    count = SIZE // 50 - 2
    boxes = count // 12
    yield "boxes_apart.stl", stl([t for _ in range(boxes) for t in box(place(), 0.001)]), True
    yield "boxes_overlap.stl", stl([t for _ in range(boxes) for t in box(place(), 0.02)]), False
    yield "boxes_nested.stl", stl([t for k in range(boxes) for t in box((0, 0, 0), 0.02 + 1e-5 * k)]), False
    yield "random.stl", stl([(place(), place(), place()) for _ in range(count)]), False
    yield "one_triangle.stl", stl([((0, 0, 0), (0.05, 0, 0), (0, 0.05, 0))] * count), True
    yield "slivers.stl", stl([((0, 0, 0), (0.1 * math.cos(a), 0.1 * math.sin(a), 1e-4 * a),
                               (0.1 * math.cos(a + 1e-6), 0.1 * math.sin(a + 1e-6), 0))
                              for a in (1e-3 * k for k in range(count))]), False
    yield "ball.stl", stl(ball(100, 99, 0.03, 0)), False
    yield "crumpled.stl", stl(ball(100, 99, 0.03, 0.4)), False
    corners = 34000
    yield "polygon.obj", ("".join("v %g %g 0\n" % (math.cos(k), math.sin(k)) for k in range(corners)) +
                          "f " + " ".join(map(str, range(1, corners + 1)))).encode(), True
    yield "promise.ply", (b"ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n"
                          b"element face 4000000000\nproperty list uchar int vertex_indices\nend_header\n" + b"0 0 0\n" * 150000), True
    yield "deep.dae", b'<?xml version="1.0"?>' + b"<a>" * 200000, True
    yield "numbers.stl", (b"solid x\n" + b"facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1e300 0 0\nvertex nan 1 0\n"
                          b"endloop\nendfacet\n" * 9000), True


def requests():
    yield "brackets", "parts: " + "[" * 490000
    yield "braces", "parts: " + "{a: " * 240000
    yield "laughs", "a0: &a0 [%s]\n" % ",".join("x" * 9) + "".join(
        "a%d: &a%d [%s]\n" % (k, k, ",".join(["*a%d" % (k - 1)] * 9)) for k in range(1, 30)) + "parts: *a29\n"
    yield "keys", "".join("key%d: 1\n" % k for k in range(80000))
    yield "parts", "parts:\n" + "- {model: box.stl, count: 1}\n" * 33000
    yield "sensors", "parts: [{model: box.stl, count: 1}]\nsensors:\n" + "".join("- {name: s%d}\n" % k for k in range(50000))
    yield "name", 'parts: [{model: "%s"}]' % ("x" * 990000)
    yield "count", "parts: [{model: box.stl, count: 1000000000}]"
    yield "motion", "bin: {motion: {poses: [%s]}}\nparts: [{model: box.stl, count: 1}]" % ",".join(
        "{time: %d, pose: [0,0,0,0,0,0,1]}" % k for k in range(20000))
    yield "twice", "parts: []\n" * 100000
    yield "comments", "#\n" * 500000
    yield "documents", "---\n" * 250000
    yield "merges", "parts:\n" + "- &a {<<: *a}\n" * 50000


def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(command, folder):
    """Exit code, message, and processor seconds of it and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, capture_output=True, preexec_fn=limits, timeout=20 * LIMIT_S,
                          env=dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"), BIN_SCENES_PROGRESS="0"))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.returncode, done.stderr, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    tool, everything = pathlib.Path(sys.argv[1]).resolve(), "--all" in sys.argv
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        cases = []
        for name, data, quick in models():
            if quick or everything:
                (folder / name).write_bytes(data)
                cases.append((name, [tool, "inspect", name]))
        (folder / "box.stl").write_bytes(stl(box((0, 0, 0), 0.02)))
        for name, text in requests():
            (folder / (name + ".yaml")).write_text(text)
            cases.append((name + ".yaml", [tool, "generate", name + ".yaml", "--out", name]))
        for name, command in cases:
            assert (folder / name).stat().st_size <= SIZE, name
            code, message, seconds = run(command, folder)
            lines = message.decode("utf-8", "replace").splitlines()
            answered = code == 0 or code == 1 and len(lines) == 2 and "set apart" in lines[0]  # and why, in the second
            good = answered or (code in (1, 2, 3) and len(lines) == 1)
            good &= code == 0 or len(message) < 1000 and message.endswith(b"\n") and all(map(str.isprintable, lines))
            wrong += not good
            print("| %s | %s | %.1f s | %s |" % (name, "answered" if answered else "refused" if good else "WRONG, exit %d" % code,
                                              seconds, message[:150].decode("utf-8", "replace").strip()), flush=True)
    print("%d passed, %d failed" % (len(cases) - wrong, wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
