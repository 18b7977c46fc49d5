"""How fast the display takes what hosts send: `python -m benchmarks.display [--rounds N]`.

Each figure is the best of its rounds, beside its target; ratios are of the same run. Leaves with 1 when a
target is missed.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ramtek_emu import Ramtek9300, instructions

Words = NDArray[np.uint16]
ROUNDS = 7
MILLISECOND = 1e-3


class Figure(NamedTuple):
    """A measured number, its unit, and its target: at most, or at least."""

    name: str
    value: float
    unit: str
    target: float
    at_most: bool

    @property
    def is_met(self) -> bool:
        """Whether the target is met."""
        return self.value <= self.target if self.at_most else self.value >= self.target


def best(run: Callable[[], object], rounds: int) -> float:
    """Seconds of the quickest round."""
    seconds = []
    for _ in range(rounds + 1):
        begin = time.perf_counter()
        run()
        seconds.append(time.perf_counter() - begin)
    return min(seconds[1:])


def short_vectors(count: int, step: int) -> Words:
    """A wandering row of linked vectors, as one stream."""
    random = np.random.default_rng(9300)
    walk = np.cumsum(random.integers(-step, step + 1, (count + 1, 2)), axis=0)
    # Folded at the edges, so that no vector is longer than its step.
    walk = np.abs((walk + np.array((320, 240))) % (1278, 958) - (639, 479))
    return instructions.write_vectors(walk, 5)


def small_instructions() -> dict[str, tuple[Words, int]]:
    """Streams of small instructions, and how many there are in each."""
    random = np.random.default_rng(1978)
    places = random.integers(20, 440, (3000, 2))
    vectors = [
        (0x0802, 0x8000, x, y, 0x0E01, 4, x + dx, y + dy)
        for (x, y), (dx, dy) in zip(places.tolist(), random.integers(-9, 10, (3000, 2)).tolist(), strict=True)
    ]
    streams = {
        "SET": ((0x0802, 2, 5),) * 3000,
        "SET and WVL of one vector": vectors,
        "ERS of a small window": [(0x0902, 0x44, 3, x, y, x + 9, y + 9) for x, y in places.tolist()],
        "WT of one character": [(0x0C03, 0x40, x, y, x + 9, y + 9, 1, 0x4100) for x, y in places.tolist()],
        "WI of three words": [(0x0A03, 0x40, x, y, x + 2, y, 6, 1, 2, 3) for x, y in places.tolist()],
        "WCSS": [(0x1600, x, 0x400 | y) for x, y in places.tolist()],
        "an illegal word and NOP": ((0xFFFF, 0x0700),) * 3000,
    }
    counts = {"SET and WVL of one vector": 6000, "an illegal word and NOP": 6000}
    return {
        name: (np.array(rows, np.uint16).reshape(-1), counts.get(name, 3000))
        for name, rows in streams.items()
    }


def long_instructions() -> dict[str, Words]:
    """The longest instructions of each kind that is executed in slices."""
    corners = np.tile([[0, 0], [639, 479]], (8191, 1))
    comb = np.zeros((480, 640), np.uint16)
    comb[:479, 1::2] = 1
    texture = instructions.set_parameters(texture=(0xAAAA, 0))
    return {
        "16,382 linked vectors across the picture": instructions.write_vectors(corners, 5),
        "the same with texture": np.concatenate((texture, instructions.write_vectors(corners, 5))),
        "10,922 circles": instructions.write_circles([(320, 240, 330)] * 10_922, 5),
        "a fill around a comb": np.concatenate(
            (instructions.write_image(comb), instructions.fill(0, 479, 1))
        ),
    }


def longest_step(words: Words, rounds: int) -> float:
    """The longest time in seconds from one pause of a new display to the next; the best of each step."""
    times = []
    for _ in range(rounds):
        display = Ramtek9300("family")
        times.append([time.perf_counter(), *(time.perf_counter() for _ in display.send_stepwise(words))])
    return float(np.diff(times).min(axis=0).max())


def figures(rounds: int) -> Iterator[Figure]:
    """Every figure."""
    display = Ramtek9300("family")
    image = np.random.default_rng(1).integers(0, 1024, (480, 640)).astype(np.uint16)
    stream = instructions.write_image(image)
    copy = np.empty_like(stream)
    plain = best(lambda: np.copyto(copy, stream), 3 * rounds)
    whole = best(lambda: display.send(stream), 3 * rounds)
    target = (4 * plain + MILLISECOND) / MILLISECOND
    yield Figure("a full WI, against 4 memcpy + 1 ms", whole / MILLISECOND, "ms", target, True)

    for step in (4, 12):
        linked = short_vectors(50_000, step)
        rate = 50_000 / best(lambda linked=linked: display.send(linked), rounds)  # type: ignore[misc]
        yield Figure(f"linked vectors of at most {step} pixels", rate, "/s", 100_000, False)
    for name, (words, count) in small_instructions().items():
        rate = count / best(lambda words=words: display.send(words), rounds)  # type: ignore[misc]
        yield Figure(name, rate, "/s", 20_000, False)

    for name, words in long_instructions().items():
        longest = longest_step(words, rounds)
        yield Figure(f"the longest step of {name}", longest / MILLISECOND, "ms", 20, True)
    fills = np.concatenate((instructions.fill(5, 5, 7), instructions.fill(5, 5, 8)))
    display.send(instructions.erase(word=8))
    fill = best(lambda: display.send(fills), rounds) / 2
    yield Figure("a fill of the whole picture", fill / MILLISECOND, "ms", 5, True)

    illegal = np.full(100_000, 0xFFFF, np.uint16)
    yield Figure(
        "a row of illegal words", 100_000 / best(lambda: display.send(illegal), rounds), "/s", 1e6, False
    )
    random = np.random.default_rng(2).integers(0, 0x10000, 1_000_000).astype(np.uint16)
    yield Figure("random words", 1e6 / best(lambda: display.send(random), 2), "/s", 5e5, False)
    yield from scan_out_figures(stream, rounds)


def scan_out_figures(stream: Words, rounds: int) -> Iterator[Figure]:
    """Scan-out with cursors, origin and zoom, against plain scan-out after the same write."""
    display, pixels = Ramtek9300("family"), np.zeros((480, 640), np.uint32)
    display.send(stream)
    touch = instructions.erase((0, 0, 0, 0), 5)

    def field() -> None:
        display.send(touch)
        display.scan_out.scan_out_into(pixels)

    plain = best(field, 10 * rounds)
    display.send(np.array([0x1600, 100, 0x464, 0x1601, 300, 0x4C8, 0x0802, 0x20, 100, 77], np.uint16))
    yield Figure("scan-out with cursors and origin", best(field, 10 * rounds) / plain, "x plain", 2, True)
    for factor in (2, 3, 16):
        display.send(np.array([0x2600, (factor - 1) * 0x0101], np.uint16))
        ratio = best(field, 10 * rounds) / plain
        yield Figure(f"scan-out with cursors, origin and zoom {factor}", ratio, "x plain", 2, True)


def main() -> None:
    """Measure everything and print the table."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=ROUNDS)
    missed = 0
    for figure in figures(options.parse_args().rounds):
        bound = "at most" if figure.at_most else "at least"
        verdict = "" if figure.is_met else "   MISSED"
        value, target = f"{figure.value:,.2f}", f"{figure.target:,.2f}"
        print(f"{figure.name:<62}{value:>16} {figure.unit:<8} {bound} {target:>14}{verdict}")
        missed += not figure.is_met
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
