"""`autocolor validate`: list every problem of a scene and every fault of its mesh."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import click

from autocolor.commands.scenes import REPAIRED, SceneSource, ended, read, scene_options
from autocolor.errors import InputError
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from autocolor.scene.mesh_faults import Fault, Hole
    from autocolor.scene.scene import Scene

EXAMPLES: Final = """\b
Examples:
  autocolor validate scenes/coupe
  autocolor validate car.obj --strict --json
  autocolor validate car.obj --show     color the faults in a window
"""


@click.command(epilog=EXAMPLES)
@scene_options()
@click.option("--json", "as_json", is_flag=True, help="Print JSON, with all rows.")
@click.option("--show", "shows", is_flag=True, help="Show the faults of the mesh in color, in a window.")
def validate(source: SceneSource, as_json: bool, shows: bool) -> int:
    """List every problem and every repair of SCENE, and every fault of its mesh.

    A scene with a problem cannot be rendered: the exit code is 65. A scene with faults or repairs can; with
    --strict the exit code is then 1. Rows are counted from 1.
    """
    try:
        report = read(source)
    except InputError as error:
        if as_json:
            click.echo(json.dumps({"problems": error.problems, "repairs": [], "faults": []}, indent=2))
        raise
    from autocolor.scene.mesh_faults import mesh_faults

    faults = mesh_faults(report.scene.mesh)
    if as_json:
        answer = {"problems": [], "repairs": report.repairs, "faults": fault_values(faults)}
        click.echo(json.dumps(answer, indent=2))
    else:
        kinds = f"{len(faults)} kind{'s' if len(faults) > 1 else ''} of faults in its mesh"
        verdict = f"it can be rendered, with {kinds}" if faults else "no problem"
        tell(f"{source.path}: {verdict}", *fault_lines(faults), err=False)
    if shows:
        from autocolor.commands.window import show
        from autocolor.journal.history import History

        # The colored scene has no file to save to.
        show(History(fault_scene(report.scene, faults)))
    return REPAIRED if source.strict and faults else ended(report, source)


FIRST_ROWS: Final = 5
"""The most rows that a line names, and the most lines about loops of edges."""

MOST_ROWS: Final = 10_000
"""Limit: rows of one kind in JSON; nobody reads more."""


def fault_lines(faults: Sequence[Fault]) -> Iterator[str]:
    """A line for each kind of faults, with its number and first rows, and lines for its first loops of edges.

    Rows are counted from 1, as in a table store, an OBJ file, or CSV tables without row numbers.
    """
    from autocolor.scene.mesh_faults import EDGE, KINDS

    for fault in faults:
        rows = fault.rows[:FIRST_ROWS] + 1
        if fault.of == EDGE:
            names = "nodes " + ", ".join("-".join(map(str, row)) for row in rows)
        else:
            names = ", ".join(map(str, rows.tolist()))
        more = ", ..." if len(fault.rows) > FIRST_ROWS else ""
        yield f"{fault.number:2} {fault.kind} {len(fault.rows):,}: {KINDS[fault.kind]} ({names}{more})"
        for hole in fault.holes[:FIRST_ROWS]:
            yield f"     {_hole_line(hole)}"
        more_holes = len(fault.holes) - FIRST_ROWS
        if more_holes > 0:
            yield f"     and {more_holes:,} shorter {'loop' if more_holes == 1 else 'loops'}"


def _hole_line(hole: Hole) -> str:
    kind = "a closed loop" if hole.is_closed else "a branching run"
    place = ", ".join(f"{component:.4g}" for component in hole.center)
    return (
        f"{kind} of {hole.edges:,} edges, {hole.length:.4g} long, around ({place}), at node {hole.node + 1}"
    )


def fault_values(faults: Sequence[Fault]) -> list[dict[str, Any]]:
    """The faults as values that JSON can hold, with at most MOST_ROWS rows of a kind."""

    def hole_values(hole: Hole) -> dict[str, Any]:
        values = {**vars(hole), "node": hole.node + 1, "closed": hole.is_closed}
        del values["is_closed"]
        return values

    return [
        {
            "kind": fault.kind,
            "number": fault.number,
            "of": fault.of,
            "count": len(fault.rows),
            "rows": (fault.rows[:MOST_ROWS] + 1).tolist(),
            "polygons": (fault.polygons[:MOST_ROWS] + 1).tolist(),
            **({"loops": [hole_values(hole) for hole in fault.holes[:MOST_ROWS]]} if fault.holes else {}),
        }
        for fault in faults
    ]


COLORS: Final = "#56b4e9,#7878dc,#5a5a5a,#fadc5a,#f0aa3c,#e66e1e,#00aa6e,#c86ebe,#9628a0,#dc1428"
"""The colors of the kinds of faults, in the order of their numbers; graver faults are redder and darker."""

WITHOUT_FAULT: Final = "#c8c8c8"

SURFACE: Final = "mesh"
"""The surface of all parts in a picture of faults, so that the levels suffice for all kinds."""


def fault_scene(scene: Scene, faults: Sequence[Fault]) -> Scene:
    """The scene colored by the faults of its mesh: a color for each kind, and light gray without fault."""
    from autocolor.scene.mesh_faults import FAULT, KINDS, fault_scalar
    from autocolor.scene.scalar import Scalar
    from autocolor.scene.scene import AUTO
    from autocolor.scene.surfaces import Reflectance, Surface

    mesh = scene.mesh
    others = [scalar for scalar in mesh.scalars if scalar.name != FAULT]
    count = len(KINDS)
    return scene.replace(
        mesh=mesh.with_scalars(*others, fault_scalar(mesh, faults)),
        parts=tuple(part.replace(surface=SURFACE, stage=False) for part in scene.parts),
        surfaces=(Surface(SURFACE, Reflectance(0.8, 0.0)),),
        exposure=AUTO,
        scalar=Scalar(FAULT, (-0.5, count + 0.5), f"{WITHOUT_FAULT},{COLORS}", bands=count + 1),
    )
