"""The lights screen: a list of all lights and every parameter of the chosen light, over the picture.

Above the list are the arrangements, which replace all lights. While the pointer is over one of them, the
picture shows it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.legend import CORNERS
from autocolor.scene.arrangements import ARRANGEMENTS, arranged
from autocolor.scene.columns import fields_of
from autocolor.scene.creation import new_light_of
from autocolor.scene.following import attached, detached
from autocolor.scene.lights import HalfSpace, Light, free_name
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.cached import Cached
from autocolor.screens.file_actions import save_rig
from autocolor.screens.input import Gesture
from autocolor.screens.light_parameters import (
    KIND,
    all_lights_on,
    light_alone,
    parameter_rows,
    put_light,
    solo_light,
)
from autocolor.screens.naming import ask_name
from autocolor.screens.picture.light_handles import LightHandles, highlight_items
from autocolor.screens.picture.over_picture import OverPicture, exposure_row
from autocolor.screens.screen import Content, Surroundings
from autocolor.screens.session import Session
from autocolor.visibility.projection import focal_length
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import GRAY, LIGHT_GRAY, SCREEN, YELLOW, Area, Item, area_of, lines
from autocolor.widgets.menu import WORK, Section, paged
from autocolor.widgets.rows import INDENT, rows_of
from autocolor.widgets.widget import (
    NOWHERE,
    ROW_LINES,
    Button,
    Choice,
    Pair,
    PanelButton,
    Switch,
    Widget,
    titled,
)

FIRST: Final = ("on", "intensity", "concentration", "cone_angle", "inner_angle", "flaps")
"""The columns of a light that are edited most; their rows are always shown."""

PLACE: Final = (KIND, "position", "direction", "aim", "follows")
"""The columns in the section of the place and the aim."""

POINTS: Final = ("first", "second", "third")
"""The points of the object that are picked for the plane of a new half-space."""


class LightsScreen(OverPicture):
    """The lights, in a list, and the chosen light in the menu."""

    name = "lights"
    title = "lights"
    word = "lights"
    help = "The chosen light: drag its highlight, and where its cone, flaps and half-spaces end"

    # The light list is at the upper left.
    corners = tuple(corner for corner in CORNERS if corner != (0.0, 0.0))

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._handles = LightHandles(session, WORK, has_rims=True)
        self._list_is_open = True
        self._points: list[Vector] | None = None
        """The points of a plane that were picked; None while the user picks none."""
        self._arranged: Cached[DisplayImage | None] = Cached()

    def build(self, around: Surroundings) -> Content:
        content, widgets = super().build(around), self._list() if around.has_panels else ()
        self._handles.area = WORK if around.has_menu else SCREEN
        if self.session.chosen_light is None:
            # Without a light, there is nothing that a plane could bound.
            self._points = None
        # The list covers handles, also where they are within reach of a place beside it.
        covered = Area(*widgets[0].area[:2], *widgets[-1].area[2:]) if widgets else NOWHERE
        marks: Sequence[Item] = ()
        handles = [*content.handles, *self._handles.handles()] if self._points is None else []
        if self._points is not None:
            marks = plane_items(self._points, self.session.scene.view)
        elif self.other_image(around) is None:
            marks = self._handles.items()
        return replace(
            content,
            items=[*content.items, *marks],
            rows=self._rows,
            widgets=widgets,
            handles=[each for each in handles if not covered.has(each.element, each.line)],
            preferred=self._handles.preferred,
            escape=self._end_picking,
        )

    def other_image(self, around: Surroundings) -> DisplayImage | None:
        """The picture in the light of the arrangement under the pointer."""
        within, _, name = around.lit.partition(".")
        if within != "arrangements":
            return super().other_image(around)
        return self._arranged.of(partial(self._image_of, name), self.session.scene, ARRANGEMENTS[name])

    def _image_of(self, arrangement: str) -> DisplayImage | None:
        other, scene = arranged(self.session.scene, arrangement), self.session.scene
        # After the click, the marks of the new lights are shown at once.
        return None if other.equals(scene) else self.session.studio.image_of(other)

    def pick(self, gesture: Gesture) -> None:
        if self._points is None:
            super().pick(gesture)
        else:
            self._pick_point(gesture)

    def leave(self) -> None:
        self._end_picking()

    # The menu.

    def _rows(self) -> Sequence[Widget]:
        session, light = self.session, self.session.chosen_light
        if light is None:
            help = "A light above the side of the eye, aimed at the object."
            return [Button("add a light", help, run=self._add)]
        of = partial(parameter_rows, session, light)
        others = [name for name in fields_of(Light) if name not in (*FIRST, *PLACE, "links", "half_spaces")]
        return [
            Choice(
                "light",
                "The light whose parameters are shown.",
                names=tuple(each.name for each in session.scene.lights),
                present=light.name,
                choose=session.choose_light,
            ),
            *of(FIRST),
            exposure_row(session),
            Section("place & aim"),
            *of(PLACE),
            Section("links"),
            *of(["links"]),
            Section("other settings"),
            *of(others),
            Section("half-spaces"),
            self._picking_row(),
            *(row for each in light.half_spaces for row in half_space_rows(session, light, each)),
            Section("add & remove"),
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
            Button(
                "save the rig",
                "Save all lights, to put them on another scene.",
                run=partial(save_rig, session),
            ),
        ]

    def _add(self) -> None:
        light, scene = new_light_of(self.session.scene), self.session.scene
        self._show_new(scene.replace(lights=(*scene.lights, light)), f"light added: {light.name}")

    def _copy(self) -> None:
        name = self.session.light_name
        scene = self.session.scene.with_copied_light(name)
        self._show_new(scene, f"{titled('light', name)} copied: {scene.lights[-1].name}")

    def _mirror(self) -> None:
        # The two sides of a product are at the ends of its shorter horizontal extent.
        (x, y, _), (to_x, to_y, _) = self.session.scene.object_bounds
        axis, name = "x" if to_x - x <= to_y - y else "y", self.session.light_name
        scene = self.session.scene.with_mirrored_light(name, axis)
        self._show_new(scene, f"{titled('light', name)} mirrored along {axis}: {scene.lights[-1].name}")

    def _show_new(self, scene: Scene, message: str) -> None:
        """Show a scene whose last light is new, choose that light, and ask for its name."""
        session, name = self.session, scene.lights[-1].name
        session.edit(scene)
        session.choose_light(name)
        session.tell(message)
        ask_name(session, "light", name, lambda new: put_light(session, name, {"name": new}), is_new=True)

    def _remove(self) -> None:
        name = self.session.light_name
        self.session.edit(self.session.scene.without_light(name))
        self.session.tell(f"{titled('light', name)} removed; undo brings it back")

    # The panel: the arrangements, and the list with a row for each light.

    def _list(self) -> list[Widget]:
        """The rows of the panel with their areas, from the top. Folded, it has its heading alone."""
        session, lights = self.session, self.session.scene.lights
        fold = partial(setattr, self, "_list_is_open")
        help = "Fold the arrangements and the list of all lights, or show them."
        rows: list[list[Widget]] = [[Section("light list", help, is_open=self._list_is_open, fold=fold)]]
        if self._list_is_open:
            buttons: list[Widget] = [
                PanelButton(
                    name,
                    f"{arrangement.help}; a click replaces all lights.",
                    within="arrangements",
                    run=partial(self._arrange, name),
                )
                for name, arrangement in ARRANGEMENTS.items()
            ]
            rows += [buttons[:3], buttons[3:]]
            names = [light.name for light in lights]
            shown, turning = paged(
                list(enumerate(lights, start=1)),
                LIGHTS_A_PAGE,
                names.index(session.light_name) // LIGHTS_A_PAGE if lights else 0,
                "Another page of lights.",
                lambda page: session.choose_light(names[page * LIGHTS_A_PAGE]),
            )
            rows += [light_row(session, *each) for each in shown]
            rows += [turning] if turning else []
            if lights:
                run = partial(all_lights_on, session)
                rows.append([Button("all lights on", "Switch all lights on.", run=run)])
        return [widget for number, row in enumerate(rows) for widget in placed(row, number)]

    def _arrange(self, name: str) -> None:
        session = self.session
        session.edit(arranged(session.scene, name))
        session.choose_light(session.scene.lights[0].name)
        session.tell(f"arrangement {name}; undo brings the former lights back")

    # Picking a plane: three points of the object, one after the other, for the plane of a new half-space.

    def _picking_row(self) -> Button:
        if self._points is None:
            help = "Pick three points of a plane that bounds the light."
            return Button("half spaces", help, run=partial(self._ask_for_point, []), value="add")
        value = f"{len(self._points)}/{len(POINTS)}"
        help = "Stop picking points."
        return Button("half spaces", help, run=self._end_picking, value=value, is_chosen=True)

    def _ask_for_point(self, points: list[Vector], problem: str = "") -> None:
        """Go on with some points of the plane, and ask for the next point."""
        self._points = points
        prompt = f"pick the {POINTS[len(points)]} point of the plane on the object; Esc ends"
        self.session.tell(problem + prompt, is_warning=bool(problem), persistent=True)

    def _end_picking(self) -> bool:
        """End picking; returns False if the user did not pick."""
        was_on, self._points = self._points is not None, None
        if was_on:
            self.session.tell("")
        return was_on

    def _pick_point(self, gesture: Gesture) -> None:
        """Take the point that is seen at a place; the third point makes a half-space of the chosen light.

        Raises InputError if the three points are in one line; the third must then be picked again.
        """
        session, scene, points = self.session, self.session.scene, self._points or []
        seen = session.studio.seen_at(gesture.line, gesture.element)
        if seen is None:
            self._ask_for_point(points, "no point is seen there; ")
            return
        points = [*points, seen.point]
        if len(points) < len(POINTS):
            self._ask_for_point(points)
            return
        light = scene.lights_in_world[session.light_name]
        name = free_name("plane", [each.name for each in light.half_spaces])
        half_space = facing(HalfSpace.through(name, *points), light)
        session.edit(scene.with_light(light.name, half_spaces={name: half_space}))
        session.tell(f"half-space added to {light.name}: {name}")
        self._points = None


# The rows of the panel.

LIST_LEFT: Final = 8
LIST_TOP: Final = WORK.top + 8
LIST_ELEMENTS: Final = (136, 72, 44)
"""The elements of a light's name with its switch, of its intensity, and of solo."""

