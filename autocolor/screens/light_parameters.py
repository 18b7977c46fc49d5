"""The rows of a light's parameters, for the menus of all screens where lights are set."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

from autocolor.scene.columns.column import fields_of
from autocolor.scene.lights import Light
from autocolor.screens.session import Session
from autocolor.widgets.column_rows import rows_of
from autocolor.widgets.widget import Choice, Widget

POINT: Final = "point source"
DIRECTION: Final = "direction"
AIM: Final = "aim"
"""The kinds of lights: those with an axis have a direction, or an aim."""

NEEDS_AXIS: Final = "a point source has none; choose the kind aim first"


def kind_of(light: Light) -> str:
    """The kind of a light."""
    return DIRECTION if light.direction is not None else AIM if light.aim is not None else POINT


def parameter_rows(session: Session, light: Light, leave_out: Sequence[str] = ()) -> list[Widget]:
    """The rows of the columns of a light, without some, and of its kind, which stands after its place."""
    rows = rows_of(light, partial(put_light, session, light.name), session.world, leave_out)
    # A point source has no axis: what needs one cannot be used, and says so.
    if kind_of(light) == POINT:
        needing = ("concentration", "cone angle")
        rows = [replace(row, why_not=NEEDS_AXIS) if row.label in needing else row for row in rows]
    before = max((n for n, row in enumerate(rows, start=1) if row.label.startswith("position")), default=0)
    choice = Choice(
        "kind",
        "A point source shines to all sides; others along a direction, or at an aim.",
        names=(POINT, AIM, DIRECTION),
        present=kind_of(light),
        choose=partial(choose_kind, session, light),
    )
    return [*rows[:before], choice, *rows[before:]]


def put_light(session: Session, name: str, changes: Mapping[str, Any]) -> None:
    """Change fields of a light; one that gets another name stays chosen."""
    session.change_light(name, **changes)
    if "name" in changes:
        session.choose_light(str(changes["name"]))


def choose_kind(session: Session, light: Light, kind: str) -> None:
    """Make a light one of another kind, aimed at the middle of the object, or in the direction it had."""
    if kind == POINT:
        # Without an axis there is no concentration and no cone.
        absent = {name: _default(name) for name in ("direction", "aim", "concentration", "cone_angle")}
        put_light(session, light.name, absent)
    elif kind == AIM:
        low, high = session.scene.object_bounds
        middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
        put_light(session, light.name, {"aim": middle})
    else:
        put_light(session, light.name, {"direction": light.axis or (0.0, 0.0, -1.0)})


def _default(name: str) -> object:
    default = fields_of(Light)[name].default
    return None if default is None else default()
