"""Words that stand for normals, and their entries.

Paper: reference 2, D. H. Bass, 1981: the frame buffer holds quantized normals, and the table what they
reflect. Each surface has its level range as ever; its words stand for normals instead of levels:

    word = first + number of the normal's cell

A word's intensity is mapped to a fraction of the range as ever, and its entry is the color that the paint has
there. Assumed: the range of intensities that is mapped is that of the words in use, one each, however many
pixels they cover.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Indices, Singles, Words
from autocolor.immutable import read_only
from autocolor.lighting.picture import Picture
from autocolor.mapping.color_blending import entries_at
from autocolor.mapping.exposure import mapped_ranges
from autocolor.mapping.intensity_mapping import fractions_by_surface
from autocolor.mapping.level_ranges import BACKGROUND, WORDS, LevelRange
from autocolor.mapping.normals.cells import cells_of
from autocolor.mapping.normals.far_light import light_at_normals
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import SurfaceSlice


class WordNormals(NamedTuple):
    """The words in use, (n,), sorted by surface as `slices` tells, and their normals, (3, n), read-only.

    The normals are unit vectors in camera space.
    """

    words: Indices
    normals: Singles
    slices: tuple[SurfaceSlice, ...]


def words_of_normals(picture: Picture, ranges: Mapping[str, LevelRange]) -> tuple[Words, WordNormals]:
    """The words of a picture that has normals, (lines, elements) uint16, read-only, and what they stand for.

    The normals of each visible surface are divided into as many cells as its range has words, or fewer;
    BACKGROUND is where nothing is visible.
    """
    assert picture.normals is not None
    raster = np.full(picture.lines * picture.elements, BACKGROUND, np.uint16)
    words, normals = [np.empty(0, np.intp)], [np.empty((3, 0), np.float32)]
    slices = []
    start = 0
    for surface in picture.slices:
        first, levels = ranges[picture.surfaces[surface.surface_number - 1]]
        cells = cells_of(picture.normals[:, surface.pixels], levels)
        count = cells.normals.shape[1]
        raster[picture.pixels[surface.pixels]] = first + cells.numbers
        words.append(np.arange(first, first + count))
        normals.append(cells.normals)
        slices.append(SurfaceSlice(surface.surface_number, start, start + count))
        start += count
    stand_for = WordNormals(
        read_only(np.concatenate(words)), read_only(np.concatenate(normals, axis=1)), tuple(slices)
    )
    return read_only(raster).reshape(picture.lines, picture.elements), stand_for


def light_at_words(scene: Scene, stand_for: WordNormals) -> Picture:
    """The light of a scene at the normal of each word: a picture of one line, whose elements are words.

    Raises InputError for intensities that float32 can't hold.
    """
    return light_at_normals(scene, stand_for.normals, stand_for.slices, stand_for.words, WORDS)


def fill_entries(
    table: Bytes,
    scene: Scene,
    lit: Picture,
    ranges: Mapping[str, LevelRange],
    floors: Mapping[str, float],
) -> None:
    """Write the entries of the words in use into a lookup table, (1024, 3) uint8.

    `lit` is the light at them, and `floors` the brightness of each surface's lowest fraction, 0 if absent.
    """
    extents = mapped_ranges(lit, scene.scaling, scene.exposure)
    fractions_of = fractions_by_surface(lit, extents, scene.mapping)
    for each in lit.slices:
        surface = scene.surfaces[each.surface_number - 1]
        fractions = fractions_of[each.surface_number](lit.relative[each.pixels])
        levels, floor = ranges[surface.name].levels, floors.get(surface.name, 0.0)
        table[lit.pixels[each.pixels]] = entries_at(surface.paint, fractions, levels, floor)
