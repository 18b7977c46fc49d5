"""Going through a legacy VTK file: lines of keywords, and arrays in text or binary (high byte first)."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Numbers
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import NumberText
from autocolor.files.reading import shown

LONGEST_LINE: Final = 4096
LONGEST_METADATA: Final = 10_000
"""Lines of a METADATA section."""

SPACES: Final = b" \t\r\n\f\v"

TYPES: Final = {
    b"char": "i1",
    b"unsigned_char": "u1",
    b"short": ">i2",
    b"unsigned_short": ">u2",
    b"int": ">i4",
    b"unsigned_int": ">u4",
    b"long": ">i8",
    b"unsigned_long": ">u8",
    b"float": ">f4",
    b"double": ">f8",
    # Written as 32 bits by all versions that write this name.
    b"vtkidtype": ">i4",
    b"vtktypeint8": "i1",
    b"vtktypeuint8": "u1",
    b"vtktypeint16": ">i2",
    b"vtktypeuint16": ">u2",
    b"vtktypeint32": ">i4",
    b"vtktypeuint32": ">u4",
    b"vtktypeint64": ">i8",
    b"vtktypeuint64": ">u8",
    b"vtktypefloat32": ">f4",
    b"vtktypefloat64": ">f8",
}


class VtkCursor:
    """A place, `at`, in the bytes of a file; `name` is the file's name in messages."""

    def __init__(self, data: bytes, name: str) -> None:
        self.data = data
        self.name = name
        self.at = self.begun = 0
        self.text: NumberText | None = None

    def as_text(self) -> None:
        """Read arrays as text from here on."""
        self.text = NumberText(self.data, self.name)

    @property
    def where(self) -> str:
        """The latest line of keywords, for a message: its number in a text file, its byte in a binary one."""
        if self.text is None:
            return f"{self.name}, byte {self.begun:,}"
        line = self.data.count(b"\n", 0, self.begun) + 1
        return f"{self.name}, line {line}"

    def raw_line(self) -> bytes:
        """The next line, without its end; empty at the end of the file. Raises InputError."""
        end = self.data.find(b"\n", self.at, self.at + LONGEST_LINE)
        if end < 0:
            if len(self.data) - self.at >= LONGEST_LINE:
                raise InputError(
                    f"{self.where}: a line of keywords must have less than {LONGEST_LINE:,} bytes; correct it"
                )
            end = len(self.data)
        line = self.data[self.at : end]
        self.at = min(end + 1, len(self.data))
        return line.rstrip()

    def words(self) -> list[bytes]:
        """The words of the next line that has any; none at the end of the file. Raises InputError."""
        while self.at < len(self.data) and self.data[self.at] in SPACES:
            self.at += 1
        self.begun = self.at
        return self.raw_line().split()

    def peek(self) -> bytes:
        """The first word of the next line, in capitals, without going on."""
        before = self.at, self.begun
        words = self.words()
        self.at, self.begun = before
        return words[0].upper() if words else b""

    def skip_metadata(self) -> None:
        """Go past a METADATA section, which an empty line ends."""
        for _ in range(LONGEST_METADATA):
            if self.at >= len(self.data) or not self.raw_line():
                return
        raise InputError(f"{self.where}: METADATA must end with an empty line; remove it")

    def count(self, word: bytes, what: str) -> int:
        """A count of at most 18 digits. Raises InputError."""
        if not word.isdigit() or len(word) > 18:
            raise InputError(
                f"{self.where}: {what} must be a whole number from 0 on, not {shown(word)}; correct it"
            )
        return int(word)

    def array(self, count: int, kind: bytes, what: str) -> AnyArray:
        """The next numbers: floating-point for `float`, `double` and all text, else whole. Raises InputError.

        Of a text file, whole numbers are those of whole types.
        """
        dtype = np.dtype(TYPES.get(kind.lower(), "V"))
        if dtype.kind == "V":
            raise InputError(
                f"{self.where}: the type of the {what} must be int, float, double or another of numbers, not"
                f" {shown(kind)}; write it as double"
            )
        if self.text is None:
            size = count * dtype.itemsize
            if size > len(self.data) - self.at:
                left = len(self.data) - self.at
                raise InputError(
                    f"{self.where}: the {what} must have {size:,} bytes, not {left:,}; the file is cut short"
                    " or its counts are wrong"
                )
            array = np.frombuffer(self.data, dtype, count, self.at)
            self.at += size
            return array
        first = int(np.searchsorted(self.text.starts, self.at))
        left = len(self.text) - first
        if count > left:
            raise InputError(
                f"{self.where}: the {what} must have {count:,} numbers, not {left:,}; the file is cut short"
                " or its counts are wrong"
            )
        values: AnyArray
        if dtype.kind == "f":
            values = self.text.values(first, count)
        else:
            values = self.text.wholes(first, count, f"a number of the {what}")
        if count:
            last = int(self.text.starts[first + count - 1])
            following = first + count
            end = int(self.text.starts[following]) if following < len(self.text) else len(self.data)
            self.at = last + len(self.data[last:end].rstrip(SPACES))
        return values

    def wholes(self, count: int, kind: bytes, what: str) -> Numbers:
        """The next whole numbers, int64. Raises InputError, for a type that is not whole, too."""
        array = self.array(count, kind, what)
        if array.dtype.kind not in "iu":
            raise InputError(
                f"{self.where}: the type of the {what} must be one of whole numbers, not {shown(kind)};"
                " write it as int"
            )
        return array.astype(np.int64)

    def coordinates(self, count: int, kind: bytes, what: str) -> Floats:
        """The next numbers as float64, all finite and at most 1e30 in size. Raises InputError."""
        start = self.where
        values = self.array(count, kind, what).astype(np.float64)
        wrong = np.flatnonzero(~(np.abs(values) <= LARGEST_COORDINATE))
        if len(wrong):
            raise InputError(
                f"{start}: a coordinate must be finite and at most 1e30 in size, not {values[wrong[0]]:g}"
                f" (number {wrong[0] + 1:,} of the {what}); correct it"
            )
        return values
