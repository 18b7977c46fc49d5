from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from autocolor import Flap, Flaps, Light, Scene, read_scene
from autocolor.journal.history import History
from autocolor.scene.scalar import Scalar
from autocolor.scene.surfaces import Paint
from autocolor.scene.swatches import swatches
from autocolor.screens.comparing import NOW
from autocolor.screens.surface.painting import change_paint
from autocolor.screens.tutorial import END, LESSONS, Tutorial, work_of
from autocolor.screens.viewer import SCREENS, Viewer
from autocolor.widgets.items import CHARACTER
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boxes import told
from tests.autocolor.screens.hand import Hand
from tests.small import car
from tests.tables import first

ROOT = Path(__file__).parents[3]


@cache
def coupe() -> Scene:
    return read_scene(ROOT / "scenes/coupe")


Act = Callable[[Hand], object]

BOX = 0.95
"""Where the box of a row is, as a share of its width."""


def calls(method: str) -> Callable[..., Act]:
    """Gives acts that call a method of a hand."""
    return lambda *arguments: lambda hand: getattr(hand, method)(*arguments)


pick, go, pull, drag = map(calls, ("pick", "turn_to", "pull", "drag"))
menu = Hand.open_menu


def drag_handle(label: str, number: int, right: int, down: int) -> Act:
    """Drag one of the handles of a label; each projection has its own."""

    def act(hand: Hand) -> None:
        handles = [each for each in hand.viewer.board.content.handles if each.label.startswith(label)]
        element, line = handles[number].element, handles[number].line
        hand.drag((element, line), (element + right, line + down))

    return act


def turn(hand: Hand) -> None:
    """Turn the object before the task begins."""
    hand.drag((300, 60), (340, 60))
    hand.steps = 0


def recolor(hand: Hand) -> None:
    """Give the body another color before the task begins."""
    hand.press("c")


def key(hand: Hand) -> Light:
    return hand.scene.lights["key"]


def paint(hand: Hand) -> Paint:
    return hand.scene.surfaces["body"].paint


def all_differ(before: Sequence[float] | None, now: Sequence[float] | None) -> bool:
    return before is not None and now is not None and all(np.not_equal(before, now))


def is_split_elsewhere(hand: Hand) -> bool:
    words = hand.display.words[:400, 200:320].copy()
    hand.drag((200, 200), (320, 200))
    hand.steps -= 1
    return not np.array_equal(hand.display.words[:400, 200:320], words)


# Tasks of a lighting designer, each by the joystick unit alone.

