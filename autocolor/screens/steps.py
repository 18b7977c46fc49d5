"""Going to other states of a session: to its steps, by undo and redo, and to the state to compare with."""

from __future__ import annotations

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


def undo(session: Session) -> None:
    """Undo the last step."""
    go(session, -1)


def redo(session: Session) -> None:
    """Redo the last undone step."""
    go(session, 1)


def go(session: Session, steps: int) -> None:
    """Go some steps forth, or back if the number is negative, and tell what they changed."""
    before, count, studio = session.scene, abs(steps), session.studio
    verb = "undo" if steps < 0 else "redo"
    if not (studio.undo(count) if steps < 0 else studio.redo(count)):
        session.tell(f"nothing to {verb}")
        return
    earlier, later = (session.scene, before) if steps < 0 else (before, session.scene)
    what = describe(earlier, later, MOST_DESCRIBED) or "no change"
    session.tell(f"{f'{count} steps ' if count > 1 else ''}{verb}ne: {what}")
