"""What the tests of the Python module share. A test is called with the folder of the packages and the command line:

    x_test.py PACKAGES TOOL
"""
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES, TOOL = (os.path.abspath(sys.argv.pop(1)) for _ in range(2))
sys.path.insert(0, PACKAGES)

NUT = str(ROOT / "models/nut_hex.stl")
CONROD = str(ROOT / "models/conrod.stl")


def nuts(count=10, **keys):
    """A request of nuts in a small bin, seen by a small camera."""
    request = {"seed": 3, "bin": {"inner_size": [0.12, 0.12, 0.1]}, "parts": [{"model": NUT, "unit": "mm", "count": count}],
               "sensors": [{"name": "camera", "width": 160, "height": 120}]}
    request.update(keys)
    return request


def endless():
    """A request that takes far longer than any test waits."""
    return nuts(400, pour={"pattern": "rain", "limit": 1000.0}, seconds=1000.0, bin={"inner_size": [0.3, 0.3, 0.3]})
