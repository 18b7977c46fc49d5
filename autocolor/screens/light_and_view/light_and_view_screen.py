"""The light and view screen: the object, the eye and the lights in three views, to be moved by pointing.

Paper: Figure 5. The user selects a position or a direction in a view, then its new place in the same view.
Two views set all three coordinates, and no number is typed. Positions and directions can be dragged as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Final

from autocolor.arrays import Words
from autocolor.checks import Vector
from autocolor.errors import UsageError
from autocolor.scene.lights import Light
from autocolor.scene.scene import FRONTS
from autocolor.screens.input import Gesture, turn_between, wheel_ratio
from autocolor.screens.light_and_view.handles import (
    AIM,
    EYE,
    FLAP,
    LIGHT,
    MovablePoint,
    handles_in,
    mark_of,
    movable_of,
    point_text,
    side_of,
)
from autocolor.screens.light_and_view.marks import SideItems, flap_marks
from autocolor.screens.light_and_view.object_lines import ObjectLines, sampled
from autocolor.screens.light_and_view.orthographic_views import (
    AXES,
    PICTURE_AREA,
    SIDES,
    OrthographicViews,
    PointMark,
    ViewSide,
    area_of_picture,
    fitted_views,
    shown_points,
    side_at,
)
from autocolor.screens.light_parameters import KIND, parameter_rows, put_light
from autocolor.screens.picture.over_picture import camera_rows
from autocolor.screens.picture.picture_edits import PictureEdits, side_name, target_of
from autocolor.screens.screen import Cached, Handle, Screen
from autocolor.screens.session import Session
from autocolor.widgets.items import (
    GRAY,
    NIGHT,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    image,
    outline,
    text,
)
from autocolor.widgets.menu import Section
from autocolor.widgets.widget import (
    NOWHERE,
    Button,
    Choice,
    Pair,
    Place,
    Steps,
    Switch,
    Widget,
    box_items,
    titled,
)

CLOSER: Final = 1.25
"""Assumed: the ratio of scales for each step of RESCALE."""

ANGLE: Final = 5.0
"""Degrees for each step of ANGLE."""

UNKNOWN: Final = "unknown"
"""The choice of no front."""


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
        self._handles: Cached[list[Handle]] = Cached()
        self._fitted: Cached[OrthographicViews] = Cached()
        self._views: OrthographicViews | None = None
        self._eye_is_chosen = False
        self._moved: Vector | None = None
        """The point that is being placed. Its coordinate across the view stays."""
        self._has_lines = False
        """Whether lines through that point run across the views."""
        self._outside: tuple[PointMark, tuple[float, float]] | None = None
        """The arrow at the edge that was grabbed, and the position of its point; None for a point inside."""

    @property
    def views(self) -> OrthographicViews:
        """The scale and the middle of the three views."""
        if self._views is None:
            scene = self.session.scene
            self._views = self._fitted.of(
                lambda: fitted_views(scene.object_coordinates), scene.mesh, scene.parts
            )
        return self._views

    @property
    def chosen(self) -> str:
        """The name of the chosen light; empty if the eye is chosen."""
        return "" if self._eye_is_chosen else self.session.light_name

    def choose(self, light: str) -> None:
        """Choose a light by its name, or the eye by an empty name."""
        self._eye_is_chosen = not light
        if light:
            self.session.choose_light(light)

    def enter(self) -> None:
        self._views, self._eye_is_chosen = None, False

    def leave(self) -> None:
        self.release()

    # How it looks.

    def base(self) -> Words | int:
        return self._lines.page(self.session.scene, self.views)

    def idle(self) -> bool:
        return self._lines.find_next(self.session.scene, self.views)

    def items(self) -> Sequence[Item]:
        scene, views, chosen = self.session.scene, self.views, self.chosen
        target, moved = target_of(scene), self._moved if self._has_lines else None
        items = self._display.items()
        for side_items in self._sides.values():
            items += side_items.items(views, scene, target, chosen, moved)
        return items

    # Widgets and handles.

    def widgets(self) -> Sequence[Widget]:
        session, chosen = self.session, self.chosen
        if not chosen:
            return []
        put = partial(put_light, session, chosen)
        return list(flap_switches(self.views, session.scene.lights[chosen], put))

    def handles(self) -> Sequence[Handle]:
        scene, views, chosen = self.session.scene, self.views, self.chosen
        handles = self._handles.of(lambda: handles_in(scene, views, chosen), scene, views, chosen)
        signs = {
            MovablePoint(AIM if cross.is_aim else LIGHT, side.name, scene.lights[cross.number - 1].name): area
            for side, items in self._sides.items()
            for cross, area in items.numerals
            if cross.number <= len(scene.lights)
        }
        return [handle._replace(sign=signs.get(movable_of(handle), NOWHERE)) for handle in handles]

    def hint(self, element: int, line: int) -> str:
        if PICTURE_AREA.has(element, line):
            return "The view: drag to turn around the object, the wheel moves closer; click: picture or mesh"
        side = side_at(element, line)
        if side is None:
            return self.help
        point = self.views.placed(side, (0.0, 0.0, 0.0), element, line)
        shown = "  ".join(f"{AXES[axis]} {point[axis]:g}" for axis in (side.right, side.up))
        return f"{self._name_of(side)}: {shown}"

    def _name_of(self, side: ViewSide) -> str:
        return side_name(self.session.scene, side.toward)

    # Gestures.

    def hold(self, handle: Handle) -> None:
        movable = movable_of(handle)
        self.choose(movable.light)
        scene, views = self.session.scene, self.views
        self._moved = movable.point_in(scene, views)
        self._outside = None
        if movable.what in (EYE, LIGHT) and self._moved is not None:
            side = side_of(movable)
            mark = mark_of(movable, side, scene, views)
            if mark.away is not None:
                self._outside = mark, views.position(side, self._moved)
        self._has_lines = movable.what != FLAP

    def release(self) -> None:
        self._moved = None

    def place(self, handle: Handle, element: int, line: int) -> None:
        movable, session, views = movable_of(handle), self.session, self.views
        side = side_of(movable)
        area = side.area
        if session.moving and self._outside is not None:
            # The arrow follows the pointer as far as it points to a light or an eye outside.
            mark, (start, start_line) = self._outside
            element = round(start + mark.ratio * (element - mark.element))
            line = round(start_line + mark.ratio * (line - mark.line))
        elif session.moving:
            element = min(max(element, area.left), area.right)
            line = min(max(line, area.top), area.bottom)
        elif not area.has(element, line):
            raise UsageError(
                f"{movable.label}: its new place must be in the {self._name_of(side)} view; pick it there"
            )
        point = self._moved or movable.point_in(session.scene, views)
        if point is None:
            return
        point = views.placed(side, point, element, line)
        session.edit(movable.put(session.scene, point))
        self._moved = point
        if movable.what == FLAP:
            now = movable.point_in(session.scene, views) or point
            session.tell(f"{movable.label} {views.rounded(now[AXES.index(movable.axis)]):g}")
        else:
            session.tell(f"{movable.label}: {point_text(point, views)}")

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
            Section("three views"),
            Steps("rescale", "RESCALE: move the three views farther or nearer.", step=self.zoom),
            Pair(
                "fit all",
                "RESCALE: show everything, or the object, with space left on all sides.",
                run=self.fit,
                other="object",
                run_other=self.fit_object,
            ),
            Button("fit surface", f"Show the chosen surface: {session.surface_name}.", run=self.fit_surface),
            Choice(
                "front",
                "Toward which axis the object faces: it names the views from the sides.",
                names=(UNKNOWN, *FRONTS),
                present=session.scene.front or UNKNOWN,
                choose=self._face,
            ),
            Section("display view"),
            Choice(
                "display",
                "DISPLAY VIEW: the picture, or the mesh, as the eye sees it.",
                names=(PICTURE, MESH),
                present=self._display.shown,
                choose=self._display.show,
            ),
            Steps("angle", "ANGLE: turn the picture.", step=self._tilt, signs=("<", ">")),
            Button("frame", "Move the eye so that the object fills the picture.", run=self.edits.rescale),
            Button("as opened", "Look as the scene's file says.", run=self.edits.as_opened),
            *camera_rows(self.edits),
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

    def _face(self, front: str) -> None:
        changes: dict[str, Any] = {"front": None if front == UNKNOWN else front}
        self.session.edit(self.session.scene.replace(**changes))

    def zoom(self, steps: float) -> None:
        """Move nearer, or farther."""
        self._views = self.views.zoomed(CLOSER**steps)

    def _tilt(self, steps: float) -> None:
        self.edits.tilt(steps * ANGLE)
        self.session.tell(f"angle {self.session.scene.view.angle:g} degrees")


# DISPLAY VIEW: the fourth quarter of the light and view screen, with the picture or the mesh, small.
#
# Paper: Figure 5, "A small mesh image of the current view can be generated by selecting DISPLAY VIEW".
# Assumed: the picture itself can be shown there, too.

PICTURE: Final = "picture"
MESH: Final = "mesh"
"""The two ways to display the view."""

FRAME: Final = 8
"""Assumed: the elements and lines between the edge of the quarter and the picture."""


class DisplayView:
    """The view of a session as a picture or a mesh."""

    def __init__(self, session: Session, lines: ObjectLines) -> None:
        self._session = session
        self._lines = lines
        self.shown = PICTURE
        self._item: Cached[Item] = Cached()

    @property
    def area(self) -> Area:
        """The area of the picture: the largest of its shape in the quarter, with a frame."""
        lines, elements = self._session.studio.words.shape
        return area_of_picture(PICTURE_AREA.inset(FRAME), elements / lines)

    def show(self, what: str) -> None:
        """Show the picture or the mesh."""
        self.shown = what

    def items(self) -> list[Item]:
        """The items of the quarter."""
        area = self.area
        studio, scene = self._session.studio, self._session.scene
        title = text("view", PICTURE_AREA.left + 8, PICTURE_AREA.top + 4, GRAY)
        words = studio.words
        if self.shown == MESH:
            words = self._lines.of_points(scene, studio.sight.points, area)
        small = self._item.of(lambda: image(sampled(words, area.height, area.width), *area[:2]), words)
        return [title, outline(area.inset(-1), SLATE), small]


# The small switches of the chosen light's flaps, at the end of their lines in the three views.

BOX: Final = 7
"""Elements and lines of a switch."""


class FlapSwitch(Switch):
    """The small box of a flap's switch."""

    def items(self, lit: bool) -> list[Item]:
        return box_items(self.area, self.is_on, WHITE if lit else YELLOW, NIGHT)

    def pick(self, place: Place) -> object:
        return self.flip()


