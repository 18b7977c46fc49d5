"""How far words that stand for normals are from the picture by levels: `python -m benchmarks normals`.

A ball of 640 x 480 pixels has all words, D = 0.75 and S = 0.5. The eye and the light are far away, so that
the difference is that of the cells of normals alone. The light shines from many directions, one after
another: the largest difference depends on where its highlight falls between the cells, and on how much the
color of the light differs from that of the object.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

import autocolor
from autocolor.arrays import Numbers
from autocolor.images import display_image
from benchmarks.shapes.curved import sphere

FAR: Final = 1e3
"""The distance of the eye and the light, in radii of the ball."""

DIRECTIONS: Final = 40
EXPONENTS: Final = (5.0, 20.0, 50.0, 100.0)
PAINTS: Final = {"gray": "#b4b4b4", "red": "#b01020"}
"""The object colors; the light color is white."""


def measure(quick: bool = False) -> dict[str, Any]:
    """The differences of color components, 0 to 255, over the ball, for each exponent and paint."""
    places = around(DIRECTIONS)[:: DIRECTIONS // 2 if quick else 1]
    rows = []
    for exponent in EXPONENTS:
        found = [differences(ball(exponent, place)) for place in places]
        for paint in PAINTS:
            means = [float(each[paint].mean()) for each in found]
            largest = [int(each[paint].max()) for each in found]
            rows.append(
                {
                    "exponent": exponent,
                    "paint": paint,
                    "mean": float(np.mean(means)),
                    "largest mean": max(means),
                    "median of largest": float(np.median(largest)),
                    "largest": max(largest),
                }
            )
    return {"directions": len(places), "rows": rows}


def around(count: int) -> list[tuple[float, float, float]]:
    """Places of the light, evenly around the half of the sky on the side of the eye, which looks along +y."""
    turns = math.pi * (3 - math.sqrt(5)) * np.arange(count)
    nearer = (np.arange(count) + 0.5) / count
    across = np.sqrt(1 - nearer**2)
    places = FAR * np.stack([across * np.cos(turns), -nearer, across * np.sin(turns)], axis=1)
    return [(x, y, z) for x, y, z in places.tolist()]


def ball(exponent: float, place: tuple[float, float, float]) -> autocolor.Scene:
    """A ball under one light, as high as the picture."""
    scene = autocolor.scene_of(
        sphere(128), surfaces=[autocolor.Surface("shell")], surface_of_part={"sphere": "shell"}
    )
    angle = 2 * math.degrees(math.asin(1 / FAR)) * 1.15
    view = autocolor.View((0, -FAR, 0), target=(0, 0, 0), field_of_view=angle)
    scene = scene.replace(lights=(autocolor.Light("light", place),), view=view, ambient=0.1, words="normals")
    return scene.with_surface("shell", diffuse=0.75, specular=0.5, exponent=exponent, blend=0.6)


def differences(scene: autocolor.Scene) -> dict[str, Numbers]:
    """The differences of the two pictures at the visible pixels, (n, 3), for each paint."""
    picture = autocolor.render(scene)
    visible = picture.surface_number > 0
    found = {}
    for paint, color in PAINTS.items():
        painted = scene.with_surface("shell", object_color=color)
        images = [display_image(painted.replace(words=words), picture) for words in ("normals", "levels")]
        ours, true = (each.colors[visible].astype(np.int64) for each in images)
        found[paint] = np.abs(ours - true)
    return found


def text(measured: dict[str, Any]) -> str:
    """A line for each exponent and paint."""
    columns = ("mean", "largest mean", "median of largest", "largest")
    rows = [f"{'N':>5}  {'paint':6}" + "".join(f"{column:>19}" for column in columns)]
    for row in measured["rows"]:
        numbers = "".join(f"{row[column]:19.1f}" for column in columns)
        rows.append(f"{row['exponent']:5.0f}  {row['paint']:6}{numbers}")
    return "\n".join(rows)
