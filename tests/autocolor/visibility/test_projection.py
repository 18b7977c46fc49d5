from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View, render, scene_of
from autocolor.scene.scene import SCAN_LINE
from autocolor.testing import meshes, outside_views, views
from autocolor.visibility import projection as projection_module
from autocolor.visibility.projection import (
    Projection,
    Raster,
    focal_length,
    left_center,
    on_raster,
    preselected,
    projection,
    right_center,
    split_quads,
)
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.decals import decal_on_ground
from tests.autocolor.reference import ray
from tests.autocolor.strategies import interpolations, rasters
from tests.small import cube, grid, sphere
from tests.tables import first


@given(st.integers(1, 400), st.integers(1, 600), st.floats(0.01, 179))
def test_the_field_of_view_is_the_vertical_one_of_the_widest_raster_of_4_to_3(
    lines: int, elements: int, field_of_view: float
) -> None:
    half = math.tan(math.radians(field_of_view) / 2)
    if 3 * elements >= 4 * lines:
        assert focal_length(lines, elements, field_of_view) == lines / 2 / half
    else:
        assert focal_length(lines, elements, field_of_view) == elements * 0.75 / 2 / half


RASTER = Raster(10, 16, 20.0)


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(0.1, 10))
def test_a_node_lies_where_its_ray_meets_the_raster(right: float, down: float, depth: float) -> None:
    x, y, inverse_depth, first_line = on_raster(np.array([[right], [down], [depth]]), 1e-9, RASTER)
    assert x[0] == pytest.approx(8 + 20 * right / depth)
    assert y[0] == pytest.approx(5 + 20 * down / depth)
    assert inverse_depth[0] == 1 / depth
    centers = np.arange(10) + 0.5
    assert first_line[0] == np.count_nonzero(centers < y[0])


def test_a_node_behind_the_near_plane_is_put_on_it() -> None:
    nodes = on_raster(np.array([[1.0, 0.0], [1.0, 0.0], [-1.0, 0.5]]), 0.25, RASTER)
    assert nodes.inverse_depth.tolist() == [4.0, 2.0]
    assert nodes.x.tolist() == [8 + 20 * 4.0, 8.0]


def test_a_crossing_within_its_rounding_of_a_center_may_be_on_either_side() -> None:
    for x in (3.5 - 1e-9, 3.5, 3.5 + 1e-9):
        assert (left_center(np.array([x]))[0], right_center(np.array([x]))[0]) == (3, 4)
    assert (left_center(np.array([3.6]))[0], right_center(np.array([3.6]))[0]) == (4, 4)


