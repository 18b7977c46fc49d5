"""Processor: executes instructions; owns the sticky parameters, the status and what is to be read back.

Each instruction is a row of the table and one function here.

What is modelled: the parameters, the addressing modes, image modes, replies in order, the illegal-instruction
bit. What is **not**: logical functions other than replacement; they replace (Assumed: FUNC, whose codes no
source explains).
"""

from collections import deque
from collections.abc import Callable
from enum import IntFlag

import numpy as np
from numpy.typing import NDArray

from . import drawing
from .character_rom import characters
from .configuration import Configuration
from .errors import ReplyError
from .frame_buffer import FrameBuffer
from .instruction import NO_WORDS, Instruction
from .instruction_set import Flags
from .lookup_table import LookupTable
from .parameters import Parameters
from .scan_orders import Point

Words = NDArray[np.uint16]
MOST_WAITING = 1 << 22
"""Words of replies that wait for the host at most.

Assumed: what a host never reads is dropped, newest first; hardware would stop the host.
"""


class Status(IntFlag):
    """Bits of the interface's status register (Hardware: PRG, DRIVER.c, gpst)."""

    CURSOR = 0o000001
    ILLEGAL = 0o000002
    READY = 0o000100


class Processor:
    """The instruction processor between the decoder and the memories."""

    def __init__(
        self, configuration: Configuration, frame_buffer: FrameBuffer, lookup_table: LookupTable
    ) -> None:
        self.configuration = configuration
        self.frame_buffer = frame_buffer
        self.lookup_table = lookup_table
        self.parameters = Parameters.at_reset(configuration)
        self.characters = characters()
        self.status = Status.READY
        self.illegal_words = 0
        """Words skipped because no instruction begins with them; it only grows."""
        self._replies: deque[Words] = deque()
        self._waiting = 0

    @property
    def waiting(self) -> int:
        """Words that the host may receive."""
        return self._waiting

    def execute(self, instruction: Instruction) -> None:
        """Take an instruction's operands, then do it; nothing that a host sends raises."""
        if instruction.form.is_normal:
            self.parameters.take(instruction.operands, instruction.low_byte)
        EXECUTORS[instruction.form.name](self, instruction)

    def reply(self, words: Words) -> None:
        """Hold words for the host."""
        words = words[: MOST_WAITING - self._waiting]
        if len(words):
            self._replies.append(words)
            self._waiting += len(words)

    def take_reply(self, count: int) -> Words:
        """The next `count` words for the host; ReplyError when there are fewer."""
        if not 0 <= count <= self._waiting:
            raise ReplyError(
                f"the words received must be 0 to {self._waiting}, which wait, not {count}; "
                "send an instruction that reads them first"
            )
        taken = []
        left = count
        while left:
            words = self._replies.popleft()
            if len(words) > left:
                self._replies.appendleft(words[left:])
                words = words[:left]
            taken.append(words)
            left -= len(words)
        self._waiting -= count
        return np.concatenate(taken) if taken else NO_WORDS

    def colors(self, instruction: Instruction) -> tuple[int, int]:
        """Foreground and background words, in the order that the swap flag asks for."""
        pair = self.parameters.foreground, self.parameters.background
        return (pair[1], pair[0]) if instruction.low_byte & Flags.SWAP else pair


Executor = Callable[[Processor, Instruction], None]
EXECUTORS: dict[str, Executor] = {}


def executes(name: str) -> Callable[[Executor], Executor]:
    """Enter a function as what does the instruction of that name."""

    def enter(executor: Executor) -> Executor:
        EXECUTORS[name] = executor
        return executor

    return enter


@executes("???")
def skip_illegal_word(processor: Processor, instruction: Instruction) -> None:
    """Hardware: PRG (the status bit). Assumed: the word alone is skipped."""
    processor.status |= Status.ILLEGAL
    processor.illegal_words += 1


@executes("RSET")
def reset(processor: Processor, instruction: Instruction) -> None:
    """Hardware: LIN libdoc (clears interrupts, parameters and screen); BTL (the lookup table stays)."""
    initialize(processor, instruction)
    processor.status = Status.READY
    processor.frame_buffer.fill(processor.parameters.whole_window, processor.parameters.background)


@executes("INIT")
def initialize(processor: Processor, instruction: Instruction) -> None:
    """Assumed: the parameters alone, since libdoc speaks of erasing for RSET only."""
    processor.parameters = Parameters.at_reset(processor.configuration)


@executes("NOP")
@executes("SET")
def do_nothing(processor: Processor, instruction: Instruction) -> None:
    """Nothing beyond taking the operands."""


