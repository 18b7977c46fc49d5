from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, Scene, scene_of
from autocolor.scene.columns import fields_of
from autocolor.scene.scalar import MeshScalar, Scalar
from tests.autocolor.screens.boxes import hand_at, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand
from tests.small import boxes


def boxes_with_stress() -> Scene:
    scene = boxes()
    stress = MeshScalar("stress", np.arange(len(scene.mesh.coordinates), dtype=float))
    return scene.replace(mesh=scene.mesh.with_scalars(stress))


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "scalar", boxes_with_stress().with_scalar(name="z", legend=False))


def scalar_of(hand: Hand) -> Scalar:
    scalar = hand.scene.scalar
    assert scalar is not None
    return scalar


def labels_of(hand: Hand) -> set[str]:
    return {row.label for row in hand.viewer.board.content.rows()}


def test_every_column_of_the_scalar_has_a_row(hand: Hand) -> None:
    hand.viewer.session.edit(hand.scene.with_scalar(name="zebra"))
    rows = {"name": "scalar", "limits": "own range", "surfaces": "colored", "direction": "direction x"}
    rows["legend_place"] = "legend placed"
    assert {rows.get(name, name) for name in fields_of(Scalar)} <= labels_of(hand)


def test_the_legend_is_dragged_and_let_go_again(hand: Hand) -> None:
    hand.viewer.session.edit(hand.scene.with_scalar(name="z", legend=True))

    def place() -> tuple[int, int]:
        hand.viewer.tell("")
        return hand.handle("the legend")

    before = hand.scene
    left, top = place()
    hand.drag((left + 5, top + 20), (left - 90, top + 50), (left + 105, top + 80))
    assert place() == (left + 100, top + 60)
    assert hand.scene.view == before.view
    hand.pick("legend placed")
    assert place() == (left, top)
    undo(hand)
    assert place() == (left + 100, top + 60)
    undo(hand)
    assert hand.scene is before


def test_a_scale_is_reversed_and_stays_so_when_another_is_chosen(hand: Hand) -> None:
    hand.pick("reversed")
    assert scalar_of(hand).scale == "viridis_r"
    hand.choose("scale", "turbo")
    assert scalar_of(hand).scale == "turbo_r"
    hand.pick("reversed")
    assert scalar_of(hand).scale == "turbo"
    # A list of colors has no name to reverse.
    hand.viewer.session.edit(hand.scene.with_scalar(scale=["red", "blue"]))
    hand.viewer.tell("")
    hand.pick("reversed")
    assert scalar_of(hand).scale == ((255, 0, 0), (0, 0, 255))
    hand.choose("scale", "turbo")
    assert scalar_of(hand).scale == "turbo"


@pytest.mark.parametrize(
    ("label", "name", "column", "value"),
    [
        ("below", "cyan", "below", (0, 255, 255)),
        ("above", "red", "above", (255, 0, 0)),
        ("missing", "magenta", "missing", (255, 0, 255)),
        ("scale", "turbo", "scale", "turbo"),
        ("legend", "", "legend", True),
        ("colored", "", "surfaces", ("high",)),
        ("around zero", "", "limits", (-1.0, 1.0)),
        ("own range", "", "limits", (0.0, 1.0)),
    ],
)
def test_a_click_sets_a_column_alone_and_is_one_step_without_rendering(
    hand: Hand, label: str, name: str, column: str, value: object
) -> None:
    before, picture = hand.scene, hand.viewer.studio.picture
    hand.pick(label)
    if name:
        hand.pick(name)
    assert scalar_of(hand) == before.with_scalar(**{column: value}).scalar  # type: ignore[arg-type]
    assert hand.viewer.studio.picture is picture
    undo(hand)
    assert hand.scene is before


def test_a_scalar_is_chosen_and_taken_away(hand: Hand) -> None:
    hand.choose("scalar", "none")
    assert hand.scene.scalar is None
    assert labels_of(hand) == {"scalar"}
    hand.choose("scalar", "slope")
    # Only scalars that are computed with them have a direction and stripes.
    assert {"direction x", "stripes"} & labels_of(hand) == {"direction x"}


def test_another_scalar_comes_in_its_own_range_and_stripes_in_black_and_white(hand: Hand) -> None:
    hand.viewer.session.edit(hand.scene.with_scalar(limits=[1, 2], scale="turbo"))
    for name, looks in (("stress", ("turbo", 16)), ("zebra", ("zebra", 2)), ("z", ("viridis", 16))):
        hand.choose("scalar", name)
        assert scalar_of(hand).limits is None
        assert (scalar_of(hand).scale, scalar_of(hand).bands) == looks


def test_a_click_tells_the_value_that_is_seen_there(hand: Hand) -> None:
    hand.click(250, 240)
    value = hand.viewer.studio.picture.scalar
    assert value is not None
    assert f"z {value[240, 250]:.5g}, shade " in hand.viewer.message


def test_limits_appear_when_the_own_range_is_left_and_do_not_cross(hand: Hand) -> None:
    assert not {"low limit", "high limit"} & labels_of(hand)
    hand.pick("own range")
    assert scalar_of(hand).limits == (0.0, 1.0)
    before, picture = hand.scene, hand.viewer.studio.picture
    hand.pull("high limit", 0.9, 0.5)
    assert scalar_of(hand).limits == pytest.approx((0.0, 0.5), abs=0.02)
    assert hand.viewer.studio.picture is picture
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.scene is before
    for label, start, end in (("high limit", 0.9, 0.3), ("low limit", 0.1, 0.9), ("high limit", 0.5, 0.0)):
        hand.pull(label, start, end)
        low, high = scalar_of(hand).limits or (0, 0)
        assert low < high
    assert high < low + 0.01
    hand.pick("own range")
    assert scalar_of(hand).limits is None


@pytest.mark.parametrize("limits", [(0.0, 5e-324), (-5e-324, 0.0)])
def test_limits_may_be_as_close_as_numbers_are(tmp_path: Path, limits: tuple[float, float]) -> None:
    hand = hand_at(tmp_path, "scalar", boxes().with_scalar(name="z", limits=limits, legend=True))
    hand.pull("high limit", 0.9, 0.5)
    assert scalar_of(hand).limits != limits


def test_a_held_range_has_the_fewest_digits(tmp_path: Path) -> None:
    mesh = boxes().mesh
    tenths = Mesh(mesh.coordinates * 0.1, mesh.node_numbers)
    hand = hand_at(tmp_path, "scalar", scene_of(tenths).with_scalar(name="z", legend=False))
    assert hand.viewer.studio.picture.scalar_limits == (0.0, float(np.float32(0.1)))
    hand.pick("own range")
    assert scalar_of(hand).limits == (0.0, 0.1)
    assert words_are_those_of_the_scene(hand)
