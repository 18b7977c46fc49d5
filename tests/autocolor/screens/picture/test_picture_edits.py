"""The edits themselves are tried through the viewer, in test_viewer.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.screens.picture.picture_edits import PictureEdits
from autocolor.screens.session import Session
from autocolor.studio import Studio
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import wall_scene


@pytest.fixture
def session(tmp_path: Path) -> Session:
    display = Ramtek9300()
    return Session(Studio(wall_scene(lights=[]), display), display, tmp_path)


def test_a_light_that_a_scene_does_not_have_is_told(session: Session) -> None:
    PictureEdits(session).switch_light(0)
    assert session.message == "the scene has no light 1"


def test_an_edit_of_a_movement_passes_on_that_it_is_one(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[tuple[bool, bool]] = []
    monkeypatch.setattr(
        session.studio, "edit", lambda scene, same_step, moving: told.append((same_step, moving))
    )
    for is_one in (False, True):
        session.same_step = session.moving = is_one
        PictureEdits(session).turn(5, 0)
    assert told == [(False, False), (True, True)]
