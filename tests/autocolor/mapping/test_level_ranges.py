from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Surface
from autocolor.mapping.level_ranges import BACKGROUND, SCREENS, LevelRange, level_ranges
from tests.autocolor.reference import divided


def rows(levels: list[int | None]) -> list[Surface]:
    return [Surface(f"surface {row}", levels=count) for row, count in enumerate(levels)]


@given(st.lists(st.none() | st.integers(2, 200), min_size=1, max_size=12), st.data())
def test_the_surfaces_in_use_share_the_words_as_the_slow_twin_says(
    levels: list[int | None], data: st.DataObject
) -> None:
    surfaces = rows(levels)
    used = [surface for surface in surfaces if data.draw(st.booleans())]
    in_use = {surface.name for surface in used}
    asked = sum(surface.levels or 0 for surface in used)
    sharing = sum(surface.levels is None for surface in used)
    if asked > 1007 or (sharing and (1007 - asked) // sharing < 2):
        with pytest.raises(InputError, match="ask for fewer levels"):
            level_ranges(surfaces, in_use)
        return
    ranges = level_ranges(surfaces, in_use)
    assert list(ranges) == [surface.name for surface in used]
    assert [tuple(each) for each in ranges.values()] == divided([surface.levels for surface in used])


@given(st.integers(1, 255))
def test_ranges_follow_each_other_between_the_background_and_the_screens(count: int) -> None:
    surfaces = rows([None] * count)
    words = [
        word
        for first, levels in level_ranges(surfaces, {surface.name for surface in surfaces}).values()
        for word in range(first, first + levels)
    ]
    assert words == list(range(1, 1 + len(words)))
    assert BACKGROUND not in words
    assert words[-1] < SCREENS.first
    assert SCREENS == (1008, 16)


def test_one_surface_has_all_the_words_but_those_of_background_and_screens() -> None:
    only = level_ranges(rows([None]), {"surface 0"})["surface 0"]
    assert only == LevelRange(1, 1007)
    assert only.last == 1007


def test_a_surface_that_asks_for_too_much_is_named() -> None:
    with pytest.raises(InputError) as refusal:
        level_ranges(rows([600, 500]), {"surface 0", "surface 1"})
    assert str(refusal.value).startswith(
        "surface 'surface 0': the levels must be at most 1007 in all, 2 of them"
    )


def test_a_surface_that_is_not_in_use_has_no_words() -> None:
    assert list(level_ranges(rows([2000, None]), {"surface 1"})) == ["surface 1"]
