"""Edits of the picture by keys and the mouse: of the view, the lights and the paint of a surface."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.errors import UsageError
from autocolor.mapping.intensity import is_held
from autocolor.scene.defaults import OBJECT_COLORS, default_view, framed, stage_top
from autocolor.scene.kinds import in_digits
from autocolor.scene.scene import Scene
from autocolor.scene.stage import NONE, shape_of
from autocolor.scene.view import View
from autocolor.screens.cached import Cached
from autocolor.screens.naming import name_view
from autocolor.screens.session import Session
from autocolor.screens.surface.painting import change_paint
from autocolor.visibility.projection import focal_length
from autocolor.widgets.widget import titled

# The object colors that a key steps through: the default colors of new surfaces, and a surface's own color.


def color_after(present: str, own: str, step: int, colors: Sequence[str] = OBJECT_COLORS) -> str:
    """The color that is `step` positions further than the present one, among different `colors`.

    The surface's own color comes first if the colors do not contain it. If they do not contain the present
    color, the first color follows.

    >>> color_after("#ff0000", "#ff0000", 1), color_after("#f4a39b", "#ff0000", -1)
    ('#f4a39b', '#ff0000')
    """
    colors = colors if own in colors else (own, *colors)
    place = colors.index(present) + step if present in colors else 0
    return colors[place % len(colors)]


# Orbiting: views with the eye moved around its target, closer to it, farther away or beside it.
#
# Some views have names: those from the sides of the object.

HIGHEST: Final = math.radians(85)
"""Assumed: the largest elevation; closer to the vertical, a small step would spin the picture."""

ABOVE_STAGE: Final = 0.01
"""Assumed: how far an eye stays above the stage, as a part of its distance from the target."""

SIDE_NAMES: Final = ("front", "left", "back", "right")
"""The sides of an object whose front is known. Left and right are the object's own."""

AXIS_NAMES: Final = {
    (0.0, -1.0, 0.0): "from -y",
    (1.0, 0.0, 0.0): "from x",
    (0.0, 1.0, 0.0): "from y",
    (-1.0, 0.0, 0.0): "from -x",
}
"""The sides of other objects, by the direction toward the eye."""

TOP: Final = "top"
THREE_QUARTERS: Final = "three quarters"


def front_of(scene: Scene) -> Vector:
    """The direction toward which the object faces; -y, as on an engineering drawing, if that is not known."""
    sign = -1.0 if (scene.front or "-y").startswith("-") else 1.0
    return (sign, 0.0, 0.0) if (scene.front or "").endswith("x") else (0.0, sign, 0.0)


def sides_of(scene: Scene) -> dict[str, Vector | None]:
    """The directions toward the eye of the views from the sides, in the order of their keys.

    Three quarters, which is None, is the direction of a created view, turned with the front.
    Assumed: as on an engineering drawing, x is to the right and z up in the view from -y, y to the right and
    z up in the view from x, x to the right and y up in the top view.
    """
    x, y, _ = front_of(scene)
    ring = ((x, y, 0.0), (0.0 - y, x, 0.0), (0.0 - x, 0.0 - y, 0.0), (y, 0.0 - x, 0.0))
    names = SIDE_NAMES if scene.front else [AXIS_NAMES[toward] for toward in ring]
    front, left, back, right = zip(names, ring, strict=True)
    return dict([front, left, back, (TOP, (0.0, 0.0, 1.0)), (THREE_QUARTERS, None), right])


def side_name(scene: Scene, toward_eye: Vector) -> str:
    """The name of the view from a direction along an axis."""
    return next(name for name, toward in sides_of(scene).items() if toward == toward_eye)


def turned(scene: Scene, right: float, up: float, top: float = -math.inf) -> View:
    """The view with the eye moved around the target by degrees to the right and up, at the same distance.

    An eye above `top`, the z coordinate of the stage, stays above it, as in `moved` and `panned`.
    """
    target = np.array(target_of(scene))
    away = np.array(scene.view.eye) - target
    distance = float(np.linalg.norm(away)) or 1.0
    azimuth = math.radians(scene.view.polar(_vector(target)).azimuth + right)
    before = math.asin(max(-1.0, min(1.0, float(away[2]) / distance)))
    lowest = max(-1.0, (lowest_eye(scene, top) - float(target[2])) / distance)
    elevation = max(-HIGHEST, min(HIGHEST, before + math.radians(up)))
    elevation = max(elevation, min(before, math.asin(min(1.0, lowest))))
    # At the highest and lowest elevation, rounding would make a slightly different view.
    if up and math.isclose(elevation, before, abs_tol=1e-9):
        return scene.view
    horizontal = math.cos(elevation)
    eye = target + distance * np.array(
        [horizontal * math.cos(azimuth), horizontal * math.sin(azimuth), math.sin(elevation)]
    )
    return scene.view.replace(eye=_vector(eye), target=_vector(target))