@given(meshes(), views(), rasters)
def test_no_line_crosses_a_polygon_more_than_twice(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    projected = projection(mesh, view, *raster)
    first_lines = projected.first_line[projected.corners]
    for line in range(raster[0]):
        above = first_lines <= line
        crossed = (above != np.roll(above, -1, axis=0)).sum(axis=0)
        assert set(crossed.tolist()) <= {0, 2}


def test_a_node_that_no_polygon_uses_changes_nothing() -> None:
    mesh = cube()
    scene = scene_of(mesh)
    stray = Mesh(
        np.concatenate([mesh.coordinates, [(1e25, 0, 0), (0, 0, -1e30)]]),
        mesh.node_numbers,
        mesh.part_numbers,
        mesh.part_names,
    )
    pictures = [render(scene.replace(mesh=each), (40, 30)) for each in (mesh, stray)]
    assert pictures[0].intensity.tobytes() == pictures[1].intensity.tobytes()


def test_a_dart_is_split_at_its_notch() -> None:
    # The notch points down; a line below the tip of the notch crosses the dart four times.
    dart = Mesh(
        np.array([(-1, 0, 1), (0, 0, -1), (1, 0, 1), (0, 0, 0.2)]),
        np.array([(0, 1, 2, 3)]),
        np.zeros(1, np.intp),
        ("dart",),
    )
    for angle in (0, 90, 180, 270, 37):
        view = View((0, -4, 0), direction=(0, 1, 0), angle=angle, field_of_view=40)
        scene = scene_of(dart, view=view)
        covered = render(scene, (64, 64)).surface_number > 0
        for line, element in np.ndindex(64, 64):
            x, _, z = (4 * part for part in ray(view, 64, 64, line, element))
            x = abs(x)
            inside_by = min((z - (2 * x - 1)) / 2.3, ((0.2 + 0.8 * x) - z) / 1.3)
            if abs(inside_by) > 1e-6:
                assert covered[line, element] == (inside_by > 0)


GROUND = grid(1, 1, (-1, -1, 0), (2, 0, 0), (0, 2, 0), "ground")
DECAL = grid(2, 2, (-0.5, -0.5, 0), (1, 0, 0), (0, 1, 0), "decal")


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
    assert projected.planes is not None
    assert len(projected.planes.of_polygons) > 1
    assert set((projected.planes.of_polygons >= 0).tolist()) == {used}


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
    assert projected.planes is None


def in_two_steps(
    mesh: Mesh, view: View, lines: int, elements: int, interpolation: str = SCAN_LINE
) -> Projection:
    """The projection as that of a large mesh, in chunks of a few polygons and nodes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(projection_module, "LARGE", 0)
        patch.setattr(projection_module, "POLYGONS_AT_ONCE", 3)
        patch.setattr(projection_module, "NODES_AT_ONCE", 5)
        return projection(mesh, view, lines, elements, interpolation)


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
            *([] if each.planes is None else each.planes),
            *([] if each.diagonals is None else [each.diagonals]),
            np.array([each.nearest, each.unit, each.focal_length]),
        ]
        for each in (one, other)
    )
    return all(
        a.shape == b.shape and a.tobytes() == b.tobytes()
        for pair in (at_corners, rest)
        for a, b in zip(*pair, strict=True)
    )


@given(
    st.tuples(meshes(), views() | outside_views()) | st.integers(0, 1 << 32).map(decal_on_ground),
    rasters,
    interpolations,
)
def test_a_large_mesh_is_projected_in_two_steps_to_the_same_bits(
    scene: tuple[Mesh, View], raster: tuple[int, int], interpolation: str
) -> None:
    mesh, view = scene
    projected = projection(mesh, view, *raster, interpolation)
    assert same(in_two_steps(mesh, view, *raster, interpolation), projected)
    assert (projected.line_counts > 0).all()


@pytest.mark.parametrize("height", first(1, [0.7, 0.05]))
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
    raster = Raster(12, 16, focal_length(12, 16, 60))
    camera = preselected(fine, view, raster)
    # Seven lines of seven pixel centers lie on the square; each is in one polygon, or at the edge of a few.
    seen = np.unique(visible_surfaces(fine, view, (1,), 12, 16).polygon_numbers)
    assert set(seen.tolist()) <= set(camera.polygon_numbers.tolist())
    assert len(seen) <= camera.corners.shape[1] < 4 * len(seen)
    assert camera.positions.shape[1] == len(np.unique(fine.node_numbers[camera.polygon_numbers]))


DART = [(0, 0), (2, 5), (4, 0), (2, 1)]
BOW_TIE = [(0, 0), (4, 3), (4, 0), (0, 5)]


def triangles(
    corners: Sequence[tuple[float, float]], order: npt.NDArray[np.intp], depths: Sequence[float] | None = None
) -> list[frozenset[int]]:
    """The nodes of the two triangles of a quad, first the one that comes first."""
    x, y = np.array(corners, np.float64).T
    positions = np.stack([x, y, np.array(depths or [1.0] * 4)])
    columns = np.array(order, np.intp)[:, None]
    split, normals, parents = split_quads(np.array([0]), x, y, positions, columns, columns)
    assert split.tolist() == normals.tolist()
    assert parents.tolist() == [0, 0]
    return [frozenset(column.tolist()) for column in split.T]


@pytest.mark.parametrize("turn", range(4))
def test_a_quad_that_crosses_itself_is_split_along_its_shorter_diagonal_in_space(turn: int) -> None:
    order = np.roll(np.arange(4), turn)
    assert all({0, 2} <= half for half in triangles(BOW_TIE, order))
    assert all({1, 3} <= half for half in triangles(BOW_TIE, order, [1.0, 2.0, 9.0, 2.0]))


@given(
    st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=4, max_size=4, unique=True),
    st.integers(0, 3),
    st.booleans(),
)
def test_the_triangles_do_not_depend_on_the_corner_that_is_written_first(
    corners: list[tuple[float, float]], turn: int, backward: bool
) -> None:
    order = np.roll(np.arange(4), turn)
    assert triangles(corners, order[::-1] if backward else order) == triangles(corners, np.arange(4))


def test_triangles_take_the_place_of_their_quad_and_keep_its_winding() -> None:
    x, y = np.array([*DART, (9, 9), (9, 8), (8, 8)], np.float64).T
    positions = np.stack([x, y, np.ones(7)])
    columns = np.array([(4, 5, 6, 6), (0, 1, 2, 3), (6, 5, 4, 4)]).T
    split, _, parents = split_quads(np.array([1]), x, y, positions, columns, columns)
    assert parents.tolist() == [0, 1, 1, 2]
    assert split[:, [0, 3]].tolist() == columns[:, [0, 2]].tolist()
    for column in split[:, 1:3].T.tolist():
        # The nodes of a triangle follow each other around the quad as they did.
        assert column[2] == column[3]
        steps = np.diff([*column[:3], column[0]]) % 4
        assert steps.sum() == 4
