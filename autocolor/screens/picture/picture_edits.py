"""Edits of the picture by keys and the mouse: of the view, the lights and the paint of a surface."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.errors import UsageError
from autocolor.mapping.intensity import is_held
from autocolor.scene.defaults import default_view, framed, stage_top
from autocolor.scene.scene import Scene
from autocolor.scene.stage import NONE, shape_of
from autocolor.scene.surfaces import Part
from autocolor.scene.view import View
from autocolor.screens.naming import name_view
from autocolor.screens.session import Session
from autocolor.visibility.projection import focal_length
from autocolor.widgets.widget import titled

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


def turned(scene: Scene, right: float, up: float) -> View:
    """The view with the eye moved around the target by degrees to the right and up, at the same distance.

    An eye above the stage stays above it, as in `moved` and `panned`.
    """
    target = np.array(target_of(scene))
    away = np.array(scene.view.eye) - target
    distance = float(np.linalg.norm(away)) or 1.0
    azimuth = math.radians(scene.view.polar(_vector(target)).azimuth + right)
    before = math.asin(max(-1.0, min(1.0, float(away[2]) / distance)))
    lowest = max(-1.0, (lowest_eye(scene) - float(target[2])) / distance)
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


def lowest_eye(scene: Scene) -> float:
    """The least z coordinate that the eye may move to; minus infinity for an eye not above a stage."""
    mesh, parts, eye = scene.mesh, scene.parts, scene.view.eye
    top = stage_top(mesh, parts)
    if scene.stage != NONE:
        top = max(top, shape_of(mesh, parts).floor)
    if eye[2] <= top:
        return -math.inf
    return min(eye[2], top + ABOVE_STAGE * math.dist(eye, target_of(scene)))


def moved(scene: Scene, ratio: float) -> View:
    """The view with the distance of the eye from the target multiplied by a ratio.

    At the stage, the eye slides along it.
    """
    target = np.array(target_of(scene))
    eye = target + (np.array(scene.view.eye) - target) * ratio
    eye[2] = max(eye[2], lowest_eye(scene))
    return scene.view.replace(eye=_vector(eye))


def panned(scene: Scene, right: float, down: float, lines: int, elements: int) -> View:
    """The view moved sideways, so that the target point moves by elements and lines in the picture.

    `lines` and `elements` are the size of the picture.
    """
    view, target = scene.view, np.array(target_of(scene))
    eye = np.array(view.eye)
    axes = view.axes
    depth = float((target - eye) @ axes[2])
    step = depth / focal_length(lines, elements, view.field_of_view)
    shift = -step * (right * axes[0] + down * axes[1])
    missing = lowest_eye(scene) - float(eye[2] + shift[2])
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


# The edits of the view of a session.

TURN: Final = 5.0
"""Degrees for each step of a key or of a row of a menu."""

CLOSER: Final = 0.9
"""The ratio of distances for each step closer."""


def look(session: Session, view: View) -> None:
    """Change the view."""
    session.edit(session.scene.replace(view=view))


def turn(session: Session, right: float, up: float) -> None:
    """Move the eye around the object, in degrees."""
    _look_above_stage(session, turned(session.scene, right, up), up < 0)


def move(session: Session, ratio: float) -> None:
    """Multiply the distance of the eye by a ratio."""
    look(session, moved(session.scene, ratio))


def pan(session: Session, right: float, down: float) -> None:
    """Move the picture by elements and lines."""
    view = panned(session.scene, right, down, *session.studio.words.shape)
    _look_above_stage(session, view, down < 0)


def _look_above_stage(session: Session, view: View, is_lowered: bool) -> None:
    """Change the view, and say why an eye that is to be lowered stays at its height."""
    before, lowest = session.scene.view.eye[2], lowest_eye(session.scene)
    look(session, view)
    if is_lowered and lowest > -math.inf and math.isclose(before, view.eye[2], rel_tol=1e-9):
        session.tell("the eye stays above the stage")


def tilt(session: Session, steps: float) -> None:
    """Rotate the horizontal axis of the picture plane (Paper: Figure 5, ANGLE)."""
    angle = session.scene.view.angle + steps * TURN
    look(session, session.scene.view.replace(angle=angle))
    session.tell(f"angle {session.scene.view.angle:g} degrees")


def as_opened(session: Session) -> None:
    """Look as the scene's file says: the view that was opened or saved last."""
    look(session, session.studio.history.saved.scene.view)
    session.tell("the view as opened")


def view_again(session: Session, back: bool) -> None:
    """Return to the view before, or forward to the view that was left."""
    studio = session.studio
    if not (studio.view_back() if back else studio.view_forward()):
        session.tell(f"there is no view {'before' if back else 'after'} this one")


