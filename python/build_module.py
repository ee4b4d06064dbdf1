"""How setuptools makes the wheel: CMake compiles the module, with BIN_SCENES_ROS=OFF, in a folder build-wheel-* of the
source tree for each Python (BIN_SCENES_WHEEL_BUILD names another). Shaders, presets and sample parts go into the wheel, too."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig

from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

ROOT = pathlib.Path(__file__).resolve().parent.parent
version = re.search(r"project\(bin_scenes VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def compiled():
    """The module, made for the Python that runs this."""
    build = pathlib.Path(os.environ.get("BIN_SCENES_WHEEL_BUILD", ROOT / ("build-wheel-" + sys.implementation.cache_tag)))
    for program in ("cmake", "ninja"):
        if not shutil.which(program):
            sys.exit("bin_scenes: %s is missing; scripts/install_deps core installs what the module is built with" % program)
    subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", build, "-DBIN_SCENES_ROS=OFF", "-DBIN_SCENES_PCL=OFF",
                    "-DBIN_SCENES_TESTS=OFF", "-DBIN_SCENES_PYTHON=ON", "-DPYTHON_EXECUTABLE=" + os.path.realpath(sys.executable)], check=True)
    done = subprocess.run(["cmake", "--build", build, "--target", "bin_scenes_python"])
    if done.returncode != 0:
        sys.exit("bin_scenes: the module was not built, for the reason above; without pybind11 (pybind11-dev) there is no target")
    return build / "python/bin_scenes" / ("_core" + sysconfig.get_config_var("EXT_SUFFIX"))


class Build(build_py):
    def run(self):
        shutil.rmtree(self.build_lib, ignore_errors=True)  # what an earlier tree had
        super().run()
        package = pathlib.Path(self.build_lib) / "bin_scenes"
        shutil.copy2(compiled(), package)
        share = package / "share/bin_scenes"
        shutil.copytree(ROOT / "shaders", share / "shaders", ignore=shutil.ignore_patterns("test"))
        shutil.copytree(ROOT / "config", share / "config")
        (share / "models").mkdir()
        for model in (ROOT / "models").glob("*.stl"):
            shutil.copy2(model, share / "models")


class Wheel(bdist_wheel):
    """Named for one Python and one kind of processor: pip refuses it elsewhere."""

    def finalize_options(self):
        self.distribution.has_ext_modules = lambda: True
        super().finalize_options()
