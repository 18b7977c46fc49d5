"""Edits of the colors of the chosen surface, and their messages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Unpack

from autocolor.errors import UsageError
from autocolor.scene.changes import PaintChanges
from autocolor.scene.scene import Scene, unset_paints
from autocolor.scene.surfaces import Paint
from autocolor.scene.swatches import finished
from autocolor.screens.session import Session


def change_paint(
    session: Session, message: Callable[[Paint], str] | None = None, /, **changes: Unpack[PaintChanges]
) -> None:
    """Change the colors of the chosen surface, if there is one, and show a message about its new paint.

    If two colors replace a ramp, colors and blend are as before the ramp, if this session gave it, else
    the color in its middle and its last color, unless they are given.
    """
    if session.surface_name:
        present = session.scene.surfaces[session.surface_name].paint
        if present.ramp is not None and changes.get("ramp") is None:
            mesh, before = session.blended.get(session.surface_name, (None, present))
            if mesh is not session.scene.mesh:
                before = Paint(present.color, present.ramp[-1])
            scene = session.scene.with_surface(session.surface_name, paint=before.replace(**changes))
        else:
            scene = session.scene.with_paint(session.surface_name, **changes)
        edit_paint(session, scene, message(scene.surfaces[session.surface_name].paint) if message else "")


def finish(session: Session, name: str) -> None:
    """Give the chosen surface a finish. Raises UsageError for an unknown finish."""
    surface = session.scene.surfaces[session.surface_name]
    scene = session.scene.with_surface(surface.name, **finished(surface, name))
    edit_paint(session, scene, f"{surface.name}: {name}")


def edit_paint(session: Session, scene: Scene, message: str) -> None:
    """Make a scene with other paints the current scene, and tell the colors that the edit unsets."""
    before = session.scene
    # A message is about the chosen surface already.
    chosen = f"{session.surface_name}: " if message else ""
    messages = [message, *(each.removeprefix(chosen) for each in unset_paints(before, scene))]
    session.edit(scene)
    for old, new in zip(before.surfaces, scene.surfaces, strict=True):
        if old.paint.ramp is None and new.paint.ramp is not None:
            session.blended[old.name] = before.mesh, old.paint
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
