"""What a scalar adds to a frame: `python -m benchmarks scalars`.

A frame is a picture that is rendered anew, without its words; what a scalar adds is the time to compute its
values at the visible points, in turns with the frame. The curvatures of a mesh are computed once, for all
frames of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

import autocolor
from autocolor.rendering import rendering
from autocolor.scalars.computed import scalar_values
from autocolor.scene.geometry.curvature import curvatures
from benchmarks.cases import Case, ratios, spread, timed
from benchmarks.points import QUANTITIES

ROUNDS = 15
SCENES = {"the coupe": ("lines", 480), "hills of a million polygons": ("polygons", 1_000_000)}
"""What is rendered: points of the scaling curves."""

FRAME, CURVATURES = "a frame", "the curvatures, once"
OF_NODES, OF_POLYGONS = "a scalar of nodes", "a scalar of polygons"
SCALARS = {
    OF_NODES: autocolor.Scalar(OF_NODES),
    OF_POLYGONS: autocolor.Scalar(OF_POLYGONS),
    **{name: autocolor.Scalar(name) for name in ("z", "slope", "mean curvature", "zebra")},
}


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """Milliseconds of each case of each scene, and its share of a frame; with `quick` of the coupe alone."""
    scenes = {}
    for name, (quantity, size) in list(SCENES.items())[: 1 if quick else None]:
        seconds = timed(list(cases(QUANTITIES[quantity].scene(size))), rounds)
        scenes[name] = [
            {
                "case": case,
                "ms": spread(each).times(1e3)._asdict(),
                "percent": ratios(each, seconds[FRAME]).times(1e2).median,
            }
            for case, each in seconds.items()
        ]
    return {"rounds": rounds, "scenes": scenes}


def cases(scene: autocolor.Scene) -> Iterator[Case]:
    """A frame of a scene, each scalar at its points, and the curvatures of its mesh."""
    mesh = scene.mesh.with_scalars(
        autocolor.MeshScalar(OF_NODES, scene.mesh.coordinates @ np.array([1.0, 2.0, 3.0])),
        autocolor.MeshScalar(
            OF_POLYGONS, np.arange(len(scene.mesh.node_numbers), dtype=np.float64), "polygon"
        ),
    )
    scene = scene.replace(mesh=mesh)
    points = rendering(scene).points
    yield Case(FRAME, partial(rendering, scene))
    for name, scalar in SCALARS.items():
        yield Case(name, partial(scalar_values, mesh, scalar, points))
    yield Case(CURVATURES, partial(curvatures, mesh.coordinates, mesh.node_numbers, mesh.normals))


def text(measured: dict[str, Any]) -> str:
    """A line a case for each scene."""
    rows = []
    for scene, lines in measured["scenes"].items():
        rows += [f"{scene:32}{'ms':>9}{'quartiles':>18}{'% of a frame':>14}"]
        for line in lines:
            spent = line["ms"]
            quartiles = f"{spent['low']:.2f}-{spent['high']:.2f}"
            rows.append(f"  {line['case']:30}{spent['median']:9.2f}{quartiles:>18}{line['percent']:14.1f}")
        rows.append("")
    return "\n".join(rows[:-1])
