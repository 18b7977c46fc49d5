"""Watkins' scan-line algorithm as it is told: line by line, with an active-edge list.

Paper: "Introduction", [3, 21]. It is written to be read, and stands beside `visible_surfaces`, which does the
same for all lines at once: the two see the same polygon at every pixel.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.depth import DepthScale, depth_scale
from autocolor.visibility.edges import edges
from autocolor.visibility.interpolation import seen_of_spans
from autocolor.visibility.projection import Projection, least_of_four, projection
from autocolor.visibility.visible_points import Seen


@dataclass
class Edge:
    """An edge while it is active: where it is cut by its first line, and what each line adds."""

    top: int
    polygon: int
    falls: bool
    first_line: int
    beyond_line: int
    across: float
    across_step: float
    inverse_depth: float
    inverse_depth_step: float

    def cut(self, line: int) -> tuple[float, float]:
        """The place across and the inverse depth on a line."""
        down = line - self.first_line
        return self.across + down * self.across_step, self.inverse_depth + down * self.inverse_depth_step


@dataclass
class Span:
    """What a line sees of one polygon: its pixels from `first` to before `beyond`.

    The depth key is `start` at the first pixel and `step` more at each further one. `down_top` and `up_top`
    are the tops of its two edges.
    """

    polygon: int
    first: int
    beyond: int
    start: int
    step: int
    down_top: int
    up_top: int

    def key(self, element: int) -> tuple[int, int]:
        """The depth key at a pixel, the nearer the larger; of equal ones the later polygon counts."""
        return self.start + (element - self.first) * self.step, self.polygon


def watkins(
    mesh: Mesh,
    view: View,
    surface_numbers: tuple[int, ...],
    lines: int = 480,
    elements: int = 640,
    one_sided: frozenset[int] = frozenset(),
) -> Seen:
    """What is seen at each pixel; the arguments are those of `visible_surfaces`."""
    projected = projection(mesh, view, lines, elements)
    scale = depth_scale(projected)
    bucket = y_buckets(projected)
    active: list[Edge] = []
    span_at_pixel = np.zeros(lines * elements, np.int64)
    tops = np.zeros((2, int(projected.first_crossing[-1]) + 1), np.int32)
    top_line = least_of_four(projected.first_line[projected.corners])

    for line in range(lines):
        # Enter the edges that begin on this line, and drop those that ended above it.
        active = [edge for edge in active if edge.beyond_line > line] + bucket.get(line, [])
        # Find the visible spans from left to right.
        for span, first, beyond in visible_spans(spans_of_line(active, scale, line, elements)):
            number = int(projected.first_crossing[span.polygon] + line - top_line[span.polygon]) + 1
            tops[:, number] = span.down_top, span.up_top
            span_at_pixel[line * elements + first : line * elements + beyond] = number

    return seen_of_spans(
        span_at_pixel,
        tops,
        projected,
        mesh,
        view,
        surface_numbers,
        one_sided,
    )


def y_buckets(projected: Projection) -> dict[int, list[Edge]]:
    """The edges that cross a line, by the first line that they cross."""
    first_lines = projected.first_line[projected.corners]
    polygons = projected.corners.shape[1]
    starts = np.flatnonzero(first_lines != np.roll(first_lines, -1, axis=0))
    ends = (starts + polygons) % max(projected.corners.size, 1)
    falls = first_lines.ravel()[starts] < first_lines.ravel()[ends]
    cut = edges(projected, np.where(falls, starts, ends), np.where(falls, ends, starts))
    buckets: dict[int, list[Edge]] = {}
    for row in range(len(starts)):
        first_line = int(cut.first_line[row])
        edge = Edge(
            int(cut.top[row]),
            int(cut.top[row]) % polygons,
            bool(falls[row]),
            first_line,
            first_line + int(cut.count[row]),
            float(cut.across[row]),
            float(cut.across_step[row]),
            float(cut.inverse_depth[row]),
            float(cut.inverse_depth_step[row]),
        )
        buckets.setdefault(first_line, []).append(edge)
    return buckets


def spans_of_line(active: list[Edge], scale: DepthScale, line: int, elements: int) -> list[Span]:
    """The spans of a line that hold a pixel's center, in the order of their left ends."""
    pairs: dict[int, list[Edge]] = {}
    for edge in active:
        pairs.setdefault(edge.polygon, []).append(edge)
    spans = []
    for polygon, pair in pairs.items():
        # Pair the cuts of the polygon: the edge that it runs down, and the one that it runs up.
        down, up = sorted(pair, key=lambda edge: not edge.falls)
        left, right = sorted((down.cut(line), up.cut(line)), key=lambda cut: cut[0])
        first = min(max(math.ceil(left[0] - 0.5), 0), elements)
        beyond = min(max(math.ceil(right[0] - 0.5), 0), elements)
        if beyond > first:
            step = (right[1] - left[1]) / (right[0] - left[0])
            start = left[1] + (first + 0.5 - left[0]) * step
            spans.append(Span(polygon, first, beyond, scale.key(start), scale.key(step), down.top, up.top))
    return sorted(spans, key=lambda span: span.first)


def visible_spans(spans: list[Span]) -> Iterator[tuple[Span, int, int]]:
    """The spans that are seen and the pixels where they are, from left to right.

    The ends of the spans cut the line into intervals, within which none begins or ends.
    """
    ends = sorted({end for span in spans for end in (span.first, span.beyond)})
    active: list[Span] = []
    entering = iter(spans)
    following = next(entering, None)
    for first, beyond in pairwise(ends):
        active = [span for span in active if span.beyond > first]
        while following is not None and following.first == first:
            active.append(following)
            following = next(entering, None)
        if active:
            yield from nearest_in_interval(active, first, beyond)


def nearest_in_interval(spans: list[Span], first: int, beyond: int) -> Iterator[tuple[Span, int, int]]:
    """The nearest of the spans at the pixels of an interval, which is cut in two until it is one."""
    nearest = max(spans, key=lambda span: span.key(first))
    # Depths change evenly: what is nearest at both ends is nearest all the way.
    if all(nearest.key(beyond - 1) >= span.key(beyond - 1) for span in spans):
        yield nearest, first, beyond
        return
    middle = (first + beyond) // 2
    yield from nearest_in_interval(spans, first, middle)
    yield from nearest_in_interval(spans, middle, beyond)
