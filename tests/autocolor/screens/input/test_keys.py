from __future__ import annotations

import pytest

from autocolor.screens.input.keys import Binding, Chord


@pytest.mark.parametrize(
    ("chord", "text"),
    [
        (Chord("f1"), "F1"),
        (Chord("escape"), "Esc"),
        (Chord("tab"), "Tab"),
        (Chord("left"), "Left"),
        (Chord("c", shift=True), "Shift+C"),
        (Chord("z", control=True, shift=True), "Ctrl+Shift+Z"),
        (Chord("["), "["),
    ],
)
def test_a_chord_is_written_as_on_a_keyboard(chord: Chord, text: str) -> None:
    assert str(chord) == text


def test_a_binding_is_written_as_its_chords_or_its_label() -> None:
    chords = (Chord("up"), Chord("down"))
    assert str(Binding[object](chords, "look", lambda _, __: None)) == "Up, Down"
    assert str(Binding[object](chords, "look", lambda _, __: None, label="arrows")) == "arrows"


@pytest.mark.parametrize(("name", "is_sign"), [("1", True), ("+", True), ("a", False), ("f1", False)])
def test_digits_and_signs_are_signs(name: str, is_sign: bool) -> None:
    assert Chord(name).is_sign == is_sign
