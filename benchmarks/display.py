"""How fast the display is, as ratios in one run: `python -m benchmarks.display [--json FILE] [--rounds N]`.

Each row stands beside what it is measured against: a copy of its bytes, a number a second that the display
must reach, plain scan-out, or the same stream in this process. Only ratios of one run are worth anything.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case, timed
from ramtek_emu import Ramtek9300, TcpPort, instructions
from ramtek_emu.server import Server

ROUNDS = 15
VECTORS, SMALL = 10_000, 4_000
SLACK = 1e-3
"""Seconds that a whole image may take beside its copies."""
Words = NDArray[np.uint16]


@dataclass(frozen=True)
class Row:
    """A figure, what it is measured against, and the target of their ratio if there is one."""

    name: str
    seconds: float
    figure: str
    ratio: float
    against: str
    target: str = ""
    met: bool | None = None


def short_vectors() -> Words:
    """Linked vectors a few pixels long."""
    draw = np.random.default_rng(1978)
    turns = np.cumsum(draw.integers(-6, 7, (VECTORS + 1, 2)), axis=0)
    return instructions.write_vectors(np.abs(turns % 900 - 450) + 10, 255)


def small_instructions() -> tuple[Words, int]:
    """Instructions as the programs of 1978 sent them: SET, ERS, one vector, one character; and how many."""
    one = instructions.concatenate(
        instructions.set_parameters(foreground=9),
        instructions.erase((10, 10, 17, 17), 3),
        instructions.write_vectors([[20, 20], [27, 31]]),
        instructions.write_text("a", 40, 40),
    )
    return np.tile(one, SMALL // 4), SMALL


class Piped:
    """The display of `ramtek serve --stdio` in another process."""

    def __init__(self) -> None:
        command = [sys.executable, "-m", "ramtek_emu", "serve", "--stdio"]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def send(self, words: Words) -> None:
        """Send words, low byte first."""
        assert self.process.stdin is not None
        self.process.stdin.write(words.astype("<u2", copy=False).tobytes())
        self.process.stdin.flush()

    def receive(self, count: int) -> Words:
        """The words of a reply."""
        assert self.process.stdout is not None
        return np.frombuffer(self.process.stdout.read(2 * count), "<u2")

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


def cases(doors: ExitStack) -> Iterator[Case]:
    """The cases; what has to be closed at the end goes to the doors."""
    display, viewed = Ramtek9300(), Ramtek9300()
    image = instructions.write_image(np.arange(480 * 640).reshape(480, 640) % 1024)
    copy = np.empty_like(image)
    field = np.zeros((480, 640), np.uint32)
    vectors, (small, _) = short_vectors(), small_instructions()
    dot = instructions.write_image([[7]], 3, 3)
    for each in (display, viewed):
        each.send(image)
    viewed.send(np.array([0x0802, 0x0020, 37, 21, 0x2600, 0x0101, 0x1600, 300, 0x0400 | 200], np.uint16))
    server = doors.enter_context(Server(Ramtek9300()))
    ended = threading.Event()

    def serve() -> None:
        while not ended.is_set():
            server.step(0.01)

    thread = threading.Thread(target=serve)
    thread.start()
    doors.callback(thread.join)
    doors.callback(ended.set)
    tcp = TcpPort(server.address)
    doors.callback(tcp.close)
    pipe = Piped()
    doors.callback(pipe.close)
    reading = list(instructions.read_image(0, 0, 640, 480))

    def there_and_back(port: Ramtek9300 | TcpPort | Piped) -> None:
        port.send(image)
        for words, count in reading:
            port.send(words)
            port.receive(count)

    def scan_out(each: Ramtek9300, words: Words | None = None) -> None:
        if words is not None:
            each.send(words)
        each.scan_out.scan_out_into(field)

    yield Case("copy of an image's bytes", lambda: np.copyto(copy, image))
    yield Case("image, 640 x 480", lambda: display.send(image))
    yield Case("linked vectors", lambda: display.send(vectors))
    yield Case("small instructions", lambda: display.send(small))
    yield Case("scan-out, plain", lambda: scan_out(display))
    yield Case("scan-out, origin, zoom, cursor", lambda: scan_out(viewed))
    yield Case("scan-out after a write, plain", lambda: scan_out(display, dot))
    yield Case("scan-out after a write, origin, zoom, cursor", lambda: scan_out(viewed, dot))
    yield Case("image there and back, here", lambda: there_and_back(display))
    yield Case("image there and back, TCP", lambda: there_and_back(tcp))
    yield Case("image there and back, stdio", lambda: there_and_back(pipe))


def rows(medians: dict[str, float]) -> Iterator[Row]:
    """The table."""
    copied, image = medians["copy of an image's bytes"], medians["image, 640 x 480"]
    most = 4 * copied + SLACK
    yield Row(
        "image, 640 x 480",
        image,
        f"{2 * 640 * 480 / image / 1e6:.0f} MB/s",
        image / most,
        "4 copies + 1 ms",
        "1",
        image <= most,
    )
    for name, count, least in (
        ("linked vectors", VECTORS, 100_000),
        ("small instructions", small_instructions()[1], 20_000),
    ):
        rate = count / medians[name]
        yield Row(
            name, medians[name], f"{rate:,.0f} a second", least / rate, f"{least:,}", "1", rate >= least
        )
    for plain in ("scan-out, plain", "scan-out after a write, plain"):
        name = plain.replace("plain", "origin, zoom, cursor")
        ratio = medians[name] / medians[plain]
        figure = f"{1 / medians[name]:,.0f} a second"
        yield Row(name, medians[name], figure, ratio, plain, "2", ratio <= 2)
    here = medians["image there and back, here"]
    for way in ("TCP", "stdio"):
        seconds = medians[f"image there and back, {way}"]
        figure = f"{4 * 640 * 480 / seconds / 1e6:.0f} MB/s"
        yield Row(f"image there and back, {way}", seconds, figure, seconds / here, "the same here")


def main() -> None:
    """Time everything, print the table, and write it as JSON where that is asked."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=ROUNDS)
    options.add_argument("--json", type=Path)
    chosen = options.parse_args()
    with ExitStack() as doors:
        seconds = timed(list(cases(doors)), chosen.rounds)
    table = list(rows({name: statistics.median(row) for name, row in seconds.items()}))
    print(f"{'row':46} {'ms':>8} {'figure':>20} {'ratio':>7}  to")
    for row in table:
        verdict = "" if row.met is None else f", target {row.target}: {'met' if row.met else 'MISSED'}"
        numbers = f"{row.seconds * 1e3:8.3f} {row.figure:>20} {row.ratio:7.2f}"
        print(f"{row.name:46} {numbers}  {row.against}{verdict}")
    if chosen.json is not None:
        chosen.json.write_text(json.dumps([vars(row) for row in table], indent=2), encoding="utf-8")


if __name__ == "__main__":
    main()
