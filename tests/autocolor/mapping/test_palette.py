from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from autocolor import render
from autocolor.images import display_image
from autocolor.mapping.palette import in_palette, thumbnail
from tests.small import car

SMALL = stn.arrays(np.uint8, st.tuples(st.integers(1, 6), st.integers(1, 6), st.just(3))) | st.just(
    np.full((84, 112, 3), 77, np.uint8)
)


@given(SMALL, st.integers(1, 40))
def test_every_pixel_has_a_color_of_the_palette_and_few_colors_are_kept(
    colors: np.ndarray, most: int
) -> None:
    places, palette = in_palette(colors, most)
    assert places.shape == colors.shape[:2]
    assert places.dtype == np.uint16
    assert palette.dtype == np.uint8
    assert 1 <= len(palette) <= most
    distinct = np.unique(colors.reshape(-1, 3), axis=0)
    assert len(palette) == min(most, len(distinct))
    if len(distinct) <= most:
        assert np.array_equal(palette[places], colors)


@given(SMALL, st.integers(1, 40))
def test_a_color_of_the_palette_is_the_mean_of_its_pixels(colors: np.ndarray, most: int) -> None:
    places, palette = in_palette(colors, most)
    for number, color in enumerate(palette):
        mean = colors[places == number].mean(axis=0)
        assert np.abs(mean - color).max() <= 0.501


def test_the_box_of_most_colors_is_cut_at_its_median() -> None:
    colors = np.zeros((1, 8, 3), np.uint8)
    colors[0, :, 1] = (0, 2, 4, 6, 200, 202, 204, 206)
    places, palette = in_palette(colors, 2)
    assert places.tolist() == [[0, 0, 0, 0, 1, 1, 1, 1]]
    assert palette.tolist() == [[0, 3, 0], [0, 203, 0]]


def test_a_smooth_picture_in_many_colors_is_true_within_a_few_steps() -> None:
    line, element = np.mgrid[0:84, 0:112]
    colors = np.stack([line * 3, element * 2, (line + element)], axis=2).astype(np.uint8)
    places, palette = in_palette(colors, 200)
    errors = np.abs(palette[places].astype(int) - colors).max(axis=2)
    assert errors.mean() < 8
    assert errors.max() <= 24


@pytest.mark.parametrize("size", [(96, 128), (49, 65), (48, 64), (24, 32)])
def test_a_thumbnail_has_the_averages_of_rectangles_that_differ_by_one_at_most(size: tuple[int, int]) -> None:
    shown = display_image(car(), render(car(), *size))
    small = thumbnail(shown)
    assert small.dtype == np.uint8
    lines, elements = min(size[0], 48), min(size[1], 64)
    assert small.shape == (lines, elements, 3)
    rows = [line * size[0] // lines for line in range(lines + 1)]
    columns = [element * size[1] // elements for element in range(elements + 1)]
    for line, element in np.ndindex(lines, elements):
        block = shown.colors[rows[line] : rows[line + 1], columns[element] : columns[element + 1]]
        # Half up, as everywhere.
        assert (small[line, element] == np.floor(block.mean(axis=(0, 1)) + 0.5)).all()
