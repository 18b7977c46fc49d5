from __future__ import annotations

import numpy as np
import pytest

from autocolor.scene.color_scales import COLOR_SCALES, IN_TURN, SCALE_TABLES, scale_colors


@pytest.mark.parametrize("count", [2, 5, 16, 256])
def test_a_scale_runs_from_its_first_color_to_its_last(count: int) -> None:
    for name in (name for name in COLOR_SCALES if name not in IN_TURN):
        colors = scale_colors(name, count)
        ends = [bytes.fromhex(COLOR_SCALES[name][end][1:]) for end in (0, -1)]
        assert colors.shape == (count, 3)
        assert colors.dtype == np.uint8
        assert [bytes(colors[0]), bytes(colors[-1])] == ends, name


@pytest.mark.parametrize("name", [name for name in COLOR_SCALES if not name.endswith("_r")])
def test_a_reversed_scale_begins_with_the_last_color(name: str) -> None:
    assert (scale_colors(f"{name}_r", 8)[::-1] == scale_colors(name, 8)).all()


def test_the_middle_band_of_an_odd_number_has_the_middle_color_of_a_diverging_scale() -> None:
    assert bytes(scale_colors("coolwarm", 9)[4]).hex() == COLOR_SCALES["coolwarm"][16][1:]


def test_zebra_is_black_and_white_in_turn_however_many_bands_there_are() -> None:
    assert scale_colors("zebra", 5)[:, 0].tolist() == [0, 255, 0, 255, 0]
    assert scale_colors("zebra_r", 4)[:, 0].tolist() == [255, 0, 255, 0]


def test_a_list_of_colors_is_a_scale_whose_colors_are_mixed_between_them() -> None:
    assert scale_colors(((0, 0, 0), (200, 100, 0)), 3).tolist() == [[0, 0, 0], [100, 50, 0], [200, 100, 0]]


@pytest.mark.parametrize("name", ["viridis", "plasma", "inferno", "magma", "cividis"])
def test_a_perceptually_uniform_scale_gets_lighter_from_color_to_color(name: str) -> None:
    parts = [bytes.fromhex(color) for color in SCALE_TABLES[name].split()]
    lightness = [0.2126 * red + 0.7152 * green + 0.0722 * blue for red, green, blue in parts]
    assert lightness == sorted(lightness)
