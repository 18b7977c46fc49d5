from __future__ import annotations

from dataclasses import replace

import numpy as np

from ramtek_emu import instructions
from ramtek_emu.inspection import panels
from ramtek_emu.inspection.histories import EntryRange
from ramtek_emu.inspection.listing import LONGEST_MEANING, meaning_of
from ramtek_emu.inspection.panels import wrapped
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.monitor.boxes import GRAY, ORANGE, WHITE, Span
from tests.ramtek_emu.inspection.sessions import Served, at_rest, session_of, text_of
from tests.ramtek_emu.recorded_streams import listing, words
from tests.small import BOXES_STREAM


def test_a_long_meaning_is_cut_and_an_illegal_word_is_raw() -> None:
    session = session_of(instructions.write_image(np.arange(117).reshape(9, 13)), [0xFFFF])
    texts = [meaning_of(session.replay.stream, number) for number in (1, 2)]
    assert len(texts[0]) == LONGEST_MEANING
    assert texts[1] == "raw FFFF ; begins no instruction"


def test_long_lines_of_a_listing_are_wrapped_and_nothing_is_lost() -> None:
    stream = words("0A0F 80C1 0020 00FF 0000 0000 027F 01DF 0000 000A 0001 0001 0004 0100 0302")
    lines = listing(stream.astype("<u2").tobytes())
    for width in (50, 64, 200):
        parts = list(wrapped(lines, width))
        assert all(len(part) <= width for part in parts)
        assert " ".join(parts).split() == " ".join(lines).split()
    assert parts == lines


def test_parameters_that_have_changed_since_the_last_position_are_orange() -> None:
    session = session_of(*BOXES_STREAM)
    assert {line[1].color for line in panels.parameters(session.state)} == {GRAY}
    colors = []
    for number in (1, 2, 3, 4, 5, 1, 3):
        session.go(number)
        rows = {text_of(line[:1]).strip(): line for line in panels.parameters(session.state)}
        colors.append((rows["background"][1].color, rows["next entry"][1].color))
    # Instructions 2 and 5 load an entry, the others erase.
    forward = [(ORANGE, GRAY), (WHITE, ORANGE), (ORANGE, WHITE), (ORANGE, WHITE), (WHITE, WHITE)]
    assert colors == [*forward, (WHITE, ORANGE), (ORANGE, ORANGE)]
    assert (rows["background"][1], rows["mask"][1]) == (Span("*7", ORANGE), Span(" 0xFFFF", GRAY))


def test_no_parameter_of_a_display_that_runs_is_orange() -> None:
    served = Served(session_of().display)
    session = served.inspection
    served.execute(*BOXES_STREAM)
    session.pause()
    session.go(1)
    session.go_on()
    served.execute(*BOXES_STREAM)
    assert ORANGE not in {line[1].color for line in panels.parameters(session.state)}


def test_a_history_says_up_to_which_instruction_it_is() -> None:
    session = session_of(*BOXES_STREAM)
    session.go(3)
    session.select(Window(4, 4, 4, 4))
    titles = [text_of(panels.history_title(at_rest(session).state))]
    session.go(5)
    titles.append(text_of(panels.history_title(session.state)))
    session.select(Window(4, 4, 4, 4))
    titles.append(text_of(panels.history_title(at_rest(session).state)))
    assert titles == [
        "history of pixel 4,4: 2 writes up to instruction 3",
        "history of pixel 4,4: 2 writes up to instruction 3",
        "history of pixel 4,4: 3 writes",
    ]


def test_a_pixel_is_shown_with_its_word_its_entry_and_its_color() -> None:
    session = session_of(*BOXES_STREAM)
    session.go(2)
    session.state = replace(session.state, pointed=Point(3, 4))
    session.select(Window(5, 6, 5, 6))
    pointer, selected = panels.pixels(at_rest(session).state)
    assert text_of(pointer).split() == ["pointer", "3,4", "word", "0005", "=", "5", "entry", "5", "#0A141E"]
    assert text_of(selected).split() == ["selected", "5,6", "word", "0005", "=", "5", "entry", "5", "#0A141E"]
    assert pointer[2].background == 0x0A141E
    session.state = replace(session.state, pointed=EntryRange(5, 6))
    session.select(EntryRange(5, 8))
    assert [text_of(line).split() for line in panels.pixels(session.state)] == [
        ["pointer", "entry", "5", "#0A141E"],
        ["selected", "entries", "5", "to", "7"],
    ]


def test_the_title_says_whether_a_host_runs_and_what_is_incomplete() -> None:
    served = Served(session_of(BOXES_STREAM[0]).display)
    session = served.inspection
    assert text_of(panels.title(session.state)) == "instruction 0 of 0  running"
    session.pause()
    assert text_of(panels.title(session.state)) == "instruction 0 of 0  paused"
    assert (
        text_of(panels.title(session_of(BOXES_STREAM[0], BOXES_STREAM[2][:4]).state))
        == "instruction 0 of 1  4 words of the next"
    )


def test_cursors_and_the_reply_that_reads_them_are_shown() -> None:
    session = session_of(instructions.write_cursor(0, 3, 4), instructions.read_cursor(0))
    session.go(2)
    assert text_of(panels.cursors(session.state)[0]).split() == ["cursor", "0", "3,4", "visible"]
    assert text_of(panels.words_of_the_instruction(session.state, 9, 64)[-1]) == "reply  0003 0404"


def test_what_does_not_fit_by_one_row_or_one_word_ends_in_periods() -> None:
    image = instructions.write_image(np.arange(48).reshape(6, 8))
    reply, _ = next(instructions.read_image(0, 0, 8, 6))
    session = session_of(image, reply)
    session.go(1)
    texts = [text_of(line) for line in panels.words_of_the_instruction(session.state, 1000, 64)]
    rows = len(texts)
    assert [text_of(line) for line in panels.words_of_the_instruction(session.state, rows, 64)] == texts
    cut = [text_of(line) for line in panels.words_of_the_instruction(session.state, rows - 1, 64)]
    assert cut == [*texts[: rows - 2], "       ..."]
    # All 48 words of a reply take 7 + 48 * 5 characters, and the last of them needs no gap.
    session.go(2)
    words = " ".join(f"{word:04X}" for word in range(48))
    last = text_of(panels.words_of_the_instruction(session.state, 9, 7 + 48 * 5 + len(" .. 48 words"))[-1])
    assert last == f"reply  {words}"
    last = text_of(panels.words_of_the_instruction(session.state, 9, 6 + 48 * 5 + len(" .. 48 words"))[-1])
    assert last == f"reply  {words[:-5]} .. 48 words"
