"""Watkins' scan-line algorithm as published: line by line, with an active-edge list.

Paper: "Introduction", [3, 21]. It is written to be read. `visible_surfaces` finds the same polygon at every
pixel, for all lines at once and with a depth buffer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from autocolor.arrays import Numbers, underflowing
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import SCAN_LINE
from autocolor.scene.view import View
from autocolor.visibility.depth import (
    DepthScale,
    depth_scale,
    numbers_of_polygons,
    plane_keys,
    polygons_of_numbers,
)
from autocolor.visibility.projection import Projection, projection
from autocolor.visibility.scan_lines import edges
from autocolor.visibility.visible_points import VisiblePoints
from autocolor.visibility.visible_surfaces import interpolated_points


@dataclass
class Edge:
    """An active edge: its values at the first line that it crosses, and their steps from line to line.

    `number` is the number of its polygon in depth keys.
    """

    number: int
    descends: bool
    first_line: int
    end_line: int
    x: float
    x_step: float
    inverse_depth: float
    inverse_depth_step: float

    def crossing(self, line: int) -> tuple[float, float]:
        """The screen x and the inverse depth where the edge crosses a line."""
        lines_below = line - self.first_line
        return self.x + lines_below * self.x_step, self.inverse_depth + lines_below * self.inverse_depth_step


@dataclass
class Segment:
    """The extent of a polygon on a line: its pixels from `first` to before `end`.

    The depth key is `start` at the first pixel and changes by `step` to the next. `number` is the number of
    the polygon in depth keys.
    """

    number: int
    first: int
    end: int
    start: int
    step: int

    def key(self, element: int) -> tuple[int, int]:
        """The depth key at a pixel, the nearer the larger; of equal keys the higher number wins."""
        return self.start + (element - self.first) * self.step, self.number


@underflowing
def watkins(
    mesh: Mesh,
    view: View,
    surface_numbers: tuple[int, ...],
    lines: int = 480,
    elements: int = 640,
    one_sided: frozenset[int] = frozenset(),
    interpolation: str = SCAN_LINE,
) -> VisiblePoints:
    """The visible points of a mesh in a view; the arguments are as in `visible_surfaces`."""
    projected = projection(mesh, view, lines, elements, interpolation)
    number_at_pixel = np.concatenate(list(numbers_by_line(projected)))
    return interpolated_points(projected, number_at_pixel, surface_numbers, one_sided)


def numbers_by_line(projected: Projection) -> Iterator[Numbers]:
    """The number of the visible polygon at each pixel of each line, (elements,) int64, 0 for none.

    The numbers are as in depth keys. The lines follow from the top; a line is computed when it is asked for.
    """
    scale = depth_scale(projected)
    active: list[Edge] = []
    for line, beginning in enumerate(edges_by_line(projected)):
        # Add the edges that begin on this line, and drop those that ended above it.
        active = [edge for edge in active if edge.end_line > line] + beginning
        # Find the visible spans from left to right.
        numbers = np.zeros(projected.elements, np.int64)
        for segment, first, end in visible_spans(segments_of_line(active, projected, scale, line)):
            numbers[first:end] = segment.number
        yield numbers


def edges_by_line(projected: Projection) -> Iterator[list[Edge]]:
    """For each line, from the top, the edges that begin there: Watkins' y-buckets.

    The edges of a line are listed only when the line is asked for: the first line does not wait for the rest.
    """
    first_lines = projected.first_line[projected.corners]
    polygons = projected.corners.shape[1]
    starts = np.flatnonzero(first_lines != np.roll(first_lines, -1, axis=0))
    ends = (starts + polygons) % max(projected.corners.size, 1)
    descends = first_lines.ravel()[starts] < first_lines.ravel()[ends]
    of_lines = edges(projected, np.where(descends, starts, ends), np.where(descends, ends, starts))
    columns = (
        numbers_of_polygons(projected, starts % max(polygons, 1)),
        descends,
        of_lines.first_line,
        of_lines.first_line + of_lines.count,
        of_lines.x,
        of_lines.x_step,
        of_lines.inverse_depth,
        of_lines.inverse_depth_step,
    )
    by_first_line = np.argsort(of_lines.first_line, kind="stable")
    bounds = np.searchsorted(of_lines.first_line[by_first_line], np.arange(projected.lines + 1))
    for first, end in pairwise(bounds.tolist()):
        rows = by_first_line[first:end]
        fields = [column[rows].tolist() for column in columns]
        yield [Edge(*row) for row in zip(*fields, strict=True)]


def segments_of_line(
    active: list[Edge], projected: Projection, scale: DepthScale, line: int
) -> list[Segment]:
    """The segments of a line that cover the center of a pixel, sorted by their left ends."""
    pairs: dict[int, list[Edge]] = {}
    for edge in active:
        pairs.setdefault(edge.number, []).append(edge)
    segments = []
    for number, pair in pairs.items():
        # Pair the crossings of the polygon: one edge leads down the raster, the other back up.
        down, up = sorted(pair, key=lambda edge: not edge.descends)
        left, right = sorted((down.crossing(line), up.crossing(line)), key=lambda crossing: crossing[0])
        first = min(max(math.ceil(left[0] - 0.5), 0), projected.elements)
        end = min(max(math.ceil(right[0] - 0.5), 0), projected.elements)
        if end > first:
            step = (right[1] - left[1]) / (right[0] - left[0])
            start = left[1] + (first + 0.5 - left[0]) * step
            keys = key_of_plane(projected, scale, number, line, first)
            segments.append(Segment(number, first, end, *(keys or (scale.key(start), scale.key(step)))))
    return sorted(segments, key=lambda segment: segment.first)


def key_of_plane(
    projected: Projection, scale: DepthScale, number: int, line: int, element: int
) -> tuple[int, int] | None:
    """The depth key at a pixel and its step, from the shared plane of a polygon; None if it has none."""
    if scale.planes is None:
        return None
    plane = scale.planes[polygons_of_numbers(projected, np.array([number]))]
    if plane[0] < 0:
        return None
    start, step = plane_keys(projected, scale, plane, np.array([line]), np.array([element]))
    return int(start[0]), int(step[0])


def visible_spans(segments: list[Segment]) -> Iterator[tuple[Segment, int, int]]:
    """The visible spans of a line from left to right: the segment, and the pixels where it is visible.

    The ends of the segments divide the line into intervals within which no segment begins or ends.
    """
    ends = sorted({end for segment in segments for end in (segment.first, segment.end)})
    active: list[Segment] = []
    entering = iter(segments)
    following = next(entering, None)
    for first, end in pairwise(ends):
        active = [segment for segment in active if segment.end > first]
        while following is not None and following.first == first:
            active.append(following)
            following = next(entering, None)
        if active:
            yield from nearest_in_interval(active, first, end)


def nearest_in_interval(segments: list[Segment], first: int, end: int) -> Iterator[tuple[Segment, int, int]]:
    """The nearest segments at the pixels of an interval, halved until one segment is nearest all over."""
    nearest = max(segments, key=lambda segment: segment.key(first))
    # Depth is linear: a segment that is nearest at both ends is nearest in between.
    if all(nearest.key(end - 1) >= segment.key(end - 1) for segment in segments):
        yield nearest, first, end
        return
    middle = (first + end) // 2
    yield from nearest_in_interval(segments, first, middle)
    yield from nearest_in_interval(segments, middle, end)