def see_from(session: Session, side: str) -> None:
    """Look at the object from a side of `sides_of`."""
    view = seen_from(session.scene, side)
    look(session, view)
    session.side_view = view, side
    session.tell(f"view: {side}")


def present_side(session: Session) -> str:
    """The side that `see_from` took the present view from; empty if it is another view."""
    taken = session.side_view
    return taken[1] if taken is not None and taken[0] == session.scene.view else ""


def present_camera(session: Session) -> str:
    """The name of the named view that equals the present view; empty if there is none.

    If several are equal, the named view that was taken last comes before the first.
    """
    names = [row.name for row in session.scene.views if row.view == session.scene.view]
    return session.camera if session.camera in names else next(iter(names), "")


def take_view(session: Session, name: str) -> None:
    """Make a named view the present view."""
    session.edit(session.scene.with_taken_view(name))
    session.camera = name
    session.tell(f"camera: {name}")


def save_view(session: Session) -> None:
    """Save the present view under a free name, unless a named view equals it."""
    present = present_camera(session)
    if present:
        session.tell(f"this view is saved already: {present}")
        return
    scene = session.scene.with_saved_view()
    session.edit(scene)
    session.tell(f"view saved: {scene.views[-1].name}")
    name_view(session, scene.views[-1].name, is_new=True)


def remove_view(session: Session) -> None:
    """Remove the named view that equals the present view. Raises UsageError if there is none."""
    name = present_camera(session)
    if not name:
        raise UsageError("only the camera that is shown can be removed; take one from the row camera")
    session.edit(session.scene.without_named_view(name))
    session.tell(f"{titled('camera', name)} removed; undo brings it back")


def rescale(session: Session) -> None:
    """Move the eye so that the object fills the picture (Paper: Figure 5, RESCALE)."""
    look(session, framed(session.scene.view, session.scene.object_coordinates))


def rescale_surface(session: Session) -> None:
    """Move the eye so that the chosen surface fills the picture; the object if no surface is in use."""
    if session.surface_name:
        _fill(session, lambda part: part.surface == session.surface_name)
    else:
        rescale(session)


def rescale_part(session: Session) -> None:
    """Move the eye so that the part that was clicked last fills the picture.

    Raises UsageError if no part was clicked.
    """
    if session.part_name not in [part.name for part in session.scene.parts]:
        raise UsageError("no part was clicked yet; click a part in the picture first")
    _fill(session, lambda part: part.name == session.part_name)


def _fill(session: Session, has: Callable[[Part], bool]) -> None:
    """Move the eye so that some parts fill the picture."""
    scene = session.scene
    numbers = [number for number in scene.mesh.parts_in_use if has(scene.parts[number])]
    if not numbers:
        raise UsageError("the view fills with the object, not with its stage; click a part of the object")
    look(session, framed(scene.view, scene.mesh.coordinates_of_parts(numbers)))


# The edits of lights, exposure and paint by keys.

ALL_HELD: Final = "all held"
"""The choice of an exposure that holds the ranges of all surfaces."""


def switch_light(session: Session, number: int) -> None:
    """Switch a light, counted from 0, on or off."""
    lights = session.scene.lights
    if number >= len(lights):
        session.tell(f"the scene has no light {number + 1}")
        return
    light = lights[number]
    session.edit(session.scene.with_light(light.name, on=not light.on))
    session.tell(f"{titled('light', light.name)} {'off' if light.on else 'on'}")


def choose_exposure(session: Session, exposure: str) -> None:
    """Hold the intensity ranges of all surfaces as they are in the picture, or let them follow it.

    `exposure` is ALL_HELD, or a word of the exposure of a scene.
    """
    if exposure != ALL_HELD:
        session.edit(session.scene.replace(exposure=exposure))
        session.tell("the exposure follows the picture")
        return
    session.studio.hold_exposure()
    if not is_held(session.scene.exposure):
        raise UsageError(
            "to hold the exposure, a surface must have different intensities, and none has; switch a light on"
        )
    session.tell("exposure held: less light is darker")


def switch_exposure(session: Session) -> None:
    """Hold the intensity ranges of the picture; if they are held, return to the exposure before."""
    if is_held(session.scene.exposure):
        session.studio.release_exposure()
        session.tell("exposure released")
    else:
        choose_exposure(session, ALL_HELD)


def next_surface(session: Session, step: int) -> None:
    """Choose another surface in use, `step` positions further."""
    count = max(1, len(session.studio.level_ranges))
    session.surface = (session.surface + step) % count
    name = session.surface_name
    session.tell(titled("surface", name) if name else "the scene has no surface")
