"""States: displays packed into little memory; consecutive states share equal blocks.

A state is a pickled display. Its arrays are cut into blocks. A block that equals the block of the state
before is the same object, and the others are deflated.
"""

from __future__ import annotations

import pickle
import zlib
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots, Words
from ramtek_emu.display import Ramtek9300

BLOCK: Final = 1 << 14
"""The bytes of a block: about a line in forty of a picture."""
LEVEL: Final = 1
"""The level of deflation; level 6 takes twice the time for a tenth fewer bytes."""


@dataclass(frozen=True, slots=True)
class State:
    """A display after a number of instructions."""

    number: int
    data: bytes
    """The pickled display without its arrays."""
    arrays: tuple[tuple[bytes, ...], ...] = field(repr=False)
    """The blocks of the arrays, deflated."""
    reply: Words | None
    """The reply of the last instruction; None if it is not known."""
    touched: bytes | None = None
    """The words written since the state before, a bit each; None if they are not known."""

    def display(self) -> Ramtek9300:
        """A new display in this state.

        The words of an incomplete instruction, and replies that wait, belong to a host and are left out.
        """
        buffers = [bytearray().join(map(zlib.decompress, blocks)) for blocks in self.arrays]
        display: Ramtek9300 = pickle.loads(self.data, buffers=buffers)
        display.decoder.clear()
        display.processor.clear_replies()
        return display


class Packer:
    """Packs displays that follow each other."""

    def __init__(self) -> None:
        self._last: list[tuple[bytes, tuple[bytes, ...]]] = []
        """The arrays of the last state, whole and as deflated blocks."""

    def pack(
        self, display: Ramtek9300, number: int, reply: Words | None, touched: bytes | None = None
    ) -> State:
        """The state of a display between two instructions."""
        buffers: list[pickle.PickleBuffer] = []
        data = pickle.dumps(display, protocol=5, buffer_callback=buffers.append)
        arrays = [buffer.raw().tobytes() for buffer in buffers]
        packed = []
        for position, array in enumerate(arrays):
            last, blocks = self._last[position] if position < len(self._last) else (b"", ())
            if array != last:
                blocks = tuple(
                    blocks[index]
                    if last[first : first + BLOCK] == array[first : first + BLOCK]
                    else zlib.compress(array[first : first + BLOCK], LEVEL)
                    for index, first in enumerate(range(0, len(array), BLOCK))
                )
            packed.append(blocks)
        self._last = list(zip(arrays, packed, strict=True))
        return State(number, data, tuple(packed), reply, touched)


def size_of(states: list[State]) -> int:
    """The bytes of states; shared blocks count once."""
    blocks = {id(block): len(block) for state in states for array in state.arrays for block in array}
    own = sum(len(state.data) + len(state.touched or b"") for state in states)
    return own + sum(blocks.values()) + sum(state.reply.nbytes for state in states if state.reply is not None)


def thinned(states: list[State]) -> list[State]:
    """Every second state from the first on, and the last."""
    fewer, dropped = [states[0]], None
    for index, state in enumerate(states[1:], 1):
        if index % 2 and index < len(states) - 1:
            dropped = state
        else:
            fewer.append(state if dropped is None else replace(state, touched=_joined(dropped, state)))
            dropped = None
    return fewer


def _joined(first: State, second: State) -> bytes | None:
    """What was touched before either of two states; None if it is not known."""
    if first.touched is None or second.touched is None:
        return None
    bits = [np.frombuffer(each, np.uint8) for each in (first.touched, second.touched)]
    return (bits[0] | bits[1]).tobytes()


def packed_dots(dots: Dots) -> bytes:
    """Dots as bits. Measured: deflating them would take as long as all else when states are dropped."""
    return np.packbits(dots).tobytes()


def unpacked_dots(packed: bytes, shape: tuple[int, int]) -> Dots:
    """The (lines, elements) dots of `packed_dots`."""
    bits = np.frombuffer(packed, np.uint8)
    return np.unpackbits(bits, count=shape[0] * shape[1]).view(np.bool_).reshape(shape)
