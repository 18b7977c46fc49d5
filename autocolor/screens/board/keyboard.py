"""The keyboard: a key goes to the text that is typed, the menu, the screen, or what it is bound to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from autocolor.screens.bindings import BINDINGS, Actions
from autocolor.screens.board.board import Board
from autocolor.screens.input.keys import bound_to


class Do(Protocol):
    """Does what a key asks for; False if that does nothing."""

    def __call__(
        self, source: object, run: Callable[[], object], continues: bool = False, moving: bool = False
    ) -> bool: ...


class Keyboard:
    """The keys of a board; those that are bound do what `actions` do."""

    def __init__(self, board: Board, actions: Actions, do: Do) -> None:
        self._board = board
        self._actions = actions
        self._do = do

    def press(self, name: str, control: bool, shift: bool, typed: str, repeated: bool) -> bool:
        """Do what a key asks for; returns False if it does nothing here."""
        if not control and self._typed(name, typed, repeated):
            return True
        chosen = bound_to(BINDINGS, name, control, shift, typed)
        if chosen is None:
            return False
        binding, number = chosen
        if repeated and not (binding.held or binding.repeats):
            # A switch would flip for as long as its key is down.
            return True
        continues = repeated and binding.held
        return self._do(chosen, lambda: binding.run(self._actions, number), continues, binding.held)

    def release(self, name: str) -> bool:
        """Do what letting go of a key asks for; returns False if that is nothing."""
        released = [
            each.release
            for each in BINDINGS
            if each.release is not None and any(chord.name == name for chord in each.chords)
        ]
        for release in released:
            release(self._actions)
        return bool(released)

    def _typed(self, name: str, typed: str, repeated: bool) -> bool:
        """Let the text that is being typed, the menu or the screen take a key."""
        board, source = self._board, ("key", name)
        if board.typing.is_on:
            return self._do(None, lambda: board.typing.key(name, typed))
        return self._do(source, lambda: board.key(name, typed), repeated, repeated) or self._do(
            source, lambda: board.screen.key(name, typed), repeated, repeated
        )
