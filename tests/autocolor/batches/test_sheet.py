from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from autocolor import UsageError, grid
from autocolor.arrays import light_of
from autocolor.batches.outputs import (
    BOXES,
    GAP,
    GROUND,
    NO_PICTURE,
    Box,
    box_of,
    columns_of,
    read_thumbnail,
    sheet_png,
    thumbnail,
)
from autocolor.batches.table import variants_of
from ramtek_emu.png import png_bytes


@given(st.integers(1, 40), st.integers(1, 40), st.integers(0, 99))
def test_a_thumbnail_fits_and_each_pixel_is_the_mean_light_of_a_square(
    lines: int, elements: int, seed: int
) -> None:
    colors = np.random.default_rng(seed).integers(0, 256, (lines, elements, 3), np.uint8)
    box = Box(9, 7)
    small = thumbnail(colors, box)
    assert small.shape[0] <= box.lines
    assert small.shape[1] <= box.elements
    side = min(max(1, -(-lines // box.lines), -(-elements // box.elements)), lines, elements)
    light = light_of(colors.astype(np.float64))
    for line, element in np.ndindex(small.shape[:2]):
        square = light[line * side : (line + 1) * side, element * side : (element + 1) * side]
        mean = light_of(small[line, element].astype(np.float64))
        half = np.maximum(
            light_of(np.minimum(small[line, element] + 0.5, 255.0)) - mean,
            mean - light_of(np.maximum(small[line, element] - 0.5, 0.0)),
        )
        assert (np.abs(square.mean((0, 1)) - mean) <= half + 1e-6).all()


def test_a_sheet_has_the_shape_of_a_grid_else_it_is_nearly_square() -> None:
    assert columns_of(grid({"a": [1, 2, 3], "b": [1, 2, 3, 4, 5]})) == 5
    assert columns_of(grid({"a": [1, 2], "b": [1, 2, 3], "c": [1, 2, 3, 4]})) == 4
    assert columns_of(grid({"a": range(24)})) == 5
    assert columns_of(grid({"a": range(2), "b": range(40)})) == 9
    assert columns_of(variants_of([{"a": 1, "b": 1}, {"a": 2, "b": 2}, {"a": 3}])) == 2
    # Rows of a high grid stand side by side.
    assert columns_of(grid({"a": range(24), "b": range(3)})) == 9
    assert columns_of(grid({"a": range(1000), "b": range(2)})) == 44
    assert columns_of(()) == 1


def test_a_sheet_has_each_thumbnail_in_its_cell_and_a_label_below() -> None:
    variants = grid({"a": [1, 2], "b": ["a name too long for a cell of so few pixels" * 3, "x"]})
    box = box_of(variants)
    colors = np.full((box.lines, box.elements, 3), 200, np.uint8)
    field = np.asarray(Image.open(BytesIO(sheet_png(variants, {3: colors, 1: colors[:11, :20], 0: None}))))
    step = (field.shape[0] - GAP) // 2, (field.shape[1] - GAP) // 2
    corners = [(GAP + row * step[0], GAP + column * step[1]) for row in range(2) for column in range(2)]
    cells = [field[top : top + box.lines, left : left + box.elements] for top, left in corners]
    assert (cells[3] == 200).all()
    assert (cells[0] == NO_PICTURE).all()
    # The smaller picture is in the middle of its cell, with the same ground on both sides.
    expected = np.full_like(cells[1], GROUND)
    top, left = (box.lines - 11) // 2, (box.elements - 20) // 2
    expected[top : top + 11, left : left + 20] = 200
    assert (cells[1] == expected).all()
    for top, left in corners:
        label = field[top + box.lines : top + step[0], left : left + box.elements]
        assert label.max() > 150
    # A long label ends within its cell.
    assert (field[:, GAP + box.elements : GAP + step[1]] == GROUND).all()


def test_a_sheet_has_the_columns_that_it_is_given() -> None:
    rows = grid({"a": range(24), "b": range(3)})
    box, labels = box_of(rows, 12), 16
    with Image.open(BytesIO(sheet_png(rows, {}, 12))) as sheet:
        assert sheet.size == (12 * (box.elements + GAP) + GAP, 6 * (box.lines + labels + GAP) + GAP)
    with Image.open(BytesIO(sheet_png(rows[:2], {}, 100))) as sheet:
        assert sheet.width == 2 * (box.elements + GAP) + GAP
    for wrong in (0, 101, True, "3"):
        with pytest.raises(UsageError, match="the columns of a sheet must be a whole number from 1 to 100"):
            box_of(rows, wrong)  # type: ignore[arg-type]


def test_a_sheet_of_many_variants_has_smaller_thumbnails_and_of_too_many_is_refused() -> None:
    assert box_of(grid({"a": range(401)})) == BOXES[1][1]
    with pytest.raises(UsageError, match=r"at most 10,000 variants, not 10,001; make sheets of parts"):
        box_of(grid({"a": range(10_001)}))


def test_the_thumbnail_of_a_file_is_that_of_its_colors(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    colors = np.random.default_rng(1).integers(0, 256, (30, 40, 3), np.uint8)
    (tmp_path / "a.png").write_bytes(png_bytes(colors))
    small = read_thumbnail(str(tmp_path / "a.png"), Box(20, 20))
    assert small is not None
    assert (small == thumbnail(colors, Box(20, 20))).all()
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 30 * 40 // 2 - 1)
    assert read_thumbnail(str(tmp_path / "a.png"), Box(20, 20)) is None
