"""Generator and Heap."""
from types import TracebackType
from typing import Any, Iterable, List, Mapping, Optional, Sequence, Type, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._error import Error
from ._request import Request, read

Ids = Union[int, Sequence[int], "npt.NDArray[Any]"]
Vector = Union[Sequence[float], "npt.NDArray[Any]"]
MOST_GRAVITY = 1e4  # m/s2, of a component: what a request may have


def _ids(ids: Ids, where: str) -> List[int]:
    array = np.atleast_1d(np.asarray(ids))
    if array.ndim != 1 or array.size and not np.issubdtype(array.dtype, np.integer):
        raise Error("ids of shape %s and type %s" % (array.shape, array.dtype), where, "give whole numbers, as in Scene.ids")
    for i in array:
        if not 0 <= i < 2**31:
            raise Error("no part has the id %d" % i, where, "give ids of Scene.ids")
    return [int(i) for i in array]


def _flag(value: Any, name: str, where: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise Error("%s is %r" % (name, value), where, "give True or False")
    return bool(value)


def _vector(vector: Vector, where: str) -> List[float]:
    try:
        array = np.asarray(vector, dtype=float)
    except (TypeError, ValueError):
        raise Error("is no vector: %r" % (vector,), where, "give three numbers x y z") from None
    if array.shape != (3,) or not np.isfinite(array).all():
        raise Error("a vector of shape %s%s" % (array.shape, "" if np.isfinite(array).all() else " that is not finite"),
                    where, "give three finite numbers x y z")
    return [float(x) for x in array]


class Generator:
    """Makes scenes, and keeps between requests what is expensive: loaded models, the device.

    The work is done in a thread of its own, for one caller at a time; Python's other threads go on meanwhile. A second
    caller gets an Error, as does a child of os.fork(): make a Generator in each process. Ctrl-C cancels what is being
    made and raises KeyboardInterrupt; the generator can be used again.
    """

    def __init__(self) -> None:
        self._session = _core.Session()

    def __enter__(self) -> "Generator":
        self._session.refuse_if_closed()
        return self

    def __exit__(self, type: Optional[Type[BaseException]], value: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.close()

    def close(self) -> None:
        """Cancels what is being made and lets go of models, device and heaps. Scenes made before stay valid."""
        self._session.close()

    def generate(self, request: Request, *, scenes: Optional[int] = None, seed: Optional[int] = None,
                 first: Optional[int] = None, prefetch: int = 0, images: bool = True, grasps: bool = False,
                 gray: bool = False, **overrides: Any) -> "_core.Scenes":
        """Scenes of a request, in order of their index: an iterator of Scene.

        request:   name of a YAML file, or a dict of the same keys; a dict may hold arrays, for instance
                   parts[0]["poses"] of shape (N, 7). Its relative paths start at the current directory.
        scenes, seed, first:  keys of the request. Scene i depends on request, seed and i alone, bit for bit: it is the
                   scene that `bin_scenes generate` writes. A loop without end asks for scenes=10**9.
        prefetch:  scenes made ahead at most, in the background, while the loop's body runs; 0: none
        images:    False: no sensor image is made
        grasps:    True: Scene.grasps are found, for the request's grippers
        gray:      True: range sensors make Image.gray as well, which takes up to a fifth more of their time
        overrides: further keys, as `--set` has them, which replace what the request says: bin={"floor": True},
                   solver__type="bullet" (or **{"solver.type": "bullet"}), parts__0__count=20

        Scenes that were not accepted come, too: look at Scene.accepted. Leaving the loop stops what is made ahead.
        """
        if not isinstance(prefetch, (int, np.integer)) or not 0 <= prefetch <= 1000:
            raise Error("prefetch is %r" % (prefetch,), "Generator.generate", "give 0 to 1000 scenes")
        self._session.refuse_if_closed()
        wanted = [_flag(images, "images", "Generator.generate"), _flag(grasps, "grasps", "Generator.generate"),
                  _flag(gray, "gray", "Generator.generate")]
        return self._session.generate(read(request, scenes=scenes, seed=seed, first=first, **overrides), int(prefetch), *wanted)

    def heap(self, request: Request, *, seed: Optional[int] = None, first: Optional[int] = None, **overrides: Any) -> "Heap":
        """Scene `first` of a request as a heap that can be changed: settle() pours it. Arguments as in generate()."""
        self._session.refuse_if_closed()
        return Heap(self._session.heap(read(request, seed=seed, first=first, **overrides)))


class Heap:
    """A heap that outlives its scene. Made by Generator.heap(); used, and ended, with its generator."""

    def __init__(self, heap: "_core.Heap") -> None:
        self._heap = heap

    def settle(self) -> bool:
        """Simulates until all parts rest, or for pour.limit (s, simulated). Returns whether they rest."""
        return self._heap.settle()

    def remove(self, ids: Ids) -> None:
        """Takes parts out. During the next settle() only those move that they held up."""
        self._heap.remove(_ids(ids, "Heap.remove"))

    def lift(self, ids: Ids, direction: Vector = (0.0, 0.0, 1.0), distance: float = 0.1) -> None:
        """Moves parts by `distance` (m) along `direction` (x y z, bin frame) at 0.1 m/s, and drags along what hangs on
        them. Afterwards remove() them, or let them fall by settle()."""
        try:
            length = float(distance)
        except (TypeError, ValueError):
            raise Error("is no length: %r" % (distance,), "Heap.lift: distance", "give a number in m") from None
        self._heap.lift(_ids(ids, "Heap.lift"), _vector(direction, "Heap.lift: direction"), length)

    def add(self, parts: Union[Mapping[str, Any], Sequence[Mapping[str, Any]]]) -> "npt.NDArray[np.int32]":
        """Pours more onto the heap during the next settle(): lines as in `parts` of a request. Returns the new ids."""
        if not isinstance(parts, Iterable):
            raise Error("a %s is no part line" % type(parts).__name__, "Heap.add", "give a dict with `model`")
        lines = [parts] if isinstance(parts, Mapping) else list(parts)
        if not lines:
            raise Error("no part line is given", "Heap.add", "name at least one model")
        requests = []
        for line in lines:
            if not isinstance(line, Mapping):
                raise Error("a %s is no part line" % type(line).__name__, "Heap.add", "give a dict with `model`")
            placed = line.get("poses") is not None and not line.get("fixed", False)
            requests.append(read({"parts": [line], "pour": {"pattern": "given" if placed else "rain"}}))
        return np.array(self._heap.add(requests), np.int32)

    def set_gravity(self, gravity: Vector) -> None:
        """Tilts or turns the heap: gravity (m/s2) x y z in the bin frame. All parts wake."""
        vector = _vector(gravity, "Heap.set_gravity")
        if max(abs(x) for x in vector) > MOST_GRAVITY:
            raise Error("a component of %g m/s2" % max(vector, key=abs), "Heap.set_gravity",
                        "give at most %g, as in a request" % MOST_GRAVITY)
        self._heap.set_gravity(vector)

    def scene(self, images: bool = True, grasps: bool = False, gray: bool = False) -> "_core.Scene":
        """The heap as it is now, judged, and seen by the request's sensors unless `images` is False. With `grasps` of the
        request's grippers, and with Image.gray if `gray`."""
        return self._heap.scene(_flag(images, "images", "Heap.scene"), _flag(grasps, "grasps", "Heap.scene"),
                                _flag(gray, "gray", "Heap.scene"))
