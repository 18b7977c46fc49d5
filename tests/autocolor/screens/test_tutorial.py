from __future__ import annotations

import math
from pathlib import Path

import pytest

from autocolor import Flap, Flaps, Scene
from autocolor.journal.history import History
from autocolor.screens.tutorial import END, LESSONS, Lesson, Tutorial, work_of
from autocolor.screens.viewer import SCREENS, Viewer
from autocolor.widgets.items import CHARACTER
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand
from tests.small import car


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
    hand.open_menu()
    hand.pick("light & view")
    element, line = hand.handle("key: x")
    hand.drag((element, line), (element + 20, line - 10))
    assert name_of(tutorial) == "flaps"
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("lights")
    hand.pick("flaps y", 0.95)
    assert name_of(tutorial) == "flaps"
    hand.pick("y minimum", 0.95)
    assert name_of(tutorial) == "a cone"
    hand.pull("cone angle", 0.3, 0.6)
    assert name_of(tutorial) == "mix a color"
    # How colors are mixed and blended is the affair of those screens; what counts is the scene.
    hand.viewer.session.paint(object_color="#204080")
    hand.viewer.tell("")
    assert name_of(tutorial) == "blend"
    hand.viewer.session.paint(blend=0.2)
    hand.viewer.tell("")
    assert name_of(tutorial) == "save"
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("file")
    hand.pick("save")
    assert name_of(tutorial) == ""
    assert list(tmp_path.glob("*.npz"))
    hand.pick("end")
    assert tutorial.has_ended
    assert tutorial.widgets() == ()


def test_a_lesson_is_skipped_and_undo_does_not_go_back_to_one(hand: Hand, tutorial: Tutorial) -> None:
    hand.pick("skip")
    hand.pick("skip")
    assert name_of(tutorial) == "a cone"
    hand.open_menu()
    hand.pick("lights")
    hand.pull("cone angle", 0.3, 0.6)
    hand.pick(" ", 0.1)
    assert name_of(tutorial) == "mix a color"
    for _ in range(3):
        hand.pick("skip")
    assert tutorial.lesson is None
    assert "skip" not in [each.label for each in hand.viewer.board.widgets()]


def test_the_panel_stands_on_every_screen_and_makes_room(hand: Hand, tutorial: Tutorial) -> None:
    before = hand.scene
    for screen in SCREENS[::4]:
        hand.viewer.session.turn_to(screen.name)
        hand.viewer.tell("")
        places = []
        for _ in range(2):
            panel = next(each.area for each in hand.viewer.board.widgets() if each.label == "tutorial")
            places.append(panel)
            assert hand.viewer.board.is_covered(panel.left + 8, panel.top + 20)
            hand.pick("up" if panel.top else "down")
        assert not places[0].overlaps(places[1])
        hand.drag((100, places[0].bottom - 5), (200, places[0].bottom - 90))
        assert hand.scene is before
        assert all(WORK.covers(place) for place in places)


def test_the_panel_is_folded_to_its_first_line_until_the_next_lesson(hand: Hand, tutorial: Tutorial) -> None:
    def height() -> int:
        return next(each.area.height for each in hand.viewer.board.widgets() if each.label == "tutorial")

    whole = height()
    hand.pick("tutorial")
    assert height() < whole / 2
    hand.pick("skip")
    assert height() == whole


CAR = car()
BODY = CAR.surface("body")

DONE: dict[str, Scene] = {
    "move a light": CAR.with_light("fill", position=(1, 2, 3)),
    "flaps": CAR.with_light("key", flaps=Flaps(x=Flap(0.0, math.inf))),
    "a cone": CAR.with_light("fill", aim=(0, 0, 0), cone_angle=20),
    "mix a color": CAR.with_paint("body", object_color="#123456"),
    "blend": CAR.with_paint("glass", blend=0.25),
}


@pytest.mark.parametrize("lesson", LESSONS, ids=lambda lesson: str(lesson.name))
def test_a_lesson_is_done_by_what_it_asks_for_alone(lesson: Lesson) -> None:
    before = work_of(History(CAR))
    for name, scene in DONE.items():
        history = History(CAR)
        history.take(scene, False)
        assert lesson.is_done(before, work_of(history)._replace(saved=before.saved)) == (name == lesson.name)


@pytest.mark.parametrize(
    "changes",
    [
        {"name": "main", "position": (9, 9, 9)},
        {"flaps": Flaps(x=Flap())},
        {"flaps": Flaps(x=Flap(0.0, 1.0, on=False))},
        {"cone_angle": None},
        {"intensity": 0.5},
    ],
)
def test_a_flap_without_a_limit_and_a_cone_switched_off_are_not_enough(changes: dict[str, object]) -> None:
    history = History(CAR)
    before = work_of(history)
    history.take(CAR.with_light("key", **changes), False)  # type: ignore[arg-type]
    assert not any(lesson.is_done(before, work_of(history)) for lesson in LESSONS)


def test_what_is_saved_to_a_file_is_saved_and_what_is_opened_or_only_marked_is_not() -> None:
    history = History(CAR)
    before = work_of(history)

    def done() -> list[str]:
        return [lesson.name for lesson in LESSONS if lesson.is_done(before, work_of(history))]

    history.mark_saved({})
    assert done() == []
    history.mark_saved({"car.npz": "stamp"})
    assert done() == ["save"]
    # What was saved before the lesson does not count.
    before = work_of(history)
    assert done() == []


def test_the_lines_fit_into_the_panel() -> None:
    room = (WORK.width - 2 * MARGIN) // CHARACTER
    assert [line for lesson in LESSONS for line in lesson.lines if len(line) > room] == []
    assert max(map(len, END)) <= room
