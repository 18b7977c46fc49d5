from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.checks import Color
from autocolor.mapping.level_ranges import BACKGROUND, SCREENS, LevelRange
from autocolor.screens.colors.mixing_palette import RAMP_STEPS, Palette, Ranges, palette_of, ramp_of
from autocolor.widgets.colors import NIGHT

COMPONENTS = st.integers(0, 255)
COLORS = st.tuples(COMPONENTS, COMPONENTS, COMPONENTS)

ALONE: Ranges = (("body", LevelRange(1, 1007)),)
LARGE: Ranges = (("body", LevelRange(1, 1000)), ("glass", LevelRange(1001, 7)))
SMALL: Ranges = (("glass", LevelRange(1, 600)), ("body", LevelRange(601, 407)))


@given(COLORS)
def test_step_k_of_a_ramp_is_k_of_63_parts_of_the_color_rounded_half_up(color: Color) -> None:
    expected = [[(2 * part * step + 63) // 126 for part in color] for step in range(64)]
    assert ramp_of(color).tolist() == expected


@pytest.mark.parametrize("ranges", [ALONE, LARGE, SMALL])
@pytest.mark.parametrize("swatches", [0, 12, 200])
def test_all_words_differ_and_none_is_of_the_background_of_the_screens_or_shown(
    ranges: Ranges, swatches: int
) -> None:
    palette = palette_of(ranges, "body", swatches)
    words = np.concatenate([palette.light_ramp, palette.object_ramp, palette.swatches])
    assert len(palette.light_ramp) == len(palette.object_ramp) == RAMP_STEPS
    assert len(palette.swatches) == swatches
    assert len(set(words.tolist())) == len(words)
    assert words.min() > BACKGROUND
    assert words.max() < SCREENS.first
    own = dict(ranges)["body"]
    assert not np.isin(words, palette.shown[own.first : own.last + 1]).any()


@pytest.mark.parametrize("ranges", [ALONE, LARGE, SMALL])
def test_the_surface_is_shown_by_its_own_words_or_their_neighbors_and_the_others_by_the_ground(
    ranges: Ranges,
) -> None:
    palette = palette_of(ranges, "body", 200)
    levels = dict(ranges)["body"]
    own = np.arange(levels.first, levels.last + 1)
    off = np.abs(palette.shown[levels.first : levels.last + 1].astype(int) - own)
    assert off.max() == (0 if ranges is SMALL else 1)
    assert (np.delete(palette.shown, own) == NIGHT).all()


@pytest.mark.parametrize("ranges", [ALONE, LARGE, SMALL])
def test_loads_put_each_color_into_its_word(ranges: Ranges) -> None:
    palette = palette_of(ranges, "body", 12)
    swatches = np.random.default_rng(1).integers(0, 256, (12, 3)).astype(np.uint8)
    table = np.full((1024, 3), 7, np.uint8)
    for first, colors in palette.loads((200, 100, 50), (1, 2, 3), swatches):
        table[first : first + len(colors)] = colors
    assert np.array_equal(table[palette.light_ramp], ramp_of((200, 100, 50)))
    assert np.array_equal(table[palette.object_ramp], ramp_of((1, 2, 3)))
    assert np.array_equal(table[palette.swatches], swatches)
    assert (np.delete(table, palette.borrowed, axis=0) == 7).all()


def test_words_that_follow_each_other_are_one_load() -> None:
    palette = palette_of(SMALL, "body", 12)
    assert len(palette.loads((0, 0, 0), (0, 0, 0), np.zeros((12, 3), np.uint8))) == 1


def test_equal_surfaces_have_the_same_palette() -> None:
    palette = palette_of(SMALL, "body", 12)
    assert isinstance(palette, Palette)
    assert palette_of(tuple(SMALL), "body", 12) is palette
