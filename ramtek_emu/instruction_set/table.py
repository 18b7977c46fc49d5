"""The instruction table and the operand table, on which decoder, processor, disassembler and assembler work.

An instruction begins with a word whose high byte is the opcode. In a *normal* instruction the low byte holds
flags. Operand flag words follow, then the operands that they name in ascending bit order, then, with the data
flag, a length in bytes and the data. In a *special* instruction the low byte is the number of a device, a
cursor or a character, and a fixed sequence of operands follows.

Hardware: LIN, BTL, JPL and NCAR agree on all of this; the counts of words are Linton's `Argno` and `libdoc`.
Assumed: CONE is 12 words, as its only client sends; a header comment says 6, which the decoder takes where
nothing else can be meant.
Assumed: DCL is one word, as its neighbors are; no client sends it.
Assumed: the bits of the second flag word that no source names carry no words.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final


class Flags:
    """The bits in the low byte of a normal instruction; plain numbers, which are quick to test."""

    DATA: Final = 0x01
    OPERANDS_1: Final = 0x02
    OPERANDS_2: Final = 0x04
    REVERSE_PACKING: Final = 0x08
    SWAP: Final = 0x10
    """Swap foreground and background."""
    ADDITIVE: Final = 0x20
    ADDRESSING: Final = 0xC0
    """Two bits: 0 absolute, or one of the three below."""
    INDEX_1: Final = 0x40
    INDEX_2: Final = 0x80
    RELATIVE: Final = 0xC0


@dataclass(frozen=True, slots=True)
class Operand:
    """A sticky parameter: our name for it, its mnemonic in the sources, and its number of words."""

    name: str
    mnemonic: str
    words: int


OPERANDS_1: Final = (
    Operand("mask", "SUB", 1),
    Operand("foreground", "FORE", 1),
    Operand("background", "BACK", 1),
    Operand("index_1", "INX1", 2),
    Operand("index_2", "INX2", 2),
    Operand("origin", "ORIG", 2),
    Operand("window", "WIN", 4),
    Operand("scan_order", "SCAN", 1),
    Operand("dimensions", "DIM", 2),
    Operand("spacing", "SPACE", 2),
    Operand("scale", "SCALE", 1),
    Operand("function", "FUNC", 1),
    Operand("conic", "CONE", 12),
    Operand("base_line", "BASE", 1),
    Operand("scroll", "SCRO", 1),
    Operand("start", "STRT", 2),
)
OPERANDS_2: Final = (
    Operand("read_mask", "RMSK", 1),
    Operand("write_window", "WEW", 4),
    Operand("write_offset", "WOF", 2),
    Operand("texture", "VTX", 2),
    Operand("display_class", "DCL", 1),
    Operand("image_mode", "IMG", 1),
)
OPERANDS: Final = {operand.name: operand for operand in OPERANDS_1 + OPERANDS_2}
OPERAND_BITS: Final = {
    operand.name: 1 << 16 * word + bit
    for word, operands in enumerate((OPERANDS_1, OPERANDS_2))
    for bit, operand in enumerate(operands)
}
"""The bits of the operands in the two flag words; the second flag word is the upper half."""


@lru_cache(maxsize=1024)
def operands_named(flag_word_1: int, flag_word_2: int = 0) -> tuple[Operand, ...]:
    """The operands that two flag words name, in the order in which they are sent."""
    return tuple(
        operand
        for flag_word, operands in ((flag_word_1, OPERANDS_1), (flag_word_2, OPERANDS_2))
        for bit, operand in enumerate(operands)
        if flag_word >> bit & 1
    )


@dataclass(frozen=True, slots=True)
class InstructionFormat:
    """A row of the instruction table."""

    opcode: int
    name: str
    meaning: str
    fixed: tuple[str, ...] | None = None
    """The operands of a special instruction, and `length` if data follow; None for a normal instruction."""
    replies: bool = False
    """Whether the data go to the host; the instruction then has a length but no data."""
    extended: bool = False
    """Whether the instruction exists only on the 9400 and the 9460."""
    unimplemented: bool = False
    """Whether the sources give only the name; then the instruction has no effect here."""
    requests_operands: bool = False
    """Whether the flag words name operands that the host asks for; then no operands follow."""

    @property
    def is_normal(self) -> bool:
        """Whether the low byte holds flags."""
        return self.fixed is None


ILLEGAL: Final = InstructionFormat(-1, "???", "no instruction", ())
"""The format of a word that begins no instruction of the table; only that word is skipped."""

CHARACTER_ROWS: Final = tuple(f"rows_{2 * pair}_{2 * pair + 1}" for pair in range(6))
"""The operands of LPF: twelve rows of eight dots, two a word."""

SUBSTANTIATED: Final = (
    InstructionFormat(0x03, "LAM", "load the lookup table", ("address", "length")),
    # Assumed: on the 9300 too, though only clients of the 9460 were seen to send it; without it, a client
    # that reads the table of a 9300 would wait for its answer forever.
    InstructionFormat(0x04, "RAM", "read the lookup table", ("address", "length"), replies=True),
    InstructionFormat(0x05, "RSET", "restore every parameter and erase the screen", ()),
    InstructionFormat(0x06, "INIT", "restore every parameter", ()),
    InstructionFormat(0x07, "NOP", "do nothing", ()),
    InstructionFormat(0x08, "SET", "set parameters"),
    InstructionFormat(0x09, "ERS", "erase the window"),
    InstructionFormat(0x0A, "WI", "write an image"),
    InstructionFormat(0x0B, "RI", "read an image", replies=True),
    InstructionFormat(0x0C, "WT", "write text"),
    InstructionFormat(0x0D, "WR", "write a raster of one bit a pixel"),
    InstructionFormat(0x0E, "WVL", "write linked vectors"),
    InstructionFormat(0x0F, "WC", "write a conic"),
    InstructionFormat(0x13, "PUSHE", "save the environment", (), extended=True),
    InstructionFormat(0x14, "POPE", "restore the environment", (), extended=True),
    InstructionFormat(0x15, "LPF", "load a character", CHARACTER_ROWS),
    InstructionFormat(0x16, "WCSS", "write a cursor, screen coordinates", ("element", "line_and_state")),
    InstructionFormat(0x17, "RCSS", "read a cursor, screen coordinates", ()),
    InstructionFormat(0x21, "LPFRP", "load a character, reverse packed", CHARACTER_ROWS, extended=True),
    InstructionFormat(0x24, "READP", "read parameters", extended=True, requests_operands=True),
    InstructionFormat(0x25, "RERR", "read and clear the error status", (), extended=True),
    InstructionFormat(0x26, "ZOOM", "repeat elements and lines", ("zoom",), extended=True),
    InstructionFormat(0x27, "SELVO", "select the video origin", (), extended=True),
    InstructionFormat(0x29, "WAITVR", "wait for the vertical retrace", (), extended=True),
    InstructionFormat(0x2A, "WAITL", "wait for a line", ("line",), extended=True),
    InstructionFormat(0x2B, "BERS", "erase the whole memory", extended=True),
    InstructionFormat(
        0x2C, "WCSP", "write a cursor, pixel coordinates", ("element", "line_and_state"), extended=True
    ),
    InstructionFormat(
        0x2D, "WCSG", "write a cursor, global coordinates", ("element", "line", "state"), extended=True
    ),
    InstructionFormat(0x2E, "RCSP", "read a cursor, pixel coordinates", (), extended=True),
    InstructionFormat(0x2F, "RCSG", "read a cursor, global coordinates", (), extended=True),
    InstructionFormat(0x30, "LCF", "load a cursor's shape", ("length",), extended=True),
    InstructionFormat(0x33, "DDCC", "connect a tracking device to cursors", ("cursors",), extended=True),
    InstructionFormat(0x35, "WVU", "write unlinked vectors", extended=True),
    InstructionFormat(0x38, "WPT", "write points", extended=True),
    InstructionFormat(0x39, "WRP", "write random pixels", extended=True),
    InstructionFormat(0x3A, "FILL", "fill an area", extended=True),
    InstructionFormat(0x4E, "ATTPF", "attach a font", (), extended=True),
    InstructionFormat(0x69, "COPY", "copy an image", extended=True),
    InstructionFormat(0x6D, "CIRC", "write circles", extended=True),
)
"""The instructions that programs of the time confirm, or whose names leave little doubt.

