from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light, Scene, View
from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.screens.light_and_view.marks import (
    DIRECTION_LENGTH,
    HEAD,
    LIDS,
    PUPIL,
    RIM_SIDES,
    Cross,
    Numeral,
    SideItems,
    arrow,
    arrow_end,
    chosen_items,
    cone_outline,
    crosses_of,
    drawn_items,
    eye_marks,
    flap_marks,
    light_marks,
    lines_across,
    numeral_item,
    numerals,
    picture_corners,
)
from autocolor.screens.light_and_view.object_lines import ObjectLines
from autocolor.screens.light_and_view.orthographic_views import (
    EDGE,
    FRONT,
    SIDE,
    SIDES,
    TOP,
    OrthographicViews,
    ViewSide,
    fitted_views,
    shown_points,
)
from autocolor.screens.picture.picture_edits import target_of
from autocolor.testing import directions, lights, numbers, vectors, views
from autocolor.visibility.projection import focal_length
from autocolor.widgets.items import (
    BLUE,
    GRAY,
    LIGHT_GRAY,
    NIGHT,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    area_of,
    text,
)
from ramtek_emu import Ramtek9300, instructions
from tests.autocolor.screens.light_and_view.pointing import FILL, KEY, boxed

VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)
POINT = Light("key", (1.0, 2.0, 3.0))


def drawn(items: Sequence[Item]) -> Ramtek9300:
    """A cleared display on which some items are drawn."""
    display = Ramtek9300()
    display.send(instructions.reset())
    display.send(instructions.erase(Area(0, 0, 639, 479), 0))
    for item in items:
        display.send(np.frombuffer(item.stream, np.uint16))
    return display


def words_of(items: Sequence[Item]) -> set[int]:
    return set(drawn(items).words.ravel().tolist()) - {0}


class Drawn:
    """What the items of one view were made of, and are."""

    def __init__(self, scene: Scene) -> None:
        self.sides = {side: SideItems(side) for side in SIDES}
        self.lines = ObjectLines()
        self.views = fitted_views(shown_points(scene))

    def items(self, scene: Scene, chosen: str = "key", moved: Vector | None = None) -> list[Item]:
        strokes = self.lines.of_side(scene, self.views, TOP)
        return self.sides[TOP].items(self.views, scene, target_of(scene), strokes, chosen, moved)


def test_a_chosen_point_source_is_a_yellow_cross_alone() -> None:
    for side in SIDES:
        items = chosen_items(VIEWS, side, POINT)
        element, line = (np.floor(np.array(VIEWS.position(side, POINT.position)) + 0.5)).astype(int).tolist()
        lines, elements = np.nonzero(drawn(items).words)
        assert words_of(items) == {YELLOW}
        assert len(lines) == 17
        assert {*elements[lines == line]} == {*range(element - 4, element + 5)}
        assert {*lines[elements == element]} == {*range(line - 4, line + 5)}


def test_the_flaps_of_the_chosen_light_are_yellow_and_gray_where_they_are_off() -> None:
    flaps = Flaps(x=Flap(-1.05, 2.0), y=Flap(minimum=0.55, on=False))
    words = drawn(chosen_items(VIEWS, TOP, POINT.replace(flaps=flaps))).words
    left, top = (round(each) for each in VIEWS.position(TOP, (-1.05, 0.55, 0.0)))
    assert (words[TOP.area.top : TOP.area.bottom + 1, left] == YELLOW).all()
    across = words[top, TOP.area.left : TOP.area.right + 1]
    assert set(across.tolist()) == {GRAY, YELLOW}
    assert (across == YELLOW).sum() == 2


def test_a_view_shows_the_object_the_eye_and_all_lights() -> None:
    scene = boxed(KEY, FILL, KEY.replace(name="side", position=(0.0, 3.0, 1.0)))
    assert words_of(Drawn(scene).items(scene)) == {SLATE, GRAY, LIGHT_GRAY, BLUE, WHITE, YELLOW, NIGHT}
    off = scene.with_light("fill", on=False).with_light("side", on=False)
    assert words_of(Drawn(off).items(off)) == {SLATE, GRAY, BLUE, YELLOW, NIGHT}
    none = scene.replace(lights=[])
    assert words_of(Drawn(none).items(none, chosen="")) == {SLATE, GRAY, YELLOW, NIGHT}


