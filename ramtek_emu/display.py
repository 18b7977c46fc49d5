"""Ramtek9300: the display, with all its parts connected.

host port -> decoder -> processor -> frame buffer, lookup table, cursors -> scan-out -> field
"""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Colors, Words
from ramtek_emu.checks import checked_number, checked_stream
from ramtek_emu.configuration import GMR_9300, Configuration, checked_configuration
from ramtek_emu.errors import ReplyError
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME, ILLEGAL
from ramtek_emu.memory.cursors import Cursors, Joystick
from ramtek_emu.memory.frame_buffer import FrameBuffer
from ramtek_emu.memory.lookup_table import LookupTable
from ramtek_emu.processor import cursor_executors, drawing_executors, environment_executors, image_executors
from ramtek_emu.processor.processor import Executors, Pauses, Processor, Status
from ramtek_emu.video.beam import Beam
from ramtek_emu.video.scan_out import ScanOut
from ramtek_emu.writing import PNG, check_suffix, write_atomically


class Ramtek9300:
    """A display in this process. It is a host port: a host sends words to it and receives its replies.

    The configuration may be given by name, as in `Ramtek9300("NCAR_9460")`. A display can be copied
    (`copy.deepcopy`) and pickled with its incomplete instruction and unread replies.
    """

    def __init__(self, configuration: Configuration | str = GMR_9300) -> None:
        configuration = checked_configuration(configuration)
        self.configuration = configuration
        self.resets = 0
        """The number of times that RESET was pressed; it never decreases."""
        self.words_received = 0
        """The number of words that hosts sent since power-on; it never decreases."""
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
            self.processor.parameters,
            self.beam,
        )

    def state(self) -> dict[str, dict[str, Any]]:
        """All that the display is, by part and name: numbers, tuples, lists, dictionaries and arrays.

        The words of an incomplete instruction and unread replies belong to a host and are left out. So are
        the counts of words and resets.
        """
        return {name: part.state() for name, part in self._parts().items()}

    def restore(self, state: dict[str, dict[str, Any]]) -> None:
        """Become as a display of the same configuration was; drop pending words and replies."""
        self.decoder.clear()
        for name, part in self._parts().items():
            part.restore(state[name])

    def __reduce__(self) -> tuple[Any, ...]:
        processor = self.processor
        beside = self.resets, self.words_received, self.decoder, processor.replies, processor.foreign
        return type(self), (self.configuration,), (self.state(), beside)

    def __setstate__(self, saved: tuple[Any, ...]) -> None:
        state, beside = saved
        self.restore(state)
        self.resets, self.words_received, self.decoder, replies, foreign = beside
        self.processor.replies, self.processor.foreign = replies, foreign

    def _parts(self) -> dict[str, Any]:
        """The parts that have a state; the beam paints the monitor image, so it comes first."""
        timed: dict[str, Any] = {} if self.beam is None else {"beam": self.beam, "scan_out": self.scan_out}
        return {
            "frame_buffer": self.frame_buffer,
            "lookup_table": self.lookup_table,
            "parameters": self.processor.parameters,
            "processor": self.processor,
            "cursors": self.cursors,
            **timed,
        }

    def send(self, words: Words) -> None:
        """Send 16-bit words; instructions may be cut anywhere. WordsError if they are not 16-bit words."""
        for _ in self.send_stepwise(words):
            pass

    def send_stepwise(self, words: Words) -> Iterator[int]:
        """Send words as `send` does, and pause after each instruction: yields how many words are executed.

        A long instruction is executed in slices of a few milliseconds, with pauses between them. Such a pause
        yields the same number as the pause before the instruction. A reset during it abandons the rest of the
        instruction. With a beam, the instruction takes its time at the end: lines that the beam has passed
        show the state before the instruction, all others the state after it.
        """
        stream = checked_stream(words)
        self.words_received += len(stream)
        return self._take(stream)

    def _take(self, stream: Words) -> Iterator[int]:
        executed = 0
        for instruction in self.decoder.feed(stream):
            # A reset during the pause feeds the decoder, too.
            used = self.decoder.used
            if self.beam is None:
                pauses = execute_in_slices(self.processor, instruction)
            else:
                pauses = self._execute_in_time(instruction, self.beam)
            if pauses is not None:
                resets = self.resets
                for _ in pauses:
                    yield executed
                    if self.resets != resets:
                        break
            executed = used
            yield used

    def _execute_in_time(self, instruction: Instruction, beam: Beam) -> Pauses:
        yield from self.scan_out.follow_beam()
        written = self.frame_buffer.written
        yield from execute_in_slices(self.processor, instruction) or ()
        yield from self.scan_out.follow_beam()
        if instruction.format is ILLEGAL:
            # Assumed: the words of a row are read one by one; so its time does not depend on cuts.
            beam.charge(len(instruction.data), 0, len(instruction.data))
            return
        words = 1 + sum(map(len, instruction.operands.values())) + len(instruction.data)
        beam.charge(words, self.frame_buffer.written - written)

    def reset(self) -> None:
        """Press RESET on the control unit: reset parameters, screen, cursors; drop pending words and replies.

        Hardware: PRG introdoc (the switch), DRIVER.c (the interface's hard reset).
        Assumed: the lookup table and loaded characters stay, as after the instruction RSET.
        """
        self.resets += 1
        self.decoder.clear()
        self.processor.replies.clear()
        for cursor in self.cursors.all:
            cursor.state = 0
        for _ in self._take(np.array([FORMAT_OF_NAME["RSET"].opcode << 8], np.uint16)):
            pass

    def receive(self, count: int) -> Words:
        """The next `count` words of the replies, uint16; ReplyError if fewer are waiting."""
        advice = "send an instruction that reads them first"
        count = checked_number(count, "the words received", 0, self.processor.waiting, advice, ReplyError)
        replies = self.processor.replies
        words = np.frombuffer(bytes(replies[: 2 * count]), np.uint16).copy()
        del replies[: 2 * count]
        return words

    def field(self) -> Colors:
        """The field that the monitor shows, (lines, elements, 3) uint8."""
        return self.scan_out.field()

    @property
    def words(self) -> Words:
        """The words of the frame buffer, (lines, elements) uint16; a read-only view that stays current."""
        return self.frame_buffer.words

    @property
    def entries(self) -> Colors:
        """The entries of the lookup table, (entries, 3) uint8; a read-only copy."""
        return self.lookup_table.entries

    @property
    def status(self) -> Status:
        """The bits of the interface's status register."""
        return self.processor.status

    def save_png(self, path: str | PathLike[str], overwrite: bool = False) -> None:
        """Write the field to a PNG file, whole or not at all.

        Raises OutputError for a name that does not end in .png, and if no file can be created there;
        OutputExistsError if the file exists and `overwrite` is false; WriteError if writing fails.
        """
        check_suffix(path, PNG, "a picture")
        write_atomically(path, self._repr_png_(), overwrite=overwrite)

    def __repr__(self) -> str:
        sizes = self.configuration
        return (
            f"{type(self).__name__}({sizes.name}, {sizes.elements} x {sizes.lines} x {sizes.planes} bits, "
            f"{sizes.entries} entries, {self.words_received} words received)"
        )

    def _repr_png_(self) -> bytes:
        """The field as the bytes of a PNG file, for a notebook."""
        from ramtek_emu.png import png_bytes

        return png_bytes(self.field())


def execute_in_slices(processor: Processor, instruction: Instruction) -> Pauses | None:
    """Set the operands of an instruction and begin it; no instruction raises an error.

    Returns the pauses of a long instruction, None if the instruction is complete.
    """
    format = instruction.format
    if format.is_normal and instruction.operands and not format.requests_operands:
        processor.parameters.take(instruction.operands, instruction.low_byte)
    return EXECUTORS[format.name](processor, instruction)


EXECUTORS: Final[Executors] = (
    image_executors.EXECUTORS
    | drawing_executors.EXECUTORS
    | cursor_executors.EXECUTORS
    | environment_executors.EXECUTORS
)