@executes("ERS")
def erase(processor: Processor, instruction: Instruction) -> None:
    """Hardware: NCAR (the window alone), JPL (through the mask; foreground with the swap flag)."""
    parameters = processor.parameters
    _, background = processor.colors(instruction)
    processor.frame_buffer.fill(parameters.window, background, parameters.enable)


@executes("WI")
def write_image(processor: Processor, instruction: Instruction) -> None:
    """Hardware: LIN, PIC (one word a pixel); JPL, NCAR (mode 1, two pixels a word; a run goes on).

    Assumed: of an odd number of bytes in mode 0 the last is no pixel.
    """
    parameters = processor.parameters
    if parameters.image_mode & 1:
        words = np.frombuffer(instruction.data_bytes(), np.uint8).astype(np.uint16)
    else:
        words = instruction.data[: (instruction.length or 0) // 2]
    parameters.start = processor.frame_buffer.write_run(
        parameters.window, parameters.order, parameters.start, words, parameters.enable
    )


@executes("RI")
def read_image(processor: Processor, instruction: Instruction) -> None:
    """Hardware: LIN (one word a pixel), NCAR (the read mask).

    Assumed: planes that are not there read as 0; the run moves the operating point as writing does; a byte
    that fills up the last word is 0.
    """
    parameters = processor.parameters
    length = instruction.length or 0
    count = length if parameters.image_mode & 1 else length // 2
    words, parameters.start = processor.frame_buffer.read_run(
        parameters.window, parameters.order, parameters.start, count
    )
    words &= np.uint16(parameters.read_mask)
    if parameters.image_mode & 1:
        data = words.astype(np.uint8).tobytes() + bytes(length % 2)
        reverse = instruction.low_byte & Flags.REVERSE_PACKING
        words = np.frombuffer(data, "<u2" if reverse else ">u2").astype(np.uint16)
    processor.reply(words)


@executes("WT")
def write_text(processor: Processor, instruction: Instruction) -> None:
    """Hardware: BTL, LIN, JPL (cells of 7 x 9); LIN (the swap flag).

    Assumed: the additive flag leaves the pixels between the dots as they are, from its name.
    """
    parameters = processor.parameters
    foreground, background = processor.colors(instruction)
    style = drawing.TextStyle(
        dimensions=parameters.dimensions,
        spacing=parameters.spacing,
        size=(1 + (parameters.scale & 0x0F), 1 + (parameters.scale >> 8 & 0x0F)),
        foreground=foreground,
        background=background,
        transparent=bool(instruction.low_byte & Flags.ADDITIVE),
    )
    parameters.start = drawing.write_text(
        processor.frame_buffer,
        processor.characters,
        instruction.data_bytes(),
        style,
        window=parameters.window,
        order=parameters.order,
        start=parameters.start,
        enable=parameters.enable,
    )


@executes("WVL")
def write_linked_vectors(processor: Processor, instruction: Instruction) -> None:
    """Link vertices to the operating point, which ends at the last.

    Hardware: LIN, BTL, JPL (from the operating point through every vertex, which it ends at); BTL (a
    vector to the operating point is a point).

    Assumed: with relative addressing each vertex is counted from the one before.
    """
    parameters = processor.parameters
    numbers = instruction.data[: (instruction.length or 0) // 4 * 2].view(np.int16).reshape(-1, 2)
    if not len(numbers):
        return
    vertices = np.vstack(([parameters.start], numbers)).astype(np.int64)
    if instruction.low_byte & Flags.ADDRESSING == Flags.RELATIVE:
        vertices = np.cumsum(vertices, axis=0)
    else:
        vertices[1:] += parameters.base(instruction.low_byte)
    # Coordinates are registers of 16 bits.
    vertices = (vertices + 0x8000) % 0x10000 - 0x8000
    word, _ = processor.colors(instruction)
    drawing.write_vectors(processor.frame_buffer, vertices, word, parameters.enable)
    parameters.start = Point(*vertices[-1].tolist())


@executes("LAM")
def load_lookup_table(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL, NCAR (the device number is a table's, 0 on systems of one channel).

    Assumed: words for a table that is not there go nowhere.
    """
    if instruction.low_byte == 0:
        words = instruction.data[: (instruction.length or 0) // 2]
        processor.lookup_table.load(instruction.operands["address"][0], words)


@executes("RAM")
def read_lookup_table(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL (the packing of LAM). Assumed: a table that is not there reads as zeros."""
    count = (instruction.length or 0) // 2
    if instruction.low_byte == 0:
        processor.reply(processor.lookup_table.read(instruction.operands["address"][0], count))
    else:
        processor.reply(np.zeros(count, np.uint16))
