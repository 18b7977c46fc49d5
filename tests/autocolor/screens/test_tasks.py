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
from autocolor.screens.session import BEFORE, NOW
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boxes import told
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
    assert not told(hand)[1]


def turn(hand: Hand) -> None:
    """Turn the object before the task."""
    hand.drag((300, 60), (340, 60))
    hand.steps = 0


def drag_two_handles(hand: Hand, label: str, *ways: tuple[int, int]) -> None:
    """Drag the handles of a label in the two projections."""
    for number, (right, down) in enumerate(ways):
        handles = [each for each in hand.viewer.board.screen.handles() if each.label.startswith(label)]
        element, line = handles[number].element, handles[number].line
        hand.drag((element, line), (element + right, line + down))


def move_a_light(hand: Hand) -> None:
    go_to(hand, "light & view")
    drag_two_handles(hand, "key: x", (40, -30), (0, -40))
    before, now = coupe().light("key"), hand.scene.light("key")
    assert all(a != b for a, b in zip(before.position, now.position, strict=True))


def aim_a_light(hand: Hand) -> None:
    go_to(hand, "light & view")
    drag_two_handles(hand, "key: aim", (12, -12), (12, -12))
    before, now = coupe().light("key").aim, hand.scene.light("key").aim
    assert before is not None
    assert now is not None
    assert all(a != b for a, b in zip(before, now, strict=True))


def set_a_flap(hand: Hand) -> None:
    go_to(hand, "lights")
    hand.pick("flaps z", 0.95)
    hand.pick("z minimum", 0.95)
    flap = hand.scene.light("key").flaps.z
    assert flap is not None
    assert flap.on
    assert np.isfinite(flap.minimum)


def switch_a_cone_on_and_off(hand: Hand) -> None:
    go_to(hand, "lights")
    for is_on in (True, False):
        hand.pick("cone angle", 0.95)
        assert (hand.scene.light("key").cone_angle is not None) is is_on


def set_intensity_and_concentration(hand: Hand) -> None:
    go_to(hand, "lights")
    hand.pull("intensity", 0.5, 0.8)
    hand.pull("concentration", 0.2, 0.4)
    assert hand.scene.light("key").intensity > 1.2
    assert hand.scene.light("key").concentration > 20


def switch_a_light(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("side", 0.95)
    assert not hand.scene.light("side").on


def choose_any_paint(hand: Hand) -> None:
    go_to(hand, "color mixing")
    hand.pick("paints", 0.7)
    assert hand.scene.surface("body").paint.object_color in set(map(tuple, swatches().tolist()))


def blend(hand: Hand) -> None:
    go_to(hand, "light blending")
    hand.move(20, 20)
    hand.pick("blend level", 0.5)
    assert hand.scene.surface("body").paint.blend == pytest.approx(0.5, abs=0.01)


def mix_a_ramp(hand: Hand) -> None:
    go_to(hand, "color mixing")
    hand.pick("ramp", 0.95)
    hand.pick("ramp bar", 0.6)
    before = hand.scene.surface("body").paint.ramp
    hand.pick("paints", 0.7)
    after = hand.scene.surface("body").paint.ramp
    assert before is not None
    assert after is not None
    assert [color for color, other in zip(after, before, strict=True) if color != other] == [after[3]]


def color_by_a_scalar(hand: Hand) -> None:
    go_to(hand, "scalar")
    # A drag along a choice goes through all names.
    hand.pull("scalar", 0.3, 0.7)
    hand.pull("scale", 0.3, 0.7)
    scalar = hand.scene.scalar
    assert scalar is not None
    assert scalar.scale != Scalar(scalar.name).scale


def turn_and_move_the_view(hand: Hand) -> None:
    hand.drag((300, 60), (340, 60), (360, 70))
    hand.open_menu()
    hand.pull("move", 0.3, 0.7)
    assert hand.scene.view.eye != coupe().view.eye
    assert hand.scene.view.target != coupe().view.target


def save(hand: Hand) -> None:
    turn(hand)
    go_to(hand, "file")
    hand.pick("save")
    assert "*" not in hand.viewer.caption


def undo(hand: Hand) -> None:
    turn(hand)
    hand.open_menu()
    hand.pick(" ", 0.1)
    assert hand.scene is coupe()


def go_back_several_steps(hand: Hand) -> None:
    for _ in range(3):
        turn(hand)
    hand.open_menu()
    hand.pick(" ", 0.5)
    hand.pick("step 0")
    assert hand.scene is coupe()


def see_what_an_edit_sent(hand: Hand) -> None:
    turn(hand)
    go_to(hand, "what was sent")
    assert hand.viewer.page == "sent"


def explain_a_pixel(hand: Hand) -> None:
    go_to(hand, "explain a pixel")
    hand.click(200, 240)
    assert (hand.viewer.page, hand.viewer.session.pixel) == ("explain", (240, 200))


def compare_side_by_side(hand: Hand) -> None:
    turn(hand)
    hand.open_menu()
    hand.pick("compare", 0.75)
    words = hand.display.words.copy()
    hand.drag((320, 200), (200, 200))
    assert not np.array_equal(hand.display.words[:400, 200:320], words[:400, 200:320])


def compare(hand: Hand) -> None:
    turn(hand)
    hand.open_menu()
    for name in (BEFORE, NOW):
        hand.pick("compare")
        assert hand.message.startswith(f"shown: {name}")


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
