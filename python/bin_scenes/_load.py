"""Imports the compiled module, or says why it cannot be had."""
import importlib
import pathlib
import re
import sys
from types import ModuleType

from ._error import Error


def load() -> ModuleType:
    """bin_scenes._core; Error, if it is not there, was built for another Python, or lacks a library."""
    try:
        return importlib.import_module("bin_scenes._core")
    except ImportError as error:
        folder = pathlib.Path(__file__).parent
        built = sorted(folder.glob("_core.*.so"))
        if isinstance(error, ModuleNotFoundError) and built:
            tag = re.sub(r"^_core\.|\.so$", "", built[0].name)
            raise Error("built for another Python (%s), and this is %s %d.%d" % (
                tag, sys.implementation.name, *sys.version_info[:2]), str(folder),
                "run the Python it was built for, or `pip install .` with this one", "environment") from None
        if built:
            raise Error(str(error), str(built[0]), "install the libraries that it was built with: scripts/install_deps core",
                        "environment") from None
        raise Error("the compiled module is not there", str(folder),
                    "build with -DBIN_SCENES_PYTHON=ON and pybind11-dev, or `pip install .`", "environment") from None
