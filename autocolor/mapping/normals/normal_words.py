"""Words that stand for normals, and their entries.

Paper: reference 2, D. H. Bass, 1981: the frame buffer holds quantized normals, and the table what they
reflect. Each surface has its level range as ever; its words stand for normals instead of levels:

    word = first + number of the normal's cell

A word's intensity is mapped to a fraction of the range as ever, and its entry is the color that the paint has
there. Assumed: the range that is mapped is that of the bins of normals that are seen, which are finer than
the words. Measured and rejected: the range of the words in use. A narrow highlight falls between the normals
of words, now nearer to one and then farther, and the whole surface would become brighter and darker with
that as a light moves: for N = 100 the mean error on a ball is up to 10 of 255 instead of 3.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from autocolor.arrays import Indices, Singles, Words
from autocolor.immutable import read_only
from autocolor.lighting.picture import Picture
from autocolor.mapping.exposure import mapped_ranges
from autocolor.mapping.intensity_mapping import fractions_by_surface
from autocolor.mapping.level_ranges import BACKGROUND, WORDS, LevelRange
from autocolor.mapping.normals.cells import cells_of
from autocolor.mapping.normals.far_light import light_at_normals
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import SurfaceSlice


class WordNormals(NamedTuple):
    """The words in use, (n,), sorted by surface as `slices` tells, and their normals, (3, n), read-only.

    `samples`, (3, m), sorted by surface as `sample_slices` tells, are normals that are seen, more of them
    than words. All are unit vectors in camera space.
    """

    words: Indices
    normals: Singles
    slices: tuple[SurfaceSlice, ...]
    samples: Singles
    sample_slices: tuple[SurfaceSlice, ...]


class NormalLight(NamedTuple):
    """The light of a scene at normals: pictures of one line.

    The elements of `at_words` are words; those of `at_samples` are the samples, whose range is mapped.
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
    nothing = np.empty((3, 0), np.float32)
    words, normals, samples = [np.empty(0, np.intp)], [nothing], [nothing]
    slices, sample_slices = [], []
    start = sample_start = 0
    for surface in picture.slices:
        first, levels = ranges[picture.surfaces[surface.surface_number - 1]]
        cells = cells_of(picture.normals[:, surface.pixels], levels)
        number, count = surface.surface_number, cells.normals.shape[1]
        raster[picture.pixels[surface.pixels]] = first + cells.numbers
        words.append(np.arange(first, first + count))
        normals.append(cells.normals)
        samples.append(cells.samples)
        slices.append(SurfaceSlice(number, start, start + count))
        start += count
        sample_slices.append(SurfaceSlice(number, sample_start, sample_start + cells.samples.shape[1]))
        sample_start = sample_slices[-1].stop
    stand_for = WordNormals(
        read_only(np.concatenate(words)),
        read_only(np.concatenate(normals, axis=1)),
        tuple(slices),
        read_only(np.concatenate(samples, axis=1)),
        tuple(sample_slices),
    )
    return read_only(raster).reshape(picture.lines, picture.elements), stand_for


def normal_light(scene: Scene, stand_for: WordNormals) -> NormalLight:
    """The light of a scene at the normals of words, and at the samples.

    Raises InputError for intensities that float32 can't hold.
    """
    count = stand_for.samples.shape[1]
    return NormalLight(
        light_at_normals(scene, stand_for.normals, stand_for.slices, stand_for.words, WORDS),
        light_at_normals(scene, stand_for.samples, stand_for.sample_slices, np.arange(count), count),
    )


def fractions_at_words(scene: Scene, lit: NormalLight) -> Mapping[str, Singles]:
    """The fraction of the range, 0 to 1, at each word in use of each visible surface, by name."""
    extents = mapped_ranges(lit.at_samples, scene.scaling, scene.exposure)
    fractions_of = fractions_by_surface(lit.at_samples, extents, scene.mapping)
    found = {}
    for each in lit.at_words.slices:
        # A word may be nearer to a highlight than any sample.
        low, high = map(np.float32, extents[each.surface_number])
        intensities = lit.at_words.relative[each.pixels].clip(low, high)
        name = scene.surfaces[each.surface_number - 1].name
        found[name] = fractions_of[each.surface_number](intensities)
    return found


def words_at_levels(first: int, fractions: Singles, levels: int) -> Words:
    """For each level of a range, the word whose fraction is nearest to that of the level, (levels,) uint16.

    `fractions` are those of the words from `first` on.
    """
    order = np.argsort(fractions, kind="stable")
    between = (fractions[order[1:]] + fractions[order[:-1]]) / 2
    nearest = np.searchsorted(between, np.arange(levels) / (levels - 1))
    return read_only((first + order[nearest]).astype(np.uint16))
