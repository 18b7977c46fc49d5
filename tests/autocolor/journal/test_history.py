"""The steps of a session, and that they give the same history when they are taken again."""

from __future__ import annotations

import pytest

from autocolor import UsageError
from autocolor.journal.history import Edit, History, Move, Show, Variants
from autocolor.journal.places import Opened, ScenePlace, Source
from tests.small import car
from tests.tables import call, refused

CAR = car()
SCENES = [CAR, *(CAR.replace(ambient=number / 8) for number in range(4))]


def test_a_drag_that_came_back_is_no_step_and_may_go_on() -> None:
    history = History(SCENES[0])
    history.take(SCENES[3])
    history.move("undo")
    for scene in (SCENES[1], SCENES[2], SCENES[0]):
        history.take(scene, same_step=True)
    drag = [Edit(SCENES[0], SCENES[2]), Edit(SCENES[2], SCENES[0], joins=True)]
    assert history.steps[2:] == drag
    assert (history.to_undo, history.to_redo) == ((), (SCENES[3],))
    history.take(SCENES[4], same_step=True)
    assert history.steps[2:] == [drag[0], Edit(SCENES[2], SCENES[4], joins=True)]
    assert (history.to_undo, history.to_redo) == ((SCENES[0],), ())


def test_an_edit_after_an_undo_begins_a_step_and_forgets_what_was_undone() -> None:
    history = History(SCENES[0])
    history.take(SCENES[1])
    history.move("undo")
    history.take(SCENES[2], same_step=True)
    assert history.to_redo == ()
    assert history.steps == [Edit(SCENES[0], SCENES[1]), Move("undo"), Edit(SCENES[0], SCENES[2])]


def test_each_place_knows_what_was_saved_of_it() -> None:
    history = History(SCENES[0])
    first = history.place
    history.take(SCENES[1])
    source = Source("other.obj")
    history.open(Opened(SCENES[2], ScenePlace(source)), source)
    assert (history.place.source, history.is_changed, history.left_unsaved) == (source, False, ("scene",))
    history.mark_saved({"other.npz": "9f"})
    history.move("undo")
    assert history.place is first
    assert (history.is_changed, history.saved.files, history.left_unsaved) == (True, {}, ())
    history.mark_saved({"first.npz": "77"})
    history.move("redo")
    assert (history.saved.files, history.left_unsaved) == ({"other.npz": "9f"}, ())


def test_what_is_nothing_to_undo_leaves_a_drag_one_step() -> None:
    history = History(SCENES[0])
    history.take(SCENES[1])
    history.keep("A")
    history.mark_saved({})
    history.take(SCENES[2], same_step=True)
    assert history.to_undo == (SCENES[0],)
    history.go(history.shown("A"), Show("A"))
    assert history.scene is SCENES[1]
    history.move("undo")
    assert history.scene is SCENES[2]


ONE = Opened(car(), ScenePlace())


FULL = Variants({f"{number}": ONE for number in range(999)}).with_variant("x" * 100, ONE)
"""1000 variants; one has the longest name."""


def test_variants_keep_their_order_and_are_values() -> None:
    none = Variants()
    both = none.with_variant("B", ONE).with_variant("A", ONE)
    assert list(both) == ["B", "A"]
    assert both["A"] is ONE
    assert len(none) == 0
    assert list(both.without("A")) == ["B"]


test_what_is_refused_of_variants = refused(
    call,
    [
        (
            lambda: Variants().with_variant("A", ONE).with_variant("A", Opened(CAR, ScenePlace())),
            "a variant must have a name of its own, and 'A' is in use; choose another, or drop that one",
        ),
        (lambda: FULL.with_variant("more", ONE), "there must be at most 1000 variants; drop one"),
        (
            lambda: Variants().with_variant("evening", ONE)["evenin"],
            "there is no variant 'evenin'; did you mean 'evening'?",
        ),
    ],
)


@pytest.mark.parametrize("name", ["", "x" * 101, 5])
def test_a_name_is_a_short_text(name: str) -> None:
    with pytest.raises(UsageError, match="a variant must have a name of 1 to 100 characters, not "):
        Variants().with_variant(name, ONE)


def test_free_names_are_letters_and_then_letters_with_numbers() -> None:
    variants = Variants()
    names = []
    for _ in range(54):
        names.append(variants.free_name())
        variants = variants.with_variant(names[-1], ONE)
    assert names[:3] == ["A", "B", "C"]
    assert names[25:28] == ["Z", "A2", "B2"]
    assert names[52:] == ["A3", "B3"]
    assert variants.without("C").free_name() == "C"
