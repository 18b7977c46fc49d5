"""A virtual screen, Xvfb's, whose pixels can be looked at."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest


class VirtualScreen:
    """The screen that a DISPLAY names, and the file that Xvfb keeps its pixels in."""

    def __init__(self, name: str, memory: Path) -> None:
        self.name = name
        self.memory = memory

    def pixels(self) -> npt.NDArray[np.uint8]:
        """What is to be seen, (height, width, 3) uint8."""
        data = self.memory.read_bytes()
        # An XWD file: a header of big-endian numbers, a table of colors, the pixels as blue, green, red, 0.
        header = struct.unpack(">25I", data[:100])
        size, width, height, stride, colors = header[0], header[4], header[5], header[12], header[19]
        start = size + 12 * colors
        rows = np.frombuffer(data, np.uint8, height * stride, start).reshape(height, stride)
        return rows[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]


@contextmanager
def virtual_screen(folder: Path, size: str) -> Iterator[VirtualScreen]:
    """A screen of "WIDTHxHEIGHT" pixels; the test is skipped where Xvfb is missing or does not start."""
    if shutil.which("Xvfb") is None:
        pytest.skip("Xvfb is not installed; the window cannot be tried without a screen")
    read_end, write_end = os.pipe()
    server = subprocess.Popen(
        [
            *("Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{size}x24"),
            # Between two clients a server starts again, and does not answer meanwhile.
            *("-nolisten", "tcp", "-noreset", "-fbdir", str(folder)),
        ],
        pass_fds=[write_end],
        stderr=subprocess.DEVNULL,
    )
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        number = pipe.readline().strip()
    try:
        if not number:
            pytest.skip("Xvfb does not start here; the window cannot be tried without a screen")
        yield VirtualScreen(f":{number}", folder / "Xvfb_screen0")
    finally:
        server.terminate()
        server.wait()
