"""The values of a scalar at the visible points, and its range: a scalar of the mesh, or a computed scalar.

Coordinates, angles, curvatures and stripes are computed for any mesh. To add a scalar, write its function,
add it to the table COMPUTING at the foot, and add its name to `scene.scalar.COMPUTED`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping
from functools import partial
from typing import Final, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from autocolor.arrays import Floats, Indices, Singles, chunks, lengths, underflowing, unit_vector, used_rows
from autocolor.immutable import read_only
from autocolor.scalars.interpolation import interpolated, weighted_points
from autocolor.scene.geometry.curvature import Curvatures
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import LARGEST_SCALAR, POLYGON, MeshScalar, Scalar
from autocolor.visibility.visible_points import PIXELS_AT_ONCE, POINT, REFLECTED_VIEW, VisiblePoints

Limits = tuple[float, float]
"""A range: if the table `[scalar]` of a scene gives no limits, the range of the scalar itself is shown."""

UNIT: Final = (0.0, 1.0)
"""Assumed: the range of a scalar without any value."""

LEAST_EXTENT: Final = 1e-6
"""Assumed: a range that is shorter than this fraction of its larger limit is noise of float32."""

SMALLEST: Final = 1e-36
"""The least number whose half is exact enough in float32."""

MOST_RANGES: Final = 64
"""Limit: cached ranges of one mesh; while a direction is dragged, every direction has its own range."""


@underflowing
def size_of(mesh: Mesh) -> float:
    """The diagonal of the box around a mesh."""
    low, high = mesh.bounds
    return float(np.linalg.norm(high - low))


class ScalarValues(NamedTuple):
    """A scalar at the visible points, (n,) float32 in their order, NaN where missing, and its own range."""

    values: Singles
    limits: Limits


@underflowing
def scalar_values(
    mesh: Mesh, scalar: Scalar, points: VisiblePoints, object_coordinates: Floats | None = None
) -> ScalarValues:
    """The values of a scalar at the visible points; a scalar of the mesh hides a computed one of its name.

    If the object is a part of the mesh, `object_coordinates`, (nodes, 3), are its nodes. Then a coordinate or
    a distance has their range: with the range of a wide floor the object would have few colors.
    """
    of_mesh = {each.name: each for each in mesh.scalars}.get(scalar.name)
    if of_mesh is None:
        values, limits = COMPUTING[scalar.name](mesh, scalar, points)
        if object_coordinates is not None:
            limits = limits_of_object(scalar, object_coordinates) or limits
    else:
        values, limits = (_of_polygons if of_mesh.of == POLYGON else _of_nodes)(mesh, of_mesh, points)
    return ScalarValues(read_only(values), limits)


def _of_polygons(mesh: Mesh, scalar: MeshScalar, points: VisiblePoints) -> ScalarValues:
    """The values of the visible polygons, and the range of all polygons."""
    values = scalar.values.take(points.span_polygons).astype(np.float32)
    limits = cached_range(mesh, ("of mesh", scalar.name), partial(range_of, scalar.values))
    return ScalarValues(np.repeat(values, points.span_lengths), limits)


def _of_nodes(mesh: Mesh, scalar: MeshScalar, points: VisiblePoints) -> ScalarValues:
    """The values interpolated between nodes, and the range of the nodes that polygons use."""
    node_rows = mesh.node_numbers.T

    def corner_values(polygons: Indices) -> Floats:
        return scalar.values.take(np.take(node_rows, polygons, axis=1))

    def range_of_nodes() -> Limits:
        used = used_rows(node_rows, len(scalar.values))
        return range_of(scalar.values if used.all() else scalar.values[used])

    limits = cached_range(mesh, ("of mesh", scalar.name), range_of_nodes)
    return within(interpolated(mesh, points, corner_values), limits)


def within(values: Singles, limits: Limits) -> ScalarValues:
    """The values, clipped in their own array: rounding may have put a value beyond the limits."""
    return ScalarValues(np.clip(values, *limits, out=values), limits)


def widened(low: float, high: float, least: float = 0.0) -> Limits:
    """The range from `low` to `high` in float32, as the values at the pixels are.

    Assumed: if the extent is at most `least`, as for a constant, the range is widened on both sides, so that
    the value is in the middle of the colors. It is widened by half of the value but at least by `least`; if
    both are 0, by 0.5.

    >>> widened(1.0, 3.0), widened(8.0, 8.0), widened(0.0, 0.0)
    ((1.0, 3.0), (4.0, 12.0), (-0.5, 0.5))
    """
    low, high = float(np.float32(low)), float(np.float32(high))
    most = max(abs(low), abs(high))
    if high - low > max(LEAST_EXTENT * most, least):
        return low, high
    half = max(most / 2, least)
    half = min(half, LARGEST_SCALAR) if half > SMALLEST else 0.5
    return float(np.float32(low - half)), float(np.float32(high + half))


def range_of(values: Floats, cut: float = 0, least: float = 0.0) -> Limits:
    """The least and the largest value, `widened`; UNIT if all values are missing.

    `cut` percent of the values are left out at either end.
    """
    finite = values[np.isfinite(values)]
    if not len(finite):
        return UNIT
    if cut:
        low, high = np.percentile(finite, [cut, 100 - cut]).tolist()
        return widened(low, high, least)
    return widened(float(finite.min()), float(finite.max()), least)


_RANGES: Final[WeakKeyDictionary[Mesh, dict[Hashable, Limits]]] = WeakKeyDictionary()


def cached_range(mesh: Mesh, key: Hashable, compute: Callable[[], Limits]) -> Limits:
    """The range for a mesh and a key, computed for the first picture and cached for the next."""
    ranges = _RANGES.setdefault(mesh, {})
    if key not in ranges:
        if len(ranges) >= MOST_RANGES:
            ranges.clear()
        ranges[key] = compute()
    return ranges[key]


LEAST_SIZE: Final = 1e-6
"""Assumed: the extent, as a fraction of the object's size, that is rounding, as in a level plate's height."""


def coordinate(axis: int, mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """A world coordinate, and its range over the nodes that polygons use."""
    low, high = mesh.bounds
    limits = widened(float(low[axis]), float(high[axis]), LEAST_SIZE * size_of(mesh))
    return within(_along(np.eye(3)[axis], points), limits)


def distance(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The distance from the origin along the scalar's direction, and its range over the nodes in use."""
    direction = direction_of(scalar)
    key = ("distance", *direction.tolist())
    return within(_along(direction, points), cached_range(mesh, key, partial(_range_along, direction, mesh)))


