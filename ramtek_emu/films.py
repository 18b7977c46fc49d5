"""Films of fields, written whole or not at all.

| suffix | format | colors |
|---|---|---|
| .webp | animated WebP | lossless |
| .apng | animated PNG | lossless |
| .gif | animated GIF | 256 a field; others become the nearest of these |

A field after the first is stored as the rectangle that differs from the field before. Pillow encodes the
fields; an animated PNG and a GIF are put together here, because Pillow keeps all fields in memory until the
end. Of a WebP, the library keeps the encoded fields.

Measured for 640 x 480 fields of the coupe, a turn and a fade of its paint: WebP takes 9 ms and 30 to 51 KB a
field, an animated PNG 10 ms and 61 to 72 KB, a GIF 15 ms and 24 to 30 KB.
Measured and rejected: slower methods of WebP, which save a fifth to a quarter of the bytes for three to seven
times the time; WebP put together here, whose fields are twice as large.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from io import BytesIO
from os import PathLike
from pathlib import Path
from struct import pack, unpack_from
from typing import Final, NamedTuple
from zlib import crc32

import numpy as np
from PIL import Image

from ramtek_emu.arrays import Colors
from ramtek_emu.checks import checked_number
from ramtek_emu.errors import ColorsError, OutputError
from ramtek_emu.writing import Output

LEAST_RATE: Final = 0.1
MOST_RATE: Final = 100.0
MOST_GIF_RATE: Final = 50.0
"""Limit: fields per second. GIF counts hundredths of a second, and browsers slow down fields of less than
two."""

MOST_FIELDS: Final = 100_000
"""Limit: fields of a film."""

LARGEST_WEBP: Final = 16383
"""The most elements and lines of a WebP."""


class Loss(NamedTuple):
    """How many fields of a film lost colors, and the largest difference of a component, 0 to 255."""

    fields: int = 0
    largest: int = 0


def write_film(
    path: str | PathLike[str],
    fields: Iterable[Colors],
    count: int,
    *,
    fields_per_second: float,
    loop: bool = True,
    overwrite: bool = False,
) -> Loss:
    """Write (lines, elements, 3) uint8 fields to a film in the format of its suffix; returns what was lost.

    `fields` are taken one by one, and `count` is their number. With `loop`, the film begins again at its end.
    A WebP stores equal consecutive fields once, with a longer duration.
    Raises ColorsError for fields of different sizes or another count, OutputError, OutputExistsError or
    WriteError if the file cannot be written.
    """
    suffix = Path(path).suffix.lower()
    write = FORMATS.get(suffix)
    if write is None:
        raise OutputError(f"a film must end in {', '.join(FORMATS)}, not in {suffix!r}; rename it")
    count = checked_number(count, "the fields of a film", 1, MOST_FIELDS, "choose fewer", ColorsError)
    most = MOST_GIF_RATE if suffix == ".gif" else MOST_RATE
    if not LEAST_RATE <= fields_per_second <= most:
        raise ColorsError(
            f"a film must have {LEAST_RATE:g} to {most:g} fields per second, not {fields_per_second:g};"
            " choose another rate"
        )
    with Output(path, overwrite=overwrite) as output:
        loss = write(output.write, _alike(fields, count), count, fields_per_second, loop)
        output.keep()
    return loss


def _alike(fields: Iterable[Colors], count: int) -> Iterator[Colors]:
    """The fields, contiguous. Raises ColorsError if their number is not `count` or their sizes differ."""
    size: tuple[int, ...] | None = None
    number = 0
    for number, field in enumerate(fields, 1):
        size = size or field.shape
        if field.shape != size or field.dtype != np.uint8 or field.ndim != 3 or number > count:
            raise ColorsError(
                f"a film must have {count} (lines, elements, 3) uint8 fields of one size, not field {number}"
                f" of shape {field.shape} after {size}; render them alike"
            )
        yield np.ascontiguousarray(field)
    if number != count:
        raise ColorsError(f"a film must have {count} fields, not {number}; count them first")


def ticks(number: int, fields_per_second: float, per_second: int) -> int:
    """The duration of a field, counted from 0, so that the film as a whole has the right duration.

    >>> [ticks(number, 24, 100) for number in range(6)]
    [4, 4, 5, 4, 4, 4]
    """
    end, start = (math.floor(per_second * at / fields_per_second + 0.5) for at in (number + 1, number))
    return end - start


class Rectangle(NamedTuple):
    """The elements and lines of a rectangle."""

    left: int
    top: int
    elements: int
    lines: int

    def of(self, field: Colors) -> Colors:
        """The colors of a field in the rectangle."""
        lines = slice(self.top, self.top + self.lines)
        return field[lines, self.left : self.left + self.elements]


def differing_area(field: Colors, before: Colors | None) -> Rectangle:
    """The smallest rectangle of pixels that differ from the field before; one pixel if no pixel differs."""
    if before is None:
        return Rectangle(0, 0, field.shape[1], field.shape[0])
    differs = (field != before).any(axis=2)
    lines, elements = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    if not len(lines):
        return Rectangle(0, 0, 1, 1)
    left, top = int(elements[0]), int(lines[0])
    return Rectangle(left, top, int(elements[-1]) - left + 1, int(lines[-1]) - top + 1)


Write = Callable[[bytes], None]


# Animated WebP.


class _Fields(Image.Image):
    """Fields as the pictures of one image. Pillow seeks each of them once, in order, and then encodes it."""

    def __init__(self, fields: Iterator[Colors], count: int) -> None:
        super().__init__()
        self._fields = fields
        self.n_frames = count

    def seek(self, frame: int) -> None:
        vars(self).update(vars(Image.fromarray(next(self._fields))))


def _write_webp(write: Write, fields: Iterator[Colors], count: int, rate: float, loop: bool) -> Loss:
    first = next(fields)
    if max(first.shape) > LARGEST_WEBP:
        raise OutputError(
            f"a WebP must have at most {LARGEST_WEBP} lines and elements, not {max(first.shape)}; write .apng"
        )
    buffer = BytesIO()
    durations = [ticks(number, rate, 1000) for number in range(count)]
    Image.fromarray(first).save(
        buffer,
        "WEBP",
        save_all=True,
        append_images=[_Fields(fields, count - 1)] if count > 1 else [],
        duration=durations,
        loop=0 if loop else 1,
        lossless=True,
        quality=50,
        method=0,
    )
    # Pillow takes `count` fields: check that there is no further one.
    next(fields, None)
    write(buffer.getvalue())
    return Loss()


# Animated PNG, by its specification: fcTL describes a field, fdAT holds the data of a field after the first.

PNG_LEVEL: Final = 3
"""Level 6 takes twice the time for a fifth fewer bytes."""


def _write_apng(write: Write, fields: Iterator[Colors], count: int, rate: float, loop: bool) -> Loss:
    before, sequence = None, 0
    for number, field in enumerate(fields):
        area = differing_area(field, before)
        chunks = list(_png_chunks(area.of(field)))
        if number == 0:
            write(PNG_SIGNATURE + _chunk(*chunks[0]) + _chunk(b"acTL", pack(">II", count, 0 if loop else 1)))
        shape = (area.elements, area.lines, area.left, area.top)
        # Neither dispose of the field before nor blend with it: the rectangle is replaced.
        control = pack(">IIIIIHHBB", sequence, *shape, ticks(number, rate, 1000), 1000, 0, 0)
        write(_chunk(b"fcTL", control))
        sequence += 1
        for kind, data in chunks:
            if kind == b"IDAT" and number == 0:
                write(_chunk(kind, data))
            elif kind == b"IDAT":
                write(_chunk(b"fdAT", pack(">I", sequence) + data))
                sequence += 1
        before = field
    write(_chunk(b"IEND", b""))
    return Loss()


PNG_SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"


def _png_chunks(field: Colors) -> Iterator[tuple[bytes, bytes]]:
    """The kinds and data of the chunks of a field as a PNG."""
    buffer = BytesIO()
    Image.fromarray(np.ascontiguousarray(field)).save(buffer, "PNG", compress_level=PNG_LEVEL)
    data, place = buffer.getvalue(), len(PNG_SIGNATURE)
    while place < len(data):
        length, kind = unpack_from(">I4s", data, place)
        yield kind, data[place + 8 : place + 8 + length]
        place += 12 + length


def _chunk(kind: bytes, data: bytes) -> bytes:
    return pack(">I", len(data)) + kind + data + pack(">I", crc32(data, crc32(kind)))


# Animated GIF, by its specification of 1989: each field has a color table of its own.

REPEAT: Final = b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"
"""The extension that repeats the film without end."""

LOCAL_TABLE: Final = 0x80


def _write_gif(write: Write, fields: Iterator[Colors], count: int, rate: float, loop: bool) -> Loss:
    before, shown = None, None
    loss = Loss()
    for number, field in enumerate(fields):
        area = differing_area(field, before)
        # Measured: these 256 colors are off by at most 7, the colors of a median cut by up to 43.
        image = Image.fromarray(np.ascontiguousarray(area.of(field))).quantize(
            256, Image.Quantize.MAXCOVERAGE
        )
        if shown is None:
            lines, elements, _ = field.shape
            write(b"GIF89a" + pack("<HHBBB", elements, lines, 0, 0, 0) + (REPEAT if loop else b""))
            shown = np.empty_like(field)
        area.of(shown)[:] = np.asarray(image.convert("RGB"))
        largest = int((np.maximum(field, shown) - np.minimum(field, shown)).max())
        loss = Loss(loss.fields + (largest > 0), max(loss.largest, largest))
        table, data = _gif_parts(image)
        bits = (len(table) // 3).bit_length() - 2
        # Leave the field before in place.
        write(b"\x21\xf9\x04" + pack("<BHB", 1 << 2, ticks(number, rate, 100), 0) + b"\x00")
        corner = (area.left, area.top, area.elements, area.lines)
        write(b"\x2c" + pack("<HHHHB", *corner, LOCAL_TABLE | bits) + table + data)
        before = field
    write(b"\x3b")
    return loss


def _gif_parts(image: Image.Image) -> tuple[bytes, bytes]:
    """The color table of an image with a palette, and its compressed pixels, as in a GIF."""
    buffer = BytesIO()
    image.save(buffer, "GIF", interlace=0)
    data = buffer.getvalue()
    # Pillow writes a header of 13 bytes, a global table, 10 bytes about the image, and its pixels.
    end = 13 + (3 << (data[10] & 7) + 1)
    assert data[end] == 0x2C
    return data[13:end], data[end + 10 : -1]


FORMATS: Final = {".webp": _write_webp, ".apng": _write_apng, ".gif": _write_gif}
"""The function that writes each format, by the suffix."""
