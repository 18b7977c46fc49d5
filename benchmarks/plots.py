"""Pictures of what was measured, where matplotlib is installed.

Each function returns whether it drew, which it does not without matplotlib.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from benchmarks.cases import Spread
from benchmarks.panels import (
    BLUE,
    GREEN,
    ORANGE,
    QUIET,
    VIOLET,
    Bar,
    Line,
    figure,
    line_panel,
    memory_name,
    proportion,
    ratio_panel,
    save,
    stations,
    time_name,
    time_panel,
)
from benchmarks.points import FRAME

PANELS = (
    ("polygons", "polygons", "Polygons: hills over {seen:.0%} of 640 x 480, 4 lights"),
    ("lights", "lights", "Lights: the coupe over {seen:.0%} of 640 x 480"),
    ("lines", "pixels", "Picture: the coupe over {seen:.0%} of it, 4 lights"),
)
"""The quantity, the number that it is drawn over, and a heading."""
OWN = "autocolor"
ROW_HEIGHT = 0.36
"""Of a bar, in inches."""
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
            line_panel(axes, across, lines[name], low, high, tick_name)
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
    return [*lines, Line("opening", QUIET, [point["open ms"] for point in points])]


def memory_lines(points: list[dict[str, Any]]) -> list[Line]:
    """The MiB of opening and of editing."""
    return [
        Line("editing", BLUE, [point["edit MiB"] for point in points]),
        Line("opening", QUIET, [point["open MiB"] for point in points]),
    ]


def targets(measured: dict[str, Any], path: Path) -> bool:
    """Write how far each target is met or missed, and what a whole frame takes here and with the peers."""
    if not is_possible():
        return False
    rows = [bar_of(target) for target in measured["targets"]]
    frames = {
        frame_name(name.removesuffix(FRAME).removesuffix(": "), measured["peers"]): Spread(**spent)
        for name, spent in measured["cases ms"].items()
        if name.endswith(FRAME)
    }
    verdicts = [target["verdict"] for target in measured["targets"] if target["measured"] is not None]
    height = 1.9 + ROW_HEIGHT * max(len(rows), len(frames))
    made = figure(
        15,
        height,
        f"{verdicts.count('met')} of {len(verdicts)} targets are met",
        "Medians of one run, in turns, with cold caches; the lines go from quartile to quartile.",
    )
    grid = made.add_gridspec(
        1,
        2,
        width_ratios=(1.5, 1),
        left=0.29,
        right=0.97,
        bottom=0.45 / height,
        top=1 - 1.35 / height,
        wspace=0.25,
    )
    bars, points = made.add_subplot(grid[0]), made.add_subplot(grid[1])
    ratio_panel(bars, rows)
    bars.set_title("How much of its bound each takes", loc="left", fontsize=11, pad=12)
    time_panel(points, frames, OWN, len(rows))
    points.set_title("A whole frame", loc="left", fontsize=11, pad=12)
    save(made, path)
    return True


def frame_name(peer: str, peers: dict[str, Any]) -> str:
    """Whose frame it is, and whether it is a picture of another kind than ours."""
    if not peer:
        return OWN
    return peer if peers[peer]["agrees"] else f"{peer}\n(not comparable)"


def bar_of(target: dict[str, Any]) -> Bar:
    """A target as a bar: what is measured over the bound, or the bound over what must reach it."""
    sign = "\u2265" if target["at least"] else "\u2264"
    name = f"{target['target']} {sign} {target['bound']:g} {target['unit']}"
    figure, bound = target["measured"], target["bound"]
    if figure is None:
        return Bar(name, None, target["verdict"])
    if not bound:
        return Bar(name, None, f"{figure['median']:g} {target['unit']}, {target['verdict']}")
    low, median, high = (figure[part] / bound for part in ("low", "median", "high"))
    return Bar(
        name, Spread(1 / high, 1 / median, 1 / low) if target["at least"] else Spread(low, median, high)
    )
