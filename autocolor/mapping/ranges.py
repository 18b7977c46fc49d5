"""Level ranges: the words that each surface owns.

Paper: "Light Source Color Blending", Figure 11: the intensities of each surface type are mapped to a separate
sequential range of the lookup table. Assumed: word 0 is the background, the sixteen highest words belong to
the interactive screens, and the words between are divided among the surfaces in use, in table order.

Assumed: they are divided in proportion to the square root of the pixels that a surface covers, which is its
size in the picture: a gradient across twice the size is as smooth with twice the levels. In proportion to the
pixels themselves, small surfaces would get too few levels.

A screen that needs more colors than its own sixteen words borrows words of surfaces. A surface may own nearly
all words, so that there are none between the surfaces: then the borrowed words are spread over the surfaces
that stay visible, whose pixels show the neighboring level.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Numbers, Words
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.immutable import read_only
from autocolor.scene.surfaces import Surface

WORDS: Final = 1024
BACKGROUND: Final = 0
SCREEN_LEVELS: Final = 16
FEWEST_LEVELS: Final = 2

USEFUL_LEVELS: Final = 16
"""Assumed: with fewer levels a surface shows visible steps. Every surface gets these if the words suffice."""


class LevelRange(NamedTuple):
    """The words `first` to `first + levels - 1`; a surface's level l is the word first + l."""

    first: int
    levels: int

    @property
    def last(self) -> int:
        """The word of the highest level."""
        return self.first + self.levels - 1


SCREENS: Final = LevelRange(WORDS - SCREEN_LEVELS, SCREEN_LEVELS)
"""The words that the interactive screens draw with."""

BACKDROP: Final = LevelRange(SCREENS.first - 32, 32)
"""The words of the backdrop of a scene that has one, from the top of the picture to its bottom."""

STAGE_LEVELS: Final = 128
"""The most levels of a stage that is made and asks for no number; with the backdrop, it has 160 words."""

SURFACE_WORDS: Final = SCREENS.first - BACKGROUND - 1
"""How many words the surfaces share."""

SCREEN_COLORS: Final = (
    (0, 0, 0), (255, 255, 255), (192, 192, 192), (128, 128, 128), (72, 76, 84), (36, 39, 46),
    (255, 214, 90), (255, 140, 60), (235, 70, 70), (110, 200, 110), (90, 170, 240), (170, 130, 230),
    (120, 220, 220), (240, 150, 190), (150, 110, 70), (210, 225, 160),
)  # fmt: skip
"""Assumed: the colors of the screens' words, which do not depend on the scene."""


def level_ranges(
    surfaces: Sequence[Surface],
    covered: Mapping[str, int],
    division: str = "covered",
    fixed: Mapping[str, int] = MappingProxyType({}),
    *,
    stage: str = "",
    has_backdrop: bool = False,
) -> Mapping[str, LevelRange]:
    """The level range of each surface in use, by name.

    `covered` has the number of pixels that each surface in use covers in the picture, 0 if it is not visible.
    A surface gets the number of levels that is `fixed` for it, such as by its bands, else the number that it
    asks for. Surfaces without a number share the rest, equally or by the pixels that they cover. Of it, the
    surface of the `stage` that is made takes STAGE_LEVELS, or fewer if the others would get too few. Raises
    InputError if that would leave fewer than two levels for a surface.
    """
    used = [surface for surface in surfaces if surface.name in covered]
    levels_of = {surface.name: fixed.get(surface.name, surface.levels) for surface in used}
    room = SURFACE_WORDS - BACKDROP.levels * has_backdrop
    asked = sum(levels for levels in levels_of.values() if levels is not None)
    sharing = [name for name, levels in levels_of.items() if levels is None]
    if stage in sharing:
        sharing.remove(stage)
        left = min(max(room - asked - USEFUL_LEVELS * len(sharing), FEWEST_LEVELS), STAGE_LEVELS)
        levels_of[stage], asked = left, asked + left
    if asked > room or (sharing and (room - asked) // len(sharing) < FEWEST_LEVELS):
        largest = max(levels_of, key=lambda name: levels_of[name] or 0)
        raise InputError(
            f"surface {largest!r}: all levels must be at most {room}, {FEWEST_LEVELS} for each surface"
            f" without a number, not {asked} and {len(sharing)} such; ask for fewer levels"
        )
    if division == "equal":
        shares = [(room - asked) // len(sharing) for _ in sharing]
    else:
        shares = shares_of_words(room - asked, [covered[name] for name in sharing])
    share_of = dict(zip(sharing, shares, strict=True))
    ranges = {}
    first = BACKGROUND + 1
    for name, given in levels_of.items():
        levels = share_of[name] if given is None else given
        ranges[name] = LevelRange(first, levels)
        first += levels
    return ranges


def shares_of_words(words: int, pixels: Sequence[int]) -> list[int]:
    """The words, divided in proportion to the square roots of some numbers of pixels.

    Each share is at least USEFUL_LEVELS, or an equal share if the words do not suffice for that. Shares are
    rounded down; the shares that lost most get a word more until none is left. Ties go to the first.

    >>> shares_of_words(1007, [160_000, 40_000, 100, 0])
    [650, 325, 16, 16]
    """
    if not pixels:
        return []
    fewest = min(USEFUL_LEVELS, words // len(pixels))
    weights = [math.sqrt(count) for count in pixels]
    if not any(weights):
        weights = [1.0] * len(pixels)
    # Give the least share to every row whose part of the words is smaller, until no part is.
    sharing = list(range(len(pixels)))
    while True:
        rest = words - fewest * (len(pixels) - len(sharing))
        total = sum(weights[row] for row in sharing)
        parts = {row: rest * weights[row] / total for row in sharing}
        larger = [row for row in sharing if parts[row] >= fewest]
        if len(larger) == len(sharing):
            break
        sharing = larger
    shares = [fewest] * len(pixels)
    for row, part in parts.items():
        shares[row] = math.floor(part)
    most_lost = sorted(sharing, key=lambda row: shares[row] - parts[row])
    for row in most_lost[: words - sum(shares)]:
        shares[row] += 1
    return shares


def borrowed_words(ranges: Mapping[str, LevelRange], visible: Collection[str], count: int) -> Words:
    """Words to borrow, (count,) uint16, rising, read-only, while the surfaces in `visible` stay visible.

    Words of no surface and of the other surfaces come first. If these do not suffice, words are spread evenly
    over the visible surfaces: no two borrowed words are neighbors unless more than half of all are borrowed,
    and each visible surface keeps at least one. The words of the background and of the screens are never
    borrowed. Raises UsageError if there are not so many words.
    """
    is_free = np.ones(WORDS, bool)
    is_free[[BACKGROUND, *range(SCREENS.first, WORDS)]] = False
    staying = [_words_of(each) for name, each in ranges.items() if name in visible]
    for words in staying:
        is_free[words] = False
    free = np.flatnonzero(is_free)
    if 0 <= count <= len(free):
        return _as_words(free[:count])
    lending = [words for words in staying if len(words) > 1]
    lent = np.sort(np.concatenate([np.empty(0, np.int64), *lending]))
    needed = count - len(free)
    if 2 * needed > len(lent):
        # Some neighbors are both borrowed: keep the lowest level of each surface.
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
    """The raster with each borrowed word replaced by the nearest word of the same surface that stays.

    Ties go to the lower word. `words` may have any shape; the result has the same shape and is read-only. The
    words of a surface that lent all its words stay, because such a surface is not visible.
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