def test_nothing_is_made_anew_where_nothing_changed() -> None:
    scene = boxed(KEY, FILL)
    view = Drawn(scene)
    before = view.items(scene)
    again = view.items(scene)
    assert all(one is other for one, other in zip(before, again, strict=True))


def test_a_light_that_moves_leaves_all_lines_but_its_own_as_they_are() -> None:
    scene = boxed(KEY, FILL)
    view = Drawn(scene)
    before = view.items(scene)
    after = view.items(scene.with_light("key", position=(1.8, -2.5, 4.0)))
    changed = set(after) - set(before)
    assert len(changed) == 2
    assert {word for item in changed for word in words_of([item])} == {YELLOW, NIGHT}


def test_a_point_that_is_placed_has_lines_below_everything() -> None:
    scene = boxed(KEY, FILL)
    view = Drawn(scene)
    items = view.items(scene, moved=(0.5, 0.5, 0.5))
    assert words_of([items[1]]) == {SLATE}
    assert items[1] == lines_across(view.views, TOP, (0.5, 0.5, 0.5))


def test_the_lines_of_a_point_stand_on_the_same_column_or_line_in_two_views() -> None:
    point = (1.0, 2.0, 3.0)
    display = drawn([lines_across(VIEWS, side, point) for side in SIDES])
    element, line = (round(each) for each in VIEWS.position(FRONT, point))
    assert (display.words[0:224, element] == SLATE).all()
    assert (display.words[232:456, element] == SLATE).all()
    assert (display.words[line, 0:248] == SLATE).all()
    assert (display.words[line, 256:504] == SLATE).all()


def test_lines_of_a_point_outside_of_a_view_are_left_out() -> None:
    item = lines_across(VIEWS, TOP, (1e6, 2.0, 3.0))
    words = drawn([item]).words
    assert (words == SLATE).sum() == TOP.area.width


def test_the_number_of_the_chosen_light_makes_way_for_the_others_and_they_stay() -> None:
    scene = boxed(Light("key", (-2.0, 0.0, 1.0)), Light("fill", (1.0, 0.0, 2.0)))
    view = Drawn(scene)
    fill = view.items(scene)[-2]
    for place in ((1.0, 0.0, 1.0), (1.1, 0.05, 1.0)):
        *_, other, own = view.items(scene.with_light("key", position=place))
        assert other == fill
        assert not own.area.overlaps(other.area)
        assert words_of([own]) == {YELLOW, NIGHT}
        assert words_of([other]) == {WHITE, NIGHT}


def test_a_numeral_is_written_where_it_stands() -> None:
    item = numeral_item(Numeral(Cross(16, 50, 50), Area(60, 30, 73, 38)), GRAY)
    assert item == text("16", 60, 30, GRAY)
    assert item.area == (60, 30, 73, 38)


def test_an_arrow_toward_the_viewer_is_in_no_place_s_way() -> None:
    light = Light("key", (0.0, 0.0, 5.0), aim=(0.0, 0.0, 0.0))
    assert crosses_of(VIEWS, TOP, 1, light)[0].arrow == (0.0, 0.0)
    assert crosses_of(VIEWS, FRONT, 1, light)[0].arrow == pytest.approx((0.0, 1.0))


def test_strokes_are_drawn_within_their_area_and_layers_without_strokes_are_left_out() -> None:
    strokes = np.array([(10.0, 30.0, 20.0, 12.0), (15.0, 15.0, 5.0, 15.0)])
    (item,) = drawn_items({WHITE: [strokes], GRAY: [np.empty((0, 4))]})
    lines, elements = np.nonzero(drawn([item]).words == WHITE)
    assert item.area == area_of(strokes.reshape(-1, 2))
    assert item.area == (elements.min(), lines.min(), elements.max(), lines.max())


