"""What each key does is tried in test_viewer.py and test_bindings.py; here, who gets it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.autocolor.screens.boards import Desk, desk_viewer, middle_of, point


def test_a_key_goes_to_the_typed_text_then_to_the_screen_then_to_its_binding(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer = desk_viewer(tmp_path)
    before: list[str] = []

    def key(desk: Desk, name: str, typed: str) -> bool:
        before.append(name)
        return name == "c"

    monkeypatch.setattr(Desk, "key", key)
    scene = viewer.studio.scene
    viewer.on_key("c", typed="c")
    assert viewer.studio.scene is scene
    viewer.on_key("e", typed="e")
    assert before == ["c", "e"]
    assert viewer.studio.scene is not scene
    point(viewer, "hover", *middle_of(viewer.board, "ambient"))
    viewer.on_key("1", typed="1")
    viewer.on_key("e", typed="e")
    assert before == ["c", "e"]
    assert viewer.board.message[0] == "ambient: 1e_"


def test_a_key_with_control_is_never_typed(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    viewer.session.edit(viewer.studio.scene.replace(ambient=0.5))
    point(viewer, "hover", *middle_of(viewer.board, "ambient"))
    viewer.on_key("1", typed="1")
    viewer.on_key("z", control=True, typed="\x1a")
    assert viewer.studio.scene.ambient == 0.0
    assert not viewer.board.typing.is_on
