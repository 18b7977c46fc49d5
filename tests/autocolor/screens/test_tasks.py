"""Tasks of a lighting designer, each by the joystick unit alone, with the number of its steps.

The table of docs/guides/studio.md tells the same numbers.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from autocolor import Scene, read_scene
from autocolor.scene.scalar import Scalar
from autocolor.scene.swatches import swatches
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand

ROOT = Path(__file__).parents[3]


@cache
def coupe() -> Scene:
    return read_scene(ROOT / "scenes/coupe")


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return Hand(Viewer(coupe(), Ramtek9300(), tmp_path))


def go_to(hand: Hand, screen: str) -> None:
    hand.open_menu()
    hand.pick(screen)
    assert hand.viewer.message == "" or not hand.viewer.session.news.is_warning


def move_a_light(hand: Hand) -> None:
    go_to(hand, "light & view")
    element, line = hand.handle("key: x")
    hand.drag((element, line), (element + 20, line - 10), (element + 40, line - 30))
    front = [each for each in hand.viewer.board.screen.handles() if each.label.startswith("key: x")][1]
    hand.drag((front.element, front.line), (front.element, front.line - 40))
    before, now = coupe().light("key"), hand.viewer.studio.scene.light("key")
    assert all(a != b for a, b in zip(before.position, now.position, strict=True))


def aim_a_light(hand: Hand) -> None:
    go_to(hand, "light & view")
    for number in (0, 1):
        aims = [each for each in hand.viewer.board.screen.handles() if each.label.startswith("key: aim")]
        element, line = aims[number].element, aims[number].line
        hand.drag((element, line), (element + 12, line - 12))
    before, now = coupe().light("key"), hand.viewer.studio.scene.light("key")
    assert before.aim is not None
    assert now.aim is not None
    assert all(a != b for a, b in zip(before.aim, now.aim, strict=True))


def set_a_flap(hand: Hand) -> None:
    go_to(hand, "lights")
    hand.pick("flaps z", 0.95)
    hand.pick("z minimum", 0.95)
    flap = hand.viewer.studio.scene.light("key").flaps.z
    assert flap is not None
    assert flap.on
    assert np.isfinite(flap.minimum)


def switch_a_cone_on_and_off(hand: Hand) -> None:
    go_to(hand, "lights")
    hand.pick("cone angle", 0.95)
    assert hand.viewer.studio.scene.light("key").cone_angle is not None
    hand.pick("cone angle", 0.95)
    assert hand.viewer.studio.scene.light("key").cone_angle is None


def set_intensity_and_concentration(hand: Hand) -> None:
    go_to(hand, "lights")
    hand.pull("intensity", 0.5, 0.8)
    hand.pull("concentration", 0.2, 0.4)
    light = hand.viewer.studio.scene.light("key")
    assert light.intensity > 1.2
    assert light.concentration > 20


def switch_a_light(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("side", 0.95)
    assert not hand.viewer.studio.scene.light("side").on


def choose_any_paint(hand: Hand) -> None:
    go_to(hand, "color mixing")
    hand.pick("paints", 0.7)
    assert hand.viewer.studio.scene.surface("body").paint.object_color in set(map(tuple, swatches().tolist()))


def blend(hand: Hand) -> None:
    go_to(hand, "light blending")
    hand.move(20, 20)
    hand.pick("blend level", 0.5)
    assert hand.viewer.studio.scene.surface("body").paint.blend == pytest.approx(0.5, abs=0.01)


def mix_a_ramp(hand: Hand) -> None:
    go_to(hand, "color mixing")
    hand.pick("ramp", 0.95)
    hand.pick("ramp bar", 0.6)
    before = hand.viewer.studio.scene.surface("body").paint.ramp
    hand.pick("paints", 0.7)
    after = hand.viewer.studio.scene.surface("body").paint.ramp
    assert before is not None
    assert after is not None
    assert [color for color, other in zip(after, before, strict=True) if color != other] == [after[3]]


def color_by_a_scalar(hand: Hand) -> None:
    go_to(hand, "scalar")
    # A drag along a choice goes through all names.
    hand.pull("scalar", 0.3, 0.7)
    hand.pull("scale", 0.3, 0.7)
    scalar = hand.viewer.studio.scene.scalar
    assert scalar is not None
    assert scalar.scale != Scalar(scalar.name).scale


def turn_and_move_the_view(hand: Hand) -> None:
    hand.drag((300, 60), (340, 60), (360, 70))
    hand.open_menu()
    hand.pull("move", 0.3, 0.7)
    assert hand.viewer.studio.scene.view.eye != coupe().view.eye
    assert hand.viewer.studio.scene.view.target != coupe().view.target


def save(hand: Hand) -> None:
    hand.drag((300, 60), (340, 60))
    hand.steps = 0
    go_to(hand, "file")
    hand.pick("save")
    assert not hand.viewer.studio.is_changed


def undo(hand: Hand) -> None:
    hand.drag((300, 60), (340, 60))
    hand.steps = 0
    hand.open_menu()
    hand.pick(" ", 0.1)
    assert hand.viewer.studio.scene is coupe()


def go_back_several_steps(hand: Hand) -> None:
    for _ in range(3):
        hand.drag((300, 60), (340, 60))
    hand.steps = 0
    hand.open_menu()
    hand.pick(" ", 0.5)
    hand.pick("step 0")
    assert hand.viewer.studio.scene is coupe()


def see_what_an_edit_sent(hand: Hand) -> None:
    hand.drag((300, 60), (340, 60))
    hand.steps = 0
    hand.open_menu()
    hand.pick("what was sent")
    last = hand.viewer.session.last_edit
    assert hand.viewer.page == "sent"
    assert last is not None
    assert last.after is hand.viewer.studio.scene
    assert len(last.words) > 0


def explain_a_pixel(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("explain a pixel")
    hand.click(200, 240)
    assert (hand.viewer.page, hand.viewer.session.pixel) == ("explain", (240, 200))


def compare_side_by_side(hand: Hand) -> None:
    hand.drag((300, 60), (340, 60))
    hand.steps = 0
    hand.open_menu()
    hand.pick("compare", 0.75)
    scene, words = hand.viewer.studio.scene, hand.viewer.board.screen.base()
    hand.drag((320, 200), (200, 200))
    assert not np.array_equal(hand.viewer.board.screen.base(), words)
    assert hand.viewer.studio.scene is scene


def compare(hand: Hand) -> None:
    hand.drag((300, 60), (340, 60))
    hand.steps = 0
    hand.open_menu()
    for is_before in (True, False):
        hand.pick("compare")
        assert hand.viewer.session.comparing.is_on == is_before


TASKS: dict[str, Callable[[Hand], None]] = {
    "move a light": move_a_light,
    "aim a light": aim_a_light,
    "set a flap": set_a_flap,
    "switch a cone on and off": switch_a_cone_on_and_off,
    "set intensity and concentration": set_intensity_and_concentration,
    "switch a light": switch_a_light,
    "choose any paint": choose_any_paint,
    "blend": blend,
    "mix a ramp": mix_a_ramp,
    "color by a scalar": color_by_a_scalar,
    "turn and move the view": turn_and_move_the_view,
    "save": save,
    "undo": undo,
    "go back several steps": go_back_several_steps,
    "compare": compare,
    "see what an edit sent": see_what_an_edit_sent,
    "explain a pixel": explain_a_pixel,
    "compare side by side": compare_side_by_side,
}


@pytest.mark.parametrize("name", TASKS)
def test_a_task_is_done_by_pointing_in_as_many_steps_as_the_guide_tells(hand: Hand, name: str) -> None:
    TASKS[name](hand)
    table = (ROOT / "docs/guides/studio.md").read_text()
    told = re.search(rf"^\| {name} \| .* \| (\d+) \|$", table, re.MULTILINE)
    assert told is not None, f"docs/guides/studio.md does not tell how to {name}"
    assert hand.steps == int(told[1])
    assert hand.steps <= 5


def test_the_guide_tells_of_these_tasks_and_no_other() -> None:
    table = (ROOT / "docs/guides/studio.md").read_text()
    assert re.findall(r"^\| ([a-z ]+) \| .* \| \d+ \|$", table, re.MULTILINE) == list(TASKS)
