"""Fields as PNG files, written whole or not at all. The only module that uses Pillow."""

from __future__ import annotations

from io import BytesIO
from os import PathLike
from pathlib import Path

import numpy as np
from PIL import Image

from ramtek_emu.arrays import Colors
from ramtek_emu.errors import OutputExistsError
from ramtek_emu.writing import write_atomically


def png_bytes(field: Colors) -> bytes:
    """A (lines, elements, 3) uint8 field as the bytes of a PNG file."""
    buffer = BytesIO()
    Image.fromarray(np.ascontiguousarray(field)).save(buffer, "PNG")
    return buffer.getvalue()


def save_png(field: Colors, path: str | PathLike[str], overwrite: bool = True) -> None:
    """Write a field to a PNG file, whole or not at all; OutputExistsError, OutputError or WriteError."""
    write_atomically(path, png_bytes(field), overwrite=overwrite)


def save_numbered(field: Colors, folder: Path, name: str) -> Path:
    """Write a field to NAME-0001.png or the next free number, never over a file; OutputError or WriteError.

    Returns the path, links resolved.
    """
    number = 1
    while True:
        path = folder / f"{name}-{number:04d}.png"
        number += 1
        if path.exists():
            continue
        try:
            save_png(field, path, overwrite=False)
        except OutputExistsError:
            continue
        return path.resolve()
