"""Lessons: the tasks of the tutorial, each with what tells that a person has done it.

What was done is seen in the scene, however it was done: by a screen, a bar, a key or the picture itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

from autocolor.journal.history import History, Saved
from autocolor.scene.lights.flaps import Flap
from autocolor.scene.lights.light import Light
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface


class Work(NamedTuple):
    """The scene at one moment, and what was saved last."""

    scene: Scene
    saved: Saved


class Lesson(NamedTuple):
    """A task: its name, what to do in two lines, and whether it was done between two moments."""

    name: str
    lines: tuple[str, str]
    is_done: Callable[[Work, Work], bool]


def work_of(history: History) -> Work:
    """The work of a session now."""
    return Work(history.scene, history.saved)


def _moved(before: Work, now: Work) -> bool:
    return any(old.position != light.position for old, light in lights_of_both(before, now))


def _cut_off(before: Work, now: Work) -> bool:
    return any(
        flap is not None and flap != old_flap and _cuts(flap)
        for old, light in lights_of_both(before, now)
        for old_flap, flap in zip(_flaps(old), _flaps(light), strict=True)
    )


def _narrowed(before: Work, now: Work) -> bool:
    return any(
        light.cone_angle is not None and light.cone_angle != old.cone_angle
        for old, light in lights_of_both(before, now)
    )


def _mixed(before: Work, now: Work) -> bool:
    return any(
        (old.paint.object_color, old.paint.light_color)
        != (surface.paint.object_color, surface.paint.light_color)
        for old, surface in surfaces_of_both(before, now)
    )


def _blended(before: Work, now: Work) -> bool:
    return any(old.paint.blend != surface.paint.blend for old, surface in surfaces_of_both(before, now))


def _saved(before: Work, now: Work) -> bool:
    # A scene that was just opened has no files that it was saved to.
    return now.saved is not before.saved and bool(now.saved.files)


def _flaps(light: Light) -> tuple[Flap | None, Flap | None, Flap | None]:
    return light.flaps.x, light.flaps.y, light.flaps.z


def _cuts(flap: Flap) -> bool:
    """Whether a flap keeps light away from anything."""
    return flap.on and (flap.minimum > -math.inf or flap.maximum < math.inf)


def lights_of_both(before: Work, now: Work) -> list[tuple[Light, Light]]:
    """The lights that both scenes have, by name."""
    old = {light.name: light for light in before.scene.lights}
    return [(old[light.name], light) for light in now.scene.lights if light.name in old]


def surfaces_of_both(before: Work, now: Work) -> list[tuple[Surface, Surface]]:
    """The surfaces that both scenes have, by name."""
    old = {surface.name: surface for surface in before.scene.surfaces}
    return [(old[surface.name], surface) for surface in now.scene.surfaces if surface.name in old]


LESSONS: Final = (
    Lesson(
        "move a light",
        (
            "The right edge brings the menu: pick light & view there. Pick a light",
            "in one of the views, then its new place in the same view; or drag it.",
        ),
        _moved,
    ),
    Lesson(
        "flaps",
        (
            "Keep a light from a part of the car: in this menu, or that of lights,",
            "switch on one of the flaps x, y and z, and set where it ends.",
        ),
        _cut_off,
    ),
    Lesson(
        "a cone",
        (
            "Make a spotlight: in the same menu, switch on the cone angle. Drag",
            "along its bar until the rim of the light is where you want it.",
        ),
        _narrowed,
    ),
    Lesson(
        "mix a color",
        (
            "Paint the car: pick < picture, pick the body, then color mixing in",
            "the menu. The bars are red, green, blue, and white for all three.",
        ),
        _mixed,
    ),
    Lesson(
        "blend",
        (
            "Pick < picture, then light blending, and drag the handle of the bar:",
            "above it, the color of the body goes over into that of the light.",
        ),
        _blended,
    ),
    Lesson(
        "save",
        (
            "Pick < picture, then file, and save there: the message line says the",
            "names of the files that hold the scene and the picture.",
        ),
        _saved,
    ),
)
"""The tasks, in the order of the paper: lights, flaps and cones, colors."""
