"""States: displays after some of the instructions of a stream, in little memory.

A state is `Ramtek9300.state()`, pickled. Its arrays are cut into blocks, which are deflated. If a block
equals one of the previous state, both states share the deflated block.
"""

from __future__ import annotations

import pickle
import zlib
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Final

import numpy as np

from ramtek_emu.arrays import Bytes, Dots
from ramtek_emu.display import Ramtek9300
from ramtek_emu.memory.scan_orders import Window

BLOCK: Final = 1 << 14
"""The bytes of a block: about a line in forty of a picture."""
LEVEL: Final = 1
"""The level of deflation; level 6 takes twice the time for a tenth fewer bytes."""


@dataclass(frozen=True, slots=True)
class State:
    """A display after a number of instructions."""

    number: int
    data: bytes
    """The pickled state without its arrays."""
    arrays: tuple[tuple[bytes, ...], ...] = field(repr=False)
    """The blocks of the arrays, deflated."""
    touched: Bytes = field(repr=False)
    """The words that may have been written since the state before, as `np.packbits(dots, axis=1)`."""

    def restore(self, display: Ramtek9300) -> None:
        """Bring a display to this state."""
        buffers = [b"".join(map(zlib.decompress, blocks)) for blocks in self.arrays]
        display.restore(pickle.loads(self.data, buffers=buffers))

    def may_touch(self, window: Window) -> bool:
        """Whether a word of a window within the memory may have been written since the state before."""
        part = self.touched[window.top : window.bottom + 1, window.left // 8 : window.right // 8 + 1]
        first = window.left % 8
        return bool(np.unpackbits(part, axis=1)[:, first : first + window.width].any())


class Packer:
    """Packs displays that follow each other."""

    def __init__(self) -> None:
        self._deflated: dict[bytes, bytes] = {}
        """The deflated blocks of the last state, by the blocks."""

    def pack(self, display: Ramtek9300, number: int, touched: Dots) -> State:
        """The state of a display between two instructions; it may have written the (lines, elements) dots."""
        buffers: list[pickle.PickleBuffer] = []
        data = pickle.dumps(display.state(), protocol=5, buffer_callback=buffers.append)
        raw = [buffer.raw() for buffer in buffers]
        arrays = [[bytes(array[at : at + BLOCK]) for at in range(0, len(array), BLOCK)] for array in raw]
        last, self._deflated = self._deflated, {}
        for block in chain.from_iterable(arrays):
            if block not in self._deflated:
                self._deflated[block] = last.get(block) or zlib.compress(block, LEVEL)
        packed = (tuple(map(self._deflated.__getitem__, blocks)) for blocks in arrays)
        return State(number, data, tuple(packed), np.packbits(touched, axis=1))


def size_of(states: list[State]) -> int:
    """The bytes of states; shared blocks count once."""
    blocks = {id(block): len(block) for state in states for array in state.arrays for block in array}
    return sum(blocks.values()) + sum(len(state.data) + state.touched.nbytes for state in states)


def thinned(states: list[State]) -> list[State]:
    """Every second state from the first on, and the last."""
    first, *rest = states
    pairs = zip(rest[::2], rest[1::2], strict=False)
    joined = [replace(other, touched=one.touched | other.touched) for one, other in pairs]
    return [first, *joined, *rest[2 * len(joined) :]]
