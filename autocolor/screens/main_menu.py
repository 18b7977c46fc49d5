"""The parts of every menu beside the rows of its screen: the strip above it, and its last rows."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from autocolor.screens.screen import Screen
from autocolor.screens.session import BLENDING, HISTORY, MIXING, PICTURE, Session
from autocolor.screens.steps import redo, switch_comparing, switch_split, undo
from autocolor.widgets.menu import STRIP
from autocolor.widgets.widget import Button, Cell, Gap, Pair, PanelButton, Widget


def strip_of(session: Session, screens: Iterable[Screen]) -> list[Widget]:
    """The words that lead to the screens, side by side above the menu; the present screen is chosen."""
    named = [each for each in screens if each.word]
    # Light blending is a place of color mixing.
    shown = MIXING if session.screen == BLENDING else session.screen
    width = STRIP.width // len(named)
    return [
        PanelButton(
            each.word,
            f"{each.title}, Ctrl+{(number + 1) % 10}: {each.help}",
            within="strip",
            area=STRIP._replace(left=width * number, right=width * (number + 1) - 1),
            run=partial(session.turn_to, each.name),
            is_chosen=each.name == shown,
        )
        for number, each in enumerate(named)
    ]


def last_rows(session: Session, screen: Screen) -> list[Widget]:
    """The rows at the end of every page of every menu: undo, and over the picture comparing."""
    history = session.studio.history
    can_undo, can_redo = bool(history.to_undo), bool(history.to_redo)
    can_go = can_undo or can_redo
    row = Pair(
        " ",
        "Undo the last step, or redo it; between, the list of all steps.",
        "" if can_go else "there is no step to undo",
        buttons=(
            Cell("undo", partial(undo, session), can_undo),
            Cell(
                "steps", partial(session.turn_to, PICTURE if session.screen == HISTORY else HISTORY), can_go
            ),
            Cell("redo", partial(redo, session), can_redo),
        ),
    )
    return [Gap("undo gap"), row, *([compare_row(session)] if screen.shows_picture else [])]


def compare_row(session: Session) -> Widget:
    """The row that shows the state to compare with, and the present one again, or both side by side."""
    other = session.comparing.other
    if other is None:
        return Button("compare", why_not="there is no step to undo")
    return Pair(
        "compare",
        f"Show {other.name}, and the present state again; or both, left and right of a line.",
        run=partial(switch_comparing, session),
        other="split",
        run_other=partial(switch_split, session),
        is_chosen=session.comparing.is_on,
    )