def lowest_eye(scene: Scene, top: float) -> float:
    """The least z coordinate that the eye may move to, for a stage with this `top`."""
    eye = scene.view.eye
    if eye[2] <= top:
        return -math.inf
    return min(eye[2], top + ABOVE_STAGE * math.dist(eye, target_of(scene)))


def moved(scene: Scene, ratio: float, top: float = -math.inf) -> View:
    """The view with the distance of the eye from the target multiplied by a ratio.

    At the stage, the eye slides along it.
    """
    target = np.array(target_of(scene))
    eye = target + (np.array(scene.view.eye) - target) * ratio
    eye[2] = max(eye[2], lowest_eye(scene, top))
    return scene.view.replace(eye=_vector(eye))


def panned(
    scene: Scene, right: float, down: float, lines: int, elements: int, top: float = -math.inf
) -> View:
    """The view moved sideways, so that the target point moves by elements and lines in the picture.

    `lines` and `elements` are the size of the picture.
    """
    view, target = scene.view, np.array(target_of(scene))
    eye = np.array(view.eye)
    axes = view.axes
    depth = float((target - eye) @ axes[2])
    step = depth / focal_length(lines, elements, view.field_of_view)
    shift = -step * (right * axes[0] + down * axes[1])
    missing = lowest_eye(scene, top) - float(eye[2] + shift[2])
    if missing > 0:
        # The steepest direction in the picture plane: only a shift along it changes the height.
        steepest = np.array([0.0, 0.0, 1.0]) - axes[2, 2] * axes[2]
        shift += steepest * missing / steepest[2]
    return view.replace(eye=_vector(eye + shift), target=_vector(target + shift))


def seen_from(scene: Scene, side: str) -> View:
    """The upright view of the object from a side of `sides_of`, in which it fills the picture."""
    toward_eye: Vector | Floats | None = sides_of(scene)[side]
    if toward_eye is None:
        right, toward, up = default_view(scene.object_coordinates).axes[2] * -1
        x, y, _ = front_of(scene)
        toward_eye = (-right * y - toward * x, right * x - toward * y, up)
    eye, target = _vector(toward_eye), (0.0, 0.0, 0.0)
    # The angle is 0, so that the view is upright, as on a drawing.
    view = scene.view.replace(eye=eye, direction=None, target=target, angle=0.0)
    return framed(view, scene.object_coordinates)


def target_of(scene: Scene) -> Vector:
    """The point to orbit: the view's target, else the point on the line of sight at the object's depth."""
    return scene.view.orbit_target(*scene.object_bounds)


def _vector(values: Floats | Vector) -> Vector:
    return (float(values[0]), float(values[1]), float(values[2]))


ALL_HELD: Final = "all held"
"""The choice of an exposure that holds the ranges of all surfaces."""


