from __future__ import annotations

import itertools

from hypothesis import given
from hypothesis import strategies as st

from autocolor.screens.light_and_view.numerals import Cross, numerals
from autocolor.widgets.areas import Area

AREA = Area(0, 0, 247, 223)

crosses = st.builds(Cross, st.integers(1, 16), st.integers(-20, 260), st.integers(-20, 240))


def test_a_numeral_stands_to_the_right_and_above_its_cross() -> None:
    ((cross, area),) = numerals([Cross(3, 100, 100)], AREA, [])
    assert cross.number == 3
    assert (area.left, area.bottom) == (106, 94)
    assert (area.width, area.height) == (7, 9)


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
