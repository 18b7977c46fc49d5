"""`autocolor info`: print the counts, sizes and ranges of a scene."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import click

from autocolor.commands.options import json_option
from autocolor.commands.scenes import SceneSource, ended, read, scene_options, tell_up
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport
    from autocolor.scene.scalar import MeshScalar

EXAMPLES: Final = """\b
Examples:
  autocolor info scenes/coupe
  autocolor info car.obj --json
"""


NORMALS: Final = {None: "computed", True: "the file's", False: "the file's, computed where it has none"}
"""Which normals are used, by whether the file's own are complete."""


@click.command(epilog=EXAMPLES)
@scene_options()
@json_option
def info(source: SceneSource, as_json: bool) -> int:
    """Print the nodes, polygons, scalars, parts, surfaces, lights, view and intensities of SCENE."""
    report = read(source)
    tell_up(report, source)
    facts = facts_of(report)
    if as_json:
        click.echo(json.dumps(facts, indent=2))
    else:
        tell(*lines_of(facts), err=False)
    return ended(report, source)


def facts_of(report: SceneReport) -> dict[str, Any]:
    """The facts about a scene, as values that JSON can hold. To find them, the scene is rendered."""
    from autocolor.images import display_image
    from autocolor.rendering import render
    from autocolor.scene.mesh_faults import quad_shapes

    scene = report.scene
    mesh, own = scene.mesh, scene.mesh.own_normals
    picture = render(scene)
    ranges = display_image(scene, picture).ranges
    low, high = mesh.bounds
    return {
        "name": scene.name,
        "nodes": len(mesh.coordinates),
        "polygons": len(mesh.node_numbers),
        "triangles": mesh.triangle_count,
        "edges": mesh.edge_count,
        "quads": quad_shapes(mesh),
        "normals": NORMALS[None if own is None else own.are_complete],
        "bounds": [low.tolist(), high.tolist()],
        "scalars": [scalar_facts(scalar) for scalar in mesh.scalars],
        "parts": {part.name: part.surface for part in scene.parts},
        "surfaces": {
            surface.name: {
                "words": [ranges[surface.name].first, ranges[surface.name].last]
                if surface.name in ranges
                else None,
                "intensities": picture.ranges.surfaces.get(surface.name),
            }
            for surface in scene.surfaces
        },
        "lights": [light.name for light in scene.lights if light.on],
        "view": {"eye": scene.view.eye, "forward": scene.view.axes[2].tolist()},
        "views": [row.name for row in scene.views],
        "pixels": len(picture.pixels),
        "intensities": picture.ranges.whole,
        "repairs": list(report.repairs),
        "created": list(report.created),
    }


def scalar_facts(scalar: MeshScalar) -> dict[str, Any]:
    """The facts about a scalar of the mesh. The range is None if all values are missing."""
    import numpy as np

    present = scalar.values[~np.isnan(scalar.values)]
    return {
        "name": scalar.name,
        "of": scalar.of,
        "range": [float(present.min()), float(present.max())] if len(present) else None,
        "missing": len(scalar.values) - len(present),
    }


def lines_of(facts: dict[str, Any]) -> list[str]:
    """The facts as lines of text."""
    low, high = facts["bounds"]
    size = " x ".join(f"{b - a:.4g}" for a, b in zip(low, high, strict=True))
    lines = [
        f"{facts['name']}: nodes {facts['nodes']:,}, polygons {facts['polygons']:,}"
        f" (three-sided {facts['triangles']:,}), edges {facts['edges']:,}",
        "quads that are not flat and convex: "
        + ", ".join(f"{shape} {facts['quads'][shape]:,}" for shape in ("warped", "concave", "crossed")),
        f"size {size}, pixels {facts['pixels']:,},"
        f" intensities {facts['intensities'].minimum:.4g} to {facts['intensities'].maximum:.4g}",
        f"normals: {facts['normals']}",
        f"parts: {', '.join(f'{part} ({surface})' for part, surface in facts['parts'].items())}",
        f"view: from {_point(facts['view']['eye'])} toward {_point(facts['view']['forward'])}",
        *([f"named views: {', '.join(facts['views'])}"] if facts["views"] else []),
        f"lights: {', '.join(facts['lights']) or 'none'}",
        "surfaces:",
    ]
    for name, surface in facts["surfaces"].items():
        words, extent = surface["words"], surface["intensities"]
        owned = f"words {words[0]} to {words[1]}" if words else "no words"
        seen = f"intensities {extent.minimum:.4g} to {extent.maximum:.4g}" if extent else "not seen"
        lines.append(f"  {name}: {owned}, {seen}")
    if facts["scalars"]:
        lines.append("scalars:")
    for scalar in facts["scalars"]:
        extent, missing = scalar["range"], scalar["missing"]
        values = f"{extent[0]:.4g} to {extent[1]:.4g}" if extent else "no values"
        gaps = f", missing {missing:,}" if missing else ""
        lines.append(f"  {scalar['name']}: of {scalar['of']}s, {values}{gaps}")
    if facts["created"]:
        lines.append(f"created: {', '.join(facts['created'])}")
    return lines


def _point(components: Sequence[float]) -> str:
    return f"({', '.join(f'{component:.4g}' for component in components)})"