class PictureEdits:
    """The edits of the picture of a session, one method for each key."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._own_colors: dict[str, str] = {}
        """The object colors of surfaces before a key changed them, by the surface's name."""
        self._top: Cached[float] = Cached()

    def look(self, view: View) -> None:
        """Change the view."""
        self.session.edit(self.session.scene.replace(view=view))

    @property
    def stage_top(self) -> float:
        """The largest z coordinate of the stage; minus infinity without a stage."""
        scene = self.session.scene
        if scene.stage != NONE:
            return max(stage_top(scene.mesh, scene.parts), shape_of(scene.mesh, scene.parts).floor)
        return self._top.of(lambda: stage_top(scene.mesh, scene.parts), scene.mesh, scene.parts)

    def turn(self, right: float, up: float) -> None:
        """Move the eye around the object, in degrees."""
        before = self.session.scene.view.eye[2]
        self.look(turned(self.session.scene, right, up, self.stage_top))
        self._tell_of_stage(up < 0, before)

    def move(self, ratio: float) -> None:
        """Multiply the distance of the eye by a ratio."""
        self.look(moved(self.session.scene, ratio, self.stage_top))

    def pan(self, right: float, down: float) -> None:
        """Move the picture by elements and lines."""
        before = self.session.scene.view.eye[2]
        lines, elements = self.session.studio.words.shape
        self.look(panned(self.session.scene, right, down, lines, elements, self.stage_top))
        self._tell_of_stage(down < 0, before)

    def _tell_of_stage(self, is_lowered: bool, before: float) -> None:
        """Say why the eye did not go below its height `before`."""
        after = self.session.scene.view.eye[2]
        if is_lowered and after > self.stage_top > -math.inf and math.isclose(before, after, rel_tol=1e-9):
            self.session.tell("the eye stays above the stage")

    def as_opened(self) -> None:
        """Look as the scene's file says: the view that was opened or saved last."""
        self.look(self.session.studio.history.saved.scene.view)
        self.session.tell("the view as opened")

    def view_again(self, back: bool) -> None:
        """Return to the view before, or forward to the view that was left."""
        studio = self.session.studio
        if not (studio.view_back() if back else studio.view_forward()):
            self.session.tell(f"there is no view {'before' if back else 'after'} this one")

    def see_from(self, side: str) -> None:
        """Look at the object from a side of `sides_of`."""
        view = seen_from(self.session.scene, side)
        self.look(view)
        self.session.side_view = view, side
        self.session.tell(f"view: {side}")

    @property
    def side(self) -> str:
        """The side that `see_from` took the present view from; empty if it is another view."""
        taken = self.session.side_view
        return taken[1] if taken is not None and taken[0] == self.session.scene.view else ""

    @property
    def camera(self) -> str:
        """The name of the named view that equals the present view; empty if there is none.

        If several are equal, the named view that was taken last comes before the first.
        """
        scene, taken = self.session.scene, self.session.camera
        names = [row.name for row in scene.views if row.view == scene.view]
        return taken if taken in names else next(iter(names), "")

    def take_view(self, name: str) -> None:
        """Make a named view the present view."""
        self.session.edit(self.session.scene.with_taken_view(name))
        self.session.camera = name
        self.session.tell(f"camera: {name}")

    def save_view(self) -> None:
        """Save the present view under a free name, unless a named view equals it."""
        if self.camera:
            self.session.tell(f"this view is saved already: {self.camera}")
            return
        scene = self.session.scene.with_saved_view()
        self.session.edit(scene)
        self.session.tell(f"view saved: {scene.views[-1].name}")
        name_view(self.session, scene.views[-1].name, is_new=True)

    def remove_view(self) -> None:
        """Remove the named view that equals the present view. Raises UsageError if there is none."""
        name = self.camera
        if not name:
            raise UsageError("only the camera that is shown can be removed; take one from the row camera")
        self.session.edit(self.session.scene.without_named_view(name))
        self.session.tell(f"{titled('camera', name)} removed; undo brings it back")

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
        """Move the eye so that the part that was clicked last fills the picture.

        Raises UsageError if no part was clicked.
        """
        if not self.chosen_parts:
            raise UsageError("no part was clicked yet; click a part in the picture first")
        self._fill(self.chosen_parts)

    def _fill(self, parts: Sequence[int]) -> None:
        """Move the eye so that some parts, by their numbers, fill the picture."""
        scene = self.session.scene
        if not parts:
            raise UsageError("the view fills with the object, not with its stage; click a part of the object")
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
        self.session.tell(f"{titled('light', light.name)} {'off' if light.on else 'on'}")

    def choose_exposure(self, exposure: str) -> None:
        """Hold the intensity ranges of all surfaces as they are in the picture, or let them follow it.

        `exposure` is ALL_HELD, or a word of the exposure of a scene.
        """
        session = self.session
        if exposure != ALL_HELD:
            session.edit(session.scene.replace(exposure=exposure))
            session.tell("the exposure follows the picture")
            return
        session.studio.hold_exposure()
        if not is_held(session.scene.exposure):
            raise UsageError(
                "to hold the exposure, a surface must have different intensities, and none has;"
                " switch a light on"
            )
        session.tell("exposure held: less light is darker")

    def switch_exposure(self) -> None:
        """Hold the intensity ranges of the picture; if they are held, return to the exposure before."""
        if is_held(self.session.scene.exposure):
            self.session.studio.release_exposure()
            self.session.tell("exposure released")
        else:
            self.choose_exposure(ALL_HELD)

    def choose_surface(self, step: int) -> None:
        """Select another surface in use for the color keys, `step` positions further."""
        count = max(1, len(self.session.studio.level_ranges))
        self.session.surface = (self.session.surface + step) % count
        self.session.tell(
            titled("surface", self.session.surface_name)
            if self.session.surface_name
            else "the scene has no surface"
        )

    def blend(self, step: float) -> None:
        """Change the blend of the selected surface."""
        if self.session.surface_name:
            blend = self.session.scene.surfaces[self.session.surface_name].paint.blend
            blend = min(1.0, max(0.0, round(blend + step, 6)))
            change_paint(self.session, lambda paint: f"blend {paint.blend:.2f}", blend=blend)

    def repaint(self, step: int) -> None:
        """Give the selected surface another object color, `step` positions further.

        The colors are its own and the paints that the user brought, or OBJECT_COLORS.
        """
        name = self.session.surface_name
        if not name:
            return
        present = in_digits(self.session.scene.surfaces[name].paint.color)
        names = dict.fromkeys(OBJECT_COLORS, "")
        if (paints := self.session.paints) is not None:
            names = dict(zip(map(in_digits, paints.colors), paints.names, strict=True))
        color = color_after(present, self._own_colors.setdefault(name, present), step, tuple(names))
        message = f"object color {', '.join(part for part in (names.get(color), color) if part)}"
        change_paint(self.session, lambda _: message, object_color=color)
