"""The joystick unit and the RESET switch without a window: lines of text from a person or a script.

    cursor X Y      move the cursors that the joystick drives to this element and line
    by X Y          move them by X elements and Y lines
    enter           press ENTER
    track on        set the TRACK switch (or: track off)
    reset           press RESET on the control unit

A line may have several actions, which are done in order: `cursor 100 200 enter`. Empty lines, and comments
after a #, are ignored. A line with anything else does nothing, and an error message answers it.
"""

from __future__ import annotations

import os
import queue
import re
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Final

from ramtek_emu.errors import MissingInputError, reason_of
from ramtek_emu.memory.cursors import Joystick

MOST_BYTES: Final = 1 << 12
"""Limit: the most bytes of a line. The rest of a longer line is another line."""
MOST_LINES: Final = 64
"""Limit: the most lines that wait; while they do, no more are read."""
TWO_NUMBERS: Final = re.compile(r"[+-]?[0-9]{1,6} [+-]?[0-9]{1,6}")

Action = Callable[[], object]


def actions(line: str, joystick: Joystick, reset: Action) -> list[Action]:
    """The actions of a line, in order; ValueError with a sentence if the line has anything else."""
    words = line.partition("#")[0].split()
    asked: list[Action] = []
    while words:
        match words:
            case ["enter", *rest]:
                asked.append(joystick.press_enter)
            case ["reset", *rest]:
                asked.append(reset)
            case ["track", "on" | "off" as switch, *rest]:
                asked.append(partial(setattr, joystick, "track", switch == "on"))
            case ["cursor" | "by" as kind, x, y, *rest] if TWO_NUMBERS.fullmatch(f"{x} {y}"):
                move = joystick.move_to if kind == "cursor" else joystick.move_by
                asked.append(partial(move, int(x), int(y)))
            case _:
                raise ValueError(
                    "a joystick line must hold cursor X Y, by X Y, enter, track on, track off or reset, "
                    f"not {line[:60]!r}; write it so"
                )
        words = rest
    return asked


class JoystickLines:
    """Lines from a file, a FIFO or stdin. A thread reads them; `obey` acts on them when called."""

    def __init__(self, path: str, answer: Callable[[str], object]) -> None:
        """Begin to read; `answer` gets a sentence for a bad line. MissingInputError if there is no file."""
        self._answer = answer
        self._lines: queue.Queue[str] = queue.Queue(MOST_LINES)
        self._number = 0
        threading.Thread(target=self._read, args=(opened(path),), daemon=True).start()

    def obey(self, joystick: Joystick, reset: Action) -> None:
        """Do the actions of the waiting lines."""
        for _ in range(self._lines.qsize()):
            self._number += 1
            try:
                for action in actions(self._lines.get(), joystick, reset):
                    action()
            except ValueError as refusal:
                self._answer(f"joystick, line {self._number}: {refusal}")

    def _read(self, number: int) -> None:
        with suppress(OSError), open(number, "rb") as file:
            while line := file.readline(MOST_BYTES):
                self._lines.put(line.decode("utf-8", "replace").rstrip("\n"))


def opened(path: str) -> int:
    """The descriptor of the opened file, stdin for `-`; MissingInputError if it cannot be opened."""
    try:
        if path == "-" and sys.stdin is not None:
            return os.dup(sys.stdin.fileno())
        # A FIFO that is opened for writing, too, does not end when its last writer leaves.
        return os.open(path, os.O_RDWR)
    except (OSError, ValueError) as cause:
        raise MissingInputError(
            f"a joystick's lines must come from a file or a FIFO that can be read and written, not {path!r} "
            f"({reason_of(cause)}); make a FIFO with mkfifo, or give - for stdin"
        ) from None
