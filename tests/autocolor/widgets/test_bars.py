from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Words, half_up
from autocolor.errors import UsageError
from autocolor.scene.columns import BarRange
from autocolor.widgets.bars import (
    LANE,
    Bar,
    ComponentBar,
    LevelBar,
    PercentBar,
    RampBar,
    bar_within,
    levels_along,
    number_text,
    rounded_to,
)
from autocolor.widgets.items import WHITE, Area
from autocolor.widgets.menu import WIDE_BAR
from autocolor.widgets.widget import Place, Widget
from ramtek_emu import Ramtek9300
from tests.autocolor.widgets.drawing import draw_items

STEPS = (0.001, 0.01, 0.05, 0.1, 0.125, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0)
ROW = Area(505, 32, 639, 47)
ANYWHERE = Place(0, 0)


@given(st.sampled_from(STEPS), st.integers(-500, 500))
def test_a_whole_number_of_steps_is_written_and_read_again(step: float, count: int) -> None:
    value = rounded_to(count * step, step)
    assert value == pytest.approx(count * step)
    assert rounded_to(value, step) == value
    assert float(number_text(value, step)) == pytest.approx(value)


@pytest.mark.parametrize(
    ("value", "step", "shown"),
    [
        (0.25, 0.25, "0.25"),
        (2.5, 2.5, "2.5"),
        (0.3, 0.05, "0.30"),
        (-0.0, 0.1, "0.0"),
        (12.345, 1, "12.3"),
        (1 / 3, 1 / 3, "0.3333333333"),
    ],
)
def test_a_number_is_shown_with_the_digits_of_its_step(value: float, step: float, shown: str) -> None:
    assert number_text(value, step) == shown


@pytest.mark.parametrize("area", [ROW, WIDE_BAR])
@given(st.sampled_from(STEPS), st.integers(-50, 50), st.integers(1, 200), st.data())
def test_a_value_is_found_again_where_its_bar_ends(
    area: Area, step: float, first: int, count: int, data: st.DataObject
) -> None:
    low, high = first * step, (first + count) * step
    value = data.draw(st.floats(low, high))
    bar = Bar("bar", area=area, value=value, low=low, high=high, step=step)
    track = bar._track
    found = bar.value_at(track.left + round(bar.share * (track.width - 1)))
    assert low <= found <= high
    assert abs(found - value) <= step / 2 + (high - low) / (2 * (track.width - 1)) + 1e-9


def test_the_ends_of_a_bar_are_those_of_its_range_even_between_steps() -> None:
    bar = Bar("bar", area=ROW, low=0.05, high=0.97, step=0.1)
    assert bar.value_at(0) == 0.05
    assert bar.value_at(639) == 0.97
    assert 0.05 <= bar.value_at(ROW.right - 9) <= 0.97
    assert Bar("bar", area=ROW, value=1.0, low=1.0, high=1.0).share == 0.0


def test_a_bar_is_set_by_pick_drag_step_and_text() -> None:
    found: list[float] = []
    bar = Bar("bar", area=ROW, value=0.525909, low=0.0, high=1.0, step=0.1, put=found.append)
    assert (bar.number, bar.typed.value) == ("0.53", "0.525909")
    # A bar that cannot be used is not drawn along its track.
    assert len(replace(bar, why_not="not now").items(lit=False)) == len(bar.items(lit=False)) - 1
    bar.pick(Place(ROW.left, 40))
    bar.drag(ANYWHERE, ANYWHERE, Place(ROW.right, 40))
    bar.nudge(-1)
    bar.typed.take("0,75")
    with pytest.raises(UsageError) as refusal:
        bar.typed.take("much")
    assert str(refusal.value) == "bar must be a number, not 'much'; type one, such as 1.5"
    assert found == [0.0, 1.0, 0.4, 0.75]


def test_a_number_that_can_be_absent_has_a_box() -> None:
    found: list[object] = []
    present = Bar("bar", area=ROW, value=0.5, put=found.append, flip=lambda: found.append("off"))
    absent = Bar("bar", area=ROW, value=None, put=found.append, flip=lambda: found.append("on"))
    present.pick(Place(ROW.right - 10, 40))
    absent.pick(Place(ROW.left + 20, 40))
    present.pick(Place(ROW.left, 40))
    absent.nudge(1)
    assert found == ["off", "on", 0.0]
    assert (absent.number, absent.share) == ("", 0.0)


@pytest.mark.parametrize("area", [ROW, WIDE_BAR])
@pytest.mark.parametrize("value", [-1e7, 0.0, 0.5, 1e7, None])
@pytest.mark.parametrize("lit", [True, False])
def test_a_bar_stays_in_its_area(area: Area, value: float | None, lit: bool) -> None:
    bar = Bar("a name that is far too long for the row", area=area, value=value, unit="world", flip=lambda: 0)
    items = bar.items(lit)
    assert items[0].area == area
    assert all(area.covers(item.area) for item in items)


