from __future__ import annotations

import numpy as np
import pytest

from autocolor.arrays import Floats, Indices
from autocolor.files.meshes.cells import CORNERS, CellSurface, Flats, Volumes, cell_surface

NO_FLATS = Flats(np.empty(0, np.intp), np.empty(0, np.intp), np.empty(0, np.intp))

CUBE = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float
)

CELLS = {
    "tetra": [[0, 1, 3, 4], [1, 2, 3, 6], [1, 5, 4, 6], [3, 4, 7, 6], [1, 3, 4, 6]],
    "pyramid": [[0, 1, 2, 3, 8], [4, 7, 6, 5, 8], [0, 4, 5, 1, 8],
                [1, 5, 6, 2, 8], [2, 6, 7, 3, 8], [3, 7, 4, 0, 8]],
    "wedge": [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]],
    "hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]],
}  # fmt: skip
"""The unit cube, cut into cells of each shape; node 8 is its center."""

TRIANGLES_AND_QUADS = {"tetra": (12, 0), "pyramid": (0, 6), "wedge": (4, 4), "hexahedron": (0, 6)}


def volumes(shape: str, table: list[list[int]] | None = None) -> Volumes:
    corners = np.array(CELLS[shape] if table is None else table)
    return Volumes(shape, corners, np.arange(len(corners)))


def with_center() -> Floats:
    return np.concatenate([CUBE, [[0.5, 0.5, 0.5]]])


def volume_of(surface: CellSurface, coordinates: Floats) -> float:
    """The volume that a closed surface turned outward encloses, by the divergence theorem."""
    total, at = 0.0, 0
    places = coordinates[surface.nodes]
    for count in surface.flats.corner_counts.tolist():
        corners = places[surface.flats.corners[at : at + count]]
        for second in range(1, count - 1):
            total += float(np.dot(corners[0], np.cross(corners[second], corners[second + 1]))) / 6
        at += count
    return total


@pytest.mark.parametrize("shape", CORNERS)
@pytest.mark.parametrize("turned", [False, True])
def test_a_cube_of_cells_of_each_shape_has_its_six_sides_and_its_volume(shape: str, turned: bool) -> None:
    table = np.array(CELLS[shape])
    if turned:
        half = CORNERS[shape] // 2
        order = {"tetra": [1, 0, 2, 3], "pyramid": [3, 2, 1, 0, 4]}.get(
            shape, [*range(half, 2 * half), *range(half)]
        )
        table = table[:, order]
    coordinates = with_center()
    surface = cell_surface(coordinates, NO_FLATS, [Volumes(shape, table, np.arange(len(table)))])
    counts = surface.flats.corner_counts
    assert ((counts == 3).sum(), (counts == 4).sum()) == TRIANGLES_AND_QUADS[shape]
    assert volume_of(surface, coordinates) == pytest.approx(1)
    assert surface.nodes.tolist() == list(range(8))
    many = len(table) > 1
    assert surface.sentences == (
        f"took the outer surface of {len(table)} volume {'cells' if many else 'cell'}",
        "left out 1 node that the surface does not use",
    )


def test_cells_of_different_shapes_share_their_faces() -> None:
    coordinates = np.concatenate([CUBE, [[0.5, 0.5, 2.0]]])
    surface = cell_surface(
        coordinates,
        NO_FLATS,
        [volumes("hexahedron"), Volumes("pyramid", np.array([[4, 5, 6, 7, 8]]), np.array([1]))],
    )
    assert sorted(surface.flats.corner_counts.tolist()) == [3, 3, 3, 3, 4, 4, 4, 4, 4]
    assert surface.flats.cells.tolist() == [0] * 5 + [1] * 4
    assert volume_of(surface, coordinates) == pytest.approx(1 + 1 / 3)


def test_polygons_that_are_faces_of_cells_are_left_out_and_others_kept() -> None:
    flats = Flats.joined(
        [
            Flats.of(np.array([[3, 2, 1, 0], [0, 1, 8, 8]]), np.array([0, 1])),
            Flats(np.array([0, 1, 2, 3, 8]), np.array([5]), np.array([2])),
        ]
    )
    surface = cell_surface(with_center(), flats, [Volumes("hexahedron", np.arange(8)[None], np.array([3]))])
    assert surface.flats.corner_counts.tolist() == [3, 5, 4, 4, 4, 4, 4, 4]
    assert surface.flats.cells.tolist() == [1, 2, 3, 3, 3, 3, 3, 3]
    assert surface.sentences == (
        "took the outer surface of 1 volume cell",
        "left out 1 polygon that are faces of volume cells",
    )


def test_a_triangle_that_repeats_another_corner_is_the_same_face() -> None:
    two: Indices = np.array([[0, 1, 3, 4], [1, 0, 3, 4]])
    assert len(cell_surface(CUBE, NO_FLATS, [volumes("tetra", two.tolist())]).flats.cells) == 0


def test_polygons_of_several_lists_come_in_the_order_of_their_rows() -> None:
    joined = Flats.joined(
        [
            Flats(np.array([5, 6, 7, 1, 2, 3, 4]), np.array([3, 0, 4]), np.array([4, 5, 0])),
            Flats.of(np.array([[9, 8, 7, 7]]), np.array([2])),
        ]
    )
    assert joined.corners.tolist() == [1, 2, 3, 4, 9, 8, 7, 5, 6, 7]
    assert joined.corner_counts.tolist() == [4, 3, 3]
    assert joined.cells.tolist() == [0, 2, 4]
    assert len(Flats.joined([]).cells) == 0