def limits_of_object(scalar: Scalar, coordinates: Floats) -> Limits | None:
    """The range of a coordinate or a distance over the nodes of an object, (nodes, 3).

    None for any other scalar.
    """
    if scalar.name not in ("x", "y", "z", "distance") or not len(coordinates):
        return None
    is_distance = scalar.name == "distance"
    direction = direction_of(scalar) if is_distance else np.eye(3)["xyz".index(scalar.name)]
    values = coordinates @ direction
    size = float(np.linalg.norm(np.ptp(coordinates, axis=0)))
    return widened(float(values.min()), float(values.max()), LEAST_SIZE * size)


def direction_of(scalar: Scalar) -> Floats:
    """The direction of a scalar as a unit vector."""
    return np.array(unit_vector(scalar.direction))


def _along(direction: Floats, points: VisiblePoints) -> Singles:
    """The component of each point along a unit vector."""
    toward = points.camera_direction((direction[0], direction[1], direction[2])) * points.unit
    start = toward @ points.origin + direction @ np.array(points.view.eye)
    values = np.empty(len(points.pixels), np.float32)
    for chunk in chunks(len(values), PIXELS_AT_ONCE):
        right, down, ahead = points.rows[POINT, chunk].astype(np.float64)
        values[chunk] = toward[0] * right + toward[1] * down + toward[2] * ahead + start
    return values


def _range_along(direction: Floats, mesh: Mesh) -> Limits:
    """The range of the nodes that polygons use, in chunks: the table may be a mapped file."""
    used = used_rows(mesh.node_numbers.T, len(mesh.coordinates))
    ends = [UNIT] if not used.any() else []
    for chunk in chunks(len(used), PIXELS_AT_ONCE):
        values = (direction @ mesh.coordinates.T[:, chunk])[used[chunk]]
        if len(values):
            ends.append((float(values.min()), float(values.max())))
    return widened(min(low for low, _ in ends), max(high for _, high in ends), LEAST_SIZE * size_of(mesh))


# Slope and draft angle.
#
# Assumed: the normal is the normal of the mesh, interpolated between the corners as scalars are. It is not
# turned to the eye, so both angles are the same from every view: the front of a polygon, where its corners
# run counterclockwise, is the outside.

SLOPES: Final = (0.0, 90.0)
DRAFT_ANGLES: Final = (-90.0, 90.0)


