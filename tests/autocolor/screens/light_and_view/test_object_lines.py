from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, Scene, View, scene_of
from autocolor.arrays import Booleans, Words
from autocolor.screens.light_and_view.object_lines import (
    NO_PART,
    STAGE,
    ObjectLines,
    crease_edges,
    depth_picture,
    line_words,
)
from autocolor.screens.light_and_view.orthographic_views import (
    FRONT,
    SIDES,
    TOP,
    OrthographicViews,
    ViewSide,
    fitted_views,
)
from autocolor.testing import meshes, views
from autocolor.visibility.visible_surfaces import visible_surfaces
from autocolor.widgets.items import GRAY, LIGHT_GRAY, NIGHT, SLATE, Area
from tests.small import CUBE_NODES, CUBE_QUADS, cube, grid, sphere

EYE = View((4.0, -5.0, 3.0), target=(0.5, 0.5, 0.5))


def words_in(scene: Scene, side: ViewSide, views: OrthographicViews | None = None) -> Words:
    """The words of the lines in one of the views, which is fitted to the object."""
    fitted, lines = views or fitted_views(scene.object_coordinates), ObjectLines()
    while lines.find_next(scene, fitted):
        pass
    return part_of(lines.page(scene, fitted), side.area)


def part_of(words: Words, area: Area) -> Words:
    return words[area.top : area.bottom + 1, area.left : area.right + 1]


def box(pixels: Booleans) -> tuple[int, int, int, int]:
    """The first and the last line and element of some pixels."""
    lines, elements = np.nonzero(pixels)
    return int(lines.min()), int(lines.max()), int(elements.min()), int(elements.max())


def test_a_ball_is_drawn_as_a_circle_without_a_gap() -> None:
    scene = scene_of(sphere(64, 32), view=EYE)
    words = words_in(scene, FRONT)
    assert set(np.unique(words).tolist()) == {NIGHT, LIGHT_GRAY}
    lines, elements = np.nonzero(words == LIGHT_GRAY)
    middle = FRONT.area.width / 2, FRONT.area.height / 2
    x, y = elements + 0.5 - middle[0], lines + 0.5 - middle[1]
    scale = fitted_views(scene.object_coordinates).scale
    assert np.hypot(x, y) == pytest.approx(scale, abs=1.6)
    degrees = np.sort(np.degrees(np.arctan2(y, x)))
    assert np.diff(degrees, append=degrees[0] + 360).max() < 1.5 * np.degrees(1 / scale) + 0.5
    # The circle is one pixel wide: it has no more pixels than its eight octants have steps.
    assert len(x) <= 8 * scale * np.sin(np.pi / 4) + 16


@pytest.mark.parametrize("side", SIDES)
def test_a_cube_is_drawn_as_its_outline_where_the_views_have_its_corners(side: ViewSide) -> None:
    scene = scene_of(cube(), view=EYE)
    fitted = fitted_views(scene.object_coordinates)
    words = words_in(scene, side)
    assert set(np.unique(words).tolist()) == {NIGHT, LIGHT_GRAY}
    left, bottom = fitted.position(side, (0, 0, 0))
    right, top = fitted.position(side, (1, 1, 1))
    wanted = (top - side.area.top, bottom - side.area.top, left - side.area.left, right - side.area.left)
    assert box(words == LIGHT_GRAY) == pytest.approx(wanted, abs=1)
    # An outline of one pixel has about as many pixels as its edges are long.
    assert (words == LIGHT_GRAY).sum() == pytest.approx(4 * fitted.scale, abs=8)


def test_a_thing_within_another_is_drawn_in_no_view() -> None:
    inner = sphere(16, 9)
    ball = Mesh(inner.coordinates * 0.2 + 0.5, inner.node_numbers, inner.part_numbers, ("ball",))
    both = scene_of(Mesh.joined([ball, cube()]), view=EYE)
    alone = scene_of(cube(), view=EYE)
    for side in SIDES:
        assert np.array_equal(words_in(both, side), words_in(alone, side))


