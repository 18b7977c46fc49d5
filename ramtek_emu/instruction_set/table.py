"""The instruction table and the operand table, on which decoder, processor, disassembler and assembler work.

An instruction begins with a word whose high byte is the opcode. In a *normal* instruction the low byte holds
flags. Operand flag words follow, then the operands that they name in ascending bit order, then, with the data
flag, a length in bytes and the data. In a *special* instruction the low byte is the number of a device, a
cursor or a character, and a fixed sequence of operands follows.

Every row of both tables cites its sources: keys of docs/SOURCES.md, each with a file.

Hardware: LIN, BTL, JPL and NCAR agree on all of this; the counts of words are Linton's `Argno` and `libdoc`.
Assumed: CONE is 6 words, as `Argno`, `libdoc` and the header say, but 12 in WC, as LIN wc.c sends. Each of
the 12 is the upper or the lower half of a number; the decoder tells where WC is taken with 6. NCAR ramtek.h
has another opcode, 8A, for conics with coefficients of 32 bits, so that WC may have 16 bits on the 9400.
Assumed: DCL is one word, as its neighbors are; no client sends it.
Assumed: the bits of the second flag word that no source names carry no words.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
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
    Operand("conic", "CONE", 6, "LIN setp.c, LIN libdoc, PRG ramtek.h, LIN wc.c"),
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


@dataclass(frozen=True)
class InstructionFormat:
    """A row of the instruction table."""

    opcode: int
    name: str
    meaning: str
    source: str
    """The sources of the format, such as "LIN lam.c, BTL openpl.c"."""
    fixed: tuple[str, ...] | None = None
    """The operands of a special instruction, with `length` last if it has data; None if it is normal."""
    extended: bool = False
    """Whether the instruction exists only on the 9400 and the 9460."""
    unimplemented: bool = False
    """Whether the sources give only the name; then the instruction has no effect here."""

    @cached_property
    def is_normal(self) -> bool:
        """Whether the low byte holds flags."""
        return self.fixed is None

    @cached_property
    def replies(self) -> bool:
        """Whether the data go to the host; the instruction then has a length but no data."""
        return self.name in ("RAM", "RI")

    @cached_property
    def sends_data(self) -> bool:
        """Whether data follow a length."""
        return not self.replies and "length" in (self.fixed or ("length",) * self.is_normal)

    @cached_property
    def requests_operands(self) -> bool:
        """Whether the flag words name operands that the host asks for; then no operands follow."""
        return self.name == "READP"


def rows_of(table: str) -> tuple[InstructionFormat, ...]:
    """The formats of a text with a row a line: opcode, name and operands | meaning | source.

    A plus sign after the opcode means the 9400 and the 9460 alone. Without a word after the name the
    instruction is normal, and `none` means a special instruction without operands.
    """
    rows = []
    for line in table.strip().replace("\n    ", " ").splitlines():
        head, meaning, source = line.split(" | ")
        opcode, name, *operands = head.split()
        fixed = tuple(operand for operand in operands if operand != "none") if operands else None
        rows.append(
            InstructionFormat(int(opcode[:2], 16), name, meaning, source, fixed, opcode.endswith("+"))
        )
    return tuple(rows)


ILLEGAL: Final = InstructionFormat(-1, "???", "no instruction", "", ())
"""The format of a row of words that begin no instruction of the table; these words are skipped."""

SUBSTANTIATED: Final = rows_of("""
03 LAM address length | load the lookup table | LIN lam.c, PRG cmap.c, BTL openpl.c, JPL ramtek_lut.c,
    NCAR dev_ramtek.c
