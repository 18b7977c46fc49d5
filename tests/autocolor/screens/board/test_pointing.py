"""Gestures are tried through the board, in test_board.py; here, which of them are one step."""

from __future__ import annotations

from pathlib import Path

from autocolor.screens.board.pointing import WHEEL
from autocolor.screens.input.gestures import Gesture
from tests.autocolor.screens.boards import desk_viewer, middle_of, point


def test_the_wheel_makes_one_step_on_each_widget(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    element, line = middle_of(viewer.board, "ambient")
    for _ in range(3):
        viewer.point(Gesture("wheel", element, line, steps=2))
    assert viewer.studio.scene.ambient == 0.06
    assert viewer._doing.kind == WHEEL
    viewer.on_key("z", control=True)
    assert viewer.studio.scene.ambient == 0.0


def test_two_drags_are_two_steps(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    element, line = middle_of(viewer.board, "ambient")
    seen = []
    for shift in (10, 30):
        seen.append(viewer.studio.scene)
        point(viewer, "grab", element, line)
        point(viewer, "drag", element + shift - 5, line)
        point(viewer, "drag", element + shift, line)
        point(viewer, "drop", element + shift, line)
    for scene in reversed(seen):
        viewer.on_key("z", control=True)
        assert viewer.studio.scene is scene
