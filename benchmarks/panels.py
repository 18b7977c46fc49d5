"""What the plots are drawn with: figures, panels of lines and of bars, names beside what they name.

Drawn without pyplot, so that no window and no state of the process is involved.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.cases import Spread

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, QUIET, GRID = "#222222", "#757575", "#e3e3e3"
BLUE, ORANGE, GREEN, VIOLET, RED = "#0b5394", "#c55a11", "#2e7d32", "#7b2d8b", "#c0392b"
DOTS_PER_INCH = 150
NAME_SIZE = 9.0
NAME_HEIGHT = 11.5
"""In points: how far apart the names of two lines are put that end close to each other."""
LETTER = 0.6
"""The width of a letter as a fraction of its size, on average."""


@dataclass(frozen=True)
class Line:
    """A line of a panel; `quartiles` are the bounds of its band."""

    name: str
    color: str
    values: Sequence[float]
    quartiles: Sequence[tuple[float, float]] = ()


@dataclass(frozen=True)
class Bar:
    """A ratio with its name; where there is none, a note instead."""

    name: str
    ratio: Spread | None
    note: str = ""


def figure(width: float, height: float, title: str, below: str) -> Figure:
    """An empty figure with its title and a sentence below it; width and height in inches."""
    from matplotlib.figure import Figure

    made = Figure(figsize=(width, height), facecolor="white")
    left, top = 0.35 / width, 1 - 0.3 / height
    made.text(left, top, title, fontsize=16, fontweight="bold", color=INK, va="top")
    made.text(left, top - 0.36 / height, below, fontsize=9.5, color=QUIET, va="top", linespacing=1.4)
    return made


def line_panel(
    axes: Axes,
    across: Sequence[float],
    lines: Sequence[Line],
    low: float,
    high: float,
    name: Callable[[float], str],
) -> None:
    """Draw lines over a logarithmic plane from low to high, each with its name at its end.

    `name` names the powers of ten on the upright axis.
    """
    bare(axes)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    axes.set_yticks(decades(low, high), [name(tick) for tick in decades(low, high)])
    axes.grid(axis="y", color=GRID, linewidth=0.8)
    for line in lines:
        if line.quartiles:
            bottoms, tops = zip(*line.quartiles, strict=True)
            axes.fill_between(across, bottoms, tops, color=line.color, alpha=0.2, linewidth=0)
        axes.plot(across, line.values, color=line.color, linewidth=1.7, marker="o", markersize=3.2)

    height = axes.bbox.height / axes.figure.dpi * 72
    points_a_decade = height / math.log10(high / low)
    ends = [math.log10(line.values[-1] / low) * points_a_decade for line in lines]
    for line, end, place in zip(lines, ends, moved_apart(ends, NAME_HEIGHT), strict=True):
        axes.annotate(
            line.name,
            (across[-1], line.values[-1]),
            (8, place - end),
            textcoords="offset points",
            fontsize=NAME_SIZE,
            color=line.color,
            va="center",
            annotation_clip=False,
        )


def proportion(axes: Axes, across: Sequence[float], last: float) -> None:
    """Draw what would be in proportion to the quantity, up to the last value."""
    values = [last * value / across[-1] for value in across]
    axes.plot(across, values, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2.5)))


def ratio_panel(axes: Axes, bars: Sequence[Bar]) -> None:
    """Draw ratios as bars from 1 on a logarithmic axis, to the left where they are at most 1."""
    _row_panel(axes, [bar.name for bar in bars], len(bars))
    ratios = [bar.ratio for bar in bars if bar.ratio is not None]
    low = min([0.4, *(ratio.low for ratio in ratios)]) / 1.5
    high = max([1.6, *(ratio.high for ratio in ratios)]) * 1.5
    for row, bar in enumerate(bars):
        if bar.ratio is None:
            _note(axes, row, 1, bar.note, QUIET)
            continue
        met = bar.ratio.median <= 1
        color = GREEN if met else RED
        axes.plot(
            [1, bar.ratio.median], [row, row], color=color, linewidth=9, alpha=0.35, solid_capstyle="butt"
        )
        _whisker(axes, row, bar.ratio, color)
        place = min(bar.ratio.low, 1) if met else max(bar.ratio.high, 1)
        _note(axes, row, place, f"{bar.ratio.median:.2f}", color, to_left=met)
    axes.axvline(1, color=INK, linewidth=1.2)
    ticks = [lead * 10.0**power for power in range(-3, 4) for lead in (1, 2, 5)]
    _level_axis(axes, low, high, {tick: "1, the bound" if tick == 1 else f"{tick:g}" for tick in ticks})


def time_panel(axes: Axes, times: Mapping[str, Spread], own: str, rows: int) -> None:
    """Draw milliseconds by name as points on a logarithmic axis with room for some rows; `own` stands out."""
    _row_panel(axes, list(times), rows)
    for row, (name, spent) in enumerate(times.items()):
        color = BLUE if name == own else QUIET
        _whisker(axes, row, spent, color)
        _note(axes, row, spent.high, time_name(spent.median), color)
    low = 10.0 ** math.floor(math.log10(min(spent.low for spent in times.values())))
    high = max(spent.high for spent in times.values()) * 2.5
    _level_axis(axes, low, high, {tick: time_name(tick) for tick in decades(low, high)})


def _level_axis(axes: Axes, low: float, high: float, names: Mapping[float, str]) -> None:
    """Let the level axis go from low to high, with names at some places."""
    axes.set_xticks(list(names), list(names.values()))
    axes.minorticks_off()
    axes.set_xlim(low, high)


def _row_panel(axes: Axes, names: Sequence[str], rows: int) -> None:
    """Prepare a logarithmic axis with room for some rows, the named ones on top."""
    bare(axes)
    axes.set_xscale("log")
    axes.set_ylim(rows - 0.4, -0.6)
    axes.set_yticks(range(len(names)), names)
    axes.grid(axis="x", color=GRID, linewidth=0.8)


def _whisker(axes: Axes, row: int, spread: Spread, color: str) -> None:
    """Draw a median and the line between its quartiles."""
    axes.plot([spread.low, spread.high], [row, row], color=color, linewidth=1.5)
    axes.plot([spread.median], [row], color=color, marker="o", markersize=4.5)


def _note(axes: Axes, row: int, place: float, note: str, color: str, to_left: bool = False) -> None:
    """Write beside a place of a row."""
    axes.annotate(
        note,
        (place, row),
        (-7 if to_left else 7, 0),
        textcoords="offset points",
        ha="right" if to_left else "left",
        va="center",
        fontsize=NAME_SIZE,
        color=color,
    )


def decades(low: float, high: float) -> list[float]:
    """The powers of ten from low to high."""
    return [10.0**power for power in range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1)]


def time_name(milliseconds: float) -> str:
    """A time in few letters.

    >>> time_name(1), time_name(34.567), time_name(1234.5)
    ('1 ms', '34.6 ms', '1.23 s')
    """
    return f"{milliseconds / 1000:.3g} s" if milliseconds >= 1000 else f"{milliseconds:.3g} ms"


def memory_name(mebibytes: float) -> str:
    """A size of memory in few letters."""
    return f"{mebibytes:,.0f} MiB"


def stations(axes: Axes, places: Sequence[float], names: Sequence[str]) -> None:
    """Name the measured places on the level axis, every second of them where all have no room."""
    step = 1
    while sum(len(name) + 2 for name in names[::step]) * NAME_SIZE * LETTER > width_of(axes):
        step *= 2
    axes.set_xticks(places[::step], names[::step])
    axes.minorticks_off()


def width_of(axes: Axes) -> float:
    """The width of a panel in points."""
    return float(axes.bbox.width / axes.figure.dpi * 72)


def bare(axes: Axes) -> None:
    """Leave of the frame what is read."""
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color(QUIET)
    axes.tick_params(length=0, labelsize=NAME_SIZE, colors=INK, which="both")
    axes.set_axisbelow(True)


def moved_apart(places: Sequence[float], apart: float) -> list[float]:
    """The places moved as little as need be to stand at least so far apart, in their order.

    >>> moved_apart([10, 0, 1], 4)
    [10, -1.5, 2.5]
    """
    groups: list[tuple[float, list[int]]] = []
    for row in sorted(range(len(places)), key=lambda row: places[row]):
        middle, rows = places[row], [row]
        while groups and middle - groups[-1][0] < apart * (len(rows) + len(groups[-1][1])) / 2:
            rows = groups.pop()[1] + rows
            middle = sum(places[row] for row in rows) / len(rows)
        groups.append((middle, rows))
    moved = list(places)
    for middle, rows in groups:
        for number, row in enumerate(rows):
            moved[row] = middle + apart * (number - (len(rows) - 1) / 2)
    return moved


def save(made: Figure, path: Path) -> None:
    """Write the figure as PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    made.savefig(path, dpi=DOTS_PER_INCH)
