"""What is seen: for each pixel the polygon, the point and the normal, in camera space, surface by surface.

Paper: "The Lighting Model": the direction of the normal is computed from the node normals by bilinear
interpolation, along the edges and then along the span. Departs: on the screens of 1983 that was linear in
the picture; here it is right in perspective, by interpolating the normal times the inverse depth. Only the
direction matters, so the inverse depth never has to be divided out again.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from autocolor.edges import edges
from autocolor.mesh import Mesh
from autocolor.projection import Projection, lens
from autocolor.view import View

PIXELS_AT_ONCE = 1 << 14
RAY_ACROSS = 6
"""The row of what is linear along a span where the ray begins: across, down and 1."""

Singles = npt.NDArray[np.float32]
Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.intp]

# Rows of `Seen.rows`: the point P, 1 and P.P; the normal N and -N.P; the eye's mirrored ray M and -M.P.
POINT, ONE, POINT_SQUARED = slice(0, 3), 3, 4
NORMAL, NORMAL_POINT = slice(5, 8), 8
MIRROR, MIRROR_POINT = slice(9, 12), 12
ROW_COUNT = 13


@dataclass(frozen=True, eq=False)
class SurfaceSlice:
    """The pixels `start` to `stop` of what is seen, all of one surface."""

    surface_number: int
    start: int
    stop: int


def surface_slices(surface_numbers: npt.NDArray[np.uint8]) -> tuple[SurfaceSlice, ...]:
    """The slices of pixels that are sorted by their surface numbers, none of which is 0."""
    counts = np.bincount(surface_numbers, minlength=1)
    stops = np.cumsum(counts)
    return tuple(
        SurfaceSlice(number, int(stops[number] - counts[number]), int(stops[number]))
        for number in np.flatnonzero(counts).tolist()
    )


@dataclass(frozen=True, eq=False)
class Seen:
    """The visible pixels, sorted by surface and within one by place.

    `pixels` are their flat places in the raster, (n,) intp; `polygon_numbers` (n,) intp are rows of the
    polygon table. `rows` is (13, n) float32 and has what the reflected light is computed from: a point in
    camera space around `middle`, the unit normal, and the ray to the eye mirrored at the normal, each with
    its product with the point, so that every cosine to a light is one matrix product. Lengths in camera
    space, `middle` and `inverse_depth` among them, are in `unit`.
    """

    lines: int
    elements: int
    pixels: Numbers
    slices: tuple[SurfaceSlice, ...]
    polygon_numbers: Numbers
    inverse_depth: Singles
    rows: Singles
    view: View
    unit: float
    middle: Floats

    @cached_property
    def reach(self) -> float:
        """The largest distance of a point from the middle in units; the points' rounding is in proportion."""
        return float(np.sqrt(self.rows[POINT_SQUARED].max(initial=0.0)))

    def camera_point(self, point: tuple[float, float, float]) -> Floats:
        """A point of the world as the rows of points are: in camera space, around the middle."""
        away = np.array(point) - np.array(self.view.eye)
        placed: Floats = self.view.axes @ away / self.unit - self.middle
        return placed

    def camera_direction(self, direction: tuple[float, float, float]) -> Floats:
        """A direction of the world in camera space."""
        turned: Floats = self.view.axes @ np.array(direction)
        return turned

    def world_coordinate(self, axis: int) -> Floats:
        """The four numbers whose product with a point and 1 is the point's world coordinate in units."""
        along = self.view.axes[:, axis]
        return np.append(along, self.view.eye[axis] / self.unit + along @ self.middle)

    @property
    def points(self) -> Floats:
        """The points in world coordinates, (n, 3), in the order of `pixels`."""
        placed = (self.rows[POINT].T.astype(np.float64) + self.middle) * self.unit
        points: Floats = placed @ self.view.axes + np.array(self.view.eye)
        return points

    @property
    def normals(self) -> Floats:
        """The unit normals in world axes, (n, 3), in the order of `pixels`."""
        normals: Floats = self.rows[NORMAL].T.astype(np.float64) @ self.view.axes
        return normals


@dataclass(frozen=True, eq=False)
class Winners:
    """The spans that are seen somewhere, and at each visible pixel the one that is.

    `pixels`, `inverse_depth` and `span` are (n,), a row for each visible pixel in the order of the raster;
    `first_pixel`, `left_edge` and `right_edge` are (spans,).
    """

    pixels: Numbers
    inverse_depth: Singles
    span: Numbers
    first_pixel: Numbers
    left_edge: Numbers
    right_edge: Numbers


