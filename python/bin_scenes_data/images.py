"""The two kinds of images in a shard, decoded by Pillow, which halves colours of 16 bits: these are decoded here."""
import io
import struct
import zlib

import numpy as np
from PIL import Image

_RGB_OF_16_BITS = b"\x10\x02"  # bits and kind of colour in a PNG's header
_NONE, _UP = 0, 2  # filters of rows, of which this project writes these


def _decoded(data, kind):
    try:
        image = Image.open(io.BytesIO(data), formats=[kind])
        image.load()
    except (OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise ValueError("no whole %s: %s" % (kind, error)) from error
    return image


def _rgb_of_16_bits(data):
    width, height = struct.unpack(">II", data[16:24])
    packed, at = b"", 8
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    try:
        rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 6 * width)
    except zlib.error as error:
        raise ValueError("no whole PNG: %s" % error) from error
    samples, above = np.empty((height, 6 * width), np.uint8), 0
    for row, sample in zip(rows, samples):
        if row[0] not in (_NONE, _UP):
            raise ValueError("RGB of 16 bits only with the filters that bin_scenes writes, none and up")
        sample[:] = row[1:] + above if row[0] == _UP else row[1:]
        above = sample
    return samples.view(">u2").astype(np.uint16).reshape(height, width, 3)


def read_png(data):
    """Bytes of a PNG, grey or RGB of 8 or 16 bits, to an array (rows, columns[, 3]). Raises ValueError."""
    image = _decoded(data, "PNG")
    wide = image.mode == "I" or image.mode.startswith("I;16")  # grey of 16 bits, to Pillow before 10.3 and from then on
    if not wide and image.mode not in ("L", "RGB"):
        raise ValueError("only grey and RGB, of 8 or 16 bits")
    if data[24:26] == _RGB_OF_16_BITS:
        return _rgb_of_16_bits(data)
    pixels = np.asarray(image)
    return pixels.astype(np.uint16) if wide else pixels


def read_tiff(data):
    """Bytes of an 8-bit grey TIFF to an array (rows, columns). Raises ValueError."""
    image = _decoded(data, "TIFF")
    if image.mode != "L":
        raise ValueError("only grey of 8 bits")
    return np.asarray(image)
