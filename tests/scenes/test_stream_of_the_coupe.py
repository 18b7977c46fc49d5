"""The words of a session with the coupe, stopped anywhere."""

from __future__ import annotations

from io import BytesIO
from random import Random

import numpy as np

import autocolor
from autocolor import Studio
from ramtek_emu import Ramtek9300, Recorder
from ramtek_emu.inspection.histories import finished, next_change, writes_to_entry, writes_to_pixel
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME
from ramtek_emu.snapshot import snapshot_bytes
from tests.scenes.test_coupe import SCENES

LOAD = FORMAT_OF_NAME["LAM"].opcode


def test_a_picture_is_sent_once_and_a_recoloring_loads_the_table_alone() -> None:
    sent, display = BytesIO(), Ramtek9300()
    studio = Studio(autocolor.read_scene(SCENES / "coupe"), Recorder(sent, display))
    whole = len(sent.getvalue()) // 2
    studio.recolor("body", object_color="#107040")
    words = np.frombuffer(sent.getvalue(), "<u2").astype(np.uint16)
    stream = Stream(words=words)
    replay = Replay(stream)
    while replay.prepare_for(1.0):
        pass
    for number in [*Random(1983).choices(range(len(stream) + 1), k=5), len(stream)]:
        fresh = Ramtek9300()
        fresh.send(stream.words_between(0, number))
        replay.go_to(number)
        assert snapshot_bytes(replay.display) == snapshot_bytes(fresh)
    assert (replay.display.field() == display.field()).all()

    # After the last write of the picture no instruction writes a pixel, and an entry of the body is loaded.
    before = int(np.searchsorted(stream.ends, whole))
    assert set(stream.opcodes[before:].tolist()) == {LOAD}
    assert finished(next_change(replay, display.frame_buffer.window, before)) is None
    body = studio.level_ranges["body"]
    line, element = np.argwhere((display.words >= body.first) & (display.words <= body.last))[0].tolist()
    writes = finished(writes_to_pixel(replay, line, element, len(stream)))
    assert writes[-1].after == display.words[line, element]
    assert writes[-1].number <= before
    last = finished(writes_to_entry(replay, int(display.words[line, element]), len(stream)))[-1]
    assert last.number > before
    assert last.after == int(display.lookup_table.packed[display.words[line, element]])
