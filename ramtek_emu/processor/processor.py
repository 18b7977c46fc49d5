"""Processor: owns the parameters, the status and the replies, and has the methods that executors share.

Each instruction has a row in the instruction table and an executor: a function of the processor and the
instruction, which raises no error. A new instruction is a row of the instruction table, a function in the
module of executors for its subject, and a row of the table at the foot of that module. An executor that may
take more than about 20 ms returns its pauses.

What is modeled: the parameters, the addressing modes, image modes, replies in order, the illegal-instruction
bit. What is **not**: logical functions other than replacement; they replace (Assumed: FUNC; no source
explains its codes); write-enable offsets, which can be set and read back but have no effect (Assumed: WOF;
its only client, NCAR, sends the corner of the window along with coordinates that include it already).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from enum import IntFlag
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Numbers, Words
from ramtek_emu.configuration import Configuration
from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.instruction_set.table import Flags
from ramtek_emu.memory.character_rom import initial_loaded_characters
from ramtek_emu.memory.cursors import Cursors
from ramtek_emu.memory.frame_buffer import FrameBuffer
from ramtek_emu.memory.lookup_table import LookupTable
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.video.beam import Beam

MOST_WAITING: Final = 1 << 22
"""The largest number of words of replies that wait for the host.

Assumed: if the host does not read, further replies are dropped; hardware would stop the host.
"""


class Status(IntFlag):
    """Bits of the interface's status register (Hardware: PRG, DRIVER.c, gpst)."""

    CURSOR = 0o000001
    ILLEGAL = 0o000002
    READY = 0o000100


class Processor:
    """The instruction processor, between the decoder and the memories."""

    def __init__(
        self,
        configuration: Configuration,
        frame_buffer: FrameBuffer,
        lookup_table: LookupTable,
        cursors: Cursors,
        beam: Beam | None,
    ) -> None:
        self.configuration = configuration
        self.frame_buffer = frame_buffer
        self.lookup_table = lookup_table
        self.cursors = cursors
        self.beam = beam
        self.parameters = Parameters.at_reset(configuration)
        """The current parameters; always the same object."""
        self.saved: list[Parameters] = []
        """The parameters that PUSHE saved, the newest last."""
        self.loaded_characters = initial_loaded_characters()
        """The dots of the loaded characters, (256, 12, 8)."""
        self.illegal_words = 0
        """The number of illegal words that were skipped; it never decreases."""
        self.foreign: str | None = None
        """What the host sent first that this 9300 lacks and the 9460 has, such as "FILL"; None if nothing."""
        self.unimplemented = 0
        """The number of instructions without effect, known by name only; it never decreases."""
        self.is_illegal = False
        """Whether the status has an illegal instruction."""
        self.replies = bytearray()
        """The bytes of the replies that the host has not read."""

    def state(self) -> dict[str, Any]:
        """All but the current parameters and the replies."""
        return {
            "saved": [parameters.state() for parameters in self.saved],
            "loaded_characters": self.loaded_characters.copy(),
            "illegal": self.is_illegal,
            "illegal_words": self.illegal_words,
            "without_effect": self.unimplemented,
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Set the values of a state, and drop the replies."""
        self.saved[:] = [Parameters(**values) for values in state["saved"]]
        self.loaded_characters[...] = state["loaded_characters"]
        self.is_illegal = state["illegal"]
        self.illegal_words, self.unimplemented = state["illegal_words"], state["without_effect"]
        self.replies.clear()

    @property
    def status(self) -> Status:
        """The bits of the interface's status register."""
        status = Status.READY
        if self.is_illegal:
            status |= Status.ILLEGAL
        return status | Status.CURSOR if self.cursors.enter_is_pressed else status

    def clear_status(self) -> None:
        """Clear the request bits of the status register."""
        self.is_illegal = self.cursors.enter_is_pressed = False

    @property
    def waiting(self) -> int:
        """The number of words that the host can receive."""
        return len(self.replies) // 2

    def points(self, instruction: Instruction, columns: int = 2) -> Numbers:
        """The data as (n, columns) signed numbers; an incomplete row at the end is dropped."""
        size = 2 * columns
        words = instruction.data[: (instruction.length or 0) // size * columns]
        return words.view(np.int16).reshape(-1, columns).astype(np.int64)

    def placed(self, points: Numbers, flags: int) -> Numbers:
        """The (n, 2) points in absolute coordinates, by the addressing mode in the flags.

        Assumed: with relative addressing a point is counted from the previous point, and the first point from
        the operating point. Coordinates are registers of 16 bits.
        """
        if flags & Flags.ADDRESSING == Flags.RELATIVE:
            points = np.cumsum(points, axis=0) + self.parameters.start
        elif flags & Flags.ADDRESSING:
            points = points + self.parameters.base(flags)
        else:
            return points
        wrapped: Numbers = (points + 0x8000) % 0x10000 - 0x8000
        return wrapped

    def reply(self, words: Words) -> None:
        """Store words until the host receives them."""
        self.replies += words[: MOST_WAITING - self.waiting].astype(np.uint16).tobytes()

    def colors(self, instruction: Instruction) -> tuple[int, int]:
        """The foreground and the background word, exchanged if the swap flag is set."""
        pair = self.parameters.foreground, self.parameters.background
        return (pair[1], pair[0]) if instruction.low_byte & Flags.SWAP else pair


Pauses = Iterator[None]
"""The pauses of a long instruction: each step of the iterator draws a slice, and the last step ends it.

Between two steps anything may be read, and the display may be reset; then the iterator is dropped.
"""
Executors = dict[str, Callable[[Processor, Instruction], Pauses | None]]
"""Executors by the name of the instruction. An executor returns None if it has executed everything."""
