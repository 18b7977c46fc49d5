"""Handles of the chosen light in the picture: at its highlight, and along the rims of its controls.

The user drags a highlight or a rim to a pixel, and the light is placed so that it goes there; see
`lighting.picking`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Final, Literal, NamedTuple

import numpy as np

from autocolor.arrays import Indices
from autocolor.lighting.controls import Plane, flaps_of
from autocolor.lighting.picking import (
    CONE,
    Rim,
    cone_placed,
    flap_placed,
    half_space_placed,
    highlight_placed,
    rims,
    seen_highlight,
    specular_shares,
)
from autocolor.scene.lights import Light
from autocolor.scene.scene import NORMALS
from autocolor.screens.cached import Cached
from autocolor.screens.screen import Handle
from autocolor.screens.session import Session
from autocolor.widgets.bars import number_text
from autocolor.widgets.items import (
    BLACK,
    CHARACTER_LINES,
    WHITE,
    YELLOW,
    Area,
    Item,
    area_of,
    segments,
    text,
)
from autocolor.widgets.rows import World

HIGHLIGHT: Final = "highlight"

CELL: Final = 6
"""Assumed: elements and lines of a cell, in which a rim has at most one handle. So every place on a rim is
within reach of a handle, and the rims of a light have some hundred handles."""

ARM: Final = 5
"""Elements or lines from the middle of the cross at a highlight to its ends."""

DOTS: Final = 3
PERIOD: Final = 5
"""DOTS of PERIOD neighboring pixels of a rim are drawn."""


class HandleKey(NamedTuple):
    """The part of a light that a handle moves. The handles of a rim differ by line and element."""

    light: str
    what: Literal["highlight"] | Rim
    place: tuple[int, int] | None = None


class LightHandles:
    """The highlights of all lights, and with `has_rims` the rims of the chosen light, in `area`."""

    def __init__(self, session: Session, area: Area, has_rims: bool) -> None:
        self.session = session
        self.area = area
        self._has_rims = has_rims
        self._placed: tuple[object, tuple[int, int]] = None, (0, 0)
        """The source of a light, and the line and element where its highlight was placed. It is there
        without a search: other pixels may be as bright."""
        self._searched: dict[str, Cached[tuple[int, int] | None]] = {}
        """The line and element of the highlight of each light that was searched."""
        self._rims: Cached[tuple[Sequence[Handle], Sequence[Item]]] = Cached()
        """The handles and the marks at the rims of the chosen light."""

    def handles(self) -> Sequence[Handle]:
        """The handles of the lights that are on; none while something moves."""
        if self.session.moving:
            return ()
        # Of several handles at the same distance, the last is grabbed.
        handles = [*self._at_rims()[0]]
        for light, line, element in self._highlights():
            key = HandleKey(light.name, HIGHLIGHT)
            handles.append(self._handle(key, line, element, f"highlight of {light.name}"))
        return handles

    def preferred(self, near: Sequence[Handle], element: int, line: int) -> Sequence[Handle]:
        """Handles near a place. Of several highlights, the light that shines most at the place is first."""
        keys = ((each, each.key) for each in near)
        lights = {
            each: key.light for each, key in keys if isinstance(key, HandleKey) and key.what == HIGHLIGHT
        }
        if len(lights) < 2:
            return near
        shares = specular_shares(self.session.studio.picture, line, element)
        brightest = iter(sorted(lights, key=lambda each: -shares.get(lights[each], 0.0)))
        return [next(brightest) if each in lights else each for each in near]

    def items(self) -> Sequence[Item]:
        """The marks at the handles: dotted lines along the rims, and crosses at the highlights.

        A cross has the number of its light, from 1, at its right; that of the chosen light is yellow. While
        something moves, only a dragged highlight is marked: the light in the picture itself shows the rest,
        and the picture comes sooner. Measured on the coupe: five rims take 8 of 20 ms, and a highlight a
        third of a light's drag.
        """
        items = [] if self.session.moving else [*self._at_rims()[1]]
        numbers = {light.name: number for number, light in enumerate(self.session.scene.lights, start=1)}
        for light, line, element in self._highlights():
            word = YELLOW if light.name == self.session.light_name else WHITE
            items += highlight_items(element, line, self.area, word)
            beside = element + 2 * ARM + 2, line - CHARACTER_LINES // 2
            items.append(text(str(numbers[light.name]), *beside, word, BLACK))
        return items

    def _handle(self, key: HandleKey, line: int, element: int, label: str) -> Handle:
        """A handle that chooses and moves its light."""
        hold = partial(self.session.choose_light, key.light)
        return Handle(key, element, line, label, place=partial(self._place, key), hold=hold)

    def _place(self, key: HandleKey, element: int, line: int) -> None:
        """Let the light follow a handle to a place. Raises UsageError on the background."""
        session = self.session
        # The menu covers the places beside the area.
        element, line = min(element, self.area.right), min(line, self.area.bottom)
        scene, seen = session.scene, session.studio.seen_at(line, element)
        if key.what == HIGHLIGHT:
            scene = highlight_placed(scene, seen, key.light)
        elif key.what == CONE:
            scene = cone_placed(scene, seen, key.light)
        elif isinstance(key.what, Plane):
            scene = half_space_placed(scene, seen, key.light, key.what.half_space)
        else:
            scene = flap_placed(scene, seen, key.light, *key.what)
        session.edit(scene)
        light = scene.lights_in_world[key.light]
        if key.what == HIGHLIGHT:
            self._placed = self._source_of(light), (line, element)
        session.tell(message_of(light, key.what, session.world))

    def _seen_lights(self) -> list[Light]:
        """The lights that are on, in world coordinates, the chosen light last; none of a coarse picture."""
        session, chosen = self.session, self.session.light_name
        if session.studio.is_coarse or session.comparing.is_on:
            return []
        lights = [light for light in session.scene.lights_in_world if light.on]
        return sorted(lights, key=lambda light: light.name == chosen)

    def _highlights(self) -> Iterator[tuple[Light, int, int]]:
        """The lights whose highlight is in the area, each with the line and element of the highlight."""
        for light in self._seen_lights():
            place: tuple[int, int] | None = self._placed[1]
            if self._placed[0] != self._source_of(light):
                place = None if self.session.moving else self._search(light.name)
            if place is not None and self.area.has(*reversed(place)):
                yield light, *place

    def _source_of(self, light: Light) -> object:
        """The visible points and all of a light on which the place of its highlight depends."""
        axis = light.axis if light.at_infinity else None
        return self.session.studio.sight.points, light.name, light.position, axis

    def _search(self, light: str) -> tuple[int, int] | None:
        """Where the highlight of a light is: where it is seen, else the pixel with the largest cos(E).

        It is on the chosen surface, else on any surface.
        """
        studio, surface = self.session.studio, self.session.surface_name
        planes = studio.picture.light_planes.get(light)
        # Where words stand for normals, or there are no planes, the place depends on all of the scene.
        is_seen = planes is not None and studio.scene.words != NORMALS
        source = planes.values if planes is not None and is_seen else studio.scene

        def search() -> tuple[int, int] | None:
            place = None
            for name in (surface, None) if surface else (None,):
                place = place or (seen_highlight(studio.picture, light, name) if is_seen else None)
                place = place or studio.highlight_of(light, name)
            return place

        return self._searched.setdefault(light, Cached()).of(search, source, surface)

    def _at_rims(self) -> tuple[Sequence[Handle], Sequence[Item]]:
        """The handles and the marks at the rims of the chosen light, if it is on."""
        sight, area, name = self.session.studio.sight, self.area, self.session.light_name
        if not self._has_rims or name not in [light.name for light in self._seen_lights()]:
            return (), ()

        def at_rims() -> tuple[Sequence[Handle], Sequence[Item]]:
            handles, items = list[Handle](), list[Item]()
            for rim, pixels in rims(sight, name).items():
                seen = pixels[(pixels <= (area.bottom, area.right)).all(axis=1)]
                items += rim_items(seen, area)
                label = f"end of the {name_of(rim)} of {name}"
                _, first_in_cells = np.unique(seen // CELL, axis=0, return_index=True)
                for line, element in seen[first_in_cells].tolist():
                    handles.append(self._handle(HandleKey(name, rim, (line, element)), line, element, label))
            return handles, items

        return self._rims.of(at_rims, self.session.scene.lights, name, sight.points, area)


def rim_items(pixels: Indices, area: Area) -> list[Item]:
    """A dotted line along the pixels of a rim, (n, 2) line and element."""
    # A pattern that has dots in all directions.
    dots = pixels[(pixels[:, 1] + 2 * pixels[:, 0]) % PERIOD < DOTS][:, ::-1]
    if not len(dots):
        return []
    places = dots.astype(np.float64)
    return [segments(np.concatenate([places, places], axis=1), YELLOW, area_of(places, limit=area))]


def highlight_items(element: int, line: int, area: Area, word: int = YELLOW) -> list[Item]:
    """A diagonal cross at a highlight, which the upright pointer does not hide, with a shadow on white."""
    arms = np.array([(-1, -1), (1, -1), (-1, 1), (1, 1)], np.float64)
    middle = np.array((element, line), np.float64)
    strokes = np.concatenate([middle + 2 * arms, middle + ARM * arms], axis=1)
    around = area_of(strokes.reshape(-1, 2), margin=1, limit=area)
    shadow = strokes + np.array((1, 0, 1, 0))
    return [segments(shadow, BLACK, around), segments(strokes, word, around)]


def name_of(rim: Rim) -> str:
    """The name of a rim's control in the message line."""
    if rim == CONE:
        return "cone"
    return f"half-space {rim.half_space}" if isinstance(rim, Plane) else f"flap {rim[0]}, {rim[1]},"


def message_of(light: Light, what: Literal["highlight"] | Rim, world: World) -> str:
    """The message while a part of a light is placed; coordinates have the digits of their bars."""

    def shown(axis: str, value: float) -> str:
        return number_text(value, world.range_of(axis).step)

    if what == CONE:
        return f"{light.name}: cone angle {light.cone_angle:.1f} degrees"
    if isinstance(what, tuple) and not isinstance(what, Plane):
        axis, end = what
        return f"{light.name}: flap {axis}, {end} {shown(axis, getattr(flaps_of(light)[axis], end))}"
    name, point = light.name, light.position
    if isinstance(what, Plane):
        name, point = next((r.name, r.point) for r in light.half_spaces if r.name == what.half_space)
    return f"{name}: " + "  ".join(f"{axis} {shown(axis, at)}" for axis, at in zip("xyz", point, strict=True))