04 RAM address length | read the lookup table | JPL ramtek_lut.c
05 RSET none | restore every parameter and erase the screen | LIN libdoc, PRG ramtek.h, BTL erase.c
06 INIT none | restore every parameter | LIN libdoc, PRG ramtek.h
07 NOP none | do nothing | PRG ramtek.h, NCAR ramtek.h
08 SET | set parameters | LIN setp.c, LIN libdoc, BTL move.c, JPL rtekinc.h, NCAR dev_ramtek.c
09 ERS | erase the window | LIN clear.c, LIN libdoc, BTL sbox.c, JPL rtekinc.h, NCAR dev_ramtek.c
0A WI | write an image | LIN wi.c, PIC pmunge0.c, JPL rtekinc.h, NCAR dev_ramtek.c
0B RI | read an image | LIN ri.c, LIN lread.c, PRG rread.c, JPL rtekinc.h
0C WT | write text | LIN wt.c, PRG rrr.c, BTL text.c, JPL rtekinc.h
0D WR | write a raster of one bit a pixel | LIN wr.c, PRG rast.c
0E WVL | write linked vectors | LIN wv.c, LIN wvs.c, PRG rrr.c, BTL vec.c, JPL rtekinc.h, NCAR dev_ramtek.c
0F WC | write a conic | LIN wc.c, LIN libdoc
10 WPB | write a plot | LIN libdoc, LIN fplot.c, NCAR ramtek.h, format assumed
13+ PUSHE none | save the environment | NCAR ramtek.h, format assumed
14+ POPE none | restore the environment | NCAR ramtek.h, format assumed
15 LPF rows_0_1 rows_2_3 rows_4_5 rows_6_7 rows_8_9 rows_10_11 | load a character | LIN lcs.c
16 WCSS element line_and_state | write a cursor, screen coordinates | LIN wcur.c
17 RCSS none | read a cursor, screen coordinates | LIN rcur.c
21+ LPFRP rows_0_1 rows_2_3 rows_4_5 rows_6_7 rows_8_9 rows_10_11 | load a character, reverse packed
    | NCAR ramtek.h, format assumed
24+ READP | read parameters | NCAR ramtek.h, format assumed
25+ RERR none | read and clear the error status | NCAR ramtek.h, format assumed
26+ ZOOM zoom | repeat elements and lines | JPL rtekinc.h, NCAR dev_ramtek.c
27+ SELVO none | select the video origin | NCAR dev_ramtek.c
29+ WAITVR none | wait for the vertical retrace | NCAR dev_ramtek.c
2A+ WAITL line | wait for a line | NCAR ramtek.h, format assumed
2B+ BERS | erase the whole memory | NCAR ramtek.h, format assumed
2C+ WCSP element line_and_state | write a cursor, pixel coordinates | NCAR dev_ramtek.c
2D+ WCSG element line state | write a cursor, global coordinates | JPL ramtek_curposition.c
2E+ RCSP none | read a cursor, pixel coordinates | NCAR dev_ramtek.c
2F+ RCSG none | read a cursor, global coordinates | JPL ramtek_curposition.c
30+ LCF length | load a cursor's shape | JPL rtekinc.h
33+ DDCC cursors | connect a tracking device to cursors | JPL ramtek_autotrack.c
35+ WVU | write unlinked vectors | NCAR ramtek.h, format assumed
38+ WPT | write points | NCAR dev_ramtek.c
39+ WRP | write random pixels | NCAR ramtek.h, format assumed
3A+ FILL | fill an area | NCAR dev_ramtek.c
4E+ ATTPF none | attach a font | NCAR dev_ramtek.c
69+ COPY | copy an image | NCAR ramtek.h, format assumed
6D+ CIRC | write circles | JPL rtekinc.h, NCAR dev_ramtek.c
""")
"""The instructions that programs of the time confirm, or whose names leave little doubt.

