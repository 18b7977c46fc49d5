"""Words that stand for normals, and their entries.

Paper: reference 2, D. H. Bass, 1981, "Using the video lookup table for reflectivity calculations": the frame
buffer holds quantized normals, and the table the light that they reflect. Each surface has its level range as
ever, but its words stand for normals instead of levels:

    word = first + number of the normal's cell

The intensity at a word's normal is mapped to a fraction of the range as ever, and the word's entry is the
color that the paint has there. Assumed: the range that is mapped is the range of the bins of visible normals,
which are finer than the words. With the range of the words in use, a whole surface would become brighter and
darker while a narrow highlight moves between the normals of its words.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import (
    Bytes,
    Floats,
    Indices,
    Real,
    RealArray,
    Singles,
    Words,
    chunks,
    dot,
    normalized,
    underflowing,
)
from autocolor.checks import Vector
from autocolor.immutable import read_only
from autocolor.lighting.illumination import illuminate
from autocolor.lighting.picture import Picture
from autocolor.lighting.rays import direction_to_eye, direction_to_light, middle_of
from autocolor.mapping.colors import entries_at, entries_of
from autocolor.mapping.display_image import DisplayImage, image_ranges, in_blocks, with_backdrop
from autocolor.mapping.intensity import fractions_by_surface, ranges_of
from autocolor.mapping.ranges import BACKGROUND, WORDS, LevelRange
from autocolor.scene.columns import with_values
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import (
    NORMAL,
    REFLECTED_VIEW,
    ROW_COUNT,
    SurfaceSlice,
    VisibleParts,
    VisiblePoints,
    surface_slices,
)


@dataclass(frozen=True, eq=False)
class NormalImage(DisplayImage):
    """A display image whose words stand for normals; a light changes entries alone.

    Only the visible points of the picture count; its intensities may be out of date. `normals` are the
    normals that the words stand for, and `lit` is the light of the scene at them.
    """

    normals: WordNormals = field(kw_only=True)
    lit: NormalLight = field(kw_only=True)

    meaning = "normal"
    has_light_in_words = False

    @classmethod
    def of(cls, scene: Scene, picture: Picture, before: DisplayImage | None, block: int) -> NormalImage:
        """The image of a scene and its picture, which has normals.

        Words and normals are shared with an earlier image of the same visible points, whatever lights them.
        Raises InputError for intensities that float32 can't hold.
        """
        assert picture.normals is not None
        visible = picture.normals

        def size(surface: SurfaceSlice) -> int:
            # A floor needs few words, as all its normals are alike. Assumed: so a surface gets words in
            # proportion to the square roots of its pixels and of the part of the sphere its normals take.
            return (surface.stop - surface.start) * spread_of(visible[:, surface.pixels])

        ranges = image_ranges(scene, picture, {}, before, block, size)
        if (
            isinstance(before, NormalImage)
            and before.picture.normals is picture.normals
            and before.ranges is ranges
            and before.scene.has_backdrop == scene.has_backdrop
        ):
            words, normals = before.words, before.normals
        else:
            words, normals = words_of_normals(picture, ranges)
            words = in_blocks(with_backdrop(words, scene), block)
        lit = normal_light(scene, normals)
        return cls(scene, picture, ranges, words, block, normals=normals, lit=lit)

    @property
    def mapped(self) -> Picture:
        """The light at the visible normals, which are more than the words."""
        return self.lit.at_samples

    def entries_of(self, name: str) -> Bytes:
        """The entries of one surface's words, (levels, 3) uint8, read-only. Raises as `range_of`.

        Words that stand for no normal have the color of their level.
        """
        levels, floor = self.range_of(name).levels, self.floor_of(name)
        paint = self.scene.surfaces[name].paint
        entries = entries_of(paint, levels, floor)
        if name not in self._fractions:
            return entries
        at_normals = entries_at(paint, self._fractions[name], levels, floor)
        return read_only(np.concatenate([at_normals, entries[len(at_normals) :]]))

    def words_at_levels(self, name: str) -> Words:
        """The word that comes nearest to each level of a surface in use, (levels,) uint16."""
        first, levels = self.ranges[name]
        if name not in self._fractions:
            return np.arange(first, first + levels, dtype=np.uint16)
        return words_at_levels(first, self._fractions[name], levels)

    @cached_property
    def _fractions(self) -> Mapping[str, Singles]:
        """The fraction of the range at each word that stands for a normal, by surface name."""
        return fractions_at_words(self.scene, self.lit)


class WordNormals(NamedTuple):
    """The words in use, (n,), sorted by surface as `slices` tells, and their normals, (3, n), read-only.

    `samples`, (3, m), sorted by surface as `sample_slices` tells, are the normals of bins, which are more
    than the words, and `sample_counts`, (m,), the pixels of each. All are unit vectors in camera space.
    """

    words: Indices
    normals: Singles
    slices: tuple[SurfaceSlice, ...]
    samples: Singles
    sample_slices: tuple[SurfaceSlice, ...]
    sample_counts: Indices


class NormalLight(NamedTuple):
    """The light of a scene at normals: pictures of one line.

    The elements of `at_words` are words. The elements of `at_samples` are samples, whose range is mapped.
    """

    at_words: Picture
    at_samples: Picture


def words_of_normals(picture: Picture, ranges: Mapping[str, LevelRange]) -> tuple[Words, WordNormals]:
    """The words of a picture that has normals, (lines, elements) uint16, read-only, and what they stand for.

    The normals of each visible surface are divided into as many cells as its range has words, or fewer;
    BACKGROUND is where nothing is visible.
    """
    assert picture.normals is not None
    raster = np.full(picture.lines * picture.elements, BACKGROUND, np.uint16)
    words, cells = [np.empty(0, np.intp)], dict[int, Cells]()
    for surface in picture.slices:
        first, levels = ranges[picture.surfaces[surface.surface_number - 1]]
        found = cells[surface.surface_number] = cells_of(picture.normals[:, surface.pixels], levels)
        raster[picture.pixels[surface.pixels]] = first + found.numbers
        words.append(np.arange(first, first + found.normals.shape[1]))
    nothing = cells_of(np.empty((3, 0), np.float32), 1)
    normals, _, samples, counts = zip(nothing, *cells.values(), strict=True)

    def slices_of(rows: Sequence[Singles]) -> tuple[SurfaceSlice, ...]:
        sizes = [each.shape[1] for each in rows[1:]]
        return surface_slices(np.bincount(np.array([*cells], np.intp), sizes, minlength=1).astype(np.int64))

    stand_for = WordNormals(
        read_only(np.concatenate(words)),
        read_only(np.concatenate(normals, axis=1)),
        slices_of(normals),
        read_only(np.concatenate(samples, axis=1)),
        slices_of(samples),
        read_only(np.concatenate(counts)),
    )
    return read_only(raster).reshape(picture.lines, picture.elements), stand_for


def normal_light(scene: Scene, stand_for: WordNormals) -> NormalLight:
    """The light of a scene at the normals of words, and at the samples.

    Raises InputError for intensities that float32 can't hold.
    """
    count = stand_for.samples.shape[1]
    samples = light_at_normals(scene, stand_for.samples, stand_for.sample_slices, np.arange(count), count)
    return NormalLight(
        light_at_normals(scene, stand_for.normals, stand_for.slices, stand_for.words, WORDS),
        replace(samples, counts=stand_for.sample_counts),
    )


def fractions_at_words(scene: Scene, lit: NormalLight) -> Mapping[str, Singles]:
    """The fraction of the range, 0 to 1, at each word in use of each visible surface, by name."""
    extents = ranges_of(scene, lit.at_samples)
    fractions_of = fractions_by_surface(lit.at_samples, extents, scene.mapping)
    fractions = {}
    for each in lit.at_words.slices:
        # A word may be nearer to a highlight than any sample.
        low, high = map(np.float32, extents[each.surface_number])
        intensities = lit.at_words.relative[each.pixels].clip(low, high)
        name = scene.surfaces[each.surface_number - 1].name
        fractions[name] = fractions_of[each.surface_number](intensities)
    return fractions


def words_at_levels(first: int, fractions: Singles, levels: int) -> Words:
    """For each level of a range, the word whose fraction is nearest to that of the level, (levels,) uint16.

    `fractions` are the fractions of the words from `first` on.
    """
    order = np.argsort(fractions, kind="stable")
    between = (fractions[order[1:]] + fractions[order[:-1]]) / 2
    nearest = np.searchsorted(between, np.arange(levels) / (levels - 1))
    return read_only((first + order[nearest]).astype(np.uint16))


# The light at normals.
#
# Paper: reference 2: the light that is reflected is a function of the normal where light and eye are far from
# the object. Assumed: the direction to a light, and to the eye, starts in the middle of the object; the
# direction of a light at infinity is its axis. A normal does not tell the place of a point. So light controls
# and links to parts are left out, because they depend on the place. All else is as in the picture: strengths,
# links to surfaces, reflection models, the ambient light.


@underflowing
def light_at_normals(
    scene: Scene, normals: Singles, slices: tuple[SurfaceSlice, ...], numbers: Indices, count: int
) -> Picture:
    """A picture of one line of `count` elements, in which the light of a scene falls on some normals.

    `normals` are unit vectors in camera space, (3, n) float32, sorted by surface as `slices` tells, and
    `numbers`, (n,), are their elements. All normals are at one point, the middle of the object, and each
    light is in its direction at a distance of 1: so `illuminate` computes the reflected light. A light at the
    middle itself gives nothing. Raises InputError for intensities that float32 can't hold.
    """
    nothing = np.empty(0, np.intp)
    middle = middle_of(scene)
    view = scene.view.replace(eye=(0.0, 0.0, 0.0), direction=tuple(scene.view.axes[2].tolist()))
    to_eye = direction_to_eye(scene).astype(np.float32)[:, None]
    rows = np.zeros((ROW_COUNT, normals.shape[1]), np.float32)
    rows[NORMAL] = normals
    rows[REFLECTED_VIEW] = 2 * dot(normals, to_eye) * normals - to_eye
    points = VisiblePoints(
        view=view,
        lines=1,
        elements=count,
        unit=1.0,
        origin=np.zeros(3),
        pixels=numbers,
        slices=slices,
        span_polygons=nothing,
        span_lengths=nothing,
        parts=VisibleParts((), nothing, nothing, nothing),
        rows=rows,
    )
    lights = tuple(far_light(light, middle) for light in scene.lights_in_world)
    far_scene = with_values(scene, {"view": view, "lights": lights})
    return illuminate(far_scene, points)


def far_light(light: Light, middle: Vector) -> Light:
    """A light of the world as a point source at a distance of 1 from the origin, in its direction.

    Of its controls, the links to surfaces stay.
    """
    links = with_values(light.links, {"only_parts": None, "except_parts": None})
    return Light(light.name, direction_to_light(light, middle), light.intensity, light.on, links=links)


# Cells. The visible normals of a surface are divided into few cells, each with one normal that stands for it.
# The sphere of normals is laid out flat around the direction to the eye, by Lambert's azimuthal map, which
# keeps areas, and divided into bins. Seeds are spread over the bins that are seen, along a curve that fills
# the plane; each bin joins the nearest seed, and the seeds move to the middle of their bins a few times (S.
# Lloyd, 1982, "Least squares quantization in PCM").
#
# Measured: 26 ms for a ball of 137,000 pixels and 1,007 normals; `python -m benchmarks normals` measures its
# errors. On the hood of a coupe that is seen from far away, the mean error is 7.9 of 255 with 143 cells.
# Measured and rejected: bins that weigh the square roots of their pixels and are never divided. A ball has
# the same mean error, but the hood 53 cells and 12.0. With bins that are divided twice it has 7.5.

BINS: Final = 128
"""Bins along the longer side of what a surface shows of the flat sphere; a power of two, at most 128."""

QUARTERS: Final = 4 * BINS * BINS

MOST_OF_CELL: Final = 1 / 4
"""Assumed: a bin with more than this part of the pixels of a mean cell is divided into quarters."""

LEAST_SIDE: Final = 1e-3
"""Assumed: a surface whose normals differ by less than this, in radians, is flat; one bin holds them."""

LEAST_FACING: Final = 1e-6
"""The least 1 - z. It is less only if a normal points straight away from the eye.

