"""The tutorial: a panel over every screen that gives the next task, and sees when the task is done.

It knows no screen: it compares scenes to see the user's edits. The panel can be moved out of the way, folded,
skipped task by task, and ended; the joystick unit alone can do all of this.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from autocolor.journal.history import History, Saved
from autocolor.scene.lights import Flap, Light
from autocolor.scene.scene import Scene
from autocolor.screens.session import Session
from autocolor.widgets.items import GREEN, WHITE, YELLOW, Area
from autocolor.widgets.menu import WIDE_BAR, WORK
from autocolor.widgets.widget import Panel, PanelButton, Widget

# The lessons. A function compares two scenes to see whether the task was done: by a screen, a bar, a key,
# or in the picture itself.


class Work(NamedTuple):
    """The scene at one moment, and what was saved last."""

    scene: Scene
    saved: Saved


class Lesson(NamedTuple):
    """A task: its name, two lines of instructions, and a function that sees whether it was done."""

    name: str
    text: str
    is_done: Callable[[Work, Work], bool]


def work_of(history: History) -> Work:
    """The work of a history now."""
    return Work(history.scene, history.saved)


def edited(table: str, values_of: Callable[[Any], Sequence[object]]) -> Callable[[Work, Work], bool]:
    """A function that sees whether a row of a table has another value; None is no value."""

    def is_edited(before: Work, now: Work) -> bool:
        old_rows = {row.name: row for row in vars(before.scene)[table]}
        return any(
            value is not None and value != old
            for row in vars(now.scene)[table]
            if row.name in old_rows
            for old, value in zip(values_of(old_rows[row.name]), values_of(row), strict=True)
        )

    return is_edited


def cutting_flaps(light: Light) -> list[Flap | None]:
    """The flaps along x, y and z, each None if it does not cut off light anywhere."""
    flaps = (light.flaps.x, light.flaps.y, light.flaps.z)
    endless = (-math.inf, math.inf)
    return [flap if flap and flap.on and (flap.minimum, flap.maximum) != endless else None for flap in flaps]


def is_saved(before: Work, now: Work) -> bool:
    """Whether the scene was saved. An opened scene has no saved files."""
    return now.saved is not before.saved and bool(now.saved.files)


LESSONS: Final = (
    Lesson(
        "move a light",
        "The right edge brings the menu: pick views above it. Drag a light in\n"
        "one of the views. Or pick it, and then its new place in that view.",
        edited("lights", lambda light: [light.position]),
    ),
    Lesson(
        "flaps",
        "Keep a light from a part of the car: in the menu of views or lights,\n"
        "add one of the flaps x, y and z, and set where it ends.",
        edited("lights", cutting_flaps),
    ),
    Lesson(
        "a cone",
        "Make a spotlight: in the same menu, switch on the cone angle. Drag\n"
        "along its bar until the rim of the light is where you want it.",
        edited("lights", lambda light: [light.cone_angle]),
    ),
    Lesson(
        "mix a color",
        "Paint the car: pick picture at the top, pick the body, then colors at\n"
        "the top. Drag the bars, or pick one of the paints in the menu.",
        edited("surfaces", lambda row: [row.paint.object_color, row.paint.light_color, row.paint.ramp]),
    ),
    Lesson(
        "blend",
        "In the menu of colors, pick light blending. Drag the handle of the\n"
        "bar: above it, the body takes the color of the light.",
        edited("surfaces", lambda row: [row.paint.blend]),
    ),
    Lesson(
        "save",
        "Pick file at the top, and save there: the message line tells you the\n"
        "names of the files that hold the scene and the picture.",
        is_saved,
    ),
)
"""The tasks, in the order of the paper: lights, flaps and cones, colors."""

END: Final = (
    "That was all. Views, reflectance, mapping, variants and undo are in\n"
    "the menus, too. Your work stays: pick end, and go on with it."
)

HEAD_LINES: Final = 16
"""The height of the panel when it is folded."""

LINES: Final = 40

BUTTON: Final = 48
"""Elements of a button in the panel's first line."""


class Tutorial:
    """The lessons of a session, with a panel that shows them until the tutorial has ended."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._number = 0
        self._is_done = False
        """Whether the lesson before was done, and not skipped."""
        self._before = work_of(session.studio.history)
        self._is_low = True
        self._is_folded = False
        self.has_ended = False
        """Whether the panel was taken away."""

    @property
    def lesson(self) -> Lesson | None:
        """The lesson to do; None after the last lesson."""
        return LESSONS[self._number] if self._number < len(LESSONS) else None

    def _go_on(self, is_done: bool) -> None:
        self._number, self._is_done, self._is_folded = self._number + 1, is_done, False
        self._before = work_of(self._session.studio.history)

    def widgets(self) -> Sequence[Widget]:
        """The panel, the topmost widget first; the next lesson if this one has been done."""
        if self.has_ended:
            return ()
        now = work_of(self._session.studio.history)
        if self.lesson is not None and self.lesson.is_done(self._before, now):
            self._go_on(True)
        height = HEAD_LINES if self._is_folded else LINES
        top = WIDE_BAR.top - height if self._is_low else WORK.top
        area = Area(WORK.left, top, WORK.right, top + height - 1)
        title, text = "end of the tutorial", END
        if self.lesson is not None:
            title, text = f"{self._number + 1} of {len(LESSONS)}: {self.lesson.name}", self.lesson.text
        head = (f"well done!  {title}", GREEN) if self._is_done else (title, YELLOW)
        lines = [head, *((line, WHITE) for line in text.splitlines())]
        buttons = [
            ("end", "End the tutorial; your work stays.", partial(setattr, self, "has_ended", True)),
            (
                "up" if self._is_low else "down",
                "Move the panel out of the way.",
                partial(setattr, self, "_is_low", not self._is_low),
            ),
            # At the left, so that the other buttons stay in their places when it goes.
            ("skip", "Go on without doing this.", partial(self._go_on, False)),
        ]
        panel: list[Widget] = []
        for number, (label, help, run) in enumerate(buttons if self.lesson else buttons[:2], start=1):
            left = area.right - number * BUTTON
            place = Area(left, area.top + 1, left + BUTTON - 1, area.top + HEAD_LINES - 2)
            panel.append(PanelButton(label, help, area=place, run=run, within="tutorial"))
        return [
            *panel,
            Panel(
                "tutorial",
                "Fold the panel, or show it whole.",
                area=area,
                lines=lines[:1] if self._is_folded else lines,
                run=partial(setattr, self, "_is_folded", not self._is_folded),
            ),
        ]