Hardware: LIN, PRG, BTL and PIC send or describe the rows that are not extended, except RAM. JPL and NCAR send
the extended rows; FILL and WPT are in disabled code.
Assumed: RAM belongs to the 9300, too, though only clients of the 9460 were seen to send it; without it, a
client that reads the table of a 9300 would wait for its answer forever.
Assumed: the formats of PUSHE, POPE, READP, RERR, WAITL, BERS, LPFRP, WVU, WRP and COPY, of which the
sources give numbers and names. Their executors say more.
"""

NAMES: Final = """
arcs: 6E+ ARC1, 6F+ ARC2, 70+ ARC3
conics: 8A+ WC32
contexts: 3D+ RESCON, 5C+ ALCON, 5D+ DECON, 5E+ SCON, 5F+ READAS, 60+ RCON
cursors: 31+ LCCIO, 32+ CWC, 34+ DCVC, 81+ SCW, 83+ RCSL, 84+ WCSL
detection: 61+ SDP, 62+ ED, 63+ DD, 64+ SD, 65+ RD, 66+ SDD, 67+ SDS, 68+ RDB
display classes: 23+ SETDC
display lists: 1B+ LDL, 1C+ RDL, 1F+ LDLRP, 20+ RDLRP, 3B+ ALDL, 3C+ DEDL, 41+ CDL, 42+ RETDL
fonts: 4C+ ALPF, 4D+ DEPF, 4F+ LMPF
images: 6A+ COPYT, 6B+ COMBI, 6C+ COMBT, 7F+ WPI
keyboard: 18+ WKB, 19+ RKB, 3E+ WBLK, 3F+ WBLKRP, 76+ SKES, 77+ CKES
local functions: 71+ SLFS, 72+ SLKF, 73+ CLKF, 74+ SLCF, 75+ CLCF
matrices: 50+ PUSHM, 51+ POPM, 52+ SETM, 53+ LM, 54+ SM, 55+ MM, 56+ MMI, 57+ IM, 58+ SCALE, 59+ TRANS,
    5A+ ROTAT, 5B+ READM
peripherals: 1A+ SPS
plots: 36+ WPP, 37+ WPV
processors: 1D+ CCM, 1E+ XIM, 22+ SELMG
registers: 01+ LOAD, 02+ READ
registers of display lists: 43+ SDLR, 44+ DDLR, 45+ IDLR, 46+ SUBDLR, 47+ ADLR, 48+ LDLR, 49+ STDLR,
    4A+ PLDLR, 4B+ JDLR, 85+ DIVDLR, 86+ MULDLR, 87+ ANDDLR, 88+ ORDLR, 89+ XORDLR
scrolling: 11 SCRX, 12 SCRY
subchannels: 28+ LOADSO
tablet: 40+ RTC, 8B+ STM, 8C+ RTCS
text: 82+ WRCT
vectors: 80+ WIV, 8D+ WCVU
"""
"""Opcodes of which only numbers and names are known, by subjects; plus signs mean the same as above.

Hardware: NCAR ramtek.h lists them with a few words each, and no client sends them. SDS has a joke there.
LIN libdoc has a scrolling count, so that SCRX and SCRY belong to the 9300, too.
"""

UNIMPLEMENTED: Final = tuple(
    InstructionFormat(
        int(opcode[:2], 16), name, f"{subject}, by name only", "NCAR ramtek.h", None, "+" in opcode, True
    )
    for subject, names in (line.split(": ") for line in NAMES.strip().replace("\n    ", " ").splitlines())
    for opcode, name in map(str.split, names.split(", "))
)

FORMATS: Final = SUBSTANTIATED + UNIMPLEMENTED
"""All rows of the instruction table.

Assumed: an instruction known by its name only has the normal format. The decoder consumes the flag words,
operands and data that its low byte announces, and so finds the next instruction. The operands are set, since
they are sticky. The only other effect is the illegal-instruction status.
"""
FLAG_OF_NAME: Final = {
    "RP": Flags.REVERSE_PACKING,
    "BK": Flags.SWAP,
    "AD": Flags.ADDITIVE,
    "IX01": Flags.INDEX_1,
    "IX10": Flags.INDEX_2,
    "IX11": Flags.RELATIVE,
}
"""The flags of packing, colors and addressing by their names in the sources."""
FORMAT_OF_NAME: Final = {format.name: format for format in FORMATS}
