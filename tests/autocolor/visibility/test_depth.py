from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.testing import meshes, outside_views, views
from autocolor.visibility.depth import (
    KEY_BITS,
    LEAST_NUMBER_BITS,
    DepthScale,
    depth_scale,
    numbers_of_polygons,
    plane_keys,
    plane_rounding,
    polygons_of_numbers,
    segments_of_polygons,
)
from autocolor.visibility.projection import LARGEST_PLANE_ERROR, projection
from autocolor.visibility.scan_lines import extents_of_polygons
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.decals import ROUNDINGS, decal_on_ground
from tests.autocolor.strategies import rasters
from tests.small import grid

depths = st.floats(1e-9, 1.0)


@given(st.integers(1, 24), depths, depths)
def test_the_nearer_polygon_has_the_larger_key_whatever_its_number(
    bits: int, one: float, other: float
) -> None:
    scale = DepthScale(1 << bits, 2.0 ** (62 - bits))
    near, far = (int(key) for key in scale.keys(np.array([max(one, other), min(one, other)])))
    assert near >= far
    assert (near > far) == (near > far + scale.number_limit - 1)
    assert near % scale.number_limit == 0


def test_a_step_beyond_all_depths_is_still_a_whole_number() -> None:
    scale = DepthScale(1 << 16, 2.0**46)
    assert scale.keys(np.array([1e30, -1e30])).tolist() == [2**62, -(2**62)]


@given(st.integers(0, 1 << 32), outside_views() | st.none())
def test_the_key_of_a_shared_plane_is_the_same_wherever_its_steps_begin(seed: int, view: View | None) -> None:
    mesh, before = decal_on_ground(seed)
    projected = projection(mesh, view or before, 48, 64)
    scale = depth_scale(projected)
    if scale.planes is None:
        return
    lines, elements = (each.ravel() for each in np.mgrid[0:48, 0:64])
    starts, steps = plane_keys(projected, scale, np.zeros_like(lines), lines, elements)
    assert len(set(steps.tolist())) == 1
    assert (np.diff(starts.reshape(48, 64), axis=1) == steps[0]).all()
    expected = scale.depths_of_planes(np.zeros_like(lines), elements + 0.5, lines + 0.5)
    inside = (expected > 0.5 * projected.inverse_depth.min()) & (expected < projected.nearest)
    units = starts[inside] // scale.number_limit
    assert np.abs(units - expected[inside] * scale.factor).max(initial=0) <= plane_rounding(projected)
    assert (starts % scale.number_limit == 0).all()


@given(st.integers(0, 1 << 32), st.sampled_from(ROUNDINGS))
def test_the_depth_of_a_plane_is_the_depth_of_the_corners_of_its_polygons(seed: int, rounding: str) -> None:
    mesh, view = decal_on_ground(seed, rounding)
    projected = projection(mesh, view, 48, 64)
    scale = depth_scale(projected)
    if scale.planes is not None:
        corners = projected.corners[:, scale.planes >= 0]
        x, y = projected.x[corners], projected.y[corners]
        depths = scale.depths_of_planes(np.zeros_like(corners), x, y)
        assert depths == pytest.approx(projected.inverse_depth[corners], rel=1.1 * LARGEST_PLANE_ERROR)


def test_a_plane_whose_depths_no_key_can_hold_leaves_its_polygons_their_own() -> None:
    two = [grid(1, 1, (-side, -1, 0), (2 * side, 0, 0), (0, 2 * side, 0), str(side)) for side in (1, 0.5)]
    upright = [
        grid(1, 1, (-side, 9, -1), (2 * side, 0, 0), (0, 0, 2), f"upright {side}") for side in (1, 0.5)
    ]
    view = View((0.0, -4.0, 1e-6), direction=(0, 1, 0))
    projected = projection(Mesh.joined([*two, *upright]), view, 3, 3)
    assert projected.planes is not None
    assert sorted(set(projected.planes.of_polygons.tolist())) in ([0], [1], [0, 1])
    scale = depth_scale(projected)
    assert scale.planes is not None
    assert len(set(scale.planes.tolist()) - {-1}) == 1


def test_a_corner_beside_the_eye_leaves_the_depths_in_the_picture_as_fine_as_before() -> None:
    far = grid(1, 1, (-1, 1, -1), (2, 0, 0), (0, 0, 2), "far")
    beside = grid(1, 1, (0.5, 1e-8, -1), (0, 1, 0), (0, 0, 2), "beside")
    view = View((0.0, 0.0, 0.0), direction=(0, 1, 0), field_of_view=70)
    projected = projection(Mesh.joined([far, beside]), view, 48, 64)
    assert projected.nearest > 1e7
    assert depth_scale(projected).factor > 2.0**KEY_BITS / 2.0**LEAST_NUMBER_BITS / 2048
    # A wall just behind another is hidden by it, however near the eye a third one begins.
    behind = grid(1, 1, (-1, 1 + 1e-5, -1), (2, 0, 0.3), (0, 0, 2), "behind")
    points = visible_surfaces(Mesh.joined([far, beside, behind]), view, (1, 2, 3), 48, 64)
    assert not (points.polygon_numbers == 2)[points.world_points[:, 2] < 0.69].any()


@given(meshes(), views() | outside_views(), rasters)
def test_the_keys_of_a_polygons_segments_hold_its_depth_and_its_number(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected = projection(mesh, view, *raster)
    scale = depth_scale(projected)
    every = np.arange(projected.corners.shape[1])
    numbers = numbers_of_polygons(projected, every)
    # Polygons that face the eye have the highest numbers, and every number leads to its polygon.
    order = sorted(every.tolist(), key=lambda polygon: (not projected.from_behind[polygon], polygon))
    assert np.argsort(numbers).tolist() == order
    assert polygons_of_numbers(projected, numbers).tolist() == every.tolist()
    assert all(0 < number < scale.number_limit for number in numbers.tolist())

    polygons = every[::2]
    extents, segments = (
        extents_of_polygons(projected, polygons),
        segments_of_polygons(projected, scale, polygons),
    )
    assert segments.number.tolist() == numbers[polygons[extents.row]].tolist()
    assert segments.first_pixel.tolist() == (extents.line * raster[1] + extents.first).tolist()
    assert segments.count.tolist() == extents.count.tolist()
    last = segments.start + (segments.count - 1) * segments.step
    ends = extents.start, extents.start + (extents.count - 1) * extents.step
    for keys, depths in zip((segments.start, last), ends, strict=True):
        assert not (keys % scale.number_limit).any()
        assert (keys >= 0).all()
        if scale.planes is None:
            # Half a unit of depth for each pixel on the way.
            difference = keys // scale.number_limit - depths * scale.factor
            assert (np.abs(difference) <= 1 + extents.count / 2 + 2.0**-50 * depths * scale.factor).all()
