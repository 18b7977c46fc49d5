from __future__ import annotations

import numpy as np
import pytest

from autocolor.widgets.areas import Area
from autocolor.widgets.swatch_fields import SwatchField
from autocolor.widgets.widget import Place
from ramtek_emu import Ramtek9300

AREA = Area(176, 312, 255, 367)


def field_of(count: int, found: list[int] | None = None) -> SwatchField:
    found = [] if found is None else found
    words = np.arange(100, 100 + count, dtype=np.uint16)
    return SwatchField("paints", words=words, across=5, width=16, height=14, take=found.append, area=AREA)


def drawn(field: SwatchField) -> Ramtek9300:
    display = Ramtek9300()
    for item in field.items(lit=False):
        display.send(np.frombuffer(item.stream, np.uint16))
    return display


@pytest.mark.parametrize("count", [1, 5, 7, 20])
def test_a_pick_takes_the_cell_that_is_shown_there(count: int) -> None:
    found: list[int] = []
    field = field_of(count, found)
    words = drawn(field).words
    for line in range(AREA.top, AREA.bottom + 1, 14):
        for element in range(AREA.left, AREA.right + 1, 16):
            before = len(found)
            field.pick(Place(element + 3, line + 3))
            word = int(words[line + 3, element + 3])
            assert found[before:] == ([word - 100] if 100 <= word < 100 + count else [])
    assert found == list(range(count))


def test_nothing_is_drawn_or_taken_beyond_the_cells() -> None:
    found: list[int] = []
    field = field_of(20, found)
    lines, elements = np.nonzero(drawn(field).words)
    assert AREA.covers(Area(elements.min(), lines.min(), elements.max(), lines.max()))
    for place in ((175, 320), (256, 320), (200, 311), (200, 368)):
        field.drag(Place(200, 320), Place(200, 320), Place(*place))
    assert found == []


def test_a_drag_takes_each_cell_that_it_comes_to() -> None:
    found: list[int] = []
    field = field_of(20, found)
    for element in (180, 200, 220):
        field.drag(Place(180, 315), Place(180, 315), Place(element, 330))
    assert found == [5, 6, 7]


def test_without_cells_there_is_nothing() -> None:
    found: list[int] = []
    field = field_of(0, found)
    assert field.items(lit=True) == []
    field.pick(Place(180, 315))
    assert found == []
