from __future__ import annotations

from autocolor.files.repair.names import LONGEST_NAME, different, name_of, printable_name


def test_names_that_repeat_become_different() -> None:
    assert different(["a", "a", "b", "a", "a 2"]) == ("a", "a 2", "b", "a 3", "a 2 2")
    assert different(["q", "q", "q"], " of polygons") == ("q", "q of polygons", "q of polygons 2")


def test_a_name_is_printable_and_not_too_long() -> None:
    assert printable_name("  b\0" + "c" * 300) == "b?" + "c" * (LONGEST_NAME - 2)
    assert printable_name(" \t") == ""


def test_bytes_that_are_not_utf_8_are_latin_1() -> None:
    assert (name_of(" Kühler ".encode()), name_of("Kühler".encode("latin-1"))) == ("Kühler", "Kühler")


def test_a_name_that_is_cut_within_a_letter_is_still_utf_8() -> None:
    assert name_of(("x" + "ü" * 1000).encode()) == "x" + "ü" * (LONGEST_NAME - 1)
