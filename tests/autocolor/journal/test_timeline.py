"""The timeline of a session against its twin: a list of states and a list of views, and its place in both."""

from __future__ import annotations

from copy import deepcopy
from typing import Any, NamedTuple

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from autocolor.journal.history import History, Show
from autocolor.journal.places import Opened, ScenePlace, Source
from autocolor.journal.timeline import have_one_look
from autocolor.scene.scene import Scene
from tests.small import car

CAR = car()
SCENES = [
    [CAR.replace(ambient=look / 8, view=CAR.view.replace(angle=10 * view)) for view in range(3)]
    for look in range(4)
]


class State(NamedTuple):
    """A state of the twin: numbers of its look, its view and its place."""

    look: int
    view: int
    place: int


class Twin:
    """The list of states that steps lead to, and the list of views since the present place was opened."""

    def __init__(self) -> None:
        self.states, self.at = [State(0, 0, 0)], 0
        self.views, self.seen = [0], 0
        self.has_jumped = False

    @property
    def present(self) -> State:
        return self.states[self.at]

    def _go(self, at: int, keeps_view: bool = True) -> None:
        """Go to another state of the list."""
        before, self.at = self.present, at
        if keeps_view and self.present.place == before.place:
            self.states[at] = self.present._replace(view=before.view)
        if self.present.place != before.place:
            self.views, self.seen = [self.present.view], 0

    def step(self, state: State, keeps_view: bool = False) -> None:
        self.states[self.at + 1 :] = [state]
        self.has_jumped = False
        self._go(self.at + 1, keeps_view)

    def edit(self, look: int, view: int) -> None:
        if look != self.present.look:
            self.step(self.present._replace(look=look))
        if view != self.present.view:
            self.views[self.seen + 1 :] = [view]
            self._turn(self.seen + 1)

    def _turn(self, seen: int) -> None:
        self.seen = seen
        self.states[self.at] = self.present._replace(view=self.views[seen])

    def move(self, way: str, steps: int) -> bool:
        """Whether there are so many steps on the way."""
        sign = 1 if way in ("redo", "view_forward") else -1
        places, at = (self.views, self.seen) if way.startswith("view") else (self.states, self.at)
        if not 0 <= at + sign * steps < len(places):
            return False
        self.has_jumped |= way == "undo" and steps > 1
        for _ in range(steps):
            if way.startswith("view"):
                self._turn(self.seen + sign)
            else:
                self._go(self.at + sign)
        return True


moves = st.lists(
    st.tuples(st.just("edit"), st.booleans(), st.tuples(st.integers(0, 3), st.integers(0, 2)))
    | st.tuples(
        st.sampled_from(["undo", "undo", "redo", "view_back", "view_forward"]), st.none(), st.integers(1, 3)
    )
    | st.tuples(st.just("open"), st.none(), st.tuples(st.integers(0, 3), st.integers(0, 2)))
    | st.tuples(st.sampled_from(["keep", "show"]), st.none(), st.integers(0, 5)),
    max_size=20,
)

TURNS = [("edit", False, (0, 1)), ("edit", False, (0, 2))]
EDITS = [("edit", False, (look, 0)) for look in (1, 2, 3)]
KEPT = [("keep", None, 0), ("edit", False, (1, 1))]


def undone(*steps: int) -> list[tuple[str, Any, Any]]:
    """Steps to undo at once, or to redo if they are negative."""
    return [("undo" if number > 0 else "redo", None, abs(number)) for number in steps]


