#!/usr/bin/python3
"""The wheel: built without network by Debian's tools, installed into fresh virtual environments, refused where it must be.
CMake and ccache compile most of the module once more.

    wheel_test.py [FOLDER FOR CMAKE]
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else str(ROOT / "build-wheel")

USE = """
import bin_scenes, json, sys
request = {"seed": 3, "bin": {"inner_size": [0.12, 0.12, 0.1]}, "sensors": [{"name": "camera", "model": "structured_light",
           "preset": "structured_light_0.7m_750mm", "width": 64, "height": 48}],
           "parts": [{"model": sys.argv[1], "unit": "mm", "count": 4, "surface": {"material": "steel_brushed"}}]}
with bin_scenes.Generator() as g:
    s = next(g.generate(request))
print(s.poses.shape, s.images["camera"].depth.shape, s.report["at_rest"])
"""


def run(*command, **how):
    # no index, no compiler beside ours: what needs the network fails
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "BIN_SCENES", "PIP"))}
    environment.update(PIP_NO_INDEX="1", PIP_DISABLE_PIP_VERSION_CHECK="1", BIN_SCENES_WHEEL_BUILD=BUILD,
                       CMAKE_BUILD_PARALLEL_LEVEL=os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", "2"))
    return subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          env=environment, **how)


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="bin_scenes_wheel_")
        cls.folder = pathlib.Path(cls.temporary.name)
        # With the flags of scripts/test, and beside its folders, ccache has all objects.
        done = run("cmake", "-G", "Ninja", "-S", ROOT, "-B", BUILD, "-DBIN_SCENES_ROS=OFF", "-DBIN_SCENES_PCL=OFF",
                   "-DBIN_SCENES_TESTS=OFF", "-DBIN_SCENES_WERROR=ON", "-DPYTHON_EXECUTABLE=" + os.path.realpath("/usr/bin/python3"))
        assert done.returncode == 0, done.stdout
        done = run("/usr/bin/python3", "-m", "build", "--wheel", "--no-isolation", "--outdir", cls.folder, ROOT)
        assert done.returncode == 0, done.stdout
        [cls.wheel] = cls.folder.glob("*.whl")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def environment(self, name, *options):
        """A fresh virtual environment; its python."""
        done = run("/usr/bin/python3", "-m", "venv", *options, self.folder / name)
        self.assertEqual(done.returncode, 0, done.stdout)
        return self.folder / name / "bin/python"

    def test_installed_into_an_environment_with_debians_numpy(self):
        python = self.environment("system", "--system-site-packages")
        done = run(python, "-m", "pip", "install", self.wheel)
        self.assertEqual(done.returncode, 0, done.stdout)
        used = run(python, "-c", USE, ROOT / "models/nut_hex.stl", cwd=self.folder)
        self.assertEqual(used.stdout, "(4, 7) (48, 64) True\n")
        self.check_files(self.folder / "system")
        self.check_another_python(python)

    def check_files(self, environment):
        [package] = environment.glob("lib/python3*/site-packages/bin_scenes")
        self.assertTrue((package.parent / "bin_scenes_data/shards.py").is_file())
        for file in ("py.typed", "_core.pyi", "share/bin_scenes/config/sensors/ideal.yaml", "share/bin_scenes/models/conrod.stl",
                     "share/bin_scenes/config/materials/brass.yaml", "share/bin_scenes/shaders/shared/types.h"):
            self.assertTrue((package / file).is_file(), file)

    def check_another_python(self, python):
        """As if another Python found the package on its path; then one that lacks the module."""
        [module] = self.folder.glob("system/lib/python3*/site-packages/bin_scenes/_core.*.so")
        other = module.with_name(re.sub(r"cpython-\d+", "cpython-35", module.name))
        module.rename(other)
        code = "import bin_scenes\nbin_scenes.data\ntry: bin_scenes.Generator\nexcept bin_scenes.Error as e: print(e.kind, '|', e.what, '|', e.remedy)"
        told = run(python, "-c", code, cwd=self.folder).stdout
        self.assertRegex(told, r"^environment \| built for another Python \(cpython-35-\S+\), and this is cpython 3\.\d+ \| run .*\n$")
        other.write_bytes(b"no library")
        other.rename(module)
        self.assertRegex(run(python, "-c", code, cwd=self.folder).stdout, r"^environment \| .*_core\S+: .* \| install the libraries.*\n$")
        module.unlink()
        self.assertRegex(run(python, "-c", code, cwd=self.folder).stdout, r"^environment \| the compiled module is not there \| build .*\n$")

    def test_without_numpy_pip_says_so(self):
        python = self.environment("plain")
        done = run(python, "-m", "pip", "install", self.wheel)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("No matching distribution found for numpy", done.stdout)

    def test_pip_refuses_it_for_another_python(self):
        python = self.environment("other")
        other = self.folder / re.sub(r"cp\d+-cp\d+", "cp35-cp35m", self.wheel.name)
        other.symlink_to(self.wheel)
        done = run(python, "-m", "pip", "install", "--no-deps", other)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("is not a supported wheel on this platform", done.stdout)

    def test_pip_install_of_the_folder(self):
        python = self.environment("folder", "--system-site-packages")
        done = run(python, "-m", "pip", "install", "--no-build-isolation", ROOT)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.check_files(self.folder / "folder")


if __name__ == "__main__":
    unittest.main()
