from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Surface, testing
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
from tests.tables import call, refused


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


def test_words_that_are_left_go_to_the_first_and_the_unseen_have_the_fewest() -> None:
    assert shares_of_words(101, [50, 50, 50]) == [34, 34, 33]
    assert shares_of_words(100, [0, 0, 0]) == [34, 33, 33]
    assert shares_of_words(1007, [90_000, 0]) == [991, 16]
    assert shares_of_words(30, [90_000, 0, 0]) == [10, 10, 10]


def test_a_surface_that_asks_for_levels_has_them_whatever_it_covers() -> None:
    surfaces = rows([300, None, None])
    covered = {"surface 0": 4, "surface 1": 40_000, "surface 2": 10_000}
    assert [each.levels for each in level_ranges(surfaces, covered).values()] == [300, 471, 236]


Ranges = dict[str, LevelRange]


def words_in(each: LevelRange) -> range:
    return range(each.first, each.last + 1)


@st.composite
def loans(draw: st.DrawFn) -> tuple[Ranges, list[str], int]:
    """Ranges, the surfaces that stay, and a number of words that can be borrowed."""
    ranges = draw(testing.level_ranges())
    kept = [name for name in ranges if draw(st.booleans())]
    most = SCREENS.first - 1 - len(kept)
    return ranges, kept, draw(st.integers(0, most) | st.sampled_from([min(128, most), most]))


@given(testing.level_ranges(), st.integers(1, 400))
def test_borrowed_words_are_spread_evenly(ranges: Ranges, count: int) -> None:
    name = max(ranges, key=lambda each: ranges[each].levels)
    levels = ranges[name].levels
    borrowed = borrowed_words(ranges, [name], SCREENS.first - 1 - levels + min(count, levels - 1))
    first, last = ranges[name].first, ranges[name].last
    lent = borrowed[(borrowed >= first) & (borrowed <= last)].astype(int)
    gaps = np.diff(lent)
    assert np.ptp(gaps) <= 1 if len(gaps) else len(lent) <= 1


@given(loans())
def test_as_many_words_are_borrowed_as_asked_for_and_surfaces_that_stay_lend_what_the_others_lack(
    loan: tuple[Ranges, list[str], int],
) -> None:
    ranges, kept, count = loan
    borrowed = borrowed_words(*loan)
    assert borrowed.shape == (count,)
    assert borrowed.dtype == np.uint16
    assert (np.diff(borrowed.astype(int)) > 0).all()
    assert ((borrowed != BACKGROUND) & (borrowed < SCREENS.first)).all()
    own = {word for name in kept for word in words_in(ranges[name])}
    lent = own & set(borrowed.tolist())
    free = SCREENS.first - 1 - len(own)
    assert len(lent) == max(0, count - free)

    every = np.arange(WORDS, dtype=np.uint16).reshape(32, 32)
    after = without_words(every, borrowed, ranges)
    assert after.shape == every.shape
    assert after.dtype == np.uint16
    assert not after.flags.writeable
    shown = after.ravel().tolist()
    for name in kept:
        # The slow twin: the nearest of all that are left, the lower one of two.
        left = [word for word in words_in(ranges[name]) if word not in lent]
        for word in words_in(ranges[name]):
            assert shown[word] == min(left, key=lambda other: (abs(other - word), other))
            # No pixel moves by more than a level unless more than half are borrowed.
            assert abs(shown[word] - word) <= 1 or 2 * len(lent) > len(own)
    others = set(range(WORDS)) - {word for each in ranges.values() for word in words_in(each)}
    all_lent = [each for each in ranges.values() if set(words_in(each)) <= set(borrowed.tolist())]
    for word in [*others, *(word for each in all_lent for word in words_in(each))]:
        assert shown[word] == word


BODY_AND_GLASS = {"body": LevelRange(1, 1000), "glass": LevelRange(1001, 7)}

test_what_is_refused = refused(
    call,
    [
        (
            lambda: level_ranges(rows([600, 500, None]), {f"surface {row}": 1 for row in range(3)}),
            "surface 'surface 0': all levels must be at most 1007, 2 for each surface without a number,"
            " not 1100 and 1 such; ask for fewer levels",
        ),
        *(
            (
                lambda count=count: borrowed_words(BODY_AND_GLASS, ["body", "glass"], count),
                f"the words to borrow must be 0 to 1005 beside the surfaces that stay, not {count};"
                " borrow fewer",
            )
            for count in (-1, 1006)
        ),
    ],
)
