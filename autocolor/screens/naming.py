"""Names of lights, cameras and variants: asked for at once, and again by a second click in their list.

The name stands selected in the message line, where Return takes it. Users without a keyboard are not asked.
"""

from __future__ import annotations

from collections.abc import Callable

from autocolor.screens.session import Session
from autocolor.widgets.widget import Entry, titled


def ask_name(
    session: Session, noun: str, name: str, rename: Callable[[str], object], is_new: bool = False
) -> None:
    """Ask for a name; `rename` takes it. With `is_new`, it belongs to the step that made the named thing."""

    def take(text: str) -> None:
        session.same_step = is_new
        rename(text.strip())
        session.tell(titled(noun, text.strip()))

    session.naming = Entry(f"name of the {noun}", value=name, take=take)


def name_view(session: Session, name: str, is_new: bool = False) -> None:
    """Ask for a name of a camera; with `is_new`, the name belongs to the step that saved the view."""

    def rename(new: str) -> None:
        session.edit(session.scene.with_named_view(name, name=new))

    ask_name(session, "camera", name, rename, is_new)
