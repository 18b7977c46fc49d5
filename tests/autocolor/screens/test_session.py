from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Light
from autocolor.mapping.level_ranges import BACKGROUND, SCREENS
from autocolor.screens.session import MESSAGE_SECONDS, Session
from autocolor.studio import Studio
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import wall_scene


@pytest.fixture
def session(tmp_path: Path) -> Session:
    display = Ramtek9300()
    lights = [Light("key", (1, -3, 2)), Light("fill", (-1, -3, 2))]
    return Session(Studio(wall_scene(lights=lights), display), display, tmp_path)


def test_the_word_of_a_pixel_tells_its_surface(session: Session) -> None:
    assert session.surface_of(session.word_at(320, 240)) == "wall"
    assert session.word_at(320, 240) == session.studio.words[240, 320]
    assert session.surface_of(BACKGROUND) == session.surface_of(SCREENS.first) == ""


def test_a_message_passes_after_a_while(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("time.monotonic", lambda: 100.0)
    session.tell("done")
    assert session.has_news
    monkeypatch.setattr("time.monotonic", lambda: 100.0 + MESSAGE_SECONDS)
    assert not session.has_news
    assert session.message == "done"


def test_the_first_light_is_chosen_until_another_is_and_again_when_that_is_gone(session: Session) -> None:
    assert session.light_name == "key"
    session.choose_light("fill")
    assert session.chosen_light is session.scene.light("fill")
    session.edit(session.scene.without_light("fill"))
    assert session.light_name == "key"
    session.edit(session.scene.without_light("key"))
    assert session.light_name == ""
    assert session.scene.lights == ()


def test_the_edits_of_one_gesture_are_one_step(session: Session) -> None:
    before = session.scene
    session.same_step = False
    session.change_light("key", intensity=0.5)
    session.change_surface("wall", levels=50)
    session.paint(blend=0.25)
    session.undo()
    assert session.scene is before
    assert session.message == "undone"
    session.redo()
    assert session.scene.surface("wall").paint.blend == 0.25
