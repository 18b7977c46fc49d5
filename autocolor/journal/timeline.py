"""The timeline of a session: the present scene, the looks to undo and to redo, the views back and forward.

A look is all of a scene but its view. Undo and redo exchange looks, and the present view stays. Views have
a way back and forward of their own, until another scene is opened: each scene has its own view, even if the
user comes back to it by undo. A timeline is an immutable value; each action makes another one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal

from autocolor.journal.places import Opened
from autocolor.scene.columns import fields_of
from autocolor.scene.scene import Scene
from autocolor.scene.view import View

Way = Literal["undo", "redo", "view_back", "view_forward"]
"""The ways to move on a timeline."""

WAYS: Final[tuple[Way, ...]] = ("undo", "redo", "view_back", "view_forward")


def have_one_look(one: Scene, other: Scene) -> bool:
    """Whether two scenes are equal but for their views."""
    ones, others = vars(one), vars(other)
    return all(
        ones[name] is others[name] or column.kind.cost(ones[name], others[name], column.tier) is None
        for name, column in fields_of(Scene).items()
        if name != "view"
    )


@dataclass(frozen=True)
class Timeline:
    """The states of a session around the present one; the nearest state is the last in each tuple."""

    present: Opened
    to_undo: tuple[Opened, ...] = ()
    """The states before each step that can be undone, each in the view of its time."""
    to_redo: tuple[Opened, ...] = ()
    """The states after each step that can be redone, each in the view of its time."""
    views_back: tuple[View, ...] = ()
    views_forward: tuple[View, ...] = ()
    has_jumped: bool = False
    """Whether several steps were undone at once, and no step was taken since."""

    def edited(self, scene: Scene) -> Timeline:
        """The timeline after an edit: a new look is a step, and from a new view there is a way back.

        A new view alone is no step, and the looks to redo stay.
        """
        before, after = self.present.scene, self
        if not have_one_look(before, scene):
            after = self._stepped()
        if scene.view != before.view:
            after = replace(after, views_back=(*self.views_back, before.view), views_forward=())
        return replace(after, present=Opened(scene, self.present.place))

    def moved_to(self, opened: Opened) -> Timeline:
        """A step to another state, in the present view if it is of the same place."""
        return self._stepped()._at(opened)

    def moved(self, way: Way, steps: int = 1) -> Timeline:
        """The timeline after some steps on a way at once. Raises IndexError if there are not so many."""
        if steps < 1:
            raise IndexError
        there = replace(self, has_jumped=self.has_jumped or (way == "undo" and steps > 1))
        for _ in range(steps):
            there = there._moved_once(way)
        return there

    def _moved_once(self, way: Way) -> Timeline:
        present, back, forward = self.present, self.views_back, self.views_forward
        match way:
            case "undo":
                there = self._at(self.to_undo[-1])
                return replace(there, to_undo=self.to_undo[:-1], to_redo=(*self.to_redo, present))
            case "redo":
                there = self._at(self.to_redo[-1])
                return replace(there, to_undo=(*self.to_undo, present), to_redo=self.to_redo[:-1])
            case "view_back":
                there = replace(self, present=_with_view(present, back[-1]))
                return replace(there, views_back=back[:-1], views_forward=(*forward, present.scene.view))
            case "view_forward":
                there = replace(self, present=_with_view(present, forward[-1]))
                return replace(there, views_back=(*back, present.scene.view), views_forward=forward[:-1])

    def _stepped(self) -> Timeline:
        """The timeline after a step that is still to change the present state."""
        return replace(self, to_undo=(*self.to_undo, self.present), to_redo=(), has_jumped=False)

    def _at(self, opened: Opened) -> Timeline:
        """The timeline at another state, in the present view; a state of another place has its own view."""
        if opened.place is self.present.place:
            return replace(self, present=_with_view(opened, self.present.scene.view))
        return replace(self, present=opened, views_back=(), views_forward=())


def _with_view(opened: Opened, view: View) -> Opened:
    scene = opened.scene
    return opened if scene.view == view else opened._replace(scene=scene.replace(view=view))
