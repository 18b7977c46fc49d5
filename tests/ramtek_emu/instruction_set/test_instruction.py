from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from ramtek_emu import InstructionError
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.instruction import encode, normal
from ramtek_emu.testing import streams


@given(streams())
def test_an_instruction_is_equal_to_its_own_words_read_again(stream: list[int]) -> None:
    for instruction in Decoder().feed(np.array(stream, np.uint16)):
        (again,) = Decoder().feed(encode(instruction))
        assert again == instruction
        assert hash(again) == hash(instruction)
        assert str(again) == str(instruction)


def test_an_instruction_has_at_most_65535_bytes_of_data() -> None:
    for length in (0, 65534, 65535):
        assert normal("WI", {}, length=length).length == length
    for length in (-1, 65536):
        with pytest.raises(InstructionError, match=f"the data of WI must be 0 to 65535 bytes, not {length};"):
            normal("WI", {}, length=length)


def test_a_listing_names_operands_and_flags() -> None:
    assert str(normal("SET", {"mask": 15, "window": (0, 0, 9, 9)})) == "SET  mask 15; window 0, 0, 9, 9"
    (text,) = Decoder().feed(np.array([0x0C13, 0x0040, 0, 0, 32, 32, 3, 0x3030, 0x3400], np.uint16))
    assert str(text) == "WT   BK; window 0, 0, 32, 32; 3 bytes"
    assert text.data_bytes() == b"004"


def test_an_instruction_is_shown_by_its_name_and_operands() -> None:
    shown = repr(normal("WVL", {"foreground": 1, "start": (10, 20)}, np.array([30, 40], np.uint16)))
    assert shown == "Instruction('WVL  foreground 1; start 10, 20; 4 bytes')"
