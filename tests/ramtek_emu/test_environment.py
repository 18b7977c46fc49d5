"""Parameters, status and what is shown; and streams that nobody would send."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import GMR_9300, JPL_9460, NCAR_9460, PRINCETON_9300, Configuration, Ramtek9300, instructions
from ramtek_emu.instruction_set.table import FORMATS, OPERANDS
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.strategies import SMALL, quick, sent_words, thorough


@quick
@given(st.dictionaries(st.sampled_from(sorted(OPERANDS)), st.integers(0, 0xFFFF)))
def test_parameters_are_read_as_they_were_set(chosen: dict[str, int]) -> None:
    display = Ramtek9300()
    operands = {
        name: [(seed + 77 * place) & 0x7FFF for place in range(OPERANDS[name].words)]
        for name, seed in chosen.items()
    }
    for name in ("conic",):
        if name in operands:
            operands[name] = [0, 9, 0, 8, 0xFFFF, 0xFFF0, 0, 4, 1, 2, 0, 1]
    display.send(instructions.set_parameters(**operands))
    flag_words = [
        sum(1 << bit for bit, name in enumerate(names) if name in operands)
        for names in (list(OPERANDS)[:16], list(OPERANDS)[16:])
    ]
    display.send(sent_words([0x2406, *flag_words]))
    names = [name for name in OPERANDS if name in operands] or list(OPERANDS)
    received = display.receive(display.processor.waiting).tolist()
    if operands:
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


def test_environments_beyond_the_most_are_flagged_and_not_kept() -> None:
    display = Ramtek9300()
    display.send(np.full(5000, 0x1300, np.uint16))
    assert len(display.processor.saved) == 16
    assert Status.ILLEGAL in display.status
    display.send(instructions.initialize())
    assert not display.processor.saved


def test_the_error_status_is_read_and_cleared() -> None:
    display = Ramtek9300()
    display.send(sent_words([0xFFFF, 0x2500, 0x2500]))
    assert display.receive(2).tolist() == [Status.ILLEGAL, 0]
    assert display.status == Status.READY


@pytest.mark.parametrize(
    "format", [format for format in FORMATS if format.unimplemented], ids=lambda format: format.name
)
def test_what_is_known_by_name_only_is_consumed_and_flagged(format: object) -> None:
    display = Ramtek9300()
    opcode = format.opcode  # type: ignore[attr-defined]
    display.send(sent_words([opcode << 8 | 3, 2, 5, 4, 0x0500, 0x0600, 0x0902, 0x44, 3, 0, 0, 1, 1]))
    assert display.status == Status.READY | Status.ILLEGAL
    assert display.processor.unimplemented == 1
    assert display.processor.parameters.foreground == 5
    assert (display.words[:2, :2] == 3).all()


@pytest.mark.parametrize(
    "format", [format for format in FORMATS if format.extended], ids=lambda format: format.name
)
def test_what_the_9460_brought_is_illegal_on_the_9300(format: object) -> None:
    display = Ramtek9300(PRINCETON_9300)
    opcode = format.opcode  # type: ignore[attr-defined]
    display.send(sent_words([opcode << 8]))
    assert display.status == Status.READY | Status.ILLEGAL
    assert display.processor.illegal_words == 1
    assert not display.decoder.held_words


def twin_field(
    words: NDArray[np.uint16],
    shown: tuple[int, int],
    origin: tuple[int, int],
    zoom: tuple[int, int],
    up: bool,
) -> list[list[int]]:
    """The word shown at each pixel of the screen, found one by one."""
    lines, elements = words.shape
    field = []
    for line in range(shown[0]):
        from_origin = shown[0] - 1 - line if up else line
        row = (origin[1] + from_origin // zoom[1]) % lines
        field.append([int(words[row, (origin[0] + x // zoom[0]) % elements]) for x in range(shown[1])])
    return field


@thorough
@given(
    st.integers(1, 13), st.integers(1, 9), st.tuples(*[st.integers(-0x8000, 0x7FFF)] * 2),
    st.tuples(*[st.integers(1, 16)] * 2), st.booleans(),
)  # fmt: skip
def test_what_is_shown_follows_origin_zoom_and_video_origin(
    elements: int, lines: int, origin: tuple[int, int], zoom: tuple[int, int], up: bool
) -> None:
    display = Ramtek9300(replace(SMALL, visible_elements=elements, visible_lines=lines))
    words = np.arange(117).reshape(9, 13)
    display.send(instructions.load_entries(0, np.repeat(np.arange(117)[:, np.newaxis], 3, axis=1)))
    display.send(instructions.write_image(words))
    display.field()
    display.send(instructions.set_parameters(origin=origin))
    display.send(sent_words([0x2600, zoom[1] - 1 << 8 | zoom[0] - 1, 0x2700 | up]))
    twin = twin_field(display.words, (lines, elements), origin, zoom, up)
    assert display.field()[..., 0].tolist() == twin
    display.send(sent_words([0x0802, 0x0040, 3, 3, 9, 7, 0x0902, 4, 99]))
    twin = twin_field(display.words, (lines, elements), origin, zoom, up)
    assert display.field()[..., 0].tolist() == twin


def test_a_black_and_white_monitor_sees_the_low_eight_bits() -> None:
    display = Ramtek9300(replace(PRINCETON_9300, monochrome=True))
    # The first table of cmap: each word its own number.
    display.send(sent_words([0x0300, 0, 2048, *range(1024)]))
    display.send(instructions.write_image(np.arange(1024).reshape(2, 512)))
    field = display.field()[:2, :512].reshape(-1, 3)
    assert (field == (np.arange(1024) & 0xFF)[:, np.newaxis]).all()
    wide = Ramtek9300(replace(GMR_9300, monochrome=True))
    wide.send(instructions.load_entries(0, [[10, 20, 30]]))
    assert wide.field()[0, 0].tolist() == [30, 30, 30]


@pytest.mark.parametrize("configuration", [JPL_9460, NCAR_9460])
def test_four_sections_of_the_table_are_picked_by_the_pointer(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    for section in range(4):
        color = [10 * section + 1, 10 * section + 2, 10 * section + 3]
        # Section s lies at word (s - 1) * 200h; 1024 bytes each.
        display.send(
            sent_words([0x2901, 0x0300, 0x200 * section, 1024, *([color[1] << 8 | color[2], color[0]] * 256)])
        )
    for section in (2, 0, 3, 1):
        display.send(sent_words([0x0300, 0x200 * section, 0]))
        assert display.field()[5, 5].tolist() == [10 * section + 1, 10 * section + 2, 10 * section + 3]


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300, NCAR_9460])
def test_random_words_leave_a_display_that_works(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    random = np.random.default_rng(1983)
    for _ in range(5):
        display.send(random.integers(0, 0x10000, 100_000).astype(np.uint16))
        assert display.words.max() <= configuration.largest_word
        display.field()
    display.reset()
    assert not display.words.any()
    picture = random.integers(0, 256, (480, 640))
    display.send(instructions.write_image(picture))
    assert (display.words[:480, :640] == picture).all()
    assert display.processor.waiting == 0


WORST = {
    "lines across everything": [0x0E01, 65528, *[0x8000, 0x8000, 0x7FFF, 0x7FFF] * 8191],
    "texture across everything": [0x0E05, 8, 0xAAAA, 0, 65528, *[0x8000, 0x8000, 0x7FFF, 0x7FFF] * 8191],
    "giant text in a small window": [
        0x0C23,
        0x0740,
        9,
        9,
        9,
        9,
        16,
        16,
        0,
        0,
        0x0F0F,
        65534,
        *[0x4142] * 32767,
    ],
    "text in the narrowest window": [0x0C03, 0x0040, 9, 0x8000, 9, 0x7FFF, 65534, *[0x4142] * 32767],
    "rasters in one pixel": [0x0D23, 0x0040, 9, 9, 9, 9, 65534, *[0x5555] * 32767],
    "images in one pixel": [0x0A03, 0x0040, 9, 9, 9, 9, 65534, *[3] * 32767],
    "images in the largest window": [0x0A03, 0x0040, 0x8000, 0x8000, 0x7FFF, 0x7FFF, 65534, *[3] * 32767],
    "erasing the largest window": [0x0902, 0x0040, 0x8000, 0x8000, 0x7FFF, 0x7FFF],
    "copying the largest window": [0x6903, 0x0040, 0x8000, 0x8000, 0x7FFF, 0x7FFF, 4, 5, 5],
    "circles": [0x6D01, 65532, *[320, 240, 200] * 10922],
    "circles of any size": [0x6D01, 65532, *range(32766)],
    "a conic without an end": [0x0F02, 0x1000, *[0] * 9, 1, 0, 0],
    "a conic of large numbers": [0x0F02, 0x1000, *[0x7FFF] * 12],
    "filling": [0x3A02, 0x8002, 5, 3, 3],
}


@pytest.mark.parametrize("name", WORST)
def test_no_instruction_takes_long(name: str) -> None:
    display = Ramtek9300()
    display.send(sent_words([*WORST[name], 0x0700]))
    assert display.decoder.held_words == 0
    assert display.words.max() <= 1023
