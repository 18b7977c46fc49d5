"""A hand on the joystick unit of a display: it points, presses ENTER, holds TRACK, and counts its steps."""

from __future__ import annotations

from autocolor.screens.board import rows_of_menu
from autocolor.screens.viewer import Viewer
from autocolor.widgets.menu import Section, sections_of
from autocolor.widgets.widget import Widget
from ramtek_emu import Ramtek9300


class Hand:
    """What a user does who has the unit alone. A step is a click or a drag; moving the pointer is none."""

    def __init__(self, viewer: Viewer) -> None:
        assert isinstance(viewer.display, Ramtek9300)
        self.viewer = viewer
        self.joystick = viewer.display.joystick
        self.steps = 0
        viewer.poll()

    def move(self, element: float, line: float) -> None:
        """Move the pointer."""
        self.joystick.move_to(round(element), round(line))
        self.viewer.poll()

    def click(self, element: float, line: float) -> None:
        """Press ENTER at a place."""
        self.move(element, line)
        self.joystick.press_enter()
        self.viewer.poll()
        self.steps += 1

    def drag(self, *places: tuple[float, float]) -> None:
        """Hold TRACK from the first place, over the others, to the last one."""
        self.move(*places[0])
        self.joystick.track = True
        self.viewer.poll()
        for place in places[1:]:
            self.move(*place)
        self.joystick.track = False
        self.viewer.poll()
        self.steps += 1
        self.viewer.on_tick()

    def open_menu(self) -> None:
        """Bring the menu by moving the pointer to the right edge."""
        self.move(639, 200)

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

    def handle(self, label: str) -> tuple[int, int]:
        """The place of a handle whose label begins so."""
        for each in self.viewer.board.screen.handles():
            if each.label.startswith(label):
                return each.element, each.line
        labels = [each.label for each in self.viewer.board.screen.handles()]
        raise AssertionError(f"{label!r} is not among {labels}")


def folded_section_of(viewer: Viewer, label: str) -> str:
    """The label of the folded section of the menu with a row; empty if there is none."""
    board = viewer.board
    folded = [row.label for row in board.layout.rows if isinstance(row, Section) and not row.is_open]
    rows = rows_of_menu(viewer.session, board.screen, viewer.screens.values())
    sections = [section for section in sections_of(rows)[1:] if section[0].label in folded]
    return next((s[0].label for s in sections if any(row.label == label for row in s[1:])), "")
