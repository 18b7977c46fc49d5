from __future__ import annotations

from ramtek_emu import instructions
from tests.ramtek_emu.displays import box, sent


def test_operands_stay_until_they_are_set_again() -> None:
    display = sent("0802 0004 0007", "0902 0040 0001 0001 0002 0002", "0900")
    assert display.words[1:3, 1:3].tolist() == [[7, 7], [7, 7]]
    assert display.frame_buffer.written == 8
    display.send(instructions.reset())
    display.send(instructions.erase())
    assert not display.words.any()


def test_addresses_count_from_index_registers_and_the_operating_point() -> None:
    display = sent("0802 0008 0005 0006", "0942 0044 0003 0000 0000 0001 0000")
    assert box(display) == (5, 6, 6, 6)
    display = sent("0802 0010 0009 0007", "0982 0044 0003 FFFF 0000 0000 0000")
    assert box(display) == (8, 7, 9, 7)
    # The text window of wtr() lies at the operating point.
    display = sent("0802 8000 0014 001E", "09C2 0044 0003 0000 0000 0006 0008")
    assert box(display) == (20, 30, 26, 38)
