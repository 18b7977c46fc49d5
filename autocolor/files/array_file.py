"""Files of arrays, as .npz archives that numpy can open: picture files and table files.

Each has a member `header`, JSON in UTF-8, and arrays of given types. They are stored without compression: the
size of each array is checked against the size of its member before anything is allocated, so a small file
cannot take much memory. Nothing is ever unpickled.
"""

from __future__ import annotations

import io
import json
import math
import re
import struct
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.errors import InputError
from autocolor.files.reading import read_bytes, shown

LARGEST_HEADER: Final = 16 << 20
MOST_VALUES: Final = 1_000_000
LARGEST_ARRAY_HEADER: Final = 1024

ARRAY_HEADER: Final = re.compile(
    rb"\{'descr': '([^']*)', 'fortran_order': False, 'shape': \(((?:\d{1,12}, ?)*(?:\d{1,12})?)\), \} *\n"
)
"""The array header exactly as numpy writes it; it is matched, never evaluated."""

HEADER_TYPE: Final = ("|u1", 1)


@dataclass(frozen=True)
class ArrayFileKind:
    """One kind of array file.

    `noun` is what messages call it, and `advice` what they say to do about a damaged one. `formats` are the
    values of `format` in the header that can be read, `keys` the other keys that the header has. `arrays` are
    the dtype and the number of dimensions of each member but the header.
    """

    noun: str
    advice: str
    largest: int
    formats: tuple[str, ...]
    keys: frozenset[str]
    arrays: Mapping[str, tuple[str, int]]


class ArrayFile(NamedTuple):
    """The header and the arrays of a file."""

    header: dict[str, Any]
    arrays: dict[str, AnyArray]


def array_file_bytes(kind: ArrayFileKind, header: Mapping[str, Any], arrays: Mapping[str, AnyArray]) -> bytes:
    """The content of an array file of the first format of its kind; the same for the same values."""
    text = json.dumps({"format": kind.formats[0], **header}, allow_nan=False).encode()
    members = {"header": np.frombuffer(text, np.uint8), **arrays}
    types = {"header": HEADER_TYPE, **kind.arrays}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for name, array in members.items():
            member = io.BytesIO()
            np.lib.format.write_array(
                member,
                np.ascontiguousarray(array, dtype=types[name][0]),
                version=(1, 0),
                allow_pickle=False,
            )
            # A fixed date makes the file depend on its content only.
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", (1983, 7, 25, 0, 0, 0)), member.getvalue())
    return buffer.getvalue()


def read_array_file(kind: ArrayFileKind, source: Path) -> ArrayFile:
    """The header and the arrays of a file. Raises InputError if the file is damaged or incomplete."""
    types = {"header": HEADER_TYPE, **kind.arrays}
    arrays = _arrays(kind, source, types)
    return ArrayFile(_header(kind, source, arrays.pop("header")), arrays)


def _damaged(kind: ArrayFileKind, source: Path, found: str) -> InputError:
    return InputError(
        f"{source.name}: a {kind.noun} must be whole and as autocolor wrote it, not {found}; {kind.advice}"
    )


def _arrays(kind: ArrayFileKind, source: Path, types: Mapping[str, tuple[str, int]]) -> dict[str, AnyArray]:
    """The members of the file as arrays, each checked before its array is made."""
    try:
        with zipfile.ZipFile(io.BytesIO(read_bytes(source, kind.largest))) as archive:
            found = [member.filename for member in archive.infolist()]
            if sorted(found) != sorted(f"{name}.npy" for name in types):
                listed = ", ".join(map(shown, found[:3])) or "none"
                raise _damaged(kind, source, f"with members like {listed}")
            if any(member.compress_type != zipfile.ZIP_STORED for member in archive.infolist()):
                raise _damaged(kind, source, "compressed")
            return {
                name: _array(kind, source, name, types[name], archive.read(f"{name}.npy")) for name in types
            }
    except InputError:
        raise
    except (zipfile.BadZipFile, EOFError, RuntimeError, ValueError, OSError) as error:
        raise _damaged(kind, source, f"damaged or of another kind ({error or 'cut short'})") from None
    except (struct.error, LookupError, ArithmeticError) as error:
        # zipfile raises these for wrong offsets in its directory.
        raise _damaged(kind, source, f"damaged ({error})") from None


def _array(kind: ArrayFileKind, source: Path, name: str, wanted: tuple[str, int], data: bytes) -> AnyArray:
    """One member as an array. Raises InputError if its dtype, dimensions or size is not the wanted one."""
    dtype, dimensions = wanted
    start = 10 + int.from_bytes(data[8:10], "little")
    described = ARRAY_HEADER.fullmatch(data[10:start]) if start <= LARGEST_ARRAY_HEADER else None
    if described is not None and data[:8] == b"\x93NUMPY\x01\x00" and described[1].decode() == dtype:
        shape = [int(count) for count in re.findall(rb"\d+", described[2])]
        size = math.prod(shape) * np.dtype(dtype).itemsize
        if len(shape) == dimensions and size == len(data) - start and max(shape) <= len(data):
            return np.frombuffer(data, dtype, offset=start).reshape(shape)
    raise InputError(
        f"{source.name}, {name}: it must be an array of {dtype} with {dimensions} dimensions in as many bytes"
        f" as its shape says, not {len(data)} bytes that begin {data[:10]!r}; {kind.advice}"
    )


def _header(kind: ArrayFileKind, source: Path, data: AnyArray) -> dict[str, Any]:
    """The parsed header. Raises InputError if it is not JSON or lacks a key."""
    place = f"{source.name}, header"

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    try:
        text = data.tobytes()
        if len(text) > LARGEST_HEADER or sum(map(text.count, (b",", b"[", b"{"))) > MOST_VALUES:
            raise ValueError(f"{len(text):,} bytes of it")
        header = json.loads(text.decode("utf-8"), parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{place}: it must be JSON of at most {LARGEST_HEADER >> 20} MiB and {MOST_VALUES:,} values, not"
            f" {error}; {kind.advice}"
        ) from None
    keys = {"format", *kind.keys}
    if not isinstance(header, dict) or set(header) != keys or header["format"] not in kind.formats:
        raise InputError(f"{place}: its format must be {kind.formats[0]!r}, not another; {kind.advice}")
    return header
