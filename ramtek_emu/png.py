"""Fields, and words with their entries, as PNG files. The only module that uses Pillow."""

from __future__ import annotations

from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from ramtek_emu.arrays import Colors, Words
from ramtek_emu.errors import OutputExistsError
from ramtek_emu.writing import write_atomically


def png_bytes(field: Colors) -> bytes:
    """A (lines, elements, 3) uint8 field as the bytes of a PNG file."""
    buffer = BytesIO()
    Image.fromarray(np.ascontiguousarray(field)).save(buffer, "PNG")
    return buffer.getvalue()


TABLE: Final = "lookup table"
"""The name of the suggested palette, and the keyword of the text, with the entries of a PNG file of words."""


def word_png_bytes(words: Words, entries: Colors) -> bytes:
    """Words, (lines, elements) uint16, as a PNG file of 16-bit grays with all entries, (n, 3) uint8.

    The gray of a pixel is its word. The entries are in the file twice, in the order of their words: as a
    suggested palette, the chunk `sPLT`, which libpng and Java read; and as a text of six hexadecimal digits
    an entry, the chunk `zTXt`, because Pillow skips suggested palettes. Both are named `TABLE`.

    Assumed: a suggested palette must be sorted by falling frequency. All frequencies are 0 here, so the order
    of the words is allowed.
    """
    rows = np.zeros(len(entries), [("color", "u1", 3), ("alpha", "u1"), ("frequency", ">u2")])
    rows["color"], rows["alpha"] = entries, 255
    chunks = PngInfo()
    chunks.add(b"sPLT", TABLE.encode("ascii") + b"\0\x08" + rows.tobytes())
    chunks.add_text(TABLE, entries.tobytes().hex(), zip=True)
    return _saved(Image.fromarray(np.ascontiguousarray(words)), chunks)


def indexed_png_bytes(indices: Colors, palette: Colors) -> bytes:
    """Indices, (lines, elements) uint8, of a palette of 1 to 256 colors, (n, 3) uint8, as a PNG file."""
    image = Image.fromarray(np.ascontiguousarray(indices))
    image.putpalette(palette.tobytes())
    return _saved(image)


def _saved(image: Image.Image, chunks: PngInfo | None = None) -> bytes:
    buffer = BytesIO()
    image.save(buffer, "PNG", pnginfo=chunks)
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
