"""Films of fields, lossless and written whole or not at all: animated WebP, or a numbered PNG for each field.

A field of a WebP after the first is stored as the rectangle that differs from the field before. Pillow
encodes the rectangles; the film is put together here, because Pillow keeps all fields in memory until the
end. The number of fields need not be known before the last. `TimedFilm` takes fields with the times at which
they were shown.

docs/PERFORMANCE.md says how large films are, and which other encoders were measured and rejected.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from io import BytesIO
from os import PathLike, fspath
from pathlib import Path
from struct import pack
from typing import Final

import numpy as np
from PIL import Image, ImageChops

from ramtek_emu.arrays import Colors
from ramtek_emu.errors import ColorsError, OutputError
from ramtek_emu.png import png_bytes
from ramtek_emu.writing import Output, refuse_output, write_atomically

LEAST_RATE: Final = 0.1
MOST_RATE: Final = 100.0
"""Limit: fields per second."""

MOST_FIELDS: Final = 100_000
"""Limit: fields of a film."""


def write_film(
    path: str | PathLike[str],
    fields: Iterable[Colors],
    *,
    fields_per_second: float,
    loop: bool = True,
    overwrite: bool = False,
) -> None:
    """Write (lines, elements, 3) uint8 fields to a film, whose name ends in .webp.

    `fields` are taken one by one. With `loop`, the film begins again at its end. `path` may be a pattern of
    numbered pictures, such as "frame-{number:04}.png"; they have no rate.

    Raises ColorsError for fields of different sizes, for none or too many, and for a wrong rate. Raises
    OutputError, OutputExistsError or WriteError if the film cannot be written. Then there is no file, but
    numbered pictures that were finished stay.
    """
    check_film(path, fields_per_second, overwrite)
    if Path(path).suffix.lower() == PICTURES:
        for number, field in enumerate(_alike(fields), 1):
            picture = fspath(path).format(number=number)
            write_atomically(picture, png_bytes(field), overwrite=overwrite, sync=False)
        return
    with Output(path, overwrite=overwrite) as output:
        film = AnimatedWebp(output.write, loop)
        for number, field in enumerate(_alike(fields)):
            film.add(field, milliseconds_of(number, fields_per_second))
        output.write_at(AnimatedWebp.LENGTH_PLACE, film.length())
        output.keep()


def check_film(path: str | PathLike[str], fields_per_second: float, overwrite: bool = False) -> str:
    """The path of a film, or of the first of numbered pictures.

    Raises the error of `write_film` for a path that it cannot write, or for a rate of no film.
    """
    first, suffix = fspath(path), Path(path).suffix.lower()
    if suffix not in (FILM, PICTURES):
        raise OutputError(
            f"a film must end in {FILM}, or in {PICTURES} with a number, not in {suffix!r}; rename it"
        )
    if not LEAST_RATE <= fields_per_second <= MOST_RATE:
        raise ColorsError(
            f"a film must have {LEAST_RATE:g} to {MOST_RATE:g} fields per second, not {fields_per_second:g};"
            " choose another rate"
        )
    if suffix == PICTURES:
        second = first
        with suppress(LookupError, ValueError, TypeError, AttributeError):
            first, second = (fspath(path).format(number=number) for number in (1, 2))
        if first == second:
            raise OutputError(
                "numbered pictures must have a number in their name, as in frame-{number:04}.png, not"
                f" {fspath(path)!r}; or end the name in .webp for a film"
            )
    refuse_output(first, overwrite)
    return first


def _alike(fields: Iterable[Colors]) -> Iterator[Colors]:
    """The fields. Raises ColorsError for none, too many, or fields of different sizes."""
    size: tuple[int, ...] | None = None
    for number, field in enumerate(fields, 1):
        size = size or field.shape
        if field.shape != size or field.dtype != np.uint8 or size[2:] != (3,) or not field.size:
            raise ColorsError(
                f"a film must have (lines, elements, 3) uint8 fields of one size, not field {number}"
                f" of shape {field.shape}, {field.dtype}, after {size}; render them alike"
            )
        if number > MOST_FIELDS:
            raise ColorsError(f"a film must have at most {MOST_FIELDS:,} fields, not more; choose fewer")
        yield field
    if size is None:
        raise ColorsError("a film must have at least one field, not none; make a field")


def milliseconds_of(number: int, fields_per_second: float) -> int:
    """The duration of a field, counted from 0, so that the film as a whole has the right duration.

    >>> [milliseconds_of(number, 24) for number in range(6)]
    [42, 41, 42, 42, 41, 42]
    """
    end, start = (math.floor(1000 * at / fields_per_second + 0.5) for at in (number + 1, number))
    return end - start


# Animated WebP, by its specification, RFC 9649: a header, and a chunk ANMF for each field.

FILM: Final = ".webp"
PICTURES: Final = ".png"
"""The suffixes of a film and of numbered pictures."""

LARGEST_WEBP: Final = 16383
"""The most elements and lines of a WebP."""

LARGEST_RIFF: Final = (1 << 32) - 10
"""Limit: bytes of a WebP after its first eight."""

LONGEST: Final = (1 << 24) - 1
"""Limit: milliseconds of a field, four and a half hours."""

ANIMATED: Final = 0x02
"""The flag of an animation in VP8X."""


class AnimatedWebp:
    """An animated WebP that is made field by field; `write` gets its bytes.

    The number of bytes stands before the fields. It is 0 until `length` is written at LENGTH_PLACE.
    """

    LENGTH_PLACE: Final = 4

    def __init__(self, write: Callable[[bytes], object], loop: bool) -> None:
        self.fields = 0
        """The number of fields."""
        self._write = write
        self._loop = loop
        self._before: Image.Image | None = None
        self._length = 0

    def add(self, field: Colors, milliseconds: int) -> None:
        """Add a (lines, elements, 3) uint8 field of the size of the others, with its duration.

        Raises OutputError if the field or the film is too large for the format.
        """
        if self._before is None:
            lines, elements, _ = field.shape
            if max(lines, elements) > LARGEST_WEBP:
                raise OutputError(
                    f"a WebP must have at most {LARGEST_WEBP} lines and elements, not {max(lines, elements)};"
                    " write numbered pictures"
                )
            sizes = _three_bytes(elements - 1, lines - 1)
            header = b"WEBP" + _riff_chunk(b"VP8X", pack("<I", ANIMATED) + sizes)
            header += _riff_chunk(b"ANIM", pack("<IH", 0, 0 if self._loop else 1))
            self._write(b"RIFF\0\0\0\0" + header)
            self._length = len(header)
        picture, box = Image.fromarray(field), None
        if self._before is not None:
            # A field that equals the field before is a pixel of it.
            box = ImageChops.difference(picture, self._before).getbbox() or (0, 0, 1, 1)
        left, top, right, bottom = box or (0, 0, *picture.size)
        # The format has half of the place.
        left, top = left // 2 * 2, top // 2 * 2
        still = BytesIO()
        picture.crop((left, top, right, bottom)).save(still, "WEBP", lossless=True, quality=50, method=0)
        place = left // 2, top // 2, right - left - 1, bottom - top - 1, min(milliseconds, LONGEST)
        # A still picture is a header of 12 bytes and the chunk of its pixels.
        data = _riff_chunk(b"ANMF", _three_bytes(*place) + bytes(1) + still.getvalue()[12:])
        self._length += len(data)
        if self._length > LARGEST_RIFF:
            raise OutputError(
                "a WebP must have at most 4 GB, not more; write fewer or smaller fields, or numbered pictures"
            )
        self._write(data)
        self._before = picture
        self.fields += 1

    def length(self) -> bytes:
        """The number of the bytes that follow it; it belongs at LENGTH_PLACE."""
        return pack("<I", self._length)


def _three_bytes(*numbers: int) -> bytes:
    return b"".join(number.to_bytes(3, "little") for number in numbers)


def _riff_chunk(kind: bytes, data: bytes) -> bytes:
    return kind + pack("<I", len(data)) + data + bytes(len(data) % 2)


# Films of fields as they are shown.

MOST_BYTES: Final = 1 << 28
"""Limit: the encoded fields of a `TimedFilm`, which stay in memory."""


class TimedFilm:
    """Fields with the times at which they were shown, as an animated WebP in memory.

    A field is encoded when the next field is shown, because its duration stands before its data. Measured: a
    field of 640 x 480 that differs everywhere takes 10 ms.
    """

    def __init__(self, field: Colors, seconds: float) -> None:
        """Begin with a (lines, elements, 3) uint8 field, shown since `seconds` of any clock."""
        self._file = BytesIO()
        self._film = AnimatedWebp(self._file.write, loop=True)
        self._shown = field
        self._began = seconds
        self._milliseconds = 0
        """The time of the shown field, from the beginning."""

    @property
    def fields(self) -> int:
        """The number of fields, with the field that is shown."""
        return self._film.fields + 1

    @property
    def is_full(self) -> bool:
        """Whether a limit is reached: MOST_FIELDS or MOST_BYTES."""
        return self.fields >= MOST_FIELDS or self._file.tell() >= MOST_BYTES

    def show(self, field: Colors, seconds: float) -> None:
        """Add a field that is shown from `seconds` on; a field that equals the shown field adds nothing."""
        if not np.array_equal(field, self._shown):
            self._encode_shown(seconds)
            self._shown = field

    def _encode_shown(self, seconds: float) -> None:
        end = max(self._milliseconds + 1, math.floor(1000 * (seconds - self._began) + 0.5))
        self._film.add(self._shown, end - self._milliseconds)
        self._milliseconds = end

    def end(self, seconds: float) -> bytes:
        """End the film at `seconds`; returns the bytes of its file."""
        self._encode_shown(seconds)
        self._file.seek(AnimatedWebp.LENGTH_PLACE)
        self._file.write(self._film.length())
        return self._file.getvalue()
