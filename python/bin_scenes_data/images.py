"""The two kinds of images in a shard, decoded with numpy and zlib."""
import struct
import zlib

import numpy as np


def _undo_filters(rows, bytes_per_pixel):
    """Rows of a PNG, each behind its filter byte, to plain bytes."""
    filters, data = rows[:, 0], rows[:, 1:]
    if (filters == 0).all():
        return data
    out = np.empty_like(data)
    if (filters == 2).all():  # every row is the difference to the one above; in half the time of np.add.accumulate
        out[0] = data[0]
        for above, difference, row in zip(out, data[1:], out[1:]):
            np.add(above, difference, out=row)
        return out
    above = np.zeros(data.shape[1], np.uint8)
    for y, kind in enumerate(filters):
        row = data[y].copy()
        if kind == 1:
            pixels = row.reshape(-1, bytes_per_pixel)
            row = np.add.accumulate(pixels, axis=0, dtype=np.uint8).reshape(-1)
        elif kind == 2:
            row += above
        elif kind in (3, 4):
            row = _undo_one(row, above, bytes_per_pixel, kind)
        out[y] = above = row
    return out


def _undo_one(row, above, step, kind):
    """Filters 3 (average) and 4 (Paeth), byte by byte: this project's files do not use them."""
    values = [0] * step + row.tolist()
    up = [0] * step + above.tolist()
    for i in range(step, len(values)):
        left, top, corner = values[i - step], up[i], up[i - step]
        if kind == 3:
            guess = (left + top) // 2
        else:
            guess = min((left, top, corner), key=lambda v: abs(left + top - corner - v))
        values[i] = (values[i] + guess) & 255
    return np.array(values[step:], np.uint8)


def read_png(data):
    """Bytes of a grey or RGB PNG of 8 or 16 bits to an array (rows, columns[, 3]). Raises ValueError."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG")
    at, packed = 8, []
    width = height = bits = colour = 0
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        at += 12 + size
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed.append(body)
    channels = {0: 1, 2: 3}.get(colour)
    if channels is None or bits not in (8, 16):
        raise ValueError("only grey and RGB of 8 or 16 bits")
    pixel = channels * bits // 8
    rows = np.frombuffer(zlib.decompress(b"".join(packed)), np.uint8).reshape(height, 1 + width * pixel)
    plain = np.ascontiguousarray(_undo_filters(rows, pixel))
    image = plain.view(">u2").astype(np.uint16) if bits == 16 else plain
    return image.reshape((height, width, 3) if channels == 3 else (height, width))


def read_tiff(data):
    """Bytes of an 8-bit grey TIFF of one strip, deflated, to an array (rows, columns). Raises ValueError."""
    if data[:4] != b"II*\0":
        raise ValueError("no TIFF of this project")
    (at,) = struct.unpack("<I", data[4:8])
    (count,) = struct.unpack("<H", data[at:at + 2])
    tags = {}
    for i in range(count):
        tag, kind, _, value = struct.unpack("<HHII", data[at + 2 + 12 * i:at + 14 + 12 * i])
        tags[tag] = value & 0xffff if kind == 3 else value
    plain = zlib.decompress(data[tags[273]:tags[273] + tags[279]])
    return np.frombuffer(plain, np.uint8).reshape(tags[257], tags[256])
