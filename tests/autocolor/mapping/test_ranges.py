from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Surface, UsageError, testing
from autocolor.mapping.ranges import (
    BACKGROUND,
    SCREENS,
    USEFUL_LEVELS,
    WORDS,
    LevelRange,
    borrowed_words,
    level_ranges,
    shares_of_words,
    without_words,
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
        "surface 'surface 0': the levels of all surfaces must be at most 1007, with 2"
    )


def test_a_surface_that_is_not_in_use_has_no_words() -> None:
    assert list(level_ranges(rows([2000, None]), {"surface 1": 1})) == ["surface 1"]


@given(st.integers(2, 1007), st.lists(st.integers(0, 300_000), min_size=1, max_size=60))
def test_words_are_shared_by_the_square_root_of_the_covered_pixels(words: int, pixels: list[int]) -> None:
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


Ranges = dict[str, LevelRange]


@st.composite
def loans(draw: st.DrawFn) -> tuple[Ranges, list[str], int]:
    """Ranges, the surfaces that stay, and a number of words that can be borrowed."""
    ranges = draw(testing.level_ranges())
    kept = [name for name in ranges if draw(st.booleans())]
    most = SCREENS.first - 1 - len(kept)
    return ranges, kept, draw(st.integers(0, most) | st.sampled_from([min(128, most), most]))


@given(loans())
def test_as_many_words_are_borrowed_as_asked_for_each_once(loan: tuple[Ranges, list[str], int]) -> None:
    borrowed = borrowed_words(*loan)
    assert borrowed.shape == (loan[2],)
    assert borrowed.dtype == np.uint16
    assert (np.diff(borrowed.astype(int)) > 0).all()
    assert BACKGROUND not in borrowed
    assert (borrowed < SCREENS.first).all()


@given(loans())
def test_surfaces_that_stay_lend_only_what_the_others_lack(loan: tuple[Ranges, list[str], int]) -> None:
    ranges, kept, count = loan
    borrowed = set(borrowed_words(ranges, kept, count).tolist())
    own = {word for name in kept for word in range(ranges[name].first, ranges[name].last + 1)}
    free = SCREENS.first - 1 - len(own)
    assert len(borrowed & own) == max(0, count - free)
    for name in kept:
        assert not set(range(ranges[name].first, ranges[name].last + 1)) <= borrowed


@given(loans())
def test_no_pixel_of_a_surface_that_stays_has_a_borrowed_word_or_another_surfaces(
    loan: tuple[Ranges, list[str], int],
) -> None:
    ranges, kept, _ = loan
    borrowed = borrowed_words(*loan)
    every = np.arange(WORDS, dtype=np.uint16).reshape(32, 32)
    after = without_words(every, borrowed, ranges)
    assert after.shape == every.shape
    assert after.dtype == np.uint16
    assert not after.flags.writeable
    told = dict(zip(every.ravel().tolist(), after.ravel().tolist(), strict=True))
    for name in kept:
        first, last = ranges[name].first, ranges[name].last
        left = [word for word in range(first, last + 1) if word not in set(borrowed.tolist())]
        for word in range(first, last + 1):
            # The slow twin: the nearest of all that are left, the lower one of two.
            assert told[word] == min(left, key=lambda other: (abs(other - word), other))
    outside = set(range(WORDS)) - {w for each in ranges.values() for w in range(each.first, each.last + 1)}
    assert all(told[word] == word for word in outside)


@given(loans())
def test_no_pixel_moves_by_more_than_a_level_unless_more_than_half_are_borrowed(
    loan: tuple[Ranges, list[str], int],
) -> None:
    ranges, kept, count = loan
    borrowed = borrowed_words(*loan)
    own = sorted(word for name in kept for word in range(ranges[name].first, ranges[name].last + 1))
    free = SCREENS.first - 1 - len(own)
    if 2 * (count - free) <= len(own):
        words = np.array(own, np.uint16)
        moved = np.abs(without_words(words, borrowed, ranges).astype(int) - words)
        assert moved.max(initial=0) <= 1


@given(testing.level_ranges(), st.integers(1, 400))
def test_borrowed_words_are_spread_evenly(ranges: Ranges, count: int) -> None:
    name = max(ranges, key=lambda each: ranges[each].levels)
    levels = ranges[name].levels
    borrowed = borrowed_words(ranges, [name], SCREENS.first - 1 - levels + min(count, levels - 1))
    first, last = ranges[name].first, ranges[name].last
    lent = borrowed[(borrowed >= first) & (borrowed <= last)].astype(int)
    gaps = np.diff(lent)
    assert np.ptp(gaps) <= 1 if len(gaps) else len(lent) <= 1


def test_one_surface_with_all_words_lends_two_ramps_of_sixty_four() -> None:
    ranges = {"body": LevelRange(1, 1007)}
    borrowed = borrowed_words(ranges, ["body"], 128)
    assert borrowed[:3].tolist() == [4, 12, 20]
    assert without_words(np.array([[0, 3, 4, 12, 1023]], np.uint16), borrowed, ranges).tolist() == [
        [0, 3, 3, 11, 1023]
    ]


def test_surfaces_that_are_not_shown_lend_before_the_others_and_keep_their_pixels() -> None:
    ranges = {"body": LevelRange(1, 500), "glass": LevelRange(501, 507)}
    borrowed = borrowed_words(ranges, ["body"], 507)
    assert borrowed.tolist() == list(range(501, 1008))
    glass = np.arange(501, 1008, dtype=np.uint16)
    assert without_words(glass, borrowed, ranges).tolist() == glass.tolist()


@pytest.mark.parametrize("count", [-1, 1006, 5000])
def test_more_words_than_there_are_is_refused(count: Any) -> None:
    ranges = {"body": LevelRange(1, 1000), "glass": LevelRange(1001, 7)}
    with pytest.raises(UsageError) as refusal:
        borrowed_words(ranges, ["body", "glass"], count)
    assert str(refusal.value) == (
        f"the words to borrow must be 0 to 1005 beside the surfaces that stay, not {count}; borrow fewer"
    )
