"""The faults of a mesh in sentences and as values that JSON can hold.

Rows count from 1 here, as in a table store, an OBJ file or CSV tables without numbers of their own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from autocolor.scene.geometry.faults.holes import Hole
from autocolor.scene.geometry.faults.mesh_faults import EDGE, KINDS, Fault

FIRST_ROWS: Final = 5
"""The rows, and the loops of edges, that a sentence names."""

MOST_ROWS: Final = 10_000
"""Assumed: the rows of one kind in JSON; a file of more can be read, but hardly be gone through."""


def fault_lines(faults: Sequence[Fault]) -> Iterator[str]:
    """A line for each kind of faults, with its number and first rows, and one for each of the first loops."""
    for fault in faults:
        rows = fault.rows[:FIRST_ROWS] + 1
        named = ", ".join("-".join(map(str, row)) for row in rows) if fault.of == EDGE else _listed(rows)
        what = "nodes " if fault.of == EDGE else ""
        more = ", ..." if len(fault.rows) > FIRST_ROWS else ""
        yield f"{fault.number:2} {fault.kind} {len(fault.rows):,}: {KINDS[fault.kind]} ({what}{named}{more})"
        for hole in fault.holes[:FIRST_ROWS]:
            yield f"     {_hole_told(hole)}"
        more_holes = len(fault.holes) - FIRST_ROWS
        if more_holes > 0:
            yield f"     and {more_holes:,} shorter {'one' if more_holes == 1 else 'ones'}"


def _listed(rows: Any) -> str:
    return ", ".join(map(str, rows.tolist()))


def _hole_told(hole: Hole) -> str:
    kind = "a closed loop" if hole.is_closed else "a branching run"
    place = ", ".join(f"{component:.4g}" for component in hole.center)
    return (
        f"{kind} of {hole.edges:,} edges, {hole.length:.4g} long, around ({place}), at node {hole.node + 1}"
    )


def fault_values(faults: Sequence[Fault]) -> list[dict[str, Any]]:
    """The faults as values that JSON can hold; of each kind at most MOST_ROWS rows."""
    return [
        {
            "kind": fault.kind,
            "number": fault.number,
            "of": fault.of,
            "count": len(fault.rows),
            "rows": (fault.rows[:MOST_ROWS] + 1).tolist(),
            "polygons": (fault.polygons[:MOST_ROWS] + 1).tolist(),
            **({"loops": [_hole_values(hole) for hole in fault.holes[:MOST_ROWS]]} if fault.holes else {}),
        }
        for fault in faults
    ]


def _hole_values(hole: Hole) -> dict[str, Any]:
    return {
        "edges": hole.edges,
        "length": hole.length,
        "center": list(hole.center),
        "node": hole.node + 1,
        "closed": hole.is_closed,
    }
