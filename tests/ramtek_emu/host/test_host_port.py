from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ramtek_emu import (
    HostPort,
    Ramtek9300,
    Recorder,
    ReplyError,
    WordsError,
    instructions,
)


def test_a_recording_holds_every_word_low_byte_first() -> None:
    file = BytesIO()
    port: HostPort = Recorder(file)
    port.send(np.array([0x0802, 0x0002], np.uint16))
    port.send(np.array([0x1234], np.uint16))
    assert file.getvalue() == b"\x02\x08\x02\x00\x34\x12"


def test_a_recording_played_again_gives_the_same_words() -> None:
    file, display = BytesIO(), Ramtek9300()
    port = Recorder(file, display)
    port.send(instructions.write_text("again", 30, 40, 9, 3))
    again = Ramtek9300()
    again.send(np.frombuffer(file.getvalue(), "<u2"))
    assert display.words.any()
    assert (again.words == display.words).all()


def test_a_recording_answers_through_the_port_behind_it() -> None:
    port = Recorder(BytesIO(), Ramtek9300())
    port.send(np.array([0x0B03, 0x0040, 0, 0, 1, 0, 4], np.uint16))
    assert port.receive(2).tolist() == [0, 0]
    with pytest.raises(ReplyError) as refusal:
        Recorder(BytesIO()).receive(2)
    assert str(refusal.value) == (
        "a recording must have a display behind it to give words, not none (2 asked); give Recorder a port"
    )


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([70000], "a word of a stream must be 0 to 65535, not 70000 (word 0); mask it to 16 bits"),
        ([1, -1], "a word of a stream must be 0 to 65535, not -1 (word 1); mask it to 16 bits"),
        ([[1]], "a stream of words must be one row, not of shape (1, 1); flatten it first"),
        ([1.5], "a stream of words must be whole numbers, not float64; convert them first, rounding half up"),
        ("text", "a stream of words must be whole numbers, not text; pass a list or an array of them"),
    ],
)
def test_what_is_no_stream_of_words_is_refused_by_name(words: Any, sentence: str) -> None:
    display = Ramtek9300()
    for port in (display, Recorder(BytesIO())):
        with pytest.raises(WordsError) as refusal:
            port.send(words)
        assert str(refusal.value) == sentence


def test_streams_of_either_byte_order_and_any_whole_type_are_taken() -> None:
    for stream in ([0x0802, 2, 5], np.array([0x0802, 2, 5], ">u2"), np.array([0x0802, 2, 5], np.int64)):
        display = Ramtek9300()
        display.send(np.asarray(stream))
        assert display.processor.parameters.foreground == 5
    Ramtek9300().send(np.array([]))


def test_a_recorder_tells_its_file_and_its_display(tmp_path: Path) -> None:
    with open(tmp_path / "words", "wb") as file:
        assert repr(Recorder(file)) == f"Recorder({tmp_path / 'words'})"
    assert repr(Recorder(BytesIO(), Ramtek9300())).startswith("Recorder(BytesIO, Ramtek9300(GMR_9300, ")
