"""Streams of programs of the time, as hexadecimal words.

PRG has PDP-11 executables of 1980. An emulator of the PDP-11 and of the system calls that they make ran them,
and captured what they wrote to the file of the device. The driver of NCAR is a C source, which ran with its
output call captured. The keys and their files are in docs/SOURCES.md.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ramtek_emu import FAMILY, Configuration
from ramtek_emu.instruction_set.disassembler import items


def words(text: str) -> NDArray[np.uint16]:
    """The words of a text in hexadecimal."""
    return np.array([int(word, 16) for word in text.split()], np.uint16)


def listing(stream: bytes, configuration: Configuration = FAMILY) -> list[str]:
    """The lines of the listing of a stream."""
    return [line for item in items([stream], configuration) for line in item.lines()]


OUTLINE = words("""
0802 0002 0100   0802 8000 0064 0064   0E01 0004 00C8 00C8   0E01 0004 015E 00C8   0E01 0004 015E 0032
0E01 0004 00C8 0032   0E01 0004 0064 0064   0802 0102 0100 0007 0009
0C03 0040 005A 005A 0064 0064 0001 6100   0C03 0040 00CD 00CD 00D7 00D7 0001 6200
0C03 0040 00CD 0028 00D7 0032 0001 6300   0C03 0040 0163 0028 016D 0032 0001 6400
0C03 0040 0163 00CD 016D 00D7 0001 6500   0802 8002 0080 0064 0064   0E01 0004 00FA 0064
0E01 0004 015E 0032   0802 8000 00FA 0064   0E01 0004 015E 00C8   0802 8002 0100 00C8 00C8
0E01 0004 00C8 0032   0802 0002 0080   0C03 0040 00F0 006E 00FA 0078 0001 6600
""")
"""A closed outline with lines in it, and the letters a to f.

Hardware: PRG, all that the executable `rrr` (source rrr.c) writes, captured from the device file.
"""

SQUARES = words("""
0802 0040 0000 0000 001F 001F   0902 0004 0004   0802 0006 0004 0000
0C13 0040 0000 0000 0020 0020 0003 3030 3400
0802 0040 0020 0000 003F 001F   0902 0004 0006   0802 0006 0006 0000
0C13 0040 0020 0000 0040 0020 0003 3030 3600
""")
"""Two numbered squares.

Hardware: PRG, the first two of the 160 squares of the executable `sqap`, captured from the device file.
"""

BARS = np.array(
    [word for i in range(320) for word in (0x0802, 0x0040, 2 * i, 0, 2 * i + 1, 0x0100, 0x0902, 0x0004, i)],
    np.uint16,
)
"""Vertical bars in the words 0 to 319.

Hardware: PRG, all that the executable `band` writes, captured from the device file; written here as a loop.
"""

COLOR_MAP = np.array(
    [0x0300, 0, 0x0800]
    + [(i & 0o1700) >> 5 << 7 | (i & 0o70) >> 2 << 4 | (i & 7) << 1 for i in range(1024)]
    + [0x0300, 0x03FF, 2, 0],
    np.uint16,
)
"""A table of 12-bit entries, and its address counter parked.

Hardware: PRG, all that the executable `cmap` (source cmap.c) writes with the argument 3, captured from the
device file; written here as a formula.
"""

CLEAR = words("0910 0500")
"""A cleared screen.

Hardware: PRG, all that the executable `zp` writes, captured from the device file.
"""

BYTE_IMAGE = words(
    "0A0F 00C0 0020 0008 0210 000B 0213 0000 0001 0010 0201 0403 0605 0807 0A09 0C0B 0E0D 100F"
)
"""4 x 4 pixels of a byte each.

Hardware: NCAR, the call `rm_pixel` of dev_ramtek.c with 16 bytes, its output captured; byte n is n.
"""

DECODED = words("""
0500 0802 0002 0001 0802 8000 000A 01F5 0E01 0004 0064 01C3
0912 0043 00FF 0007 0064 0032 00C7 0063
0902 0044 0002 0064 014B 00C8 019B
0A03 0040 000A 0014 000D 0015 0008 0001 0002 0003 0004
0C0B 0040 0064 01C3 026B 01FF 0006 4548 4C4C 204F
0C13 0040 0000 0000 0020 0020 0003 3030 3400
0A0F 80C1 0020 00FF 0000 0000 027F 01DF 0000 000A 0001 0001 0010 0100 0302 0504 0706 0908 0B0A 0D0C 0F0E
0E03 8003 00FF 0005 0000 0000 0008 027F 01DF 013F 00EF
0802 0020 000A 0014 2600 0101
0E0F 8002 0008 0007 000A 0214 FF00 1000 0008 0064 0214 0064 025A
080E 0041 0006 00FF 0000 0200 027F 03FF 0000 0200 027F 03FF 0000 0200
""")
"""Instructions of five libraries, one after the other.

Hardware: line by line, BTL (erase.c, color.c, move.c, vec.c); JPL (ramtek_fill.c); BTL (sbox.c); PIC
(pmunge0.c); BTL (text.c); PRG (sqap); JPL (the image, vector, window and zoom structures of rtekinc.h, three
lines); NCAR (rm_poly and rm_hcw of dev_ramtek.c). These functions write the words for the arguments in them.
"""

RECORDED = (OUTLINE, SQUARES, BARS, COLOR_MAP, CLEAR, BYTE_IMAGE, DECODED)
