from __future__ import annotations

from collections import Counter

import pytest

from autocolor.screens.bindings import BINDINGS, WINDOW_KEYS
from autocolor.screens.input.keys import Binding, Chord
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import wall_scene

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
