"""Levels, bands and scalars at a point, in Python's floats, from the paper alone."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Color, Vector
from autocolor.mapping.bands import Bands
from autocolor.scene.color_scales import COLOR_SCALES, IN_TURN
from autocolor.scene.curves import CurvePoints
from autocolor.scene.kinds import ColorKind
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import LARGEST_SCALAR, Scalar
from autocolor.scene.surfaces import Paint
from tests.autocolor.twins.light import along_points
from tests.autocolor.twins.point import (
    PointExplained,
    between,
    corner_rows,
    cross,
    dot,
    length,
    minus,
    times,
    unit,
)

ROUNDING: Final = 2.0**-20
"""The rounding of intensities and scalars in the picture, as a fraction of the largest."""


def light_share(paint: Paint, level: float, levels: int) -> float:
    """The weight of the light color at a level: N equal steps above the blend level."""
    begin = math.floor(paint.blend * (levels - 1) + 0.5)
    if level <= begin:
        return 0.0
    return (level - begin) / (levels - 1 - begin) * paint.light_percentage / 100


def curved(mapping: str | CurvePoints, fraction: float) -> float:
    """A fraction of the range after a mapping curve that depends on nothing else."""
    if not isinstance(mapping, str):
        return along_points(mapping, fraction)
    curves = {
        "linear": fraction,
        "gamma": math.pow(fraction, 1 / 2.2),
        "logarithm": math.log1p(15 * fraction) / math.log(16),
    }
    return curves[mapping]


def equalized(everything: Floats, low: float, high: float, intensity: float) -> float:
    """The share of all intensities above the minimum of a range that are at most as large as an intensity.

    Where many intensities differ by little more than rounding, rounding changes the share by several levels.
    """
    if intensity >= high:
        return 1.0
    rounding = ROUNDING * high
    above = everything[everything > low + rounding]
    # The maximum counts even if no intensity reaches it.
    is_reached = bool((above >= high - rounding).any())
    return float(np.count_nonzero(above <= intensity + rounding)) / (len(above) + (not is_reached))


def ordered_threshold(line: int, element: int) -> float:
    """The threshold of a pixel, 0 to 1, in the ordered dither of 8 x 8 pixels: Bayer's matrix, 1973."""
    number = 0
    for bit in range(3):
        below, right = line >> bit & 1, element >> bit & 1
        number = 4 * number + ((0, 2), (3, 1))[below][right]
    return (number + 0.5) / 64


# The scalar that colors a surface. See `scalars.computed` for what each scalar is.


def scalar_value(mesh: Mesh, scalar: Scalar, at: PointExplained) -> float:
    """The value of a scalar at a point; NaN where it is missing."""
    polygon = at.polygon - 1
    of_mesh = {each.name: each for each in mesh.scalars}.get(scalar.name)
    if of_mesh is not None and of_mesh.of == "polygon":
        return float(of_mesh.values[polygon])
    within = corner_weights([at.corners[place].coordinates for place in at.between], at.point)
    weights = [0.0] * len(at.corners)
    for place, weight in zip(at.between, within, strict=True):
        weights[place] = weight
    if of_mesh is not None:
        values = [float(of_mesh.values[corner.node - 1]) for corner in at.corners]
        return math.nan if any(map(math.isnan, values)) else dot(weights, values)
    if scalar.name in ("x", "y", "z"):
        return at.point["xyz".index(scalar.name)]
    direction = unit(scalar.direction)
    if scalar.name == "distance":
        return dot(direction, at.point)
    if scalar.name == "zebra":
        return zebra_phase(direction, at.reflected_view, scalar.stripes)
    if scalar.name in ("slope", "draft angle"):
        normals = [corner.normal for corner in at.corners]
        normal = [dot(weights, component) for component in zip(*normals, strict=True)]
        along = dot(normal, direction)
        across = length(minus(normal, times(along, direction)))
        upright = math.degrees(math.atan2(across, abs(along)))
        return upright if scalar.name == "slope" else math.degrees(math.atan2(along, across))
    bends = [curvature(scalar.name, mesh, row) for _, row in corner_rows(mesh, polygon)]
    return dot(weights, [min(max(each, -LARGEST_SCALAR), LARGEST_SCALAR) for each in bends])


