"""The lights screen: a list of all lights and every parameter of the chosen light, over the picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.errors import InputError, UsageError
from autocolor.mapping.legend import CORNERS
from autocolor.scene.columns import fields_of
from autocolor.scene.creation import new_light_of
from autocolor.scene.following import attached, detached
from autocolor.scene.lights import HalfSpace, Light, free_name
from autocolor.scene.view import View
from autocolor.screens.file_actions import save_rig
from autocolor.screens.input import Gesture
from autocolor.screens.light_parameters import KIND, all_lights_on, light_alone, parameter_rows, solo_light
from autocolor.screens.naming import name_light
from autocolor.screens.picture.light_handles import LightHandles, highlight_items
from autocolor.screens.picture.over_picture import OverPicture, exposure_row
from autocolor.screens.screen import Content, Surroundings
from autocolor.screens.session import Session
from autocolor.visibility.projection import focal_length
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import (
    BLACK,
    CHARACTER,
    GRAY,
    LIGHT_GRAY,
    NIGHT,
    SCREEN,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    area_of,
    filled,
    fitted,
    lines,
    text,
)
from autocolor.widgets.menu import WORK, Section
from autocolor.widgets.widget import (
    BOX,
    MARGIN,
    NOWHERE,
    ROW_LINES,
    TEXT_DOWN,
    Button,
    Choice,
    Pair,
    Place,
    Switch,
    Widget,
    box_items,
    page_choice,
    short_name,
    titled,
)

FIRST: Final = ("on", "intensity", "concentration", "cone_angle", "inner_angle", "flaps")
"""The columns of a light that are edited most; their rows are always shown."""

SECTIONS: Final[Mapping[str, Sequence[str]]] = {
    "place & aim": (KIND, "position", "direction", "aim", "follows"),
    "links": ("links",),
}
"""The columns of the sections of the menu. Further columns are in a section of their own."""

APART: Final = ("half_spaces",)
"""The columns whose rows are not derived."""


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
        self._picking = PlanePicking(session, WORK)
        self._list = LightList(session)

    def build(self, around: Surroundings) -> Content:
        content, marks, picking = super().build(around), self._handles, self._picking
        marks.area = WORK if around.has_menu else SCREEN
        # The list covers handles, also where they are within reach of a place beside it.
        covered = self._list.area if around.has_panels else NOWHERE
        handles = () if picking.is_on else [*content.handles, *marks.handles()]
        return replace(
            content,
            items=[*content.items, *(picking if picking.is_on else marks).items()],
            rows=self._rows,
            widgets=self._list.widgets() if around.has_panels else (),
            handles=[each for each in handles if not covered.has(each.element, each.line)],
            preferred=marks.preferred,
            escape=picking.end,
        )

    def pick(self, gesture: Gesture) -> None:
        if self._picking.is_on:
            self._picking.pick(gesture.element, gesture.line)
        else:
            super().pick(gesture)

    def leave(self) -> None:
        self._picking.end()

    def _rows(self) -> Sequence[Widget]:
        light = self.session.chosen_light
        if light is None:
            return [
                Button(
                    "add a light", "A light above the side of the eye, aimed at the object.", run=self._add
                )
            ]
        session, first = self.session, parameter_rows(self.session, light, FIRST)
        shown = {*FIRST, *APART, *chain.from_iterable(SECTIONS.values())}
        others = [name for name in fields_of(Light) if name not in shown]
        rows: list[Widget] = [
            Choice(
                "light",
                "The light whose parameters are shown.",
                names=tuple(each.name for each in session.scene.lights),
                present=light.name,
                choose=session.choose_light,
            ),
            *first,
            exposure_row(session),
        ]
        for title, columns in {**SECTIONS, "other settings": others}.items():
            rows += [Section(title), *parameter_rows(session, light, columns)]
        rows += [Section("half-spaces"), *half_space_rows(session, light, self._picking)]
        return [*rows, Section("add & remove"), *self._verbs()]

    def _verbs(self) -> list[Widget]:
        session = self.session
        return [
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
        light = new_light_of(self.session.scene)
        scene = self.session.scene
        self.session.edit(scene.replace(lights=(*scene.lights, light)))
        self.session.choose_light(light.name)
        self.session.tell(f"light added: {light.name}")
        name_light(self.session, light.name, is_new=True)

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
        name_light(self.session, lights[-1].name, is_new=True)

    def _remove(self) -> None:
        name = self.session.light_name
        self.session.edit(self.session.scene.without_light(name))
        self.session.tell(f"{titled('light', name)} removed; undo brings it back")


# The light list: a panel over the picture with a row for each light.

LIST_AT: Final = Place(8, WORK.top + 8)
"""The upper left corner of the list."""

NAME_CHARACTERS: Final = 12
NUMBER_CHARACTERS: Final = 5
TRACK: Final = 56
"""Elements of the bar of an intensity."""

SOLO: Final = "solo"
SPACE: Final = 6
"""Elements between the parts of a row."""

LIST_ELEMENTS: Final = (
    2 * MARGIN + CHARACTER * (3 + NAME_CHARACTERS + NUMBER_CHARACTERS + len(SOLO)) + BOX + TRACK + 4 * SPACE
)

LIGHTS_A_PAGE: Final = 12
"""Assumed: lights of a page of the list; more would cover too much of the picture."""


class LightList:
    """The list of the lights of a session. Folded, it shows its heading alone."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._is_open = True
        self._page: tuple[str, int] | None = None
        """The light that was chosen when the user turned to another page, and the page."""

    @property
    def area(self) -> Area:
        """The area of the list; empty without lights."""
        areas = [each.area for each in self.widgets()]
        return Area(*areas[0][:2], *areas[-1][2:]) if areas else NOWHERE

    def widgets(self) -> list[Widget]:
        """The rows of the list with their areas: the heading, the lights, and the rows for all lights."""
        lights = self._session.scene.lights
        if not lights:
            return []
        help = "Fold the list of all lights, or show it."
        rows: list[Widget] = [Section("light list", help, is_open=self._is_open, fold=self._fold)]
        if self._is_open:
            pages = -(-len(lights) // LIGHTS_A_PAGE)
            page = min(self._shown_page, pages - 1)
            first = page * LIGHTS_A_PAGE
            for number, light in enumerate(lights[first : first + LIGHTS_A_PAGE], start=first + 1):
                rows.append(self._row(number, light))
            if pages > 1:
                rows.append(page_choice("The next page of lights.", page, pages, self._turn))
            rows.append(
                Button("all lights on", "Switch all lights on.", run=partial(all_lights_on, self._session))
            )
        left, top = LIST_AT
        right = left + LIST_ELEMENTS - 1
        return [
            row.at(Area(left, top + ROW_LINES * number, right, top + ROW_LINES * (number + 1) - 1))
            for number, row in enumerate(rows)
        ]

    def _row(self, number: int, light: Light) -> LightRow:
        session, name = self._session, light.name
        bar = fields_of(Light)["intensity"].bar
        assert bar is not None
        return LightRow(
            name,
            f"{name}: name: choose, again: rename; box: on, off; bar: intensity; {SOLO}: alone, and back",
            within="light list",
            value=light.intensity,
            **bar._asdict(),
            put=lambda intensity: session.edit(session.scene.with_light(name, intensity=intensity)),
            numeral=number,
            is_on=light.on,
            is_chosen=name == session.light_name,
            is_solo=name == solo_light(session),
            choose=partial(self._choose, name),
            switch=lambda: session.edit(session.scene.with_light(name, on=not light.on)),
            solo=partial(light_alone, session, name),
        )

    def _choose(self, name: str) -> None:
        if name == self._session.light_name:
            name_light(self._session, name)
        self._session.choose_light(name)

    @property
    def _shown_page(self) -> int:
        """The page that the user turned to, until another light is chosen; else the chosen light's page."""
        session = self._session
        if self._page is not None and self._page[0] == session.light_name:
            return self._page[1]
        names = [light.name for light in session.scene.lights]
        return names.index(session.light_name) // LIGHTS_A_PAGE

    def _turn(self, page: int) -> None:
        self._page = self._session.light_name, page

    def _fold(self, is_open: bool) -> None:
        self._is_open = is_open


@dataclass(frozen=True)
class LightRow(Bar):
    """A light in the list: its numeral and name, its switch, its intensity with a bar, and solo.

    A pick on the name calls `choose`, on the box `switch`, on the bar `put`, and on the word at the end
    `solo`. A drag that begins on the bar sets the intensity.
    """

    numeral: int = 1
    is_on: bool = True
    is_chosen: bool = False
    is_solo: bool = False
    choose: Callable[[], object] = lambda: None
    switch: Callable[[], object] = lambda: None
    solo: Callable[[], object] = lambda: None

    @property
    def _name_end(self) -> int:
        """The element after the numeral and the name."""
        return self.area.left + MARGIN + CHARACTER * (3 + NAME_CHARACTERS) + SPACE // 2

    @property
    def _box(self) -> Area:
        left, top = self._name_end + SPACE // 2, self.area.top + (ROW_LINES - BOX) // 2
        return Area(left, top, left + BOX - 1, top + BOX - 1)

    @property
    def _track(self) -> Area:
        left, middle = self._box.right + 1 + SPACE, self.area.top + ROW_LINES // 2
        return Area(left, middle - 3, left + TRACK - 1, middle + 2)

    @property
    def _solo_start(self) -> int:
        return self.area.right + 1 - MARGIN - CHARACTER * len(SOLO)

    def items(self, lit: bool) -> list[Item]:
        left, top, *_ = self.area
        ground, ink = SLATE if lit else NIGHT, WHITE if self.is_on else LIGHT_GRAY
        named = self.area._replace(right=self._name_end - 1)
        name_ground, name_ink = (WHITE, BLACK) if self.is_chosen else (ground, ink)
        name = f"{self.numeral:2} {short_name(self.label, NAME_CHARACTERS)}"
        track, down = self._track, top + TEXT_DOWN
        end = track.left + round(self.share * (track.width - 1))
        number = fitted(self.number, NUMBER_CHARACTERS)
        return [
            filled(self.area, ground),
            filled(named, name_ground),
            text(name, left + MARGIN, down, name_ink, name_ground),
            *box_items(self._box, self.is_on, ink, ground),
            filled(track, GRAY if lit else SLATE),
            filled(track._replace(right=end), YELLOW if lit else LIGHT_GRAY if self.is_on else GRAY),
            text(number, self._solo_start - SPACE - CHARACTER * len(number), down, ink, ground),
            text(SOLO, self._solo_start, down, YELLOW if self.is_solo else LIGHT_GRAY, ground),
        ]

    def pick(self, place: Place) -> object:
        element = place.element
        if element < self._name_end:
            return self.choose()
        if element < self._track.left - SPACE // 2:
            return self.switch()
        if element < self._solo_start - SPACE // 2:
            return self.put(self.value_at(element)) if self._is_on_track(element) else None
        return self.solo()

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.put(self.value_at(place.element)) if self._is_on_track(start.element) else None

    def _is_on_track(self, element: int) -> bool:
        return self._track.left - SPACE // 2 <= element <= self._track.right + SPACE // 2


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

        Raises InputError if the three points are in one line, and UsageError without a light; the third must
        then be picked again.
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
        except (InputError, UsageError):
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
        if not session.light_name:
            raise UsageError("to have a half-space, there must be a light; add one")
        light = scene.lights_in_world[session.light_name]
        name = free_name(NAME, [each.name for each in light.half_spaces])
        half_space = HalfSpace.through(name, *self._points)
        if not is_lit_side(half_space, light, scene.view):
            half_space = turned(half_space)
        session.edit(session.scene.with_light(light.name, half_spaces={name: half_space}))
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
    focal = focal_length(SCREEN.height, SCREEN.width, view.field_of_view)
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
    helps = {key: field.help for key, field in fields_of(HalfSpace).items()}
    usual = session.world.range_of_lengths(is_zero_left_out=False)

    def put(**changes: object) -> None:
        session.edit(session.scene.with_light(light.name, half_spaces={name: changes}))  # type: ignore[dict-item]

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
    there = session.scene.lights_in_world[light.name]
    carry = detached if half_space.carried else attached
    _put_row(session, light, carry(half_space, there))


def _put_row(session: Session, light: Light, half_space: HalfSpace) -> None:
    session.edit(session.scene.with_light(light.name, half_spaces={half_space.name: half_space}))


def _remove(session: Session, light: Light, name: str) -> None:
    session.edit(session.scene.with_light(light.name, half_spaces={name: None}))
    session.tell(f"{titled('half-space', name)} removed; undo brings it back")
