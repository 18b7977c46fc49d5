"""What is visible is what a ray meets first."""

from __future__ import annotations

import itertools
import math
import tracemalloc

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.arrays import Numbers, runs
from autocolor.scene.scene import INVARIANT, SCAN_LINE
from autocolor.testing import directions, meshes, numbers, outside_views, vectors, views
from autocolor.visibility import visible_surfaces as module
from autocolor.visibility.depth import depth_scale, polygons_of_numbers
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_points import NORMAL, POINT, POINT_SQUARED, REFLECTED_VIEW, VisiblePoints
from autocolor.visibility.visible_surfaces import (
    depth_test,
    not_occluded,
    visible_surfaces,
)
from tests.autocolor.decals import ROUNDINGS, decal_on_ground
from tests.autocolor.reference import first_hit, on_triangles, ray
from tests.autocolor.strategies import rasters, soups
from tests.autocolor.twins.point import dot, minus, times, unit
from tests.small import cube, grid, sphere, uneven_wall
from tests.tables import first


def on_raster(points: VisiblePoints) -> npt.NDArray[np.float64]:
    """The polygon, the world point and the world normal at each pixel, (lines, elements, 7); -1 for none."""
    raster = np.full((points.lines * points.elements, 7), -1.0)
    raster[points.pixels] = np.column_stack(
        [points.polygon_numbers, points.world_points, points.world_normals]
    )
    return raster.reshape(points.lines, points.elements, 7)


