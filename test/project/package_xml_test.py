#!/usr/bin/env python3
"""package.xml names what scripts/install_deps installs, and nothing else: rosdep users get what Debian users get."""
import pathlib
import re
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]

# What Debian 12 has for rosdep's keys that are not named like Debian's packages, or bring more than one that we list.
DEBIAN = {
    "assimp": ["libassimp-dev"],
    "bullet": ["libbullet-dev"],
    "bullet-extras": ["libbullet-extras-dev"],
    "cli11": ["libcli11-dev"],
    "dynamic_reconfigure": ["libdynamic-reconfigure-config-init-mutex-dev"],
    "eigen": ["libeigen3-dev"],
    "gtest": ["libgtest-dev"],
    "libepoxy-dev": ["libepoxy-dev", "libegl-dev"],
    "libpcl-all-dev": ["libpcl-dev"],
    "libjpeg": ["libjpeg-dev"],
    "libopencv-dev": ["libopencv-calib3d-dev"],
    "nodelet": ["libnodelet-dev", "libnodeletlib-dev", "libnodeletlib-tools"],
    "nlohmann-json-dev": ["nlohmann-json3-dev"],
    "opengl": ["libegl1", "libopengl0", "libgl1-mesa-dri"],
    "tbb": ["libtbb-dev"],
    "tinyxml2": ["libtinyxml2-dev"],
    "yaml-cpp": ["libyaml-cpp-dev"],
}
# Installed for work on this package, not for the package: compilers come with catkin or build-essential.
OURS = {"g++", "cmake", "ninja-build", "ccache", "pkg-config", "python3", "assimp-testmodels", "libnss-myhostname",
        "clang-format", "clang-tidy", "shellcheck", "pyflakes3",  # for test/project/style_test.py
        "mypy", "python3-build", "python3-wheel",  # types and wheel of the Python module
        "catkin-lint", "clang", "libclang-rt-dev",  # for the tests; for the fuzzers
        "glslang-tools", "spirv-tools", "spirv-headers",  # rosdep has no key of them; where one is missing its test is skipped
        "libembree-dev",  # rosdep has no key of it: scripts/install_deps installs it for catkin's users too
        "mkdocs", "mkdocs-material", "doxygen",  # for the documentation site
        "libfastcdr-dev",  # neither of it: its key is of ROS 2
        "libocct-data-exchange-dev",  # without it STEP and IGES are not read
        "libjs-three",  # for reports; without it they have no 3-D view
        # node, a browser, a cluster and a shell, which tests start; where they are missing these tests are skipped
        "nodejs", "npm", "chromium", "slurmctld", "slurmd", "slurm-client", "munge", "zsh",
        # of the shell: rosrun, rosservice, rostopic and rospack, which come with a ROS that has roslaunch
        "rosbash", "rospack-tools", "python3-rosservice", "python3-rostopic"}


def installed(script):
    """Debian's packages by the name of their array in scripts/install_deps."""
    arrays = {}
    for name, text in re.findall(r"^(\w+)=\(([^()]*(?:\([^()]*\)[^()]*)*)\)", script, re.MULTILINE):
        words = re.sub(r"#.*", "", text).split()
        if words:
            arrays[name] = words
    return arrays


def keys(xml):
    return {e.text for e in xml.iter() if e.tag.endswith("depend")}


def ros_package(debian):
    """tf2_ros of libtf2-ros-dev, ros-tf2-ros, python3-tf2-ros."""
    return re.sub(r"^(ros-|python3-|lib)|-dev$", "", debian).replace("-", "_")


class PackageXml(unittest.TestCase):
    def setUp(self):
        self.arrays = installed((ROOT / "scripts/install_deps").read_text())
        self.keys = keys(xml.etree.ElementTree.parse(ROOT / "package.xml").getroot())

    def test_the_list_is_read_whole(self):
        self.assertEqual(set(self.arrays) - {"root", "failed", "wanted"},
                         {"build", "libraries", "pcd", "cad", "python", "run", "report", "realism", "tests", "dataset_tests", "bench", "package", "fuzz", "docs",
                          "readers", "ros",
                          "ros_pcl", "ros_tests"})
        self.assertIn("libtinyxml2-dev", self.arrays["libraries"])
        self.assertIn("rosbash", self.arrays["ros"])

    def test_what_is_installed_has_a_key(self):
        provided = {p for key in self.keys for p in DEBIAN.get(key, [key])}
        missing = []
        for name in ("build", "libraries", "pcd", "python", "run", "report", "realism", "tests", "dataset_tests", "docs", "ros",
                     "ros_pcl", "ros_tests"):
            for package in self.arrays[name]:
                known = package in provided or name.startswith("ros") and ros_package(package) in self.keys
                if not known and package not in OURS:
                    missing.append(package)
        self.assertEqual(missing, [], "package.xml lacks keys for them")

    def test_every_key_is_installed(self):
        packages = {p for name in ("libraries", "pcd", "python", "run", "realism", "tests", "ros", "ros_pcl", "ros_tests") for p in self.arrays[name]}
        ros = {ros_package(p) for p in self.arrays["ros"] + self.arrays["ros_pcl"] + self.arrays["ros_tests"]}
        unknown = [k for k in sorted(self.keys)
                   if k not in ros and not packages.issuperset(DEBIAN.get(k, [k]))]
        self.assertEqual(unknown, [], "scripts/install_deps lacks packages for them")


if __name__ == "__main__":
    unittest.main()
