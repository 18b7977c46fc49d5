from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.widgets.items import Area
from autocolor.widgets.menu import Section
from autocolor.widgets.widget import (
    STEM_LETTERS,
    Button,
    Choice,
    Entry,
    Gap,
    Heading,
    Pair,
    Place,
    Steps,
    Switch,
    Widget,
    short_label,
    short_name,
)
from tests.autocolor.widgets.drawing import checksum

ROW = Area(505, 32, 639, 47)
LEFT, RIGHT = Place(510, 40), Place(630, 40)
LONG = "a label that is far too long for a row"


class Done:
    """What widgets did."""

    def __init__(self) -> None:
        self.did: list[object] = []

    def __call__(self, *values: object) -> None:
        self.did.append(values[0] if values else "done")


def test_a_switch_flips_at_its_box_and_chooses_beside_it() -> None:
    flipped, chosen = Done(), Done()
    switch = Switch("key", flip=flipped, choose=chosen, area=ROW)
    switch.pick(RIGHT)
    assert (len(flipped.did), len(chosen.did)) == (1, 0)
    switch.pick(LEFT)
    assert (len(flipped.did), len(chosen.did)) == (1, 1)
    Switch("key", flip=flipped, area=ROW).pick(LEFT)
    assert len(flipped.did) == 2


@pytest.mark.parametrize(
    ("is_on", "steps", "flips"), [(True, 1, 0), (True, -1, 1), (False, 1, 1), (False, -2, 0)]
)
def test_a_step_up_switches_on_and_a_step_down_off(is_on: bool, steps: float, flips: int) -> None:
    flipped = Done()
    Switch("key", is_on=is_on, flip=flipped, area=ROW).nudge(steps)
    assert len(flipped.did) == flips


def test_signs_take_whole_steps_and_a_drag_small_ones() -> None:
    done = Done()
    steps = Steps("turn", step=done, area=ROW)
    steps.pick(LEFT)
    steps.pick(RIGHT)
    steps.nudge(2)
    assert done.did == [-1, 1, 2]
    done.did.clear()
    for element in range(510, 526):
        steps.drag(LEFT, Place(element, 40), Place(element + 1, 40))
    assert sum(each for each in done.did if isinstance(each, float)) == 1


@pytest.mark.parametrize(
    ("present", "place", "chosen"),
    [("b", RIGHT, "c"), ("b", LEFT, "a"), ("c", RIGHT, "a"), ("", RIGHT, "a"), ("", LEFT, "c")],
)
def test_a_choice_goes_around_in_both_directions(present: str, place: Place, chosen: str) -> None:
    done = Done()
    Choice("curve", names=("a", "b", "c"), present=present, choose=done, area=ROW).pick(place)
    assert done.did == [chosen]


def test_a_drag_along_a_choice_runs_through_all_names() -> None:
    done = Done()
    choice = Choice("curve", names=("a", "b", "c"), present="b", choose=done, area=ROW)
    for element in range(ROW.left - 20, ROW.right + 20):
        choice.drag(LEFT, LEFT, Place(element, 40))
    assert list(dict.fromkeys(done.did)) == ["a", "c"]
    assert abs(done.did.count("a") - done.did.count("c")) <= 1
    for gesture in (Choice.pick, lambda empty, place: empty.drag(LEFT, LEFT, place)):
        gesture(Choice("curve", choose=done, area=ROW), RIGHT)
    assert set(done.did) == {"a", "c"}


@pytest.mark.parametrize(
    ("names", "turns_pages", "has_list"),
    [("abc", False, False), ("abcd", False, True), ("abcd", True, False), ("", False, False)],
)
def test_a_choice_of_many_names_has_a_list_and_says_so(names: str, turns_pages: bool, has_list: bool) -> None:
    choice = Choice("curve", "The curve.", names=names, turns_pages=turns_pages, area=ROW)
    assert choice.has_list == has_list
    assert choice.hint == ("The curve; a click lists all 4." if has_list else "The curve.")
    assert replace(choice, why_not="not now").hint == "not now"
    plain = replace(choice, names="ab")
    assert (choice.items(lit=False) != plain.items(lit=False)) == has_list


