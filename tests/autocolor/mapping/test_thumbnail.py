"""Thumbnails of display images: averages of colors."""

from __future__ import annotations

import numpy as np
import pytest

from autocolor import render
from autocolor.mapping.display_image import DisplayImage, display_image
from autocolor.mapping.thumbnail import thumbnail
from tests.autocolor.sessions import car


def image(lines: int, elements: int) -> DisplayImage:
    scene = car()
    return display_image(scene, render(scene, lines=lines, elements=elements))


def test_a_thumbnail_of_the_papers_picture_is_the_average_of_blocks_of_ten_by_ten() -> None:
    shown = image(480, 640)
    small = thumbnail(shown)
    assert small.shape == (48, 64, 3)
    assert small.dtype == np.uint8
    blocks = shown.colors.reshape(48, 10, 64, 10, 3).astype(int).sum(axis=(1, 3))
    # Half up, as everywhere.
    assert (small == (blocks + 50) // 100).all()
    assert len(np.unique(small)) > 10


@pytest.mark.parametrize("size", [(100, 130), (48, 64), (49, 65)])
def test_rectangles_that_differ_by_one_cover_other_sizes(size: tuple[int, int]) -> None:
    shown = image(*size)
    small = thumbnail(shown)
    rows = [line * size[0] // 48 for line in range(49)]
    columns = [element * size[1] // 64 for element in range(65)]
    for line, element in ((0, 0), (20, 30), (30, 33), (47, 63)):
        block = shown.colors[rows[line] : rows[line + 1], columns[element] : columns[element + 1]]
        assert (small[line, element] == np.floor(block.mean(axis=(0, 1)) + 0.5)).all()


def test_an_image_that_is_smaller_keeps_its_pixels() -> None:
    shown = image(24, 32)
    assert (thumbnail(shown) == shown.colors).all()
