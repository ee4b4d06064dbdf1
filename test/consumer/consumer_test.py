#!/usr/bin/env python3
"""A project of another author finds, compiles with and runs the library.
    consumer_test.py --build FOLDER --compiler C++ plain|catkin
plain: against an install tree made here. catkin: against the development space of a build with ROS."""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SHARE = "share/bin_scenes"


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}\nexit {done.returncode}")
    return done.stdout


def built(project, prefix, compiler, folder):
    """Configures and builds the project against the prefix; returns the compiler's command of its one file."""
    run("cmake", "-G", "Ninja", "-S", HERE / project, "-B", folder, f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_CXX_COMPILER={compiler}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DPYTHON_EXECUTABLE=/usr/bin/python3")
    run("cmake", "--build", folder)
    commands = [entry["command"] for entry in json.loads((folder / "compile_commands.json").read_text())]
    return next(command for command in commands if HERE.name in command)


def expect(condition, what):
    if not condition:
        sys.exit(f"consumer_test: {what}")


def plain(build, compiler, work):
    prefix = work / "prefix"
    run("cmake", "--install", build, "--prefix", prefix)
    command = built("plain", prefix, compiler, work / "picker")
    flags = re.findall(r"\s(-[fWOmD]\S+)", command)
    leaked = [flag for flag in flags if not flag.startswith("-DROS")]
    expect(not leaked, f"flags of bin_scenes reach its users: {leaked}")
    expect(str(prefix / "include") in command, f"the headers are not those of the install tree: {command}")

    # Nothing of the build tree is needed, shaders included.
    environment = {**os.environ, "BIN_SCENES_GL": "software"}
    lines = run(work / "picker" / "picker", prefix / SHARE / "models", env=environment).splitlines()
    poses = [line for line in lines if line.startswith("part ")]
    expect(len(poses) == 50, f"50 poses expected, {len(poses)} found: {lines}")
    last = re.fullmatch(r"took out part \d+: at rest 1, (\d+) of 49 parts did not move", lines[-1])
    expect(last and 10 <= int(last[1]) <= 49, f"a pick leaves what it does not touch: {lines[-1]}")

    # The library's results are those of the program, whoever links it.
    request = work / "nuts.yaml"
    request.write_text("{seed: 7, bin: {inner_size: [0.12, 0.1, 0.1]}, "
                       f"parts: [{{model: {prefix / SHARE}/models/nut_hex.stl, unit: mm, count: 50}}]}}\n")
    run(prefix / "bin" / "bin_scenes", "generate", request, "--out", work / "out", "--formats", "json", env=environment)
    scene = json.loads((work / "out" / "scene_000000" / "scene.json").read_text())
    tool = [part["pose"]["position"] for part in scene["parts"]]
    for line, position in zip(poses, tool):
        expect(line.endswith("%.4f %.4f %.4f" % tuple(position)), f"the program has {position} where the library: {line}")


def catkin(build, compiler, work):
    command = built("catkin", build / "devel", compiler, work / "depot")
    expect("-ffp-contract" not in command and "EIGEN_FAST_MATH" not in command, f"flags leak: {command}")
    program, = work.glob("depot/devel/lib/depot/depot")
    expect(run(program, HERE.parents[1] / "models").strip() == "50 parts in a bin_scenes/Scene", "the message's type is another")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", default="c++")
    parser.add_argument("kind", choices=["plain", "catkin"])
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        {"plain": plain, "catkin": catkin}[arguments.kind](arguments.build, arguments.compiler, pathlib.Path(work))


if __name__ == "__main__":
    main()
