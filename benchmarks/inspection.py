"""What it takes to stop a stream anywhere: `python -m benchmarks inspection`.

A long stream is run plainly, and with states kept. Then fields are asked for at random instructions, as while
the bar of the inspector is dragged, and the history of a pixel. Times are of the processor; ratios are to the
plain run of the same stream.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import spread
from benchmarks.targets import MET, MISSED
from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.inspection.histories import finished, history_of
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.memory.scan_orders import Window

MILLIONS = (1, 10)
JUMPS = 200
PIXEL = Window(300, 200, 300, 200)
BOUNDS = {"MB of states a million words": 64.0, "longest jump ms": 50.0, "history": 1.5}
"""A history is bounded by its ratio to a plain run."""

Words = NDArray[np.uint16]


def drawing(count: int) -> Words:
    """At least so many words of filled boxes, vectors, text, images and table loads, in random order."""
    chance = random.Random(9300)
    words = np.random.default_rng(9300).integers(0, 1024, (9, 30))
    parts: list[Words] = []
    sent = 0
    while sent < count:
        left, top, kind = chance.randrange(500), chance.randrange(400), chance.randrange(5)
        if kind == 0:
            box = left, top, left + chance.randrange(1, 100), top + chance.randrange(1, 60)
            parts.append(instructions.erase(box, chance.randrange(1024)))
        elif kind == 1:
            vertices = [
                (chance.randrange(640), chance.randrange(480)) for _ in range(chance.randrange(2, 20))
            ]
            parts.append(instructions.write_vectors(vertices, chance.randrange(1024)))
        elif kind == 2:
            parts.append(instructions.write_text("RAMTEK 9300", left, top, chance.randrange(1024)))
        elif kind == 3:
            parts.append(instructions.write_image(words, left, top))
        else:
            colors = [(chance.randrange(256), left % 256, top % 256)] * 8
            parts.append(instructions.load_entries(chance.randrange(1000), colors))
        sent += len(parts[-1])
    return np.concatenate(parts)


def processor_seconds(run: Callable[[], object]) -> float:
    """The seconds of processor that a call takes."""
    begin = time.process_time()
    run()
    return time.process_time() - begin


def figures(count: int, jumps: int = JUMPS) -> dict[str, float]:
    """The figures of a stream of so many words."""
    words = drawing(count)
    stream = Stream()
    index_seconds = processor_seconds(lambda: stream.append(words))
    plain = processor_seconds(lambda: Ramtek9300().send(words))
    replay = Replay(stream)

    def prepare() -> None:
        while replay.prepare_for(1.0):
            pass

    def jump_to(number: int) -> Callable[[], None]:
        def jump() -> None:
            replay.go_to(number)
            replay.display.field()

        return jump

    prepared = processor_seconds(prepare)
    numbers = np.random.default_rng(1978).integers(0, len(stream) + 1, jumps).tolist()
    seconds = [processor_seconds(jump_to(number)) for number in numbers]
    history = processor_seconds(lambda: finished(history_of(replay, PIXEL, len(stream))))
    return {
        "instructions": len(stream),
        "plain run s": plain,
        "numbering": index_seconds / plain,
        "run with states": prepared / plain,
        "MB of states a million words": replay.state_bytes / len(words),
        "median jump ms": 1e3 * spread(seconds).median,
        "longest jump ms": 1e3 * max(seconds),
        "history": history / plain,
    }


def measure(quick: bool = False) -> dict[str, Any]:
    """The figures of each stream, and whether they keep to their bounds."""
    streams = {
        f"{millions} M words": figures(1_000_000 * millions) for millions in MILLIONS[: 1 if quick else None]
    }
    return {
        "streams": streams,
        "targets": [
            {
                "target": f"{name}, {stream}",
                "bound": bound,
                "verdict": MET if measured[name] <= bound else MISSED,
            }
            for stream, measured in streams.items()
            for name, bound in BOUNDS.items()
        ],
    }


def text(measured: dict[str, Any]) -> str:
    """A row for each figure."""
    streams = measured["streams"]
    lines = [f"{'':32}" + "".join(f"{name:>14}" for name in streams)]
    for figure in next(iter(streams.values())):
        lines.append(f"{figure:32}" + "".join(f"{each[figure]:14,.2f}" for each in streams.values()))
    missed = [row["target"] for row in measured["targets"] if row["verdict"] == MISSED]
    return "\n".join([*lines, f"missed: {', '.join(missed)}" if missed else "all bounds are kept"])
