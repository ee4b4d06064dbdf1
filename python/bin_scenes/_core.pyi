"""Types of the compiled module. Arrays are the scene's own memory: they are not copied, keep the scene alive, and may be
written to. N is the number of parts, H and W rows and columns of an image. SI units."""
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

__version__: str

class Image:
    """What a sensor delivers of a scene, in its optical frame (x right, y down, z forward), with the truth beside it.
    The truth is that of the camera's own view (sensor width x height); for laser_line, H is the number of profiles."""

    @property
    def name(self) -> str: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def depth_scale(self) -> float:
        """m a count, if depth is stored in 16 bits as the command line does."""
    @property
    def K(self) -> npt.NDArray[np.float64]:
        """(3, 3) intrinsics, pixels."""
    @property
    def distortion(self) -> npt.NDArray[np.float64]:
        """(5,) plumb_bob: k1 k2 p1 p2 k3."""
    @property
    def pose(self) -> npt.NDArray[np.float64]:
        """(7,) optical frame in the bin frame: x y z (m) qx qy qz qw."""
    @property
    def depth(self) -> npt.NDArray[np.float32]:
        """(H, W) along the optical axis (m); NaN where nothing valid was measured."""
    @property
    def label(self) -> npt.NDArray[np.uint16]:
        """(H, W) part id + 1 where depth is valid, else 0."""
    @property
    def intensity(self) -> npt.NDArray[np.float32]:
        """(H, W) 0 to 1."""
    @property
    def snr(self) -> npt.NDArray[np.float32]:
        """(H, W) signal / standard deviation of its noise, as predicted."""
    @property
    def validity(self) -> npt.NDArray[np.uint8]:
        """(H, W) 0 valid, else the reason (docs/use/sensors.md)."""
    @property
    def picture(self) -> Optional[Union[npt.NDArray[np.uint8], npt.NDArray[np.uint16]]]:
        """Of model `image`: (H, W) grey or (H, W, 3) red, green, blue; counts of its 8 or 16 bits. Else None."""
    def channel(self, name: str) -> Optional[Union[npt.NDArray[np.uint8], npt.NDArray[np.uint16]]]:
        """Counts of a channel as the files of format `png` hold it, such as "truth_depth": (H, W) or (H, W, 3). None if
        the image has none. bin_scenes.Error for an unknown name."""
    @property
    def gray(self) -> Optional[npt.NDArray[np.uint8]]:
        """(H, W) levels of the grey image (docs/use/sensors.md). None for range sensors unless asked for by `gray`."""
    @property
    def points(self) -> npt.NDArray[np.float32]:
        """(H, W, 3) organised cloud (m); NaN where depth is. Made at first use."""
    @property
    def normals(self) -> npt.NDArray[np.float32]:
        """(H, W, 3) of the measured points, towards the camera. Made at first use."""
    @property
    def truth_depth(self) -> npt.NDArray[np.float32]:
        """(H, W) without any effect of the sensor (m)."""
    @property
    def truth_label(self) -> npt.NDArray[np.uint16]:
        """(H, W) part id + 1, 0 for bin and background."""
    @property
    def truth_normals(self) -> npt.NDArray[np.float32]:
        """(H, W, 3) of the true surface, towards the camera; NaN where nothing is."""
    @property
    def visible_pixels(self) -> npt.NDArray[np.int64]:
        """(N,) true pixels of each part that are seen."""
    @property
    def total_pixels(self) -> npt.NDArray[np.int64]:
        """(N,) pixels that would be seen of it, if it were alone."""

class Scene:
    """A finished scene. Rows of all arrays are the parts, in order of their id."""

    @property
    def seed(self) -> int: ...
    @property
    def index(self) -> int: ...
    @property
    def accepted(self) -> bool:
        """False: report["reasons"] says why the command line would set it apart."""
    @property
    def at_rest(self) -> bool: ...
    @property
    def poses(self) -> npt.NDArray[np.float64]:
        """(N, 7) x y z (m) qx qy qz qw: frame of the model file in the bin frame; NaN for a part that is not there."""
    @property
    def velocities(self) -> npt.NDArray[np.float64]:
        """(N, 6) of the centre of mass (m/s), then angular (rad/s), bin frame."""
    @property
    def ids(self) -> npt.NDArray[np.int32]:
        """(N,) the same in every output."""
    @property
    def lines(self) -> npt.NDArray[np.int32]:
        """(N,) index into `parts` of the request."""
    @property
    def models(self) -> List[str]:
        """N names, as the request has them."""
    @property
    def states(self) -> List[str]:
        """N of resting, moving, escaped, fixed, not_poured, removed."""
    @property
    def visible_fraction(self) -> Dict[str, npt.NDArray[np.float64]]:
        """By sensor: (N,) 0 to 1."""
    @property
    def images(self) -> Dict[str, Image]:
        """By the sensor's name."""
    @property
    def report(self) -> Dict[str, Any]:
        """As `report` in scene.json (docs/use/outputs.md)."""
    @property
    def grasps(self) -> Optional[Dict[str, Any]]:
        """The grasps as in grasps.json (docs/use/outputs.md) if requested, otherwise None. Built anew at each access."""
    def json(self) -> str:
        """The text of scene.json, as the command line writes it."""

class Scenes(Iterator[Scene]):
    """Scenes in order. Dropped or closed, it cancels what is being made."""

    def __iter__(self) -> Scenes: ...
    def __next__(self) -> Scene: ...
    @property
    def ready(self) -> int:
        """Scenes that were made ahead and wait."""
    def close(self) -> None: ...

# What follows is for the Python files of this package.
class Request:
    @property
    def scenes(self) -> int: ...

class Heap:
    def settle(self) -> bool: ...
    def remove(self, ids: Sequence[int]) -> None: ...
    def lift(self, ids: Sequence[int], direction: Sequence[float], distance: float) -> None: ...
    def add(self, requests: Sequence[Request]) -> List[int]: ...
    def set_gravity(self, gravity: Sequence[float]) -> None: ...
    def scene(self, images: bool, grasps: bool, gray: bool) -> Scene: ...

class Session:
    def __init__(self) -> None: ...
    def refuse_if_closed(self) -> None: ...
    def close(self) -> None: ...
    def generate(self, request: Request, ahead: int, images: bool, grasps: bool, gray: bool) -> Scenes: ...
    def heap(self, request: Request) -> Heap: ...

def read_file(path: bytes, assignments: Sequence[Tuple[str, str]]) -> Request: ...
def read_text(yaml: str, assignments: Sequence[Tuple[str, str]]) -> Request: ...
