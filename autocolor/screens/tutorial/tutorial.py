"""The tutorial: a panel over every screen that says what to do next, and sees when it is done.

It knows no screen: what a person did is seen in the scene. The panel can be moved out of the way, folded,
skipped step by step, and ended; all by the joystick unit alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from autocolor.screens.session import Session
from autocolor.screens.tutorial.lessons import LESSONS, Lesson, work_of
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GREEN, NIGHT, SLATE, WHITE, YELLOW
from autocolor.widgets.items import CHARACTER, Item, filled, outline, text
from autocolor.widgets.menu import WIDE_BAR, WORK
from autocolor.widgets.widget import MARGIN, Button, Place, Widget

HEAD_LINES: Final = 16
"""The height of the panel when it is folded."""

LINES: Final = 40
LINE_STEP: Final = 12

BUTTON: Final = 48
"""Elements of a button in the panel's first line."""

END: Final = (
    "That was all. Views, reflectance, mapping, variants and undo are in",
    "the menus, too. What you made stays: pick end, and go on with it.",
)


class Tutorial:
    """The lessons of a session. `widgets` are those of its panel; none when it was ended."""

    def __init__(self, session: Session, lessons: Sequence[Lesson] = LESSONS) -> None:
        self._session = session
        self._lessons = lessons
        self._number = 0
        self._is_done = False
        """Whether the lesson before was done, and not skipped."""
        self._before = self._seen = work_of(session.studio.history)
        self._is_low = True
        self._is_folded = False
        self._has_ended = False

    @property
    def lesson(self) -> Lesson | None:
        """The lesson that is to be done; None after the last."""
        return self._lessons[self._number] if self._number < len(self._lessons) else None

    @property
    def has_ended(self) -> bool:
        """Whether the panel was taken away."""
        return self._has_ended

    def look(self) -> None:
        """Go on to the next lesson if this one has been done."""
        now = work_of(self._session.studio.history)
        if now == self._seen or self.lesson is None:
            return
        self._seen = now
        if self.lesson.is_done(self._before, now):
            self._go_on(True)

    def _go_on(self, is_done: bool) -> None:
        self._number, self._is_done, self._is_folded = self._number + 1, is_done, False
        self._before = self._seen = work_of(self._session.studio.history)

    def _skip(self) -> None:
        if self.lesson is not None:
            self._go_on(False)

    def _end(self) -> None:
        self._has_ended = True

    def _move(self) -> None:
        self._is_low = not self._is_low

    def _fold(self) -> None:
        self._is_folded = not self._is_folded

    @property
    def _area(self) -> Area:
        height = HEAD_LINES if self._is_folded else LINES
        top = WIDE_BAR.top - height if self._is_low else WORK.top
        return Area(WORK.left, top, WORK.right, top + height - 1)

    def widgets(self) -> Sequence[Widget]:
        """The panel, the topmost widget first."""
        if self._has_ended:
            return ()
        self.look()
        buttons = [
            ("skip", "Go on without doing this.", self._skip),
            ("end", "End the tutorial; what was made stays.", self._end),
            ("down" if not self._is_low else "up", "Move the panel out of the way.", self._move),
        ]
        if self.lesson is None:
            del buttons[0]
        area = self._area
        found: list[Widget] = []
        right = area.right - 1
        for label, told, run in buttons:
            place = Area(right - BUTTON + 1, area.top + 1, right, area.top + HEAD_LINES - 2)
            found.append(PanelButton(label, told, area=place, run=run))
            right -= BUTTON
        task = Task(
            "tutorial",
            "Fold the panel, or show it whole.",
            area=area,
            head=self._head,
            lines=() if self._is_folded else (END if self.lesson is None else self.lesson.lines),
            is_done=self._is_done,
            run=self._fold,
        )
        return [*found, task]

    @property
    def _head(self) -> str:
        done = "well done!  " if self._is_done else ""
        if self.lesson is None:
            return f"{done}end of the tutorial"
        return f"{done}{self._number + 1} of {len(self._lessons)}: {self.lesson.name}"


@dataclass(frozen=True)
class PanelButton(Button):
    """A button in the first line of the panel; its key differs from that of a row of the menu."""

    @property
    def key(self) -> str:
        return f"tutorial {self.label}"

    def items(self, lit: bool) -> list[Item]:
        left = self.area.left + (self.area.width - CHARACTER * len(self.label)) // 2
        ground = SLATE if lit else NIGHT
        return [
            filled(self.area, ground),
            text(self.label, left, self.area.top + 3, WHITE, ground),
        ]


@dataclass(frozen=True)
class Task(Widget):
    """What is to be done: a headline, and the lines below it unless it is folded; a pick runs `run`."""

    head: str = ""
    lines: Sequence[str] = ()
    is_done: bool = False
    run: Callable[[], object] = lambda: None

    def items(self, lit: bool) -> list[Item]:
        left, top = self.area.left + MARGIN, self.area.top + 4
        return [
            filled(self.area, NIGHT),
            outline(self.area, SLATE),
            text(self.head, left, top, GREEN if self.is_done else YELLOW),
            *(
                text(line, left, top + LINE_STEP * number, WHITE)
                for number, line in enumerate(self.lines, start=1)
            ),
        ]

    def pick(self, place: Place) -> object:
        return self.run()
