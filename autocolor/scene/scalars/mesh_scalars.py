"""Scalars of a mesh: one number for each node or each polygon, such as stress, pressure or temperature.

Paper: "Introduction": scalar variables such as stress on the surface of an object. A number that is missing
is NaN; no other is without an end.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import LARGEST_COORDINATE, shown
from autocolor.errors import InputError
from autocolor.immutable import Immutable, read_only

NODE: Final = "node"
POLYGON: Final = "polygon"

MOST_SCALARS: Final = 1000
"""Assumed: the scalars of one mesh."""

LARGEST_SCALAR: Final = LARGEST_COORDINATE


@dataclass(frozen=True, eq=False, repr=False)
class MeshScalar(Immutable):
    """A scalar: `values`, (n,) float64, one for each row of the table that `of` names, "node" or "polygon".

    NaN is a missing value; all others are at most 1e30 in size. The values are copied unless they are a
    read-only array of this type. Raises InputError.
    """

    name: str
    values: Floats
    of: str = NODE

    def __post_init__(self) -> None:
        problems = []
        if not isinstance(self.name, str) or not self.name:
            problems.append(f"a scalar must have a name, not {shown(self.name)}; give it one")
        label = f"scalar {shown(self.name)}"
        if self.of not in (NODE, POLYGON):
            problems.append(f"{label}: it must be of 'node' or 'polygon', not {shown(self.of)}; choose one")
        values = np.asarray(self.values)
        if values.dtype.kind not in "iuf" or values.ndim != 1:
            problems.append(
                f"{label}: its values must be numbers in one dimension, not {values.dtype} of shape"
                f" {values.shape}; convert them"
            )
        else:
            is_kept = values.dtype == np.float64 and not values.flags.writeable
            values = values if is_kept else read_only(np.array(values, np.float64))
            if problem := _endless(values):
                problems.append(f"{label}: {problem}")
        if problems:
            raise InputError(problems)
        object.__setattr__(self, "values", values)


def _endless(values: Floats) -> str | None:
    """What is wrong with the first value that is infinite or too large; None if none is."""
    # A comparison with NaN is false, and warns of nothing.
    rows = np.flatnonzero((values > LARGEST_SCALAR) | (values < -LARGEST_SCALAR))
    if not len(rows):
        return None
    found = values[rows[0]]
    return f"a value must be at most 1e30 in size, or NaN if it is missing, not {found:g} (row {rows[0]})"


def scalar_problems(scalars: Sequence[MeshScalar], nodes: int, polygons: int) -> Iterator[str]:
    """What is wrong with the scalars of a mesh of so many nodes and polygons."""
    names: set[str] = set()
    counts = {NODE: nodes, POLYGON: polygons}
    for scalar in scalars:
        if scalar.name in names:
            yield f"scalar {scalar.name!r}: its name must be unique, not repeated; rename one"
        names.add(scalar.name)
        if len(scalar.values) != counts[scalar.of]:
            yield (
                f"scalar {scalar.name!r}: there must be one value a {scalar.of} ({counts[scalar.of]}), not"
                f" {len(scalar.values)}"
            )


def joined_scalars(
    scalars: Sequence[Sequence[MeshScalar]], nodes: Sequence[int], polygons: Sequence[int]
) -> tuple[MeshScalar, ...]:
    """The scalars of several meshes that are joined to one; `nodes` and `polygons` are their counts.

    A mesh without a scalar of a name has missing values. A name that is of nodes in one mesh and of polygons
    in another becomes two: the second is named as in "stress of polygons".
    """
    kinds = dict.fromkeys((scalar.name, scalar.of) for each in scalars for scalar in each)
    names: dict[str, tuple[str, str]] = {}
    for name, of in kinds:
        names[name if name not in names else f"{name} of {of}s"] = (name, of)
    joined = []
    for name, key in names.items():
        counts = nodes if key[1] == NODE else polygons
        found = [{(each.name, each.of): each.values for each in of_mesh}.get(key) for of_mesh in scalars]
        values = [
            np.full(count, np.nan) if each is None else each
            for count, each in zip(counts, found, strict=True)
        ]
        joined.append(MeshScalar(name, read_only(np.concatenate(values)), key[1]))
    return tuple(joined)
