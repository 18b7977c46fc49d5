from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from autocolor import Paint, render
from autocolor.checks import Color
from autocolor.images import display_image
from autocolor.mapping.colors import (
    Hsv,
    blend_from,
    blend_level,
    color_of_hsv,
    entries_at,
    entries_of,
    hsv_of,
    white_of,
    with_white,
)
from autocolor.mapping.palette import in_palette, thumbnail
from autocolor.testing import numbers, paints, ramps
from tests.autocolor.reference import entry_of
from tests.small import car


@given(paints(), st.integers(2, 300), st.just(0.0) | numbers(0, 1))
def test_every_entry_agrees_with_the_slow_twin(paint: Paint, levels: int, floor: float) -> None:
    entries = entries_of(paint, levels, floor)
    expected = [entry_of(paint, levels, level, floor) for level in range(levels)]
    assert np.abs(entries.astype(int) - np.array(expected)).max() <= (0 if floor == 0 else 1)
    assert entries.dtype == np.uint8


@given(st.integers(1, 1007), st.data())
def test_the_blend_from_a_level_has_that_level_and_no_digit_more_than_it_takes(
    levels: int, data: st.DataObject
) -> None:
    level = data.draw(st.integers(0, levels - 1))
    blend = blend_from(level, levels)
    assert 0 <= blend <= 1
    assert blend_level(blend, levels) == level
    digits = len(f"{blend!r}") - 2
    assert digits <= 2 or blend_level(round(level / (levels - 1), digits - 1), levels) != level


def test_the_color_shifts_in_equal_steps_above_the_blend_level() -> None:
    # With floor 1 nothing is darkened: 4 levels of pure object color, then 5 steps of a fifth each.
    entries = entries_of(Paint((0, 0, 0), (250, 100, 50), 3 / 8), 9, floor=1.0)
    assert entries[:, 0].tolist() == [0, 0, 0, 0, 50, 100, 150, 200, 250]
    assert entries[:, 2].tolist() == [0, 0, 0, 0, 10, 20, 30, 40, 50]


@pytest.mark.parametrize(("percentage", "last"), [(100.0, 250), (50.0, 150), (0.0, 50)])
def test_the_percentage_is_how_much_of_the_light_color_is_reached(percentage: float, last: int) -> None:
    assert entries_of(Paint((50, 50, 50), (250, 250, 250), 0.5, percentage), 11)[-1].tolist() == [last] * 3


def test_the_floor_is_how_bright_the_lowest_level_is() -> None:
    entries = entries_of(Paint((200, 100, 40), (200, 100, 40)), 11, floor=0.5)
    assert entries[[0, 5, 10]].tolist() == [[100, 50, 20], [150, 75, 30], [200, 100, 40]]


@given(ramps(), st.integers(1, 1_000_000))
def test_a_ramp_begins_with_its_first_color_and_ends_with_its_last(
    ramp: tuple[Color, ...], levels: int
) -> None:
    entries = entries_of(Paint(ramp=ramp), levels)
    assert tuple(entries[0]) == ramp[0]
    assert levels == 1 or tuple(entries[-1]) == ramp[-1]
    assert not entries.flags.writeable


def test_a_component_of_a_ramp_in_the_middle_between_two_is_rounded_up() -> None:
    entries = entries_of(Paint(ramp=((0, 255, 7), (1, 254, 7))), 3)
    assert entries.tolist() == [[0, 255, 7], [1, 255, 7], [1, 254, 7]]


@given(paints(), st.integers(2, 300), st.just(0.0) | numbers(0, 1))
def test_the_entries_at_fractions_of_a_range_are_those_of_its_levels(
    paint: Paint, levels: int, floor: float
) -> None:
    fractions = (np.arange(levels) / (levels - 1)).astype(np.float32)
    difference = entries_at(paint, fractions, levels, floor).astype(int) - entries_of(paint, levels, floor)
    assert np.abs(difference).max() <= 1


COMPONENTS = st.integers(0, 255)
COLORS = st.tuples(COMPONENTS, COMPONENTS, COMPONENTS)


@given(color=COLORS, white=COMPONENTS)
def test_to_change_white_the_same_amount_is_added_to_each_component_until_it_reaches_an_end(
    color: Color, white: int
) -> None:
    found = with_white(color, white)
    assert white_of(found) == white
    added = {after - before for before, after in zip(color, found, strict=True) if 0 < after < 255}
    assert len(added) <= 1
    for amount in added:
        assert found == tuple(np.clip(np.add(color, amount), 0, 255))
    # The white that a color has changes it by no more than one.
    assert np.abs(np.subtract(with_white(color, white_of(color)), color)).max() <= 1


@given(color=COLORS)
def test_the_ends_are_black_and_white_alone(color: Color) -> None:
    assert with_white(color, 0) == (0, 0, 0)
    assert with_white(color, 255) == (255, 255, 255)
    assert (white_of(color) == 0) == (max(color) <= 1 and sum(color) <= 1)


@given(COLORS)
def test_hue_saturation_and_value_give_the_color_back(color: Color) -> None:
    hsv = hsv_of(color)
    assert color_of_hsv(hsv) == color
    assert 0 <= hsv.hue <= 360
    assert 0 <= hsv.saturation <= 100
    assert hsv.value == pytest.approx(max(color) / 255 * 100)


@given(
    st.tuples(st.floats(0, 360) | st.sampled_from(range(0, 361, 60)), st.floats(0, 100), st.floats(0, 100))
)
def test_a_color_by_hue_has_the_components_of_its_definition(hsv: tuple[float, float, float]) -> None:
    # The definition by the distance of the hue from those of red, green and blue.
    hue, saturation, value = hsv[0], hsv[1] / 100, hsv[2] / 100
    for component, number in zip(color_of_hsv(Hsv(*hsv)), (5, 3, 1), strict=True):
        sixth = (number + hue / 60) % 6
        exact = 255 * (value - value * saturation * max(0, min(sixth, 4 - sixth, 1)))
        assert abs(component - exact) <= 0.5 + 1e-9


def test_a_gray_has_no_saturation_and_hue_0() -> None:
    assert [hsv_of((gray, gray, gray))[:2] for gray in (0, 1, 128, 255)] == [(0, 0)] * 4


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


@pytest.mark.parametrize("size", [(128, 96), (65, 49), (64, 48), (32, 24)])
def test_a_thumbnail_has_the_averages_of_rectangles_that_differ_by_one_at_most(size: tuple[int, int]) -> None:
    shown = display_image(car(), render(car(), size))
    small = thumbnail(shown)
    assert small.dtype == np.uint8
    elements, lines = min(size[0], 64), min(size[1], 48)
    assert small.shape == (lines, elements, 3)
    rows = [line * size[1] // lines for line in range(lines + 1)]
    columns = [element * size[0] // elements for element in range(elements + 1)]
    for line, element in np.ndindex(lines, elements):
        block = shown.colors[rows[line] : rows[line + 1], columns[element] : columns[element + 1]]
        # Half up, as everywhere.
        assert (small[line, element] == np.floor(block.mean(axis=(0, 1)) + 0.5)).all()
