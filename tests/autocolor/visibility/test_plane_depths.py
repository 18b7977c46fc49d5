from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility.plane_depths import MOST_OFF
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import ROUNDINGS, decal_on_ground, grid, sphere

GROUND = grid(1, 1, (-1, -1, 0), (2, 0, 0), (0, 2, 0), "ground")
DECAL = grid(2, 2, (-0.5, -0.5, 0), (1, 0, 0), (0, 1, 0), "decal")


@given(st.integers(0, 1 << 32), st.sampled_from(ROUNDINGS))
def test_the_depth_of_a_plane_is_that_of_the_corners_of_its_polygons(seed: int, rounding: str) -> None:
    mesh, view = decal_on_ground(seed, rounding)
    projected = projection(mesh, view, 48, 64)
    corners = projected.corners[:, projected.planes.columns >= 0]
    x, y = projected.x[corners], projected.y[corners]
    depths = projected.planes.inverse_depth(np.zeros_like(corners), x, y)
    assert depths == pytest.approx(projected.inverse_depth[corners], rel=1.1 * MOST_OFF)


@given(st.integers(0, 1 << 32))
def test_all_polygons_of_a_plane_and_winding_are_seen_from_the_same_side(seed: int) -> None:
    mesh, view = decal_on_ground(seed)
    projected = projection(mesh, view, 48, 64)
    assert len(set(projected.from_behind.tolist())) <= 1
    turned = Mesh(mesh.coordinates, mesh.node_numbers[:, ::-1], mesh.part_numbers, mesh.part_names)
    other = projection(turned, view, 48, 64)
    assert other.from_behind.tolist() == (~projected.from_behind).tolist()


@pytest.mark.parametrize(("height", "used"), [(0.5, True), (0.01, True), (1e-4, True), (1e-5, False)])
def test_a_plane_is_not_used_where_the_eye_is_almost_in_it(height: float, used: bool) -> None:
    # The decal is as uneven as numbers of six decimals.
    uneven = DECAL.coordinates + np.random.default_rng(1).choice([0.0, 1e-6], (len(DECAL.coordinates), 3))
    decal = Mesh(uneven, DECAL.node_numbers, DECAL.part_numbers, DECAL.part_names)
    mesh = Mesh.joined([GROUND, decal])
    projected = projection(mesh, View((0.0, 0.0, height), direction=(0, 1, -1)), 48, 64)
    assert len(projected.planes.columns) > 1
    assert (projected.planes.columns >= 0).all() == used
    assert (projected.planes.columns < 0).all() == (not used)


@pytest.mark.parametrize("rounding", ["float32", "decimals"])
@given(seed=st.integers(0, 1 << 32))
def test_a_decal_hides_its_ground_even_if_it_is_seen_almost_edge_on(rounding: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    mesh = Mesh.joined([GROUND, DECAL])
    corners = mesh.coordinates @ turn
    corners = corners.round(6) if rounding == "decimals" else corners.astype(np.float32).astype(np.float64)
    angle = random.uniform(0, 6.28)
    eye = np.array([0.3 * np.cos(angle), 0.3 * np.sin(angle), 1.5e-4])
    view = View(tuple((eye @ turn).tolist()), target=(0, 0, 0), field_of_view=100.0)

    def parts(*numbers: int) -> dict[int, int]:
        chosen = np.isin(mesh.part_numbers, numbers)
        some = Mesh(corners, mesh.node_numbers[chosen], mesh.part_numbers[chosen], mesh.part_names)
        points = visible_surfaces(some, view, (1, 2), 48, 64)
        seen = some.part_numbers[points.polygon_numbers]
        return dict(zip(points.pixels.tolist(), seen.tolist(), strict=True))

    both, decal = parts(0, 1), parts(1)
    assert decal.keys() == {pixel for pixel, part in both.items() if part == 1}


def test_a_mesh_without_shared_planes_has_none_on_the_raster() -> None:
    projected = projection(sphere(), View((0.0, -4.0, 0.0), target=(0, 0, 0)), 48, 64)
    assert projected.planes.columns.size == projected.planes.linear.size == 0