Hardware: LIN, PRG, BTL (the rows that are not extended), JPL, NCAR (RAM, ZOOM, SELVO, WAITVR, the pixel and
global cursor forms, LCF, DDCC, ATTPF; FILL, WPT and CIRC in disabled code).
Assumed: the formats of PUSHE, POPE, READP, RERR, WAITL, BERS, LPFRP, WVU, WRP and COPY, of which the
sources give numbers and names. Their executors say more.
"""

UNIMPLEMENTED: Final = (
    (0x01, "LOAD", "load a hard register"),
    (0x02, "READ", "read a soft register"),
    (0x10, "WPB", "write a plot box"),
    (0x11, "SCRX", "scroll along the lines"),
    (0x12, "SCRY", "scroll across the lines"),
    (0x18, "WKB", "write to the keyboard"),
    (0x19, "RKB", "read the keyboard"),
    (0x1A, "SPS", "SPS"),
    (0x1B, "LDL", "load a display list"),
    (0x1C, "RDL", "read a display list"),
    (0x1D, "CCM", "CCM"),
    (0x1E, "XIM", "XIM"),
    (0x1F, "LDLRP", "load a display list, reverse packed"),
    (0x20, "RDLRP", "read a display list, reverse packed"),
    (0x22, "SELMG", "SELMG"),
    (0x23, "SETDC", "set the display class"),
    (0x28, "LOADSO", "LOADSO"),
    (0x31, "LCCIO", "LCCIO"),
    (0x32, "CWC", "CWC"),
    (0x34, "DCVC", "DCVC"),
    (0x36, "WPP", "WPP"),
    (0x37, "WPV", "WPV"),
    (0x3B, "ALDL", "allocate a display list"),
    (0x3C, "DEDL", "delete a display list"),
    (0x3D, "RESCON", "RESCON"),
    (0x3E, "WBLK", "write a block"),
    (0x3F, "WBLKRP", "write a block, reverse packed"),
    (0x40, "RTC", "RTC"),
    (0x41, "CDL", "call a display list"),
    (0x42, "RETDL", "return from a display list"),
    *((opcode, f"DL{opcode:02X}", "display-list registers") for opcode in range(0x43, 0x4C)),
    (0x4C, "ALPF", "allocate a font"),
    (0x4D, "DEPF", "delete a font"),
    (0x4F, "LMPF", "LMPF"),
    *((opcode, f"MX{opcode:02X}", "matrices") for opcode in range(0x50, 0x5C)),
    *((opcode, f"CX{opcode:02X}", "contexts") for opcode in range(0x5C, 0x61)),
    *((opcode, f"DT{opcode:02X}", "detection") for opcode in range(0x61, 0x69)),
    (0x6A, "COPYT", "COPYT"),
    (0x6B, "COMBI", "combine images"),
    (0x6C, "COMBT", "COMBT"),
    *((opcode, f"ARC{opcode:02X}", "arcs") for opcode in range(0x6E, 0x71)),
    *((opcode, f"LF{opcode:02X}", "local functions") for opcode in range(0x71, 0x78)),
    (0x7F, "WPI", "write a packed image"),
    (0x80, "WIV", "WIV"),
    (0x81, "SCW", "SCW"),
    (0x82, "WRCT", "WRCT"),
    (0x83, "RCSL", "RCSL"),
    (0x84, "WCSL", "WCSL"),
    *((opcode, f"RA{opcode:02X}", "register arithmetic") for opcode in range(0x85, 0x8A)),
    (0x8A, "WC32", "WC32"),
    (0x8B, "STM", "STM"),
    (0x8C, "RTCS", "RTCS"),
    (0x8D, "WCVU", "WCVU"),
)
"""Opcodes of the 9400 and 9460 of which only number and name are known: opcode, name, meaning.

Hardware: NCAR, whose header lists them; no client that sends one of them was found. Names such as DL43 are
ours: the header describes a whole range.
"""

FORMATS: Final = SUBSTANTIATED + tuple(
    InstructionFormat(opcode, name, meaning, extended=True, unimplemented=True)
    for opcode, name, meaning in UNIMPLEMENTED
)
"""All rows of the instruction table.

Assumed: an instruction known by its name only has the normal format. Its flag words, operands and data are
consumed as its low byte says, so that the next instruction is found. The operands are set, since they are
sticky; nothing else is done, and the illegal-instruction status is set.
"""
FLAG_NAMES: Final = {
    Flags.REVERSE_PACKING: "RP",
    Flags.SWAP: "BK",
    Flags.ADDITIVE: "AD",
}
ADDRESSING_NAMES: Final = {Flags.INDEX_1: "IX01", Flags.INDEX_2: "IX10", Flags.RELATIVE: "IX11"}
FORMAT_OF_NAME: Final = {format.name: format for format in FORMATS}
