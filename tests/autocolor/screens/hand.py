"""A hand on the joystick unit of a display: it points, presses ENTER, holds TRACK, and counts its steps."""

from __future__ import annotations

import numpy as np

from autocolor import Scene, Studio
from autocolor.screens.viewer import Viewer
from autocolor.widgets.menu import Section, sections_of
from autocolor.widgets.sheet import Sheet
from autocolor.widgets.widget import Widget
from ramtek_emu import Ramtek9300


class Hand:
    """What a user does who has the unit alone. A step is a click or a drag; moving the pointer is none."""

    def __init__(self, viewer: Viewer) -> None:
        assert isinstance(viewer.display, Ramtek9300)
        self.viewer = viewer
        self.display = viewer.display
        self.joystick = viewer.display.joystick
        self.steps = 0
        self.pointer = 0, 0
        viewer.poll()

    @property
    def scene(self) -> Scene:
        """The scene of the session."""
        return self.viewer.studio.scene

    @property
    def message(self) -> str:
        """The last message."""
        return self.viewer.message

    @property
    def hint(self) -> str:
        """The last part of the message line: the message, the typed text, or else the hint."""
        return self.viewer.board.messages[-1].text

    @property
    def labels(self) -> list[str]:
        """The labels of all that can be pointed at, the topmost first."""
        return [each.label for each in self.viewer.board.widgets()]

    def move(self, element: float, line: float) -> None:
        """Move the pointer."""
        self.pointer = round(element), round(line)
        self.joystick.move_to(*self.pointer)
        self.viewer.poll()

    def click(self, element: float, line: float) -> None:
        """Press ENTER at a place."""
        self.move(element, line)
        self.joystick.press_enter()
        self.viewer.poll()
        self.steps += 1

    def grab(self, element: float, line: float) -> None:
        """Begin to hold TRACK at a place."""
        self.move(element, line)
        self.joystick.track = True
        self.viewer.poll()

    def drop(self) -> None:
        """Let go of TRACK."""
        self.joystick.track = False
        self.viewer.poll()
        self.steps += 1
        self.viewer.on_tick()

    def drag(self, *places: tuple[float, float]) -> None:
        """Hold TRACK from the first place, over the others, to the last one."""
        self.grab(*places[0])
        for place in places[1:]:
            self.move(*place)
        self.drop()

    def press(self, *keys: str, repeated: bool = False) -> bool:
        """Press keys, such as `Ctrl+Z` or `Alt+Left`, and return whether the last one does anything."""
        taken = False
        for key in keys:
            *modifiers, name = key.split("+") if len(key) > 1 else [key]
            control, shift, alt = (modifier in modifiers for modifier in ("Ctrl", "Shift", "Alt"))
            typed = name if len(name) == 1 and not control and not alt else ""
            typed = typed.upper() if shift else typed.lower()
            taken = self.viewer.on_key(name.lower(), control, shift, typed, repeated, alt)
        return taken

    def type(self, text: str) -> None:
        """Type a text on the keyboard."""
        for letter in text:
            self.viewer.on_key(letter.lower(), typed=letter)

    def open_menu(self) -> None:
        """Bring the menu by moving the pointer to the right edge."""
        self.move(639, 200)

    def turn_to(self, title: str) -> None:
        """Pick the word of a screen in the strip above the menu; the menu is brought if needed."""
        self.open_menu()
        word = next(screen.word for screen in self.viewer.screens.values() if screen.title == title)
        strip = {each.label: each.area for each in self.viewer.board.layout.strip}
        self.click(strip[word].left + 4, strip[word].top + 8)

    def widget(self, label: str) -> Widget:
        """A widget that can be seen, by its label.

        If needed, its section of the menu is opened, and pages are turned; these are steps, too.
        """
        for _ in range(8):
            for each in self.viewer.board.widgets():
                if each.label == label:
                    return each
            folded = folded_section_of(self.viewer, label)
            if label == "more":
                break
            self.pick(folded or "more")
            # A second click at the same place would fold the section again.
            self.move(self.pointer[0] + 1, self.pointer[1])
        raise AssertionError(f"{label!r} is not among {[each.label for each in self.viewer.board.widgets()]}")

    def choose(self, label: str, name: str) -> None:
        """Choose a name from the list of a row."""
        self.pick(label)
        self.pick(name)

    def pick(self, label: str, share: float = 0.25) -> None:
        """Click a widget at a share of its width."""
        left, top, right, bottom = self.widget(label).area
        self.click(left + share * (right - left), (top + bottom) / 2)

    def pull(self, label: str, start: float, end: float) -> None:
        """Drag along a widget, from one share of its width to another."""
        left, top, right, bottom = self.widget(label).area
        line = (top + bottom) / 2
        self.drag(*((left + share * (right - left), line) for share in (start, (start + end) / 2, end)))

    def middle(self, label: str) -> tuple[int, int]:
        """The middle of a widget."""
        left, top, right, bottom = self.widget(label).area
        return (left + right) // 2, (top + bottom) // 2

    def go_to(self, screen: str) -> None:
        """Turn to a screen at once, without a message."""
        self.viewer.session.turn_to(screen)
        self.viewer.tell("")

    def shows(self, scene: Scene) -> bool:
        """Whether the display has what it has after that scene alone was sent to it, but for the message."""
        message = self.message
        self.viewer.tell("")
        fresh = Ramtek9300()
        Studio(scene, fresh)
        is_shown = has_the_same(self.display, fresh)
        self.viewer.tell(message)
        return is_shown

    def is_drawn_whole(self) -> bool:
        """Whether the display has what the present page alone gives."""
        fresh = Ramtek9300(self.display.configuration)
        Sheet(fresh).show(self.viewer.board.page())
        return has_the_same(self.display, fresh)

    def handle(self, label: str) -> tuple[int, int]:
        """The place of a handle whose label begins so."""
        for each in self.viewer.board.content.handles:
            if each.label.startswith(label):
                return each.element, each.line
        labels = [each.label for each in self.viewer.board.content.handles]
        raise AssertionError(f"{label!r} is not among {labels}")


def has_the_same(one: Ramtek9300, other: Ramtek9300) -> bool:
    """Whether two displays have the same words and the same entries."""
    return np.array_equal(one.words, other.words) and np.array_equal(one.entries, other.entries)


def folded_section_of(viewer: Viewer, label: str) -> str:
    """The label of the folded section of the menu with a row; empty if there is none."""
    board = viewer.board
    folded = [row.label for row in board.layout.rows if isinstance(row, Section) and not row.is_open]
    rows = list(board.content.rows())
    sections = [section for section in sections_of(rows)[1:] if section[0].label in folded]
    return next((s[0].label for s in sections if any(row.label == label for row in s[1:])), "")
