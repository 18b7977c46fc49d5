from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.mapping.ranges import BACKGROUND, SCREENS, LevelRange
from autocolor.screens.surface.mixing_palette import GRAYS, HUES, SHADE_STEPS, crop_of, mixing_words
from autocolor.widgets.items import NIGHT, Area

ALONE = (("body", LevelRange(1, 1007)),)
LARGE = (("body", LevelRange(1, 1000)), ("glass", LevelRange(1001, 7)))
TWO_RANGES = (("glass", LevelRange(1, 600)), ("body", LevelRange(601, 407)))

every_division = pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])


@every_division
@pytest.mark.parametrize("swatches", [0, 12, 200])
def test_no_word_is_used_twice_and_the_surface_has_its_own_words_or_their_neighbors(
    ranges: tuple[tuple[str, LevelRange], ...], swatches: int
) -> None:
    palette = mixing_words(ranges, "body", swatches)
    counts = [SHADE_STEPS, SHADE_STEPS, len(GRAYS), len(HUES), swatches]
    assert [len(words) for words in palette[:5]] == counts
    words = np.concatenate(palette[:5])
    assert len(set(words.tolist())) == sum(counts)
    assert BACKGROUND < words.min() <= words.max() < SCREENS.first
    first, levels = dict(ranges)["body"]
    own = np.arange(first, first + levels)
    shown = palette.shown[own].astype(int)
    assert not np.isin(words, shown).any()
    assert np.abs(shown - own).max() == (0 if ranges is TWO_RANGES else 1)
    assert (np.delete(palette.shown, own) == NIGHT).all()


@every_division
def test_other_surfaces_are_dim_and_the_lighter_color_never_has_the_darker_gray(
    ranges: tuple[tuple[str, LevelRange], ...],
) -> None:
    palette = mixing_words(ranges, "body", 200)
    entries = np.random.default_rng(1).integers(0, 256, (1024, 3)).astype(np.uint8)
    words, (first, levels) = palette.dimmed(entries), dict(ranges)["body"]
    own = np.arange(first, first + levels)
    assert np.array_equal(words[own], palette.shown[own])
    others = np.setdiff1d(np.arange(1, SCREENS.first), own)
    assert np.isin(words[others], palette.grays).all()
    light = entries[others] @ np.array((0.299, 0.587, 0.114))
    grays = np.searchsorted(palette.grays, words[others])
    assert (np.diff(grays[np.argsort(light)]) >= 0).all()
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
    # No pixel comes twice, and none of the surface is beyond the edges.
    steps = [np.diff(crop.lines), np.diff(crop.elements)]
    scale = max(int(step.max(initial=1)) for step in steps)
    assert all(step.min(initial=1) >= 1 for step in steps)
    assert crop.lines[0] - scale < top <= bottom < crop.lines[-1] + scale
    assert crop.elements[0] - scale < left <= right < crop.elements[-1] + scale
    if scale > 1:
        # It could not be larger: in one direction, the surface needs the whole room.
        assert max((bottom + 1 - top) / ROOM.height, (right + 1 - left) / ROOM.width) > 1
        assert crop.area.height == ROOM.height or crop.area.width == ROOM.width


def test_a_place_beside_a_crop_has_no_pixel() -> None:
    crop = crop_of(np.ones((480, 640), np.bool_), ROOM)
    assert crop.pixel_at(crop.area.left - 1, crop.area.top) is None
    assert crop.pixel_at(crop.area.left, crop.area.top) == (crop.lines[0], crop.elements[0])
    words = np.arange(480 * 640).reshape(480, 640).astype(np.uint16)
    assert crop.of(words)[3, 5] == words[crop.lines[3], crop.elements[5]]
    nothing = crop_of(np.zeros((480, 640), np.bool_), ROOM)
    assert (nothing.lines[0], nothing.elements[0], nothing.area.width) == (1, 1, 320)
