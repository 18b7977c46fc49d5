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

from autocolor.edges import edges
from autocolor.mesh import Mesh
from autocolor.projection import Projection, projection
from autocolor.seen import Seen, Winners, seen_of_winners
from autocolor.view import View

CLEARLY = 1e-5
"""How much nearer a segment must be, as a fraction, for rounding not to matter between two samples."""


@dataclass
class Edge:
    """An edge while it is active: where it is cut by its first line, and what each line adds."""

    number: int
    polygon: int
    first_line: int
    beyond_line: int
    across: float
    across_step: float
    inverse_depth: float
    inverse_depth_step: float

    def cut(self, line: int) -> tuple[float, float, int]:
        """The place across and the inverse depth on a line, and the edge's number."""
        down = line - self.first_line
        return (
            self.across + down * self.across_step,
            self.inverse_depth + down * self.inverse_depth_step,
            self.number,
        )


@dataclass
class Segment:
    """What a line sees of one polygon: its samples from `first` to before `beyond`."""

    polygon: int
    first: int
    beyond: int
    start: np.float32
    step: np.float32
    left_edge: int
    right_edge: int

    def inverse_depth(self, element: int) -> np.float32:
        """The inverse depth at a sample."""
        nearness: np.float32 = self.start + np.float32(element - self.first) * self.step
        return nearness


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
    bucket = y_buckets(projected)
    active: list[Edge] = []
    pixels: list[int] = []
    depths: list[np.float32] = []
    seen_segment: list[int] = []
    segments_seen: list[tuple[int, Segment]] = []

    for line in range(lines):
        # Enter the edges that begin on this line, and drop those that ended above it.
        active = [edge for edge in active if edge.beyond_line > line] + bucket.get(line, [])
        # Find the visible segments from left to right.
        for segment, first, beyond in visible_segments(segments_of_line(active, line, elements)):
            segments_seen.append((line * elements + segment.first, segment))
            for element in range(first, beyond):
                pixels.append(line * elements + element)
                depths.append(segment.inverse_depth(element))
                seen_segment.append(len(segments_seen) - 1)

    winners = Winners(
        np.array(pixels, np.intp),
        np.array(depths, np.float32),
        np.array(seen_segment, np.intp),
        np.array([first_pixel for first_pixel, _ in segments_seen], np.intp),
        np.array([segment.left_edge for _, segment in segments_seen], np.intp),
        np.array([segment.right_edge for _, segment in segments_seen], np.intp),
    )
    return seen_of_winners(winners, projected, mesh, view, surface_numbers, one_sided)


def y_buckets(projected: Projection) -> dict[int, list[Edge]]:
    """The edges that cross a line, by the first line that they cross."""
    first_lines = projected.first_line[projected.corners]
    numbers = np.flatnonzero(first_lines != np.roll(first_lines, -1, axis=0))
    polygons = projected.corners.shape[1]
    cut = edges(projected, numbers)
    buckets: dict[int, list[Edge]] = {}
    for row, number in enumerate(numbers.tolist()):
        first_line = int(cut.first_line[row])
        edge = Edge(
            number,
            number % polygons,
            first_line,
            first_line + int(cut.count[row]),
            float(cut.across[row]),
            float(cut.across_step[row]),
            float(cut.inverse_depth[row]),
            float(cut.inverse_depth_step[row]),
        )
        buckets.setdefault(first_line, []).append(edge)
    return buckets


def segments_of_line(active: list[Edge], line: int, elements: int) -> list[Segment]:
    """The segments of a line that hold a sample, in the order of their left ends."""
    cuts: dict[int, list[tuple[float, float, int]]] = {}
    for edge in active:
        cuts.setdefault(edge.polygon, []).append(edge.cut(line))
    segments = []
    for polygon, (one, other) in cuts.items():
        # Pair the two cuts of the polygon, the left one first.
        left, right = (one, other) if one[0] <= other[0] else (other, one)
        first = min(max(math.ceil(left[0] - 0.5), 0), elements)
        beyond = min(max(math.ceil(right[0] - 0.5), 0), elements)
        if beyond > first:
            step = (right[1] - left[1]) / (right[0] - left[0])
            start = left[1] + (first + 0.5 - left[0]) * step
            segments.append(
                Segment(polygon, first, beyond, np.float32(start), np.float32(step), left[2], right[2])
            )
    return sorted(segments, key=lambda segment: segment.first)


def visible_segments(segments: list[Segment]) -> Iterator[tuple[Segment, int, int]]:
    """The segments that are seen and the samples where they are, from left to right.

    The ends of the segments cut the line into sample spans, within which none begins or ends.
    """
    ends = sorted({end for segment in segments for end in (segment.first, segment.beyond)})
    active: list[Segment] = []
    entering = iter(segments)
    following = next(entering, None)
    for first, beyond in pairwise(ends):
        active = [segment for segment in active if segment.beyond > first]
        while following is not None and following.first == first:
            active.append(following)
            following = next(entering, None)
        if active:
            yield from nearest_in_span(active, first, beyond)


def nearest_in_span(segments: list[Segment], first: int, beyond: int) -> Iterator[tuple[Segment, int, int]]:
    """The nearest of the segments at the samples of a span; the span is cut in two until one is clear."""
    if len(segments) == 1:
        yield segments[0], first, beyond
        return
    at_first = max(segments, key=lambda segment: (segment.inverse_depth(first), segment.polygon))
    if beyond - first == 1:
        yield at_first, first, beyond
        return
    # One that is clearly nearest at both ends is nearest all the way, for depths change evenly.
    others = [segment for segment in segments if segment is not at_first]
    if all(
        at_first.inverse_depth(end) > segment.inverse_depth(end) * (1 + CLEARLY)
        for segment in others
        for end in (first, beyond - 1)
    ):
        yield at_first, first, beyond
        return
    middle = (first + beyond) // 2
    yield from nearest_in_span(segments, first, middle)
    yield from nearest_in_span(segments, middle, beyond)
