"""Edits of the colors of the chosen surface, their rows in menus, and their messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final, NamedTuple, Unpack

import numpy as np

from autocolor.arrays import half_up
from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.mapping.colors import entries_at, entries_of
from autocolor.scene.changes import PaintChanges
from autocolor.scene.defaults import OBJECT_COLORS
from autocolor.scene.kinds import in_digits
from autocolor.scene.scene import Scene, unset_paints
from autocolor.scene.surfaces import Paint
from autocolor.scene.swatches import finished
from autocolor.screens.session import Session
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Switch, Widget

TWO_COLORS: Final = ("object", "light source")
"""The names of the two colors of a paint for users, in the order of their numbers."""


class PaintColor(NamedTuple):
    """A color of a paint: the object color, number 0, the light color, number 1, or a color of the ramp."""

    paint: Paint
    number: int

    @property
    def color(self) -> Color:
        return colors_of(self.paint)[self.number]

    @property
    def label(self) -> str:
        """The label of the color: "object", or "color 2" of a ramp."""
        return TWO_COLORS[self.number] if self.paint.ramp is None else f"color {self.number + 1}"

    @property
    def name(self) -> str:
        """The color in a sentence: "the object color", or "color 2 of 5"."""
        ramp = self.paint.ramp
        return f"the {self.label} color" if ramp is None else f"{self.label} of {len(ramp)}"

    def change(self, color: Sequence[int] | str) -> PaintChanges:
        """The change of the paint that puts another color in its place."""
        ramp, number = self.paint.ramp, self.number
        if ramp is not None:
            return {"ramp": (*ramp[:number], color, *ramp[number + 1 :])}
        return {"light_color": color} if number else {"object_color": color}


def colors_of(paint: Paint) -> tuple[Color, ...]:
    """The colors of a ramp, or the object color and the light color."""
    return paint.ramp or (paint.object_color, paint.light_color)


def with_moved_color(ramp: tuple[Color, ...], number: int, to: int) -> list[list[int]]:
    """The ramp with a color at another place among as many colors; both are numbers from 0.

    The parts of the ramp below and above the color are stretched or shortened evenly, and give the others.

    >>> with_moved_color(((0, 0, 0), (30, 30, 30), (60, 60, 60), (0, 0, 90)), 1, 2)
    [[0, 0, 0], [15, 15, 15], [30, 30, 30], [0, 0, 90]]
    """
    last = len(ramp) - 1
    below = np.interp(range(to), [0, to], [0, number])
    above = np.interp(range(to + 1, last + 1), [to, last], [number, last])
    fractions = np.float32(1 / last) * np.array([*below, number, *above], np.float32)
    colors: list[list[int]] = entries_at(Paint(ramp=ramp), fractions, len(ramp)).tolist()
    return colors


def change_paint(
    session: Session, message: Callable[[Paint], str] | None = None, /, **changes: Unpack[PaintChanges]
) -> None:
    """Change the colors of the chosen surface, if there is one, and show a message about its new paint.

    If two colors replace a ramp, colors and blend are as before the ramp, if there are steps before it, else
    the color in its middle and its last color, unless they are given.
    """
    name = session.surface_name
    if name:
        present = session.scene.surfaces[name].paint
        if present.ramp is not None and changes.get("ramp") is None:
            middle = Paint(present.color, present.ramp[-1])
            earlier = reversed(session.studio.history.earlier)
            paints = (row.paint for scene in earlier for row in scene.surfaces if row.name == name)
            before = next((paint for paint in paints if paint.ramp is None), middle)
            scene = session.scene.with_surface(name, paint=before.replace(**changes))
        else:
            scene = session.scene.with_paint(name, **changes)
        edit_paint(session, scene, message(scene.surfaces[name].paint) if message else "")


def with_finish(session: Session, name: str) -> Scene:
    """The scene with a finish of the chosen surface. Raises UsageError for an unknown finish."""
    surface = session.scene.surfaces[session.surface_name]
    return session.scene.with_surface(surface.name, **finished(surface, name))


def edit_paint(session: Session, scene: Scene, message: str) -> None:
    """Make a scene with other paints the current scene, and tell the colors that the edit unsets."""
    before = session.scene
    # A message is about the chosen surface already.
    chosen = f"{session.surface_name}: " if message else ""
    messages = [message, *(each.removeprefix(chosen) for each in unset_paints(before, scene))]
    session.edit(scene)
    if any(messages):
        session.tell("; ".join(filter(None, messages)))


def color_of(session: Session, color: Sequence[int] | str) -> Sequence[int] | str:
    """The color that a text names among `paints`; every other color itself."""
    if not isinstance(color, str) or session.paints is None:
        return color
    return session.paints.color_named(color.strip()) or color


def take_paint(session: Session, name: str) -> None:
    """Give the chosen surface the paint of another: both colors, the blend and the percentage, or a ramp.

    Raises UsageError if that is the chosen surface.
    """
    chosen = session.surface_name
    if name == chosen:
        raise UsageError(f"{name} is the chosen surface; point at another, whose paint it takes")
    scene = session.scene.with_surface(chosen, paint=session.scene.surfaces[name].paint)
    edit_paint(session, scene, f"{chosen}: the paint of {name}; undo goes back")


def paint_rows(session: Session, paint: Paint) -> list[Widget]:
    """The rows of the chosen surface's paint without its colors: whether it has a ramp, else the blend."""
    switch = Switch(
        "ramp",
        "A ramp of any colors from the lowest level to the highest, instead of two colors and their blend.",
        is_on=paint.ramp is not None,
        flip=partial(_flip_ramp, session, paint),
    )
    if paint.ramp is not None:
        return [switch]

    def put(changes: Mapping[str, Any]) -> None:
        change_paint(session, **changes)

    rows = rows_of(paint, put, session.world, leave_out=("object_color", "light_color"))
    # Shorten labels so that they fit beside their numbers.
    return [switch, *(replace(row, label=row.label.replace("percentage", "percent")) for row in rows)]


