from __future__ import annotations

import math

import pytest

from autocolor import Flap, Flaps, Scene
from autocolor.journal.history import History
from autocolor.screens.tutorial.lessons import LESSONS, Lesson, work_of
from autocolor.widgets.items import CHARACTER
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN
from tests.autocolor.sessions import car

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


def test_saving_is_done_by_files_and_not_by_opening_a_scene() -> None:
    (lesson,) = [each for each in LESSONS if each.name == "save"]
    history = History(CAR)
    before = work_of(history)
    history.mark_saved({})
    assert not lesson.is_done(before, work_of(history))
    history.mark_saved({"/tmp/car.npz": "0"})
    assert lesson.is_done(before, work_of(history))


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


def test_the_lines_fit_into_the_panel() -> None:
    room = (WORK.width - 2 * MARGIN) // CHARACTER
    assert [line for lesson in LESSONS for line in lesson.lines if len(line) > room] == []
