"""The whole display: streams of the time, streams that no program would send, and the switches."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from ramtek_emu import (
    FAMILY,
    NCAR_9460,
    PRINCETON_9300,
    Configuration,
    Ramtek9300,
    ReplyError,
    Timing,
    instructions,
)
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.testing import streams
from tests.ramtek_emu.displays import smallest_slices
from tests.ramtek_emu.recorded_streams import RECORDED
from tests.ramtek_emu.strategies import SLICED, SMALL, cuts, drawing_instructions, sent_words


@given(streams(200), st.lists(st.integers(0, 200), max_size=5))
def test_no_words_at_all_raise_or_leave_the_planes(stream: list[int], places: list[int]) -> None:
    whole = Ramtek9300(SMALL)
    whole.send(np.array(stream, np.uint16))
    assert whole.words.max() <= SMALL.largest_word
    assert whole.field().shape == (9, 13, 3)
    cut = Ramtek9300(SMALL)
    for piece in cuts(stream, places):
        cut.send(piece)
    assert (cut.words == whole.words).all()
    assert (cut.entries == whole.entries).all()
    assert cut.status == whole.status
    assert cut.processor.parameters == whole.processor.parameters
    assert cut.processor.waiting == whole.processor.waiting
    assert (cut.receive(cut.processor.waiting) == whole.receive(whole.processor.waiting)).all()


EVERYWHERE = [0x8000, 0x8000, 0x7FFF, 0x7FFF]
ONE_PIXEL = [0x0040, 9, 9, 9, 9]
LONG = {
    "textured lines across everything": [0x0E05, 8, 0xAAAA, 0, 4096, *EVERYWHERE * 512],
    "giant text in a window": [0x0C23, 0x0740, *[9] * 4, 16, 16, 0, 0, 0x0F0F, 65534, *[0x4142] * 32767],
    "giant text": [0x0C03, 0x0700, 16, 16, 0, 0, 0x0F0F, 65534, *[0x4142] * 32767],
    "text in the narrowest window": [0x0C03, 0x0040, 9, 0x8000, 9, 0x7FFF, 65534, *[0x4142] * 32767],
    "rasters in one pixel": [0x0D23, *ONE_PIXEL, 65534, *[0x5555] * 32767],
    "images in one pixel": [0x0A03, *ONE_PIXEL, 65534, *[3] * 32767],
    "images in the largest window": [0x0A03, 0x0040, *EVERYWHERE, 65534, *[3] * 32767],
    "erasing some planes": [0x0902, 0x0041, 0x55, *EVERYWHERE],
    "erasing everything": [0x2B02, 1, 0x55],
    "a reset": [0x0500],
    "copying the largest window": [0x6903, 0x0040, *EVERYWHERE, 4, 5, 5],
    "circles": [0x6D01, 3000, *[320, 240, 200] * 500],
    "circles of any size": [0x6D01, 3000, *range(1500)],
    "a conic without an end": [0x0F02, 0x1000, *[0] * 9, 1, 0, 0],
    "a conic of large numbers": [0x0F02, 0x1000, *[0x7FFF] * 12],
    "bars across everything": [0x1003, 0x2100, 0x7FFF, 0, 0, 65534, *[0x7FFF] * 32767],
    "filling": [0x3A02, 0x8002, 5, 3, 3],
}


@pytest.mark.parametrize("name", LONG)
def test_between_two_pauses_an_instruction_writes_a_quarter_of_a_large_memory_at_most(name: str) -> None:
    display = Ramtek9300(replace(FAMILY, elements=2048, lines=1024))
    steps = display.send_stepwise(sent_words([*LONG[name], 0x0700]))
    written = [0, *(display.frame_buffer.written for _ in steps)]
    assert display.decoder.pending_words == 0
    assert np.diff(written).max() <= display.words.size // 4


@given(
    st.lists(drawing_instructions(SLICED), min_size=1, max_size=4), st.sampled_from([None, Timing(line=9000)])
)
def test_slices_leave_the_display_that_an_instruction_in_one_piece_leaves(
    parts: list[NDArray[np.uint16]], timing: Timing | None
) -> None:
    configuration = replace(SMALL, timing=timing)
    whole, sliced = Ramtek9300(configuration), Ramtek9300(configuration)
    ends = np.cumsum([len(part) for part in parts]).tolist()
    pauses: list[int] = []
    for part in parts:
        whole.send(part)
    with smallest_slices():
        for executed in sliced.send_stepwise(np.concatenate(parts)):
            pauses.append(executed)
            assert sliced.words.max() <= SMALL.largest_word
            sliced.field()
    assert (sliced.words == whole.words).all()
    assert sliced.processor.parameters == whole.processor.parameters
    assert (sliced.field() == whole.field()).all()
    assert pauses == sorted(pauses)
    assert sorted(set(pauses) - {0}) == ends


PATH = [(1, 1), (11, 1), (11, 3), (60, 60), (4, 7), (4, 7), (0, 2), (12, 8)]


def test_a_reset_within_an_instruction_abandons_the_rest_of_it() -> None:
    display, twin = Ramtek9300(SMALL), Ramtek9300(SMALL)
    drawn = instructions.write_vectors(PATH, 9)
    after = instructions.write_vectors([(3, 3), (5, 5)], 7)
    with smallest_slices():
        steps = display.send_stepwise(np.concatenate((drawn, after)))
        assert (next(steps), next(steps)) == (0, 0)
        assert display.words.any()
        display.reset()
        assert not display.words.any()
        assert next(steps) == len(drawn)
        assert not display.words.any()
        assert list(steps)[-1] == len(drawn) + len(after)
    twin.send(after)
    assert display.words.tolist() == twin.words.tolist()
    assert display.processor.parameters == twin.processor.parameters


def test_the_reset_switch_hides_the_cursors_and_drops_unfinished_words() -> None:
    display = Ramtek9300()
    stream = sent_words([0x1600, 5, 0x406, 0x1700, 0x0802, 2, 9, 0x0A01, 0xFFFF, 1, 2, 3])
    display.send(stream)
    assert display.decoder.pending_words
    assert repr(display) == "Ramtek9300(GMR_9300, 640 x 480 x 10 bits, 1024 entries, 12 words received)"
    display.reset()
    # Pressing RESET is no word of a host.
    assert display.words_received == len(stream)
    assert not display.cursors[0].is_visible
    assert not display.decoder.pending_words
    assert not display.processor.waiting
    assert display.processor.parameters.foreground == 1023
    display.send(instructions.write_image([[7]]))
    assert display.words[0, 0] == 7


def test_a_display_shows_itself_in_a_notebook_and_in_a_file(tmp_path: Path) -> None:
    display = Ramtek9300()
    display.send(instructions.load_entries(0, [[10, 20, 30]]))
    display.save_png(tmp_path / "display.png")
    assert (tmp_path / "display.png").read_bytes() == display._repr_png_()
    with Image.open(tmp_path / "display.png") as picture:
        assert picture.size == (640, 480)
        assert picture.getpixel((5, 5)) == (10, 20, 30)


def busy_display(configuration: Configuration) -> Ramtek9300:
    """A display with state in all of its parts, in the middle of an instruction."""
    display = Ramtek9300(configuration)
    display.send(instructions.write_image(np.arange(480 * 640).reshape(480, 640) % 200))
    display.send(sent_words([0x0300, 0, 12, 0x1234, 0x0056, 0x789A, 0x00BC, 0x0DEF, 3]))
    display.send(sent_words([0x0802, 0x8003, 0x00F7, 77, 40, 50, 0x1300, 0x0802, 0x0020, 3, 4]))
    display.send(sent_words([0x1541, *[0x8142] * 6, 0x1600, 30, 0x0414, 0x1700, 0x0500 + 0xFF00]))
    display.joystick.press_enter()
    display.send(sent_words([0x0A03, 0x0040, 2, 3, 4, 5, 12, 1, 2, 3]))
    return display


COPIES: list[Callable[[Ramtek9300], Ramtek9300]] = [
    copy.deepcopy,
    lambda display: pickle.loads(pickle.dumps(display)),
]
EVERY_KIND = [
    FAMILY,
    PRINCETON_9300,
    replace(FAMILY, timing=Timing()),
    replace(NCAR_9460, monochrome=True),
]


@pytest.mark.parametrize("copied", COPIES, ids=["deepcopy", "pickle"])
@pytest.mark.parametrize("configuration", EVERY_KIND, ids=range(4))
def test_a_copy_of_a_display_goes_on_as_the_display_does_and_shares_nothing(
    configuration: Configuration, copied: Callable[[Ramtek9300], Ramtek9300]
) -> None:
    display = busy_display(configuration)
    display.field()
    twin = copied(display)
    before = snapshot_bytes(display)
    rest = sent_words([4, 5, 6, 0x1700, 0x1400, 0x0C01, 2, 0x4142])
    display.send(rest)
    assert snapshot_bytes(twin) == before
    twin.send(rest)
    assert snapshot_bytes(twin) == snapshot_bytes(display)
    assert (twin.field() == display.field()).all()
    assert (twin.receive(4) == display.receive(4)).all()
    assert repr(twin) == repr(display)
    assert (twin.joystick.position, twin.joystick.driven) == (display.joystick.position, (twin.cursors[0],))


def test_a_display_goes_back_to_a_state_and_drops_what_is_the_hosts() -> None:
    display = busy_display(replace(FAMILY, timing=Timing()))
    state, before = display.state(), snapshot_bytes(display)
    display.send(sent_words([4, 5, 6, 0x1600, 7, 0x0407, 0x1700, 0x0300, 0, 4, 1, 2]))
    display.joystick.press_enter()
    display.restore(state)
    assert snapshot_bytes(display) == before
    assert (display.decoder.pending_words, display.processor.waiting) == (0, 0)
    display.send(instructions.erase())
    assert (state["frame_buffer"]["words"] != display.words).any()


def test_the_arrays_of_a_copy_are_read_only_and_stay_current() -> None:
    twin = copy.deepcopy(busy_display(FAMILY))
    words, entries = twin.words, twin.lookup_table.packed
    for handed_out in (words, entries, twin.entries, characters()):
        assert not handed_out.flags.writeable
    twin.reset()
    twin.send(instructions.write_image([[7]]))
    twin.send(instructions.load_entries(7, [[1, 2, 3]]))
    assert (words[0, 0], entries[7]) == (7, 0x010203)
    assert twin.field()[0, 0].tolist() == [1, 2, 3]


@pytest.mark.parametrize("copied", COPIES, ids=["deepcopy", "pickle"])
def test_a_copy_of_a_display_within_an_instruction_does_not_finish_it(
    copied: Callable[[Ramtek9300], Ramtek9300],
) -> None:
    display = Ramtek9300(SMALL)
    with smallest_slices():
        steps = display.send_stepwise(instructions.write_vectors(PATH, 9))
        next(steps)
        twin = copied(display)
        half = twin.words.copy()
        list(steps)
    twin.send(sent_words([0x0700]))
    assert (twin.words == half).all()
    assert (display.words != half).any()


@pytest.mark.parametrize("count", [1.0, True, -1, 3])
def test_a_number_of_words_that_cannot_be_received_costs_no_reply(count: Any) -> None:
    display = Ramtek9300()
    display.send([0x1700])  # type: ignore[arg-type]
    with pytest.raises(ReplyError) as refusal:
        display.receive(count)
    assert str(refusal.value).endswith(f"0 to 2, not {count!r}; send an instruction that reads them first")
    assert display.receive(np.int64(2)).tolist() == [0, 0]  # type: ignore[arg-type]


def test_words_of_every_second_place_of_an_array_draw_the_same() -> None:
    plain, other = Ramtek9300(), Ramtek9300()
    for stream in RECORDED:
        plain.send(stream)
        other.send(np.repeat(stream, 2)[::2])
    assert snapshot_bytes(other) == snapshot_bytes(plain)
