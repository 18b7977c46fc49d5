from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, scene_of
from autocolor.scene.scalars.scalar import Scalar
from tests.autocolor.screens.boxes import boxes, hand_at, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "scalar", boxes().with_scalar(name="z", legend=False))


def scalar_of(hand: Hand) -> Scalar:
    scalar = hand.viewer.studio.scene.scalar
    assert scalar is not None
    return scalar


def test_a_limit_is_set_along_the_own_range_in_one_step_without_rendering(hand: Hand) -> None:
    before, picture = hand.viewer.studio.scene, hand.viewer.studio.picture
    hand.pull("high limit", 0.9, 0.5)
    limits = scalar_of(hand).limits
    assert limits is not None
    assert limits[0] == 0.0
    assert limits[1] == pytest.approx(0.5, abs=0.02)
    assert hand.viewer.studio.picture is picture
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.viewer.studio.scene is before


def test_the_limits_do_not_cross(hand: Hand) -> None:
    hand.pull("high limit", 0.9, 0.3)
    hand.pull("low limit", 0.1, 0.9)
    low, high = scalar_of(hand).limits or (0, 0)
    assert low < high < low + 0.01
    hand.pull("high limit", 0.5, 0.0)
    low, high = scalar_of(hand).limits or (0, 0)
    assert low < high


def test_the_own_range_is_held_and_followed_again(hand: Hand) -> None:
    hand.pick("own range")
    assert scalar_of(hand).limits == (0.0, 1.0)
    hand.pull("low limit", 0.1, 0.5)
    hand.pick("own range")
    assert scalar_of(hand).limits is None


def test_limits_around_zero_are_as_far_as_the_farther_one(hand: Hand) -> None:
    hand.pick("around zero")
    assert scalar_of(hand).limits == (-1.0, 1.0)


def test_a_held_range_has_the_fewest_digits(tmp_path: Path) -> None:
    mesh = boxes().mesh
    tenths = Mesh(mesh.coordinates * 0.1, mesh.node_numbers)
    hand = hand_at(tmp_path, "scalar", scene_of(tenths).with_scalar(name="z", legend=False))
    assert hand.viewer.studio.picture.scalar_limits == (0.0, float(np.float32(0.1)))
    hand.pick("own range")
    assert scalar_of(hand).limits == (0.0, 0.1)
    assert words_are_those_of_the_scene(hand)
