"""PNG chunks: writes and reads 16-bit gray pictures with text chunks, with limits on all sizes.

Snapshots may come from anywhere, so every size is checked before memory of that size is used: the file, the
picture, each text and the unpacked pixels. Pillow is not used here: it raises a dozen kinds of errors for
such files, and only one module is to import it. This module supports the small part of the format that is
needed and refuses the rest: other depths, interlacing, filters, unknown critical chunks.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.errors import SnapshotError

SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"
MOST_FILE: Final = 48 << 20
MOST_SIDE: Final = 4096
MOST_TEXT: Final = 8 << 20
"""The largest number of bytes of all texts together."""
MOST_CHUNKS: Final = 1 << 16


def picture_bytes(words: Words, texts: Mapping[str, str]) -> bytes:
    """A PNG file of (lines, elements) words, 16 bits gray, and of ASCII texts by keyword."""
    lines, elements = words.shape
    # Each line begins with the number of its filter; 0 is none.
    rows = np.zeros((lines, 1 + 2 * elements), np.uint8)
    rows[:, 1:] = words.astype(">u2").view(np.uint8).reshape(lines, -1)
    parts = [SIGNATURE, _chunk(b"IHDR", struct.pack(">IIBBBBB", elements, lines, 16, 0, 0, 0, 0))]
    parts += [
        _chunk(b"tEXt", keyword.encode("ascii") + b"\0" + text.encode("ascii"))
        for keyword, text in texts.items()
    ]
    parts += [_chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)), _chunk(b"IEND", b"")]
    return b"".join(parts)


def picture_of(data: bytes) -> tuple[Words, dict[str, str]]:
    """The words and the texts of such a file; SnapshotError if it is not valid."""
    if data[:8] != SIGNATURE:
        raise _refusal("begin as a PNG file does", "as something else")
    size: tuple[int, int] | None = None
    texts: dict[str, str] = {}
    packed: list[bytes] = []
    place, kind = 8, b""
    for _ in range(MOST_CHUNKS):
        kind, content, place = _next_chunk(data, place)
        if size is None:
            size = _size(kind, content)
        elif kind == b"IDAT":
            packed.append(content)
        elif kind == b"tEXt":
            keyword, text = _text(content)
            if keyword in texts:
                raise _refusal("have each text once", f"{keyword!r} twice")
            texts[keyword] = text
            if sum(map(len, texts.values())) > MOST_TEXT:
                raise _refusal(f"have texts of at most {MOST_TEXT} bytes", "longer ones")
        elif kind == b"IEND":
            break
        elif not kind[0] & 0x20:
            raise _refusal("have chunks that are known", f"one called {kind.decode('latin-1')!r}")
    if kind != b"IEND" or size is None:
        raise _refusal(f"end within {MOST_CHUNKS} chunks", "go on")
    return _words(packed, *size), texts


def _chunk(kind: bytes, content: bytes) -> bytes:
    """The bytes of a chunk, with length and checksum."""
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def _next_chunk(data: bytes, place: int) -> tuple[bytes, bytes, int]:
    """The kind and the content of a chunk, and where the next one begins."""
    if len(data) < place + 12:
        raise _refusal("have whole chunks", f"end in one, at byte {len(data)}")
    length, kind = struct.unpack_from(">I4s", data, place)
    end = place + 12 + length
    if end > len(data):
        raise _refusal("have whole chunks", f"one of {length} bytes at byte {place} of {len(data)}")
    content = data[place + 8 : end - 4]
    if zlib.crc32(content, zlib.crc32(kind)) != struct.unpack_from(">I", data, end - 4)[0]:
        raise _refusal("have chunks with a right checksum", f"a wrong one at byte {place}")
    return kind, content, end


def _size(kind: bytes, content: bytes) -> tuple[int, int]:
    if kind != b"IHDR" or len(content) != 13:
        raise _refusal("begin with its size", "with another chunk")
    elements, lines, *kind_of_pixels = struct.unpack(">IIBBBBB", content)
    if kind_of_pixels != [16, 0, 0, 0, 0]:
        raise _refusal("be 16 bits gray, not interlaced", "another kind of picture")
    if not (1 <= elements <= MOST_SIDE and 1 <= lines <= MOST_SIDE):
        raise _refusal(f"be 1 to {MOST_SIDE} elements and lines", f"{elements} x {lines}")
    return lines, elements


def _text(content: bytes) -> tuple[str, str]:
    keyword, zero, text = content.partition(b"\0")
    if not zero or not 1 <= len(keyword) <= 79 or not content.isascii():
        raise _refusal("have texts with a keyword, in ASCII", "other ones")
    return keyword.decode("ascii"), text.decode("ascii")


def _words(packed: list[bytes], lines: int, elements: int) -> Words:
    expected = lines * (1 + 2 * elements)
    unpacker = zlib.decompressobj()
    try:
        unpacked = unpacker.decompress(b"".join(packed), expected + 1)
    except zlib.error as cause:
        raise _refusal("have pixels that can be unpacked", f"broken ones ({cause})") from None
    if len(unpacked) != expected or not unpacker.eof:
        raise _refusal(f"have {lines} lines of {elements} words", "more or fewer")
    rows = np.frombuffer(unpacked, np.uint8).reshape(lines, -1)
    if rows[:, 0].any():
        raise _refusal("have unfiltered lines, as they were written", "filtered ones from another program")
    return np.ascontiguousarray(rows[:, 1:]).view(">u2").astype(np.uint16)


def _refusal(rule: str, value: str) -> SnapshotError:
    return SnapshotError(f"a snapshot must {rule}, not {value}; take a new one with --snapshot")
