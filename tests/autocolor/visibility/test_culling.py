from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.visibility.culling import not_hidden
from autocolor.visibility.depth import depth_scale
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_surfaces import keep_front_most
from tests.autocolor.meshes import sphere
from tests.autocolor.strategies import meshes, outside_views, views

RASTER = (126, 171)


def kept_and_visible(mesh: Mesh, view: View) -> tuple[set[int], set[int]]:
    """The polygons from behind that are kept, and those that are seen when none is left out."""
    projected = projection(mesh, view, *RASTER)
    scale = depth_scale(projected)
    front, tops = np.zeros(RASTER[0] * RASTER[1], np.int64), np.zeros((2, scale.span_limit), np.int32)
    columns = np.flatnonzero(projected.from_behind)
    keep_front_most(front, tops, projected, scale, np.flatnonzero(~projected.from_behind))
    kept = not_hidden(front, projected, scale, columns)
    keep_front_most(front, tops, projected, scale, columns)
    crossing = np.unique(front & (scale.span_limit - 1))
    seen = np.searchsorted(projected.first_crossing, crossing[crossing > 0] - 1, side="right") - 1
    return set(kept.tolist()), set(seen.tolist()) & set(columns.tolist())


@given(meshes(), views() | outside_views())
def test_no_polygon_that_is_seen_is_taken_for_hidden(mesh: Mesh, view: View) -> None:
    kept, visible = kept_and_visible(mesh, view)
    assert visible <= kept


@pytest.mark.parametrize("distance", [2.5, 4.0, 9.0])
def test_the_far_side_of_a_ball_is_hidden_but_near_its_rim(distance: float) -> None:
    view = View((0, -distance, 0), target=(0, 0, 0), field_of_view=60)
    kept, visible = kept_and_visible(sphere(), view)
    behind = int(projection(sphere(), view, *RASTER).from_behind.sum())
    assert visible <= kept
    assert len(kept) < 0.9 * behind