places = st.tuples(st.floats(-300, 300), st.floats(-300, 300))


def test_an_arrow_that_points_at_the_viewer_has_no_head() -> None:
    assert arrow((5, 5), (5, 5)).tolist() == [[5, 5, 5, 5]]
    assert len(arrow((5, 5), (6, 6))) == 1


def test_the_head_of_a_short_arrow_is_half_of_it() -> None:
    assert arrow((0, 0), (0, 8))[1, 1] == pytest.approx(4)


@given(places, places)
def test_a_head_is_symmetrical_and_ends_where_the_shaft_does(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    strokes = arrow(start, end)
    assert strokes[0].tolist() == [*start, *end]
    if len(strokes) == 1:
        return
    assert strokes[1, 2:].tolist() == strokes[2, :2].tolist() == list(end)
    one, other = strokes[1, :2], strokes[2, 2:]
    assert math.dist(one, end) == pytest.approx(math.dist(other, end))
    assert math.dist(one, start) == pytest.approx(math.dist(other, start))
    shaft = math.dist(start, end)
    assert math.dist((one + other) / 2, end) == pytest.approx(min(HEAD, shaft / 2))
    assert np.dot(one - end, np.array(start) - end) > 0


def rim_of(light: Light, end: Vector) -> Floats:
    """Many points of the rim: on the cone, as far from the light as the end."""
    assert light.axis is not None
    assert light.cone_angle is not None
    axis = np.array(light.axis)
    one = np.cross(axis, (0.3, -0.5, 0.8))
    one /= np.linalg.norm(one)
    turns = np.linspace(0, 2 * math.pi, 721)[:, None]
    around = np.cos(turns) * one + np.sin(turns) * np.cross(axis, one)
    angle, slant = math.radians(light.cone_angle), math.dist(end, light.position)
    rim: Floats = np.array(light.position) + slant * (math.cos(angle) * axis + math.sin(angle) * around)
    return rim


def test_a_cone_seen_from_the_side_is_two_lines_at_its_angle() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=30.0)
    one, other = cone_outline(VIEWS, FRONT, light, (2.0, 0.0, 0.0))
    element, line = FRONT.area.middle
    side = 20 * np.array([math.cos(math.pi / 6), 0.5])
    assert one == pytest.approx(np.array([(element, line), (element + side[0], line - side[1])]))
    assert other == pytest.approx(np.array([(element, line), (element + side[0], line + side[1])]))


def test_a_cone_that_points_at_the_viewer_is_a_circle() -> None:
    for up in (2.0, -2.0):
        light = Light("key", (0.0, 0.0, 0.0), aim=(0.0, 0.0, up), cone_angle=30.0)
        (rim,) = cone_outline(VIEWS, TOP, light, (0.0, 0.0, up))
        assert len(rim) == RIM_SIDES + 1
        assert np.hypot(*(rim - TOP.area.middle).T) == pytest.approx(np.full(RIM_SIDES + 1, 10.0))


def test_a_cone_of_ninety_degrees_seen_from_the_side_is_a_line_across_its_axis() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=90.0)
    outline = np.concatenate(cone_outline(VIEWS, FRONT, light, (2.0, 0.0, 0.0)))
    assert np.ptp(outline[:, 0]) == pytest.approx(0, abs=1e-9)
    assert np.ptp(outline[:, 1]) == pytest.approx(40, rel=0.01)


def test_a_cone_that_holds_everything_has_no_outline() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=180.0)
    assert all(cone_outline(VIEWS, side, light, (2.0, 0.0, 0.0)) == () for side in SIDES)


