"""Whether a bare mesh shows its form: the gray of its pixels, and what its creases differ by."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.form.measures import BRIGHT, DARK, LEAST_SHOWN, LEAST_SPREAD, MOST_EXTREME, SEEN, TONES, worst
from benchmarks.form.sight import sights, subjects

QUICK_LINES = 120
WORST = "worst of them"

HEAD = f"{'mesh':20} {'view':14} {'dark':>6} {'bright':>6} {'spread':>6} {'mean':>5}" + (
    f" {'edges':>6} {'shown':>6} {'pairs':>6} {'faintest':>8} {'tone':>5}  broken"
)
BOUNDS = (
    f"dark: percent of the object's pixels below {DARK}; bright: above {BRIGHT}; at most {MOST_EXTREME:.0%}\n"
    f"spread: 5th to 95th percentile of the gray; at least {LEAST_SPREAD} on curved shapes\n"
    f"shown: percent of the creases whose sides differ by {SEEN} or more; at least {LEAST_SHOWN:.0%}\n"
    "pairs: the same of all pairs of pixels across creases; faintest: the least difference along a crease\n"
    f"tone: median luma of the created view in its own colors; {TONES[0]} to {TONES[1]}"
)


def measure(quick: bool = False, paths: Sequence[Path] = (), lines: int = 480) -> dict[str, Any]:
    """The measures of every mesh from every side, and the worst of each mesh; in plain values."""
    rows = []
    for subject in subjects(paths):
        found = {each.view_name: each.measures() for each in sights(subject, QUICK_LINES if quick else lines)}
        for view, measures in (*found.items(), (WORST, worst(list(found.values())))):
            broken = measures.broken(subject.is_curved)
            row = {"mesh": subject.name, "view": view, "curved": subject.is_curved}
            rows.append({**row, **dataclasses.asdict(measures), "broken": list(broken)})
    return {"rows": rows}


def text(measured: Mapping[str, Any], every_view: bool = False) -> str:
    """The table of what was measured, with the bounds below it."""
    rows = [row for row in measured["rows"] if every_view or row["view"] == WORST]
    return "\n".join([HEAD, *map(_line, rows), "", BOUNDS])


def _line(row: Mapping[str, Any]) -> str:
    shares = "".join(
        f" {'-' if row[name] is None else format(100 * row[name], '.1f'):>6}"
        for name in ("edges_shown", "pairs_shown")
    )
    faintest = "-" if row["faintest"] is None else f"{row['faintest']:.1f}"
    tone = "-" if row["tone"] is None else f"{row['tone']:.2f}"
    return (
        f"{row['mesh'][:20]:20} {row['view']:14} {100 * row['dark']:6.1f} {100 * row['bright']:6.1f}"
        f" {row['spread']:6.0f} {row['mean']:5.0f} {row['edges']:6}{shares} {faintest:>8} {tone:>5}"
        f"  {' '.join(row['broken'])}"
    ).rstrip()
