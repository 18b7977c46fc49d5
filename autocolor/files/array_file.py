"""Files of arrays, as .npz archives that numpy can open: picture files and table files.

A file has a member `header`, JSON in UTF-8, and arrays of given types. Some arrays are in series, whose
lengths the header gives. Members are stored without compression. The sum of their sizes is compared with
the memory budget before a member is read, and the size of an array with the size of its member. So a small
or sparse file cannot take much memory. Nothing is ever unpickled.
"""

from __future__ import annotations

import io
import json
import math
import re
import struct
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.checks import printable, shown
from autocolor.errors import InputError
from autocolor.files.reading import bounded_json, opened, require_size
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import NodeNormals
from autocolor.scene.scalar import MOST_SCALARS, MeshScalar

GROWTH: Final = 3
"""Measured: how many times the size of its arrays a file takes while it is read."""

LARGEST_HEADER: Final = 16 << 20
MOST_VALUES: Final = 1_000_000
LARGEST_ARRAY_HEADER: Final = 1024

ARRAY_HEADER: Final = re.compile(
    rb"\{'descr': '([^']*)', 'fortran_order': False, 'shape': \(((?:\d{1,12}, ?)*(?:\d{1,12})?)\), \} *\n"
)
"""The array header exactly as numpy writes it; it is matched, never evaluated."""

ArrayType = tuple[str, int]
"""The dtype of an array and the number of its dimensions."""

HEADER_TYPE: Final[ArrayType] = ("|u1", 1)

LONGEST_REASON: Final = 300
"""Limit: letters of the reason in a message about a damaged file."""


@dataclass(frozen=True)
class Series:
    """Arrays of the same type, for the rows of a list in the header: members `member`_0, `member`_1 ..."""

    member: str
    type: ArrayType
    most: int


@dataclass(frozen=True)
class ArrayFileKind:
    """One kind of array file.

    Messages use `noun`, and `advice` for damaged files. `formats` are the readable values of `format` in the
    header; the first is written. `keys` are the other keys of the header. `arrays` has the types of the
    members by name, and `series` the series by the key of their list in the header. The `plain` formats have
    no series. Only the first format has the arrays `added`. The keys `optional` may be absent.
    """

    noun: str
    advice: str
    formats: tuple[str, ...]
    keys: frozenset[str]
    arrays: Mapping[str, ArrayType]
    series: Mapping[str, Series] = field(default_factory=dict)
    plain: tuple[str, ...] = ()
    added: frozenset[str] = frozenset()
    optional: frozenset[str] = frozenset()

    def types(self, header: Mapping[str, Any]) -> dict[str, ArrayType]:
        """The types of all members but the header, for a file with this header."""
        is_older = header.get("format", self.formats[0]) != self.formats[0]
        types = {name: type_ for name, type_ in self.arrays.items() if not (is_older and name in self.added)}
        for key, series in self.series.items():
            for number in range(len(header.get(key, ()))):
                types[f"{series.member}_{number}"] = series.type
        return types


class ArrayFile(NamedTuple):
    """The header and the arrays of a file."""

    header: dict[str, Any]
    arrays: dict[str, AnyArray]


def array_file_bytes(kind: ArrayFileKind, header: Mapping[str, Any], arrays: Mapping[str, AnyArray]) -> bytes:
    """The content of an array file of the first format of its kind; the same for the same values."""
    text = json.dumps({"format": kind.formats[0], **header}, allow_nan=False).encode()
    members = {"header": np.frombuffer(text, np.uint8), **arrays}
    types = {"header": HEADER_TYPE, **kind.types(header)}
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
    """The header and the arrays of a file, each member checked before its array is made.

    Raises InputError if the file is damaged or incomplete.
    """
    with opened(source) as (file, status):
        require_size(source.name, status.st_size, GROWTH)
        try:
            with zipfile.ZipFile(file) as archive:
                # Members may overlap, so that their sum is larger than the file.
                require_size(source.name, sum(each.file_size for each in archive.infolist()), GROWTH)
                return _read(kind, source, archive)
        except InputError:
            raise
        except (zipfile.BadZipFile, EOFError, RuntimeError, ValueError, OSError) as error:
            raise _damaged(kind, source, f"damaged or of another kind ({error or 'cut short'})") from None
        except (struct.error, LookupError, ArithmeticError) as error:
            # zipfile raises these for wrong offsets in its directory.
            raise _damaged(kind, source, f"damaged ({error})") from None


def _damaged(kind: ArrayFileKind, source: Path, reason: str) -> InputError:
    # Names in the file may be anything.
    reason = printable(reason[:LONGEST_REASON])
    return InputError(
        f"{source.name}: a {kind.noun} must be whole and as autocolor wrote it, not {reason}; {kind.advice}"
    )


