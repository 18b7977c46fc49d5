from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import PRINCETON_9300, Ramtek9300, instructions
from ramtek_emu.instruction_set.table import FORMATS, OPERANDS, InstructionFormat
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.displays import sent
from tests.ramtek_emu.strategies import SMALL, sent_words


@given(st.lists(st.sampled_from(list(OPERANDS)), unique=True), st.integers(0, 0x7FFF))
def test_parameters_are_read_as_they_were_set(chosen: list[str], seed: int) -> None:
    display = Ramtek9300()
    operands = {
        name: [(seed + 77 * place) & 0x7FFF for place in range(OPERANDS[name].words)] for name in chosen
    }
    if "conic" in operands:
        operands["conic"] = [0, 9, 0, 8, 0xFFFF, 0xFFF0, 0, 4, 1, 2, 0, 1]
    display.send(instructions.set_parameters(**operands))
    names = [name for name in OPERANDS if name in chosen]
    bits = sum(1 << list(OPERANDS).index(name) for name in names)
    display.send(sent_words([0x2406, bits & 0xFFFF, bits >> 16]))
    received = display.receive(display.processor.waiting).tolist()
    if names:
        assert received == [word for name in names for word in operands[name]]
    else:
        assert len(received) == sum(operand.words for operand in OPERANDS.values())


def test_saved_environments_come_back_in_reverse() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x0802, 2, 5, 0x1300, 0x0802, 2, 6, 0x2600, 0x0101, 0x1300, 0x0802, 2, 7]))
    assert display.processor.parameters.foreground == 7
    display.send(sent_words([0x1400]))
    assert (display.processor.parameters.foreground, display.processor.parameters.zoom) == (6, (2, 2))
    display.send(sent_words([0x1400]))
    assert (display.processor.parameters.foreground, display.processor.parameters.zoom) == (5, (1, 1))
    assert display.status == Status.READY
    display.send(sent_words([0x1400]))
    assert display.processor.parameters.foreground == 5
    assert display.processor.status == Status.READY | Status.ILLEGAL


def test_environments_beyond_the_most_are_flagged_and_not_saved() -> None:
    display = Ramtek9300()
    display.send(np.full(16, 0x1300, np.uint16))
    assert len(display.processor.saved) == 16
    assert Status.ILLEGAL not in display.status
    display.send(np.full(5000, 0x1300, np.uint16))
    assert len(display.processor.saved) == 16
    assert Status.ILLEGAL in display.status
    display.send(instructions.initialize())
    assert not display.processor.saved


def test_zoom_and_video_origin_have_the_lowest_bits_of_their_words() -> None:
    display = Ramtek9300()
    for word, zoom in [(0, (1, 1)), (0x0102, (3, 2)), (0x0F0F, (16, 16)), (0xF3F5, (6, 4))]:
        display.send(sent_words([0x2600, word]))
        assert display.processor.parameters.zoom == zoom
    for low_byte in (1, 0, 3, 2, 0xFF, 0xFE):
        display.send(sent_words([0x2700 | low_byte]))
        assert display.processor.parameters.origin_at_bottom is bool(low_byte % 2)


def test_the_error_status_is_read_and_cleared() -> None:
    display = Ramtek9300()
    display.send(sent_words([0xFFFF, 0x2500, 0x2500]))
    assert display.receive(2).tolist() == [Status.ILLEGAL, 0]
    assert display.status == Status.READY


@pytest.mark.parametrize("row", [row for row in FORMATS if row.unimplemented], ids=lambda row: row.name)
def test_instructions_known_by_name_only_are_consumed_and_flagged(row: InstructionFormat) -> None:
    display = Ramtek9300(SMALL)
    display.send(sent_words([row.opcode << 8 | 3, 2, 5, 4, 0x0500, 0x0600, 0x0902, 0x44, 3, 0, 0, 1, 1]))
    assert display.status == Status.READY | Status.ILLEGAL
    assert display.processor.unimplemented == 1
    assert display.processor.parameters.foreground == 5
    assert (display.words[:2, :2] == 3).all()


def test_instructions_of_the_9460_are_illegal_words_on_the_9300_and_reset_clears_the_status() -> None:
    display = Ramtek9300(PRINCETON_9300)
    extended = [row for row in FORMATS if row.extended]
    for row in extended:
        display.send(instructions.reset())
        assert display.status == Status.READY
        display.send(sent_words([row.opcode << 8]))
        assert display.status == Status.READY | Status.ILLEGAL, row.name
        assert not display.decoder.pending_words
    assert display.processor.illegal_words == len(extended)


def test_initialize_restores_the_parameters_and_leaves_words_and_entries() -> None:
    display = sent("0300 0000 0002 1234", "0902 0044 0009 0000 0000 0000 0000", "0600")
    assert display.words[0, 0] == 9
    assert display.processor.parameters == Ramtek9300().processor.parameters
    display.send(instructions.reset())
    assert display.words[0, 0] == 0
    assert display.entries[0].tolist() == [0, 0x12, 0x34]
