"""Parameters: the current values of the sticky operands.

Assumed: at power-on and after RSET and INIT the foreground is all ones (BTL's programs draw before they set
one), the background 0, the mask all ones, the window the whole memory, the scan order 0, the cell 7 x 9
(PRG), the zoom 1, the video origin at the top, and everything else 0; no source lists the values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from ramtek_emu.configuration import Configuration
from ramtek_emu.instruction_set.table import Flags
from ramtek_emu.memory.character_rom import CELL_ELEMENTS, CELL_LINES
from ramtek_emu.memory.frame_buffer import WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, ScanOrder, Window

ORIGIN: Final = Point(0, 0)
STANDARD_FONT: Final = 0xFF
"""Hardware: NCAR."""


def signed(word: int) -> int:
    """A word as a two's complement number: programs send negative coordinates (Hardware: PRG, chase)."""
    return word - 0x10000 if word & 0x8000 else word


def register(point: Point) -> Point:
    """The point with its coordinates wrapped to registers of 16 bits."""
    return Point(signed(point.element & 0xFFFF), signed(point.line & 0xFFFF))


def coefficients(words: tuple[int, ...]) -> tuple[int, ...]:
    """The six numbers of a conic: from six words of 16 bits, or from twelve, high word first.

    Hardware: LIN setp.c sends six words, and wc.c pairs whose high word is always 0.
    Assumed: a pair whose high word is 0 is therefore the 16-bit number in its low word, which may be
    negative; any other pair is a number of 32 bits.
    """
    if len(words) == 6:
        return tuple(map(signed, words))
    pairs = zip(words[::2], words[1::2], strict=True)
    return tuple(signed(high) << 16 | low if high else signed(low) for high, low in pairs)


@dataclass(kw_only=True)
class Parameters:
    """All sticky operands under their names in the operand table, and the parameters that have no operand."""

    mask: int
    foreground: int
    background: int = 0
    index_1: Point = ORIGIN
    index_2: Point = ORIGIN
    origin: Point = ORIGIN
    window: Window
    scan_order: int = 0
    dimensions: tuple[int, int] = (CELL_ELEMENTS, CELL_LINES)
    spacing: tuple[int, int] = (0, 0)
    scale: int = 0
    function: int = 0
    conic: tuple[int, ...] = (0,) * 6
    """Coefficients a to e of 0 = a x^2 + b y^2 + c xy + d x + e y, and the most pixels (0: no limit)."""
    base_line: int = 0
    scroll: int = 0
    start: Point = ORIGIN
    """The current operating point, which instructions move."""
    read_mask: int
    write_window: Window
    write_offset: Point = ORIGIN
    texture: tuple[int, int] = (0xFFFF, 0)
    display_class: int = 0
    image_mode: int = 0
    zoom: tuple[int, int] = (1, 1)
    """The number of times that elements, and lines, are repeated."""
    origin_at_bottom: bool = False
    """Whether lines are counted from the bottom of the screen."""
    font: int = 0
    """The font of text: STANDARD_FONT is the ROM, any other number the loaded characters."""
    whole_window: Window
    whole_word: int
    """A word with every plane set."""

    @classmethod
    def at_reset(cls, configuration: Configuration) -> Parameters:
        """The values that RSET and INIT restore."""
        window = Window(0, 0, configuration.elements - 1, configuration.lines - 1)
        return cls(
            mask=0xFFFF,
            foreground=configuration.largest_word,
            window=window,
            read_mask=0xFFFF,
            write_window=window,
            whole_window=window,
            whole_word=configuration.largest_word,
        )

    def state(self) -> dict[str, Any]:
        """The values by their names."""
        return dict(vars(self))

    def restore(self, state: dict[str, Any]) -> None:
        """Set the values of a state."""
        vars(self).update(state)

    @property
    def order(self) -> ScanOrder:
        """The current scan order.

        Assumed: only the lowest three bits count.
        """
        return SCAN_ORDERS[self.scan_order & 7]

    @property
    def enable(self) -> WriteEnable:
        """The planes and the window that writes may change now.

        Hardware: NCAR (the 9460 clips with its write-enable window; the image window clips no vector).
        """
        return WriteEnable(self.mask, self.write_window)

    def base(self, flags: int) -> Point:
        """The point that coordinates are counted from: (0, 0), an index register or the operating point.

        Hardware: LIN, wtr() sends C0h where it means the operating point.
        """
        return (ORIGIN, self.index_1, self.index_2, self.start)[(flags & Flags.ADDRESSING) >> 6]

    def take(self, operands: Mapping[str, tuple[int, ...]], flags: int) -> None:
        """Set the operands of a normal instruction.

        Hardware: LIN, BTL, LONG: a window moves the operating point to the corner where the scan starts.
        Assumed: registers have 16 bits, so that coordinates counted from a base wrap.
        Assumed: a start point in the same instruction takes precedence; window and start are counted from the
        base as it was before the instruction; the corner is that of the scan order after the instruction.
        """
        if not operands:
            return
        base = self.base(flags)
        for name, words in operands.items():
            if name in ("window", "start"):
                continue
            if len(words) == 1:
                setattr(self, name, words[0])
            elif name == "conic":
                self.conic = coefficients(words)
            elif (kind := type(getattr(self, name))) is tuple:
                setattr(self, name, words)
            else:
                setattr(self, name, kind(*map(signed, words)))
        if "window" in operands:
            left, top, right, bottom = operands["window"]
            element, line = base
            self.window = Window(
                signed(left + element & 0xFFFF),
                signed(top + line & 0xFFFF),
                signed(right + element & 0xFFFF),
                signed(bottom + line & 0xFFFF),
            )
            self.start = self.order.corner(self.window)
        if "start" in operands:
            element, line = operands["start"]
            self.start = register(Point(element + base.element, line + base.line))
