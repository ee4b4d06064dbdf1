#!/usr/bin/env python3
"""scripts/test compiles nothing again that scripts/demo has compiled: both have the same command lines.

    compiled_once_test.py BUILD     a build folder with the options of scripts/test
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGETS = r"src/(?!output/CMakeFiles/bin_scenes_output\.dir/pcd\.cpp)"  # which has other headers without PCL


def commands(build):
    """Command line by object, of all that is compiled below src/."""
    database = json.loads(subprocess.check_output(["ninja", "-C", build, "-t", "compdb"], text=True))
    return {entry["output"]: entry["command"].replace(str(build), "BUILD") for entry in database
            if re.match(TARGETS, entry["output"]) and entry["output"].endswith(".o")}


def configure(script, folder):
    """Configures with the options that stand in the script."""
    code = re.sub(r"^#.*", "", (ROOT / "scripts" / script).read_text(), flags=re.MULTILINE)
    options = re.findall(r"-DBIN_SCENES_\w+=\w+", code)
    subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", folder, *options], check=True, capture_output=True)


class CompiledOnce(unittest.TestCase):
    def test_demo_and_test_compile_alike(self):
        with tempfile.TemporaryDirectory() as folder:
            configure("demo", folder)
            demo, test = commands(folder), commands(BUILD)
        self.assertGreater(len(demo), 20)
        for output, command in demo.items():
            with self.subTest(output=output):
                self.assertEqual(command, test.get(output))


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
