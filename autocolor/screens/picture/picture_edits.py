"""Edits of the picture by keys and the mouse: of the view, the lights and the paint of a surface."""

from __future__ import annotations

import math
from typing import Final

from autocolor.arrays import Floats
from autocolor.errors import UsageError
from autocolor.mapping.intensity import is_held
from autocolor.scene.defaults import framed
from autocolor.scene.orbit import lowest_eye, moved, panned, seen_from, turned
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.naming import name_view
from autocolor.screens.session import Session
from autocolor.widgets.widget import titled

# The edits of the view of a session.

TURN: Final = 5.0
"""Degrees for each step of a key or of a row of a menu."""

CLOSER: Final = 0.9
"""The ratio of distances for each step closer."""


def look(session: Session, view: View, is_lowered: bool = False) -> None:
    """Change the view, and say why an eye that is to be lowered stays at its height above a stage."""
    before, lowest = session.scene.view.eye[2], lowest_eye(session.scene)
    session.edit(session.scene.replace(view=view))
    if is_lowered and lowest > -math.inf and math.isclose(before, view.eye[2], rel_tol=1e-9):
        session.tell("the eye stays above the stage")


def turn(session: Session, right: float, up: float) -> None:
    """Move the eye around the object, in degrees."""
    look(session, turned(session.scene, right, up), up < 0)


def move(session: Session, ratio: float) -> None:
    """Multiply the distance of the eye by a ratio."""
    look(session, moved(session.scene, ratio))


def pan(session: Session, right: float, down: float) -> None:
    """Move the picture by elements and lines."""
    look(session, panned(session.scene, right, down, *session.studio.words.shape), down < 0)


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
    """The name of the first named view that equals the present view; empty if there is none."""
    return next((row.name for row in session.scene.views if row.view == session.scene.view), "")


def take_view(session: Session, name: str) -> None:
    """Make a named view the present view."""
    session.edit(session.scene.with_taken_view(name))
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


def rescale(session: Session, surface: str = "") -> None:
    """Move the eye so that the object, or a surface, fills the picture (Paper: Figure 5, RESCALE)."""
    scene = session.scene
    points = coordinates_of(scene, "surface", surface) if surface else scene.object_coordinates
    look(session, framed(scene.view, points))


def rescale_part(session: Session) -> None:
    """Move the eye so that the part that was clicked last fills the picture.

    Raises UsageError if no part was clicked.
    """
    scene, name = session.scene, session.part_name
    if name not in [part.name for part in scene.parts]:
        raise UsageError("no part was clicked yet; click a part in the picture first")
    look(session, framed(scene.view, coordinates_of(scene, "name", name)))


def coordinates_of(scene: Scene, column: str, name: str) -> Floats:
    """The coordinates, (nodes, 3), of the parts of the object with a name in a column of their table.

    Raises UsageError if there are none.
    """
    mesh, parts = scene.mesh, scene.parts
    numbers = [number for number in mesh.parts_in_use if getattr(parts[number], column) == name]
    if not numbers:
        raise UsageError("the view fills with the object, not with its stage; click a part of the object")
    return mesh.coordinates_of_parts(numbers)


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
    session.surface = (session.surface + step) % max(1, len(session.studio.level_ranges))
    name = session.surface_name
    session.tell(titled("surface", name) if name else "the scene has no surface")
