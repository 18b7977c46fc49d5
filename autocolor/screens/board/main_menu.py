"""The main menu: the rows that every menu has beside those of its screen."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial

from autocolor.screens.screen import Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.widgets.menu import laid_out, pages_of
from autocolor.widgets.widget import Button, Gap, Heading, Place, Steps, Widget


class UndoRow(Steps):
    """Undo and redo: picks alone, since each is a step of its own."""

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return None


def rows_of_menu(session: Session, screen: Screen, screens: Iterable[Screen]) -> list[Widget]:
    """All rows of the menu of a screen: on the picture the ways to the others, on the others the way back."""
    undo = UndoRow(
        " ",
        "Undo the last step, or redo it.",
        step=lambda amount: session.undo() if amount < 0 else session.redo(),
        signs=("undo", "redo"),
    )
    last: list[Widget] = [undo, *([compare_row(session)] if screen.shows_picture else [])]
    if screen.name == PICTURE:
        ways: list[Widget] = [
            Button(each.title, each.help, run=partial(session.turn_to, each.name))
            for each in screens
            if each.is_in_menu and each is not screen
        ]
        return [Heading("AUTOCOLOR"), *ways, Gap("ways"), *screen.rows(), Gap("undo gap"), *last]
    back = Button("< picture", "Back to the picture.", run=partial(session.turn_to, PICTURE))
    return [Heading(screen.title.upper()), back, Gap("ways"), *screen.rows(), Gap("undo gap"), *last]


def compare_row(session: Session) -> Widget:
    """The row that shows the state to compare with, and the present one again."""
    other = session.comparing.other
    if other is None:
        return Button("compare", why_not="there is no step to undo")
    return Button(
        "compare",
        f"Show {other.name} in place of the present one, and back.",
        run=session.switch_comparing,
        is_chosen=session.comparing.is_on,
    )


def page_of_menu(rows: Sequence[Widget], number: int, turn: Callable[[int], object]) -> list[Widget]:
    """The rows of a page of the menu, counted from 0, laid out; the last page if there are not so many.

    If there are several, the last row calls `turn` with the number of the next one.
    """
    pages = pages_of(rows)
    number = min(number, len(pages) - 1)
    if len(pages) == 1:
        return laid_out(pages[0])
    more = Button(
        "more",
        "The other rows of this menu.",
        run=partial(turn, (number + 1) % len(pages)),
        value=f"{number + 1} of {len(pages)}",
    )
    return laid_out([*pages[number], more])