FIRST_RAMP_COLORS: Final = 6
"""Assumed: colors of a ramp that is switched on. The default blend, 0.6, begins at the fourth, so the surface
looks nearly as before."""


def _flip_ramp(session: Session, paint: Paint) -> None:
    """Give the chosen surface a ramp that looks like its paint, or two colors instead of its ramp."""
    if paint.ramp is not None:
        change_paint(session, ramp=None)
        return
    image, name = session.studio.display_image, session.surface_name
    entries = entries_of(paint, image.ranges[name].levels, image.floor_of(name))
    steps = FIRST_RAMP_COLORS - 1
    levels = [half_up(step * (len(entries) - 1) / steps) for step in range(steps + 1)]
    change_paint(session, ramp=entries[levels].tolist())


def blend(session: Session, step: float) -> None:
    """Change the blend of the chosen surface."""
    if session.chosen_surface is not None:
        blend = min(1.0, max(0.0, round(session.chosen_surface.paint.blend + step, 6)))
        change_paint(session, lambda paint: f"blend {paint.blend:.2f}", blend=blend)


def repaint(session: Session, step: int) -> None:
    """Give the chosen surface another object color, `step` positions further.

    The colors are its own and the paints that the user brought, or OBJECT_COLORS. The surface's own color
    comes first if the others do not contain it. The first color follows a color that is none of them.
    """
    if session.chosen_surface is None:
        return
    present = in_digits(session.chosen_surface.paint.color)
    names = dict.fromkeys(OBJECT_COLORS, "")
    if (paints := session.paints) is not None:
        names = dict(zip(map(in_digits, paints.colors), paints.names, strict=True))
    own = session.own_colors.setdefault(session.surface_name, present)
    colors = [*names] if own in names else [own, *names]
    place = colors.index(present) + step if present in colors else 0
    color = colors[place % len(colors)]
    message = f"object color {', '.join(part for part in (names.get(color), color) if part)}"
    change_paint(session, lambda _: message, object_color=color)
