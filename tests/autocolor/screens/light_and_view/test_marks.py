from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from autocolor import Flap, Flaps, Light, Scene
from autocolor.checks import Vector
from autocolor.screens.light_and_view.grips import target_in
from autocolor.screens.light_and_view.marks import (
    SideItems,
    area_around,
    chosen_items,
    cross_of,
    drawn_items,
    lines_across,
    numeral_item,
)
from autocolor.screens.light_and_view.numerals import Cross, Numeral
from autocolor.screens.light_and_view.object_lines import ObjectLines
from autocolor.screens.light_and_view.orthographic_views import (
    FRONT,
    SIDES,
    TOP,
    OrthographicViews,
    fitted_views,
)
from autocolor.screens.light_and_view.shown_points import shown_points
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import BLUE, GRAY, LIGHT_GRAY, NIGHT, SLATE, WHITE, YELLOW
from autocolor.widgets.items import Item, text
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
        return self.sides[TOP].items(self.views, scene, target_in(scene), strokes, chosen, moved)


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
    assert cross_of(VIEWS, TOP, 1, light).arrow == (0.0, 0.0)
    assert cross_of(VIEWS, FRONT, 1, light).arrow == pytest.approx((0.0, 1.0))


def test_strokes_are_drawn_within_their_area_and_layers_without_strokes_are_left_out() -> None:
    strokes = np.array([(10.0, 30.0, 20.0, 12.0), (15.0, 15.0, 5.0, 15.0)])
    (item,) = drawn_items({WHITE: [strokes], GRAY: [np.empty((0, 4))]})
    lines, elements = np.nonzero(drawn([item]).words == WHITE)
    assert item.area == area_around(strokes)
    assert item.area == (elements.min(), lines.min(), elements.max(), lines.max())
