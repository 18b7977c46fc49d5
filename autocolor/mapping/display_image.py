"""The display image: the words and lookup table entries that show a picture in the colors of a scene.

There are two kinds of images, with the same methods: a `LevelImage`, whose words stand for levels, and a
`normal_words.NormalImage`, whose words stand for normals. `images.display_image` makes the kind that the
scene asks for.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, Final

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import nearest
from autocolor.errors import UsageError
from autocolor.immutable import read_only
from autocolor.lighting.picture import Picture
from autocolor.mapping.bands import DARKEST, Bands, band_entries, bands_by_surface
from autocolor.mapping.colors import entries_of, ramp_entries
from autocolor.mapping.intensity import ranges_of, words_of
from autocolor.mapping.ranges import (
    BACKDROP,
    BACKGROUND,
    SCREEN_COLORS,
    SCREENS,
    WORDS,
    LevelRange,
    level_ranges,
)
from autocolor.scene.columns import Tier
from autocolor.scene.row_kinds import place_named
from autocolor.scene.scene import Scene, costs_at_least
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_points import SurfaceSlice
from autocolor.visibility.watkins import numbers_by_line

MAPPING: Final = ("scaling", "mapping", "exposure", "dither", "has_backdrop")
"""The fields of a scene that its words depend on, besides the picture and the ranges; see `words_of`."""


@dataclass(frozen=True, eq=False)
class DisplayImage(ABC):
    """The words and entries for a scene and its picture, and the level range of each surface by name.

    Each pixel of the picture is shown as a block of `block` x `block` words. `bands` are the bands of the
    surfaces that a scalar colors, by name.
    """

    scene: Scene
    picture: Picture
    ranges: Mapping[str, LevelRange]
    words: Words
    block: int = 1
    bands: Mapping[str, Bands] = field(default_factory=dict)

    meaning: ClassVar[str]
    """What a word stands for: "level" or "normal"."""

    has_light_in_words: ClassVar[bool]
    """Whether the words depend on the light. If not, the intensities of `picture` may be out of date."""

    @property
    @abstractmethod
    def mapped(self) -> Picture:
        """The picture whose intensities are mapped to the ranges."""

    @abstractmethod
    def entries_of(self, name: str) -> Bytes:
        """The entries of the words of one surface, (levels, 3) uint8, read-only. Raises as `range_of`."""

    @abstractmethod
    def words_at_levels(self, name: str) -> Words:
        """The word that shows each level of a surface in use, from the lowest level up, (levels,) uint16."""

    def range_of(self, name: str) -> LevelRange:
        """The range of a surface. Raises UsageError for an unknown surface, and for a surface of no part."""
        if name not in self.ranges:
            place_named(self.scene.surfaces, name)
            raise UsageError(
                f"surface {name!r} has no levels, because no part has it{nearest(name, self.ranges)}"
            )
        return self.ranges[name]

    @property
    def colors(self) -> Bytes:
        """The color of each pixel, (lines, elements, 3) uint8.

        Measured: `take` takes a quarter of the time of indexing.
        """
        return self.entries.take(self.words, axis=0)

    @cached_property
    def entries(self) -> Bytes:
        """The complete lookup table, (1024, 3) uint8, read-only."""
        table = np.zeros((WORDS, 3), np.uint8)
        table[BACKGROUND] = self.scene.background
        table[SCREENS.first :] = SCREEN_COLORS
        if colors := self.scene.backdrop_colors:
            table[BACKDROP.first : BACKDROP.last + 1] = ramp_entries(colors, BACKDROP.levels)
        for name, (first, levels) in self.ranges.items():
            table[first : first + levels] = self.entries_of(name)
        return read_only(table)

    def loads_after(self, before: DisplayImage) -> Iterator[tuple[int, Bytes]]:
        """The runs of entries to load after those of `before`, as (first entry, colors).

        The only run leads from the first to the last entry that differs; if no entry differs, there is no
        run.
        """
        differing = np.flatnonzero((before.entries != self.entries).any(axis=1))
        if len(differing):
            first, last = int(differing[0]), int(differing[-1])
            yield first, self.entries[first : last + 1]

    def floor_of(self, name: str) -> float:
        """The brightness of a surface's lowest level as a fraction of its highest; see `entries_of`.

        It is 0 for a surface that is not visible, and if the scene's lowest levels are black.
        """
        return self._floors.get(name, 0.0) if self.scene.contrast == "floor" else 0.0

    @cached_property
    def _floors(self) -> Mapping[str, float]:
        """The mapped minimum as a fraction of the maximum, for each visible surface by name."""
        ranges = ranges_of(self.scene, self.mapped)
        return {
            self.picture.surfaces[number - 1]: extent.minimum / extent.maximum if extent.maximum > 0 else 0.0
            for number, extent in ranges.items()
            if number
        }


@dataclass(frozen=True, eq=False)
class LevelImage(DisplayImage):
    """A display image whose words stand for levels of intensity, or for bands and their shades."""

    meaning = "level"
    has_light_in_words = True

    @classmethod
    def of(cls, scene: Scene, picture: Picture, before: DisplayImage | None, block: int) -> LevelImage:
        """The image of a scene and its picture.

        Ranges and words are shared with the earlier image `before` where they did not change. Raises
        InputError if an intensity is not finite.
        """
        bands = _bands(scene, picture, before)
        ranges = image_ranges(scene, picture, bands, before, block, lambda each: each.stop - each.start)
        if (
            isinstance(before, LevelImage)
            and before.picture is picture
            and before.ranges is ranges
            and before.bands == bands
            and all(getattr(before.scene, name) == getattr(scene, name) for name in MAPPING)
        ):
            image = cls(scene, picture, ranges, before.words, block, bands)
            # Words and lowest levels depend on the same ranges of intensity.
            if "_floors" in vars(before):
                vars(image)["_floors"] = before._floors
            return image
        words = words_of(picture, ranges, ranges_of(scene, picture), scene.mapping, scene.dither, bands)
        words = with_backdrop(words, scene)
        return cls(scene, picture, ranges, in_blocks(words, block), block, bands)

    @property
    def mapped(self) -> Picture:
        """The picture of the scene itself."""
        return self.picture

    def entries_of(self, name: str) -> Bytes:
        """The entries of a surface's levels or bands, (levels, 3) uint8, read-only. Raises as `range_of`."""
        levels = self.range_of(name).levels
        scalar, bands = self.scene.scalar, self.bands.get(name)
        if scalar is not None and bands is not None:
            ends = scalar.below if bands.has_below else None, scalar.above if bands.has_above else None
            floor = self.floor_of(name) if self.scene.contrast == "floor" else DARKEST
            return band_entries(scalar.scale, ends, scalar.missing, bands, floor)
        return entries_of(self.scene.surfaces[name].paint, levels, self.floor_of(name))

    def words_at_levels(self, name: str) -> Words:
        """The words of the surface's range, (levels,) uint16."""
        first, levels = self.ranges[name]
        return np.arange(first, first + levels, dtype=np.uint16)

    def loads_after(self, before: DisplayImage) -> Iterator[tuple[int, Bytes]]:
        """The runs of entries to load after those of `before`, as (first entry, colors).

        If the two images can differ in paints and color scales only, the runs are the ranges of the surfaces
        whose paint or scale differs, and neither table is built. Otherwise the only run leads from the first
        to the last entry that differs.
        """
        if not (
            isinstance(before, LevelImage)
            and self.ranges is before.ranges
            and self.bands == before.bands
            and self.scene.background == before.scene.background
            and self.scene.backdrop_colors == before.scene.backdrop_colors
            and self._has_floors_of(before)
        ):
            yield from super().loads_after(before)
            return
        befores = {surface.name: surface for surface in before.scene.surfaces}
        has_scale_of_before = self._scale == before._scale
        for surface in self.scene.surfaces:
            name = surface.name
            if name in self.bands:
                is_same = has_scale_of_before
            else:
                is_same = name in befores and surface.paint == befores[name].paint
            if name in self.ranges and not is_same:
                yield self.ranges[name].first, self.entries_of(name)

    @property
    def _scale(self) -> tuple[object, ...]:
        """The colors of bands."""
        scalar = self.scene.scalar
        return () if scalar is None else (scalar.scale, scalar.below, scalar.above, scalar.missing)

    def _has_floors_of(self, other: LevelImage) -> bool:
        """Whether the floors equal the floors of another image that has the same ranges."""
        if self.scene.contrast != other.scene.contrast:
            return False
        return self.scene.contrast == "stretch" or (
            self.picture is other.picture
            and self.scene.scaling == other.scene.scaling
            and self.scene.exposure == other.scene.exposure
        )


