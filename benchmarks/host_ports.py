"""What the way to the display costs: `python -m benchmarks.host_ports [--json FILE] [--rounds N]`.

A whole image is sent and read back, and a row of small instructions is sent, to a display in this process,
over TCP and on the pipe of `ramtek serve --stdio`. A figure is the median of its rounds, beside its ratio to
the same in this process. Only ratios of one run are worth anything.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case, timed
from ramtek_emu import HostPort, Ramtek9300, TcpPort, instructions

ROUNDS = 15
SMALL = 4_000
Words = NDArray[np.uint16]


def ramtek(*arguments: str, inward: int | None = None) -> subprocess.Popen[bytes]:
    """A `ramtek` in another process."""
    command = [sys.executable, "-m", "ramtek_emu", *arguments]
    return subprocess.Popen(command, stdin=inward, stdout=subprocess.PIPE)


class Piped:
    """The display of `ramtek serve --stdio`."""

    def __init__(self) -> None:
        self.process = ramtek("serve", "--stdio", inward=subprocess.PIPE)

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


def served(doors: ExitStack) -> TcpPort:
    """A port to the display of `ramtek serve --port`."""
    process = ramtek("serve", "--port", "0")
    doors.callback(process.communicate)
    doors.callback(process.terminate)
    assert process.stdout is not None
    port = TcpPort(process.stdout.readline().decode().strip())
    doors.callback(port.close)
    return port


def cases(doors: ExitStack) -> Iterator[Case]:
    """The cases; what has to be closed at the end goes to the doors."""
    pipe = Piped()
    doors.callback(pipe.close)
    ports: dict[str, HostPort] = {"here": Ramtek9300(), "TCP": served(doors), "stdio": pipe}
    image = instructions.write_image(np.arange(480 * 640).reshape(480, 640) % 1024)
    reading = list(instructions.read_image(0, 0, 640, 480))
    small = np.tile(np.array([0x0802, 2, 9, 0x0E03, 0x8000, 20, 20, 4, 27, 31], np.uint16), SMALL // 2)

    def image_there_and_back(port: HostPort) -> None:
        port.send(image)
        for words, count in reading:
            port.send(words)
            port.receive(count)

    def small_ones(port: HostPort) -> None:
        port.send(small)
        # One word read back says that all of them are done.
        port.send(np.array([0x0B03, 0x0040, 0, 0, 0, 0, 2], np.uint16))
        port.receive(1)

    for name, port in ports.items():
        yield Case(f"image there and back, {name}", lambda port=port: image_there_and_back(port))  # type: ignore[misc]
        yield Case(f"small instructions, {name}", lambda port=port: small_ones(port))  # type: ignore[misc]


def main() -> None:
    """Time everything, print the table, and write it as JSON where that is asked."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=ROUNDS)
    options.add_argument("--json", type=Path)
    chosen = options.parse_args()
    with ExitStack() as doors:
        seconds = timed(list(cases(doors)), chosen.rounds)
    rows = []
    print(f"{'case':30} {'ms':>9} {'figure':>16} {'/ here':>8}")
    for name, row in seconds.items():
        median = statistics.median(row)
        kind = name.partition(",")[0]
        ratio = median / statistics.median(seconds[f"{kind}, here"])
        moved = f"{4 * 640 * 480 / median / 1e6:,.0f} MB/s"
        figure = moved if kind.startswith("image") else f"{SMALL / median:,.0f} /s"
        print(f"{name:30} {median * 1e3:9.3f} {figure:>16} {ratio:8.2f}")
        rows.append({"case": name, "milliseconds": median * 1e3, "figure": figure, "to here": ratio})
    if chosen.json is not None:
        chosen.json.write_text(json.dumps(rows, indent=2), encoding="utf-8")


if __name__ == "__main__":
    main()