def _read(kind: ArrayFileKind, source: Path, archive: zipfile.ZipFile) -> ArrayFile:
    """The header and the arrays that it describes. Raises InputError if there are other members."""
    names = [member.filename for member in archive.infolist()]
    listed = ", ".join(map(shown, names[:3])) or "none"
    if "header.npy" not in names:
        raise _damaged(kind, source, f"with members like {listed}")
    if any(member.compress_type != zipfile.ZIP_STORED for member in archive.infolist()):
        raise _damaged(kind, source, "compressed")

    def array(name: str, wanted: ArrayType) -> AnyArray:
        return _array(kind, source, name, wanted, archive.read(f"{name}.npy"))

    header = _header(kind, source, array("header", HEADER_TYPE))
    types = kind.types(header)
    if sorted(names) != sorted(f"{name}.npy" for name in ("header", *types)):
        raise _damaged(kind, source, f"with members like {listed}")
    return ArrayFile(header, {name: array(name, wanted) for name, wanted in types.items()})


def _array(kind: ArrayFileKind, source: Path, name: str, wanted: ArrayType, data: bytes) -> AnyArray:
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
    """The parsed header. Raises InputError if it is not JSON, or has other keys than its format."""
    place = f"{source.name}, header"

    try:
        if len(data) > LARGEST_HEADER:
            raise ValueError(f"{len(data):,} bytes of it")
        header = bounded_json(data.tobytes(), MOST_VALUES)
    except ValueError as error:
        raise InputError(
            f"{place}: it must be JSON of at most {LARGEST_HEADER >> 20} MiB and {MOST_VALUES:,} values, not"
            f" {error}; {kind.advice}"
        ) from None
    formats = (*kind.formats, *kind.plain)
    if not isinstance(header, dict) or header.get("format") not in formats:
        raise InputError(f"{place}: its format must be {kind.formats[0]!r}; {kind.advice}")
    series = {} if header["format"] in kind.plain else kind.series
    if set(header) - kind.optional != {"format", *kind.keys, *series} - kind.optional:
        raise InputError(f"{place}: it must have exactly the keys of its format; {kind.advice}")
    for key, rows in series.items():
        given = header.get(key, [])
        if not isinstance(given, list) or len(given) > rows.most:
            raise InputError(
                f"{place}: {key} must be a list of at most {rows.most:,} rows, not"
                f" {shown(given)}; {kind.advice}"
            )
    return header


# The normals of a file that a mesh has: two series of at most one member. Files without them lack their keys.

NORMALS: Final = {
    "own_normals": Series("own_normal", ("<f4", 2), most=1),
    "own_normal_numbers": Series("own_normal_number", ("<i4", 2), most=1),
}


def normal_rows(normals: NodeNormals | None) -> dict[str, list[int]]:
    """The keys of the header for the normals of a mesh."""
    return {} if normals is None else {key: [0] for key in NORMALS}


def normal_members(normals: NodeNormals | None) -> dict[str, AnyArray]:
    """The arrays of the normals by the names of their members."""
    if normals is None:
        return {}
    return {"own_normal_0": normals.vectors, "own_normal_number_0": normals.numbers}


def normals_of(arrays: Mapping[str, AnyArray]) -> NodeNormals | None:
    """The normals of the arrays of a file, if it has any; a mesh checks them. Raises InputError."""
    tables = [arrays.get(f"{series.member}_0") for series in NORMALS.values()]
    vectors, numbers = tables
    if vectors is None or numbers is None:
        if vectors is not numbers:
            raise InputError("own normals must have vectors and numbers, not one alone")
        return None
    vectors, numbers = (
        np.asfortranarray(table.astype(kind)) for table, kind in ((vectors, np.float32), (numbers, np.intp))
    )
    return NodeNormals(read_only(vectors), read_only(numbers))


# The scalars of a mesh: rows of the header, and members.

KEY: Final = "mesh_scalars"
"""The key of the list in the header whose rows are tables of `name` and `of`."""

MESH_SCALARS: Final = Series("mesh_scalar", ("<f8", 1), MOST_SCALARS)


def scalar_rows(scalars: Sequence[MeshScalar]) -> list[dict[str, str]]:
    """The rows of the header that describe the scalars."""
    return [{"name": scalar.name, "of": scalar.of} for scalar in scalars]


def scalar_members(scalars: Sequence[MeshScalar]) -> dict[str, AnyArray]:
    """The values of the scalars by the names of their members."""
    return {f"{MESH_SCALARS.member}_{number}": scalar.values for number, scalar in enumerate(scalars)}


def scalars_of(header: Mapping[str, Any], arrays: Mapping[str, AnyArray]) -> tuple[MeshScalar, ...]:
    """The scalars of a header and its arrays; old formats have no scalars. Raises InputError."""
    scalars = []
    for number, row in enumerate(header.get(KEY, ())):
        if not isinstance(row, Mapping) or row.keys() != {"name", "of"}:
            raise InputError(f"{KEY}[{number + 1}] must be a table of name and of, not {shown(row)}")
        scalars.append(MeshScalar(row["name"], arrays[f"{MESH_SCALARS.member}_{number}"], row["of"]))
    return tuple(scalars)
