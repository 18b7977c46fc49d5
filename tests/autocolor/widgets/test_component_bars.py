from __future__ import annotations

import numpy as np
import pytest

from autocolor.widgets.areas import Area
from autocolor.widgets.colors import RED, SLATE, WHITE, YELLOW
from autocolor.widgets.component_bars import ComponentBar
from autocolor.widgets.widget import Place
from ramtek_emu import Ramtek9300

AREA = Area(176, 24, 495, 47)
FIRST = 192


def bar_of(value: int, found: list[float] | None = None) -> ComponentBar:
    found = [] if found is None else found
    return ComponentBar("object, red", value=value, word=RED, letter="R", put=found.append, area=AREA)


def drawn(bar: ComponentBar, lit: bool = False) -> Ramtek9300:
    display = Ramtek9300()
    for item in bar.items(lit):
        display.send(np.frombuffer(item.stream, np.uint16))
    return display


def test_each_element_is_a_value() -> None:
    found: list[float] = []
    for element in range(FIRST, FIRST + 256):
        bar_of(0, found).pick(Place(element, 30))
    assert found == list(range(256))
    bar_of(0, found).drag(Place(0, 0), Place(0, 0), Place(0, 0))
    bar_of(0, found).drag(Place(0, 0), Place(0, 0), Place(600, 0))
    assert found[-2:] == [0, 255]


@pytest.mark.parametrize("value", [0, 1, 143, 255])
@pytest.mark.parametrize("lit", [False, True])
def test_the_bar_is_as_long_as_its_component_lit_or_not(value: int, lit: bool) -> None:
    line = drawn(bar_of(value), lit).words[36]
    track = line[FIRST : FIRST + 256]
    assert (track[:value] == RED).all()
    assert track[value] == WHITE
    assert (track[value + 1 :] == SLATE).all()


@pytest.mark.parametrize("value", [0, 16, 255])
def test_letter_and_number_stand_inside_the_area_and_are_lit(value: int) -> None:
    for lit, ink in ((False, WHITE), (True, YELLOW)):
        words = drawn(bar_of(value), lit).words
        lines, elements = np.nonzero(words)
        assert AREA.covers(Area(elements.min(), lines.min(), elements.max(), lines.max()))
        assert (words[:, : FIRST - 1] == ink).any()
        assert (words[:, FIRST + 256 :] == ink).any()


def test_a_step_is_one() -> None:
    found: list[float] = []
    bar_of(100, found).nudge(1)
    bar_of(100, found).nudge(-3)
    assert found == [101, 97]
