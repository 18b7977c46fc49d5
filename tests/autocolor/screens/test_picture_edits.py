"""The edits themselves are tried through the viewer, in test_viewer.py."""

from __future__ import annotations

import pytest

from autocolor.screens.picture_edits import PictureEdits
from autocolor.studio import Studio
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import wall_scene


class Plain(PictureEdits):
    """Edits without pages."""

    message = ""

    def back(self) -> bool:
        return False


def test_the_edits_of_a_scene_without_lights_and_surfaces_in_use_are_told() -> None:
    edits = Plain()
    edits.begin(Studio(wall_scene(lights=[]), Ramtek9300()))
    edits.switch_light(0)
    assert edits.message == "the scene has no light 1"


def test_an_edit_of_a_movement_passes_on_that_it_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    edits = Plain()
    edits.begin(Studio(wall_scene(lights=[]), Ramtek9300()))
    told: list[tuple[bool, bool]] = []
    monkeypatch.setattr(
        edits.studio, "edit", lambda scene, same_step, moving: told.append((same_step, moving))
    )
    for is_one in (False, True):
        edits.same_step = edits.moving = is_one
        edits.turn(5, 0)
    assert told == [(False, False), (True, True)]