def seen_of_winners(
    winners: Winners,
    projected: Projection,
    mesh: Mesh,
    view: View,
    surface_numbers: tuple[int, ...],
    one_sided: frozenset[int],
) -> Seen:
    """What is seen, computed for the visible pixels only."""
    # Sort the pixels by surface, so that each surface's D, S and N are numbers and not arrays.
    column = winners.left_edge % max(projected.corners.shape[1], 1)
    polygon = projected.polygon_numbers[column]
    surface = np.array(surface_numbers, np.uint8)[mesh.part_numbers[polygon]]
    surface_at_pixel = surface[winners.span]
    order = np.argsort(surface_at_pixel, kind="stable")
    pixels, span = winners.pixels[order], winners.span[order]
    inverse_depth = winners.inverse_depth[order]

    # Make ready what is linear along the spans that are seen.
    low, high = mesh.bounds
    middle = view.axes @ ((low + high) / 2 - np.array(view.eye)) / projected.unit
    rays = lens(projected.lines, projected.elements, view.field_of_view)
    start, step = _along_spans(winners, projected, rays.focal_length, middle)
    # Turn to the eye the normals of polygons that are seen from behind.
    turned = projected.from_behind[column] & ~np.isin(surface, list(one_sided))
    start[:3, turned] *= -1
    step[:3, turned] *= -1

    rows = np.empty((ROW_COUNT, len(pixels)), np.float32)
    along = (pixels - winners.first_pixel[span]).astype(np.float32)
    for first in range(0, len(pixels), PIXELS_AT_ONCE):
        part = slice(first, first + PIXELS_AT_ONCE)
        nearness, some = inverse_depth[part], span[part]
        out = rows[:, part]
        # Interpolate along the span.
        between = np.take(start, some, axis=1)
        between[:6] += np.take(step, some, axis=1) * along[part]
        between[RAY_ACROSS] += along[part] * np.float32(1 / rays.focal_length)
        # Place the point.
        np.divide(between[3:6], nearness, out=out[POINT])
        out[ONE] = 1
        np.einsum("ij,ij->j", out[POINT], out[POINT], out=out[POINT_SQUARED])
        # Make the normal a unit vector.
        normal = out[NORMAL]
        normal[:] = between[:3]
        length = np.sqrt(np.einsum("ij,ij->j", normal, normal))
        normal /= np.maximum(length, np.float32(1e-30), out=length)
        # Mirror the ray to the eye: M = 2 (N.V) N - V, where V = -ray / |ray|.
        view_ray = between[RAY_ACROSS:]
        view_ray *= rays.inverse_length[pixels[part]]
        facing = np.einsum("ij,ij->j", normal, view_ray)
        np.multiply(normal, -2 * facing, out=out[MIRROR])
        out[MIRROR] += view_ray
        # Keep the products with the point.
        np.einsum("ij,ij->j", out[NORMAL], out[POINT], out=out[NORMAL_POINT])
        np.einsum("ij,ij->j", out[MIRROR], out[POINT], out=out[MIRROR_POINT])
        np.negative(out[NORMAL_POINT], out=out[NORMAL_POINT])
        np.negative(out[MIRROR_POINT], out=out[MIRROR_POINT])

    for table in (rows, pixels):
        table.flags.writeable = False
    return Seen(
        projected.lines,
        projected.elements,
        pixels,
        surface_slices(surface_at_pixel),
        polygon[span],
        inverse_depth,
        rows,
        view,
        projected.unit,
        middle,
    )


def _along_spans(
    winners: Winners, projected: Projection, focal_length: float, middle: Floats
) -> tuple[Singles, Singles]:
    """What is linear along each span: its value at the first pixel, and what each further pixel adds.

    The values are (9, spans) float32: the normal times the inverse depth; the point around the middle times
    the inverse depth, which is the ray less the middle times it; and the ray, whose step is the same for all.
    The steps are (6, spans). The difference is taken here in float64, so that a point is as exact from afar
    as from near.
    """
    line, first = np.divmod(winners.first_pixel, projected.elements)
    left, left_depth, left_normal = _at_cuts(projected, winners.left_edge, line)
    right, right_depth, right_normal = _at_cuts(projected, winners.right_edge, line)
    width, begin = right - left, first + 0.5 - left

    # Bring the normals to about the size of 1, so that float32 holds them however far the object is.
    size = np.abs(left_normal).max(axis=0) + np.abs(right_normal).max(axis=0)
    size[size == 0] = 1
    start = np.empty((RAY_ACROSS + 3, len(line)), np.float32)
    step = np.empty((RAY_ACROSS, len(line)), np.float32)
    normal_step = (right_normal - left_normal) / width
    start[:3] = (left_normal + normal_step * begin) / size
    step[:3] = normal_step / size

    depth_step = (right_depth - left_depth) / width
    depth = left_depth + depth_step * begin
    ray = (
        (first + 0.5 - projected.elements / 2) / focal_length,
        (line + 0.5 - projected.lines / 2) / focal_length,
        1.0,
    )
    ray_step = (1 / focal_length, 0.0, 0.0)
    for axis in range(3):
        start[3 + axis] = ray[axis] - middle[axis] * depth
        start[RAY_ACROSS + axis] = ray[axis]
        step[3 + axis] = ray_step[axis] - middle[axis] * depth_step
    return start, step


def _at_cuts(projected: Projection, numbers: Numbers, line: Numbers) -> tuple[Floats, Floats, Floats]:
    """Where each edge is cut by its line, with inverse depth and normal times inverse depth, (3, spans)."""
    cut = edges(projected, numbers)
    corners, rows = projected.corners.ravel(), projected.corner_normals.ravel()
    a, b = corners[cut.top], corners[cut.bottom]
    below_first = line - cut.first_line
    across = cut.across + below_first * cut.across_step
    inverse_depth = cut.inverse_depth + below_first * cut.inverse_depth_step
    way = (line + 0.5 - projected.down[a]) / (projected.down[b] - projected.down[a])
    # Measured: `take` along the second axis has a quarter of the time of an index there.
    normals = (1 - way) * projected.inverse_depth[a] * np.take(projected.normals, rows[cut.top], axis=1)
    normals += way * projected.inverse_depth[b] * np.take(projected.normals, rows[cut.bottom], axis=1)
    return across, inverse_depth, normals
