"""Comparing: another state of the scene is shown in place of the present one, to see what was gained.

That is the state before the last step, or a scene that was chosen, such as a kept variant. Nothing is edited
meanwhile; who edits ends it first. The words and entries of both are at hand, so that switching sends no more
than what differs: where only colors do, no word.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from autocolor.errors import UsageError
from autocolor.mapping.display_image import DisplayImage
from autocolor.scene.scene import Scene
from autocolor.studio import Studio

BEFORE: Final = "the state before the last step"
NOW: Final = "the present state"
"""What the message line calls what is shown."""


class Other(NamedTuple):
    """A scene to compare with, and what the message line calls it."""

    name: str
    scene: Scene


class Comparing:
    """What the scene of a studio is compared with, and whether that is shown."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._chosen: Other | None = None
        self._kept: tuple[Scene, Scene, DisplayImage] | None = None
        """A scene that was compared with another, that one, and what that looks like."""
        self._shown: DisplayImage | None = None

    @property
    def other(self) -> Other | None:
        """What is compared with: what was chosen, else the state before the last step, if there is one."""
        steps = self._studio.history.to_undo
        return self._chosen or (Other(BEFORE, steps[-1]) if steps else None)

    def choose(self, other: Other | None) -> None:
        """Choose what to compare with from now on; None for the state before the last step."""
        self.end()
        self._chosen = other

    def forget(self, scene: Scene) -> None:
        """Do not compare with a scene any longer that was chosen."""
        if self._chosen is not None and self._chosen.scene is scene:
            self.choose(None)

    @property
    def image(self) -> DisplayImage | None:
        """What is shown in place of the present state, if anything."""
        return self._shown

    @property
    def is_on(self) -> bool:
        """Whether another state is shown."""
        return self._shown is not None

    def begin(self) -> str:
        """Show the other state; returns what it is called. Raises UsageError if there is none."""
        other = self.other
        if other is None:
            raise UsageError(
                "to compare, there must be a step to undo or a kept variant; edit something first"
            )
        if self._shown is None:
            self._shown = self._image_of(other.scene)
        return other.name

    def end(self) -> bool:
        """Show the present state again; returns False if it was shown."""
        was_on, self._shown = self.is_on, None
        return was_on

    def _image_of(self, other: Scene) -> DisplayImage:
        """What another scene looks like, computed once for each two that are compared."""
        studio = self._studio
        studio.refine()
        if self._kept is None or self._kept[0] is not studio.scene or self._kept[1] is not other:
            self._kept = studio.scene, other, studio.image_of(other)
        return self._kept[2]
