"""The instruction table and the operand table, on which decoder, processor, disassembler and assembler work.

An instruction begins with a word whose high byte is the opcode. In a *normal* instruction the low byte holds
flags. Operand flag words follow, then the operands that they name in ascending bit order, then, with the data
flag, a length in bytes and the data. In a *special* instruction the low byte is the number of a device, a
cursor or a character, and a fixed sequence of operands follows.

Every row of both tables cites its sources: keys of docs/SOURCES.md, each with a file.

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
    source: str
    """The sources of the number and the meaning of its words, such as "LIN libdoc, BTL move.c"."""


OPERANDS_1: Final = (
    Operand("mask", "SUB", 1, "LIN libdoc, JPL rtekinc.h, NCAR dev_ramtek.c"),
    Operand("foreground", "FORE", 1, "LIN libdoc, BTL color.c, JPL rtekinc.h"),
    Operand("background", "BACK", 1, "LIN libdoc, BTL sbox.c"),
    Operand("index_1", "INX1", 2, "LIN libdoc, PRG ramtek.h, NCAR ramtek.h"),
    Operand("index_2", "INX2", 2, "LIN libdoc, PRG ramtek.h, NCAR ramtek.h"),
    Operand("origin", "ORIG", 2, "LIN libdoc, JPL rtekinc.h, NCAR dev_ramtek.c"),
    Operand("window", "WIN", 4, "LIN libdoc, BTL sbox.c, JPL rtekinc.h, NCAR dev_ramtek.c"),
    Operand("scan_order", "SCAN", 1, "LIN libdoc, PRG ramtek.h, JPL rtekinc.h, NCAR dev_ramtek.c"),
    Operand("dimensions", "DIM", 2, "LIN libdoc, PRG rrr.c"),
    Operand("spacing", "SPACE", 2, "LIN libdoc, PRG ramtek.h, NCAR ramtek.h"),
    Operand("scale", "SCALE", 1, "LIN libdoc, JPL rtekinc.h"),
    Operand("function", "FUNC", 1, "LIN libdoc, PRG rfun.c"),
    Operand("conic", "CONE", 12, "LIN wc.c"),
    Operand("base_line", "BASE", 1, "LIN libdoc, PRG ramtek.h, NCAR ramtek.h"),
    Operand("scroll", "SCRO", 1, "LIN libdoc, PRG ramtek.h, NCAR ramtek.h"),
    Operand("start", "STRT", 2, "LIN libdoc, BTL move.c, JPL rtekinc.h, NCAR dev_ramtek.c"),
)
OPERANDS_2: Final = (
    Operand("read_mask", "RMSK", 1, "NCAR dev_ramtek.c"),
    Operand("write_window", "WEW", 4, "NCAR dev_ramtek.c"),
    Operand("write_offset", "WOF", 2, "NCAR dev_ramtek.c"),
    Operand("texture", "VTX", 2, "NCAR dev_ramtek.c, LONG longlib.tex"),
    Operand("display_class", "DCL", 1, "NCAR ramtek.h, length assumed"),
    Operand("image_mode", "IMG", 1, "JPL rtekinc.h, NCAR dev_ramtek.c"),
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
    source: str
    """The sources of the format, such as "LIN lam.c, BTL openpl.c"."""
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


ILLEGAL: Final = InstructionFormat(-1, "???", "no instruction", "", ())
"""The format of a word that begins no instruction of the table; only that word is skipped."""

CHARACTER_ROWS: Final = tuple(f"rows_{2 * pair}_{2 * pair + 1}" for pair in range(6))
"""The operands of LPF: twelve rows of eight dots, two a word."""

NAME_ALONE: Final = "NCAR ramtek.h, format assumed"
"""The source of a row of which only number and name are known."""

SUBSTANTIATED: Final = (
    InstructionFormat(
        0x03,
        "LAM",
        "load the lookup table",
        "LIN lam.c, PRG cmap.c, BTL openpl.c, JPL ramtek_lut.c, NCAR dev_ramtek.c",
        ("address", "length"),
    ),
    # Assumed: on the 9300 too, though only clients of the 9460 were seen to send it; without it, a client
    # that reads the table of a 9300 would wait for its answer forever.
    InstructionFormat(
        0x04, "RAM", "read the lookup table", "JPL ramtek_lut.c", ("address", "length"), replies=True
    ),
    InstructionFormat(
        0x05,
        "RSET",
        "restore every parameter and erase the screen",
        "LIN libdoc, PRG ramtek.h, BTL erase.c",
        (),
    ),
    InstructionFormat(0x06, "INIT", "restore every parameter", "LIN libdoc, PRG ramtek.h", ()),
    InstructionFormat(0x07, "NOP", "do nothing", "PRG ramtek.h, NCAR ramtek.h", ()),
    InstructionFormat(
        0x08, "SET", "set parameters", "LIN libdoc, BTL move.c, JPL rtekinc.h, NCAR dev_ramtek.c"
    ),
    InstructionFormat(
        0x09, "ERS", "erase the window", "LIN libdoc, BTL sbox.c, JPL rtekinc.h, NCAR dev_ramtek.c"
    ),
    InstructionFormat(
        0x0A, "WI", "write an image", "LIN libdoc, PIC pmunge0.c, JPL rtekinc.h, NCAR dev_ramtek.c"
    ),
    InstructionFormat(0x0B, "RI", "read an image", "LIN libdoc, PIC pram.c, JPL rtekinc.h", replies=True),
    InstructionFormat(0x0C, "WT", "write text", "LIN wt.c, PRG rrr.c, BTL text.c, JPL rtekinc.h"),
    InstructionFormat(0x0D, "WR", "write a raster of one bit a pixel", "LIN wr.c, PRG rast.c"),
    InstructionFormat(
        0x0E, "WVL", "write linked vectors", "PRG rrr.c, BTL vec.c, JPL rtekinc.h, NCAR dev_ramtek.c"
    ),
    InstructionFormat(0x0F, "WC", "write a conic", "LIN wc.c, LIN libdoc"),
    InstructionFormat(0x10, "WPB", "write a plot", "LIN libdoc, LIN fplot.c, NCAR ramtek.h, format assumed"),
    InstructionFormat(0x13, "PUSHE", "save the environment", NAME_ALONE, (), extended=True),
    InstructionFormat(0x14, "POPE", "restore the environment", NAME_ALONE, (), extended=True),
    InstructionFormat(0x15, "LPF", "load a character", "LIN lcs.c", CHARACTER_ROWS),
    InstructionFormat(
        0x16, "WCSS", "write a cursor, screen coordinates", "LIN wcur.c", ("element", "line_and_state")
    ),
    InstructionFormat(0x17, "RCSS", "read a cursor, screen coordinates", "LIN rcur.c", ()),
    InstructionFormat(
        0x21, "LPFRP", "load a character, reverse packed", NAME_ALONE, CHARACTER_ROWS, extended=True
    ),
    InstructionFormat(0x24, "READP", "read parameters", NAME_ALONE, extended=True, requests_operands=True),
    InstructionFormat(0x25, "RERR", "read and clear the error status", NAME_ALONE, (), extended=True),
    InstructionFormat(
        0x26,
        "ZOOM",
        "repeat elements and lines",
        "JPL rtekinc.h, NCAR dev_ramtek.c",
        ("zoom",),
        extended=True,
    ),
    InstructionFormat(0x27, "SELVO", "select the video origin", "NCAR dev_ramtek.c", (), extended=True),
    InstructionFormat(
        0x29, "WAITVR", "wait for the vertical retrace", "NCAR dev_ramtek.c", (), extended=True
    ),
    InstructionFormat(0x2A, "WAITL", "wait for a line", NAME_ALONE, ("line",), extended=True),
    InstructionFormat(0x2B, "BERS", "erase the whole memory", NAME_ALONE, extended=True),
    InstructionFormat(
        0x2C,
        "WCSP",
        "write a cursor, pixel coordinates",
        "NCAR dev_ramtek.c",
        ("element", "line_and_state"),
        extended=True,
    ),
    InstructionFormat(
        0x2D,
        "WCSG",
        "write a cursor, global coordinates",
        "JPL ramtek_curposition.c",
        ("element", "line", "state"),
        extended=True,
    ),
    InstructionFormat(
        0x2E, "RCSP", "read a cursor, pixel coordinates", "NCAR dev_ramtek.c", (), extended=True
    ),
    InstructionFormat(
        0x2F, "RCSG", "read a cursor, global coordinates", "JPL ramtek_curposition.c", (), extended=True
    ),
    InstructionFormat(0x30, "LCF", "load a cursor's shape", "JPL rtekinc.h", ("length",), extended=True),
    InstructionFormat(
        0x33,
        "DDCC",
        "connect a tracking device to cursors",
        "JPL ramtek_autotrack.c",
        ("cursors",),
        extended=True,
    ),
    InstructionFormat(0x35, "WVU", "write unlinked vectors", NAME_ALONE, extended=True),
    InstructionFormat(0x38, "WPT", "write points", "NCAR dev_ramtek.c", extended=True),
    InstructionFormat(0x39, "WRP", "write random pixels", NAME_ALONE, extended=True),
    InstructionFormat(0x3A, "FILL", "fill an area", "NCAR dev_ramtek.c", extended=True),
    InstructionFormat(0x4E, "ATTPF", "attach a font", "NCAR dev_ramtek.c", (), extended=True),
    InstructionFormat(0x69, "COPY", "copy an image", NAME_ALONE, extended=True),
    InstructionFormat(0x6D, "CIRC", "write circles", "JPL rtekinc.h, NCAR dev_ramtek.c", extended=True),
)
"""The instructions that programs of the time confirm, or whose names leave little doubt.

