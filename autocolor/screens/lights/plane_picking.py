"""Three points of the object are picked, one after the other, for the plane of a new half-space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.errors import InputError
from autocolor.scene.lights.half_spaces import HalfSpace
from autocolor.scene.lights.light import Light
from autocolor.scene.lights.light_copies import free_name
from autocolor.scene.view import View
from autocolor.screens.picture.light_handles import highlight_items
from autocolor.screens.session import Session
from autocolor.visibility.projection import focal_length
from autocolor.widgets.areas import SCREEN, Area
from autocolor.widgets.colors import YELLOW
from autocolor.widgets.items import Item, area_of, lines

NAME: Final = "plane"

POINTS: Final = 3

ORDINALS: Final = ("first", "second", "third")


class PlanePicking:
    """The points of a plane that were picked so far; `is_on` while more are to come."""

    def __init__(self, session: Session, area: Area) -> None:
        self.session = session
        self.is_on = False
        self._area = area
        self._points: list[Vector] = []

    @property
    def count(self) -> int:
        """How many points were picked."""
        return len(self._points)

    @property
    def told(self) -> str:
        """What the message line says: which point is next."""
        return f"pick the {ORDINALS[self.count]} point of the plane on the object; Esc ends"

    def begin(self) -> None:
        """Ask for the first point."""
        self.is_on, self._points = True, []
        self.session.tell(self.told, stands=True)

    def end(self) -> bool:
        """Ask for no more points; returns False if none was asked for."""
        was_on, self.is_on, self._points = self.is_on, False, []
        if was_on:
            self.session.tell("")
        return was_on

    def pick(self, element: int, line: int) -> None:
        """Take the point that is seen at a place; the third one makes the half-space of the chosen light.

        Raises InputError for a third point in one line with the others: it is to be picked again.
        """
        session, seen = self.session, self.session.studio.seen_at(line, element)
        if seen is None:
            session.tell(f"no point is seen there; {self.told}", is_warning=True, stands=True)
            return
        self._points.append(seen.point)
        if self.count < POINTS:
            session.tell(self.told, stands=True)
            return
        try:
            self._add()
        except InputError:
            self._points.pop()
            raise
        self.is_on, self._points = False, []

    def items(self) -> Sequence[Item]:
        """A cross at each point, and lines between them."""
        places = places_of(np.array(self._points).reshape(-1, 3), self.session.scene.view)
        found = [lines([places], YELLOW, area_of(places, limit=self._area))] if len(places) > 1 else []
        for element, line in np.floor(places + 0.5).astype(int).tolist():
            found += highlight_items(element, line, self._area)
        return found

    def _add(self) -> None:
        session, scene = self.session, self.session.scene
        light = scene.light_in_world(session.light_name)
        name = free_name(NAME, [each.name for each in light.half_spaces])
        half_space = HalfSpace.through(name, *self._points)
        if not is_lit_side(half_space, light, scene.view):
            half_space = turned(half_space)
        session.change_light(light.name, half_spaces={name: half_space})
        session.tell(f"half-space added to {light.name}: {name}")


def turned(half_space: HalfSpace) -> HalfSpace:
    """The half-space whose other side is lit."""
    x, y, z = half_space.direction
    return half_space.replace(direction=(0.0 - x, 0.0 - y, 0.0 - z))


def is_lit_side(half_space: HalfSpace, light: Light, view: View) -> bool:
    """Whether the light is on the lit side of a half-space, or the eye if the light is on the plane."""
    places = [light.position, view.eye]
    if light.at_infinity and light.axis is not None:
        places[0] = tuple(p - a for p, a in zip(half_space.point, light.axis, strict=True))  # type: ignore[assignment]
    for place in places:
        toward = np.array(place) - np.array(half_space.point)
        ahead = float(toward @ np.array(half_space.direction))
        if abs(ahead) > 1e-6 * float(np.abs(toward).max()):
            return ahead > 0
    return True


def places_of(points: Floats, view: View) -> Floats:
    """Where the points, (n, 3), are seen at full size, (n, 2) element and line; those behind are left out."""
    camera = (points - np.array(view.eye)) @ view.axes.T
    camera = camera[camera[:, 2] > 0]
    focal = focal_length(SCREEN.height, view.field_of_view)
    middle = np.array([SCREEN.width, SCREEN.height]) / 2 - 0.5
    places: Floats = middle + focal * camera[:, :2] / camera[:, 2:]
    return places