LIGHTS_A_PAGE: Final = 12
"""Assumed: lights of a page of the list; more would cover too much of the picture."""


class IntensityBar(Bar):
    """The intensity of a light, without its label, which all lights share."""

    def row(self, lit: bool, label: str = "", value: str = "", chosen: bool = False) -> list[Item]:
        return super().row(lit, "", value, chosen)


def placed(row: Sequence[Widget], number: int) -> list[Widget]:
    """The widgets of a row of the panel with their areas; buttons alone share the row evenly."""
    is_light = isinstance(row[0], Switch)
    widths = LIST_ELEMENTS if is_light else (sum(LIST_ELEMENTS) // len(row),) * len(row)
    left, top, widgets = LIST_LEFT, LIST_TOP + number * ROW_LINES, list[Widget]()
    for widget, width in zip(row, widths, strict=True):
        widgets.append(widget.at(Area(left, top, left + width - 1, top + ROW_LINES - 1)))
        left += width
    return widgets


def light_row(session: Session, number: int, light: Light) -> list[Widget]:
    """A light in the list: its number and name with its switch, its intensity, and solo."""
    name, within = light.name, f"light list.{light.name}"
    bar = fields_of(Light)["intensity"].bar
    assert bar is not None

    put = partial(put_light, session, name)

    def choose() -> None:
        if name == session.light_name:
            ask_name(session, "light", name, lambda new: put({"name": new}))
        session.choose_light(name)

    return [
        Switch(
            f"{number:2} {name}",
            f"{name}: a click chooses the light, another renames it; the box: on, off.",
            within="light list",
            is_on=light.on,
            flip=lambda: put({"on": not light.on}),
            choose=choose,
            is_chosen=name == session.light_name,
        ),
        IntensityBar(
            "intensity",
            f"The intensity of {name}.",
            within=within,
            value=light.intensity,
            **bar._asdict(),
            put=lambda intensity: put({"intensity": intensity}),
            word=LIGHT_GRAY if light.on else GRAY,
        ),
        Button(
            "solo",
            f"Switch {name} on alone; again: the lights as before.",
            within=within,
            run=partial(light_alone, session, name),
            is_chosen=name == solo_light(session),
        ),
    ]


# Half-spaces: the marks of their points while these are picked, and their rows.


def plane_items(points: Sequence[Vector], view: View) -> list[Item]:
    """A cross at each point, and lines between them."""
    places = places_of(np.array(points).reshape(-1, 3), view)
    items = [lines([places], YELLOW, area_of(places, limit=WORK))] if len(places) > 1 else []
    for element, line in np.floor(places + 0.5).astype(int).tolist():
        items += highlight_items(element, line, WORK)
    return items


def places_of(points: Floats, view: View) -> Floats:
    """The elements and lines, (n, 2), of points, (n, 3), in the picture, without points behind the eye."""
    camera = (points - np.array(view.eye)) @ view.axes.T
    camera = camera[camera[:, 2] > 0]
    focal = focal_length(SCREEN.height, SCREEN.width, view.field_of_view)
    middle = np.array([SCREEN.width, SCREEN.height]) / 2 - 0.5
    places: Floats = middle + focal * camera[:, :2] / camera[:, 2:]
    return places


def facing(half_space: HalfSpace, light: Light) -> HalfSpace:
    """The half-space turned to its light."""
    to_light = np.array(light.position) - half_space.point
    if light.at_infinity and light.axis is not None:
        to_light = -np.array(light.axis)
    return half_space if to_light @ half_space.direction >= 0 else turned(half_space)


def turned(half_space: HalfSpace) -> HalfSpace:
    """The half-space whose other side is lit."""
    x, y, z = half_space.direction
    return half_space.replace(direction=(0.0 - x, 0.0 - y, 0.0 - z))


def half_space_rows(session: Session, light: Light, half_space: HalfSpace) -> list[Widget]:
    """The rows of a half-space of a light: its switch, and below it the others."""
    name = half_space.name

    def put(changes: Mapping[str, object] | HalfSpace | None) -> None:
        session.edit(session.scene.with_light(light.name, half_spaces={name: changes}))  # type: ignore[dict-item]

    def put_fields(changes: Mapping[str, object]) -> None:
        if "carried" in changes:
            # The plane stays where it is.
            carry: Callable[[HalfSpace, Light], HalfSpace] = attached if changes["carried"] else detached
            put(carry(half_space, session.scene.lights_in_world[light.name]))
        else:
            put(changes)

    def remove() -> None:
        put(None)
        session.tell(f"{titled('half-space', name)} removed; undo brings it back")

    switch, *others = rows_of(half_space, put_fields, session.world, columns=("on", "edge_width", "carried"))
    pair = Pair(
        "turn",
        f"Light the other side of {name}; or remove {name}.",
        run=lambda: put(turned(half_space)),
        other="remove",
        run_other=remove,
    )
    return [
        replace(switch, label=name, within="half-spaces"),
        *(replace(row, label=INDENT + row.label, within=f"half-spaces.{name}") for row in (*others, pair)),
    ]