@given(vectors(), directions(), numbers(1, 179), st.sampled_from(SIDES))
def test_the_lines_are_tangents_of_the_rim(
    position: Vector, direction: Vector, cone_angle: float, side: ViewSide
) -> None:
    light = Light("key", position, direction=direction, cone_angle=cone_angle)
    assert light.axis is not None
    end = tuple((np.array(position) + 2 * np.array(light.axis)).tolist())
    along = abs(float(np.dot(light.axis, side.toward)))
    # The cone opens behind the light above 90 degrees.
    half = math.radians(min(cone_angle, 180 - cone_angle))
    assume(abs(math.acos(min(along, 1.0)) - half) > 1e-3)
    assume(abs(cone_angle - 90) > 0.1)
    outline = cone_outline(VIEWS, side, light, end)
    rim = VIEWS.positions(side, rim_of(light, end))
    at = np.array(VIEWS.position(side, position))
    if math.acos(min(along, 1.0)) < half:
        assert len(outline) == 1
        return
    assert len(outline) == 2
    for start, touching in outline:
        assert start == pytest.approx(at)
        # It touches the rim, and the rim lies on one side of it.
        assert np.hypot(*(rim - touching).T).min() < 0.2
        step = (touching - start) / np.linalg.norm(touching - start)
        beside = step[0] * (rim - start)[:, 1] - step[1] * (rim - start)[:, 0]
        assert min(beside.max(), (-beside).max()) < 1e-6
    # The half angle between the lines: sin B = sin A / sin F.
    one, other = (line[1] - line[0] for line in outline)
    between = math.acos(float(np.clip(one @ other / np.linalg.norm(one) / np.linalg.norm(other), -1, 1)))
    expected = math.asin(min(1.0, math.sin(half) / math.sqrt(1 - along * along)))
    assert between / 2 == pytest.approx(expected, abs=1e-4)


