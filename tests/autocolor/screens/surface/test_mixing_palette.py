from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Bytes
from autocolor.checks import Color
from autocolor.mapping.ranges import BACKGROUND, SCREENS, LevelRange
from autocolor.screens.surface.mixing_palette import (
    GRAYS,
    HUES,
    SHADE_STEPS,
    Ranges,
    crop_of,
    mixing_words,
    shades_of,
)
from autocolor.widgets.items import NIGHT, Area

COMPONENTS = st.integers(0, 255)
COLORS = st.tuples(COMPONENTS, COMPONENTS, COMPONENTS)

ALONE: Ranges = (("body", LevelRange(1, 1007)),)
LARGE: Ranges = (("body", LevelRange(1, 1000)), ("glass", LevelRange(1001, 7)))
TWO_RANGES: Ranges = (("glass", LevelRange(1, 600)), ("body", LevelRange(601, 407)))


@given(COLORS)
def test_shade_k_is_k_of_63_parts_of_the_color_rounded_half_up(color: Color) -> None:
    expected = [[(2 * part * step + 63) // 126 for part in color] for step in range(64)]
    assert shades_of(color).tolist() == expected


@pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])
@pytest.mark.parametrize("swatches", [0, 12, 200])
def test_all_words_differ_and_none_is_of_the_background_of_the_screens_or_shown(
    ranges: Ranges, swatches: int
) -> None:
    palette = mixing_words(ranges, "body", swatches)
    parts = [palette.light_shades, palette.object_shades, palette.grays, palette.hues, palette.swatches]
    words = np.concatenate(parts)
    assert len(palette.light_shades) == len(palette.object_shades) == SHADE_STEPS
    assert (len(palette.grays), len(palette.hues)) == (len(GRAYS), len(HUES))
    assert len(palette.swatches) == swatches
    assert len(set(words.tolist())) == len(words)
    assert words.min() > BACKGROUND
    assert words.max() < SCREENS.first
    own = dict(ranges)["body"]
    assert not np.isin(words, palette.shown[own.first : own.last + 1]).any()


@pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])
def test_the_surface_is_shown_by_its_own_words_or_their_neighbors_and_the_others_by_the_ground(
    ranges: Ranges,
) -> None:
    palette = mixing_words(ranges, "body", 200)
    levels = dict(ranges)["body"]
    own = np.arange(levels.first, levels.last + 1)
    off = np.abs(palette.shown[levels.first : levels.last + 1].astype(int) - own)
    assert off.max() == (0 if ranges is TWO_RANGES else 1)
    assert (np.delete(palette.shown, own) == NIGHT).all()


@pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])
def test_loads_put_each_color_into_its_word(ranges: Ranges) -> None:
    palette = mixing_words(ranges, "body", 12)
    swatches = np.random.default_rng(1).integers(0, 256, (12, 3)).astype(np.uint8)
    table = np.full((1024, 3), 7, np.uint8)
    for first, colors in palette.loads((200, 100, 50), (1, 2, 3), swatches):
        table[first : first + len(colors)] = colors
    assert np.array_equal(table[palette.light_shades], shades_of((200, 100, 50)))
    assert np.array_equal(table[palette.object_shades], shades_of((1, 2, 3)))
    assert np.array_equal(table[palette.grays], GRAYS)
    assert np.array_equal(table[palette.hues], HUES)
    assert np.array_equal(table[palette.swatches], swatches)
    assert (np.delete(table, palette.borrowed, axis=0) == 7).all()
    # Words that follow each other are one load, and equal surfaces have the same palette.
    assert ranges is not TWO_RANGES or len(palette.loads((0, 0, 0), (0, 0, 0), swatches)) == 1
    assert mixing_words(tuple(ranges), "body", 12) is palette
    # The hues go once around in equal steps.
    thirds = HUES[:: (len(HUES) - 1) // 3].tolist()
    assert thirds == [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 0, 0]]


def random_entries(seed: int) -> Bytes:
    return np.random.default_rng(seed).integers(0, 256, (1024, 3)).astype(np.uint8)


@pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])
def test_other_surfaces_are_dim_and_the_lighter_color_never_has_the_darker_gray(ranges: Ranges) -> None:
    palette, entries = mixing_words(ranges, "body", 200), random_entries(1)
    words, own = palette.dimmed(entries), dict(ranges)["body"]
    mine = slice(own.first, own.last + 1)
    assert np.array_equal(words[mine], palette.shown[mine])
    others = np.setdiff1d(np.arange(1, SCREENS.first), np.arange(own.first, own.last + 1))
    light = entries[others] @ np.array((0.299, 0.587, 0.114))
    grays = np.searchsorted(palette.grays, words[others])
    assert np.isin(words[others], palette.grays).all()
    assert (np.diff(grays[np.argsort(light)]) >= 0).all()
    # The background and the words of the screens are the ground.
    assert words[BACKGROUND] == NIGHT
    assert (words[SCREENS.first :] == NIGHT).all()


ROOM = Area(8, 224, 495, 463)
SIZES = st.tuples(st.integers(40, 700), st.integers(40, 900))
SHARES = st.floats(0, 1)


@given(SIZES, SHARES, SHARES, SHARES, SHARES)
def test_a_crop_shows_the_surface_as_large_as_the_room_allows(
    size: tuple[int, int], down: float, across: float, height: float, width: float
) -> None:
    lines, elements = size
    top, left = int(down * (lines - 1)), int(across * (elements - 1))
    bottom = top + int(height * (lines - 1 - top))
    right = left + int(width * (elements - 1 - left))
    is_shown = np.zeros(size, np.bool_)
    is_shown[top, left] = is_shown[bottom, right] = True
    crop = crop_of(is_shown, ROOM)
    assert ROOM.covers(crop.area)
    assert (len(crop.lines), len(crop.elements)) == (crop.area.height, crop.area.width)
    steps = [np.diff(crop.lines), np.diff(crop.elements)]
    # No pixel comes twice, and none of the surface is beyond the edges.
    scale = max(int(step.max(initial=1)) for step in steps)
    assert all(step.min(initial=1) >= 1 for step in steps)
    assert crop.lines[0] - scale < top <= bottom < crop.lines[-1] + scale
    assert crop.elements[0] - scale < left <= right < crop.elements[-1] + scale
    if scale > 1:
        # It could not be larger: with a margin of four, the surface needs the whole room in one direction.
        needed = [
            (min(lines, bottom + 5) - max(0, top - 4)) / ROOM.height,
            (min(elements, right + 5) - max(0, left - 4)) / ROOM.width,
        ]
        assert max(needed) > 1
        assert crop.area.height == ROOM.height or crop.area.width == ROOM.width


def test_a_place_beside_a_crop_has_no_pixel() -> None:
    crop = crop_of(np.ones((480, 640), np.bool_), ROOM)
    assert crop.pixel_at(crop.area.left - 1, crop.area.top) is None
    assert crop.pixel_at(crop.area.left, crop.area.top) == (crop.lines[0], crop.elements[0])
    nothing = crop_of(np.zeros((480, 640), np.bool_), ROOM)
    assert (nothing.lines[0], nothing.elements[0], nothing.area.width) == (1, 1, 320)
    words = np.arange(480 * 640).reshape(480, 640).astype(np.uint16)
    assert crop.of(words)[3, 5] == words[crop.lines[3], crop.elements[5]]
