from __future__ import annotations

import numpy as np
import pytest

from autocolor import Scene
from benchmarks.agreement import Agreement, agreement, near_silhouettes
from benchmarks.comparison import BLUE, Field, comparison_scene, expected


@pytest.fixture(scope="module")
def scene() -> Scene:
    return comparison_scene()


@pytest.fixture(scope="module")
def first(scene: Scene) -> Field:
    field, _ = expected(scene)
    return (field + 0.5).astype(np.uint8)


def test_near_a_silhouette_is_one_pixel_to_either_side_corners_included() -> None:
    covered = np.zeros((7, 7), np.bool_)
    covered[3:, 3:] = True
    near = near_silhouettes(covered)
    wanted = np.zeros((7, 7), np.bool_)
    wanted[2:4, 2:] = wanted[2:, 2:4] = True
    assert near.tolist() == wanted.tolist()


@pytest.mark.parametrize("covered", [True, False])
def test_without_a_silhouette_nothing_is_near_one(covered: bool) -> None:
    assert not near_silhouettes(np.full((4, 5), covered)).any()


def test_a_picture_in_8_bits_agrees_with_the_one_it_was_rounded_from(scene: Scene, first: Field) -> None:
    found = agreement(first, scene)
    assert found.holds
    assert (found.uncovered, found.astray) == (0, 0)
    assert found.percentile <= 0.5


def test_a_silhouette_may_be_a_pixel_off_and_no_more(scene: Scene, first: Field) -> None:
    # Cover the first pixel above the horizon in each column, and then the second one too.
    _, covered = expected(scene)
    horizon = covered.argmax(axis=0)
    moved = first.copy()
    columns = np.arange(covered.shape[1])
    moved[horizon - 1, columns] = 128
    assert agreement(moved, scene).uncovered == covered.shape[1]
    assert agreement(moved, scene).holds
    moved[horizon - 3, columns] = 128
    assert agreement(moved, scene).astray > 0
    assert not agreement(moved, scene).holds


def test_a_hole_in_the_middle_of_a_surface_disagrees(scene: Scene, first: Field) -> None:
    holed = first.copy()
    holed[400, 300] = BLUE
    found = agreement(holed, scene)
    assert (found.uncovered, found.astray) == (1, 1)


def test_intensities_that_are_a_few_percent_off_disagree(scene: Scene, first: Field) -> None:
    darker = np.where((first == BLUE).all(axis=2, keepdims=True), first, (first * 0.95).astype(np.uint8))
    found = agreement(darker, scene)
    assert not found.uncovered
    assert not found.holds


def test_an_empty_picture_disagrees(scene: Scene, first: Field) -> None:
    assert not agreement(np.full_like(first, BLUE), scene).holds


def test_an_agreement_is_told_with_its_numbers() -> None:
    assert str(Agreement(12, 0, 0.25, 0.875)) == (
        "coverage differs at 12 pixels, 0 of them away from silhouettes; intensities by 0.25 of 255 (median)"
        " and 0.88 (99th percentile)"
    )