TASKS: dict[str, tuple[Sequence[Act], Act]] = {
    "move a light": (
        [go("light & view"), drag_handle("key: x", 0, 40, -30), drag_handle("key: x", 1, 0, -40)],
        lambda hand: all_differ(coupe().lights["key"].position, key(hand).position),
    ),
    "aim a light": (
        [go("light & view"), drag_handle("key: aim", 0, 12, -12), drag_handle("key: aim", 1, 12, -12)],
        lambda hand: all_differ(coupe().lights["key"].aim, key(hand).aim),
    ),
    "set a flap": (
        [go("lights"), pick("flaps", BOX), pick("z minimum", BOX)],
        lambda hand: (flap := key(hand).flaps.z) is not None and flap.on and math.isfinite(flap.minimum),
    ),
    "switch a cone on and off": (
        [go("lights"), pick("cone angle", BOX), pick("cone angle", BOX)],
        lambda hand: hand.scene.equals(coupe()) and len(hand.viewer.studio.history.to_undo) == 2,
    ),
    "set intensity and concentration": (
        [go("lights"), pull("intensity", 0.5, 0.8), pull("concentration", 0.2, 0.4)],
        lambda hand: key(hand).intensity > 1.2 and key(hand).concentration > 20,
    ),
    "switch a light": ([menu, pick("side", BOX)], lambda hand: not hand.scene.lights["side"].on),
    "choose any paint": (
        [go("color mixing"), pick("paints", 0.7)],
        lambda hand: paint(hand).object_color in set(map(tuple, swatches().tolist())),
    ),
    "blend": (
        [go("color mixing"), pick("blend bar", 0.5)],
        lambda hand: paint(hand).blend == pytest.approx(0.5, abs=0.01),
    ),
    "mix a ramp": (
        [go("color mixing"), pick("ramp", BOX), pick("ramp bar", 0.6), pick("paints", 0.7)],
        lambda hand: (paint(hand).ramp or ())[3] in set(map(tuple, swatches().tolist())),
    ),
    # A drag along a choice goes through all names.
    "color by a scalar": (
        [go("scalar"), pull("scalar", 0.3, 0.7), pull("scale", 0.3, 0.7)],
        lambda hand: hand.scene.scalar and hand.scene.scalar.scale != Scalar(hand.scene.scalar.name).scale,
    ),
    "turn and move the view": (
        [drag((300, 60), (340, 60), (360, 70)), menu, pull("move", 0.3, 0.7)],
        lambda hand: (
            hand.scene.view.eye != coupe().view.eye and hand.scene.view.target != coupe().view.target
        ),
    ),
    "save": ([turn, go("file"), pick("save")], lambda hand: "*" not in hand.viewer.caption),
    "undo": ([recolor, menu, pick(" ", 0.1)], lambda hand: hand.scene is coupe()),
    "go back several steps": (
        [recolor, recolor, recolor, menu, pick(" ", 0.5), pick("  0  as the session began")],
        lambda hand: hand.scene is coupe(),
    ),
    "compare": (
        [recolor, menu, pick("compare"), pick("compare")],
        lambda hand: hand.message == f"shown: {NOW}",
    ),
    "see what an edit sent": ([turn, menu, pick("what was sent")], lambda hand: hand.viewer.page == "sent"),
    "explain a pixel": (
        [menu, pick("explain a pixel"), lambda hand: hand.click(200, 240)],
        lambda hand: hand.viewer.page == "explain",
    ),
    "compare side by side": (
        [recolor, menu, pick("compare", 0.75), drag((320, 200), (200, 200))],
        is_split_elsewhere,
    ),
}


@pytest.mark.parametrize("name", first(5, TASKS))
def test_a_task_is_done_by_pointing_in_at_most_five_steps(tmp_path: Path, name: str) -> None:
    hand = Hand(Viewer(coupe(), Ramtek9300(), tmp_path))
    acts, is_done = TASKS[name]
    for act in acts:
        act(hand)
        assert not told(hand)[1]
    assert is_done(hand)
    assert hand.steps <= 5


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return Hand(Viewer(car(), Ramtek9300(), tmp_path))


@pytest.fixture
def tutorial(hand: Hand) -> Tutorial:
    found = Tutorial(hand.viewer.session)
    hand.viewer.board.over = found.widgets
    hand.viewer.tell("")
    return found


def name_of(tutorial: Tutorial) -> str:
    return "" if tutorial.lesson is None else tutorial.lesson.name


def test_the_whole_tutorial_is_done_by_the_unit_alone(hand: Hand, tutorial: Tutorial, tmp_path: Path) -> None:
    assert name_of(tutorial) == "move a light"
    hand.turn_to("light & view")
    element, line = hand.handle("key: x")
    hand.drag((element, line), (element + 20, line - 10))
    assert name_of(tutorial) == "flaps"
    hand.turn_to("picture")
    hand.turn_to("lights")
    hand.pick("flaps", 0.8)
    assert name_of(tutorial) == "flaps"
    hand.pick("y minimum", 0.95)
    assert name_of(tutorial) == "a cone"
    hand.pull("cone angle", 0.3, 0.6)
    assert name_of(tutorial) == "mix a color"
    # How colors are mixed and blended is the affair of those screens; what counts is the scene.
    change_paint(hand.viewer.session, object_color="#204080")
    hand.viewer.tell("")
    assert name_of(tutorial) == "blend"
    change_paint(hand.viewer.session, blend=0.2)
    hand.viewer.tell("")
    assert name_of(tutorial) == "save"
    hand.turn_to("picture")
    hand.turn_to("file")
    hand.pick("save")
    assert name_of(tutorial) == ""
    assert list(tmp_path.glob("*.npz"))
    hand.pick("end")
    assert tutorial.has_ended
    assert tutorial.widgets() == ()


