"""Files of arrays, as .npz archives that numpy can open: picture files and table files.

A file has a member `header`, JSON in UTF-8, and arrays of given types. Some arrays are in series, whose
lengths the header gives. The sizes in the archive's directory are compared with the memory budget before
anything is read, and an array is a view of the bytes of its member. So a small or sparse file cannot take
much memory. Nothing is ever unpickled.
"""

from __future__ import annotations

import io
import json
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
    members by name, and `series` the series by the key of their list in the header. Older files may lack the
    lists of series, and the keys and arrays that are `optional`.
    """

    noun: str
    advice: str
    formats: tuple[str, ...]
    keys: frozenset[str]
    arrays: Mapping[str, ArrayType]
    series: Mapping[str, Series] = field(default_factory=dict)
    optional: frozenset[str] = frozenset()

    def types(self, header: Mapping[str, Any]) -> dict[str, ArrayType]:
        """The types of all members but the header, for a file with this header."""
        types = dict(self.arrays)
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
            np.save(member, np.ascontiguousarray(array, dtype=types[name][0]), allow_pickle=False)
            # A fixed date makes the file depend on its content only.
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", (1983, 7, 25, 0, 0, 0)), member.getvalue())
    return buffer.getvalue()


def read_array_file(kind: ArrayFileKind, source: Path) -> ArrayFile:
    """The header and the arrays of a file, read-only.

    Raises InputError if the file is damaged or incomplete.
    """
    with opened(source) as (file, status):
        require_size(source.name, status.st_size, GROWTH)
        try:
            with zipfile.ZipFile(file) as archive:
                # Members may overlap, so that their sum is larger than the file.
                sizes = [member.file_size for member in archive.infolist()]
                require_size(source.name, sum(sizes), GROWTH)
                header = _header(kind, _array(archive, "header", HEADER_TYPE))
                names = archive.namelist()
                types = {
                    name: wanted
                    for name, wanted in kind.types(header).items()
                    if name not in kind.optional or f"{name}.npy" in names
                }
                if sorted(names) != sorted(f"{name}.npy" for name in ("header", *types)):
                    raise ValueError(f"its members are {', '.join(map(shown, names[:3]))}")
                return ArrayFile(
                    header, {name: _array(archive, name, wanted) for name, wanted in types.items()}
                )
        except (InputError, MemoryError):
            raise
        except Exception as error:
            # Damaged archives and arrays raise errors of many kinds. Names in the file may be anything.
            reason = printable(str(error)[:LONGEST_REASON]) or "it is cut short"
    raise InputError(
        f"{source.name}: a {kind.noun} must be whole and as autocolor wrote it, and it is not ({reason});"
        f" {kind.advice}"
    )


def _array(archive: zipfile.ZipFile, name: str, wanted: ArrayType) -> AnyArray:
    """An array by rows. Raises ValueError if its dtype, or the number of its dimensions, is another."""
    data = archive.read(f"{name}.npy")
    stream = io.BytesIO(data)
    np.lib.format.read_magic(stream)
    shape, is_by_columns, dtype = np.lib.format.read_array_header_1_0(stream, LARGEST_ARRAY_HEADER)
    if (dtype.str, len(shape)) != wanted:
        described = f"{dtype.str} of shape {shape}"
        raise ValueError(f"{name} must be {wanted[0]} with {wanted[1]} dimensions, not {described}")
    array = np.frombuffer(data, dtype, offset=stream.tell())
    return read_only(np.ascontiguousarray(array.reshape(shape, order="F" if is_by_columns else "C")))


def _header(kind: ArrayFileKind, data: AnyArray) -> dict[str, Any]:
    """The parsed header. Raises ValueError if it is not JSON, or has other keys than its format."""
    if len(data) > LARGEST_HEADER:
        raise ValueError(f"its header must have at most {LARGEST_HEADER >> 20} MiB")
    header = bounded_json(data.tobytes(), MOST_VALUES)
    if not isinstance(header, dict) or header.get("format") not in kind.formats:
        raise ValueError(f"its format must be {kind.formats[0]!r}")
    needed = {"format", *kind.keys}
    if not needed <= header.keys() <= {*needed, *kind.optional, *kind.series}:
        raise ValueError("its header must have exactly the keys of its format")
    for key, rows in kind.series.items():
        if not isinstance(header.get(key, []), list) or len(header.get(key, ())) > rows.most:
            raise ValueError(f"{key} must be a list of at most {rows.most:,} rows, not {shown(header[key])}")
    return header


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
    vectors, numbers = (arrays.get(f"{series.member}_0") for series in NORMALS.values())
    if vectors is None and numbers is None:
        return None
    if vectors is None or numbers is None:
        raise InputError("own normals must have vectors and numbers, not one alone")
    vectors, numbers = np.asfortranarray(vectors, np.float32), np.asfortranarray(numbers, np.intp)
    return NodeNormals(read_only(vectors), read_only(numbers))
