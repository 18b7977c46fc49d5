"""Words that a screen borrows from surfaces, for more colors than its own sixteen words have.

A surface may own nearly all words, so that there are none between the surfaces. A screen takes the words of
surfaces that it does not show, and, where these do not suffice, words spread over those that it shows; their
pixels then show the neighboring level. The words of the background and of the screens are never borrowed.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from autocolor.arrays import Numbers, Words
from autocolor.checks import shown
from autocolor.errors import UsageError
from autocolor.immutable import read_only
from autocolor.mapping.level_ranges import BACKGROUND, SCREENS, WORDS, LevelRange


def borrowed_words(ranges: Mapping[str, LevelRange], kept: Collection[str], count: int) -> Words:
    """Words to borrow, (count,) uint16, rising, read-only, while the surfaces named in `kept` stay visible.

    Words of no surface and of those that are not kept come first. Others are spread evenly over the surfaces
    that are: no two of them are neighbors unless more than half of all are borrowed, and each of these
    surfaces has at least one left. Raises UsageError where there are not so many.
    """
    is_free = np.ones(WORDS, bool)
    is_free[[BACKGROUND, *range(SCREENS.first, WORDS)]] = False
    staying = [_words_of(each) for name, each in ranges.items() if name in kept]
    for words in staying:
        is_free[words] = False
    free = np.flatnonzero(is_free)
    if 0 <= count <= len(free):
        return _as_words(free[:count])
    lending = [words for words in staying if len(words) > 1]
    lent = np.sort(np.concatenate([np.empty(0, np.int64), *lending]))
    needed = count - len(free)
    if 2 * needed > len(lent):
        # Then some neighbors are borrowed both: keep the lowest level of each surface.
        lent = np.setdiff1d(lent, [words[0] for words in lending])
    if not 0 <= needed <= len(lent):
        most = len(free) + sum(len(words) - 1 for words in lending)
        raise UsageError(
            f"the words to borrow must be 0 to {most} beside the surfaces that stay, not {shown(count)};"
            " borrow fewer"
        )
    places = (2 * np.arange(needed) + 1) * len(lent) // (2 * max(needed, 1))
    return _as_words(np.sort(np.concatenate([free, lent[places]])))


def without_words(words: Words, borrowed: Words, ranges: Mapping[str, LevelRange]) -> Words:
    """The raster with each borrowed word replaced by the nearest word of the same surface that is not.

    Of two that are as near, it is the lower one. `words` may have any shape; the result has the same, and is
    read-only. A surface that lent all its words, as one that is not shown does, keeps them.
    """
    other = np.arange(WORDS, dtype=np.uint16)
    is_borrowed = np.zeros(WORDS, bool)
    is_borrowed[borrowed] = True
    for each in ranges.values():
        own = _words_of(each)
        left = own[~is_borrowed[own]]
        if 0 < len(left) < len(own):
            lent = own[is_borrowed[own]]
            after = np.searchsorted(left, lent)
            below, above = left[np.maximum(after - 1, 0)], left[np.minimum(after, len(left) - 1)]
            other[lent] = np.where(np.abs(lent - below) <= np.abs(above - lent), below, above)
    return read_only(other.take(words))


def _words_of(each: LevelRange) -> Numbers:
    return np.arange(each.first, each.first + each.levels)


def _as_words(words: Numbers) -> Words:
    return read_only(words.astype(np.uint16))