Such a normal falls into the bin of normals straight to the eye."""

STEPS: Final = 3
"""How often the seeds move; measured: more change the mean error by less than a fiftieth."""

RADIUS: Final = math.sqrt(2.0)
"""The radius of the flat sphere. The half that is turned to the eye is a disk of radius 1."""

BINS_AT_ONCE: Final = 1 << 11


class Cells(NamedTuple):
    """Some normals, (3, cells) float32, and for each of the given normals the number of its cell.

    `samples`, (3, bins) float32, are the normals of the bins, which are finer, and `counts` the given normals
    in each bin.
    """

    normals: Singles
    numbers: Indices
    samples: Singles
    counts: Indices


def cells_of(normals: Singles, most: int) -> Cells:
    """At most `most` cells of unit normals in camera space, (3, n) float32; each holds at least one of them.

    The normal of a cell is the normalized mean of its normals; zero only if they cancel. Assumed: the weight
    of a bin is the number of its pixels, so that a cell is small where the picture shows it large.
    """
    places = _bin_places(normals, most)
    counts = np.bincount(places, minlength=QUARTERS)
    used = np.flatnonzero(counts)
    bins = (np.cumsum(counts > 0) - 1)[places]
    # Sum the normals of each bin once. All other steps work on bins, which are far fewer.
    sums = _sums(normals, bins, len(used))
    middles = read_only(normalized(sums).astype(np.float32))
    if len(used) <= most:
        return Cells(middles, read_only(bins), middles, counts[used])
    weights = counts[used].astype(np.float64)
    cell_of_bin = _cell_of_bin(middles, _seeds(middles, weights, most), weights)
    # A seed that is nearest to no bin is no cell.
    is_cell = np.bincount(cell_of_bin) > 0
    cell_of_bin = (np.cumsum(is_cell) - 1)[cell_of_bin]
    cells = normalized(_sums(sums, cell_of_bin, int(np.count_nonzero(is_cell)))).astype(np.float32)
    return Cells(read_only(cells), read_only(cell_of_bin[bins]), middles, counts[used])


def spread_of(normals: Singles) -> int:
    """The part of the sphere that some unit normals take: the number of their bins, of BINS x BINS."""
    on_sphere = (_flat(normals) + np.float32(RADIUS)) * np.float32(BINS / (2 * RADIUS))
    columns, rows = np.minimum(on_sphere.astype(np.intp), BINS - 1)
    return int(np.count_nonzero(np.bincount(columns * BINS + rows)))


def _bin_places(normals: Singles, cells: int) -> Indices:
    """The place of each normal's bin on a curve that fills the plane (G. Morton, 1966), below QUARTERS, (n,).

    The bins are squares, as many as BINS along the longer side of the rectangle that holds all normals. A bin
    with many pixels is divided into quarters, or a nearly flat hood would have no more cells than bins.
    """
    flat = _flat(normals)
    low = flat.min(axis=1, initial=RADIUS)
    side = float((flat.max(axis=1, initial=-RADIUS) - low).max())
    if side < LEAST_SIDE:
        return np.zeros(normals.shape[1], np.intp)
    flat -= low[:, None]
    flat *= np.float32(2 * BINS / side)
    columns, rows = np.minimum(flat.astype(np.intp), 2 * BINS - 1)
    interleaved = _spread_bits(np.arange(2 * BINS))
    quarters = interleaved[columns] << 1 | interleaved[rows]
    bins = quarters >> 2
    is_divided = np.bincount(bins, minlength=BINS * BINS) > MOST_OF_CELL * len(bins) / cells
    # The last two bits of a place are those of its quarter.
    places: Indices = quarters & np.where(is_divided, ~0, ~3)[bins]
    return places


def _flat(normals: Singles) -> Singles:
    """The places of unit normals on the flat sphere, (2, n), at most RADIUS from the middle."""
    # In camera space the eye is where z is negative.
    flat: Singles = normals[:2] / np.sqrt(np.maximum(1 - normals[2], np.float32(LEAST_FACING)))
    return flat


def _spread_bits(numbers: Indices) -> Indices:
    """Numbers below 2^8 with a 0 before each of their bits."""
    spread = numbers
    for shift, mask in ((4, 0x0F0F), (2, 0x3333), (1, 0x5555)):
        spread = (spread | spread << shift) & mask
    return spread


def _seeds(middles: Singles, weights: Floats, count: int) -> Singles:
    """At most `count` of the bins' normals, evenly spaced along the curve by the weight of the bins."""
    passed = np.cumsum(weights)
    steps = (np.arange(count) + 0.5) * (passed[-1] / count)
    # Several steps may fall into a heavy bin.
    is_chosen = np.bincount(np.searchsorted(passed, steps), minlength=len(passed)) > 0
    return middles[:, is_chosen[: len(passed)]]


