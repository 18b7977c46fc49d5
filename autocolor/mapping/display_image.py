"""What a display holds of a scene and its picture: words, entries, and which of them are whose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.lighting.picture import Picture
from autocolor.mapping.color_blending import entries_of
from autocolor.mapping.intensity_mapping import words_of
from autocolor.mapping.level_ranges import BACKGROUND, SCREEN_COLORS, SCREENS, WORDS, LevelRange, level_ranges
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface

DIVIDING: Final = ("mesh", "parts", "surfaces")
"""The fields of a scene that divide the words among its surfaces."""


@dataclass(frozen=True, eq=False)
class Shown:
    """The words and the entries of a scene with its picture, and the range of each surface."""

    scene: Scene
    picture: Picture
    ranges: Mapping[str, LevelRange]
    words: Words

    @cached_property
    def entries(self) -> Bytes:
        """The whole lookup table, (1024, 3) uint8, read-only."""
        table = np.zeros((WORDS, 3), np.uint8)
        table[BACKGROUND] = self.scene.background
        table[SCREENS.first :] = SCREEN_COLORS
        for name, (first, levels) in self.ranges.items():
            table[first : first + levels] = self.entries_of(self.scene.surface(name))
        table.flags.writeable = False
        return table

    def entries_of(self, surface: Surface) -> Bytes:
        """The entries of the range of a surface, (levels, 3) uint8, read-only."""
        floor = _floor(self.scene, self.picture, surface.name) if self.scene.contrast == "floor" else 0.0
        return entries_of(surface.paint, self.ranges[surface.name].levels, floor)

    def has_entries_of(self, other: Shown) -> bool:
        """Whether the entries are those of another for sure, as can be told without making them."""
        mine, others = self.scene, other.scene
        return (
            self.ranges is other.ranges
            and mine.surfaces is others.surfaces
            and mine.background == others.background
            and mine.contrast == others.contrast == "stretch"
        )


def shown(scene: Scene, picture: Picture, before: Shown | None = None) -> Shown:
    """What a display holds of a scene with its picture; `before` lends the words if they did not change."""
    if before is not None and all(getattr(before.scene, name) is getattr(scene, name) for name in DIVIDING):
        ranges = before.ranges
    else:
        in_use = {scene.parts[number].surface for number in scene.mesh.parts_in_use}
        ranges = level_ranges(scene.surfaces, in_use)
    if (
        before is not None
        and before.picture is picture
        and before.ranges == ranges
        and before.scene.scaling == scene.scaling
        and before.scene.mapping == scene.mapping
    ):
        words = before.words
    else:
        words = words_of(picture, ranges, scene.scaling, scene.mapping)
    return Shown(scene, picture, ranges, words)


def _floor(scene: Scene, picture: Picture, name: str) -> float:
    """The minimum as a fraction of the maximum, of the surface or of the whole object."""
    number = 0 if scene.scaling == "object" else picture.surfaces.index(name) + 1
    extent = picture.relative_ranges.get(number)
    return extent.minimum / extent.maximum if extent is not None and extent.maximum > 0 else 0.0
