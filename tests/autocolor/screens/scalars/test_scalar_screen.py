from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor import Scene
from autocolor.scene.columns.column import fields_of
from autocolor.scene.scalars.color_scales import COLOR_SCALES
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from autocolor.scene.scalars.scalar import Scalar
from tests.autocolor.screens.boxes import boxes, hand_at, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand


def boxes_with_stress() -> Scene:
    scene = boxes()
    stress = MeshScalar("stress", np.arange(len(scene.mesh.coordinates), dtype=float))
    return scene.replace(mesh=scene.mesh.with_scalars(stress))


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "scalar", boxes_with_stress().with_scalar(name="stress", legend=False))


def scalar_of(hand: Hand) -> Scalar:
    scalar = hand.viewer.studio.scene.scalar
    assert scalar is not None
    return scalar


def labels_of(hand: Hand) -> set[str]:
    return {row.label for row in hand.viewer.board.screen.rows()}


def test_without_a_scalar_there_is_the_choice_of_one_alone(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "scalar", boxes_with_stress())
    assert labels_of(hand) == {"scalar"}
    hand.pick("scalar")
    assert scalar_of(hand).name == "stress"
    hand.pick("scalar", 0.05)
    assert hand.viewer.studio.scene.scalar is None


def test_every_scalar_of_the_mesh_and_every_computed_one_is_reached_by_clicks(hand: Hand) -> None:
    names = hand.viewer.studio.scene.scalar_names
    seen = []
    for _ in names:
        seen.append(scalar_of(hand).name)
        if len(seen) < len(names):
            hand.pick("scalar")
    assert seen == list(names)


def test_every_column_of_the_scalar_has_a_row(hand: Hand) -> None:
    hand.viewer.session.edit(hand.viewer.studio.scene.with_scalar(name="zebra"))
    rows = {"name": "scalar", "limits": "own range", "surfaces": "colored", "direction": "direction x"}
    assert {rows.get(name, name) for name in fields_of(Scalar)} <= labels_of(hand)


def test_only_scalars_that_are_computed_with_them_have_a_direction_and_stripes(hand: Hand) -> None:
    assert not {"direction x", "stripes"} & labels_of(hand)
    hand.viewer.session.edit(hand.viewer.studio.scene.with_scalar(name="slope"))
    assert {"direction x", "stripes"} & labels_of(hand) == {"direction x"}


def test_another_scale_sends_no_word_and_is_one_step(hand: Hand) -> None:
    before, words = hand.viewer.studio.scene, hand.viewer.studio.words
    hand.pick("scale")
    assert scalar_of(hand).scale != "viridis"
    assert scalar_of(hand).scale in COLOR_SCALES
    assert hand.viewer.studio.words is words
    undo(hand)
    assert hand.viewer.studio.scene is before


def test_a_scale_is_reversed_and_stays_so_when_another_is_chosen(hand: Hand) -> None:
    hand.pick("reversed")
    assert scalar_of(hand).scale == "viridis_r"
    hand.pick("scale")
    assert str(scalar_of(hand).scale).endswith("_r")
    hand.pick("reversed")
    assert not str(scalar_of(hand).scale).endswith("_r")


def test_a_list_of_colors_has_no_name_to_reverse(hand: Hand) -> None:
    hand.viewer.session.edit(hand.viewer.studio.scene.with_scalar(scale=["red", "blue"]))
    assert hand.widget("reversed").why_not
    hand.pick("reversed")
    assert scalar_of(hand).scale == ((255, 0, 0), (0, 0, 255))
    hand.pick("scale")
    assert scalar_of(hand).scale in COLOR_SCALES


@pytest.mark.parametrize("label", ["bands", "shades"])
def test_bands_and_shades_are_set_along_their_bars(hand: Hand, label: str) -> None:
    if label == "shades":
        hand.pick(label, 0.95)
        assert scalar_of(hand).shades == 8
    before = vars(scalar_of(hand))[label]
    hand.pull(label, 0.2, 0.4)
    assert vars(scalar_of(hand))[label] != before
    assert words_are_those_of_the_scene(hand)


@pytest.mark.parametrize("label", ["below", "above", "missing"])
def test_the_other_colors_are_chosen_by_clicks(hand: Hand, label: str) -> None:
    before: Any = vars(scalar_of(hand))[label]
    hand.pick(label)
    assert vars(scalar_of(hand))[label] != before


def test_the_legend_is_switched(hand: Hand) -> None:
    assert not hand.viewer.board.screen.items()
    hand.pick("legend")
    assert scalar_of(hand).legend
    assert hand.viewer.board.screen.items()


def test_a_surface_gets_its_own_colors_and_those_of_the_scalar_again(hand: Hand) -> None:
    assert hand.viewer.session.surface_name == "low"
    hand.pick("colored")
    assert scalar_of(hand).surfaces == ("high",)
    hand.pick("colored")
    assert scalar_of(hand).surfaces == ("low", "high")


def test_another_scalar_comes_in_its_own_range_and_stripes_in_black_and_white(hand: Hand) -> None:
    screen: Any = hand.viewer.board.screen
    hand.viewer.session.edit(hand.viewer.studio.scene.with_scalar(limits=[1, 2], scale="turbo"))
    screen._choose("z")
    assert (scalar_of(hand).limits, scalar_of(hand).scale) == (None, "turbo")
    screen._choose("zebra")
    assert (scalar_of(hand).scale, scalar_of(hand).bands) == ("zebra", 2)
    screen._choose("stress")
    assert (scalar_of(hand).scale, scalar_of(hand).bands) == ("viridis", 16)


def test_a_click_tells_the_value_that_is_seen_there(hand: Hand) -> None:
    hand.click(250, 240)
    value = hand.viewer.studio.picture.scalar
    assert value is not None
    assert f"stress {value[240, 250]:.5g}, shade " in hand.viewer.message
