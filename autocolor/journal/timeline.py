"""The timeline of a session: the present scene, looks to undo and to redo, and views back and forward.

A look is all of a scene but its view. Undo and redo exchange looks, and the present view stays. Views have
a way back and forward of their own, until another scene is opened: each scene has its own view, even if the
user comes back to it by undo. A timeline is an immutable value; each action makes another one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from autocolor.journal.places import Opened
from autocolor.scene.columns import fields_of
from autocolor.scene.scene import Scene
from autocolor.scene.view import View


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

    def edited(self, scene: Scene, joins_look: bool = False, joins_turn: bool = False) -> Timeline:
        """An edit of the present scene.

        A new look is a step, unless it joins the last one. A new view can be gone back from, unless it joins
        the last one; it is no step, and the looks to redo stay.
        """
        before, present = self.present.scene, Opened(scene, self.present.place)
        after = self
        if not have_one_look(before, scene) and not joins_look:
            after = self._stepped()
        if scene.view != before.view:
            back = self.views_back if joins_turn else (*self.views_back, before.view)
            after = replace(after, views_back=back, views_forward=())
        return replace(after, present=present)

    def moved_to(self, opened: Opened, keeps_view: bool = False) -> Timeline:
        """A step to another state; with `keeps_view`, in the present view if it is of the same place."""
        return self._stepped()._at(self._seen(opened) if keeps_view else opened)

    def undone(self, steps: int = 1) -> Timeline:
        """The timeline after some steps were undone at once. Raises IndexError if there are not so many."""
        there = replace(self, has_jumped=self.has_jumped or steps > 1)
        for _ in range(steps):
            before, now = there.to_undo[-1], there.present
            there = replace(there._at(there._seen(before)), to_undo=there.to_undo[:-1])
            there = replace(there, to_redo=(*there.to_redo, now))
        return there

    def redone(self, steps: int = 1) -> Timeline:
        """The timeline after some steps were redone at once. Raises IndexError if there are not so many."""
        there = self
        for _ in range(steps):
            after, now = there.to_redo[-1], there.present
            there = replace(there._at(there._seen(after)), to_redo=there.to_redo[:-1])
            there = replace(there, to_undo=(*there.to_undo, now))
        return there

    def turned_back(self) -> Timeline:
        """The timeline with the view before the present view. Raises IndexError if there is none."""
        view, now = self.views_back[-1], self.present.scene.view
        there = self._at(self._with_view(self.present, view))
        return replace(there, views_back=self.views_back[:-1], views_forward=(*self.views_forward, now))

    def turned_forward(self) -> Timeline:
        """The timeline with the view after the present view. Raises IndexError if there is none."""
        view, now = self.views_forward[-1], self.present.scene.view
        there = self._at(self._with_view(self.present, view))
        return replace(there, views_back=(*self.views_back, now), views_forward=self.views_forward[:-1])

    def _stepped(self) -> Timeline:
        """The timeline after a step that is still to change the present state."""
        return replace(self, to_undo=(*self.to_undo, self.present), to_redo=(), has_jumped=False)

    def _at(self, present: Opened) -> Timeline:
        """The timeline with another present state; views of another place end."""
        if present.place is self.present.place:
            return replace(self, present=present)
        return replace(self, present=present, views_back=(), views_forward=())

    def _seen(self, opened: Opened) -> Opened:
        """A state in the present view, if it is of the same place."""
        is_here = opened.place is self.present.place
        return self._with_view(opened, self.present.scene.view) if is_here else opened

    @staticmethod
    def _with_view(opened: Opened, view: View) -> Opened:
        scene = opened.scene
        return opened if scene.view == view else opened._replace(scene=scene.replace(view=view))
