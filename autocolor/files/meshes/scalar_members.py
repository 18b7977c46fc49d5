"""The scalars of a mesh in an array file: a row of the header and a member for each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from autocolor.arrays import AnyArray
from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.files.array_file import Series
from autocolor.scene.scalars.mesh_scalars import MOST_SCALARS, MeshScalar

KEY: Final = "mesh_scalars"
"""The key of the list in the header whose rows are tables of `name` and `of`."""

MESH_SCALARS: Final = Series("mesh_scalar", ("<f8", 1), MOST_SCALARS)


def scalar_rows(scalars: Sequence[MeshScalar]) -> list[dict[str, str]]:
    """What the header tells of the scalars."""
    return [{"name": scalar.name, "of": scalar.of} for scalar in scalars]


def scalar_members(scalars: Sequence[MeshScalar]) -> dict[str, AnyArray]:
    """The values of the scalars by the names of their members."""
    return {f"{MESH_SCALARS.member}_{number}": scalar.values for number, scalar in enumerate(scalars)}


def scalars_of(header: Mapping[str, Any], arrays: Mapping[str, AnyArray]) -> tuple[MeshScalar, ...]:
    """The scalars of a header and its arrays, none of a header without them. Raises InputError."""
    return tuple(_scalars_of(header.get(KEY, ()), arrays))


def _scalars_of(rows: Sequence[object], arrays: Mapping[str, AnyArray]) -> Iterator[MeshScalar]:
    for number, row in enumerate(rows):
        if not isinstance(row, Mapping) or row.keys() != {"name", "of"}:
            raise InputError(f"{KEY}[{number + 1}] must be a table of name and of, not {shown(row)}")
        yield MeshScalar(row["name"], arrays[f"{MESH_SCALARS.member}_{number}"], row["of"])
