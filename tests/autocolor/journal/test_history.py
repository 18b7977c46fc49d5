"""The steps of a session, and that they give the same history when they are taken again."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import UsageError
from autocolor.journal import history as history_module
from autocolor.journal.history import Edit, History, Variants
from autocolor.journal.places import Opened, ScenePlace, Source
from tests.small import car

CAR = car()
SCENES = [CAR, *(CAR.replace(ambient=number / 8) for number in range(4))]

moves = st.lists(
    st.tuples(st.just("edit"), st.sampled_from(SCENES), st.booleans())
    | st.tuples(st.sampled_from(["undo", "redo"]), st.none(), st.none()),
    max_size=30,
)


def state(history: History) -> tuple[object, ...]:
    return history.scene, history.to_undo, history.to_redo


@given(moves)
def test_the_steps_of_any_session_give_the_same_history_when_taken_again(
    made: list[tuple[object, ...]],
) -> None:
    history = History(CAR)
    for kind, scene, joins in made:
        if kind == "undo" and history.to_undo:
            history.undo()
        elif kind == "redo" and history.to_redo:
            history.redo()
        elif kind == "edit" and scene is not history.scene:
            history.take(scene, bool(joins))  # type: ignore[arg-type]
    again = History(CAR)
    for step in history.steps:
        if step == "undo":
            again.undo()
        elif step == "redo":
            again.redo()
        else:
            assert isinstance(step, Edit)
            assert step.before is again.scene
            again.take(step.after, step.joins)
    assert state(again) == state(history)


def test_a_drag_is_one_step_from_its_beginning_to_its_end() -> None:
    history = History(SCENES[0])
    for scene in SCENES[1:]:
        history.take(scene, same_step=True)
    assert history.steps == [Edit(SCENES[0], SCENES[-1])]
    assert history.to_undo == (SCENES[0],)


def test_a_drag_that_came_back_is_still_a_step_to_undo() -> None:
    history = History(SCENES[0])
    for scene in (SCENES[1], SCENES[2], SCENES[0]):
        history.take(scene, same_step=True)
    assert history.steps == [Edit(SCENES[0], SCENES[2]), Edit(SCENES[2], SCENES[0], joins=True)]
    assert history.to_undo == (SCENES[0],)
    history.undo()
    assert history.scene is SCENES[0]


def test_an_edit_after_an_undo_begins_a_step_and_forgets_what_was_undone() -> None:
    history = History(SCENES[0])
    history.take(SCENES[1])
    history.undo()
    history.take(SCENES[2], same_step=True)
    assert history.to_redo == ()
    assert history.steps == [Edit(SCENES[0], SCENES[1]), "undo", Edit(SCENES[0], SCENES[2])]


def test_each_place_knows_what_was_saved_of_it() -> None:
    history = History(SCENES[0])
    first = history.place
    history.take(SCENES[1])
    source = Source("other.obj")
    history.open(Opened(SCENES[2], ScenePlace(source)), source)
    assert (history.place.source, history.is_changed, history.left_unsaved) == (source, False, ("scene",))
    history.mark_saved({"other.npz": "9f"})
    history.undo()
    assert history.place is first
    assert (history.is_changed, history.saved.files, history.left_unsaved) == (True, {}, ())
    history.mark_saved({"first.npz": "77"})
    history.redo()
    assert (history.saved.files, history.left_unsaved) == ({"other.npz": "9f"}, ())


def test_what_is_nothing_to_undo_leaves_a_drag_one_step() -> None:
    history = History(SCENES[0])
    history.take(SCENES[1])
    history.keep("A")
    history.mark_saved({})
    history.take(SCENES[2], same_step=True)
    assert history.to_undo == (SCENES[0],)
    history.show("A")
    assert history.scene is SCENES[1]
    history.undo()
    assert history.scene is SCENES[2]


def test_there_is_nothing_to_undo_at_the_beginning() -> None:
    history = History(SCENES[0])
    for move in (history.undo, history.redo):
        with pytest.raises(IndexError):
            move()
    assert (history.to_undo, history.to_redo, history.steps) == ((), (), [])


ONE = Opened(car(), ScenePlace())


def test_variants_keep_their_order_and_are_values() -> None:
    none = Variants()
    both = none.with_variant("B", ONE).with_variant("A", ONE)
    assert list(both) == ["B", "A"]
    assert both["A"] is ONE
    assert len(none) == 0
    assert list(Variants({"A": ONE, "B": Opened(car(), ScenePlace())}).without("A")) == ["B"]


def test_dropping_one_of_two_equal_variants_leaves_the_other() -> None:
    assert list(Variants().with_variant("A", ONE).with_variant("B", ONE).without("A")) == ["B"]


def test_a_name_in_use_is_never_given_to_another_scene() -> None:
    variants = Variants().with_variant("A", ONE)
    with pytest.raises(UsageError) as refusal:
        variants.with_variant("A", Opened(car(), ScenePlace()))
    assert str(refusal.value) == (
        "a variant must have a name of its own, and 'A' is in use; choose another, or drop that one"
    )


@pytest.mark.parametrize("name", ["", "x" * 101, 5])
def test_a_name_is_a_short_text(name: str) -> None:
    with pytest.raises(UsageError, match="a variant must have a name of 1 to 100 characters, not "):
        Variants().with_variant(name, ONE)


def test_a_name_may_have_1_to_100_characters_and_there_may_be_1000_variants() -> None:
    variants = Variants().with_variant("x", ONE).with_variant("x" * 99, ONE).with_variant("x" * 100, ONE)
    assert [len(name) for name in variants] == [1, 99, 100]
    full = Variants({f"{number}": ONE for number in range(999)}).with_variant("last", ONE)
    assert len(full) == 1000
    with pytest.raises(UsageError, match="there must be at most 1000 variants; drop one"):
        full.with_variant("more", ONE)


def test_an_unknown_name_is_told_with_the_closest() -> None:
    with pytest.raises(UsageError) as refusal:
        Variants().with_variant("evening", ONE)["evenin"]
    assert str(refusal.value) == "there is no variant 'evenin'; did you mean 'evening'?"


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


def test_there_are_not_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history_module, "MOST_VARIANTS", 1)
    with pytest.raises(UsageError, match="there must be at most 1 variants; drop one"):
        Variants().with_variant("A", ONE).with_variant("B", ONE)