@given(st.integers(0, 1 << 32))
def test_polygons_that_pass_through_each_other_cross_where_they_should(seed: int) -> None:
    # Two planes x = slope * y through the eye's axis: to the left of the crossing one is nearer.
    slopes = np.random.default_rng(seed).uniform(0.2, 0.9, 2)
    crossed = Mesh.joined(
        [
            grid(1, 1, (-1, -slope * sign, -1), (2, 2 * slope * sign, 0), (0, 0, 2), f"plane {sign}")
            for slope, sign in zip(slopes, (1, -1), strict=True)
        ]
    )
    view = View((0.0, -5.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=20.0)
    left, right = np.hsplit(on_raster(visible_surfaces(crossed, view, (1, 2), 16, 16))[..., 0], 2)
    assert set(left.ravel().tolist()) == {-1, 0}
    assert set(right.ravel().tolist()) == {-1, 1}


def test_the_later_of_two_coincident_polygons_is_visible() -> None:
    twice = Mesh.joined([grid(1, 1, (-1, 0, -1), (2, 0, 0), (0, 0, 2), name) for name in ("a", "b")])
    view = View((0.3, -3.0, 0.2), target=(0.0, 0.0, 0.0))
    points = visible_surfaces(twice, view, (1, 2), 12, 12)
    assert set(points.polygon_numbers.tolist()) == {1}


def test_a_floor_that_runs_from_behind_the_eye_fills_the_picture_up_to_the_horizon() -> None:
    floor = grid(1, 1, (-1000, -1000, 0), (2000, 0, 0), (0, 2000, 0))
    view = View((0.0, 0.0, 1.0), direction=(0.0, 1.0, 0.0), field_of_view=60.0)
    points = visible_surfaces(floor, view, (1,), 20, 30)
    assert sorted(points.pixels.tolist()) == list(range(10 * 30, 20 * 30))


# A narrower picture than 1 to 12 would see above the polygons.


@pytest.mark.parametrize("mesh", [cube(4), sphere(12, 8, 2.0), cube(4e-15), sphere(12, 8, 2e15)], ids=repr)
@given(st.data())
def test_a_closed_mesh_has_no_crack_from_within(mesh: Mesh, data: st.DataObject) -> None:
    low, high = mesh.bounds
    middle, size = (low + high) / 2, (high - low)[0]
    place = np.array(data.draw(vectors(numbers(-0.2, 0.2))))
    view = View(
        tuple((middle + place * size).tolist()),
        direction=data.draw(directions()),
        field_of_view=data.draw(st.sampled_from([20.0, 60.0, 120.0])),
    )
    lines, elements = data.draw(rasters)
    points = visible_surfaces(mesh, view, (1,), lines, elements)
    assert sorted(points.pixels.tolist()) == list(range(lines * elements))


@given(st.integers(0, 1 << 32), st.integers(1, 30))
def test_a_wall_of_uneven_polygons_has_no_crack(seed: int, lines: int) -> None:
    uneven = uneven_wall(seed)
    view = View((0.1, -4.0, 0.2), target=(0.0, 0.0, 0.0), field_of_view=30.0)
    points = visible_surfaces(uneven, view, (1,), lines, lines)
    assert len(points.pixels) == lines * lines


def slivers(count: int) -> Mesh:
    """Triangles from the top of the picture to its bottom, one behind the other."""
    left = np.linspace(-1.3, 1.3, count)
    feet = np.stack([left, np.linspace(0.0, 1.0, count), np.full(count, -1.2)], axis=1)
    offsets = np.array([(0, 0, 0), (0.004, 0, 0), (0.01, 0, 2.4)])
    corners = (feet[:, None] + offsets).reshape(-1, 3)
    return Mesh(corners, np.arange(3 * count).reshape(-1, 3), np.zeros(count, np.intp), ("slivers",))


def test_twice_as_many_polygons_as_high_as_the_picture_take_hardly_more_memory() -> None:
    view = View((0.0, -4.0, 0.0), direction=(0.0, 1.0, 0.0), field_of_view=2.5)
    peaks = []
    for mesh in (slivers(4000), slivers(8000)):
        assert mesh.normals
        tracemalloc.start()
        visible_surfaces(mesh, view, (1,), 400, 40)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.5 * peaks[0]


@pytest.mark.parametrize("size", [1e-3, 1e-6, 1e-8])
def test_an_object_of_any_size_before_the_eye_is_visible_in_front_of_a_plate(size: float) -> None:
    plate = grid(1, 1, (-1, 1, -1), (2, 0, 0), (0, 0, 2), "plate")
    thing = grid(1, 1, (-size / 8, 0, -size / 8), (size / 4, 0, 0), (0, 0, size / 4), "thing")
    view = View((0.0, -size, 0.0), direction=(0.0, 1.0, 0.0), field_of_view=30.0)
    points = visible_surfaces(Mesh.joined([thing, plate]), view, (1, 2), 40, 60)
    counts = np.bincount(points.polygon_numbers, minlength=2)
    # A quarter of its distance is 0.25 / (2 tan 15) of the picture's height.
    side = round(40 * 0.25 / (2 * math.tan(math.radians(15))))
    assert abs(counts[0] - side**2) <= 2 * side + 1
    assert counts.sum() == 40 * 60


def part(mesh: Mesh, number: int) -> Mesh:
    chosen = mesh.part_numbers == number
    return Mesh(mesh.coordinates, mesh.node_numbers[chosen], mesh.part_numbers[chosen], mesh.part_names)


@given(seed=st.integers(0, 1 << 32))
def test_in_a_plane_polygons_that_face_the_eye_hide_the_others(seed: int) -> None:
    mesh, view = decal_on_ground(seed)
    raster = (60, 80)
    numbers = mesh.node_numbers.copy()
    numbers[mesh.part_numbers == 1] = numbers[mesh.part_numbers == 1, ::-1]
    both = Mesh(mesh.coordinates, numbers, mesh.part_numbers, mesh.part_names)
    facing = int(projection(part(mesh, 0), view, *raster).from_behind.any())
    points = visible_surfaces(both, view, (1, 2), *raster)
    on_top = points.pixels[mesh.part_numbers[points.polygon_numbers] == facing]
    alone = visible_surfaces(part(both, facing), view, (1, 2), *raster).pixels
    assert sorted(on_top.tolist()) == sorted(alone.tolist())


CULLING_RASTER = (126, 171)


def examined_and_visible(mesh: Mesh, view: View) -> tuple[set[int], set[int]]:
    """Of the polygons seen from behind: those that are not culled, and those visible if none is culled."""
    projected = projection(mesh, view, *CULLING_RASTER)
    scale = depth_scale(projected)
    depth_buffer = np.zeros(CULLING_RASTER[0] * CULLING_RASTER[1], np.int64)
    behind = np.flatnonzero(projected.from_behind)
    depth_test(depth_buffer, projected, scale, np.flatnonzero(~projected.from_behind))
    tested = not_occluded(depth_buffer, projected, scale, behind)
    depth_test(depth_buffer, projected, scale, behind)
    number = np.unique(depth_buffer & (scale.number_limit - 1))
    visible = polygons_of_numbers(projected, number[number > 0])
    return set(tested.tolist()), set(visible.tolist()) & set(behind.tolist())


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
    tested, visible = examined_and_visible(Mesh(mesh.coordinates, numbers, parts, ("all",)), view)
    assert visible <= tested


@pytest.mark.parametrize("distance", [2.5, 4.0, 9.0])
def test_the_far_side_of_a_ball_is_culled_except_near_its_rim(distance: float) -> None:
    view = View((0, -distance, 0), target=(0, 0, 0), field_of_view=60)
    tested, visible = examined_and_visible(sphere(), view)
    behind = int(projection(sphere(), view, *CULLING_RASTER).from_behind.sum())
    assert visible <= tested
    assert len(tested) < 0.9 * behind


@given(st.integers(0, 1 << 32), st.booleans())
def test_culling_segments_changes_no_pixel(seed: int, in_planes: bool) -> None:
    random = np.random.default_rng(seed)
    mesh, view = decal_on_ground(seed)
    # Add copies of the polygons that lie in the same planes, or a little farther or nearer.
    shift = np.zeros(3) if in_planes else random.normal(scale=0.05, size=3)
    copies = [
        Mesh(mesh.coordinates + number * shift, random.permuted(mesh.node_numbers[:, ::turn], axis=0))
        for number, turn in enumerate((1, -1, 1))
    ]
    mesh = Mesh.joined(copies)
    plain = visible_surfaces(mesh, view, (1,), *CULLING_RASTER)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "OVERDRAW", 0)
        patch.setattr(module, "SEGMENTS_AT_ONCE", 1000)
        culled = visible_surfaces(mesh, view, (1,), *CULLING_RASTER)
    assert np.array_equal(plain.polygon_numbers, culled.polygon_numbers)
    assert np.array_equal(plain.rows, culled.rows)