# If a widget changes on purpose, look at it, and copy the new numbers from the failure.
DRAWN = [
    (Heading("lights"), 764194933, 764194933),
    (Gap("gap"), 1506126552, 1506126552),
    (Button("go"), 3637888975, 3632758787),
    (Button("go", value="5", is_chosen=True), 618134226, 618134226),
    (Button("go", why_not="not now", value="5"), 826001560, 3578027959),
    (Button("go", why_not="not now", is_chosen=True), 3626575330, 3626575330),
    (Switch("key", is_on=True), 3781640670, 249858473),
    (Switch("key", is_chosen=True), 3957982083, 3957982083),
    (Switch("key", why_not="not now"), 2829883396, 1015594403),
    (Steps("turn"), 317012268, 489188201),
    (Choice("curve", present="linear"), 1101980339, 1951774414),
    (Entry("name", value="key"), 1773502175, 1538077327),
    (Entry("background", value="#000000"), 2800291542, 548034610),
    (Choice("background", names="abcd", present="#000000"), 2067287873, 735976307),
    (Pair("add", other="copy"), 1500010668, 3980865222),
    (Pair("add", why_not="not now", other="copy"), 2391159186, 984172536),
]


@pytest.mark.parametrize(("widget", "dim", "bright"), DRAWN)
def test_a_widget_is_drawn_as_it_was(widget: Widget, dim: int, bright: int) -> None:
    assert [checksum(widget.at(ROW).items(lit)) for lit in (False, True)] == [dim, bright]


@pytest.mark.parametrize("lit", [True, False])
@pytest.mark.parametrize(
    "widget", [Section(LONG, is_open=False), *(replace(widget, label=LONG) for widget, *_ in DRAWN)]
)
def test_a_row_stays_in_its_area_and_fills_it(widget: Widget, lit: bool) -> None:
    items = widget.at(ROW).items(lit)
    assert items[0].area == ROW
    assert items[0].is_solid
    assert all(ROW.covers(item.area) for item in items)


@pytest.mark.parametrize(
    ("label", "most", "short"),
    [
        ("cone angle", 10, "cone angle"),
        ("x minimum", 7, "x min."),
        ("normal reflectance", 12, "normal refl."),
        ("concentration", 9, "concentr."),
        ("aim", 1, "aim"),
        ("", 0, ""),
    ],
)
def test_the_longest_word_is_shortened_first(label: str, most: int, short: str) -> None:
    assert short_label(label, most) == short


@given(st.lists(st.text("abcdefgxyz", min_size=1), min_size=1).map(" ".join), st.integers(0, 40))
def test_a_label_keeps_its_words_and_fits_if_it_can(label: str, most: int) -> None:
    short = short_label(label, most)
    words = label.split(" ")
    shortened = short.split(" ")
    assert len(shortened) == len(words)
    for word, part in zip(words, shortened, strict=True):
        assert part == word or (part.endswith(".") and word.startswith(part[:-1]) and len(part) < len(word))
    least = sum(min(len(word), STEM_LETTERS + 1) for word in words) + len(words) - 1
    assert len(short) <= max(most, least)
    if len(label) <= most:
        assert short == label


@pytest.mark.parametrize(
    ("name", "most", "shown"),
    [
        ("car.obj", 7, "car.obj"),
        ("fender of the left door 12.obj", 16, "fender .. 12.obj"),
        ("abcdef", 5, "ab..f"),
        ("abcdef", 2, ".."),
        ("abcdef", 1, "."),
        ("abcdef", -3, ""),
    ],
)
def test_the_middle_of_a_long_name_is_left_out(name: str, most: int, shown: str) -> None:
    assert short_name(name, most) == shown


@pytest.mark.parametrize(("element", "ran"), [(510, "add"), (630, "copy")])
def test_each_half_of_a_pair_is_a_button(element: int, ran: str) -> None:
    did: list[str] = []
    pair = Pair("add", run=lambda: did.append("add"), other="copy", run_other=lambda: did.append("copy"))
    pair.at(ROW).pick(Place(element, 40))
    pair.nudge(1 if ran == "copy" else -1)
    assert did == [ran, ran]
