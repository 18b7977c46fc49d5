"""Ramtek9300: the display, its boxes wired together.

host port -> decoder -> processor -> frame buffer, lookup table, cursors -> scan-out -> field
"""

from __future__ import annotations

from os import PathLike

import numpy as np

from ramtek_emu.arrays import Colors, Words
from ramtek_emu.checks import checked_stream
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME
from ramtek_emu.memory.cursors import Cursors, Joystick
from ramtek_emu.memory.frame_buffer import FrameBuffer
from ramtek_emu.memory.lookup_table import LookupTable
from ramtek_emu.processor.executors import EXECUTORS as EXECUTORS
from ramtek_emu.processor.processor import Processor, Status
from ramtek_emu.video.beam import Beam
from ramtek_emu.video.scan_out import ScanOut


class Ramtek9300:
    """A display in this process; itself the host port that a host sends to."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self.configuration = configuration
        self.frame_buffer = FrameBuffer(configuration)
        self.lookup_table = LookupTable(configuration)
        self.cursors = Cursors(configuration.cursors)
        lines, elements = configuration.shown_lines, configuration.shown_elements
        self.joystick = Joystick(self.cursors, elements, lines)
        self.beam = None if configuration.timing is None else Beam(configuration.timing, lines)
        self.processor = Processor(
            configuration, self.frame_buffer, self.lookup_table, self.cursors, self.beam
        )
        self.decoder = Decoder(configuration)
        self.scan_out = ScanOut(
            configuration,
            self.frame_buffer,
            self.lookup_table,
            self.cursors,
            lambda: self.processor.parameters,
            self.beam,
        )

    def send(self, words: Words) -> None:
        """Send 16-bit words as a host does, cut anywhere; WordsError when they are no words at all."""
        stream = checked_stream(words)
        if self.beam is None:
            for instruction in self.decoder.feed(stream, in_rows=True):
                self.processor.execute(instruction)
        else:
            for instruction in self.decoder.feed(stream):
                self._execute_in_time(instruction, self.beam)

    def _execute_in_time(self, instruction: Instruction, beam: Beam) -> None:
        # What the beam has passed keeps the look of before; what it has not will have that of after.
        self.scan_out.follow_beam()
        written = self.frame_buffer.written
        self.processor.execute(instruction)
        self.scan_out.follow_beam()
        words = 1 + sum(map(len, instruction.operands.values())) + len(instruction.data)
        beam.charge(words, self.frame_buffer.written - written)

    def reset(self) -> None:
        """Press RESET on the control unit: parameters, screen, cursors, and what a host left unfinished.

        Hardware: PRG introdoc (the switch), DRIVER.c (the interface's hard reset).
        Assumed: the lookup table and loaded characters stay, as after the instruction RSET.
        """
        self.decoder.clear()
        self.processor.clear_replies()
        self.cursors.hide()
        self.send(np.array([FORMAT_OF_NAME["RSET"].opcode << 8], np.uint16))

    def receive(self, count: int) -> Words:
        """The next `count` words that a reading instruction left, uint16; ReplyError when there are fewer."""
        return self.processor.take_reply(count)

    def field(self) -> Colors:
        """What the monitor shows, (lines, elements, 3) uint8."""
        return self.scan_out.field()

    @property
    def words(self) -> Words:
        """The words, (lines, elements) uint16, read-only; always the present ones."""
        return self.frame_buffer.words

    @property
    def entries(self) -> Colors:
        """The entries of the lookup table, (1024, 3) uint8, read-only; a copy of this moment."""
        return self.lookup_table.entries

    @property
    def status(self) -> Status:
        """The bits of the interface's status register."""
        return self.processor.status

    def save_png(self, path: str | PathLike[str], overwrite: bool = True) -> None:
        """Write the field to a PNG file, wholly or not at all; OutputExistsError or WriteError if not."""
        from ramtek_emu.png import save_png

        save_png(self.field(), path, overwrite)

    def _repr_png_(self) -> bytes:
        """The field for a notebook."""
        from ramtek_emu.png import png_bytes

        return png_bytes(self.field())
