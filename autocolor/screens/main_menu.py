"""The parts of every menu beside the rows of its screen: the strip above it, and its last rows."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Final

from autocolor.screens.screen import Screen
from autocolor.screens.session import HISTORY, PICTURE, Session
from autocolor.screens.steps import redo, switch_comparing, switch_split, undo
from autocolor.widgets.items import CHARACTER, GRAY, NIGHT, SLATE, WHITE, Item, filled, text
from autocolor.widgets.menu import STRIP
from autocolor.widgets.widget import MARGIN, TEXT_DOWN, Button, Gap, Pair, PanelButton, Place, Steps, Widget

STEPS: Final = "steps"
"""The word between undo and redo that leads to the list of steps."""


@dataclass(frozen=True)
class UndoRow(Steps):
    """Undo at the left, redo at the right, the list of steps between; a word is dim while it does nothing.

    It takes picks alone, and no drags: every pick is a step.
    """

    signs: tuple[str, str] = ("undo", "redo")
    can_undo: bool = True
    can_redo: bool = True
    show_history: Callable[[], object] = lambda: None

    def items(self, lit: bool) -> list[Item]:
        background = SLATE if lit else NIGHT
        can = self.can_undo, self.can_undo or self.can_redo, self.can_redo
        words = zip((self.signs[0], STEPS, self.signs[1]), self._places, can, strict=True)
        top = self.area.top + TEXT_DOWN
        texts = [text(word, left, top, WHITE if is_on else GRAY, background) for word, left, is_on in words]
        return [filled(self.area, background), *texts]

    @property
    def _places(self) -> tuple[int, int, int]:
        """Where the three words begin."""
        left, _, right, _ = self.area
        end = right + 1 - MARGIN - CHARACTER * len(self.signs[1])
        start = left + MARGIN
        return start, (start + CHARACTER * len(self.signs[0]) + end - CHARACTER * len(STEPS)) // 2, end

    def pick(self, place: Place) -> object:
        _, middle, end = self._places
        if middle <= place.element < end:
            return self.show_history()
        return super().pick(place)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return None


def strip_of(session: Session, screens: Iterable[Screen]) -> list[Widget]:
    """The words that lead to the screens, side by side above the menu; the present screen is chosen."""
    named = [each for each in screens if each.word]
    width = STRIP.width // len(named)
    return [
        PanelButton(
            each.word,
            f"{each.title}, Ctrl+{(number + 1) % 10}: {each.help}",
            within="strip",
            area=STRIP._replace(left=width * number, right=width * (number + 1) - 1),
            run=partial(session.turn_to, each.name),
            is_chosen=each.name == session.screen,
        )
        for number, each in enumerate(named)
    ]


def last_rows(session: Session, screen: Screen) -> list[Widget]:
    """The rows at the end of every page of every menu: undo, and over the picture comparing."""
    history = session.studio.history
    can_undo, can_redo = bool(history.to_undo), bool(history.to_redo)
    row = UndoRow(
        " ",
        "Undo the last step, or redo it; between, the list of all steps.",
        "" if can_undo or can_redo else "there is no step to undo",
        step=lambda amount: undo(session) if amount < 0 else redo(session),
        can_undo=can_undo,
        can_redo=can_redo,
        show_history=partial(session.turn_to, PICTURE if session.screen == HISTORY else HISTORY),
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