@pytest.mark.parametrize("apart", [0.0, 1e-3])
def test_of_a_stack_of_quads_few_are_drawn(apart: float, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = 0

    def counted(first: Numbers, count: Numbers, *step: Numbers) -> Numbers:
        nonlocal drawn
        drawn += int(count.sum())
        return runs(first, count, *step)

    monkeypatch.setattr(module, "runs", counted)
    monkeypatch.setattr(module, "SEGMENTS_AT_ONCE", 1000)
    stack = Mesh.joined(
        [panel((-1, y, -1), (1, y, -1), (1, y, 1), (-1, y, 1)) for y in np.arange(1000) * apart]
    )
    visible_surfaces(stack, View((0.1, -4, 0), target=(0.1, 0, 0)), (1,), 60, 80)
    assert drawn < 1000 * 60 * 80 / 10


tenths = st.integers(-20, 20).map(lambda number: number / 10)


def panel(*corners: tuple[float, float, float]) -> Mesh:
    return Mesh(np.array(corners), np.array([[0, 1, 2, 3]]), np.array([0]), ("panel",))


@given(tenths, tenths, tenths, st.integers(1, 30).map(lambda number: number / 10))
def test_the_points_of_an_edge_on_board_are_on_the_board(
    x: float, first: float, low: float, size: float
) -> None:
    mesh = panel(
        (x, first, low),
        (x, first + size, low),
        (x, first + size, low + size),
        (x, first, low + size),
    )
    for eye in ((x, first - 3.0, low + 0.3), (x + 1e-9, first - 3.0, low + 0.3)):
        points = visible_surfaces(mesh, View(eye, direction=(0, 1, 0), field_of_view=40), (1,), 24, 33)
        assert np.isfinite(points.rows).all()
        on_board = points.world_points
        assert (np.abs(on_board[:, 0] - x) < 1e-3 * size).all()
        assert ((on_board[:, 1] > first - 0.01 * size) & (on_board[:, 1] < first + 1.01 * size)).all()


@pytest.mark.parametrize("beside", first(2, [1e-4, 0.1, 1e-3]))
@pytest.mark.parametrize("turn", first(2, [0.3, -0.7, 0.0]))
def test_a_flat_wall_close_beside_the_eye_keeps_its_normal(beside: float, turn: float) -> None:
    wall = panel((beside, -50, -20), (beside, 70, -20), (beside, 70, 20), (beside, -50, 20))
    view = View((0.0, 0.0, 0.0), direction=(turn, 1.0, 0.1), field_of_view=60)
    normals = visible_surfaces(wall, view, (1,), 48, 64).world_normals
    assert len(normals)
    assert normals == pytest.approx(np.tile([-1.0, 0.0, 0.0], (len(normals), 1)), abs=1e-5)


@given(meshes() | st.integers(0, 99).map(uneven_wall), views() | outside_views(), rasters)
def test_every_quad_is_two_triangles_if_interpolation_is_invariant(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    points = visible_surfaces(mesh, view, (1, 2), *raster, interpolation=INVARIANT)
    starts = mesh.diagonals.some(points.polygon_numbers).starts % 2
    depths = (points.world_points - np.array(view.eye)) @ view.axes[2]
    for number, polygon in enumerate(points.polygon_numbers.tolist()):
        corners = mesh.coordinates[mesh.node_numbers[polygon]].tolist()
        direction = ray(view, *raster, *divmod(int(points.pixels[number]), raster[1]))
        hit = on_triangles(corners, int(starts[number]), view.eye, direction)
        if hit is None or hit.clear < 1e-3 or hit.depth < 1e-2:
            continue
        assert depths[number] == pytest.approx(hit.depth, rel=1e-4, abs=1e-5)
        normals = mesh.normals.vectors[mesh.normals.numbers[polygon]].astype(np.float64)
        normal = np.array(hit.weights) @ normals * (1 if hit.meets_front else -1)
        if np.linalg.norm(normal) > 0.1:
            assert points.world_normals[number] == pytest.approx(normal / np.linalg.norm(normal), abs=1e-4)


FLOOR = Mesh(uneven_wall(5).coordinates[:, [0, 2, 1]] * (1, 1, -0.3), uneven_wall(5).node_numbers)


@given(soups() | st.sampled_from([cube(), sphere(8, 6)]), outside_views() | views(), rasters)
def test_the_polygon_at_a_pixel_is_the_first_that_a_ray_meets(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    found = on_raster(visible_surfaces(mesh, view, (1,), *raster))
    for line, element in np.ndindex(raster):
        hit = first_hit(mesh, view.eye, ray(view, *raster, line, element))
        if hit.clear > 1e-3 and hit.depth > 1e-3:
            polygon, *point = found[line, element, :4].tolist()
            assert polygon == hit.polygon, f"pixel {line, element}"
            if polygon >= 0:
                assert dot(minus(point, view.eye), view.axes[2].tolist()) == pytest.approx(
                    hit.depth, rel=1e-4
                )


def test_each_of_many_polygons_is_where_it_must_be() -> None:
    # More polygons and more nodes than a chunk of any step has, and than 16 bits can number.
    fine = grid(200, 180, (-1, 0, -1), (2, 0, 0), (0, 0, 2))
    view = View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=30.0)
    found = on_raster(visible_surfaces(fine, view, (1,), 300, 400))[..., 0]
    pixel = 4 * math.tan(math.radians(15)) / 150
    columns = (1 + (np.arange(400) + 0.5 - 200) * pixel) * 100
    rows = (1 - (np.arange(300)[:, None] + 0.5 - 150) * pixel) * 90
    inside = (columns > 0) & (columns < 200) & (rows > 0) & (rows < 180)
    clear = (np.abs(columns - columns.round()) > 1e-6) & (np.abs(rows - rows.round()) > 1e-6)
    expected = np.where(inside, np.floor(rows) * 200 + np.floor(columns), -1)
    assert found[clear].tolist() == expected[clear].tolist()
    assert len(np.unique(found)) == 200 * 180 + 1


@given(meshes(), views() | outside_views(), rasters, st.lists(st.integers(0, 3), min_size=8, max_size=8))
def test_which_corner_of_a_polygon_is_written_first_changes_no_pixel(
    mesh: Mesh, view: View, raster: tuple[int, int], turns: list[int]
) -> None:
    turned = [np.roll(row, turn) for row, turn in zip(mesh.node_numbers.tolist(), turns, strict=False)]
    # Sharp edges: the mean of several normals may be rounded in another order.
    one, other = (
        on_raster(
            visible_surfaces(
                Mesh(mesh.coordinates, rows, mesh.part_numbers, mesh.part_names, crease_angle=0.0),
                view,
                (1, 2),
                *raster,
            )
        )
        for rows in (mesh.node_numbers, np.array(turned, np.intp))
    )
    assert one[..., 0].tolist() == other[..., 0].tolist()
    assert one[..., 1:4] == pytest.approx(other[..., 1:4], abs=1e-4)


@pytest.mark.parametrize("rounding", ROUNDINGS)
@given(first=st.integers(0, 1 << 32))
def test_no_decal_is_torn(rounding: str, first: int) -> None:
    for seed in range(first, first + 2):
        mesh, view = decal_on_ground(seed, rounding)
        ground, decal = (
            set(visible_surfaces(part(mesh, number), view, (1, 2), 60, 80).pixels.tolist())
            for number in (0, 1)
        )
        points = visible_surfaces(mesh, view, (1, 2), 60, 80)
        on_decal = points.parts.numbers == 2
        assert set(points.pixels[on_decal].tolist()) == decal, f"seed {seed}"
        assert set(points.pixels[~on_decal].tolist()) == ground - decal


@given(numbers(-1, 1), numbers(0.1, 1), numbers(-1, 1), numbers(-0.5, 0.5), st.integers(0, 3))
def test_of_coincident_warped_polygons_with_opposite_winding_the_front_is_visible(
    left: float, width: float, slope: float, twist: float, first: int
) -> None:
    corners = [
        (left, slope, -0.7),
        (left + width, -slope, -0.6),
        (left + width, -slope + twist, 0.5),
        (left, slope, 0.8),
    ]
    backward = np.roll([3, 2, 1, 0], first)
    view = View((0.3, -4.0, 0.2), target=(0.1, 0.0, 0.0), field_of_view=40)
    for quads in ([[0, 1, 2, 3], backward], [backward, [0, 1, 2, 3]]):
        mesh = Mesh(np.array(corners), np.array(quads), np.array([0, 1]), ("one", "other"))
        projected = projection(mesh, view, 40, 53)
        facing = set(projected.polygon_numbers[~projected.from_behind].tolist())
        assert set(visible_surfaces(mesh, view, (1, 2), 40, 53).polygon_numbers.tolist()) <= facing


@given(meshes(), outside_views(), rasters)
def test_spans_are_the_runs_of_pixels_of_a_line_at_which_one_polygon_is_visible(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    # Triangles only: a quad may be split into two.
    mesh = Mesh(mesh.coordinates, mesh.node_numbers[:, :3], mesh.part_numbers, mesh.part_names)
    points = visible_surfaces(mesh, view, (2, 1), *raster)
    expected, pixel = [], 0
    for line in on_raster(points)[..., 0].tolist():
        for polygon, run in itertools.groupby(line):
            count = len(list(run))
            if polygon >= 0:
                expected.append((pixel, count, int(polygon)))
            pixel += count
    lengths = points.span_lengths
    pixels = points.pixels[np.cumsum(lengths) - lengths]
    found = list(zip(pixels.tolist(), lengths.tolist(), points.span_polygons.tolist(), strict=True))
    assert sorted(found) == expected
    # The spans are sorted by surface, and within a surface those of a polygon follow each other.
    surfaces = [(2, 1)[mesh.part_numbers[polygon]] for _, _, polygon in found]
    assert surfaces == sorted(surfaces)
    assert {each.surface_number for each in points.slices} == set(surfaces)
    polygons = [polygon for polygon, _ in itertools.groupby(polygon for _, _, polygon in found)]
    assert len(polygons) == len(set(polygons))


@given(meshes(), views() | outside_views(), rasters)
def test_points_lie_on_their_rays_and_the_view_is_reflected_at_their_normals(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    points = visible_surfaces(mesh, view, (1, 2), *raster)
    rows = points.rows.astype(np.float64)
    assert np.isfinite(rows).all()
    assert len(np.unique(points.pixels)) == len(points.pixels)
    lengths = np.linalg.norm(rows[NORMAL], axis=0)
    assert ((np.abs(lengths - 1) < 1e-5) | (lengths < 1e-5)).all()
    reflected = rows[REFLECTED_VIEW].T @ view.axes
    for number, pixel in enumerate(points.pixels.tolist()):
        toward = ray(view, *raster, *divmod(pixel, raster[1]))
        point, normal = points.world_points[number], points.world_normals[number].tolist()
        depth = float((point - np.array(view.eye)) @ view.axes[2])
        assert point == pytest.approx(np.array(view.eye) + depth * np.array(toward), abs=4e-6 * max(depth, 4))
        to_eye = unit(times(-1, toward))
        expected = minus(times(2 * dot(normal, to_eye), normal), to_eye)
        assert reflected[number].tolist() == pytest.approx(expected, abs=1e-5)
    size = 1 + np.abs(rows[POINT]).max(initial=0.0)
    assert (rows[POINT] ** 2).sum(axis=0) == pytest.approx(rows[POINT_SQUARED], rel=1e-5, abs=1e-12)
    for vector in (NORMAL, REFLECTED_VIEW):
        assert (rows[vector] * rows[POINT]).sum(axis=0) == pytest.approx(rows[vector.stop], abs=1e-5 * size)


OUTSIDE = View((3.0, -4.0, 2.0), target=(0.0, 0.0, 0.0))
WITHIN = View((0.3, -0.4, 0.2), direction=(1.0, 2.0, 0.5), field_of_view=90)


@pytest.mark.parametrize(
    ("view", "one_sided", "sign"), [(OUTSIDE, (), 1), (OUTSIDE, (1,), 1), (WITHIN, (), -1), (WITHIN, (1,), 1)]
)
def test_the_normals_of_a_sphere_point_to_the_eye_unless_it_is_one_sided(
    view: View, one_sided: tuple[int, ...], sign: int
) -> None:
    points = visible_surfaces(sphere(48, 32), view, (1,), 30, 30, frozenset(one_sided))
    along = points.world_points / np.linalg.norm(points.world_points, axis=1)[:, None]
    assert len(along)
    assert np.abs(points.world_normals - sign * along).max() < 0.01


def test_normals_are_interpolated_perspective_correctly() -> None:
    # A floor in one polygon with two normals: close to the eye, the middle of the floor is not the middle
    # of its picture, and the normal there is the mean of the two.
    flat = grid(1, 3, (-1, -8, 0), (2, 0, 0), (0, 24, 0))
    bent = flat.coordinates - np.outer([4, 4, 0, 0, 0, 0, 4, 4], (0, 0, 1))
    ridge = Mesh(bent, flat.node_numbers, crease_angle=180.0)
    points = visible_surfaces(
        ridge, View((0.0, -4.0, 4.0), target=(0.0, 4.0, 0.0), field_of_view=60.0), (1,), 80, 80
    )
    on_floor = points.polygon_numbers == 1
    way = points.world_points[on_floor, 1] / 8
    near, far = ridge.normals.vectors[ridge.normals.numbers[1][[0, 2]]]
    expected = np.outer(1 - way, near) + np.outer(way, far)
    expected /= np.linalg.norm(expected, axis=1)[:, None]
    assert np.ptp(way) > 0.9
    assert np.abs(points.world_normals[on_floor] - expected).max() < 1e-5


@pytest.mark.parametrize("degrees", first(1, [90, 180, 270]))
@pytest.mark.parametrize(
    ("mesh", "view"),
    [
        (uneven_wall(3), View((0.4, -8.0, 0.7), target=(0.0, 0.0, 0.0), field_of_view=50)),
        # These quads are flat.
        (sphere(12, 8), View((2.0, -3.0, 1.0), target=(0.0, 0.0, 0.0))),
        # The floor reaches behind the eye.
        (FLOOR, View((0.1, 0.05, 0.4), direction=(0.05, 1.0, -0.2), field_of_view=80)),
    ],
    ids=["warped", "flat", "clipped"],
)
def test_the_picture_does_not_change_as_the_camera_rolls(mesh: Mesh, view: View, degrees: int) -> None:
    differences = {}
    for interpolation in (SCAN_LINE, INVARIANT):
        before, after = (
            on_raster(visible_surfaces(mesh, each, (1,), 90, 90, interpolation=interpolation))
            for each in (view, view.replace(angle=view.angle + degrees))
        )
        # If the camera turns, the picture turns the other way.
        after = np.rot90(after, degrees // 90)
        same = before[..., 0] == after[..., 0]
        assert same.mean() > 0.9995
        differences[interpolation] = float(np.abs(before - after)[same][:, 4:].max())
    assert differences[INVARIANT] < 1e-5
    assert degrees == 180 or differences[SCAN_LINE] > 1e-3
