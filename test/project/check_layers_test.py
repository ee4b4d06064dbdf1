#!/usr/bin/env python3
"""scripts/check_layers finds each kind of offence in a tree made for it, and nothing in a clean one."""
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "check_layers"


def offences(files):
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            file = pathlib.Path(root) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        run = subprocess.run([SCRIPT, root], capture_output=True, text=True)
        lines = run.stdout.splitlines()
        assert (run.returncode == 0) == (lines == ["layers: as they should be"]), run.stdout
        return [] if run.returncode == 0 else lines


class CheckLayers(unittest.TestCase):
    header = {"include/bin_scenes/core/a.hpp": "", "include/bin_scenes/solver/solver.hpp": "",
              "src/solver/bullet/b.hpp": "", "src/ros/r.hpp": "", "test/vocabulary.hpp": ""}

    def expect(self, path, line, offence):
        found = offences({**self.header, path: "// first\n" + line + "\n"})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(path + ":2: "), found)
        self.assertIn(offence, found[0])

    def allow(self, path, line):
        self.assertEqual(offences({**self.header, path: line + "\n"}), [])

    def test_directions(self):
        self.allow("src/solver/a.cpp", '#include "bin_scenes/core/a.hpp"')
        self.expect("src/core/a.cpp", '#include "bin_scenes/solver/solver.hpp"', "core may not include solver")
        self.expect("src/generate/a.cpp", '#include "ros/r.hpp"', "generate may not include ros")
        self.expect("src/solver/sphere/a.cpp", '#include "solver/bullet/b.hpp"', "sphere includes solver bullet")
        self.expect("src/core/a.cpp", '#include "vocabulary.hpp"', "the library includes test/")
        self.expect("include/bin_scenes/ros/a.hpp", '#include "../../../src/ros/r.hpp"', "private")
        self.expect("src/extra/a.cpp", '#include "bin_scenes/core/a.hpp"', "layer 'extra' is unknown")

    def test_foreign_headers(self):
        self.allow("src/ros/a.cpp", "#include <ros/ros.h>")
        self.allow("include/bin_scenes/core/b.hpp", "#include <Eigen/Core>")
        self.allow("include/bin_scenes/core/b.hpp", "#include <vector>")
        self.expect("src/part/a.cpp", "#include <sensor_msgs/Image.h>", "belongs in src/ros")
        self.expect("src/solver/a.cpp", "#include <btBulletDynamicsCommon.h>", "belongs in src/solver/bullet")
        self.expect("src/output/a.cpp", "#include <pcl/io/pcd_io.h>", "belongs in src/ros")
        self.expect("include/bin_scenes/core/b.hpp", "#include <fcntl.h>", "a public header shows")

    def test_hosts_and_machine_paths(self):
        self.allow("scripts/a", "curl http://127.0.0.1:11311")
        self.expect("scripts/a", "curl http://" + "www.example.org/x", "names a host")
        self.expect("README.md", "from deb." + "example.org", "names a host")
        self.expect("src/core/a.cpp", 'open("/home' + '/alice/x")', "path of one machine")


if __name__ == "__main__":
    unittest.main()
