"""The history of a session: its scenes to undo and to redo, and every step that was taken, in order."""

from __future__ import annotations

from typing import Literal, NamedTuple

from autocolor.scene.scene import Scene


class Edit(NamedTuple):
    """A step that changed the scene; if it `joins`, it is undone together with the step before it."""

    before: Scene
    after: Scene
    joins: bool = False


Step = Edit | Literal["undo", "redo"]


class History:
    """The scenes of a session and the steps between them; `start` is the scene with which it began.

    `steps` are all that were taken, those that were undone included: taken again one after the other, they
    give the same history.
    """

    def __init__(self, start: Scene) -> None:
        self.start = start
        self.scene = start
        self.steps: list[Step] = []
        self._done: list[Scene] = []
        self._undone: list[Scene] = []

    @property
    def to_undo(self) -> tuple[Scene, ...]:
        """The scenes before each step that can be undone, the last one last."""
        return tuple(self._done)

    @property
    def to_redo(self) -> tuple[Scene, ...]:
        """The scenes after each step that can be redone, the next one last."""
        return tuple(self._undone)

    def take(self, scene: Scene, same_step: bool = False) -> None:
        """Make a scene the current one; with `same_step`, this edit and the previous one are one step."""
        joins = same_step and bool(self._done) and not self._undone
        if not joins:
            self._done.append(self.scene)
        self._undone.clear()
        self._note(Edit(self.scene, scene, joins))
        self.scene = scene

    def undo(self) -> None:
        """Return to the scene before the last step. Raises IndexError if there is none."""
        self._undone.append(self.scene)
        self.scene = self._done.pop()
        self.steps.append("undo")

    def redo(self) -> None:
        """Return to the scene after the next undone step. Raises IndexError if there is none."""
        self._done.append(self.scene)
        self.scene = self._undone.pop()
        self.steps.append("redo")

    def _note(self, edit: Edit) -> None:
        """Note an edit among the steps; the many edits of a drag are one."""
        last = self.steps[-1] if self.steps else None
        if edit.joins and isinstance(last, Edit):
            whole = Edit(last.before, edit.after, last.joins)
            if not whole.before.equals(whole.after):
                self.steps[-1] = whole
                return
            if last.joins:
                self.steps.pop()
                return
            # A drag that came back to where it began is still a step to undo: its two ways are noted.
        self.steps.append(edit)
