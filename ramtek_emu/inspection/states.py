"""States: displays after some of the instructions of a stream, in little memory.

A state is `Ramtek9300.state()`, pickled. Its arrays are cut into blocks. If a block equals the block of the
previous state, both states share the block. Other blocks are deflated.
"""

from __future__ import annotations

import pickle
import zlib
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from ramtek_emu.arrays import Bytes
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
    touched: Bytes | None = field(default=None, repr=False)
    """The words written since the state before, as `np.packbits(dots, axis=1)`; None if not known."""

    def restore(self, display: Ramtek9300) -> None:
        """Bring a display to this state."""
        buffers = [b"".join(map(zlib.decompress, blocks)) for blocks in self.arrays]
        display.restore(pickle.loads(self.data, buffers=buffers))

    def may_touch(self, window: Window) -> bool:
        """Whether a word of a window within the memory may have been written since the state before."""
        if self.touched is None:
            return True
        part = self.touched[window.top : window.bottom + 1, window.left // 8 : window.right // 8 + 1]
        first = window.left % 8
        return bool(np.unpackbits(part, axis=1)[:, first : first + window.width].any())


class Packer:
    """Packs displays that follow each other."""

    def __init__(self) -> None:
        self._last: list[tuple[bytes, tuple[bytes, ...]]] = []
        """The arrays of the last state, whole and as deflated blocks."""

    def pack(self, display: Ramtek9300, number: int, touched: Bytes | None = None) -> State:
        """The state of a display between two instructions."""
        buffers: list[pickle.PickleBuffer] = []
        data = pickle.dumps(display.state(), protocol=5, buffer_callback=buffers.append)
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
        return State(number, data, tuple(packed), touched)


def size_of(states: list[State]) -> int:
    """The bytes of states; shared blocks count once."""
    blocks = {id(block): len(block) for state in states for array in state.arrays for block in array}
    beside = (len(state.data) + (0 if state.touched is None else state.touched.nbytes) for state in states)
    return sum(blocks.values()) + sum(beside)


def thinned(states: list[State]) -> list[State]:
    """Every second state from the first on, and the last."""
    first, *rest = states
    joined = []
    for one, other in zip(rest[::2], rest[1::2], strict=False):
        if one.touched is None or other.touched is None:
            joined.append(replace(other, touched=None))
        else:
            joined.append(replace(other, touched=one.touched | other.touched))
    return [first, *joined, *rest[2 * len(joined) :]]
