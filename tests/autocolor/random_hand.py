"""A hand that does on every screen whatever comes to it, the same for the same seed."""

from __future__ import annotations

import random

from autocolor.screens.keys import BINDINGS, Chord
from autocolor.screens.viewer import SCREENS, Viewer
from autocolor.widgets.widget import Gap
from ramtek_emu import Ramtek9300

MENU_KEYS = ("tab", "up", "down", "left", "right", "return", "space", "escape", "backspace", "home", "end")
TEXTS = ("0.5", "-3", "1e3", "nan", "#b01020", "red", "a name", "../x", "0", "12345678901234567890" * 4)

EDGES = (0, 503, 504, 636, 639), (0, 240, 463, 464, 479)


class RandomHand:
    """Moves, clicks and drags by the unit of a display, mostly where something can be pointed at."""

    def __init__(self, viewer: Viewer, display: Ramtek9300, seed: int) -> None:
        self.viewer = viewer
        self.joystick = display.joystick
        self._random = random.Random(seed)
        viewer.poll()

    def do(self) -> None:
        """Do something."""
        viewer, chance = self.viewer, self._random.random()
        # Whoever wants to leave stays.
        viewer.session.leaves = False
        if chance < 0.05:
            viewer.session.turn_to(self._random.choice(SCREENS).name)
            viewer.tell("")
        elif chance < 0.3:
            self._move()
        elif chance < 0.7:
            self._move()
            self._press_enter()
        else:
            self._drag()
        viewer.on_tick()

    def let_go(self) -> None:
        """Drag no longer, and hold nothing."""
        self._track(False)
        self.viewer.board.release()
        self.viewer.on_tick()

    def _drag(self) -> None:
        self._move()
        self._track(True)
        for _ in range(self._random.randint(0, 4)):
            self._move()
            if self._random.random() < 0.1:
                self._press_enter()
        self._track(False)

    def _move(self) -> None:
        element, line = self._place()
        self.joystick.move_to(max(0, element), max(0, line))
        self.viewer.poll()

    def _press_enter(self) -> None:
        self.joystick.press_enter()
        self.viewer.poll()

    def _track(self, is_on: bool) -> None:
        self.joystick.track = is_on
        self.viewer.poll()

    def _place(self) -> tuple[int, int]:
        """A place on a widget, near a handle, at an edge, or anywhere."""
        chance, board = self._random.random(), self.viewer.board
        widgets = [each for each in board.widgets() if not isinstance(each, Gap)]
        handles = board.content.handles
        if chance < 0.6 and widgets:
            area = self._random.choice(widgets).area
            return self._between(area.left, area.right), self._between(area.top, area.bottom)
        if chance < 0.75 and handles:
            handle = self._random.choice(handles)
            return handle.element + self._between(-3, 3), handle.line + self._between(-3, 3)
        if chance < 0.8:
            elements, lines = EDGES
            return self._random.choice(elements), self._random.choice(lines)
        return self._between(0, 700), self._between(0, 500)

    def _between(self, low: int, high: int) -> int:
        return self._random.randint(low, max(low, high))


class RandomHandWithKeys(RandomHand):
    """A hand that also presses the keys of all bindings and of the menu, and types."""

    def do(self) -> None:
        if self._random.random() < 0.7:
            super().do()
            return
        viewer, chance = self.viewer, self._random.random()
        viewer.session.leaves = False
        if chance < 0.6:
            binding = self._random.choice(BINDINGS)
            self._press(self._random.choice(binding.chords), releases=self._random.random() < 0.9)
        elif chance < 0.85:
            self._press(Chord(self._random.choice(MENU_KEYS)))
        else:
            for letter in self._random.choice(TEXTS):
                viewer.on_key(letter, typed=letter)
            viewer.on_key(self._random.choice(("return", "escape", "tab")))
        viewer.on_tick()

    def _press(self, chord: Chord, releases: bool = True) -> None:
        typed = chord.name if chord.is_sign or (len(chord.name) == 1 and not chord.control) else ""
        for repeated in (False, True)[: self._random.randint(1, 2)]:
            self.viewer.on_key(chord.name, chord.control, chord.shift, typed, repeated, chord.alt)
        if releases:
            self.viewer.on_release(chord.name)
