"""The state of the menus: whether the menu was asked for, its page, its open row, and its folded sections."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from autocolor.screens.layout import opens
from autocolor.widgets.menu import (
    MENU,
    NameList,
    Section,
    folded,
    lines_of,
    list_of,
    page_of_menu,
    sections_of,
)
from autocolor.widgets.widget import Choice, Widget


class MenuState:
    """What the user did to the menus. `take` is called with a choice and the name picked from its list."""

    def __init__(self, take: Callable[[Choice, str], object]) -> None:
        self.is_pinned = False
        """Whether the menu was asked for; else it goes when the pointer leaves it."""
        self.is_open = False
        """Whether the pointer brought the menu."""
        self.has_focus = False
        """Whether keys go to the menu."""
        self.opened = ""
        """The key of the row whose wide bar or list is open."""
        self._take = take
        self._page = 0
        self._list_page: int | None = None
        """The page of the list; None for the page of the present name."""
        self._folds: dict[str, dict[str, bool]] = {}
        """By screen, whether sections of its menu are to be open or folded, the last used at the end."""
        self._shown: Sequence[Widget] = ()
        """The rows of all pages of the present menu, without the rows of its folded sections."""

    def stamp(self, screen: str) -> object:
        """A value that changes whenever the rows of a screen's menu or their list may."""
        return self._page, self.opened, self._list_page, tuple(self._folds.get(screen, {}).items())

    def rows(self, screen: str, rows: Sequence[Widget], last: Sequence[Widget]) -> list[Widget]:
        """The rows of this page of a screen's menu, laid out; each page ends with the `last` rows."""
        folds = self._folds.get(screen, {})
        self._shown = folded(rows, folds, partial(self.fold, screen), MENU.height - lines_of(last))
        if folds:
            # A section that was folded to make room stays folded.
            self._note_sections(folds)
        return page_of_menu(self._shown, last, self._page, partial(setattr, self, "_page"))

    def _note_sections(self, folds: dict[str, bool]) -> None:
        folds.update({row.label: row.is_open for row in self._shown if isinstance(row, Section)})

    def fold(self, screen: str, section: str, is_open: bool) -> None:
        """Open or fold a section of this menu, and note that it was used last; the others stay."""
        folds = self._folds.setdefault(screen, {})
        self._note_sections(folds)
        folds.pop(section, None)
        folds[section] = is_open

    def use(self, screen: str, widget: Widget) -> None:
        """Note that the section of a widget was used last, so that the section stays open if it grows."""
        for section, *rows in sections_of(self._shown)[1:]:
            if any(row.key == widget.key for row in rows):
                self.fold(screen, section.label, True)
                return

    def open_or_close(self, row: Widget) -> None:
        """Open the wide bar or the list of a row, or close it."""
        self.opened = "" if self.opened == row.key else row.key
        self._list_page = None

    def opened_of(self, rows: Sequence[Widget]) -> tuple[Widget | None, NameList | None]:
        """The row whose wide bar or list is open, and its list."""
        row = (
            next((row for row in rows if row.key == self.opened and opens(row)), None)
            if self.opened
            else None
        )
        if not isinstance(row, Choice):
            return row, None
        turn = partial(setattr, self, "_list_page")
        return row, list_of(row, self._list_page, partial(self._take, row), turn)

    def close(self) -> None:
        """Take the menu away where it comes on demand."""
        self.is_pinned = self.is_open = self.has_focus = False

    def begin(self) -> None:
        """Show the first page of another screen's menu, with nothing open."""
        self.opened, self._page, self._shown = "", 0, ()
        self.close()
