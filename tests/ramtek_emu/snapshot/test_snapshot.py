from __future__ import annotations

import random
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from PIL import Image

from ramtek_emu import (
    GMR_9300,
    PRINCETON_9300,
    MissingInputError,
    OutputExistsError,
    Ramtek9300,
    RamtekError,
    SnapshotError,
    instructions,
    read_snapshot,
    write_snapshot,
)
from ramtek_emu.configuration import CONFIGURATIONS
from ramtek_emu.monitor.pattern import pattern
from ramtek_emu.snapshot.png_chunks import picture_bytes, picture_of
from ramtek_emu.snapshot.snapshot import display_of, snapshot_bytes
from ramtek_emu.timing import Timing
from tests.ramtek_emu.recorded_streams import BYTE_IMAGE, DECODED, OUTLINE, words
from tests.ramtek_emu.snapshots import CURSORS, SNAPSHOT, texts_of, with_text
from tests.ramtek_emu.strategies import SMALL, streams, thorough


def same(one: Ramtek9300, other: Ramtek9300) -> None:
    assert (one.words == other.words).all()
    assert (one.entries == other.entries).all()
    assert (one.field() == other.field()).all()
    assert one.configuration == other.configuration
    assert one.status == other.status
    assert one.processor.parameters == other.processor.parameters
    assert snapshot_bytes(one) == snapshot_bytes(other)


@pytest.mark.parametrize("name", sorted(CONFIGURATIONS))
def test_a_snapshot_read_back_is_the_same_display(name: str) -> None:
    configuration = CONFIGURATIONS[name]
    display = Ramtek9300(configuration)
    for stream in (pattern(configuration), OUTLINE, DECODED, BYTE_IMAGE, CURSORS, words("0001 1300 13FF")):
        display.send(stream)
    display.decoder.clear()
    again = display_of(snapshot_bytes(display))
    same(display, again)
    for one in (display, again):
        one.send(words("1400 0C01 0002 4142 0E01 0004 0005 0005 0500"))
        one.send(OUTLINE)
    same(display, again)


@thorough
@given(streams(), streams())
def test_after_any_words_a_snapshot_goes_on_as_the_display_does(before: list[int], after: list[int]) -> None:
    display = Ramtek9300(SMALL)
    display.send(np.array(before, np.uint16))
    again = display_of(snapshot_bytes(display))
    # What a host left unfinished is in no snapshot.
    display.decoder.clear()
    same(display, again)
    display.receive(display.processor.waiting)
    for one in (display, again):
        one.send(np.array(after, np.uint16))
    same(display, again)
    count = display.processor.waiting
    assert display.receive(count).tolist() == again.receive(count).tolist()


def test_time_goes_on_where_it_was() -> None:
    configuration = replace(GMR_9300, timing=Timing(pixel=900))
    display = Ramtek9300(configuration)
    display.send(instructions.load_entries(0, [[200, 0, 0]] * 1024))
    # One image after another until the beam is in the middle of a field.
    dot, half = instructions.write_image([[5] * 100]), 240
    assert display.beam is not None
    while not half < display.beam.line < 300:
        display.send(dot)
    display.send(instructions.load_entries(0, [[0, 0, 200]] * 1024))
    assert display.field()[[0, 479], 300].tolist() == [[200, 0, 0], [0, 0, 200]]
    again = display_of(snapshot_bytes(display))
    same(display, again)
    for one in (display, again):
        one.send(OUTLINE)
    same(display, again)


def test_a_snapshot_is_a_picture_that_others_read(tmp_path: Path) -> None:
    display = Ramtek9300(PRINCETON_9300)
    display.send(OUTLINE)
    write_snapshot(display, tmp_path / "snapshot.png")
    with Image.open(tmp_path / "snapshot.png") as picture:
        assert picture.size == (640, 512)
        assert (np.asarray(picture) == display.words).all()
        assert picture.info["Software"] == "ramtek_emu snapshot 1"
    same(display, read_snapshot(tmp_path / "snapshot.png"))
    with pytest.raises(OutputExistsError):
        write_snapshot(display, tmp_path / "snapshot.png", overwrite=False)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path / "none.png", tmp_path):
        with pytest.raises(MissingInputError):
            read_snapshot(path)


@pytest.mark.parametrize("text", ["", "null", "[" * 100_000, "{}", "9" * 5000, '{"now":1,"now":2}', "NaN"])
@pytest.mark.parametrize("keyword", ["configuration", "lookup table", "parameters", "processor", "cursors"])
def test_a_text_that_is_no_state_is_refused(keyword: str, text: str) -> None:
    with pytest.raises(SnapshotError):
        display_of(with_text(keyword, text))


def test_mutated_snapshots_are_read_or_refused() -> None:
    draw = random.Random(9300)
    picture, texts = picture_of(SNAPSHOT)
    accepted = 0
    for _ in range(600):
        keyword = draw.choice(sorted(texts))
        text = bytearray(texts[keyword].encode())
        for _ in range(draw.randint(1, 3)):
            text[draw.randrange(len(text))] = draw.choice(b'0123456789",:[]{}-eE.nt')
        try:
            display = display_of(picture_bytes(picture, texts | {keyword: text.decode()}))
        except SnapshotError:
            continue
        # What is taken works.
        accepted += 1
        display.send(OUTLINE)
        display.field()
        display_of(snapshot_bytes(display))
    assert accepted > 50
    for _ in range(600):
        data = bytearray(SNAPSHOT)
        for _ in range(draw.randint(1, 4)):
            data[draw.randrange(len(data))] = draw.randrange(256)
        with pytest.raises(RamtekError):
            display_of(bytes(data[: draw.choice((len(data), draw.randrange(len(data))))]))


def test_a_snapshot_shows_itself_to_pillow_with_its_texts() -> None:
    with Image.open(BytesIO(SNAPSHOT)) as picture:
        picture.load()
        assert sorted(picture.info) == sorted(texts_of(SNAPSHOT))


def test_a_snapshot_of_no_display_is_refused_before_a_file_is_made(tmp_path: Path) -> None:
    path = tmp_path / "display.png"
    with pytest.raises(SnapshotError) as refusal:
        write_snapshot(str(path), Ramtek9300())  # type: ignore[arg-type]
    assert str(refusal.value) == (
        "a snapshot must be of a Ramtek9300, not of a str; give the display first, then the path"
    )
    assert not path.exists()
