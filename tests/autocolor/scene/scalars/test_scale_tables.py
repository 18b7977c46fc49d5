from __future__ import annotations

import re

import pytest

from autocolor.scene.scalars.scale_tables import SCALE_TABLES


@pytest.mark.parametrize("name", SCALE_TABLES)
def test_a_table_has_at_least_two_colors_in_digits(name: str) -> None:
    colors = SCALE_TABLES[name].split()
    assert len(colors) >= 2
    assert all(re.fullmatch("[0-9a-f]{6}", color) for color in colors)


@pytest.mark.parametrize("name", ["viridis", "plasma", "inferno", "magma", "cividis"])
def test_a_perceptually_uniform_scale_gets_lighter_from_color_to_color(name: str) -> None:
    parts = [bytes.fromhex(color) for color in SCALE_TABLES[name].split()]
    lightness = [0.2126 * red + 0.7152 * green + 0.0722 * blue for red, green, blue in parts]
    assert lightness == sorted(lightness)


@pytest.mark.parametrize("name", ["coolwarm", "RdBu"])
def test_a_diverging_scale_is_lightest_in_its_middle(name: str) -> None:
    parts = [sum(bytes.fromhex(color)) for color in SCALE_TABLES[name].split()]
    middle = len(parts) // 2
    assert parts[middle] == max(parts)
    assert min(parts[0], parts[-1]) < parts[middle] - 100
