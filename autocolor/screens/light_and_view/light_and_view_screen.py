"""The light and view screen: the object, the eye and the lights in three views, to be moved by pointing.

Paper: Figure 5. A position or a direction is selected in a view, then its new place in the same view; two
views fix all three coordinates, and no number is typed. It can be dragged as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Final

import numpy as np

from autocolor.arrays import Words
from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.screens.gestures import Gesture, turn_between, wheel_ratio
from autocolor.screens.light_and_view.areas import PICTURE_AREA, area_of_picture
from autocolor.screens.light_and_view.grips import AXES, FLAP, Grip, handles_in, told, vector
from autocolor.screens.light_and_view.light_marks import flap_marks
from autocolor.screens.light_and_view.marks import eye_items, light_items, lines_across
from autocolor.screens.light_and_view.object_lines import ObjectLines
from autocolor.screens.light_and_view.orthographic_views import (
    SIDES,
    OrthographicViews,
    Side,
    fitted_views,
)
from autocolor.screens.light_and_view.shown_points import shown_points
from autocolor.screens.orbit import target_of
from autocolor.screens.picture_edits import PictureEdits
from autocolor.screens.screen import Handle, Screen
from autocolor.screens.session import Session
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, NIGHT, SLATE, WHITE, YELLOW
from autocolor.widgets.column_rows import rows_of
from autocolor.widgets.items import Item, filled, image, text
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Button, Gap, Place, Steps, Switch, Widget, box_items

CLOSER: Final = 1.25
"""Assumed: the ratio of scales for each step of RESCALE."""

ANGLE: Final = 5.0
"""Degrees for each step of ANGLE."""

LIGHT_ROWS: Final = ("concentration", "cone_angle", "flaps")
"""The columns of the chosen light that stand in the menu; others are pointed at, or on the lights screen."""

BOX: Final = 7
"""Elements and lines of the switch of a flap."""

LINES_BETWEEN: Final = (Area(251, 0, 252, 463), Area(0, 227, 503, 228))
"""The lines between the quarters."""


class LightAndViewScreen(Screen):
    """The three views, and in the fourth quarter the picture or the mesh as the eye sees it."""

    name = "light and view"
    title = "light & view"
    help = "Pick a light, an aim or the eye, then its new place in the same view; or drag it"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.edits = PictureEdits(session)
        self._lines = ObjectLines()
        self._views: OrthographicViews | None = None
        self._shows_mesh = False
        self._moved: Vector | None = None
        """The point that is being placed, of which lines run across the views."""

    @property
    def views(self) -> OrthographicViews:
        """The scale and the middle of the three views."""
        if self._views is None:
            self._views = fitted_views(shown_points(self.session.scene))
        return self._views

    def enter(self) -> None:
        self._views = None

    def leave(self) -> None:
        self._moved = None

    # What is seen.

    def items(self) -> Sequence[Item]:
        scene, views, chosen = self.session.scene, self.views, self.session.light_name
        target = vector(target_of(scene))
        found = [*(filled(area, SLATE) for area in LINES_BETWEEN), *self._fourth_quarter()]
        for side in SIDES:
            if self._moved is not None:
                found += lines_across(views, side, self._moved)
            found += self._lines.of_side(scene, views, side)
            found += eye_items(views, side, scene.view, target)
            for number, light in enumerate(scene.lights, start=1):
                found += light_items(views, side, light, number, light.name == chosen)
            label = f"{side.name}   {AXES[side.right]} >  {AXES[side.up]} ^"
            found.append(text(label, side.area.left + 8, side.area.top + 4, GRAY))
        return found

    def _fourth_quarter(self) -> list[Item]:
        area = area_of_picture(PICTURE_AREA)
        if self._shows_mesh:
            return [filled(area, NIGHT), *self._lines.of_eye(self.session.scene, area)]
        return [image(smaller(self.session.studio.words, area), area.left, area.top)]

    # What can be pointed at.

    def widgets(self) -> Sequence[Widget]:
        light = self.session.chosen_light
        return [] if light is None else list(self._flap_switches(light))

    def _flap_switches(self, light: Light) -> Iterator[Widget]:
        """A small switch at the end of each line of a flap."""
        for side in SIDES:
            for mark in flap_marks(self.views, side, light):
                axis, on = AXES[mark.axis], mark.on
                right, bottom = (int(each) for each in mark.stroke[0, 2:])
                left, top = (right - BOX, bottom - BOX) if mark.axis == side.up else (right + 2, bottom - BOX)
                flaps = {axis: {"on": not on}}
                yield FlapSwitch(
                    f"{light.name}: flap {axis}, {mark.end}, {side.name}",
                    f"Switch flap {axis} of {light.name} {'off' if on else 'on'}.",
                    area=Area(left, top, left + BOX - 1, top + BOX - 1).within(side.area),
                    is_on=on,
                    flip=partial(self._put_light, light.name, {"flaps": flaps}),
                )

    def handles(self) -> Sequence[Handle]:
        return handles_in(self.session.scene, self.views, self.session.light_name)

    def hint(self, element: int, line: int) -> str:
        if PICTURE_AREA.has(element, line):
            return "The view: drag to turn around the object, the wheel moves closer"
        side = side_at(element, line)
        if side is None:
            return self.help
        point = self.views.placed(side, (0.0, 0.0, 0.0), element, line)
        shown = "  ".join(f"{AXES[axis]} {point[axis]:g}" for axis in (side.right, side.up))
        return f"{side.name}: {shown}"

    # What that does.

    def hold(self, handle: Handle) -> None:
        grip = grip_of(handle)
        if grip.light:
            self.session.choose_light(grip.light)
        self._moved = None if grip.what == FLAP else grip.point_in(self.session.scene, self.views)

    def release(self) -> None:
        self._moved = None

    def place(self, handle: Handle, element: int, line: int) -> None:
        grip, session = grip_of(handle), self.session
        side = next(each for each in SIDES if each.name == grip.side)
        area = side.area
        if not area.has(element, line):
            if not session.moving:
                session.warn(f"{grip.label}: its new place must be in the {side.name} view")
                return
            element = min(max(element, area.left), area.right)
            line = min(max(line, area.top), area.bottom)
        point = grip.point_in(session.scene, self.views)
        if point is None:
            return
        point = self.views.placed(side, point, element, line)
        session.edit(grip.put(session.scene, point))
        if grip.what == FLAP:
            session.tell(f"{grip.label} {point[AXES.index(grip.axis)]:g}")
        else:
            self._moved = point
            session.tell(f"{grip.label}: {told(point)}")

    def pick(self, gesture: Gesture) -> None:
        self.session.tell(self.help)

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        if PICTURE_AREA.has(start.element, start.line):
            self.edits.turn(*turn_between(last.element, last.line, now.element, now.line))
            return
        side = side_at(start.element, start.line)
        if side is not None:
            center = list(self.views.center)
            center[side.right] -= (now.element - last.element) / self.views.scale
            center[side.up] += (now.line - last.line) / self.views.scale
            self._views = self.views.centered(center)

    def wheel(self, gesture: Gesture) -> None:
        if PICTURE_AREA.has(gesture.element, gesture.line):
            self.edits.move(wheel_ratio(gesture.steps))
        else:
            self.zoom(gesture.steps / 2)

    def fit(self) -> None:
        """Show everything, with space left on all sides."""
        self._views = fitted_views(shown_points(self.session.scene))
        self.session.tell("the views show everything")

    def fit_surface(self) -> None:
        """Show the chosen surface."""
        scene, name = self.session.scene, self.session.surface_name
        numbers = [part for part in scene.mesh.parts_in_use if scene.parts[part].surface == name]
        if numbers:
            self._views = fitted_views(scene.mesh.coordinates_of_parts(numbers))
            self.session.tell(f"the views show {name}")

    def zoom(self, steps: float) -> None:
        """Move nearer, or farther."""
        self._views = self.views.zoomed(CLOSER**steps)

    def idle(self) -> bool:
        return self._lines.leave_out_hidden(self.session.scene)

    # The menu.

    def rows(self) -> Sequence[Widget]:
        session, light = self.session, self.session.chosen_light
        found: list[Widget] = [
            Switch(
                f"{number} {each.name}",
                f"Switch light {each.name} on or off; beside the box: choose it.",
                is_on=each.on,
                flip=partial(self.edits.switch_light, number - 1),
                choose=partial(session.choose_light, each.name),
                is_chosen=each is light,
            )
            for number, each in enumerate(session.scene.lights, start=1)
        ]
        if light is not None:
            others = [name for name in vars(light) if name not in LIGHT_ROWS]
            put = partial(self._put_light, light.name)
            found += [Gap("light gap"), *rows_of(light, put, session.world, leave_out=others)]
        return [
            *found,
            Gap("view gap"),
            Pair(
                "picture",
                "DISPLAY VIEW: the picture, or the mesh, as the eye sees it.",
                run=partial(self._show_mesh, False),
                other="mesh",
                run_other=partial(self._show_mesh, True),
            ),
            Steps("rescale", "RESCALE: move the three views farther or nearer.", step=self.zoom),
            Pair(
                "fit all",
                "Show everything in the views, or the chosen surface.",
                run=self.fit,
                other="surface",
                run_other=self.fit_surface,
            ),
            Steps(
                "angle",
                "ANGLE: turn the horizontal axis of the picture.",
                step=lambda steps: self.edits.tilt(steps * ANGLE),
                signs=("<", ">"),
            ),
            Button("frame", "Move the eye so that the object fills the picture.", run=self.edits.rescale),
        ]

    def _show_mesh(self, shows_mesh: bool) -> None:
        self._shows_mesh = shows_mesh

    def _put_light(self, light: str, changes: Mapping[str, Any]) -> None:
        self.session.change_light(light, **changes)


class FlapSwitch(Switch):
    """The small box of a flap's switch."""

    def items(self, lit: bool) -> list[Item]:
        if self.area.is_empty:
            return []
        return box_items(self.area, self.is_on, WHITE if lit else YELLOW, NIGHT)

    def pick(self, place: Place) -> object:
        return self.flip()


def smaller(words: Words, area: Area) -> Words:
    """The words of a picture at the size of an area: each pixel is one of the picture's."""
    lines = np.arange(area.height) * len(words) // area.height
    elements = np.arange(area.width) * words.shape[1] // area.width
    found: Words = words[np.ix_(lines, elements)]
    return found


def side_at(element: int, line: int) -> Side | None:
    """The view at a place."""
    return next((side for side in SIDES if side.area.has(element, line)), None)


def grip_of(handle: Handle) -> Grip:
    """What a handle of this screen moves."""
    assert isinstance(handle.key, Grip)
    return handle.key
