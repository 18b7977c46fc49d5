"""The rows of a light's parameters, for the menus of all screens where lights are set."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

from autocolor.checks import Vector
from autocolor.scene.columns import fields_of
from autocolor.scene.following import names_to_follow
from autocolor.scene.lights import AXIS_CONTROLS, EYE, Light
from autocolor.screens.session import Session, Solo
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Choice, Widget, titled

POINT: Final = "point source"
DIRECTION: Final = "direction"
AIM: Final = "aim"
"""The kinds of lights: those with an axis have a direction, or an aim."""

KIND: Final = "kind"
"""Stands for the kind of a light among its columns."""

WORLD: Final = "world"
"""The choice for a light that follows nothing."""

AXIS_COLUMNS: Final = ("direction", "aim", "concentration", "cone_angle", "inner_angle", "at_infinity")
"""The columns of lights with an axis."""

EXCLUDING: Final = (
    ("only_surfaces", "except_surfaces"),
    ("except_surfaces", "only_surfaces"),
    ("only_parts", "except_parts"),
    ("except_parts", "only_parts"),
)
"""Pairs of columns that exclude each other: a column, and the column that it removes."""

DOWN: Final = (0.0, 0.0, -1.0)
"""The direction of a light that had none."""

NEEDS_AXIS: Final = "a point source has no axis; choose the kind aim first"


def kind_of(light: Light) -> str:
    """The kind of a light."""
    return DIRECTION if light.direction is not None else AIM if light.aim is not None else POINT


def parameter_rows(session: Session, light: Light, columns: Sequence[str]) -> list[Widget]:
    """The rows of some columns of a light, in their order; KIND stands for the row of its kind."""
    put, world = partial(_put_with_reach, session, light), session.world
    rows = [
        row
        for name in columns
        for row in (
            [_kind_row(session, light)] if name == KIND else rows_of(light, put, world, columns=[name])
        )
    ]
    # A light can follow only some lights, and keeps its place when it begins to follow.
    rows = [_follows_row(session, light) if row.label == "follows" else row for row in rows]
    # A point source has no axis: rows that need an axis cannot be used, and say so.
    if kind_of(light) == POINT:
        needing = [name.replace("_", " ") for name in AXIS_CONTROLS]
        rows = [replace(row, why_not=NEEDS_AXIS) if row.label in needing else row for row in rows]
    return rows


def _kind_row(session: Session, light: Light) -> Choice:
    """The choice of the kind of a light."""
    return Choice(
        "kind",
        "A point source shines to all sides; others along a direction, or at an aim.",
        names=(POINT, AIM, DIRECTION),
        present=kind_of(light),
        choose=partial(choose_kind, session, light),
    )


def put_light(session: Session, name: str, changes: Mapping[str, Any]) -> None:
    """Change fields of a light. A light that is renamed stays chosen.

    The inner angle is lowered or removed with the cone angle. A list of the only surfaces or parts to light
    removes the list of exceptions, and vice versa.
    """
    for chosen, other in EXCLUDING:
        if changes.get(chosen) is not None:
            changes = {other: None, **changes}
    inner = session.scene.lights[name].inner_angle
    if "cone_angle" in changes and inner is not None:
        outer = changes["cone_angle"]
        changes = {"inner_angle": None if outer is None else min(inner, outer), **changes}
    session.edit(session.scene.with_light(name, **changes))
    if "name" in changes:
        session.choose_light(str(changes["name"]))


def choose_kind(session: Session, light: Light, kind: str) -> None:
    """Change the kind of a light; a light with a direction or an aim goes on shining where it did."""
    if kind == POINT:
        # Without an axis there is no concentration, no cone and no direction to come from.
        put_light(session, light.name, {name: _default(name) for name in AXIS_COLUMNS})
        return
    scene = session.scene
    light = scene.lights_in_world[light.name]
    if kind == AIM:
        scene = scene.with_light_in_world(
            light.name, aim=aim_of(light, session.world.low, session.world.high)
        )
    else:
        scene = scene.with_light_in_world(light.name, direction=light.axis or DOWN)
    session.edit(scene)


def aim_of(light: Light, low: Vector, high: Vector) -> Vector:
    """The point to aim a light at: ahead of it, or else the middle of the object.

    A directed light keeps its direction. `low` and `high` are the bounds of the object.
    """
    middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    away = tuple(a - b for a, b in zip(middle, light.position, strict=True))
    axis = light.axis or (DOWN if not any(away) else None)
    if axis is None:
        x, y, z = middle
        return x, y, z
    ahead = sum(a * b for a, b in zip(axis, away, strict=True))
    distance = ahead if ahead > 0 else math.hypot(*away) or 1.0
    x, y, z = (a + distance * b for a, b in zip(light.position, axis, strict=True))
    return x, y, z


def choose_follows(session: Session, name: str, follows: str) -> None:
    """Let a light follow the eye, another light or nothing; it stays where it is now."""
    session.edit(session.scene.with_light_following(name, None if follows == WORLD else follows))


def _follows_row(session: Session, light: Light) -> Choice:
    """The choice of what a light follows: nothing, the eye, or the aim of a light that does not follow it."""
    return Choice(
        "follows",
        "The light moves with the eye, with the aim of another light, or with nothing: world.",
        names=(WORLD, EYE, *names_to_follow(light, session.scene.lights)),
        present=light.follows or WORLD,
        choose=partial(choose_follows, session, light.name),
    )


def _put_with_reach(session: Session, light: Light, changes: Mapping[str, Any]) -> None:
    """Change fields of a light. A light with a falloff but no reach gets the object's size as its reach."""
    if changes.get("falloff", "none") != "none" and light.reach is None:
        changes = {**changes, "reach": session.world.size}
    put_light(session, light.name, changes)


def _default(name: str) -> object:
    return fields_of(Light)[name].default


# Solo: one light on, and all others off.


def solo_light(session: Session) -> str:
    """The name of the light that was switched on alone, while it still is; else empty."""
    on = [light.name for light in session.scene.lights if light.on]
    return on[0] if session.before_solo is not None and on == [session.before_solo.name] else ""


def light_alone(session: Session, name: str) -> None:
    """Switch one light on and all others off; if it is alone, switch all as before."""
    scene, before, alone = session.scene, session.before_solo, solo_light(session)
    if before is not None and alone == name:
        switches = [before.switches.get(light.name, light.on) for light in scene.lights]
        lights = zip(scene.lights, switches, strict=True)
        session.edit(scene.replace(lights=tuple([light.replace(on=on) for light, on in lights])))
        session.tell("the lights are switched as before")
        return
    session.edit(scene.only_lights(name))
    switches_now = {light.name: light.on for light in scene.lights}
    session.before_solo = Solo(name, before.switches if before is not None and alone else switches_now)
    session.tell(f"{titled('light', name)} alone; again: the lights as before")


def all_lights_on(session: Session) -> None:
    """Switch all lights on."""
    session.edit(session.scene.with_all_lights_on())
    session.tell("all lights on")
