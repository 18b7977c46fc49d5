"""Level ranges: the words that each surface owns.

Paper: "Light Source Color Blending", Figure 11: the intensities of each surface type are mapped to a separate
sequential range of the lookup table. Assumed: word 0 is the background, the sixteen highest
words belong to the interactive screens, and the words between are divided equally among the surfaces in use,
in table order.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final, NamedTuple

from autocolor.errors import InputError
from autocolor.scene.surfaces import Surface

WORDS: Final = 1024
BACKGROUND: Final = 0
SCREEN_LEVELS: Final = 16
FEWEST_LEVELS: Final = 2


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

SCREEN_COLORS: Final = (
    (0, 0, 0), (255, 255, 255), (192, 192, 192), (128, 128, 128), (72, 76, 84), (36, 39, 46),
    (255, 214, 90), (255, 140, 60), (235, 70, 70), (110, 200, 110), (90, 170, 240), (170, 130, 230),
    (120, 220, 220), (240, 150, 190), (150, 110, 70), (210, 225, 160),
)  # fmt: skip
"""Assumed: the colors of the screens' words, which do not depend on the scene."""


def level_ranges(surfaces: Sequence[Surface], in_use: Collection[str]) -> Mapping[str, LevelRange]:
    """The level range of each surface in use, by name.

    A surface gets the number of levels that it asks for; the others share the rest equally. Raises InputError
    if that would leave fewer than two levels for one of them.
    """
    used = [surface for surface in surfaces if surface.name in in_use]
    room = SCREENS.first - BACKGROUND - 1
    asked = sum(surface.levels for surface in used if surface.levels is not None)
    sharing = sum(1 for surface in used if surface.levels is None)
    share = (room - asked) // sharing if sharing else 0
    if asked > room or (sharing and share < FEWEST_LEVELS):
        largest = max(
            (surface for surface in used if surface.levels), key=lambda surface: surface.levels or 0
        )
        raise InputError(
            f"surface {largest.name!r}: the levels must be at most {room} in all, {FEWEST_LEVELS} of them for"
            f" each surface that asks for none, not {asked} and {sharing} such surfaces; ask for fewer levels"
        )
    ranges = {}
    first = BACKGROUND + 1
    for surface in used:
        levels = share if surface.levels is None else surface.levels
        ranges[surface.name] = LevelRange(first, levels)
        first += levels
    return ranges
