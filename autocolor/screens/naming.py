"""Names of lights, cameras and variants: asked for at once, and again by a second click in their list.

The name stands selected in the message line, where Return takes it. Users without a keyboard are not asked.
"""

from __future__ import annotations

from functools import partial

from autocolor.screens.session import Session
from autocolor.widgets.widget import Entry, titled


def name_light(session: Session, name: str, is_new: bool = False) -> None:
    """Ask for a name of a light; with `is_new`, the name belongs to the step that made the light."""
    session.naming = Entry(
        "name of the light", value=name, take=partial(_rename_light, session, name, is_new)
    )


def name_view(session: Session, name: str, is_new: bool = False) -> None:
    """Ask for a name of a camera; with `is_new`, the name belongs to the step that saved the view."""
    session.naming = Entry(
        "name of the camera", value=name, take=partial(_rename_view, session, name, is_new)
    )


def name_variant(session: Session, name: str) -> None:
    """Ask for a name of a variant that was just kept."""
    session.naming = Entry("name of the variant", value=name, take=partial(_rename_variant, session, name))


def _rename_light(session: Session, old: str, same_step: bool, text: str) -> None:
    session.same_step = same_step
    new = text.strip()
    session.edit(session.scene.with_light(old, name=new))
    session.choose_light(new)
    session.tell(titled("light", new))


def _rename_view(session: Session, old: str, same_step: bool, text: str) -> None:
    session.same_step = same_step
    new = text.strip()
    session.edit(session.scene.with_named_view(old, name=new))
    session.tell(titled("camera", new))


def _rename_variant(session: Session, old: str, text: str) -> None:
    kept = session.studio.keep_variant(text.strip())
    session.studio.drop_variant(old)
    session.tell(f"kept as {kept}")
