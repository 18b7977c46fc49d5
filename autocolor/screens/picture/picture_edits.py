"""Edits of the picture: what keys and the mouse change of the view, the lights and the paint of a surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from autocolor.scene.defaults import framed
from autocolor.scene.scene import Exposure
from autocolor.scene.view import View
from autocolor.screens.picture.color_cycle import color_after
from autocolor.screens.picture.orbit import SIDES, moved, panned, seen_from, turned
from autocolor.screens.session import Session


class Hold(NamedTuple):
    """The exposure before it was held, and the one that holds it."""

    before: Exposure
    held: Exposure


class PictureEdits:
    """The edits of the picture of a session, one method for each key."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._hold: Hold | None = None
        self._own_colors: dict[str, str] = {}
        """The object colors that surfaces had before they got others by a key, by the surface's name."""

    def look(self, view: View) -> None:
        """Change the view."""
        self.session.edit(self.session.scene.replace(view=view))

    def turn(self, right: float, up: float) -> None:
        """Move the eye around the object, in degrees."""
        self.look(turned(self.session.scene, right, up))

    def move(self, ratio: float) -> None:
        """Multiply the distance of the eye by a ratio."""
        self.look(moved(self.session.scene, ratio))

    def pan(self, right: float, down: float) -> None:
        """Move the picture by elements and lines."""
        self.look(panned(self.session.scene, right, down, len(self.session.studio.words)))

    def see_from(self, number: int) -> None:
        """Look at the object from one of the sides that have names, counted from 0."""
        side = list(SIDES)[number]
        view = seen_from(self.session.scene, side)
        self.look(view)
        self.session.named_view = view, side
        self.session.tell(f"view: {side}")

    @property
    def side(self) -> str:
        """The side that `see_from` took the present view from; empty if it is another view."""
        named = self.session.named_view
        return named[1] if named is not None and named[0] == self.session.scene.view else ""

    def rescale(self, is_surface: bool = False) -> None:
        """Move the eye so that the object, or the selected surface, fills the picture.

        Paper: Figure 5, RESCALE.
        """
        scene = self.session.scene
        if is_surface and self.session.surface_name:
            name = self.session.surface_name
            self._fill([part for part in scene.mesh.parts_in_use if scene.parts[part].surface == name])
        else:
            self.look(framed(scene.view, scene.object_coordinates))

    @property
    def chosen_parts(self) -> list[int]:
        """The number of the part that was pointed at last, if the scene has it."""
        scene, name = self.session.scene, self.session.part_name
        return [part for part in scene.mesh.parts_in_use if scene.parts[part].name == name]

    def rescale_part(self) -> None:
        """Move the eye so that the part that was pointed at last, if any, fills the picture."""
        if self.chosen_parts:
            self._fill(self.chosen_parts)

    def _fill(self, parts: Sequence[int]) -> None:
        """Move the eye so that some parts, by their numbers, fill the picture."""
        scene = self.session.scene
        self.look(framed(scene.view, scene.mesh.coordinates_of_parts(parts)))

    def tilt(self, degrees: float) -> None:
        """Rotate the horizontal axis of the picture plane (Paper: Figure 5, ANGLE)."""
        view = self.session.scene.view
        self.look(view.replace(angle=view.angle + degrees))

    def switch_light(self, number: int) -> None:
        """Switch a light, counted from 0, on or off."""
        lights = self.session.scene.lights
        if number >= len(lights):
            self.session.tell(f"the scene has no light {number + 1}")
            return
        light = lights[number]
        self.session.edit(self.session.scene.with_light(light.name, on=not light.on))
        self.session.tell(f"light {light.name} {'off' if light.on else 'on'}")

    def switch_exposure(self) -> None:
        """Hold the intensity ranges of the picture; if they were held by this, hold what was held before."""
        present = self.session.scene.exposure
        if self._hold is not None and present == self._hold.held:
            self.session.edit(self.session.scene.replace(exposure=self._hold.before))
            self.session.tell("exposure released")
            return
        self.session.studio.hold_exposure()
        held = self.session.scene.exposure
        if held != present:
            self._hold = Hold(present, held)
        self.session.tell("exposure held" if held != present else "there is nothing more to hold")

    def choose_surface(self, step: int) -> None:
        """Select another surface in use for the color keys, `step` positions further."""
        count = max(1, len(self.session.studio.level_ranges))
        self.session.surface = (self.session.surface + step) % count
        self.session.tell(
            f"surface {self.session.surface_name}"
            if self.session.surface_name
            else "the scene has no surface"
        )

    def blend(self, step: float) -> None:
        """Change the blend of the selected surface."""
        if self.session.surface_name:
            blend = self.session.scene.surface(self.session.surface_name).paint.blend
            blend = min(1.0, max(0.0, round(blend + step, 6)))
            self.session.paint(blend=blend)
            self.session.tell(f"blend {blend:.2f}")

    def repaint(self, step: int) -> None:
        """Give the selected surface another of OBJECT_COLORS or its own, `step` positions further."""
        name = self.session.surface_name
        if not name:
            return
        red, green, blue = self.session.scene.surface(name).paint.object_color
        present = f"#{red:02x}{green:02x}{blue:02x}"
        color = color_after(present, self._own_colors.setdefault(name, present), step)
        self.session.paint(object_color=color)
        self.session.tell(f"object color {color}")
