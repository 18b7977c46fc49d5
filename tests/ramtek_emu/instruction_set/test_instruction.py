from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from ramtek_emu import InstructionError
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.instruction import encode, normal
from ramtek_emu.testing import streams
from tests.tables import call, refused


@given(streams())
def test_an_instruction_is_equal_to_its_own_words_read_again(stream: list[int]) -> None:
    for instruction in Decoder().feed(np.array(stream, np.uint16)):
        (again,) = Decoder().feed(encode(instruction))
        assert again == instruction
        assert hash(again) == hash(instruction)
        assert str(again) == str(instruction)


def test_data_and_operands_are_taken_up_to_their_limits() -> None:
    for length in (0, 65534, 65535):
        assert normal("WI", {}, length=length).length == length
    assert normal("SET", {"start": (-32768, 65535)}).operands == {"start": (0x8000, 0xFFFF)}
    assert encode(normal("SET", {"read_mask": 5, "mask": 7})).tolist() == [0x0806, 1, 1, 7, 5]


WI_BYTES = "the data of WI must be 0 to 65535 bytes, not {}; send them in several instructions"
START_NUMBERS = "start must be whole numbers from -32768 to 65535, not {}; round or clip it"
test_what_is_no_instruction = refused(
    call,
    [
        (lambda: normal("WI", {}, length=-1), WI_BYTES.format(-1)),
        (lambda: normal("WI", {}, length=65536), WI_BYTES.format(65536)),
        (lambda: normal("SET", {"start": 5}), "start must be 2 numbers, not 1; give all of them"),
        (lambda: normal("SET", {"start": (0, 65536)}), START_NUMBERS.format(65536)),
        (lambda: normal("SET", {"start": (-32769, 0)}), START_NUMBERS.format(-32769)),
        (lambda: normal("SET", {"start": (0.5, 0)}), START_NUMBERS.format(0.5)),  # type: ignore[dict-item]
    ],
)


@pytest.mark.parametrize(
    ("name", "advice"), [("foregrund", "did you mean foreground?"), ("zzz", "choose one of them")]
)
def test_an_unknown_operand_is_answered_with_the_nearest(name: str, advice: str) -> None:
    with pytest.raises(InstructionError, match=f"an operand must be one of mask, .*, not '{name}'") as caught:
        normal("SET", {name: 1})
    assert str(caught.value).endswith(f"; {advice}")


def test_a_listing_names_operands_and_flags() -> None:
    assert str(normal("SET", {"mask": 15, "window": (0, 0, 9, 9)})) == "SET  mask 15; window 0, 0, 9, 9"
    (text,) = Decoder().feed(np.array([0x0C13, 0x0040, 0, 0, 32, 32, 3, 0x3030, 0x3400], np.uint16))
    assert str(text) == "WT   BK; window 0, 0, 32, 32; 3 bytes"
    assert text.data_bytes() == b"004"
    assert repr(text) == f"Instruction({str(text)!r})"
