"""Names of lights, cameras and variants: asked for at once, and again by a second click in their list.

The name stands selected in the message line, where Return takes it. Users without a keyboard are not asked.
"""

from __future__ import annotations

from collections.abc import Callable

from autocolor.screens.session import Session
from autocolor.widgets.widget import Entry, titled


def name_light(session: Session, name: str, is_new: bool = False) -> None:
    """Ask for a name of a light; with `is_new`, the name belongs to the step that made the light."""

    def rename(new: str) -> None:
        session.edit(session.scene.with_light(name, name=new))
        session.choose_light(new)

    _ask(session, "light", name, rename, is_new)


def name_view(session: Session, name: str, is_new: bool = False) -> None:
    """Ask for a name of a camera; with `is_new`, the name belongs to the step that saved the view."""

    def rename(new: str) -> None:
        session.edit(session.scene.with_named_view(name, name=new))

    _ask(session, "camera", name, rename, is_new)


def name_variant(session: Session, name: str, choose: Callable[[str], object]) -> None:
    """Ask for a name of a variant, and choose the variant by it."""

    def rename(new: str) -> None:
        if new != name:
            session.studio.rename_variant(name, new)
        choose(new)

    _ask(session, "variant", name, rename)


def _ask(
    session: Session, noun: str, name: str, rename: Callable[[str], object], same_step: bool = False
) -> None:
    def take(text: str) -> None:
        session.same_step = same_step
        rename(text.strip())
        session.tell(titled(noun, text.strip()))

    session.naming = Entry(f"name of the {noun}", value=name, take=take)
