"""The tutorial: a panel over every screen that gives the next task, and sees when the task is done.

It knows no screen: it compares scenes to see the user's edits. The panel can be moved out of the way, folded,
skipped task by task, and ended; the joystick unit alone can do all of this.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from autocolor.journal.history import History, Saved
from autocolor.scene.lights import Flap, Light
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface
from autocolor.screens.session import Session
from autocolor.widgets.items import (
    GREEN,
    NIGHT,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    filled,
    outline,
    text,
)
from autocolor.widgets.menu import WIDE_BAR, WORK
from autocolor.widgets.widget import MARGIN, PanelButton, Place, Widget

# The lessons. A function compares two scenes to see whether the task was done: by a screen, a bar, a key,
# or in the picture itself.


class Work(NamedTuple):
    """The scene at one moment, and what was saved last."""

    scene: Scene
    saved: Saved


class Lesson(NamedTuple):
    """A task: its name, two lines of instructions, and a function that sees whether it was done."""

    name: str
    lines: tuple[str, str]
    is_done: Callable[[Work, Work], bool]


def work_of(history: History) -> Work:
    """The work of a history now."""
    return Work(history.scene, history.saved)


def _moved(before: Work, now: Work) -> bool:
    return any(old.position != light.position for old, light in lights_of_both(before, now))


def _cut_off(before: Work, now: Work) -> bool:
    return any(
        flap is not None and flap != old_flap and _cuts(flap)
        for old, light in lights_of_both(before, now)
        for old_flap, flap in zip(_flaps(old), _flaps(light), strict=True)
    )


def _narrowed(before: Work, now: Work) -> bool:
    return any(
        light.cone_angle is not None and light.cone_angle != old.cone_angle
        for old, light in lights_of_both(before, now)
    )


def _mixed(before: Work, now: Work) -> bool:
    return any(
        (old.paint.object_color, old.paint.light_color, old.paint.ramp)
        != (surface.paint.object_color, surface.paint.light_color, surface.paint.ramp)
        for old, surface in surfaces_of_both(before, now)
    )


def _blended(before: Work, now: Work) -> bool:
    return any(old.paint.blend != surface.paint.blend for old, surface in surfaces_of_both(before, now))


def _saved(before: Work, now: Work) -> bool:
    # An opened scene was not saved yet: it has no saved files.
    return now.saved is not before.saved and bool(now.saved.files)


def _flaps(light: Light) -> tuple[Flap | None, Flap | None, Flap | None]:
    return light.flaps.x, light.flaps.y, light.flaps.z


def _cuts(flap: Flap) -> bool:
    """Whether a flap cuts off light anywhere."""
    return flap.on and (flap.minimum > -math.inf or flap.maximum < math.inf)


def lights_of_both(before: Work, now: Work) -> list[tuple[Light, Light]]:
    """The lights that both scenes have, by name."""
    old = {light.name: light for light in before.scene.lights}
    return [(old[light.name], light) for light in now.scene.lights if light.name in old]


def surfaces_of_both(before: Work, now: Work) -> list[tuple[Surface, Surface]]:
    """The surfaces that both scenes have, by name."""
    old = {surface.name: surface for surface in before.scene.surfaces}
    return [(old[surface.name], surface) for surface in now.scene.surfaces if surface.name in old]


LESSONS: Final = (
    Lesson(
        "move a light",
        (
            "The right edge brings the menu: pick views above it. Pick a light in",
            "one of the views, then its new place in the same view; or drag it.",
        ),
        _moved,
    ),
    Lesson(
        "flaps",
        (
            "Keep a light from a part of the car: in this menu, or that of lights,",
            "switch on one of the flaps x, y and z, and set where it ends.",
        ),
        _cut_off,
    ),
    Lesson(
        "a cone",
        (
            "Make a spotlight: in the same menu, switch on the cone angle. Drag",
            "along its bar until the rim of the light is where you want it.",
        ),
        _narrowed,
    ),
    Lesson(
        "mix a color",
        (
            "Paint the car: pick picture at the top, pick the body, then colors at",
            "the top. Drag the bars, or pick one of the paints in the menu.",
        ),
        _mixed,
    ),
    Lesson(
        "blend",
        (
            "Pick < picture, then light blending, and drag the handle of the bar:",
            "above it, the color of the body goes over into that of the light.",
        ),
        _blended,
    ),
    Lesson(
        "save",
        (
            "Pick file at the top, and save there: the message line tells you the",
            "names of the files that hold the scene and the picture.",
        ),
        _saved,
    ),
)
"""The tasks, in the order of the paper: lights, flaps and cones, colors."""


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
    """The lessons of a session, with a panel that shows them until the tutorial has ended."""

    def __init__(self, session: Session, lessons: Sequence[Lesson] = LESSONS) -> None:
        self._session = session
        self._lessons = lessons
        self._number = 0
        self._is_done = False
        """Whether the lesson before was done, and not skipped."""
        self._before = self._seen = work_of(session.studio.history)
        self._is_low = True
        self._is_folded = False
        self.has_ended = False
        """Whether the panel was taken away."""

    @property
    def lesson(self) -> Lesson | None:
        """The lesson to do; None after the last lesson."""
        return self._lessons[self._number] if self._number < len(self._lessons) else None

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
        self.has_ended = True

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
        if self.has_ended:
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
        panel: list[Widget] = []
        right = area.right - 1
        for label, help, run in buttons:
            place = Area(right - BUTTON + 1, area.top + 1, right, area.top + HEAD_LINES - 2)
            panel.append(PanelButton(label, help, area=place, run=run, within="tutorial"))
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
        return [*panel, task]

    @property
    def _head(self) -> str:
        done = "well done!  " if self._is_done else ""
        if self.lesson is None:
            return f"{done}end of the tutorial"
        return f"{done}{self._number + 1} of {len(self._lessons)}: {self.lesson.name}"


@dataclass(frozen=True)
class Task(Widget):
    """A task: a headline, and lines below it unless it is folded. A pick calls `run`."""

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
