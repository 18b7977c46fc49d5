from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from autocolor.files.foreign.cells import FACES, CellSurface, Flats, cell_surface
from tests.autocolor.files.foreign.conftest import CUBE, SIDES

NODES = np.array([*CUBE, (0.5, 0.5, 0.5), (0.5, 0.5, 2)])

CELLS = {
    "tetra": [[0, 1, 2, 4], [1, 3, 2, 7], [1, 5, 4, 7], [2, 4, 6, 7], [1, 2, 4, 7]],
    "pyramid": [[*side[::-1], 8] for side in SIDES],
    "wedge": [[0, 1, 3, 4, 5, 7], [0, 3, 2, 4, 7, 6]],
    "hexahedron": [[0, 1, 3, 2, 4, 5, 7, 6]],
}
"""The unit cube, cut into cells of each shape; node 8 is its center."""


def volume_of(surface: CellSurface) -> float:
    """The volume that a closed surface turned outward encloses, by the divergence theorem."""
    total, places = 0.0, NODES[surface.nodes]
    for start, count in zip(surface.flats.starts, surface.flats.corner_counts, strict=True):
        first, *others = places[surface.flats.corners[start : start + count]]
        pairs = pairwise(others)
        total += sum(float(np.dot(first, np.cross(one, other))) / 6 for one, other in pairs)
    return total


@pytest.mark.parametrize("shape", FACES)
@pytest.mark.parametrize("turned", [False, True])
def test_a_cube_of_cells_of_each_shape_has_its_six_sides_and_its_volume(shape: str, turned: bool) -> None:
    table, base = np.array(CELLS[shape]), 3 if shape in ("tetra", "wedge") else 4
    if turned:
        # The corners of the base and of the top run the other way round.
        table = np.hstack([table[:, :base][:, ::-1], table[:, base:][:, ::-1]])
    surface = cell_surface(NODES[:9], [(shape, table, np.arange(len(table)))])
    triangles, quads = {"tetra": (12, 0), "wedge": (4, 4)}.get(shape, (0, 6))
    assert sorted(surface.flats.corner_counts.tolist()) == [3] * triangles + [4] * quads
    assert volume_of(surface) == pytest.approx(1)
    assert surface.nodes.tolist() == list(range(8))
    assert surface.sentences == (
        f"took the outer surface of {len(table)} volume {'cells' if len(table) > 1 else 'cell'}",
        "left out 1 node that the surface does not use",
    )


def test_cells_of_different_shapes_share_their_faces_and_polygons_that_are_faces_are_left_out() -> None:
    flats = [Flats(np.array([0, 1, 3, 2, 9]), np.array([5]), np.array([2]))]
    polygons = ("quad", np.array([[2, 3, 1, 0], [0, 1, 9, 9]]), np.array([0, 1]))
    volumes = [
        ("hexahedron", np.array(CELLS["hexahedron"]), np.array([3])),
        ("pyramid", np.array([[4, 5, 7, 6, 9]]), np.array([4])),
    ]
    surface = cell_surface(NODES, [polygons, *volumes], flats)
    assert surface.flats.corner_counts.tolist() == [3, 5, 4, 4, 4, 4, 4, 3, 3, 3, 3]
    assert surface.flats.cells.tolist() == [1, 2, *[3] * 5, *[4] * 4]
    assert surface.sentences[2] == "left out polygons that are faces of volume cells: 1"
    assert volume_of(cell_surface(NODES, volumes)) == pytest.approx(1 + 1 / 3)
    twice = ("tetra", np.array([[0, 1, 3, 4], [1, 0, 3, 4]]), np.arange(2))
    assert len(cell_surface(NODES, [twice]).flats.cells) == 0