def test_each_element_of_a_component_bar_is_a_value() -> None:
    found: list[float] = []
    bar = ComponentBar("red", value=100, put=found.append, area=Area(176, 24, 495, 47))
    for element in range(192, 192 + 256):
        bar.pick(Place(element, 30))
    assert found == list(range(256))
    for element in (0, 600):
        bar.drag(ANYWHERE, ANYWHERE, Place(element, 0))
    for steps in (1, -3, -200):
        bar.nudge(steps)
    assert found[256:] == [0, 255, 101, 97, 0]


LYING = Area(8, 100, 495, 139)
STANDING = Area(500, 24, 531, 439)


def level_bar(levels: int, value: int = 0, upright: bool = False, found: list[int] | None = None) -> LevelBar:
    return LevelBar(
        "bar",
        area=STANDING if upright else LYING,
        words=np.arange(200, 200 + levels, dtype=np.uint16),
        value=value,
        most=levels - 1,
        put=print if found is None else found.append,
        number="0.50" if upright else "",
        upright=upright,
    )


def words_of(bar: Widget) -> Words:
    """The words of a display on which a bar alone is drawn."""
    display = Ramtek9300()
    draw_items(display, bar.items(lit=False))
    return display.words


@given(length=st.integers(2, 640), levels=st.integers(2, 1007))
def test_levels_rise_evenly_from_end_to_end(length: int, levels: int) -> None:
    found = levels_along(length, levels)
    assert found.tolist() == [half_up(place * (levels - 1) / (length - 1)) for place in range(length)]


@pytest.mark.parametrize("levels", [2, 40, 488, 800])
@pytest.mark.parametrize("upright", [False, True])
def test_a_pick_selects_the_level_that_is_shown_there(levels: int, upright: bool) -> None:
    found: list[int] = []
    bar = level_bar(levels, upright=upright, found=found)
    left, top, right, bottom = bar.strip
    assert bar.strip == (Area(500 + LANE, 24, 531, 439) if upright else Area(8, 100 + LANE, 495, 139 - LANE))
    words = words_of(bar)
    # Levels rise from the left, or from below.
    along = levels_along(bottom - top + 1 if upright else right - left + 1, levels)
    wanted = along[::-1, None] if upright else along
    strip = words[top : bottom + 1, left : right + 1]
    assert np.array_equal(strip, np.broadcast_to(200 + wanted, strip.shape))
    for share in (0, 0.3, 0.77, 1):
        element, line = left + int(share * (right - left)), top + int(share * (bottom - top))
        bar.pick(Place(element, line))
        assert found[-1] == words[line, element] - 200
    for place in (Place(0, 1000), Place(1000, -5)):
        bar.drag(ANYWHERE, ANYWHERE, place)
    assert found[-2:] == [0, levels - 1]


def test_the_number_of_an_upright_bar_is_a_part_of_its_handle() -> None:
    for level in (0, 17, 59):
        bar = level_bar(60, level, upright=True)
        left, top, _, bottom = next(item.area for item in bar.items(False) if item.area.right < bar.area.left)
        places = [(x, y) for y in range(top - 2, bottom + 3) for x in range(left - 2, bar.area.left)]
        held = [(x, y) for x, y in places if bar.has(x, y)]
        assert held == [(x, y) for x, y in places if left <= x and top <= y <= bottom]
        assert bar.has(bar.area.left, bar.area.top)


def test_a_drag_on_a_ramp_chooses_the_color_where_it_begins_and_moves_it() -> None:
    done: list[tuple[str, int]] = []
    bar = RampBar(
        "ramp",
        area=LYING,
        value=2,
        most=4,
        put=lambda color: done.append(("choose", color)),
        move=lambda to: done.append(("move", to)),
    )
    start, middle, end = Place(8 + 120, 120), Place(8 + 250, 120), Place(600, 90)
    bar.drag(start, start, middle)
    bar.drag(start, middle, end)
    bar.pick(start)
    bar.nudge(-1)
    assert done == [("choose", 1), ("move", 2), ("move", 4), ("choose", 1), ("choose", 1)]
    # There is a pointer at each color only if there is room.
    assert [len(replace(bar, most=most).items(lit=False)) for most in (4, 53, 54)] == [9, 58, 4]


def test_a_percentage_is_a_share_of_the_height() -> None:
    found: list[float] = []
    bar = PercentBar("percent", area=Area(600, 0, 635, 200), value=25.0, put=found.append)
    for line in (200, 100, 0, -9, 400):
        bar.pick(Place(610, line))
    bar.drag(ANYWHERE, ANYWHERE, Place(0, 50))
    bar.nudge(1)
    bar.nudge(-200)
    assert found == [0, 50, 100, 100, 0, 75, 26, 0]
    assert np.flatnonzero(words_of(bar)[:, 602] == WHITE).tolist() == [150]


@pytest.mark.parametrize(
    ("low", "high", "step"),
    [(0, 1, 0.01), (0, 100, 1), (0, 180, 1), (-180, 180, 2), (3, 3.004, 2e-5), (0, 3e-9, 2e-11)],
)
def test_a_bar_has_round_steps_of_at_most_a_hundredth(low: float, high: float, step: float) -> None:
    assert bar_within(low, high) == BarRange(low, high, step)
