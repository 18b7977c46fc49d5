"""What the plots are drawn with: figures, panels of lines and of bars, names beside what they name.

Drawn without pyplot, so that no window and no state of the process is involved.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, QUIET, GRID = "#222222", "#757575", "#e3e3e3"
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


def figure(width: float, height: float, title: str, below: str) -> Figure:
    """An empty figure with its title and a sentence below it; width and height in inches."""
    from matplotlib.figure import Figure

    made = Figure(figsize=(width, height), facecolor="white")
    left, top = 0.35 / width, 1 - 0.3 / height
    made.text(left, top, title, fontsize=16, fontweight="bold", color=INK, va="top")
    made.text(left, top - 0.36 / height, below, fontsize=9.5, color=QUIET, va="top", linespacing=1.4)
    return made


def line_panel(axes: Axes, across: Sequence[float], lines: Sequence[Line], low: float, high: float) -> None:
    """Draw lines over a logarithmic plane from low to high, each with its name at its end."""
    bare(axes)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    axes.grid(axis="y", color=GRID, linewidth=0.8)
    for line in lines:
        if line.quartiles:
            bottoms, tops = zip(*line.quartiles, strict=True)
            axes.fill_between(across, bottoms, tops, color=line.color, alpha=0.2, linewidth=0)
        axes.plot(across, line.values, color=line.color, linewidth=1.7, marker="o", markersize=3.2)

    height = axes.bbox.height / axes.figure.dpi * 72
    points_a_decade = height / math.log10(high / low)
    ends = [math.log10(line.values[-1] / low) * points_a_decade for line in lines]
    for line, end, place in zip(lines, ends, spread(ends, NAME_HEIGHT), strict=True):
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


def decades(axes: Axes, low: float, high: float, name: Callable[[float], str]) -> None:
    """Name the powers of ten from low to high on the upright axis."""
    ticks = [10.0**power for power in range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1)]
    axes.set_yticks(ticks, [name(tick) for tick in ticks])


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


def spread(places: Sequence[float], apart: float) -> list[float]:
    """The places moved as little as need be to stand at least so far apart, in their order.

    >>> spread([10, 0, 1], 4)
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
