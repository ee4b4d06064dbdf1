"""A screen without a monitor (Xvfb), and what it shows."""

import os
import pathlib
import struct
import subprocess
import tempfile
import zlib

import numpy as np


class VirtualScreen:
    """`with VirtualScreen() as screen:` programs that get `screen.environment` open their windows there."""

    def __init__(self, width=1400, height=900):
        self.size = "%dx%dx24" % (width, height)

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        ours, theirs = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(theirs), "-screen", "0", self.size, "-fbdir", self.folder.name, "-nolisten", "tcp"],
            pass_fds=[theirs], stderr=subprocess.DEVNULL)
        os.close(theirs)
        with os.fdopen(ours) as told:
            display = told.readline().strip()
        if not display:
            raise AssertionError("Xvfb did not start")
        # OpenGL in software, whatever the machine has.
        self.environment = {**os.environ, "DISPLAY": ":" + display, "LIBGL_ALWAYS_SOFTWARE": "1", "XDG_RUNTIME_DIR": self.folder.name}
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()
        self.folder.cleanup()

    def pixels(self):
        """(height, width, 3) red, green, blue; the file is an X window dump (XWDFile.h)."""
        data = pathlib.Path(self.folder.name, "Xvfb_screen0").read_bytes()
        header = struct.unpack(">25I", data[:100])
        size, width, height, bytes_per_line, colours = header[0], header[4], header[5], header[12], header[19]
        lines = np.frombuffer(data, np.uint8, bytes_per_line * height, size + 12 * colours).reshape(height, bytes_per_line)
        return lines[:, : 4 * width].reshape(height, width, 4)[:, :, 2::-1]


def write_png(path, pixels):
    height, width, _ = pixels.shape
    lines = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, 3 * width)], axis=1).tobytes()

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))
