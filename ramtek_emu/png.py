"""Fields as PNG files, and the chunks of PNG files."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from struct import pack, unpack_from
from typing import Final
from zlib import crc32

import numpy as np

from ramtek_emu.arrays import Colors

SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"
"""The first bytes of a PNG file; chunks follow."""


def chunk(kind: bytes, content: bytes) -> bytes:
    """The bytes of a chunk of a PNG file, with its length and its checksum."""
    return pack(">I", len(content)) + kind + content + pack(">I", crc32(content, crc32(kind)))


def chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yields the kinds and contents of the chunks of a PNG file; ValueError at a broken place."""
    if data[:8] != SIGNATURE:
        raise ValueError("a PNG file must begin with its signature, not with other bytes")
    place = 8
    while place < len(data):
        length, kind = unpack_from(">I4s", data, place) if len(data) - place >= 12 else (0, b"")
        end = place + 12 + length
        if end > len(data):
            raise ValueError(f"a PNG file must have whole chunks, not end within the chunk at byte {place}")
        content = data[place + 8 : end - 4]
        if crc32(content, crc32(kind)) != unpack_from(">I", data, end - 4)[0]:
            raise ValueError(f"a PNG file must have right checksums, not a wrong one at byte {place}")
        yield kind, content
        place = end


LEVEL: Final = 4
"""The compression of a PNG file by default: from 0, fastest, to 9, smallest; see docs/PERFORMANCE.md."""


def png_bytes(field: Colors, level: int | None = None) -> bytes:
    """A (lines, elements, 3) uint8 field as the bytes of a PNG file.

    `level` is the compression, 0 to 9, by default `LEVEL`; the pixels are the same at every level.
    """
    from PIL import Image

    buffer = BytesIO()
    level = LEVEL if level is None else level
    Image.fromarray(np.ascontiguousarray(field)).save(buffer, "PNG", compress_level=level)
    return buffer.getvalue()
