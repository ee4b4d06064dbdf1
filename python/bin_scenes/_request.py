"""Requests from what Python has: a file's name or a dict, with keyword arguments over it."""
import json
import os
from typing import Any, List, Mapping, Tuple, Union

import numpy as np

from . import _core
from ._error import Error

Request = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def _plain(value: Any) -> Any:
    """What JSON has no type for: arrays, numbers of numpy, paths."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError("a %s is no value of a request" % type(value).__name__)


def _text(value: Any, where: str) -> str:
    """YAML, of which JSON is a part; numbers read back as the same bits."""
    try:
        text = json.dumps(value, default=_plain, ensure_ascii=False)
        text.encode()
        return text
    except UnicodeEncodeError as error:
        raise Error("%r is no text of UTF-8" % error.object[error.start:error.end], where, "rename that file") from None
    except (TypeError, ValueError, RecursionError) as error:
        raise Error(str(error), where, "give numbers, texts, lists, dicts and arrays") from None


def read(request: Request, **overrides: Any) -> "_core.Request":
    """A checked request. An override that is None is none; `a__b` and `a.b` stand for key b within a."""
    assignments: List[Tuple[str, str]] = []
    for name, value in overrides.items():
        if value is not None:
            assignments.append((name.replace("__", ".") + "=" + _text(value, "argument " + name), "argument " + name))
    if isinstance(request, Mapping):
        return _core.read_text(_text(request, "request"), assignments)
    if isinstance(request, (str, os.PathLike)):
        return _core.read_file(os.fsencode(request), assignments)
    raise Error("a %s is no request" % type(request).__name__, "request", "give the name of a YAML file, or a dict")
