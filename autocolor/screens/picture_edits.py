"""Edits of the picture: what keys and the mouse change of the view, the lights and the paint of a surface."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple, Unpack

from autocolor.scene.changes import PaintChanges
from autocolor.scene.defaults import framed
from autocolor.scene.scene import Exposure, Scene
from autocolor.scene.view import View
from autocolor.screens.color_cycle import color_after
from autocolor.screens.orbit import SIDES, moved, panned, seen_from, turned
from autocolor.studio import Studio


class Hold(NamedTuple):
    """The exposure before it was held, and the one that holds it."""

    before: Exposure
    held: Exposure


class PictureEdits(ABC):
    """The edits of the picture of a studio, one method for each key."""

    def begin(self, studio: Studio) -> None:
        """Begin with the picture of a studio."""
        self.studio = studio
        self.surface = 0
        self.same_step = False
        """Whether the next edit is undone together with the one before."""
        self.moving = False
        """Whether the next edit is one of a movement, whose pictures may be coarse."""
        self._hold: Hold | None = None
        self._own_colors: dict[str, str] = {}
        """The object colors that surfaces had before they got others by a key, by the surface's name."""

    @property
    @abstractmethod
    def message(self) -> str:
        """The last message."""

    @message.setter
    @abstractmethod
    def message(self, message: str) -> None: ...

    @abstractmethod
    def back(self) -> bool:
        """Return to the picture from another page; returns False if it is already shown."""

    @property
    def surface_name(self) -> str:
        """The name of the surface that the color keys change; empty if the scene has none in use."""
        names = list(self.studio.level_ranges)
        return names[self.surface % len(names)] if names else ""

    def _edit(self, scene: Scene) -> None:
        """Make a scene the current one; the edits of a key that is held down are one step to undo."""
        self.studio.edit(scene, same_step=self.same_step, moving=self.moving)

    def _look(self, view: View) -> None:
        """Change the view and return to the picture; an equal view is not an edit."""
        self.back()
        if view != self.studio.scene.view:
            self._edit(self.studio.scene.replace(view=view))

    def _paint(self, **changes: Unpack[PaintChanges]) -> None:
        """Change the paint of the selected surface; an equal paint is not an edit."""
        scene = self.studio.scene
        changed = scene.with_surface(self.surface_name, **changes)
        if changed.surfaces != scene.surfaces:
            self._edit(changed)

    def turn(self, right: float, up: float) -> None:
        """Move the eye around the object, in degrees."""
        self._look(turned(self.studio.scene, right, up))

    def move(self, ratio: float) -> None:
        """Multiply the distance of the eye by a ratio."""
        self._look(moved(self.studio.scene, ratio))

    def pan(self, right: float, down: float) -> None:
        """Move the picture by elements and lines."""
        self._look(panned(self.studio.scene, right, down, len(self.studio.words)))

    def see_from(self, number: int) -> None:
        """Look at the object from one of the sides that have names, counted from 0."""
        side = list(SIDES)[number]
        self._look(seen_from(self.studio.scene, side))
        self.message = f"view: {side}"

    def rescale(self, is_surface: bool = False) -> None:
        """Move the eye so that the object, or the selected surface, fills the picture.

        Paper: Figure 5, RESCALE.
        """
        scene = self.studio.scene
        coordinates = scene.object_coordinates
        if is_surface and self.surface_name:
            numbers = [
                part for part in scene.mesh.parts_in_use if scene.parts[part].surface == self.surface_name
            ]
            coordinates = scene.mesh.coordinates_of_parts(numbers)
        self._look(framed(scene.view, coordinates))

    def tilt(self, degrees: float) -> None:
        """Rotate the horizontal axis of the picture plane (Paper: Figure 5, ANGLE)."""
        view = self.studio.scene.view
        self._look(view.replace(angle=view.angle + degrees))

    def switch_light(self, number: int) -> None:
        """Switch a light, counted from 0, on or off."""
        lights = self.studio.scene.lights
        if number >= len(lights):
            self.message = f"the scene has no light {number + 1}"
            return
        light = lights[number]
        self.back()
        self._edit(self.studio.scene.with_light(light.name, on=not light.on))
        self.message = f"light {light.name} {'off' if light.on else 'on'}"

    def switch_exposure(self) -> None:
        """Hold the intensity ranges of the picture; if they were held by this, hold what was held before."""
        self.back()
        present = self.studio.scene.exposure
        if self._hold is not None and present == self._hold.held:
            self._edit(self.studio.scene.replace(exposure=self._hold.before))
            self.message = "exposure released"
            return
        self.studio.hold_exposure()
        held = self.studio.scene.exposure
        if held != present:
            self._hold = Hold(present, held)
        self.message = "exposure held" if held != present else "there is nothing more to hold"

    def choose_surface(self, step: int) -> None:
        """Select another surface in use for the color keys, `step` positions further."""
        self.surface = (self.surface + step) % max(1, len(self.studio.level_ranges))
        self.message = f"surface {self.surface_name}" if self.surface_name else "the scene has no surface"

    def blend(self, step: float) -> None:
        """Change the blend of the selected surface."""
        if self.surface_name:
            blend = self.studio.scene.surface(self.surface_name).paint.blend
            blend = min(1.0, max(0.0, round(blend + step, 6)))
            self._paint(blend=blend)
            self.message = f"blend {blend:.2f}"

    def repaint(self, step: int) -> None:
        """Give the selected surface another of OBJECT_COLORS or its own, `step` positions further."""
        name = self.surface_name
        if not name:
            return
        red, green, blue = self.studio.scene.surface(name).paint.object_color
        present = f"#{red:02x}{green:02x}{blue:02x}"
        color = color_after(present, self._own_colors.setdefault(name, present), step)
        self._paint(object_color=color)
        self.message = f"object color {color}"