def test_a_thing_before_another_has_an_outline_and_a_part_a_border() -> None:
    wall = grid(1, 1, (-2, 0, -2), (4, 0, 0), (0, 0, 4), "wall")
    for distance, word in ((-0.5, LIGHT_GRAY), (-1e-9, GRAY)):
        plate = grid(1, 1, (-1, distance, -1), (2, 0, 0), (0, 0, 2), "plate")
        scene = scene_of(Mesh.joined([wall, plate]), view=EYE)
        fitted = fitted_views(scene.object_coordinates)
        words = words_in(scene, FRONT)
        middle = words[FRONT.area.height // 2]
        assert (middle != NIGHT).sum() == 4
        element = round(fitted.position(FRONT, (-1, 0, 0))[0])
        assert word in middle[element - 2 : element + 3]


def test_a_stage_hides_nothing_and_is_drawn_as_its_outline_alone() -> None:
    lid = grid(2, 2, (-5, -5, 4), (10, 0, 0), (0, 10, 0), "lid")
    ring = grid(1, 1, (-2, -2, 3.9), (4, 0, 0), (0, 4, 0), "ring")
    scene = scene_of(Mesh.joined([cube(), lid, ring]), view=EYE)
    scene = scene.with_part("lid", stage=True).with_part("ring", stage=True)
    fitted = fitted_views(scene.object_coordinates)
    assert np.array_equal(words_in(scene, TOP), words_in(scene_of(cube(), view=EYE), TOP))
    far = words_in(scene, TOP, fitted.zoomed(0.1))
    assert set(np.unique(far).tolist()) == {NIGHT, LIGHT_GRAY, SLATE}
    assert (far == SLATE).sum() == pytest.approx(4 * 10 * fitted.scale / 10, abs=8)
    # If everything is stage, it is drawn as the object.
    whole = scene.with_part(scene.parts[0].name, stage=True)
    assert LIGHT_GRAY in words_in(whole, TOP)


def test_lines_come_one_view_at_a_time_and_move_with_the_views_until_they_are_found_again() -> None:
    scene = scene_of(cube(), view=EYE)
    fitted, lines = fitted_views(scene.object_coordinates), ObjectLines()
    for number in range(4):
        page = lines.page(scene, fitted)
        drawn = [(part_of(page, side.area) != NIGHT).any() for side in SIDES]
        assert drawn == [place < number for place in range(3)]
        assert lines.find_next(scene, fitted) == (number < 3)
    assert lines.page(scene, fitted) is page
    moved = fitted.panned(FRONT, -20, -10)
    before = part_of(page, FRONT.area)
    now = part_of(lines.page(scene, moved), FRONT.area)
    assert np.array_equal(now[:-10, :-20], before[10:, 20:])
    assert np.array_equal(now[:-10, :-20], words_in(scene, FRONT, moved)[:-10, :-20])
    nearer = fitted.zoomed(0.5)
    quick, final = part_of(lines.page(scene, nearer), TOP.area), words_in(scene, TOP, nearer)
    assert box(quick != NIGHT) == pytest.approx(box(final != NIGHT), abs=2)


@pytest.mark.parametrize(("fold", "creases"), [(0, 0), (29.9, 0), (30, 0), (30.1, 1), (90, 1)])
def test_a_crease_is_an_angle_above_the_crease_angle(fold: float, creases: int) -> None:
    flat = [(-1, 0, 0), (0, 0, 0), (0, 1, 0), (-1, 1, 0)]
    for turn, bent in itertools.product(np.radians([fold, -fold]), [(1, 4, 5, 2), (2, 5, 4, 1)]):
        # Two squares that meet along the y axis, of either winding.
        x, z = np.cos(turn), np.sin(turn)
        mesh = Mesh(np.array([*flat, (x, 0, z), (x, 1, z)]), np.array([(0, 1, 2, 3), bent]))
        assert crease_edges(mesh, np.arange(1)).shape == (2, creases)


def test_the_diagonals_of_divided_sides_are_no_creases_and_a_stage_has_none() -> None:
    triangles = [three for a, b, c, d in CUBE_QUADS for three in ((a, b, c), (a, c, d))]
    mesh = Mesh(np.array(CUBE_NODES), np.array(triangles))
    assert crease_edges(mesh, np.arange(1)).shape == (2, 12)
    assert crease_edges(mesh, np.array([STAGE])).shape == (2, 0)


@given(meshes(), views(), st.integers(4, 40), st.integers(4, 40))
def test_the_depths_are_those_of_the_renderer(mesh: Mesh, view: View, lines: int, elements: int) -> None:
    numbers = np.arange(len(mesh.part_names))
    ours = depth_picture(mesh, view, lines, elements, numbers)
    points = visible_surfaces(mesh, view, (1,) * len(mesh.part_names), lines, elements)
    assert np.array_equal(ours.parts.ravel()[points.pixels], points.parts.numbers - 1)
    assert ours.depths.ravel()[points.pixels] == pytest.approx(points.depths, rel=1e-3)
    assert (ours.parts != NO_PART).sum() == (ours.depths < np.inf).sum() == len(points.pixels)
    words = line_words(ours, mesh, crease_edges(mesh, numbers))
    assert (words[ours.parts == NO_PART] == NIGHT).all()