def test_a_lesson_is_skipped_and_undo_does_not_go_back_to_one(hand: Hand, tutorial: Tutorial) -> None:
    hand.pick("skip")
    hand.pick("skip")
    hand.turn_to("lights")
    hand.pull("cone angle", 0.3, 0.6)
    hand.pick(" ", 0.1)
    assert name_of(tutorial) == "mix a color"
    for _ in range(3):
        hand.pick("skip")
    assert tutorial.lesson is None
    assert "skip" not in hand.labels


def test_the_panel_stands_on_every_screen_is_folded_and_makes_room(hand: Hand, tutorial: Tutorial) -> None:
    before = hand.scene
    for screen in SCREENS[::4]:
        hand.go_to(screen.name)
        places = []
        for move in ("up", "down"):
            place = hand.widget("tutorial").area
            places.append(place)
            assert WORK.covers(place)
            assert hand.viewer.board.is_covered(place.left + 8, place.top + 20)
            hand.drag((100, place.bottom - 5), (200, place.bottom - 90))
            hand.pick("tutorial")
            assert hand.widget("tutorial").area.height < place.height / 2
            hand.pick("tutorial")
            hand.pick(move)
        assert not places[0].overlaps(places[1])
    assert hand.scene is before
    # The next lesson is shown whole.
    hand.pick("tutorial")
    hand.pick("skip")
    assert hand.widget("tutorial").area == places[0]


CAR = car()

EDITS: list[tuple[Scene, str]] = [
    (CAR.with_light("fill", position=(1, 2, 3)), "move a light"),
    (CAR.with_light("key", flaps=Flaps(x=Flap(0.0, math.inf))), "flaps"),
    (CAR.with_light("fill", aim=(0, 0, 0), cone_angle=20), "a cone"),
    (CAR.with_paint("body", object_color="#123456"), "mix a color"),
    (CAR.with_paint("glass", blend=0.25), "blend"),
    (CAR.with_light("key", name="main", position=(9, 9, 9)), ""),
    (CAR.with_light("key", flaps=Flaps(x=Flap())), ""),
    (CAR.with_light("key", flaps=Flaps(x=Flap(0.0, 1.0, on=False))), ""),
    (CAR.with_light("key", cone_angle=None), ""),
    (CAR.with_light("key", intensity=0.5), ""),
]


@pytest.mark.parametrize(("scene", "done"), EDITS)
def test_a_lesson_is_done_by_the_edit_that_it_asks_for_alone(scene: Scene, done: str) -> None:
    history = History(CAR)
    before = work_of(history)
    history.take(scene, False)
    now = work_of(history)._replace(saved=before.saved)
    assert [lesson.name for lesson in LESSONS if lesson.is_done(before, now)] == ([done] if done else [])


def test_a_scene_is_saved_when_it_has_files() -> None:
    history, seen = History(CAR), []
    *_, save = LESSONS
    for files in ({}, {"car.npz": "stamp"}):
        before = work_of(history)
        history.mark_saved(files)
        seen.append(save.is_done(before, work_of(history)))
    # A scene that was saved before the lesson does not count.
    assert [*seen, save.is_done(work_of(history), work_of(history))] == [False, True, False]


def test_the_lines_fit_into_the_panel() -> None:
    room = (WORK.width - 2 * MARGIN) // CHARACTER
    texts = [END, *(lesson.text for lesson in LESSONS)]
    assert all(len(line) <= room for text in texts for line in text.splitlines())