def _cell_of_bin(middles: Singles, seeds: Singles, weights: Floats) -> Indices:
    """The number of the seed that is nearest to each bin, after the seeds have moved."""
    weighted = middles * weights
    for _ in range(STEPS):
        moved = normalized(_sums(weighted, _nearest(middles, seeds), seeds.shape[1])).astype(np.float32)
        # A seed that is nearest to no bin stays.
        seeds = np.where(moved.any(axis=0), moved, seeds)
    return _nearest(middles, seeds)


def _nearest(normals: Singles, seeds: Singles) -> Indices:
    """The number of the seed at the smallest angle to each normal."""
    nearest = np.empty(normals.shape[1], np.intp)
    for chunk in chunks(len(nearest), BINS_AT_ONCE):
        # Rows of seeds let numpy search the largest product along memory.
        nearest[chunk] = (normals[:, chunk].T @ seeds).argmax(axis=1)
    return nearest


def _sums(vectors: RealArray[Real], numbers: Indices, count: int) -> Floats:
    """The sum of the vectors, (3, n), of each number below `count`, (3, count); zero for none."""
    sums = [np.bincount(numbers, axis, minlength=count) for axis in vectors]
    # Of no numbers, numpy counts in integers.
    return np.stack(sums, dtype=np.float64)
