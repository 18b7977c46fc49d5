from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh
from autocolor.scene.same_meshes import has_same_tables
from autocolor.scene.scalars.mesh_scalars import MeshScalar

VALUES = np.array([1.0, np.nan, 3.0, 4.0])


def mesh(*scalars: MeshScalar, coordinates: object = None, part: str = "a", crease_angle: float = 40) -> Mesh:
    nodes = np.eye(4, 3) if coordinates is None else coordinates
    return Mesh(nodes, [[0, 1, 2]], [0], (part, "b"), crease_angle, scalars)  # type: ignore[arg-type]


def test_meshes_of_equal_tables_and_scalars_are_the_same_whatever_their_crease_angle() -> None:
    one, other = (mesh(MeshScalar("stress", VALUES.copy()), crease_angle=angle) for angle in (40.0, 20.0))
    assert has_same_tables(one, other)
    assert has_same_tables(one, one)


@pytest.mark.parametrize(
    "other",
    [
        mesh(),
        mesh(MeshScalar("strain", VALUES)),
        mesh(MeshScalar("stress", VALUES[:1], "polygon")),
        mesh(MeshScalar("stress", np.array([1.0, 2.0, 3.0, 4.0]))),
        mesh(MeshScalar("stress", VALUES), MeshScalar("strain", VALUES)),
        mesh(MeshScalar("stress", VALUES), part="c"),
        mesh(MeshScalar("stress", VALUES), coordinates=np.eye(4, 3) + 1),
    ],
    ids=["no scalar", "name", "of polygons", "a value", "one more", "part", "coordinates"],
)
def test_meshes_that_differ_in_anything_else_are_not_the_same(other: Mesh) -> None:
    one = mesh(MeshScalar("stress", VALUES))
    assert not has_same_tables(one, other)
    assert not has_same_tables(other, one)
