"""Scenes of parts lying in a bin, as numpy arrays: poured, at rest, judged on their true meshes, seen by range cameras.

    import bin_scenes

    with bin_scenes.Generator() as g:
        for s in g.generate("conrods.yaml", scenes=100):      # or a dict; keyword arguments override keys
            s.poses, s.ids, s.report, s.images["camera"].depth

        heap = g.heap("conrods.yaml")
        heap.settle()
        heap.remove([3])
        heap.settle()
        heap.scene().poses

SI units, z up; a pose is x y z qx qy qz qw: the model file's own frame, scaled to metres, in the bin frame. What is wrong
is an Error with `what`, `where` and `remedy`. `bin_scenes.data` reads finished data sets.

With ROS, the messages of this package are bin_scenes.msg and bin_scenes.srv. For their sake, and for data's, the
compiled module is loaded when the first name that needs it is used.
"""
import importlib
from typing import TYPE_CHECKING, Any, List

from ._error import Error

if TYPE_CHECKING:
    from . import data
    from ._core import Image, Scene, Scenes, __version__
    from ._generator import Generator, Heap

__all__ = ["Error", "Generator", "Heap", "Image", "Scene", "Scenes", "__version__", "data"]


def __getattr__(name: str) -> Any:
    if name == "data":
        return importlib.import_module("bin_scenes.data")
    if name not in __all__:
        raise AttributeError("module 'bin_scenes' has no attribute '%s'" % name)
    from ._load import load
    core = load()
    return getattr(importlib.import_module("bin_scenes._generator") if name in ("Generator", "Heap") else core, name)


def __dir__() -> List[str]:
    return sorted(__all__)
