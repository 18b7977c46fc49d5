"""One .npy file as an array that is mapped into memory: read page by page, and never copied whole.

The header is matched, never evaluated, and nothing is ever unpickled. The size of the file is compared with
its header before it is mapped. What another program cuts off a file later cannot be guarded against: the
system then ends the process that looks at it (SIGBUS). So write such files anew and rename them.
"""

from __future__ import annotations

import math
import mmap
import re
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.errors import InputError
from autocolor.files.reading import opened, shown
from autocolor.immutable import read_only

MOST_ROWS: Final = 200_000_000
"""Assumed: rows of a table, so that looking at all of them takes seconds."""

LARGEST_HEADER: Final = 1024
"""Bytes; numpy writes 128 for a table."""

MAGIC: Final = b"\x93NUMPY"

HEADER: Final = re.compile(
    rb"\{'descr': '([<>|](?:f[248]|[iu][1248]))', 'fortran_order': (True|False),"
    rb" 'shape': \((\d{1,12}), ?(\d{1,2})?\), \} *\n"
)
"""The header exactly as numpy writes that of a table of numbers."""


class Header(NamedTuple):
    """What the header of a file says, and where the numbers begin.

    `shape` is (rows,) or (rows, columns); `by_columns` tells that the numbers of a column follow each other.
    """

    dtype: np.dtype[np.generic]
    by_columns: bool
    shape: tuple[int, ...]
    start: int

    @property
    def size(self) -> int:
        """How many bytes the file must have."""
        return self.start + math.prod(self.shape) * self.dtype.itemsize


def parsed_header(name: str, head: bytes) -> Header:
    """The header at the beginning of a file of this name. Raises InputError."""
    width = {b"\x01\x00": 2, b"\x02\x00": 4}.get(head[6:8], 0)
    start = 8 + width + int.from_bytes(head[8 : 8 + width], "little")
    described = HEADER.fullmatch(head[8 + width : start]) if start <= LARGEST_HEADER else None
    if not head.startswith(MAGIC) or not width or described is None:
        raise InputError(
            f"{name}: it must be an .npy file with a table of whole numbers or floating-point numbers, not"
            f" begin with {shown(head[:80], 80)}; write it with numpy.save"
        )
    shape = tuple(int(count) for count in described.groups()[2:] if count is not None)
    dtype = np.dtype(described[1].decode())
    if shape[0] > MOST_ROWS:
        raise InputError(f"{name}: a table must have at most {MOST_ROWS:,} rows, not {shape[0]:,}; divide it")
    # A table of one row or one column has both orders.
    by_columns = described[2] == b"True" or len(shape) == 1 or min(shape) <= 1
    return Header(dtype, by_columns, shape, start)


def mapped(path: Path) -> AnyArray:
    """The table of an .npy file, (rows,) or (rows, columns), mapped and read-only.

    Raises MissingInputError if there is no such file, InputError if it is not such a table.
    """
    with opened(path) as (file, status):
        header = parsed_header(path.name, file.read(LARGEST_HEADER))
        if status.st_size != header.size:
            raise InputError(
                f"{path.name}: a table of shape {header.shape} and type {header.dtype} must have"
                f" {header.size:,} bytes, not {status.st_size:,}; write it again"
            )
        try:
            pages = mmap.mmap(file.fileno(), header.size, access=mmap.ACCESS_READ)
        except ValueError as error:
            # Another program cut it off meanwhile.
            raise InputError(f"{path.name}: a table must stay whole ({error}); write it again") from None
    numbers: AnyArray = np.frombuffer(pages, header.dtype, math.prod(header.shape), header.start)
    return read_only(numbers.reshape(header.shape, order="F" if header.by_columns else "C"))
