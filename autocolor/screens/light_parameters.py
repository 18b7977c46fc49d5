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
from autocolor.scene.lights import AXIS_CONTROLS, EYE, Light, middle_between
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

EXCLUDED_BY: Final = {
    "only_surfaces": "except_surfaces",
    "except_surfaces": "only_surfaces",
    "only_parts": "except_parts",
    "except_parts": "only_parts",
}
"""The column that a column removes."""

DOWN: Final = (0.0, 0.0, -1.0)
"""The direction of a light that had none."""

NEEDS_AXIS: Final = "a point source has no axis; choose the kind aim first"


def kind_of(light: Light) -> str:
    """The kind of a light."""
    return DIRECTION if light.direction is not None else AIM if light.aim is not None else POINT


def parameter_rows(session: Session, light: Light, columns: Sequence[str]) -> list[Widget]:
    """The rows of some columns of a light, in their order; KIND stands for the row of its kind.

    The inner angle has a row if there is a cone, and the reach if there is a falloff.
    """
    put, own = partial(put_light, session, light.name), {KIND: _kind_row, "follows": _follows_row}
    absent = {"inner_angle": light.cone_angle is None, "reach": light.falloff == "none"}
    rows: list[Widget] = []
    for name in columns:
        if name in own:
            rows.append(own[name](session, light))
        elif not absent.get(name):
            rows += rows_of(light, put, session.world, columns=[name])
    # A point source has no axis: rows that need an axis cannot be used, and say so.
    if kind_of(light) == POINT:
        needing = [name.replace("_", " ") for name in AXIS_CONTROLS]
        rows = [replace(row, why_not=NEEDS_AXIS) if row.label in needing else row for row in rows]
    return rows


def _kind_row(session: Session, light: Light) -> Choice:
    return Choice(
        "kind",
        "A point source shines to all sides; others along a direction, or at an aim.",
        names=(POINT, AIM, DIRECTION),
        present=kind_of(light),
        choose=partial(choose_kind, session, light),
    )


def _follows_row(session: Session, light: Light) -> Choice:
    """The choice of what a light follows: nothing, the eye, or the aim of a light that does not follow it."""

    def choose(follows: str) -> None:
        # The light stays where it is now.
        session.edit(session.scene.with_light_following(light.name, None if follows == WORLD else follows))

    return Choice(
        "follows",
        "The light moves with the eye, with the aim of another light, or with nothing: world.",
        names=(WORLD, EYE, *names_to_follow(light, session.scene.lights)),
        present=light.follows or WORLD,
        choose=choose,
    )


def put_light(session: Session, name: str, changes: Mapping[str, Any]) -> None:
    """Change fields of a light. A light that is renamed stays chosen.

    A list of the only surfaces or parts to light removes the list of exceptions, and vice versa. The inner
    angle is lowered or removed with the cone angle. A light with a falloff but no reach gets the object's
    size as its reach.
    """
    light = session.scene.lights[name]
    others: dict[str, Any] = {
        EXCLUDED_BY[each]: None for each in EXCLUDED_BY.keys() & changes if changes[each] is not None
    }
    if "cone_angle" in changes and light.inner_angle is not None:
        outer = changes["cone_angle"]
        others["inner_angle"] = None if outer is None else min(light.inner_angle, outer)
    if changes.get("falloff", "none") != "none" and light.reach is None:
        others["reach"] = session.world.size
    session.edit(session.scene.with_light(name, **{**others, **changes}))
    if "name" in changes:
        session.choose_light(changes["name"])


def choose_kind(session: Session, light: Light, kind: str) -> None:
    """Change the kind of a light; a light with a direction or an aim goes on shining where it did."""
    scene = session.scene
    there = scene.lights_in_world[light.name]
    if kind == POINT:
        # Without an axis there is no concentration, no cone and no direction to come from.
        defaults = {name: fields_of(Light)[name].default for name in ("direction", "aim", *AXIS_CONTROLS)}
        session.edit(scene.with_light(light.name, **defaults))
    elif kind == AIM:
        aim = aim_of(there, session.world.low, session.world.high)
        session.edit(scene.with_light_in_world(light.name, aim=aim))
    else:
        session.edit(scene.with_light_in_world(light.name, direction=there.axis or DOWN))


def aim_of(light: Light, low: Vector, high: Vector) -> Vector:
    """The point to aim a light at: ahead of it, or else the middle of the object.

    A directed light keeps its direction. `low` and `high` are the bounds of the object.
    """
    middle = middle_between(low, high)
    distance = math.dist(middle, light.position)
    if light.axis is None and distance:
        return middle
    axis = light.axis or DOWN
    ahead = sum(a * (m - p) for a, m, p in zip(axis, middle, light.position, strict=True))
    distance = ahead if ahead > 0 else distance or 1.0
    x, y, z = (p + distance * a for p, a in zip(light.position, axis, strict=True))
    return x, y, z


# Solo: one light on, and all others off.


def solo_light(session: Session) -> str:
    """The name of the light that was switched on alone, while it still is; else empty."""
    on = [light.name for light in session.scene.lights if light.on]
    return on[0] if session.before_solo is not None and on == [session.before_solo.name] else ""


def light_alone(session: Session, name: str) -> None:
    """Switch one light on and all others off; if it is alone, switch all as before."""
    scene, before, alone = session.scene, session.before_solo, solo_light(session)
    if before is not None and alone == name:
        lights = [light.replace(on=before.switches.get(light.name, light.on)) for light in scene.lights]
        session.edit(scene.replace(lights=lights))
        session.tell("the lights are switched as before")
        return
    session.edit(scene.only_lights(name))
    switches = {light.name: light.on for light in scene.lights}
    session.before_solo = Solo(name, before.switches if before is not None and alone else switches)
    session.tell(f"{titled('light', name)} alone; again: the lights as before")


def all_lights_on(session: Session) -> None:
    """Switch all lights on."""
    session.edit(session.scene.with_all_lights_on())
    session.tell("all lights on")
