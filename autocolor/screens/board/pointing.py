"""Pointing: the gestures of the mouse and of the joystick unit, each drag one step to undo."""

from __future__ import annotations

from typing import Final

from autocolor.screens.board.board import Board
from autocolor.screens.board.keyboard import Do
from autocolor.screens.input.gestures import Gesture

WHEEL: Final = "wheel"
"""What makes edits by the wheel, which has steps but no beginning and no end."""


class Pointing:
    """The gestures on a board."""

    def __init__(self, board: Board, do: Do) -> None:
        self._board = board
        self._do = do
        self._drags = 0

    @property
    def source(self) -> tuple[str, int]:
        """What makes the edits of the last drag or pick."""
        return "drag", self._drags

    def take(self, gesture: Gesture) -> None:
        """Do what a gesture asks for."""
        board, kind = self._board, gesture.kind
        if kind in ("hover", "drop"):
            board.take(gesture)
        elif kind == "wheel":
            # On each widget it makes a step of its own.
            board.point_at(gesture)
            self._do((WHEEL, board.lit), lambda: board.take(gesture), True, True)
        elif kind == "drag":
            self._do(self.source, lambda: board.take(gesture), True, True)
        elif not (kind == "pick" and board.is_dragging) and self._has_taken_text():
            # ENTER during a drag does nothing, or it would end the step.
            self._drags += 1
            self._do(self.source, lambda: board.take(gesture))

    def _has_taken_text(self) -> bool:
        """Take the text that is being typed, if any; False if it is refused, and stays to be mended."""
        if self._board.typing.is_on:
            self._do(None, self._board.typing.take)
        return not self._board.typing.is_on
