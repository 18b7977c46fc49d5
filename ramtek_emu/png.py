"""Fields as PNG files, written whole or not at all. The only module that uses Pillow."""

from __future__ import annotations

from io import BytesIO
from os import PathLike

import numpy as np
from PIL import Image

from ramtek_emu.arrays import Colors
from ramtek_emu.writing import write_atomically


def png_bytes(field: Colors) -> bytes:
    """A (lines, elements, 3) uint8 field as the bytes of a PNG file."""
    buffer = BytesIO()
    Image.fromarray(np.ascontiguousarray(field)).save(buffer, "PNG")
    return buffer.getvalue()


def save_png(field: Colors, path: str | PathLike[str], overwrite: bool = True) -> None:
    """Write a field to a PNG file, whole or not at all; OutputExistsError, OutputError or WriteError."""
    write_atomically(path, png_bytes(field), overwrite=overwrite)
