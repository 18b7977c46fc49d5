from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.widgets.items import CHARACTER, Area
from autocolor.widgets.menu import MENU, Section, laid_out
from autocolor.widgets.widget import (
    MARGIN,
    ROW_CHARACTERS,
    ROW_LINES,
    Button,
    Choice,
    Entry,
    Pair,
    Place,
    Steps,
    Switch,
    Widget,
    short_label,
)

ROW = Area(505, 32, 639, 47)
LEFT, RIGHT = Place(510, 40), Place(630, 40)


@pytest.mark.parametrize(("place", "wanted"), [(RIGHT, "flip"), (LEFT, "choose")])
def test_a_switch_flips_at_its_box_and_chooses_beside_it(place: Place, wanted: str) -> None:
    did: list[str] = []
    switch = Switch("key", flip=lambda: did.append("flip"), choose=lambda: did.append("choose"), area=ROW)
    switch.pick(place)
    replace(switch, choose=None).pick(place)
    assert did == [wanted, "flip"]


@pytest.mark.parametrize(
    ("is_on", "steps", "flips"), [(True, 1, 0), (True, -1, 1), (False, 1, 1), (False, -2, 0)]
)
def test_a_step_up_switches_on_and_a_step_down_off(is_on: bool, steps: float, flips: int) -> None:
    did: list[str] = []
    Switch("key", is_on=is_on, flip=lambda: did.append("flip"), area=ROW).nudge(steps)
    assert len(did) == flips


def test_signs_take_whole_steps_and_a_drag_small_ones() -> None:
    did: list[object] = []
    steps = Steps("turn", step=did.append, area=ROW)
    steps.pick(LEFT)
    steps.pick(RIGHT)
    steps.nudge(2)
    for element in range(510, 526):
        steps.drag(LEFT, Place(element, 40), Place(element + 1, 40))
    assert did == [-1, 1, 2, *[1 / 16] * 16]


@pytest.mark.parametrize(
    ("present", "place", "chosen"),
    [("b", RIGHT, "c"), ("b", LEFT, "a"), ("c", RIGHT, "a"), ("", RIGHT, "a"), ("", LEFT, "c")],
)
def test_a_choice_goes_around_in_both_directions(present: str, place: Place, chosen: str) -> None:
    did: list[object] = []
    Choice("curve", names=("a", "b", "c"), present=present, choose=did.append, area=ROW).pick(place)
    assert did == [chosen]


def test_a_drag_along_a_choice_runs_through_all_names() -> None:
    did: list[object] = []
    choice = Choice("curve", names=("a", "b", "c"), present="b", choose=did.append, area=ROW)
    for element in range(ROW.left - 20, ROW.right + 20):
        choice.drag(LEFT, LEFT, Place(element, 40))
    assert list(dict.fromkeys(did)) == ["a", "c"]
    assert abs(did.count("a") - did.count("c")) <= 1
    # A scene whose surfaces are out of the picture has no name to choose.
    empty = Choice("curve", choose=did.append, area=ROW)
    empty.pick(RIGHT)
    empty.drag(LEFT, LEFT, RIGHT)
    assert set(did) == {"a", "c", ""}


@pytest.mark.parametrize(
    ("names", "turns_pages", "has_list"),
    [("abc", False, False), ("abcd", False, True), ("abcd", True, False)],
)
def test_a_choice_of_many_names_has_a_list_and_says_so(names: str, turns_pages: bool, has_list: bool) -> None:
    choice = Choice("curve", "The curve.", names=names, turns_pages=turns_pages, area=ROW)
    assert choice.has_list == has_list
    assert choice.hint_at(LEFT) == ("The curve; a click lists all 4." if has_list else "The curve.")
    assert replace(choice, why_not="not now").hint_at(LEFT) == "not now"
    assert (choice.items(lit=False) != replace(choice, names="ab").items(lit=False)) == has_list


@pytest.mark.parametrize(("element", "number"), [(510, 0), (559, 0), (571, 1), (630, 1)])
def test_each_word_of_a_row_is_a_button(element: int, number: int) -> None:
    did: list[int] = []
    pair = Pair("add", run=lambda: did.append(0), other="copy", run_other=lambda: did.append(1), area=ROW)
    pair.pick(Place(element, 40))
    pair.nudge(1 if number else -1)
    assert did == [number, number]


@pytest.mark.parametrize("kind", [Section, Button, Switch, Steps, Choice, Entry])
def test_a_row_stays_in_its_area_and_fills_it(kind: type[Widget]) -> None:
    row = kind("a label that is far too long for a row", area=ROW)
    for items in (row.items(lit=False), row.items(lit=True)):
        assert items[0].area == ROW
        assert items[0].is_solid
        assert all(ROW.covers(item.area) for item in items)


@pytest.mark.parametrize("kind", [Button, Entry, Choice])
@given(length=st.integers(1, ROW_CHARACTERS))
def test_a_name_in_a_menu_is_whole_and_so_is_its_label(kind: type[Widget], length: int) -> None:
    field = "present" if kind is Choice else "value"
    (row,) = laid_out([replace(kind("light"), **{field: "n" * length})])  # type: ignore[arg-type]
    assert row.area.height == ROW_LINES * (1 + (length > ROW_CHARACTERS - len("light ")))
    _, name, label = (item.area for item in row.items(lit=False))
    assert (name.width, label.width) == (CHARACTER * length, CHARACTER * len("light"))
    assert (label.left, name.right) == (MENU.left + 1 + MARGIN, MENU.right - MARGIN)
    assert not name.overlaps(label)
    assert row.area.covers(name)


@given(st.lists(st.text("abcdefgxyz", min_size=1), min_size=1).map(" ".join), st.integers(0, 40))
def test_a_label_fits_and_a_label_that_fits_is_whole(label: str, most: int) -> None:
    short = short_label(label, most)
    assert len(short) <= most
    assert (short == label) == (len(label) <= most)
