"""The main menu: the rows that every menu has beside those of its screen."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial

from autocolor.screens.screen import Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.widgets.colors import GRAY, NIGHT, SLATE, WHITE
from autocolor.widgets.items import CHARACTER, Item, filled, text
from autocolor.widgets.menu import MOST_LINES, laid_out, lines_of, pages_of
from autocolor.widgets.widget import MARGIN, TEXT_DOWN, Button, Gap, Heading, Place, Steps, Widget


@dataclass(frozen=True)
class UndoRow(Steps):
    """Undo at the left and redo at the right, each dim where there is no step for it.

    It takes picks alone, since each is a step of its own.
    """

    signs: tuple[str, str] = ("undo", "redo")
    can_undo: bool = True
    can_redo: bool = True

    def items(self, lit: bool) -> list[Item]:
        left, top, right, _ = self.area
        background = SLATE if lit else NIGHT
        undo, redo = self.signs
        end = right + 1 - MARGIN - CHARACTER * len(redo)
        return [
            filled(self.area, background),
            text(undo, left + MARGIN, top + TEXT_DOWN, WHITE if self.can_undo else GRAY, background),
            text(redo, end, top + TEXT_DOWN, WHITE if self.can_redo else GRAY, background),
        ]

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return None


def rows_of_menu(session: Session, screen: Screen, screens: Iterable[Screen]) -> list[Widget]:
    """The rows of the menu of a screen: on the picture the ways to the others, on the others the way back."""
    if screen.name == PICTURE:
        ways: list[Widget] = [
            Button(each.title, each.help, run=partial(session.turn_to, each.name))
            for each in screens
            if each.is_in_menu and each is not screen
        ]
        return [Heading("AUTOCOLOR"), *ways, Gap("ways"), *screen.rows()]
    back = Button("< picture", "Back to the picture.", run=partial(session.turn_to, PICTURE))
    return [Heading(screen.title.upper()), back, Gap("ways"), *screen.rows()]


def last_rows(session: Session, screen: Screen) -> list[Widget]:
    """The rows at the end of every page of every menu: undo, and over the picture comparing."""
    history = session.studio.history
    can_undo, can_redo = bool(history.to_undo), bool(history.to_redo)
    undo = UndoRow(
        " ",
        "Undo the last step, or redo it.",
        "" if can_undo or can_redo else "there is no step to undo",
        step=lambda amount: session.undo() if amount < 0 else session.redo(),
        can_undo=can_undo,
        can_redo=can_redo,
    )
    return [Gap("undo gap"), undo, *([compare_row(session)] if screen.shows_picture else [])]


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


def page_of_menu(
    rows: Sequence[Widget], last: Sequence[Widget], number: int, turn: Callable[[int], object]
) -> list[Widget]:
    """The rows of a page of the menu, counted from 0, laid out; the last page if there are not so many.

    Each page ends with the `last` rows. If there are several, the row before them calls `turn` with the
    number of the next one.
    """
    pages = pages_of(rows, MOST_LINES - sum(map(lines_of, last)))
    number = min(number, len(pages) - 1)
    if len(pages) == 1:
        return laid_out([*pages[0], *last])
    more = Button(
        "more",
        "The other rows of this menu.",
        run=partial(turn, (number + 1) % len(pages)),
        value=f"{number + 1} of {len(pages)}",
    )
    return laid_out([*pages[number], more, *last])
