"""Pictures of what was measured, where matplotlib is installed.

Each function returns whether it drew, which it does not without matplotlib.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from benchmarks.panels import Line, decades, figure, line_panel, proportion, save, stations

BLUE, ORANGE, GREEN, VIOLET, GRAY, RED = "#0b5394", "#c55a11", "#2e7d32", "#7b2d8b", "#757575", "#c0392b"
PANELS = (
    ("polygons", "polygons", "Polygons: hills over {seen:.0%} of 640 x 480, 4 lights"),
    ("lights", "lights", "Lights: the coupe over {seen:.0%} of 640 x 480"),
    ("lines", "pixels", "Picture: the coupe over {seen:.0%} of it, 4 lights"),
)
"""The quantity, the number that it is drawn over, and a heading."""
ROOM = 1.6
"""The space above and below all lines, as a factor."""


def is_possible() -> bool:
    """Whether matplotlib is installed."""
    return find_spec("matplotlib") is not None


def scaling(measured: dict[str, Any], path: Path) -> bool:
    """Write time and memory over each quantity, all logarithmic, with bands from quartile to quartile."""
    if not is_possible():
        return False
    made = figure(
        15,
        9,
        "What an edit costs as the scene grows",
        f"Above: time, medians of {measured['rounds']} rounds with cold caches, bands between the quartiles;"
        " opening once. Dotted: a frame, were it in proportion.\n"
        "Below: the most memory held, over what the imported modules hold.",
    )
    grid = made.add_gridspec(
        2, 3, height_ratios=(1.8, 1), left=0.065, right=0.9, bottom=0.05, top=0.83, hspace=0.2, wspace=0.52
    )
    points = {
        name: [point for point in measured["points"] if point["quantity"] == name] for name, *_ in PANELS
    }
    for row, (lines_of, tick_name) in enumerate(((time_lines, time_name), (memory_lines, memory_name))):
        lines = {name: lines_of(points[name]) for name in points}
        every = [value for some in lines.values() for line in some for value in line.values]
        low, high = min(every) / ROOM, max(every) * ROOM
        for column, (name, over, heading) in enumerate(PANELS):
            axes = made.add_subplot(grid[row, column])
            across = [point[over] for point in points[name]]
            line_panel(axes, across, lines[name], low, high)
            decades(axes, low, high, tick_name)
            stations(axes, across, [point["label"] for point in points[name]])
            if row == 0:
                proportion(axes, across, lines[name][0].values[-1])
                seen = points[name][-1]["pixels seen"] / points[name][-1]["pixels"]
                axes.set_title(heading.format(seen=seen), loc="left", fontsize=11, pad=12)
    save(made, path)
    return True


def time_lines(points: list[dict[str, Any]]) -> list[Line]:
    """The milliseconds of each edit, and of opening."""
    lines = []
    for name, color in zip(points[0]["edits ms"], (BLUE, ORANGE, GREEN, VIOLET), strict=True):
        edits = [point["edits ms"][name] for point in points]
        lines.append(
            Line(
                name,
                color,
                [edit["median"] for edit in edits],
                [(edit["low"], edit["high"]) for edit in edits],
            )
        )
    return [*lines, Line("opening", GRAY, [point["open ms"] for point in points])]


def memory_lines(points: list[dict[str, Any]]) -> list[Line]:
    """The MiB of opening and of editing."""
    return [
        Line("editing", BLUE, [point["edit MiB"] for point in points]),
        Line("opening", GRAY, [point["open MiB"] for point in points]),
    ]


def time_name(milliseconds: float) -> str:
    """A time in few letters."""
    return f"{milliseconds / 1000:g} s" if milliseconds >= 1000 else f"{milliseconds:g} ms"


def memory_name(mebibytes: float) -> str:
    """A size of memory in few letters."""
    return f"{mebibytes:,g} MiB"
