"""Encoder of text."""

from __future__ import annotations

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_coordinate, checked_size
from ramtek_emu.errors import InstructionError
from ramtek_emu.instruction_set.instruction import OperandValue, encode, normal
from ramtek_emu.instruction_set.table import Flags


def write_text(
    text: str | bytes,
    left: int,
    top: int,
    word: int | None = None,
    background: int | None = None,
    size: int | tuple[int, int] = 1,
    transparent: bool = False,
) -> Words:
    """WT: write text in cells of 7 x 9 dots, the top-left corner of the first cell at (left, top).

    `size` repeats each dot, as one number or as (across, down); `transparent` leaves the pixels between the
    dots unchanged. The window, the words and the size stay set. Characters that are not ASCII become question
    marks.
    """
    if not isinstance(text, str | bytes | bytearray):
        raise InstructionError(
            f"text must be a str or bytes, not {type(text).__name__}; write str() around it"
        )
    data = text.encode("ascii", "replace") if isinstance(text, str) else bytes(text)
    across, down = checked_size(size)
    left, top = (checked_coordinate(each, "the corner of text") for each in (left, top))
    window = (left, top, left + 7 * across * max(1, len(data)) - 1, top + 9 * down - 1)
    operands: dict[str, OperandValue | None] = {
        "foreground": word,
        "background": background,
        "window": window,
        "scan_order": 0,
        "dimensions": (7, 9),
        "spacing": (0, 0),
        "scale": (down - 1) << 8 | (across - 1),
    }
    packed = np.frombuffer(data + bytes(len(data) % 2), ">u2").astype(np.uint16)
    return encode(normal("WT", operands, packed, len(data), Flags.ADDITIVE if transparent else 0))
