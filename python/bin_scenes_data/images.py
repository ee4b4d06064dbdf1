"""The two kinds of images in a shard, decoded by Pillow."""
import io

import numpy as np
from PIL import Image

_RGB_OF_16_BITS = b"\x10\x02"  # bits and kind of colour in a PNG's header; Pillow would drop half of them


def _decoded(data, kind):
    try:
        image = Image.open(io.BytesIO(data), formats=[kind])
        image.load()
    except (OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise ValueError("no whole %s: %s" % (kind, error)) from error
    return image


def read_png(data):
    """Bytes of a grey PNG of 8 or 16 bits, or an RGB PNG of 8, to an array (rows, columns[, 3]). Raises ValueError."""
    image = _decoded(data, "PNG")
    if image.mode not in ("L", "I", "RGB") or data[24:26] == _RGB_OF_16_BITS:
        raise ValueError("only grey of 8 or 16 bits and RGB of 8")
    pixels = np.asarray(image)
    return pixels.astype(np.uint16) if image.mode == "I" else pixels


def read_tiff(data):
    """Bytes of an 8-bit grey TIFF to an array (rows, columns). Raises ValueError."""
    image = _decoded(data, "TIFF")
    if image.mode != "L":
        raise ValueError("only grey of 8 bits")
    return np.asarray(image)
