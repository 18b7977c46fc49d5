from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility import preselection as room
from autocolor.visibility import projection as projection_room
from autocolor.visibility.preselection import preselected
from autocolor.visibility.projection import Projection, focal_length, projection
from autocolor.visibility.raster import Raster
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import cube, decal_on_ground, grid
from tests.autocolor.strategies import meshes, outside_views, rasters, views


def in_two_steps(mesh: Mesh, view: View, lines: int, elements: int) -> Projection:
    """The projection as that of a large mesh, in chunks of a few polygons and nodes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(projection_room, "LARGE", 0)
        patch.setattr(room, "POLYGONS_AT_ONCE", 3)
        patch.setattr(room, "NODES_AT_ONCE", 5)
        return projection(mesh, view, lines, elements)


def same(one: Projection, other: Projection) -> bool:
    """Whether two projections hold the same polygons, to the bit, whatever the numbers of their nodes."""
    at_corners = (
        [each.x[each.corners], each.y[each.corners], each.inverse_depth[each.corners]]
        for each in (one, other)
    )
    rest = (
        [
            each.first_line[each.corners],
            each.normals[:, each.corner_normals],
            each.polygon_numbers,
            each.from_behind,
            each.line_counts,
            each.planes.columns,
            each.planes.linear,
            np.array([each.nearest, each.unit, each.focal_length]),
        ]
        for each in (one, other)
    )
    return all(
        a.shape == b.shape and a.tobytes() == b.tobytes()
        for pair in (at_corners, rest)
        for a, b in zip(*pair, strict=True)
    )


@given(meshes(), views() | outside_views(), rasters)
def test_a_large_mesh_is_projected_in_two_steps_to_the_same_bits(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    assert same(in_two_steps(mesh, view, *raster), projection(mesh, view, *raster))


@given(st.integers(0, 1 << 32))
def test_planes_that_polygons_share_are_the_same_in_two_steps(seed: int) -> None:
    mesh, view = decal_on_ground(seed)
    assert same(in_two_steps(mesh, view, 48, 64), projection(mesh, view, 48, 64))


@pytest.mark.parametrize("height", [0.7, 0.05])
@pytest.mark.parametrize("stray", [None, (0.1, 0.0, 0.7), (0.1, -7.0, 0.7), (1e20, 0.0, 0.0)])
def test_a_mesh_around_the_eye_is_clipped_in_two_steps_to_the_same_bits(
    height: float, stray: tuple[float, float, float] | None
) -> None:
    floor = grid(9, 9, (-2, -2, 0), (4, 0, 0), (0, 4, 0))
    # A node that no polygon uses may lie at the eye, behind it or far away.
    nodes = floor.coordinates if stray is None else np.concatenate([floor.coordinates, [stray]])
    mesh = Mesh(nodes, floor.node_numbers, floor.part_numbers, floor.part_names)
    view = View((0.1, 0.05, height), direction=(0.05, 1.0, -0.2), field_of_view=80)
    assert same(in_two_steps(mesh, view, 48, 64), projection(mesh, view, 48, 64))


def test_only_polygons_that_may_be_visible_are_put_into_camera_space() -> None:
    fine = grid(60, 60, (-1, 0, -1), (2, 0, 0), (0, 0, 2))
    view = View((0, -3, 0), direction=(0, 1, 0), field_of_view=60)
    raster = Raster(12, 16, focal_length(12, 60))
    camera = preselected(fine, view, raster)
    # Seven lines of seven pixel centers lie on the square; each is in one polygon, or at the edge of a few.
    seen = np.unique(visible_surfaces(fine, view, (1,), 12, 16).polygon_numbers)
    assert set(seen.tolist()) <= set(camera.polygon_numbers.tolist())
    assert len(seen) <= camera.corners.shape[1] < 4 * len(seen)
    assert camera.positions.shape[1] == len(np.unique(fine.node_numbers[camera.polygon_numbers]))
    assert (
        np.unique(fine.node_numbers[camera.polygon_numbers])[camera.corners]
        == fine.node_numbers[camera.polygon_numbers].T
    ).all()


def test_a_mesh_outside_the_picture_leaves_nothing_to_project() -> None:
    view = View((0, -3, 0), direction=(0, 1, 0), field_of_view=20)
    aside = Mesh(cube().coordinates + np.array([50.0, 0.0, 0.0]), cube().node_numbers)
    assert preselected(aside, view, Raster(12, 16, 30.0)).corners.shape == (4, 0)
