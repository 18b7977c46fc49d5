"""The steps of a session, and that they give the same history when they are taken again."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.journal.history import Edit, History
from autocolor.journal.places import Place, Source
from autocolor.journal.variants import Opened
from tests.autocolor.sessions import car

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
            assert step.before is not step.after
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
    history.open(Opened(SCENES[2], Place(source)), source)
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
    history.mark_saved()
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
