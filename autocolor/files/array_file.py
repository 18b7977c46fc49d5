"""Files of arrays, as .npz archives that numpy can open: picture files and table files.

A file has a member `header`, JSON in UTF-8, and arrays of given types. The sizes in the archive's directory
are compared with the memory budget before anything is read, and an array is a view of the bytes of its
member. So a small or sparse file cannot take much memory. Nothing is ever unpickled.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.checks import printable
from autocolor.errors import InputError
from autocolor.files.reading import bounded_json, opened, require_size
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import NodeNormals
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar

GROWTH: Final = 3
"""Measured: how many times the size of its arrays a file takes while it is read."""

ArrayType = tuple[str, tuple[int | None, ...]]
"""The dtype and the shape of a member; None is any size."""

MESH_TABLES: Final = ("coordinates", "node_numbers", "part_numbers")

TYPES: Final[Mapping[str, ArrayType]] = {
    "header": ("|u1", (None,)),
    "coordinates": ("<f8", (None, 3)),
    "node_numbers": ("<i4", (None, 4)),
    "part_numbers": ("<i4", (None,)),
    "mesh_scalar": ("<f8", (None,)),
    "own_normal": ("<f4", (None, 3)),
    "own_normal_number": ("<i4", (None, 4)),
}
"""The members that every file may have, without the numbers at the ends of their names."""


@dataclass(frozen=True)
class ArrayFileKind:
    """One kind of array file.

    Messages use `noun`, and `advice` for damaged files. `format` is in the header. `types` are the types of
    members besides those of a mesh.
    """

    noun: str
    advice: str
    format: str
    types: Mapping[str, ArrayType]

    def type_of(self, member: str) -> ArrayType:
        """The type of a member. Raises KeyError if a file cannot have it."""
        return {**TYPES, **self.types}[member.rstrip("_0123456789")]

    @contextmanager
    def naming(self, file: str) -> Iterator[None]:
        """Add the name of the file and the advice to each problem of its header and its arrays."""
        try:
            yield
        except InputError as error:
            raise InputError(f"{file}: {each[:400]}; {self.advice}" for each in error.problems[:20]) from None
        except (LookupError, TypeError) as error:
            reason = f"its header must be as autocolor wrote it, and is not ({error})"
            raise InputError(f"{file}: {reason}; {self.advice}") from None


def array_file_bytes(
    kind: ArrayFileKind, mesh: Mesh, header: Mapping[str, Any], arrays: Mapping[str, AnyArray]
) -> bytes:
    """The content of a file with a mesh of a kind; the same for equal values."""
    scalars = [{"name": scalar.name, "of": scalar.of} for scalar in mesh.scalars]
    text = json.dumps({"format": kind.format, "mesh_scalars": scalars, **header}, allow_nan=False).encode()
    members = {"header": np.frombuffer(text, np.uint8), **{name: getattr(mesh, name) for name in MESH_TABLES}}
    members |= {f"mesh_scalar_{number}": scalar.values for number, scalar in enumerate(mesh.scalars)}
    if mesh.own_normals is not None:
        members["own_normal_0"] = mesh.own_normals.vectors
        members["own_normal_number_0"] = mesh.own_normals.numbers
    members |= arrays
    buffer = io.BytesIO()
    typed = {name: np.ascontiguousarray(each, kind.type_of(name)[0]) for name, each in members.items()}
    np.savez(buffer, **typed)  # type: ignore[arg-type]
    return buffer.getvalue()


def read_array_file(kind: ArrayFileKind, source: Path) -> tuple[dict[str, Any], dict[str, AnyArray]]:
    """The header and the arrays of a file, read-only.

    Raises InputError if the file is damaged or incomplete.
    """
    with opened(source) as (file, status):
        require_size(source.name, status.st_size, GROWTH)
        try:
            with zipfile.ZipFile(file) as archive:
                # Members may overlap, so that their sum is larger than the file.
                require_size(source.name, sum(member.file_size for member in archive.infolist()), GROWTH)
                names = [name.removesuffix(".npy") for name in archive.namelist()]
                arrays = {name: _array(archive, name, kind.type_of(name)) for name in names}
            header = bounded_json(arrays.pop("header").tobytes(), 1_000_000)
            if not isinstance(header, dict) or header.get("format") != kind.format:
                raise ValueError(f"its format must be {kind.format!r}")
            return header, arrays
        except (InputError, MemoryError):
            raise
        except Exception as error:
            # Damaged archives and arrays raise errors of many kinds. Names in the file may be anything.
            reason = printable(str(error)[:200]) or "it is cut short"
    raise InputError(
        f"{source.name}: a {kind.noun} must be whole and as autocolor wrote it, and it is not ({reason});"
        f" {kind.advice}"
    )


def _array(archive: zipfile.ZipFile, name: str, wanted: ArrayType) -> AnyArray:
    """An array by rows. Raises ValueError if it is of another type."""
    data = archive.read(f"{name}.npy")
    stream = io.BytesIO(data)
    np.lib.format.read_magic(stream)
    shape, is_by_columns, dtype = np.lib.format.read_array_header_1_0(stream, 1024)
    sizes = wanted[1]
    fits = len(shape) == len(sizes) and all(n in (None, size) for n, size in zip(sizes, shape, strict=True))
    if is_by_columns or dtype.str != wanted[0] or not fits:
        raise ValueError(f"{name} must be {wanted[0]} of shape {sizes}, not {dtype.str} of {shape}")
    return np.frombuffer(data, dtype, offset=stream.tell()).reshape(shape)


def mesh_of(
    header: Mapping[str, Any], arrays: Mapping[str, AnyArray], part_names: Any, crease_angle: Any
) -> Mesh:
    """The mesh of the header and the arrays of a file. Raises InputError, LookupError and TypeError."""
    scalars = [
        MeshScalar(row["name"], arrays[f"mesh_scalar_{number}"], row["of"])
        for number, row in enumerate(header["mesh_scalars"])
    ]
    own = None
    if "own_normal_0" in arrays:
        numbers = arrays.get("own_normal_number_0", np.empty((0, 4), np.intp))
        # The renderer works on columns.
        vectors = np.asfortranarray(arrays["own_normal_0"])
        own = NodeNormals(read_only(vectors), read_only(np.asfortranarray(numbers, np.intp)))
    coordinates, node_numbers, part_numbers = (arrays[name] for name in MESH_TABLES)
    return Mesh(coordinates, node_numbers, part_numbers, part_names, crease_angle, tuple(scalars), own)
