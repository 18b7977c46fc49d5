"""The lights screen: every parameter of the chosen light, over the picture; lights added, copied, removed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.errors import InputError
from autocolor.scene.columns import fields_of
from autocolor.scene.creation import new_light_of
from autocolor.scene.following import attached, detached
from autocolor.scene.lights import HalfSpace, Light, free_name
from autocolor.scene.view import View
from autocolor.screens.input import Gesture
from autocolor.screens.light_parameters import parameter_rows
from autocolor.screens.picture.light_handles import LightHandles, highlight_items
from autocolor.screens.picture.over_picture import OverPicture, exposure_row
from autocolor.screens.screen import Handle
from autocolor.screens.session import Session
from autocolor.visibility.projection import focal_length
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import SCREEN, YELLOW, Area, Item, area_of, lines
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import Button, Choice, Gap, Pair, Switch, Widget, titled


class LightsScreen(OverPicture):
    """The lights, one at a time."""

    name = "lights"
    title = "lights"
    help = "The chosen light: drag its highlight, and where its cone, flaps and half-spaces end"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._handles = LightHandles(session, WORK, has_rims=True)
        self._picking = PlanePicking(session, WORK)

    def items(self) -> Sequence[Item]:
        return [*super().items(), *(self._picking if self._picking.is_on else self._handles).items()]

    def handles(self) -> Sequence[Handle]:
        return () if self._picking.is_on else self._handles.handles()

    def pick(self, gesture: Gesture) -> None:
        if self._picking.is_on:
            self._picking.pick(gesture.element, gesture.line)
        else:
            super().pick(gesture)

    def escape(self) -> bool:
        return self._picking.end()

    def leave(self) -> None:
        self._picking.end()

    def preferred(self, near: Sequence[Handle], element: int, line: int) -> Sequence[Handle]:
        return self._handles.preferred(near, element, line)

    def hold(self, handle: Handle) -> None:
        self._handles.hold(handle)

    def place(self, handle: Handle, element: int, line: int) -> None:
        self._handles.place(handle, element, line)

    def rows(self) -> Sequence[Widget]:
        light = self.session.chosen_light
        if light is None:
            return [
                Button(
                    "add a light", "A light above the side of the eye, aimed at the object.", run=self._add
                )
            ]
        return [
            Choice(
                "light",
                "The light whose parameters are shown.",
                names=tuple(each.name for each in self.session.scene.lights),
                present=light.name,
                choose=self.session.choose_light,
            ),
            *self._verbs(light),
            Gap("parameters gap"),
            *parameter_rows(self.session, light, leave_out=("half_spaces",)),
            Gap("half-spaces gap"),
            *half_space_rows(self.session, light, self._picking),
            exposure_row(self.edits),
        ]

    def _verbs(self, light: Light) -> list[Widget]:
        session = self.session
        return [
            Pair(
                "alone",
                "Switch on this light alone; or all lights.",
                run=partial(session.light_alone, light.name),
                other="all on",
                run_other=session.all_lights_on,
            ),
            Pair(
                "add",
                "Add another light, or a copy of this light.",
                run=self._add,
                other="copy",
                run_other=self._copy,
            ),
            Pair(
                "mirror",
                "Copy this light to the other side of the object; or remove this light.",
                run=self._mirror,
                other="remove",
                run_other=self._remove,
            ),
            Button("save the rig", "Save all lights, to put them on another scene.", run=session.save_rig),
        ]

    def _add(self) -> None:
        light = new_light_of(self.session.scene)
        scene = self.session.scene
        self.session.edit(scene.replace(lights=(*scene.lights, light)))
        self.session.choose_light(light.name)
        self.session.tell(f"light added: {light.name}")

    def _copy(self) -> None:
        self._append(self.session.scene.with_copied_light(self.session.light_name).lights, "copied")

    def _mirror(self) -> None:
        # The two sides of a product are at the ends of its shorter horizontal extent.
        (x, y, _), (to_x, to_y, _) = self.session.scene.object_bounds
        axis = "x" if to_x - x <= to_y - y else "y"
        lights = self.session.scene.with_mirrored_light(self.session.light_name, axis).lights
        self._append(lights, f"mirrored along {axis}")

    def _append(self, lights: tuple[Light, ...], done: str) -> None:
        before = self.session.light_name
        self.session.edit(self.session.scene.replace(lights=lights))
        self.session.choose_light(lights[-1].name)
        self.session.tell(f"{titled('light', before)} {done}: {lights[-1].name}")

    def _remove(self) -> None:
        name = self.session.light_name
        self.session.edit(self.session.scene.without_light(name))
        self.session.tell(f"{titled('light', name)} removed; undo brings it back")


# Picking a plane: three points of the object, one after the other, for the plane of a new half-space.

NAME: Final = "plane"
POINTS: Final = 3
ORDINALS: Final = ("first", "second", "third")


class PlanePicking:
    """The picked points of a plane. `is_on` while the user picks."""

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
    def prompt(self) -> str:
        """The message that asks for the next point."""
        return f"pick the {ORDINALS[self.count]} point of the plane on the object; Esc ends"

    def begin(self) -> None:
        """Ask for the first point."""
        self.is_on, self._points = True, []
        self.session.tell(self.prompt, persistent=True)

    def end(self) -> bool:
        """End picking; returns False if the user did not pick."""
        was_on, self.is_on, self._points = self.is_on, False, []
        if was_on:
            self.session.tell("")
        return was_on

    def pick(self, element: int, line: int) -> None:
        """Take the point that is seen at a place; the third one makes the half-space of the chosen light.

        Raises InputError if the three points are in one line; the third must then be picked again.
        """
        session, seen = self.session, self.session.studio.seen_at(line, element)
        if seen is None:
            session.tell(f"no point is seen there; {self.prompt}", is_warning=True, persistent=True)
            return
        self._points.append(seen.point)
        if self.count < POINTS:
            session.tell(self.prompt, persistent=True)
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
        items = [lines([places], YELLOW, area_of(places, limit=self._area))] if len(places) > 1 else []
        for element, line in np.floor(places + 0.5).astype(int).tolist():
            items += highlight_items(element, line, self._area)
        return items

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
    """The elements and lines, (n, 2), of points, (n, 3), in the picture, without points behind the eye."""
    camera = (points - np.array(view.eye)) @ view.axes.T
    camera = camera[camera[:, 2] > 0]
    focal = focal_length(SCREEN.height, view.field_of_view)
    middle = np.array([SCREEN.width, SCREEN.height]) / 2 - 0.5
    places: Floats = middle + focal * camera[:, :2] / camera[:, 2:]
    return places


# The rows of a light's half-spaces: for each half-space its switch, edge width, carried, turn and remove.


@dataclass(frozen=True)
class VerbsOf(Pair):
    """Two buttons for the thing named `of`; other things on the screen have buttons of the same labels."""

    of: str = ""

    @property
    def key(self) -> str:
        return f"{self.label} {self.of}"


def half_space_rows(session: Session, light: Light, picking: PlanePicking) -> list[Widget]:
    """The row that adds a half-space, and the rows of all half-spaces of a light."""
    rows: list[Widget] = [
        Button(
            "half spaces",
            "Stop picking points."
            if picking.is_on
            else "Pick three points of a plane that bounds the light.",
            run=picking.end if picking.is_on else picking.begin,
            value=f"{picking.count}/{POINTS}" if picking.is_on else "add",
            is_chosen=picking.is_on,
        )
    ]
    for half_space in light.half_spaces:
        rows += _rows_of(session, light, half_space)
    return rows


def _rows_of(session: Session, light: Light, half_space: HalfSpace) -> list[Widget]:
    name = half_space.name
    helps = {key: field.column.help for key, field in fields_of(HalfSpace).items()}
    usual = session.world.range_of_lengths(is_zero_left_out=False)

    def put(**changes: object) -> None:
        session.change_light(light.name, half_spaces={name: changes})  # type: ignore[dict-item]

    return [
        Switch(name, helps["on"], is_on=half_space.on, flip=lambda: put(on=not half_space.on)),
        Bar(
            f"{name} width",
            helps["edge_width"],
            value=half_space.edge_width,
            **usual._asdict(),
            put=lambda width: put(edge_width=width),
        ),
        Switch(
            f"{name} carried",
            helps["carried"],
            is_on=half_space.carried,
            flip=partial(_carry, session, light, half_space),
        ),
        VerbsOf(
            "turn",
            f"Light the other side of {name}; or remove {name}.",
            run=partial(_put_row, session, light, turned(half_space)),
            other="remove",
            run_other=partial(_remove, session, light, name),
            of=name,
        ),
    ]


def _carry(session: Session, light: Light, half_space: HalfSpace) -> None:
    """Attach a half-space to a light, or detach it; its plane stays where it is."""
    there = session.scene.light_in_world(light.name)
    carry = detached if half_space.carried else attached
    _put_row(session, light, carry(half_space, there))


def _put_row(session: Session, light: Light, half_space: HalfSpace) -> None:
    session.change_light(light.name, half_spaces={half_space.name: half_space})


def _remove(session: Session, light: Light, name: str) -> None:
    session.change_light(light.name, half_spaces={name: None})
    session.tell(f"{titled('half-space', name)} removed; undo brings it back")
