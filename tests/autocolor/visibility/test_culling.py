from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility.culling import not_occluded
from autocolor.visibility.depth import depth_scale, polygons_of_numbers
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_surfaces import depth_test
from tests.autocolor.meshes import decal_on_ground, sphere
from tests.autocolor.strategies import meshes, outside_views, views

RASTER = (126, 171)


def kept_and_visible(mesh: Mesh, view: View) -> tuple[set[int], set[int]]:
    """The polygons seen from behind that are kept, and those that are visible when none is culled."""
    projected = projection(mesh, view, *RASTER)
    scale = depth_scale(projected)
    depth_buffer = np.zeros(RASTER[0] * RASTER[1], np.int64)
    behind = np.flatnonzero(projected.from_behind)
    depth_test(depth_buffer, projected, scale, np.flatnonzero(~projected.from_behind))
    kept = not_occluded(depth_buffer, projected, scale, behind)
    depth_test(depth_buffer, projected, scale, behind)
    number = np.unique(depth_buffer & (scale.number_limit - 1))
    visible = polygons_of_numbers(projected, number[number > 0])
    return set(kept.tolist()), set(visible.tolist()) & set(behind.tolist())


@given(meshes(), views() | outside_views())
def test_no_visible_polygon_is_culled(mesh: Mesh, view: View) -> None:
    kept, visible = kept_and_visible(mesh, view)
    assert visible <= kept


@given(st.integers(0, 1 << 32), st.booleans())
def test_no_visible_polygon_of_a_shared_plane_is_culled(seed: int, cover: bool) -> None:
    mesh, view = decal_on_ground(seed)
    # Let half of the polygons run the other way round.
    numbers = mesh.node_numbers.copy()
    numbers[::2] = numbers[::2, ::-1]
    if cover:
        # A copy that faces the eye lies on all of them.
        numbers = np.concatenate([numbers, numbers[:, ::-1]])
    parts = np.zeros(len(numbers), np.intp)
    kept, visible = kept_and_visible(Mesh(mesh.coordinates, numbers, parts, ("all",)), view)
    assert visible <= kept


@pytest.mark.parametrize("distance", [2.5, 4.0, 9.0])
def test_the_far_side_of_a_ball_is_culled_except_near_its_rim(distance: float) -> None:
    view = View((0, -distance, 0), target=(0, 0, 0), field_of_view=60)
    kept, visible = kept_and_visible(sphere(), view)
    behind = int(projection(sphere(), view, *RASTER).from_behind.sum())
    assert visible <= kept
    assert len(kept) < 0.9 * behind
