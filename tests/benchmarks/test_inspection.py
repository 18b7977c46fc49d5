from __future__ import annotations

from benchmarks.inspection import drawing, figures, text
from benchmarks.targets import MISSED
from ramtek_emu.inspection.stream import Stream


def test_the_stream_has_every_kind_of_instruction() -> None:
    stream = Stream(words=drawing(5000))
    assert 5000 <= len(stream.words) == stream.ends[-1]
    assert {0x03, 0x09, 0x0A, 0x0C, 0x0E} <= set(stream.opcodes.tolist())


def test_the_figures_of_a_short_stream() -> None:
    found = {"short": figures(5000, jumps=2)}
    assert found["short"]["instructions"] == len(Stream(words=drawing(5000)))
    measured = {
        "streams": found,
        "targets": [{"target": "jumps", "bound": 50.0, "verdict": MISSED}],
    }
    assert text(measured).endswith("missed: jumps")
