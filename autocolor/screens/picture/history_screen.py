"""The history screen: the steps of the session over the picture; a click on a step goes there.

The list begins with the state that was opened. The present state is marked, and undone steps are dim.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Final

from autocolor.journal.description import describe_look
from autocolor.scene.scene import Scene
from autocolor.screens.cached import Cached
from autocolor.screens.comparing import MOST_DESCRIBED
from autocolor.screens.picture.over_picture import OverPicture
from autocolor.screens.screen import Content, Surroundings
from autocolor.screens.session import HISTORY, Session
from autocolor.screens.steps import go
from autocolor.widgets.items import CHARACTER, LIGHT_GRAY, Area
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN, ROW_LINES, Button, Gap, Pair, Widget

LIST: Final = WORK.inset(8)._replace(right=255)
"""The list, at the left of the picture."""

MOST_ROWS: Final = 26
"""The steps that are shown at once."""

DIGITS: Final = 3
"""Characters of a step's number; longer numbers move their line to the right."""

MOST_LETTERS: Final = (LIST.width - 2 * MARGIN) // CHARACTER - DIGITS - 2

BEGIN: Final = "as the session began"
AGAIN: Final = "opened again"
"""For a step that did not change the look."""


class HistoryScreen(OverPicture):
    """The steps of the session, the newest at the bottom."""

    name = HISTORY
    title = "steps"
    help = "Click a step to go there; several undone steps become a variant by another edit"

    # The list is at the left.
    corners = ((1.0, 0.0), (1.0, 1.0))

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._first: int | None = None
        """The number of the first step that is shown; None to show the present step in the middle."""
        self._texts: Cached[Sequence[tuple[str, str]]] = Cached()

    def enter(self) -> None:
        self._first = None

    def build(self, around: Surroundings) -> Content:
        content = super().build(around)
        return replace(content, rows=self._rows, widgets=self._steps() if around.has_panels else ())

    @property
    def _scenes(self) -> tuple[Scene, ...]:
        """The scenes of the session in order, from the first to the last scene that can be redone."""
        history = self.session.studio.history
        return (*history.to_undo, history.scene, *reversed(history.to_redo))

    def _start(self) -> int:
        """The number of the first step that is shown."""
        present = len(self.session.studio.history.to_undo)
        first = present - MOST_ROWS // 2 if self._first is None else self._first
        return max(0, min(first, len(self._scenes) - MOST_ROWS))

    def _steps(self) -> Sequence[Widget]:
        """The steps that are shown, each a row."""
        start, present = self._start(), len(self.session.studio.history.to_undo)
        scenes = self._scenes[max(0, start - 1) : start + MOST_ROWS]

        def texts() -> Sequence[tuple[str, str]]:
            steps = [
                (describe_look(*pair, MOST_LETTERS) or AGAIN, describe_look(*pair, MOST_DESCRIBED) or AGAIN)
                for pair in pairwise(scenes)
            ]
            return steps if start else [(BEGIN, BEGIN), *steps]

        rows = []
        for place, (line, whole) in enumerate(self._texts.of(texts, *scenes)):
            number, top = start + place, LIST.top + ROW_LINES * place
            what = f"The present state, by step {number}" if number == present else f"Go to step {number}"
            row = StepRow(
                f"{number:{DIGITS}}  {line}",
                f"{what}: {whole}",
                run=partial(self._go, number - present),
                is_chosen=number == present,
                is_undone=number > present,
                scroll=self._scroll,
            )
            rows.append(row.at(Area(LIST.left, top, LIST.right, top + ROW_LINES - 1)))
        return rows

    def _rows(self) -> Sequence[Widget]:
        count = len(self._scenes)
        help = f"Show older steps, or newer steps; there are {count - 1}."
        older, newer = partial(self._scroll, 1), partial(self._scroll, -1)
        pair = Pair("older", help, run=older, other="newer", run_other=newer)
        return [pair, Gap("list gap")] if count > MOST_ROWS else []

    def _scroll(self, pages: float) -> None:
        """Scroll by some pages to older steps; a negative number scrolls to newer steps."""
        self._first = self._start() - round(pages * (MOST_ROWS - 2))
        self._first = self._start()

    def _go(self, steps: int) -> None:
        """Undo or redo some steps at once. The list stays where it is."""
        self._first = self._start()
        if steps:
            go(self.session, steps)


@dataclass(frozen=True)
class StepRow(Button):
    """A step, dim if it is undone."""

    is_undone: bool = False
    scroll: Callable[[float], object] = lambda _: None

    @property
    def ink(self) -> int:
        return LIGHT_GRAY if self.is_undone else super().ink

    def nudge(self, steps: float) -> object:
        return self.scroll(steps / 8)
