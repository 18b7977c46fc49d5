from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh
from autocolor.scene.geometry.faults.quad_shapes import QuadShapes, polygon_shapes, quad_shapes


@pytest.mark.parametrize(
    ("corners", "shapes"),
    [
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], QuadShapes(1, 0, 0, 0)),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]], QuadShapes(1, 1, 0, 0)),
        ([[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]], QuadShapes(1, 0, 1, 0)),
        ([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], QuadShapes(1, 0, 0, 1)),
        ([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]], QuadShapes(1, 0, 0, 1)),
    ],
    ids=["square", "warped", "concave", "bow-tie that cancels", "bow-tie"],
)
@pytest.mark.parametrize("scale", [1e-20, 1.0, 1e20])
def test_a_quad_is_told_by_its_shape_at_any_size(
    corners: list[list[float]], shapes: QuadShapes, scale: float
) -> None:
    for first in range(4):
        quad = np.roll(np.arange(4), first)
        mesh = Mesh(
            np.array(corners) * scale, np.array([quad, quad[[0, 1, 2, 2]]]), np.zeros(2, np.intp), ("a",)
        )
        assert quad_shapes(mesh) == shapes


def test_a_mesh_of_triangles_has_no_quads() -> None:
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2, 2]]), np.zeros(1, np.intp), ("a",))
    assert quad_shapes(mesh) == QuadShapes(0, 0, 0, 0)


def test_polygons_without_area_are_no_quads_of_another_shape() -> None:
    places = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [0, 1, 0.0]])
    found = polygon_shapes(places, np.array([[0, 1, 2, 3], [0, 1, 2, 2], [0, 0, 0, 0], [0, 1, 4, 4]]))
    assert found.without_area.tolist() == [0, 1, 2]
    assert len(found.warped) == len(found.concave) == len(found.crossed) == 0
