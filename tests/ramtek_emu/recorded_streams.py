"""Streams of programs of the time: the writes of claims with the subject `recorded`, whose sources are there.

PRG has PDP-11 executables of 1980. An emulator of the PDP-11 and of the system calls that they make ran them,
and captured what they wrote to the file of the device. The driver of NCAR is a C source, which ran with its
output call captured. The functions of the other libraries write these words for the arguments in them.
"""

from __future__ import annotations

from ramtek_emu import FAMILY, Configuration
from ramtek_emu.arrays import Words
from ramtek_emu.conformance.claims import all_claims, words_of
from ramtek_emu.instruction_set.disassembler import items

words = words_of


def listing(stream: bytes, configuration: Configuration = FAMILY) -> list[str]:
    """The lines of the listing of a stream."""
    return [line for item in items([stream], configuration) for line in item.lines()]


def recorded(name: str) -> Words:
    """The words of the recorded stream whose name begins so."""
    (claim,) = (row for row in all_claims() if row.subject == "recorded" and row.name.startswith(name))
    return words_of(" ".join(claim.writes))


OUTLINE = recorded("rrr: a closed outline")
SQUARES = recorded("sqap")
COLOR_MAP = recorded("cmap 3")
BYTE_IMAGE = recorded("four by four")
DECODED = recorded("instructions of five libraries")
RECORDED = (OUTLINE, SQUARES, recorded("band"), COLOR_MAP, recorded("zp: ERS"), BYTE_IMAGE, DECODED)
