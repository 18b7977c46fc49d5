"""The lights screen: every parameter of the chosen light, over the picture; lights added, copied, removed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

from autocolor.checks import Vector
from autocolor.scene.columns.column import fields_of
from autocolor.scene.lights import Light
from autocolor.scene.new_lights import new_light_of
from autocolor.screens.over_picture import OverPicture
from autocolor.widgets.column_rows import rows_of
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Button, Choice, Gap, Widget

POINT: Final = "point source"
DIRECTION: Final = "direction"
AIM: Final = "aim"
"""The kinds of lights: those with an axis have a direction, or an aim."""

DOWN: Final = (0.0, 0.0, -1.0)
"""The direction of a light that had none."""

NEEDS_AXIS: Final = "a point source has none; choose the kind aim first"


class LightsScreen(OverPicture):
    """The lights, one at a time."""

    name = "lights"
    title = "lights"
    help = "The chosen light; click in the picture: choose a surface"

    def rows(self) -> Sequence[Widget]:
        light = self.session.chosen_light
        if light is None:
            return [
                Button(
                    "add a light", "A light above the side of the eye, aimed at the object.", run=self._add
                )
            ]
        return [
            Choice(
                "light",
                "The light whose parameters these are.",
                names=tuple(each.name for each in self.session.scene.lights),
                present=light.name,
                choose=self.session.choose_light,
            ),
            *self._verbs(light),
            Gap("parameters gap"),
            *self._parameters(light),
        ]

    def _verbs(self, light: Light) -> list[Widget]:
        session = self.session
        return [
            Pair(
                "alone",
                "This light alone; or all lights on.",
                run=partial(session.light_alone, light.name),
                other="all on",
                run_other=session.all_lights_on,
            ),
            Pair(
                "add",
                "Another light, or a copy of this one.",
                run=self._add,
                other="copy",
                run_other=self._copy,
            ),
            Pair(
                "mirror",
                "A copy of this light on the other side of the object; or take this light away.",
                run=self._mirror,
                other="remove",
                run_other=self._remove,
            ),
            Button("save the rig", "Save all lights, to put them on another scene.", run=session.save_rig),
        ]

    def _parameters(self, light: Light) -> list[Widget]:
        put = partial(self._put, light.name)
        rows = rows_of(light, put, self.session.world)
        kind = DIRECTION if light.direction is not None else AIM if light.aim is not None else POINT
        # A point source has no axis: what needs one cannot be used, and says so.
        if kind == POINT:
            needing = ("concentration", "cone angle")
            rows = [replace(row, why_not=NEEDS_AXIS) if row.label in needing else row for row in rows]
        # What kind of light it is stands before what only some kinds have.
        axis = ("direction", "aim", "concentration")
        before = next(number for number, row in enumerate(rows) if row.label.startswith(axis))
        choice = Choice(
            "kind",
            "A point source shines to all sides; others along a direction, or at an aim.",
            names=(POINT, AIM, DIRECTION),
            present=kind,
            choose=partial(self._choose_kind, light),
        )
        return [*rows[:before], choice, *rows[before:]]

    def _put(self, name: str, changes: Mapping[str, Any]) -> None:
        self.session.change_light(name, **changes)
        if "name" in changes:
            self.session.choose_light(str(changes["name"]))

    def _choose_kind(self, light: Light, kind: str) -> None:
        if kind == POINT:
            # Without an axis there is no concentration and no cone.
            absent = {name: _default(name) for name in ("direction", "aim", "concentration", "cone_angle")}
            self._put(light.name, absent)
        elif kind == AIM:
            self._put(light.name, {"aim": aim_of(light, *self.session.world)})
        else:
            self._put(light.name, {"direction": light.axis or DOWN})

    def _add(self) -> None:
        light = new_light_of(self.session.scene)
        scene = self.session.scene
        self.session.edit(scene.replace(lights=(*scene.lights, light)))
        self.session.choose_light(light.name)
        self.session.tell(f"light {light.name} added")

    def _copy(self) -> None:
        self._append(self.session.scene.with_copied_light(self.session.light_name).lights, "copied")

    def _mirror(self) -> None:
        # The sides of a product are those of its shorter horizontal extent.
        (x, y, _), (to_x, to_y, _) = self.session.scene.object_bounds
        axis = "x" if to_x - x <= to_y - y else "y"
        lights = self.session.scene.with_mirrored_light(self.session.light_name, axis).lights
        self._append(lights, f"mirrored along {axis}")

    def _append(self, lights: tuple[Light, ...], done: str) -> None:
        before = self.session.light_name
        self.session.edit(self.session.scene.replace(lights=lights))
        self.session.choose_light(lights[-1].name)
        self.session.tell(f"light {before} {done}: {lights[-1].name}")

    def _remove(self) -> None:
        name = self.session.light_name
        self.session.edit(self.session.scene.without_light(name))
        self.session.tell(f"light {name} removed; undo brings it back")


def aim_of(light: Light, low: Vector, high: Vector) -> Vector:
    """A point at which a light without an aim is aimed: ahead of it, or else the middle of the object.

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


def _default(name: str) -> object:
    default = fields_of(Light)[name].default
    return None if default is None else default()
