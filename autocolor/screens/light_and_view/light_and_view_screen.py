"""The light and view screen: the object, the eye and the lights in three views, to be moved by pointing.

Paper: Figure 5. A position or a direction is selected in a view, then its new place in the same view; two
views fix all three coordinates, and no number is typed. It can be dragged as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

from autocolor.checks import Vector
from autocolor.errors import UsageError
from autocolor.screens.input.gestures import Gesture, turn_between, wheel_ratio
from autocolor.screens.light_and_view.areas import PICTURE_AREA
from autocolor.screens.light_and_view.display_view import MESH, PICTURE, DisplayView
from autocolor.screens.light_and_view.flap_switches import flap_switches
from autocolor.screens.light_and_view.grips import FLAP, grip_of, handles_in, target_in, told
from autocolor.screens.light_and_view.kept import Kept
from autocolor.screens.light_and_view.light_rows import light_rows
from autocolor.screens.light_and_view.marks import SideItems
from autocolor.screens.light_and_view.object_lines import ObjectLines
from autocolor.screens.light_and_view.orthographic_views import (
    AXES,
    SIDES,
    OrthographicViews,
    fitted_views,
    side_at,
)
from autocolor.screens.light_and_view.shown_points import shown_points
from autocolor.screens.lights.light_parameters import put_light
from autocolor.screens.picture.picture_edits import PictureEdits
from autocolor.screens.screen import Handle, Screen
from autocolor.screens.session import Session
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import SLATE
from autocolor.widgets.items import Item, filled
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Button, Choice, Gap, Steps, Widget

CLOSER: Final = 1.25
"""Assumed: the ratio of scales for each step of RESCALE."""

ANGLE: Final = 5.0
"""Degrees for each step of ANGLE."""

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
        self._sides = {side: SideItems(side) for side in SIDES}
        self._display = DisplayView(session, self._lines)
        self._handles: Kept[list[Handle]] = Kept()
        self._views: OrthographicViews | None = None
        self._eye_is_chosen = False
        self._moved: Vector | None = None
        """The point that is being placed. It keeps the coordinate that its view does not show."""
        self._has_lines = False
        """Whether lines run from it across the views."""

    @property
    def views(self) -> OrthographicViews:
        """The scale and the middle of the three views."""
        if self._views is None:
            self._views = fitted_views(shown_points(self.session.scene))
        return self._views

    @property
    def chosen(self) -> str:
        """The name of the light that is chosen; empty if it is the eye."""
        return "" if self._eye_is_chosen else self.session.light_name

    def choose(self, light: str) -> None:
        """Choose a light by its name, or the eye by an empty one."""
        self._eye_is_chosen = not light
        if light:
            self.session.choose_light(light)

    def enter(self) -> None:
        self._views, self._eye_is_chosen = None, False

    def leave(self) -> None:
        self.release()

    # What is seen.

    def items(self) -> Sequence[Item]:
        scene, views, chosen = self.session.scene, self.views, self.chosen
        target, moved = target_in(scene), self._moved if self._has_lines else None
        found = [*(filled(area, SLATE) for area in LINES_BETWEEN), *self._display.items()]
        for side, side_items in self._sides.items():
            strokes = self._lines.of_side(scene, views, side)
            found += side_items.items(views, scene, target, strokes, chosen, moved)
        return found

    def idle(self) -> bool:
        return self._lines.leave_out_hidden(self.session.scene) or self._display.leave_out_hidden()

    # What can be pointed at.

    def widgets(self) -> Sequence[Widget]:
        session, chosen = self.session, self.chosen
        if not chosen:
            return []
        put = partial(put_light, session, chosen)
        return list(flap_switches(self.views, session.scene.light(chosen), put))

    def handles(self) -> Sequence[Handle]:
        scene, views, chosen = self.session.scene, self.views, self.chosen
        return self._handles.of(lambda: handles_in(scene, views, chosen), scene, views, chosen)

    def hint(self, element: int, line: int) -> str:
        if PICTURE_AREA.has(element, line):
            return "The view: drag to turn around the object, the wheel moves closer; click: picture or mesh"
        side = side_at(element, line)
        if side is None:
            return self.help
        point = self.views.placed(side, (0.0, 0.0, 0.0), element, line)
        shown = "  ".join(f"{AXES[axis]} {point[axis]:g}" for axis in (side.right, side.up))
        return f"{side.name}: {shown}"

    # What that does.

    def hold(self, handle: Handle) -> None:
        grip = grip_of(handle)
        self.choose(grip.light)
        self._moved = grip.point_in(self.session.scene, self.views)
        self._has_lines = grip.what != FLAP

    def release(self) -> None:
        self._moved = None

    def place(self, handle: Handle, element: int, line: int) -> None:
        grip, session, views = grip_of(handle), self.session, self.views
        side = next(each for each in SIDES if each.name == grip.side)
        area = side.area
        if session.moving:
            element = min(max(element, area.left), area.right)
            line = min(max(line, area.top), area.bottom)
        elif not area.has(element, line):
            raise UsageError(f"{grip.label}: its new place must be in the {side.name} view; pick it there")
        point = self._moved or grip.point_in(session.scene, views)
        if point is None:
            return
        point = views.placed(side, point, element, line)
        session.edit(grip.put(session.scene, point))
        self._moved = point
        if grip.what == FLAP:
            now = grip.point_in(session.scene, views) or point
            session.tell(f"{grip.label} {now[AXES.index(grip.axis)]:g}")
        else:
            session.tell(f"{grip.label}: {told(point)}")

    def pick(self, gesture: Gesture) -> None:
        if PICTURE_AREA.has(gesture.element, gesture.line):
            self._display.show(PICTURE if self._display.shown == MESH else MESH)
        else:
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

    # The menu.

    def rows(self) -> Sequence[Widget]:
        session = self.session
        return [
            *light_rows(session, self.edits, self.chosen, self.choose),
            Gap("view gap"),
            Steps("rescale", "RESCALE: move the three views farther or nearer.", step=self.zoom),
            Pair(
                "fit all",
                "RESCALE: show everything, or the object, with space left on all sides.",
                run=self.fit,
                other="object",
                run_other=self.fit_object,
            ),
            Button("fit surface", f"Show the chosen surface: {session.surface_name}.", run=self.fit_surface),
            Gap("display gap"),
            Choice(
                "display",
                "DISPLAY VIEW: the picture, or the mesh, as the eye sees it.",
                names=(PICTURE, MESH),
                present=self._display.shown,
                choose=self._display.show,
            ),
            Steps("angle", "ANGLE: turn the picture.", step=self._tilt, signs=("<", ">")),
            Button("frame", "Move the eye so that the object fills the picture.", run=self.edits.rescale),
        ]

    def fit(self) -> None:
        """Show everything, with space left on all sides."""
        self._views = fitted_views(shown_points(self.session.scene))
        self.session.tell("the views show everything")

    def fit_object(self) -> None:
        """Show the object."""
        self._views = fitted_views(self.session.scene.object_coordinates)
        self.session.tell("the views show the object")

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

    def _tilt(self, steps: float) -> None:
        self.edits.tilt(steps * ANGLE)
        self.session.tell(f"angle {self.session.scene.view.angle:g} degrees")