def slope(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The angle in degrees between the surface and the level: 0 lies flat, 90 stands upright.

    The scalar's direction is upward. Assumed: an overhang has the slope of its upper side.
    """
    return ScalarValues(np.abs(_elevations(mesh, scalar, points, of_surface=True)), SLOPES)


def draft_angle(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The draft angle in degrees for a mold that is pulled off along the scalar's direction.

    It is the angle of the normal above the plane across the pull: 90 faces the pull, 0 is a wall along it,
    and a side with a negative angle holds the mold.
    """
    return ScalarValues(_elevations(mesh, scalar, points, of_surface=False), DRAFT_ANGLES)


def _elevations(mesh: Mesh, scalar: Scalar, points: VisiblePoints, *, of_surface: bool) -> Singles:
    """The angle in degrees of the normal above the plane across the direction.

    With `of_surface`, 90 minus its size: the angle of the surface above that plane.
    """
    pull = direction_of(scalar)
    vectors, numbers = mesh.normals.vectors.T, mesh.normals.numbers.T
    values = np.empty(len(points.pixels), np.float32)
    for chunk in weighted_points(mesh, points):
        at_corners = np.take(vectors, np.take(numbers, chunk.polygons, axis=1), axis=1)
        rows = [chunk.interpolated(row) for row in at_corners.astype(np.float64)]
        normals = np.stack(rows).astype(np.float64)
        along = pull @ normals
        across = lengths(normals - pull[:, None] * along)
        # An arc tangent of both is exact where an arc sine or cosine is not.
        angles = np.arctan2(across, np.abs(along)) if of_surface else np.arctan2(along, across)
        values[chunk.pixels] = np.degrees(angles)
    return values


# Curvatures. They have the sign of `Mesh.curvatures`: positive where the surface bends away from its normal,
# as a ball does. The largest and the smallest curvature are the principal curvatures.

CUT: Final = 2.0
"""Assumed: the percentage of normals whose curvature is left out at either end of the range.

Otherwise a few sharp bends would take all of the colors.
"""

LEAST_BEND: Final = 1e-2
"""Assumed: curvatures up to this, times the inverse of the object's size, are rounding, as on a plate."""


def mean_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The mean of the principal curvatures, in the inverse of the world unit."""
    return _bending(lambda both: both.mean, "mean", mesh, points)


def gaussian_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The product of the principal curvatures: positive on a ball, negative on a saddle, 0 on a cylinder."""
    return _bending(lambda both: both.gaussian, "gaussian", mesh, points, power=2)


def largest_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The larger of the principal curvatures."""
    return _bending(partial(_principal, 1.0), "largest", mesh, points)


def smallest_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The smaller of the principal curvatures."""
    return _bending(partial(_principal, -1.0), "smallest", mesh, points)


def _principal(sign: float, both: Curvatures) -> Floats:
    values: Floats = both.mean + sign * np.sqrt(np.maximum(both.mean**2 - both.gaussian, 0))
    return values


def _bending(
    choose: Callable[[Curvatures], Floats], name: str, mesh: Mesh, points: VisiblePoints, power: int = 1
) -> ScalarValues:
    """Curvatures interpolated from the normals at the corners, in the inverse world unit to a power."""
    numbers = mesh.normals.numbers.T
    at_normals = np.clip(choose(mesh.curvatures), -LARGEST_SCALAR, LARGEST_SCALAR)

    def corner_values(polygons: Indices) -> Floats:
        return at_normals.take(np.take(numbers, polygons, axis=1))

    least = min(LEAST_BEND / (size_of(mesh) or 1.0), LARGEST_SCALAR) ** power
    limits = cached_range(mesh, ("bending", name), lambda: range_of(at_normals, CUT, least))
    return ScalarValues(interpolated(mesh, points, corner_values), limits)


# Zebra stripes. The stripes are reflections of long lamps, which show where a surface is not smooth.
#
# Assumed: the lamps are infinitely far, run along the scalar's direction and stand around it, as many in a
# half turn as the scalar has stripes. The reflected ray meets a lamp and the gap after it at a phase from 0
# to below 1. The phase is continuous around a full turn if the number of stripes in it is whole.

BELOW_ONE: Final = float(np.nextafter(np.float32(1), np.float32(0)))


def zebra(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The phase of the lamp that the reflected ray meets, in [0, 1), by the normals of the picture."""
    run = direction_of(scalar)
    # The angle about the run is counted from the world axis that is most across it.
    across = np.eye(3)[np.abs(run).argmin()]
    across -= run * (run @ across)
    across /= np.linalg.norm(across)
    both = np.stack([across, np.cross(run, across)])
    in_camera = (both @ points.view.axes.T).astype(np.float32)
    values = np.empty(len(points.pixels), np.float32)
    for chunk in chunks(len(values), PIXELS_AT_ONCE):
        along, upward = (in_camera @ points.rows[REFLECTED_VIEW, chunk]).astype(np.float64)
        lamps = np.arctan2(upward, along) * (scalar.stripes / math.pi)
        lamps -= np.floor(lamps)
        values[chunk] = np.minimum(lamps, BELOW_ONE)
    return ScalarValues(values, UNIT)


Computing = Callable[[Mesh, Scalar, VisiblePoints], ScalarValues]

COMPUTING: Final[Mapping[str, Computing]] = {
    "x": partial(coordinate, 0),
    "y": partial(coordinate, 1),
    "z": partial(coordinate, 2),
    "distance": distance,
    "slope": slope,
    "draft angle": draft_angle,
    "mean curvature": mean_curvature,
    "gaussian curvature": gaussian_curvature,
    "largest curvature": largest_curvature,
    "smallest curvature": smallest_curvature,
    "zebra": zebra,
}
