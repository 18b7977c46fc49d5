from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Surface
from autocolor.mapping.level_ranges import (
    BACKGROUND,
    SCREENS,
    USEFUL_LEVELS,
    LevelRange,
    level_ranges,
    shares_of_words,
)
from tests.autocolor.reference import divided


def rows(levels: list[int | None]) -> list[Surface]:
    return [Surface(f"surface {row}", levels=count) for row, count in enumerate(levels)]


@given(st.lists(st.none() | st.integers(2, 200), min_size=1, max_size=12), st.data())
def test_the_surfaces_in_use_share_the_words_equally_as_the_slow_twin_says(
    levels: list[int | None], data: st.DataObject
) -> None:
    surfaces = rows(levels)
    used = [surface for surface in surfaces if data.draw(st.booleans())]
    in_use = {surface.name: 1 for surface in used}
    asked = sum(surface.levels or 0 for surface in used)
    sharing = sum(surface.levels is None for surface in used)
    if asked > 1007 or (sharing and (1007 - asked) // sharing < 2):
        with pytest.raises(InputError, match="ask for fewer levels"):
            level_ranges(surfaces, in_use, "equal")
        return
    ranges = level_ranges(surfaces, in_use, "equal")
    assert list(ranges) == [surface.name for surface in used]
    assert [tuple(each) for each in ranges.values()] == divided([surface.levels for surface in used])


@given(st.integers(1, 255))
def test_ranges_follow_each_other_between_the_background_and_the_screens(count: int) -> None:
    surfaces = rows([None] * count)
    words = [
        word
        for first, levels in level_ranges(surfaces, {surface.name: 1 for surface in surfaces}).values()
        for word in range(first, first + levels)
    ]
    assert words == list(range(1, 1 + len(words)))
    assert BACKGROUND not in words
    assert words[-1] < SCREENS.first
    assert SCREENS == (1008, 16)


def test_one_surface_has_all_the_words_but_those_of_background_and_screens() -> None:
    only = level_ranges(rows([None]), {"surface 0": 1})["surface 0"]
    assert only == LevelRange(1, 1007)
    assert only.last == 1007


def test_a_surface_that_asks_for_too_much_is_named() -> None:
    with pytest.raises(InputError) as refusal:
        level_ranges(rows([600, 500]), {"surface 0": 1, "surface 1": 1})
    assert str(refusal.value).startswith(
        "surface 'surface 0': the levels must be at most 1007 in all, 2 of them"
    )


def test_a_surface_that_is_not_in_use_has_no_words() -> None:
    assert list(level_ranges(rows([2000, None]), {"surface 1": 1})) == ["surface 1"]


@given(st.integers(2, 1007), st.lists(st.integers(0, 300_000), min_size=1, max_size=60))
def test_words_are_shared_by_the_square_root_of_what_is_covered(words: int, pixels: list[int]) -> None:
    words = max(words, 2 * len(pixels))
    shares = shares_of_words(words, pixels)
    fewest = min(USEFUL_LEVELS, words // len(pixels))
    assert sum(shares) == words
    assert min(shares) >= fewest
    # Those above the minimum are in proportion, to within the one word of rounding.
    roots = [math.sqrt(count) for count in pixels]
    above = [row for row, share in enumerate(shares) if share > fewest + 1]
    if any(roots) and above:
        each = sum(shares[row] for row in above) / sum(roots[row] for row in above)
        assert all(abs(shares[row] - each * roots[row]) < 2 for row in above)
    # What covers more never gets less.
    by_size = sorted(range(len(pixels)), key=lambda row: pixels[row])
    assert all(shares[a] <= shares[b] + 1 for a, b in itertools.pairwise(by_size))


def test_of_surfaces_that_cover_the_same_the_first_get_the_words_that_are_left() -> None:
    assert shares_of_words(101, [50, 50, 50]) == [34, 34, 33]
    assert shares_of_words(100, [0, 0, 0]) == [34, 33, 33]


def test_a_surface_in_use_that_is_not_seen_has_the_fewest_words() -> None:
    assert shares_of_words(1007, [90_000, 0]) == [991, 16]
    assert shares_of_words(30, [90_000, 0, 0]) == [10, 10, 10]


def test_a_surface_that_asks_for_levels_has_them_whatever_it_covers() -> None:
    surfaces = rows([300, None, None])
    covered = {"surface 0": 4, "surface 1": 40_000, "surface 2": 10_000}
    assert [each.levels for each in level_ranges(surfaces, covered).values()] == [300, 471, 236]
