"""Pairs: two buttons in one row of a menu."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from autocolor.widgets.colors import NIGHT, SLATE
from autocolor.widgets.items import Item, fitted, text
from autocolor.widgets.widget import MARGIN, TEXT_DOWN, Place, Widget


@dataclass(frozen=True)
class Pair(Widget):
    """Two buttons side by side: the label is that of the left one; steps up and down pick them by keys."""

    run: Callable[[], object] = lambda: None
    other: str = ""
    run_other: Callable[[], object] = lambda: None

    def items(self, lit: bool) -> list[Item]:
        background = SLATE if lit else NIGHT
        middle = self._middle
        most = (middle - self.area.left - MARGIN) // 7
        found = self.row(lit, fitted(self.label, most))
        other = fitted(self.other, most)
        return [*found, text(other, middle, self.area.top + TEXT_DOWN, self.ink, background)]

    @property
    def _middle(self) -> int:
        """Where the right button begins."""
        return self.area.left + MARGIN + (self.area.width - MARGIN) // 2

    def pick(self, place: Place) -> object:
        return self.run_other() if place.element >= self._middle - MARGIN // 2 else self.run()

    def nudge(self, steps: float) -> object:
        return self.run_other() if steps > 0 else self.run()
