"""Gestures are tried through the board, in test_board.py; here, which of them are one step."""

from __future__ import annotations

from collections import Counter
from functools import partial
from pathlib import Path

import pytest

from autocolor.errors import UsageError
from autocolor.scene.columns import Tier
from autocolor.screens.input import Binding, Chord, Gesture
from autocolor.screens.pointing import BINDINGS, WHEEL, WINDOW_KEYS, Doing
from autocolor.screens.session import Session
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import wall_scene
from tests.autocolor.screens.boards import Desk, desk_viewer, middle_of, point


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


# -------------------- test_keyboard
# What each key does is tried in test_viewer.py and test_bindings.py; here, who gets it.


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


@pytest.fixture
def session(tmp_path: Path) -> Session:
    return desk_viewer(tmp_path).session


def test_what_continues_is_one_step_and_what_does_not_another(session: Session) -> None:
    doing, before = Doing(session), session.scene
    for value, source, continues in ((0.1, "a", True), (0.2, "a", True), (0.3, "b", True), (0.4, "b", False)):
        change = partial(session.edit, session.scene.replace(ambient=value))
        assert doing.do((source, 0), change, continues, False)
        assert doing.was_by((source, 0))
        assert doing.kind == source
        assert doing.costs is Tier.MIX
    seen = []
    while session.studio.undo():
        seen.append(session.scene.ambient)
    assert seen == [0.3, 0.2, 0.0]
    assert session.scene is before


def test_an_error_is_a_message_and_what_does_nothing_leaves_the_last_one(session: Session) -> None:
    doing = Doing(session)

    def refuse() -> None:
        raise UsageError("a number must be one\nchoose it")

    assert doing.do(None, refuse, False, False)
    assert (session.message, session.news.is_warning) == ("a number must be one; choose it", True)
    assert not doing.do(None, lambda: False, False, False)
    assert session.message == "a number must be one; choose it"
    assert doing.do(None, lambda: None, False, False)
    assert session.message == ""
    assert doing.kind is None


def test_unsaved_changes_are_announced_once(session: Session) -> None:
    doing = Doing(session)
    session.has_keyboard = True
    assert not doing.warns_of_changes("again")
    session.edit(session.scene.replace(ambient=0.5))
    assert doing.warns_of_changes("again")
    assert session.message == "not saved: Ctrl+S saves, again"
    assert not doing.warns_of_changes("again")
    doing.do(None, lambda: None, False, False)
    assert doing.warns_of_changes("again")


PRESSES = [(binding, number, chord) for binding in BINDINGS for number, chord in enumerate(binding.chords)]


def test_no_two_keys_are_the_same() -> None:
    chords = Counter(chord for binding in BINDINGS for chord in binding.chords)
    assert not [chord for chord, count in chords.items() if count > 1]


@pytest.mark.parametrize(("binding", "number", "chord"), PRESSES, ids=[str(chord) for _, _, chord in PRESSES])
def test_every_key_reaches_what_it_does(
    binding: Binding[Viewer], number: int, chord: Chord, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran: list[object] = []

    def do(viewer: Viewer, source: object, *rest: object) -> bool:
        # The menu and the screen are asked first, and do not take it.
        ran.append(source)
        return source == (binding, number)

    monkeypatch.setattr(Viewer, "_do", do)
    viewer = Viewer(wall_scene(lights=[]), Ramtek9300())
    viewer.on_key(chord.name, chord.control, chord.shift)
    assert ran[-1] == (binding, number)
    assert ran[:-1] == ([] if chord.control else [("key", chord.name)] * 2)


def test_every_key_says_what_it_does_in_words_of_its_own() -> None:
    said = [binding.does for binding in BINDINGS] + [does for _, does in WINDOW_KEYS]
    assert all(said)
    assert len(set(said)) == len(said)


def test_the_keys_of_the_window_are_not_taken_by_the_viewer() -> None:
    taken = {str(chord) for binding in BINDINGS for chord in binding.chords}
    assert not taken & {"F11", "F12", "Ctrl+Q"}
    assert {keys for keys, _ in WINDOW_KEYS} >= {"F12", "Ctrl+Q"}
