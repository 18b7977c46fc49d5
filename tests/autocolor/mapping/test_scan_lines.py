"""Line by line, the words are those of the finished picture."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, Scene, UsageError, render, scene_of
from autocolor.arrays import Numbers
from autocolor.mapping import scan_lines
from autocolor.mapping.display_image import DisplayImage, display_image
from autocolor.mapping.exposure import held_exposure
from autocolor.mapping.level_ranges import BACKGROUND
from autocolor.mapping.scan_lines import words_by_line
from autocolor.visibility.projection import Projection
from tests.autocolor.sessions import car
from tests.autocolor.strategies import rasters, scenes, soups


def image_of(scene: Scene, lines: int, elements: int) -> DisplayImage:
    return display_image(scene, render(scene, lines, elements))


def all_lines(image: DisplayImage) -> list[list[int]]:
    """The words of all lines together, after a look at each."""
    found = list(words_by_line(image))
    assert [line for line, _ in found] == list(range(image.picture.lines))
    assert {(words.shape, words.dtype) for _, words in found} == {
        ((1, image.picture.elements), np.dtype("u2"))
    }
    words: list[list[int]] = np.concatenate([words for _, words in found]).tolist()
    return words


@given(scenes(), rasters)
def test_all_lines_together_are_the_words_of_the_picture(scene: Scene, raster: tuple[int, int]) -> None:
    image = image_of(scene, *raster)
    assert all_lines(image) == image.words.tolist()


@given(soups(), rasters)
def test_all_lines_together_are_the_words_where_polygons_pass_through_each_other(
    mesh: Mesh, raster: tuple[int, int]
) -> None:
    image = image_of(scene_of(mesh), *raster)
    assert all_lines(image) == image.words.tolist()


def test_the_lines_have_the_levels_of_a_held_exposure() -> None:
    scene = car()
    picture = render(scene, 24, 32)
    held = scene.replace(exposure=held_exposure(picture, scene.scaling)).with_light("key", intensity=0.2)
    image, free = image_of(held, 24, 32), image_of(held.replace(exposure="auto"), 24, 32)
    assert all_lines(image) == image.words.tolist() != free.words.tolist()


def test_what_is_visible_is_found_by_the_literal_algorithm(monkeypatch: pytest.MonkeyPatch) -> None:
    def numbers_by_line(projected: Projection) -> Iterator[Numbers]:
        for line in range(projected.lines):
            yield np.full(projected.elements, line % 2, np.int64)

    monkeypatch.setattr(scan_lines, "numbers_by_line", numbers_by_line)
    image = image_of(car(), 24, 32)
    lines = np.array(all_lines(image))
    assert (lines[::2] == BACKGROUND).all()
    assert lines[1::2].tolist() == image.words[1::2].tolist()


def test_a_coarse_image_has_no_lines() -> None:
    image = display_image(car(), render(car(), 12, 16), block=2)
    with pytest.raises(UsageError) as caught:
        words_by_line(image)
    assert str(caught.value) == (
        "an image must have blocks of 1 pixel for its lines, not of 2; refine it first"
    )