def curvature(name: str, mesh: Mesh, row: int) -> float:
    """A curvature of the mesh at a row of its normals."""
    mean, gaussian = float(mesh.curvatures.mean[row]), float(mesh.curvatures.gaussian[row])
    beyond = math.sqrt(max(mean**2 - gaussian, 0.0))
    curvatures = {
        "mean curvature": mean,
        "gaussian curvature": gaussian,
        "largest curvature": mean + beyond,
        "smallest curvature": mean - beyond,
    }
    return curvatures[name]


def zebra_phase(run: Vector, reflected: Vector, stripes: float) -> float:
    """The phase, 0 to 1, of the long lamp along `run` that a reflected ray meets."""
    least = min(range(3), key=lambda number: abs(run[number]))
    axis = (float(least == 0), float(least == 1), float(least == 2))
    across = unit(minus(axis, times(run[least], run)))
    phase = math.atan2(dot(cross(run, across), reflected), dot(across, reflected)) * stripes / math.pi
    return phase - math.floor(phase)


def corner_weights(corners: Sequence[Vector], point: Vector) -> list[float]:
    """The weights of a polygon's corners at a point in it, which add up to 1.

    The weights of a convex polygon are Wachspress' quotients of areas. A quad with a notch counts as two
    triangles.
    """
    count = len(corners)
    if count < 3:
        return [1 / count] * count
    normal = cross(minus(corners[2], corners[0]), minus(corners[-1], corners[1]))

    def area(a: Vector, b: Vector, c: Vector) -> float:
        return dot(normal, cross(minus(b, a), minus(c, a)))

    turns = [area(corners[at - 1], corners[at], corners[(at + 1) % count]) for at in range(count)]
    if count == 4 and min(turns) < -1e-9 * max(turns):
        notch = turns.index(min(turns))
        around = [corners[(notch + step) % 4] for step in range(4)]
        three = (0, 2, 3) if area(around[0], around[2], point) > 0 else (0, 1, 2)
        within = corner_weights([around[number] for number in three], point)
        weights = [0.0] * 4
        for number, weight in zip(three, within, strict=True):
            weights[(notch + number) % 4] = weight
        return weights
    areas = [max(area(corners[at], corners[(at + 1) % count], point), 0.0) for at in range(count)]
    # The quotient turn / (area before x area after), times the product of all areas.
    products = [
        max(turns[at], 0.0) * math.prod(areas[(at + step) % count] for step in range(1, count - 1))
        for at in range(count)
    ]
    total = math.fsum(products)
    return [each / total if total else 1 / count for each in products]


def band_of(value: float, bands: Bands) -> int:
    """The band of a value; a value beyond a limit, or below an edge, by a rounding counts as at it."""
    low, high = bands.low, bands.high
    rounding = ROUNDING * max(abs(low), abs(high))
    if math.isnan(value):
        return bands.missing
    if value < low - rounding:
        return bands.below
    if value > high + rounding:
        return bands.above
    return min(math.floor((max(value - low, 0.0) + rounding) / (high - low) * bands.bands), bands.bands - 1)


def band_colors(scale: str | tuple[Color, ...], count: int) -> Iterator[Color]:
    """The colors of the bands from low to high: the scale's colors at equal distances, mixed between."""
    given = [
        ColorKind().accepted(color) for color in (COLOR_SCALES[scale] if isinstance(scale, str) else scale)
    ]
    for band in range(count):
        if isinstance(scale, str) and scale in IN_TURN:
            yield given[band % len(given)]
            continue
        place = band * (len(given) - 1) / max(count - 1, 1)
        below = min(math.floor(place), len(given) - 2)
        mixed = between(given[below], given[below + 1], place - below)
        red, green, blue = (math.floor(part + 0.5) for part in mixed)
        yield red, green, blue