def flap_switches(
    views: OrthographicViews, light: Light, put: Callable[[Mapping[str, Any]], object]
) -> Iterator[FlapSwitch]:
    """The switches of a light's flaps; `put` is called with the changed fields.

    A switch is within its view: above the right end of a level line, or to the right of the lower end of an
    upright line; to the left if there is no room.
    """
    for side in SIDES:
        for mark in flap_marks(views, side, light):
            axis, on = AXES[mark.axis], mark.on
            right, bottom = (round(each) for each in mark.stroke[0, 2:])
            left = right + 2
            if left + BOX - 1 > side.area.right:
                left = right - BOX - 1
            top = max(bottom - BOX - 1, side.area.top)
            yield FlapSwitch(
                f"{light.name}: flap {axis}, {mark.end}, {side.name}",
                f"Switch flap {axis} of {light.name} {'off' if on else 'on'}.",
                area=Area(left, top, left + BOX - 1, top + BOX - 1),
                is_on=on,
                flip=partial(put, {"flaps": {axis: {"on": not on}}}),
            )


# The menu's rows for the eye and the lights, and for columns of the chosen light that have no handle.

COLUMNS: Final = (KIND, "concentration", "cone_angle", "flaps")
"""The columns that have rows; others have handles, or rows on the lights screen."""


def light_rows(
    session: Session, edits: PictureEdits, chosen: str, choose: Callable[[str], object]
) -> list[Widget]:
    """The rows of the eye and of all lights, with their numbers in the views, and of the chosen light.

    `chosen` is the name of a light, or empty for the eye; `choose` is called with another name.
    """
    rows: list[Widget] = [
        Section("eye & lights"),
        Button(
            "eye",
            "Choose the eye: its target can then be grabbed where a light's aim is, too.",
            run=partial(choose, ""),
            is_chosen=not chosen,
        ),
    ]
    for number, light in enumerate(session.scene.lights, start=1):
        rows.append(
            Switch(
                f"{number} {light.name}",
                f"Switch {titled('light', light.name)} on or off; beside the box: choose it.",
                is_on=light.on,
                flip=partial(edits.switch_light, number - 1),
                choose=partial(choose, light.name),
                is_chosen=light.name == chosen,
            )
        )
    if chosen:
        light = session.scene.lights[chosen]
        rows += [Section("chosen light"), *parameter_rows(session, light, COLUMNS)]
    return rows