def _bands(scene: Scene, picture: Picture, before: DisplayImage | None) -> Mapping[str, Bands]:
    """The bands of the surfaces that the scalar colors; shared with an earlier image if they are the same."""
    is_same_picture = before is not None and before.picture is picture
    if before is not None and is_same_picture and not costs_at_least(before.scene, scene, Tier.LEVELS):
        return before.bands
    return bands_by_surface(scene, picture)


def image_ranges(
    scene: Scene,
    picture: Picture,
    bands: Mapping[str, Bands],
    before: DisplayImage | None,
    block: int,
    size_of: Callable[[SurfaceSlice], int],
) -> Mapping[str, LevelRange]:
    """The ranges of an image by surface name; those of the earlier image `before` if they are the same.

    Ranges depend on the surfaces and on the visible pixels, not on the light. The words are divided by the
    `size_of` each visible surface. Larger blocks keep the ranges of the earlier image, because a coarse
    picture is soon followed by a finer picture.
    """
    levels = {name: each.levels for name, each in bands.items()}
    if before is not None and levels == {name: each.levels for name, each in before.bands.items()}:
        has_same_normals = picture.normals is not None and before.picture.normals is picture.normals
        if block > 1 or has_same_normals:
            is_same = _claims(before.scene) == _claims(scene)
        else:
            # A coarse picture has the ranges of the picture before it, in which other pixels were visible.
            is_same = before.block == 1 and not costs_at_least(before.scene, scene, Tier.LEVELS)
        if is_same:
            return before.ranges
    seen = scene.staged
    sizes = {seen.parts[number].surface: 0 for number in seen.mesh.parts_in_use}
    for surface in picture.slices:
        sizes[picture.surfaces[surface.surface_number - 1]] = size_of(surface)
    stage, has_backdrop = scene.stage_surface, scene.has_backdrop
    ranges = level_ranges(
        scene.surfaces, sizes, scene.division, levels, stage=stage, has_backdrop=has_backdrop
    )
    return before.ranges if before is not None and before.ranges == ranges else ranges


