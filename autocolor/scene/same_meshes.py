"""Whether two meshes are the same, such as one in memory and the one that its file holds."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.scene.mesh import Mesh

TABLES: Final = ("coordinates", "node_numbers", "part_numbers")


def has_same_tables(one: Mesh, other: Mesh) -> bool:
    """Whether all tables and scalars of two meshes are equal; the crease angle is not one of them."""
    if one is other:
        return True
    return (
        one.part_names == other.part_names
        and [(scalar.name, scalar.of) for scalar in one.scalars]
        == [(scalar.name, scalar.of) for scalar in other.scalars]
        and all(np.array_equal(vars(one)[name], vars(other)[name]) for name in TABLES)
        and all(
            np.array_equal(scalar.values, same.values, equal_nan=True)
            for scalar, same in zip(one.scalars, other.scalars, strict=True)
        )
    )