Hardware: LIN, PRG, BTL and PIC send or describe the rows that are not extended, except RAM. JPL and NCAR send
the extended rows; FILL and WPT are in disabled code.
Assumed: the format of WPB, which LIN describes without its words; the formats of PUSHE, POPE, READP, RERR,
WAITL, BERS, LPFRP, WVU, WRP and COPY, of which the sources give numbers and names. Their executors say more.
"""

UNIMPLEMENTED: Final = (
    (0x01, "LOAD", "load a hard register"),
    (0x02, "READ", "read a soft register"),
    (0x11, "SCRX", "scroll along the lines"),
    (0x12, "SCRY", "scroll across the lines"),
    (0x18, "WKB", "write to the keyboard"),
    (0x19, "RKB", "read the keyboard"),
    (0x1A, "SPS", "sense the status of peripherals"),
    (0x1B, "LDL", "load a display list"),
    (0x1C, "RDL", "read a display list"),
    (0x1D, "CCM", "call control memory"),
    (0x1E, "XIM", "execute instruction memory"),
    (0x1F, "LDLRP", "load a display list, reverse packed"),
    (0x20, "RDLRP", "read a display list, reverse packed"),
    (0x22, "SELMG", "select an MCP or a group"),
    (0x23, "SETDC", "set the ranges of display classes"),
    (0x28, "LOADSO", "load the origins of subchannels"),
    (0x31, "LCCIO", "load a cursor into the operating point, an index register or the origin"),
    (0x32, "CWC", "center the window at a cursor"),
    (0x34, "DCVC", "define the configuration of cursors and video"),
    (0x36, "WPP", "write a plot point"),
    (0x37, "WPV", "write a plot vector"),
    (0x3B, "ALDL", "allocate a display list"),
    (0x3C, "DEDL", "delete a display list"),
    (0x3D, "RESCON", "reset a context"),
    (0x3E, "WBLK", "write a block to the keyboard"),
    (0x3F, "WBLKRP", "write a block to the keyboard, reverse packed"),
    (0x40, "RTC", "read the coordinates of the tablet"),
    (0x41, "CDL", "call a display list"),
    (0x42, "RETDL", "return from a display list"),
    (0x43, "SDLR", "set a display-list register"),
    (0x44, "DDLR", "decrement a display-list register"),
    (0x45, "IDLR", "increment a display-list register"),
    (0x46, "SUBDLR", "subtract display-list registers"),
    (0x47, "ADLR", "add display-list registers"),
    (0x48, "LDLR", "load a display-list register"),
    (0x49, "STDLR", "store a display-list register"),
    (0x4A, "PLDLR", "load display-list registers from parameters"),
    (0x4B, "JDLR", "jump if a display-list register fulfills a condition"),
    (0x4C, "ALPF", "allocate a font"),
    (0x4D, "DEPF", "delete a font"),
    (0x4F, "LMPF", "load several fonts"),
    (0x50, "PUSHM", "push the matrix"),
    (0x51, "POPM", "pop the matrix"),
    (0x52, "SETM", "set the matrix"),
    (0x53, "LM", "load the current matrix"),
    (0x54, "SM", "store the current matrix"),
    (0x55, "MM", "multiply matrices"),
    (0x56, "MMI", "multiply by an immediate matrix"),
    (0x57, "IM", "initialize the matrix"),
    (0x58, "SCALE", "scale the matrix"),
    (0x59, "TRANS", "translate the matrix"),
    (0x5A, "ROTAT", "rotate the matrix"),
    (0x5B, "READM", "read the matrix"),
    (0x5C, "ALCON", "allocate a context"),
    (0x5D, "DECON", "delete a context"),
    (0x5E, "SCON", "select a context"),
    (0x5F, "READAS", "read the state of allocation"),
    (0x60, "RCON", "read the associations of contexts"),
    (0x61, "SDP", "set the parameters of detection"),
    (0x62, "ED", "enable detection"),
    (0x63, "DD", "disable detection"),
    (0x64, "SD", "suspend detection"),
    (0x65, "RD", "resume detection"),
    (0x66, "SDD", "set the data of detection"),
    (0x67, "SDS", "SDS"),
    (0x68, "RDB", "read the buffer of detection"),
    (0x6A, "COPYT", "copy an image, triggered"),
    (0x6B, "COMBI", "combine images"),
    (0x6C, "COMBT", "combine images, triggered"),
    (0x6E, "ARC1", "write arcs, type 1"),
    (0x6F, "ARC2", "write arcs, type 2"),
    (0x70, "ARC3", "write arcs, type 3"),
    (0x71, "SLFS", "set the state of local functions"),
    (0x72, "SLKF", "set a local keyboard function"),
    (0x73, "CLKF", "clear a local keyboard function"),
    (0x74, "SLCF", "set a local cursor function"),
    (0x75, "CLCF", "clear a local cursor function"),
    (0x76, "SKES", "set the echo of the keyboard"),
    (0x77, "CKES", "clear the echo of the keyboard"),
    (0x7F, "WPI", "write a packed image"),
    (0x80, "WIV", "write image vectors"),
    (0x81, "SCW", "set the window of a cursor"),
    (0x82, "WRCT", "write colored text at random places"),
    (0x83, "RCSL", "read a cursor, local"),
    (0x84, "WCSL", "write a cursor, local"),
    (0x85, "DIVDLR", "divide display-list registers"),
    (0x86, "MULDLR", "multiply display-list registers"),
    (0x87, "ANDDLR", "AND of display-list registers"),
    (0x88, "ORDLR", "OR of display-list registers"),
    (0x89, "XORDLR", "exclusive OR of display-list registers"),
    (0x8A, "WC32", "write a conic with 32-bit coefficients"),
    (0x8B, "STM", "set the mode of the tablet"),
    (0x8C, "RTCS", "read the coordinates and the status of the tablet"),
    (0x8D, "WCVU", "write colored, unlinked vectors"),
)
"""Opcodes of which only number and name are known: opcode, name, meaning.

Hardware: NCAR ramtek.h lists them with a few words each, and no client sends them. SDS has a joke there.
Assumed: the 9300 scrolls, since LIN libdoc has a scrolling count; the other rows are of the 9400 and 9460.
"""

FORMATS: Final = SUBSTANTIATED + tuple(
    InstructionFormat(
        opcode, name, meaning, "NCAR ramtek.h", extended=name not in ("SCRX", "SCRY"), unimplemented=True
    )
    for opcode, name, meaning in UNIMPLEMENTED
)
"""All rows of the instruction table.

Assumed: an instruction known by its name only has the normal format. The decoder consumes the flag words,
operands and data that its low byte announces, and so finds the next instruction. The operands are set, since
they are sticky. The only other effect is the illegal-instruction status.
"""
FLAG_NAMES: Final = {
    Flags.REVERSE_PACKING: "RP",
    Flags.SWAP: "BK",
    Flags.ADDITIVE: "AD",
}
ADDRESSING_NAMES: Final = {Flags.INDEX_1: "IX01", Flags.INDEX_2: "IX10", Flags.RELATIVE: "IX11"}
FORMAT_OF_NAME: Final = {format.name: format for format in FORMATS}
