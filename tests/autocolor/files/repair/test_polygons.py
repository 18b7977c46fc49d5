from __future__ import annotations

import numpy as np

from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.polygons import Polygons
from autocolor.scene.scalars.mesh_scalars import MeshScalar


def test_a_piece_of_a_polygon_has_the_scalars_of_the_whole_and_nodes_keep_theirs() -> None:
    hexagon = [[2, 0, 0], [1, 2, 0], [-1, 2, 0], [-2, 0, 0], [-1, -2, 0], [1, -2, 0]]
    polygons = Polygons(
        np.array(hexagon, np.float64),
        np.array([0, 0, 1, 0, 1, 2, 3, 4, 5, 0, 1, 2]),
        np.array([3, 6, 3]),
        np.zeros(3, np.intp),
        ("all",),
        (MeshScalar("stress", np.arange(6.0)), MeshScalar("error", np.array([7.0, 8.0, 9.0]), "polygon")),
    )
    mesh = repaired(polygons, "a.ply").mesh
    stress, error = mesh.scalars
    assert stress.values.tolist() == [0, 1, 2, 3, 4, 5]
    assert error.values.tolist() == [8, 8, 9]
    assert len(mesh.node_numbers) == 3
