from __future__ import annotations

import pytest

from autocolor import Scene
from autocolor.screens.session import Session
from benchmarks.color_drags import BLEND_BAR, COLOR_BAR, UPRIGHT_BAR, ColorDrag, color_drag_seconds


@pytest.mark.parametrize("drag", [COLOR_BAR, BLEND_BAR, UPRIGHT_BAR])
def test_each_movement_of_a_drag_edits_the_paint(drag: ColorDrag, monkeypatch: pytest.MonkeyPatch) -> None:
    edited: list[Scene] = []
    edit = Session.edit

    def noted(session: Session, scene: Scene) -> None:
        edited.append(scene)
        edit(session, scene)

    monkeypatch.setattr(Session, "edit", noted)
    found = color_drag_seconds(drag, rounds=20)
    assert len(edited) == 20
    assert len({scene.surface("body").paint for scene in edited}) > 10
    assert 0 < found.low <= found.median <= found.high
