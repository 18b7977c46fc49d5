"""The display image: the words and lookup table entries that show a picture in the colors of a scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Singles, Words
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.immutable import read_only
from autocolor.lighting.picture import Picture
from autocolor.mapping.bands import DARKEST, Bands, band_entries, bands_by_surface
from autocolor.mapping.colors import entries_at, entries_of
from autocolor.mapping.intensity import mapped_ranges, words_of
from autocolor.mapping.normal_words import (
    NormalLight,
    WordNormals,
    fractions_at_words,
    normal_light,
    spread_of,
    words_at_levels,
    words_of_normals,
)
from autocolor.mapping.ranges import BACKGROUND, SCREEN_COLORS, SCREENS, WORDS, LevelRange, level_ranges
from autocolor.scene.columns import Tier
from autocolor.scene.scene import NORMALS, Scene, check_scene, costs_at_least
from autocolor.scene.surfaces import Surface
from autocolor.visibility.projection import projection
from autocolor.visibility.watkins import numbers_by_line

MAPPING: Final = ("scaling", "mapping", "exposure", "dither")
"""The fields of a scene that its words depend on, besides the picture and the ranges; see `words_of`."""


@dataclass(frozen=True, eq=False)
class DisplayImage:
    """The words and entries for a scene and its picture, and the level range of each surface by name.

    `bands` are those of the surfaces that a scalar colors. Each pixel of the picture is shown as a block of
    `block` x `block` words.

    Where words stand for normals, `normals` are these, and `lit` is the light at them. Then nothing but the
    visible points is taken from the picture, whose intensities may be those of an earlier light.
    """

    scene: Scene
    picture: Picture
    ranges: Mapping[str, LevelRange]
    words: Words
    block: int = 1
    bands: Mapping[str, Bands] = field(default_factory=dict)
    normals: WordNormals | None = None
    lit: NormalLight | None = None

    @property
    def mapped(self) -> Picture:
        """The picture whose intensities are mapped: of the pixels, or of the normals that are seen."""
        return self.picture if self.lit is None else self.lit.at_samples

    @cached_property
    def entries(self) -> Bytes:
        """The complete lookup table, (1024, 3) uint8, read-only."""
        table = np.zeros((WORDS, 3), np.uint8)
        table[BACKGROUND] = self.scene.background
        table[SCREENS.first :] = SCREEN_COLORS
        for name, (first, levels) in self.ranges.items():
            table[first : first + levels] = self.entries_of(self.scene.surface(name))
        if self.lit is not None:
            for name, fractions in self._fractions.items():
                first, levels = self.ranges[name]
                floor = self._shown_floors.get(name, 0.0)
                paint = self.scene.surface(name).paint
                table[first : first + len(fractions)] = entries_at(paint, fractions, levels, floor)
        table.flags.writeable = False
        return table

    @property
    def colors(self) -> Bytes:
        """The color of each pixel, (lines, elements, 3) uint8."""
        colors: Bytes = self.entries[self.words]
        return colors

    def words_at_levels(self, name: str) -> Words:
        """The word that shows each level of a surface in use, from the lowest level up, (levels,) uint16.

        Where words stand for normals, it is the one that comes nearest.
        """
        first, levels = self.ranges[name]
        if name in self._fractions:
            return words_at_levels(first, self._fractions[name], levels)
        return np.arange(first, first + levels, dtype=np.uint16)

    @cached_property
    def _fractions(self) -> Mapping[str, Singles]:
        """The fraction of the range at each word that stands for a normal, by surface name."""
        return {} if self.lit is None else fractions_at_words(self.scene, self.lit)

    def entries_of(self, surface: Surface) -> Bytes:
        """The entries of one surface's levels or bands, (levels, 3) uint8, read-only.

        Where words stand for normals, these are the colors of its paint from the lowest level up.
        """
        has_floor = self.scene.contrast == "floor"
        floor = self._shown_floors.get(surface.name, 0.0)
        scalar, bands = self.scene.scalar, self.bands.get(surface.name)
        if scalar is not None and bands is not None:
            ends = scalar.below if bands.has_below else None, scalar.above if bands.has_above else None
            return band_entries(scalar.scale, ends, scalar.missing, bands, floor if has_floor else DARKEST)
        return entries_of(surface.paint, self.ranges[surface.name].levels, floor)

    @property
    def _shown_floors(self) -> Mapping[str, float]:
        """The floors by surface name; none where the lowest level is black."""
        return self._floors if self.scene.contrast == "floor" else {}

    @cached_property
    def _floors(self) -> Mapping[str, float]:
        """The mapped minimum as a fraction of the maximum, for each visible surface by name."""
        ranges = mapped_ranges(self.mapped, self.scene.scaling, self.scene.exposure)
        return {
            self.picture.surfaces[number - 1]: extent.minimum / extent.maximum if extent.maximum > 0 else 0.0
            for number, extent in ranges.items()
            if number
        }

    def loads_after(self, before: DisplayImage) -> Iterator[tuple[int, Bytes]]:
        """The runs of entries, as (first entry, colors), to load into a table that holds those of `before`.

        When the two images can differ in paints and color scales only, these are the ranges of the surfaces
        with other ones, and neither table is built. Otherwise it is one run from the first to the last entry
        that differs.
        """
        if (
            self.ranges is before.ranges
            and self.normals is before.normals is None
            and self.bands == before.bands
            and self.scene.background == before.scene.background
            and self._has_floors_of(before)
        ):
            befores = {surface.name: surface for surface in before.scene.surfaces}
            has_scale_of_before = self._scale == before._scale
            for surface in self.scene.surfaces:
                name = surface.name
                if name in self.bands:
                    is_same = has_scale_of_before
                else:
                    is_same = name in befores and surface.paint == befores[name].paint
                if name in self.ranges and not is_same:
                    yield self.ranges[name].first, self.entries_of(surface)
            return
        differing = np.flatnonzero((before.entries != self.entries).any(axis=1))
        if len(differing):
            first, last = int(differing[0]), int(differing[-1])
            yield first, self.entries[first : last + 1]

    @property
    def _scale(self) -> tuple[object, ...]:
        """The colors of bands."""
        scalar = self.scene.scalar
        return () if scalar is None else (scalar.scale, scalar.below, scalar.above, scalar.missing)

    def _has_floors_of(self, other: DisplayImage) -> bool:
        """Whether the floors equal those of another image that has the same ranges."""
        if self.scene.contrast != other.scene.contrast:
            return False
        return self.scene.contrast == "stretch" or (
            self.picture is other.picture
            and self.scene.scaling == other.scene.scaling
            and self.scene.exposure == other.scene.exposure
        )


def display_image(
    scene: Scene, picture: Picture, before: DisplayImage | None = None, block: int = 1
) -> DisplayImage:
    """The display image of a scene and its picture, each pixel of which is shown as a block of words.

    Ranges and words are shared with the earlier image `before` where they did not change; the ranges depend
    on the surfaces and on what is visible, not on the light. Those of an earlier image are kept for larger
    blocks, as a coarse picture is soon followed by a finer one. Raises InputError if an intensity is not
    finite.

    The words of a picture without normals, such as one of a file, stand for levels in every scene.
    """
    bands = _bands(scene, picture, before)
    ranges = None if before is None else _kept_ranges(before, scene, picture, bands, block)
    if ranges is None:
        fixed = {name: each.levels for name, each in bands.items()}
        ranges = level_ranges(scene.surfaces, _covered(scene, picture), scene.division, fixed)
        if before is not None and before.ranges == ranges:
            ranges = before.ranges
    if _normals_of(scene, picture) is not None:
        return _image_of_normals(scene, picture, ranges, before, block)
    if (
        before is not None
        and before.normals is None
        and before.picture is picture
        and before.ranges is ranges
        and before.bands == bands
        and all(getattr(before.scene, name) == getattr(scene, name) for name in MAPPING)
    ):
        words = before.words
    else:
        words = words_of(picture, ranges, scene.scaling, scene.mapping, scene.exposure, scene.dither, bands)
        words = _in_blocks(words, block)
    return DisplayImage(scene, picture, ranges, words, block, bands)


def _normals_of(scene: Scene, picture: Picture) -> Singles | None:
    """The normals that words stand for, (3, n); None where they stand for levels."""
    return picture.normals if scene.words == NORMALS else None


def _image_of_normals(
    scene: Scene,
    picture: Picture,
    ranges: Mapping[str, LevelRange],
    before: DisplayImage | None,
    block: int,
) -> DisplayImage:
    """The display image of a picture whose words stand for normals.

    Words and normals are those of an earlier image of the same visible points, whatever lights them.
    """
    if (
        before is not None
        and before.normals is not None
        and before.picture.normals is picture.normals
        and before.ranges is ranges
    ):
        words, normals = before.words, before.normals
    else:
        words, normals = words_of_normals(picture, ranges)
        words = _in_blocks(words, block)
    return DisplayImage(
        scene, picture, ranges, words, block, normals=normals, lit=normal_light(scene, normals)
    )


def _in_blocks(words: Words, block: int) -> Words:
    """Words repeated in both directions, read-only."""
    return words if block == 1 else read_only(words.repeat(block, axis=0).repeat(block, axis=1))


def _bands(scene: Scene, picture: Picture, before: DisplayImage | None) -> Mapping[str, Bands]:
    """The bands of the surfaces that the scalar colors; those of an earlier image if they are the same."""
    is_same_picture = before is not None and before.picture is picture
    if before is not None and is_same_picture and not costs_at_least(before.scene, scene, Tier.LEVELS):
        return before.bands
    return bands_by_surface(scene, picture)


def _kept_ranges(
    before: DisplayImage, scene: Scene, picture: Picture, bands: Mapping[str, Bands], block: int
) -> Mapping[str, LevelRange] | None:
    """The ranges of an earlier image if they are those of the scene, too; None if they must be divided."""
    if {name: each.levels for name, each in bands.items()} != {
        name: each.levels for name, each in before.bands.items()
    }:
        return None
    is_same_sight = before.normals is not None and before.picture.normals is picture.normals
    if block > 1 or is_same_sight:
        return before.ranges if _claims(before.scene) == _claims(scene) else None
    # The ranges of a coarse picture are those of the picture before it, in which other pixels were visible.
    is_divided_anew = before.block > 1 or costs_at_least(before.scene, scene, Tier.LEVELS)
    return None if is_divided_anew else before.ranges


def _claims(scene: Scene) -> tuple[object, ...]:
    """What the ranges depend on, apart from what is visible."""
    used = {scene.parts[number].surface for number in scene.mesh.parts_in_use}
    return (
        scene.division,
        scene.words,
        *((each.name, each.levels) for each in scene.surfaces if each.name in used),
    )


def _covered(scene: Scene, picture: Picture) -> Mapping[str, int]:
    """How many pixels each surface in use covers.

    Where words stand for normals, times how much of the sphere its normals take: a floor needs but one.
    Assumed: so a surface gets levels in proportion to the square root of both.
    """
    covered = {scene.parts[number].surface: 0 for number in scene.mesh.parts_in_use}
    normals = _normals_of(scene, picture)
    for surface in picture.slices:
        count = surface.stop - surface.start
        if normals is not None:
            count *= spread_of(normals[:, surface.pixels])
        covered[picture.surfaces[surface.surface_number - 1]] = count
    return covered


def check_surfaces(scene: Scene, picture: Picture) -> None:
    """Raise InputError if the surfaces of a picture are not those of a scene, in the same order.

    Raises UsageError for anything else than a scene and a picture, such as the two in the wrong order.
    """
    check_scene(scene)
    if not isinstance(picture, Picture):
        raise UsageError(f"a picture must be a Picture, not {shown(picture)}; `render` makes one of a scene")
    names = [surface.name for surface in scene.surfaces]
    if list(picture.surfaces) != names:
        raise InputError(
            f"the surfaces of a picture must be those of the scene, {shown(names)}, not"
            f" {shown(list(picture.surfaces))}; render this scene, or use the scene that was rendered"
        )


# -------------------- scan_lines
# Scan lines: the words of a picture line by line, each found when it is asked for, as in 1983.
#
# Paper: "Introduction", [3, 21]: Watkins' algorithm finishes a line of the raster before it begins the
# next. Departs: only what is visible is found again on each line, by the literal algorithm; the level of
# what is visible comes from the finished picture. The levels of a whole picture cannot be told from its
# first lines: they depend on the least and the largest intensity of each surface.
#
# Measured and rejected: light on each line by itself. Points and normals are the same to the bit, but the
# products of matrices round by the number of points: on the coupe each light differs in the last place at
# 48 to 120 of 213,379 pixels, and a line could have another level than the picture that all else works on.


def words_by_line(image: DisplayImage) -> Iterator[tuple[int, Words]]:
    """The lines of a display image from the top: the line's number, and its words, (1, elements) uint16.

    The words are those of the image, whose levels are of the ranges of its picture or of a held exposure; so
    all lines together are the image to the bit. Measured: a line of the coupe takes 0.7 ms, the slowest 3.
    Raises UsageError for a coarse image.
    """
    if image.block > 1:
        raise UsageError(
            f"an image must have blocks of 1 pixel for its lines, not of {image.block}; refine it first"
        )
    return _lines_of(image)


def _lines_of(image: DisplayImage) -> Iterator[tuple[int, Words]]:
    scene, picture = image.scene, image.picture
    projected = projection(scene.mesh, scene.view, picture.lines, picture.elements)
    for line, numbers in enumerate(numbers_by_line(projected)):
        yield line, np.where(numbers > 0, image.words[line], np.uint16(BACKGROUND))[np.newaxis]
