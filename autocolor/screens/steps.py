"""Going to other states of a session: to its steps, by undo and redo, and to the state to compare with."""

from __future__ import annotations

from collections.abc import Callable

from autocolor.journal.description import describe
from autocolor.screens.comparing import MOST_DESCRIBED, NOW
from autocolor.screens.session import PICTURE, SPLIT, Session


def compare(session: Session) -> None:
    """Show the state to compare with, over the picture, until the present one is edited."""
    if not session.comparing.is_on:
        session.tell(f"shown: {session.comparing.begin()}; {session.comparing.difference}")


def end_comparing(session: Session) -> None:
    """Show the present state again."""
    if session.comparing.end():
        session.tell(f"shown: {NOW}")


def switch_comparing(session: Session) -> None:
    """Show the state to compare with, or the present one again."""
    (end_comparing if session.comparing.is_on else compare)(session)


def switch_split(session: Session) -> None:
    """Show both states, left and right of a line, or the picture again."""
    session.turn_to(PICTURE if session.screen == SPLIT else SPLIT)


def undo(session: Session, steps: int = 1) -> None:
    """Undo the last step, or some steps at once."""
    go(session, session.studio.undo, "undo", steps)


def redo(session: Session, steps: int = 1) -> None:
    """Redo the last undone step, or some steps at once."""
    go(session, session.studio.redo, "redo", steps)


def go(session: Session, run: Callable[[int], bool], verb: str, steps: int) -> None:
    """Go some steps back or forth, and tell what they changed."""
    before = session.scene
    if not run(steps):
        session.tell(f"nothing to {verb}")
        return
    earlier, later = (session.scene, before) if verb == "undo" else (before, session.scene)
    count = f"{steps} steps " if steps > 1 else ""
    session.tell(f"{count}{verb}ne: {describe(earlier, later, MOST_DESCRIBED) or 'no change'}")
