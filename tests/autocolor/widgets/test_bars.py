from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import UsageError
from autocolor.widgets.areas import Area
from autocolor.widgets.bars import Bar, digits_of, number_text, rounded_to
from autocolor.widgets.items import Item
from autocolor.widgets.menu import WIDE_BAR
from autocolor.widgets.widget import Place

STEPS = (0.001, 0.01, 0.05, 0.1, 0.125, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0)
ROW = Area(505, 32, 639, 47)


class Number:
    """A number that a bar sets."""

    def __init__(self, value: float) -> None:
        self.value = value

    def put(self, value: float) -> None:
        self.value = value


@given(st.sampled_from(STEPS), st.integers(-500, 500))
def test_a_whole_number_of_steps_is_written_and_read_again(step: float, count: int) -> None:
    value = rounded_to(count * step, step)
    assert value == pytest.approx(count * step)
    assert rounded_to(value, step) == value
    assert float(number_text(value, step)) == pytest.approx(value)


@given(st.sampled_from(STEPS), st.floats(-1e5, 1e5))
def test_rounding_is_to_the_nearest_step(step: float, value: float) -> None:
    assert abs(rounded_to(value, step) - value) <= step / 2 + 1e-6


@pytest.mark.parametrize(
    ("value", "step", "shown"),
    [(0.25, 0.25, "0.25"), (2.5, 2.5, "2.5"), (0.3, 0.05, "0.30"), (-0.0, 0.1, "0.0"), (12.345, 1, "12.345")],
)
def test_a_number_is_shown_with_the_digits_of_its_step(value: float, step: float, shown: str) -> None:
    assert number_text(value, step) == shown


def test_a_step_that_has_no_end_has_nine_digits() -> None:
    assert digits_of(1 / 3) == 9


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


def test_a_bar_is_set_by_pick_drag_step_and_text() -> None:
    number = Number(0.5)
    bar = Bar("bar", area=ROW, value=0.5, low=0.0, high=1.0, step=0.1, put=number.put)
    bar.pick(Place(ROW.left, 40))
    assert number.value == 0.0
    bar.drag(Place(0, 0), Place(0, 0), Place(ROW.right, 40))
    assert number.value == 1.0
    bar.nudge(-1)
    assert number.value == 0.4
    bar.typed.take("0,75")
    assert number.value == 0.75
    with pytest.raises(UsageError) as refusal:
        bar.typed.take("much")
    assert str(refusal.value) == "bar must be a number, not 'much'; type one, such as 1.5"
    assert number.value == 0.75


def test_a_row_has_no_more_digits_than_leave_its_label_whole() -> None:
    def written(label: str, value: float, **fields: Any) -> list[Item]:
        # After the ground of the row come the number and the label.
        return Bar(label, area=ROW, value=value, step=0.1, **fields).items(lit=False)[1:3]

    assert written("position x", -0.525909) == written("position x", -0.5)
    assert written("x", -0.525909) != written("x", -0.5)
    box = {"flip": lambda: None}
    assert written("cone angle", 12.045, **box) == written("cone angle", 12.0, **box)
    assert written("cone", 12.045, **box) != written("cone", 12.0, **box)
    assert Bar("position x", area=ROW, value=-0.525909, step=0.1).typed.text == "-0.525909"


def test_a_number_that_can_be_absent_has_a_box() -> None:
    flips: list[int] = []
    number = Number(0.0)
    present = Bar("bar", area=ROW, value=0.5, put=number.put, flip=lambda: flips.append(1))
    absent = Bar("bar", area=ROW, value=None, put=number.put, flip=lambda: flips.append(2))
    present.pick(Place(ROW.right - 10, 40))
    absent.pick(Place(ROW.left + 20, 40))
    assert flips == [1, 2]
    present.pick(Place(ROW.left, 40))
    assert (flips, number.value) == ([1, 2], 0.0)
    assert (absent.number, absent.share) == ("", 0.0)
    assert absent.nudge(1) is None


@pytest.mark.parametrize("area", [ROW, WIDE_BAR])
@pytest.mark.parametrize("value", [-1e7, 0.0, 0.5, 1e7, None])
@pytest.mark.parametrize("lit", [True, False])
def test_a_bar_stays_in_its_area(area: Area, value: float | None, lit: bool) -> None:
    bar = Bar("a name that is far too long for the row", area=area, value=value, unit="world", flip=lambda: 0)
    items = bar.items(lit)
    assert items[0].area == area
    assert all(area.covers(item.area) for item in items)


def test_a_bar_of_no_length_has_no_share() -> None:
    assert Bar("bar", area=ROW, value=1.0, low=1.0, high=1.0).share == 0.0
    assert rounded_to(0.123, 0) == 0.123