def _claims(scene: Scene) -> tuple[object, ...]:
    """The columns that the ranges depend on, besides the visible pixels."""
    seen = scene.staged
    used = {seen.parts[number].surface for number in seen.mesh.parts_in_use}
    return (
        scene.division,
        scene.words,
        scene.has_backdrop,
        *((each.name, each.levels) for each in scene.surfaces if each.name in used),
    )


def with_backdrop(words: Words, scene: Scene) -> Words:
    """The words, (lines, elements), with those of the backdrop where nothing is visible, if there is one."""
    if not scene.has_backdrop:
        return words
    down = BACKDROP.first + np.arange(len(words)) * BACKDROP.levels // len(words)
    return read_only(np.where(words == BACKGROUND, down[:, None].astype(np.uint16), words))


def in_blocks(words: Words, block: int) -> Words:
    """Words repeated in both directions, read-only."""
    return words if block == 1 else read_only(words.repeat(block, axis=0).repeat(block, axis=1))


def words_by_line(image: DisplayImage) -> Iterator[tuple[int, Words]]:
    """The lines of a display image from the top: the line's number, and its words, (1, elements) uint16.

    Paper: "Introduction", [3, 21]: Watkins' algorithm finishes a line of the raster before it begins the
    next. Departs: the words of a line come from the finished image, and the literal algorithm only finds what
    is visible on the line. So all lines together are the image to the bit: the levels of a line depend on the
    least and the largest intensity of each surface in the whole picture.

    Measured: a line of the coupe takes 0.7 ms, the slowest 3. Measured and rejected: light on each line by
    itself. Points and normals are the same to the bit, but the products of matrices round by the number of
    points: on the coupe each light differs in the last place at 48 to 120 of 213,379 pixels.

    Raises UsageError for a coarse image.
    """
    if image.block > 1:
        raise UsageError(
            f"an image must have blocks of 1 pixel for its lines, not of {image.block}; refine it first"
        )
    return _lines_of(image)


def _lines_of(image: DisplayImage) -> Iterator[tuple[int, Words]]:
    scene, picture = image.scene, image.picture
    mesh = scene.staged.mesh
    projected = projection(mesh, scene.view, picture.lines, picture.elements, scene.interpolation)
    empty = with_backdrop(np.full((picture.lines, 1), BACKGROUND, np.uint16), scene)
    for line, numbers in enumerate(numbers_by_line(projected)):
        yield line, np.where(numbers > 0, image.words[line], empty[line])[np.newaxis]