def test_the_corners_are_those_of_the_picture_as_deep_as_the_target() -> None:
    view = View((0.0, -2.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=90.0)
    corners = picture_corners(view, (5.0, 0.0, 3.0), aspect=1.5)
    assert corners == pytest.approx(np.array([(-3, 0, 2), (3, 0, 2), (3, 0, -2), (-3, 0, -2)]))


@given(views())
def test_the_renderer_has_the_corners_at_the_corners_of_its_raster(view: View) -> None:
    lines, elements = 480, 640
    target = np.array(view.eye) + view.axes[2]
    corners = picture_corners(view, tuple(target.tolist()))
    x, y, depth = view.axes @ (corners - np.array(view.eye)).T
    focal = focal_length(lines, elements, view.field_of_view)
    assert x / depth * focal == pytest.approx(np.array([-1, 1, 1, -1]) * elements / 2)
    assert y / depth * focal == pytest.approx(np.array([-1, -1, 1, 1]) * lines / 2)


def test_the_eye_is_drawn_at_its_position_in_each_view() -> None:
    view = View((1.0, -2.0, 3.0), target=(0.0, 0.0, 0.0))
    for side in SIDES:
        marks = eye_marks(VIEWS, side, view, (0.0, 0.0, 0.0))
        at = VIEWS.position(side, view.eye)
        assert len(marks.eye) == len(LIDS) + len(PUPIL) - 2
        assert (marks.eye[:, :2].min(axis=0) + marks.eye[:, :2].max(axis=0)) / 2 == pytest.approx(at)
        assert marks.direction[0].tolist() == [*at, *VIEWS.position(side, (0.0, 0.0, 0.0))]


def test_the_edges_of_the_picture_are_a_pyramid_of_eight() -> None:
    view = View((1.0, -2.0, 3.0), target=(0.0, 0.0, 0.0))
    corners = picture_corners(view, (0.0, 0.0, 0.0))
    for side in SIDES:
        strokes = eye_marks(VIEWS, side, view, (0.0, 0.0, 0.0)).picture
        positions = VIEWS.positions(side, corners)
        assert len(strokes) == 8
        assert strokes[:4, 2:] == pytest.approx(positions)
        assert strokes[4:, :2] == pytest.approx(positions)
        assert strokes[4:, 2:] == pytest.approx(np.roll(positions, -1, axis=0))


def test_an_eye_that_looks_at_the_viewer_has_an_arrow_without_a_head() -> None:
    view = View((0.0, -2.0, 0.0), target=(0.0, 0.0, 0.0))
    assert len(eye_marks(VIEWS, FRONT, view, (0.0, 0.0, 0.0)).direction) == 1
    assert len(eye_marks(VIEWS, SIDE, view, (0.0, 0.0, 0.0)).direction) == 3


def test_marks_end_at_the_border_of_the_area() -> None:
    view = View((0.0, -200.0, 0.0), target=(0.0, 0.0, 0.0))
    marks = eye_marks(VIEWS, TOP, view, (0.0, 0.0, 0.0))
    # The eye has a mark with a frame at the edge.
    assert len(marks.eye) == len(LIDS) - 1 + len(PUPIL) - 1 + 4
    edge = TOP.area.bottom - EDGE
    assert marks.eye[:, 1::2].mean() == pytest.approx(edge, abs=0.5)
    light = Light("key", (0.0, -200.0, 0.0), aim=(0.0, 0.0, 0.0))
    assert len(light_marks(VIEWS, TOP, light).cross) == 2 + 4
    assert len(light_marks(VIEWS, FRONT, light).cross) == 2
    assert marks.direction[0].tolist() == [TOP.area.middle[0], TOP.area.bottom, *TOP.area.middle]


def test_a_point_source_is_a_cross_alone() -> None:
    for side in SIDES:
        marks = light_marks(VIEWS, side, Light("key", (1.0, 2.0, 3.0)))
        element, line = VIEWS.position(side, (1.0, 2.0, 3.0))
        assert marks.cross.tolist() == [
            [element - 4, line, element + 4, line],
            [element, line - 4, element, line + 4],
        ]
        assert marks.arrow.shape == marks.cone.shape == (0, 4)


def test_a_light_with_an_aim_has_an_arrow_to_it() -> None:
    light = Light("key", (1.0, 2.0, 3.0), aim=(0.0, -1.0, 0.5))
    assert arrow_end(VIEWS, light) == (0.0, -1.0, 0.5)
    for side in SIDES:
        shaft = light_marks(VIEWS, side, light).arrow[0]
        assert shaft.tolist() == [
            *VIEWS.position(side, (1.0, 2.0, 3.0)),
            *VIEWS.position(side, (0.0, -1.0, 0.5)),
        ]


def test_a_direction_is_an_arrow_of_the_same_length_at_any_scale() -> None:
    light = Light("key", (1.0, 2.0, 3.0), direction=(3.0, 0.0, -4.0))
    for scale in (0.01, 1.0, 50.0):
        views = OrthographicViews(light.position, scale)
        start_x, start_y, end_x, end_y = light_marks(views, FRONT, light).arrow[0]
        assert math.hypot(end_x - start_x, end_y - start_y) == pytest.approx(DIRECTION_LENGTH)
        assert end_x - start_x == pytest.approx(0.6 * DIRECTION_LENGTH)


def test_flaps_are_lines_across_the_views_that_show_their_coordinate() -> None:
    flaps = Flaps(x=Flap(-1.0, 2.0), z=Flap(minimum=0.5, on=False))
    light = Light("key", (0.0, 0.0, 5.0), flaps=flaps)
    (left, right) = flap_marks(VIEWS, TOP, light)
    element = TOP.area.middle[0]
    assert left.stroke.tolist() == [[element - 10, TOP.area.top, element - 10, TOP.area.bottom]]
    assert right.stroke.tolist() == [[element + 20, TOP.area.top, element + 20, TOP.area.bottom]]
    assert [(mark.axis, mark.end, mark.on) for mark in (left, right)] == [
        (0, "minimum", True),
        (0, "maximum", True),
    ]
    (low,) = flap_marks(VIEWS, SIDE, light)
    line = SIDE.area.middle[1] - 5
    assert low.stroke.tolist() == [[SIDE.area.left, line, SIDE.area.right, line]]
    assert low[:3] == (2, "minimum", False)
    assert len(flap_marks(VIEWS, FRONT, light)) == 3


def test_a_flap_outside_of_the_view_has_no_line() -> None:
    light = Light("key", (0.0, 0.0, 5.0), flaps=Flaps(y=Flap(-1e9, 1e9)))
    assert flap_marks(VIEWS, TOP, light) == ()


@given(lights())
def test_all_marks_are_within_their_area(light: Light) -> None:
    for side in SIDES:
        marks = [*light_marks(VIEWS, side, light), *(m.stroke for m in flap_marks(VIEWS, side, light))]
        strokes = np.concatenate(marks)
        assert (strokes >= [side.area.left, side.area.top] * 2).all()
        assert (strokes <= [side.area.right, side.area.bottom] * 2).all()
        assert len(marks[2]) == 0 or light.cone_angle is not None


AREA = Area(0, 0, 247, 223)

crosses = st.builds(Cross, st.integers(1, 16), st.integers(-20, 260), st.integers(-20, 240))


def test_a_numeral_stands_to_the_right_and_above_its_cross() -> None:
    ((cross, area),) = numerals([Cross(3, 100, 100)], AREA, [])
    assert cross.number == 3
    assert area == (106, 86, 112, 94)


@pytest.mark.parametrize(
    ("right", "down", "area"),
    [
        (1, -1, (106, 86, 119, 94)),
        (-1, -1, (81, 86, 94, 94)),
        (1, 1, (106, 106, 119, 114)),
        (-1, 1, (81, 106, 94, 114)),
        (1, 0, (108, 96, 121, 104)),
        (-1, 0, (79, 96, 92, 104)),
        (0, -1, (93, 84, 106, 92)),
        (0, 1, (93, 108, 106, 116)),
    ],
)
def test_a_numeral_has_eight_places_around_its_cross(
    right: int, down: int, area: tuple[int, int, int, int]
) -> None:
    cross = Cross(16, 100, 100)
    assert cross.numeral(right, down) == area
    assert cross.area == (96, 96, 104, 104)
    # If all other places are taken, it stands there.
    others = [
        (x, y) for x, y in itertools.product((-1, 0, 1), repeat=2) if (x, y) not in ((right, down), (0, 0))
    ]
    taken = [cross.numeral(*place).within(Area(*MIDDLES[place])) for place in others]
    ((_, found),) = numerals([cross], AREA, taken)
    assert found == area


MIDDLES = {
    (x, y): (100 + 13 * x, 100 + 12 * y, 100 + 13 * x, 100 + 12 * y)
    for x, y in itertools.product((-1, 0, 1), repeat=2)
}
"""Pixels of the eight places around a cross at (100, 100) that no other place covers."""


def test_a_numeral_makes_way_for_the_arrow_of_its_light() -> None:
    ((_, area),) = numerals([Cross(12, 100, 100, (0.8, -0.6))], AREA, [])
    assert area.right < 96
    assert area.width == 14


def test_a_numeral_makes_way_for_what_is_there() -> None:
    ((_, area),) = numerals([Cross(1, 100, 100)], AREA, [Area(103, 80, 120, 99)])
    assert not area.overlaps(Area(103, 80, 120, 99))


def test_a_numeral_at_the_edge_is_within_the_area() -> None:
    corners = itertools.product((0, 247), (0, 223))
    for element, line in corners:
        ((_, area),) = numerals([Cross(10, element, line)], AREA, [])
        assert AREA.covers(area)


def test_a_light_outside_of_the_area_has_no_numeral() -> None:
    assert numerals([Cross(1, 248, 100)], AREA, []) == []


@given(st.lists(crosses, max_size=16))
def test_every_light_in_the_area_has_a_numeral_within_it(lights: list[Cross]) -> None:
    found = numerals(lights, AREA, [])
    assert [cross for cross, _ in found] == [each for each in lights if AREA.has(each.element, each.line)]
    assert all(AREA.covers(area) for _, area in found)


def test_the_numerals_of_lights_in_a_row_do_not_overlap() -> None:
    row = [Cross(number, 20 + 12 * number, 100) for number in range(1, 17)]
    areas = [area for _, area in numerals(row, AREA, [])]
    assert len(areas) == 16
    assert not any(one.overlaps(other) for one, other in itertools.combinations(areas, 2))
