"""Kept scenes by name, as an immutable value."""

from __future__ import annotations

import pytest

from autocolor import UsageError
from autocolor.journal import variants as room
from autocolor.journal.places import Place
from autocolor.journal.variants import Opened, Variants
from tests.autocolor.sessions import car

ONE = Opened(car(), Place())


def test_variants_keep_their_order_and_are_values() -> None:
    none = Variants()
    both = none.with_kept("B", ONE).with_kept("A", ONE)
    assert list(both) == ["B", "A"]
    assert both["A"] is ONE
    assert len(none) == 0
    assert list(Variants({"A": ONE, "B": Opened(car(), Place())}).without("A")) == ["B"]


def test_dropping_one_of_two_equal_variants_leaves_the_other() -> None:
    assert list(Variants().with_kept("A", ONE).with_kept("B", ONE).without("A")) == ["B"]


def test_a_name_in_use_is_never_given_to_another_scene() -> None:
    kept = Variants().with_kept("A", ONE)
    with pytest.raises(UsageError) as refusal:
        kept.with_kept("A", Opened(car(), Place()))
    assert str(refusal.value) == (
        "a variant must have a name of its own, and 'A' is in use; choose another, or drop that one"
    )


@pytest.mark.parametrize("name", ["", "x" * 101, 5])
def test_a_name_is_a_short_text(name: str) -> None:
    with pytest.raises(UsageError, match="a variant must have a name of 1 to 100 characters, not "):
        Variants().with_kept(name, ONE)


def test_an_unknown_name_is_told_with_the_closest() -> None:
    with pytest.raises(UsageError) as refusal:
        Variants().with_kept("evening", ONE)["evenin"]
    assert str(refusal.value) == "there is no variant 'evenin'; did you mean 'evening'?"


def test_free_names_are_letters_and_then_letters_with_numbers() -> None:
    kept = Variants()
    names = []
    for _ in range(54):
        names.append(kept.free_name())
        kept = kept.with_kept(names[-1], ONE)
    assert names[:3] == ["A", "B", "C"]
    assert names[25:28] == ["Z", "A2", "B2"]
    assert names[52:] == ["A3", "B3"]
    assert kept.without("C").free_name() == "C"


def test_there_are_not_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "MOST_VARIANTS", 1)
    with pytest.raises(UsageError, match="there must be at most 1 variants; drop one"):
        Variants().with_kept("A", ONE).with_kept("B", ONE)
