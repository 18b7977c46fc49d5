"""Another state of the scene, shown in place of the present state, to see what was gained.

It is the state before the last step, or a scene that was chosen, such as a variant. An edit ends the
comparison first. The words and entries of both states are at hand, so that switching sends only what differs:
where only colors differ, no word.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from autocolor.errors import UsageError
from autocolor.journal.description import describe
from autocolor.mapping.display_image import DisplayImage
from autocolor.scene.scene import Scene
from autocolor.screens.cached import Cached
from autocolor.studio import Studio

MOST_DESCRIBED: Final = 70
"""Assumed: letters of the description of a difference, which leaves room in the message line for a verb."""

BEFORE: Final = "the state before the last step"
NOW: Final = "the present state"
"""The names of the two states in the message line."""


class NamedScene(NamedTuple):
    """A scene to compare with, and its name in the message line."""

    name: str
    scene: Scene


class Comparing:
    """The state that the scene of a studio is compared with, and whether that state is shown."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._chosen: NamedScene | None = None
        self._in_view: Cached[Scene] = Cached()
        """The other scene in the present view."""
        self._images: Cached[DisplayImage] = Cached()
        """The image of the other scene, computed once for a pair of scenes."""
        self.image: DisplayImage | None = None
        """The image that is shown in place of the present state; None while comparing is off."""

    @property
    def other(self) -> NamedScene | None:
        """The chosen scene to compare with, else the look before the last step, if there is one.

        It is in the present view if it has the present mesh.
        """
        steps, present = self._studio.history.to_undo, self._studio.scene
        other = self._chosen or (NamedScene(BEFORE, steps[-1]) if steps else None)
        if other is None or other.scene.mesh is not present.mesh or other.scene.view == present.view:
            return other
        name, scene, view = *other, present.view
        return NamedScene(name, self._in_view.of(lambda: scene.replace(view=view), scene, view))

    def choose(self, other: NamedScene | None) -> None:
        """Choose the scene to compare with from now on; None for the state before the last step."""
        self.end()
        self._chosen = other

    def forget(self, scene: Scene) -> None:
        """Compare with the state before the last step again if this scene was chosen."""
        if self._chosen is not None and self._chosen.scene is scene:
            self.choose(None)

    @property
    def difference(self) -> str:
        """How the present state differs from the other state, for a message."""
        difference = describe(self.other.scene, self._studio.scene, MOST_DESCRIBED) if self.other else ""
        return f"now: {difference}" if difference else "now the same"

    @property
    def other_image(self) -> DisplayImage | None:
        """The image of the state to compare with, if there is one; the present image is refined first."""
        return None if self.other is None else self._image_of(self.other.scene)

    @property
    def is_on(self) -> bool:
        """Whether another state is shown."""
        return self.image is not None

    def begin(self) -> str:
        """Show the other state; returns its name. Raises UsageError if there is none."""
        other = self.other
        if other is None:
            raise UsageError(
                "to compare, there must be a step to undo or a kept variant; edit something first"
            )
        self.image = self._image_of(other.scene)
        return other.name

    def end(self) -> bool:
        """Show the present state again; returns False if it was shown."""
        was_on, self.image = self.is_on, None
        return was_on

    def _image_of(self, other: Scene) -> DisplayImage:
        self._studio.refine()
        return self._images.of(lambda: self._studio.image_of(other), self._studio.scene, other)