@given(moves)
# The end of a branch that was left becomes a variant once, although a drag came back and left it again.
@example([*EDITS, *undone(2), *[("edit", True, (look, 1)) for look in (2, 1, 3)]])
@example([*EDITS, *undone(2, -2, 1), ("edit", False, (0, 0))])
@example([*EDITS, *undone(1, 1, -2, 1), ("edit", False, (0, 0))])
@example([*EDITS, *undone(2, -1), ("edit", False, (0, 0)), *undone(1), ("edit", False, (1, 0))])
# Views are kept by undo, redo and variants, but each place has its own.
@example([*EDITS, ("edit", False, (3, 2)), *undone(1), ("edit", False, (2, 1)), *undone(-1, 3, -3)])
@example([*TURNS, ("open", None, (1, 1)), ("edit", False, (2, 2)), *undone(1, 1), ("view_back", None, 1)])
@example([*TURNS, ("open", None, (1, 1)), ("edit", False, (2, 2)), *undone(2, -1, -1), *TURNS])
@example([*KEPT, ("show", None, 0), ("open", None, (2, 2)), *KEPT, ("show", None, 0), ("show", None, 1)])
@example([*TURNS, ("view_back", None, 1), ("edit", False, (0, 0)), ("view_back", None, 2)])
@example([*TURNS, ("view_back", None, 2), ("view_forward", None, 1), ("edit", True, (1, 1))])
@example([*EDITS, ("undo", None, 3), ("keep", None, 0), ("open", None, (1, 1)), ("show", None, 0)])
def test_any_steps_lead_where_two_lists_lead(taken: list[tuple[str, Any, Any]]) -> None:
    places = [ScenePlace()]
    history, twin = History(SCENES[0][0], places[0]), Twin()
    base: Twin | None = None
    kept: list[State] = []
    branches: set[str] = set()

    def state_of(opened: Opened) -> State:
        look, view = round(opened.scene.ambient * 8), round(opened.scene.view.angle / 10)
        return State(look, view, places.index(opened.place))

    for kind, same_step, what in taken:
        before = deepcopy(twin)
        if kind == "edit":
            if what == twin.present[:2]:
                continue
            if not same_step or base is None:
                base = before
            twin = deepcopy(base)
            twin.edit(*what)
            history.take(SCENES[what[0]][what[1]], same_step)
        elif kind == "open":
            base = None
            places.append(ScenePlace(Source("other.obj")))
            twin.step(State(what[0], what[1], len(places) - 1))
            history.open(Opened(SCENES[what[0]][what[1]], places[-1]), Source("other.obj"))
        elif kind == "keep":
            kept.append(twin.present)
            history.keep(history.variants.free_name())
        elif kind == "show":
            if kept:
                base = None
                number = what % len(kept)
                name = list(history.variants)[number]
                twin.step(kept[number], keeps_view=True)
                history.go(history.shown(name), Show(name))
        elif twin.move(kind, what):
            base = None
            history.move(kind, what)  # type: ignore[arg-type]
        else:
            with pytest.raises(IndexError):
                history.move(kind, what)  # type: ignore[arg-type]
        if before.has_jumped and not twin.has_jumped:
            ends = [state for state in before.states[before.at + 1 :]][-1:]
            if ends and (ends[0].look, ends[0].place) not in [(each.look, each.place) for each in kept]:
                kept.append(ends[0])
                branches.add(list(history.variants)[-1])
        assert state_of(history.timeline.present) == twin.present
        assert [state_of(each) for each in history.timeline.to_undo] == twin.states[: twin.at]
        assert [state_of(each) for each in history.timeline.to_redo] == twin.states[: twin.at : -1]
        assert [round(view.angle / 10) for view in history.timeline.views_back] == twin.views[: twin.seen]
        forward = [round(view.angle / 10) for view in history.timeline.views_forward]
        assert forward == twin.views[: twin.seen : -1]
        assert [state_of(each) for each in history.variants.values()] == kept
        assert not branches & set(history.unsaved_variants)
    assert history.scene.equals(SCENES[twin.present.look][twin.present.view])


@pytest.mark.parametrize("steps", [0, -1, 4])
def test_there_is_no_way_beyond_the_ends(steps: int) -> None:
    history = History(CAR)
    for scene in (SCENES[1][0], SCENES[2][1], SCENES[3][2]):
        history.take(scene)
    with pytest.raises(IndexError):
        history.move("undo", steps)
    assert history.scene is SCENES[3][2]


def test_all_columns_but_the_view_are_the_look() -> None:
    others = [
        CAR.replace(ambient=0.5),
        CAR.with_light("key", on=False),
        CAR.with_part("pane", stage=True),
        CAR.with_saved_view("hood"),
        CAR.replace(name="other"),
    ]
    assert not any(have_one_look(CAR, other) or have_one_look(other, CAR) for other in others)
    turned: list[Scene] = [CAR.with_view(angle=5), CAR.replace(ambient=CAR.ambient)]
    assert all(have_one_look(CAR, other) for other in turned)
