"""Curves and patches: cubic B-splines, natural cubic splines, Coons patches, the inversion of a surface.

What shapes a body panel is twice continuously differentiable, because a highlight shows every kink.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Surface = Callable[[Array, Array], Array]


def basis(count: int, t: ArrayLike) -> Array:
    """Return the clamped uniform cubic B-spline basis, shape (..., count), at t from 0 to count - 3."""
    at = np.clip(np.asarray(t, dtype=float), 0.0, count - 3.0)[..., None]
    knots = np.concatenate([np.zeros(3), np.arange(count - 2), np.full(3, count - 3)]).astype(float)
    span = np.minimum(at.astype(int), count - 4)
    values: Array = (np.arange(count + 3) == span + 3).astype(float)
    for degree in (1, 2, 3):
        low, high = knots[: count + 3 - degree], knots[degree + 1 :]
        rise = np.maximum(knots[degree:-1] - low, 1e-12)
        fall = np.maximum(high - knots[1 : count + 4 - degree], 1e-12)
        values = values[..., :-1] * (at - low) / rise + values[..., 1:] * (high - at) / fall
    return values


def bspline(control: ArrayLike, t: ArrayLike) -> Array:
    """Return points of the clamped cubic B-spline with these control points, t from 0 to count - 3."""
    control = np.asarray(control, dtype=float)
    points: Array = np.tensordot(basis(len(control), t), control, axes=1)
    return points


def smooth(knots: Sequence[tuple[float, float]]) -> Callable[[ArrayLike], Array]:
    """Return the natural cubic spline through (x, value) pairs, a function of x; straight beyond its ends."""
    x, y = np.array(knots, dtype=float).T
    h, slope = np.diff(x), np.diff(y) / np.diff(x)
    matrix, right = np.eye(len(x)), np.zeros(len(x))
    for k in range(1, len(x) - 1):
        matrix[k, k - 1 : k + 2] = h[k - 1], 2 * (h[k - 1] + h[k]), h[k]
        right[k] = 6 * (slope[k] - slope[k - 1])
    bend = np.linalg.solve(matrix, right)

    def value(place: ArrayLike) -> Array:
        at = np.asarray(place, dtype=float)
        inner = np.clip(at, x[0], x[-1])
        k = np.clip(np.searchsorted(x, inner) - 1, 0, len(x) - 2)
        u = inner - x[k]
        first = slope[k] - h[k] * (2 * bend[k] + bend[k + 1]) / 6
        inside = y[k] + u * (first + u * (bend[k] / 2 + u * (bend[k + 1] - bend[k]) / (6 * h[k])))
        start, end = slope[0] - h[0] * bend[1] / 6, slope[-1] + h[-1] * bend[-2] / 6
        height: Array = inside + (at - inner) * np.where(at < inner, start, end)
        return height

    return value


def ease(x: ArrayLike, start: float, end: float) -> Array:
    """Return 0 before start, 1 after end, and a quintic with no jump in curvature between."""
    u = np.clip((np.asarray(x, dtype=float) - start) / (end - start), 0.0, 1.0)
    eased: Array = u**3 * (10 - 15 * u + 6 * u * u)
    return eased


def spaced(*stops: float, counts: Sequence[int]) -> Array:
    """Return numbers through all stops, counts[k] equal steps between stop k and the next."""
    pieces = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(stops[:-1], stops[1:], counts, strict=True)]
    return np.concatenate([*pieces, [stops[-1]]])


def coons(bottom: Array, top: Array, left: Array, right: Array) -> Array:
    """Return the (n, m, k) grid between border curves: bottom and top of n points, left and right of m."""
    i = np.linspace(0, 1, len(bottom))[:, None, None]
    j = np.linspace(0, 1, len(left))[None, :, None]
    ruled = bottom[:, None] * (1 - j) + top[:, None] * j + left[None] * (1 - i) + right[None] * i
    twist = (bottom[0] * (1 - i) + bottom[-1] * i) * (1 - j) + (top[0] * (1 - i) + top[-1] * i) * j
    grid: Array = ruled - twist
    return grid


def segment(start: ArrayLike, end: ArrayLike, steps: int) -> Array:
    """Return steps + 1 points of the straight line from start to end."""
    u = np.linspace(0, 1, steps + 1)[:, None]
    return np.asarray(start, dtype=float) * (1 - u) + np.asarray(end, dtype=float) * u


def invert(surface: Surface, target: Array, axes: tuple[int, int], guess: Array) -> Array:
    """Return the parameters (n, 2) at which two coordinates of the surface meet the target (n, 2).

    Newton's rule with difference quotients; raises ValueError where it does not arrive.
    """
    at, step = guess.copy(), 1e-5
    for _ in range(40):
        here = surface(at[:, 0], at[:, 1])[:, axes]
        by_s = (surface(at[:, 0] + step, at[:, 1])[:, axes] - here) / step
        by_v = (surface(at[:, 0], at[:, 1] + step)[:, axes] - here) / step
        miss = target - here
        determinant = by_s[:, 0] * by_v[:, 1] - by_s[:, 1] * by_v[:, 0]
        s = (miss[:, 0] * by_v[:, 1] - miss[:, 1] * by_v[:, 0]) / determinant
        v = (by_s[:, 0] * miss[:, 1] - by_s[:, 1] * miss[:, 0]) / determinant
        at = at + np.clip(np.stack([s, v], axis=1), -0.5, 0.5)
    if np.abs(miss).max() > 1e-6:
        raise ValueError(f"a panel outline must lie on its surface, not {np.abs(miss).max():.6f} m off it")
    return at


def bezier(start: Array, corner: Array, end: Array, at: Sequence[float]) -> Array:
    """Return quadratic Bezier arcs (n, len(at), 3) from start to end, tangent to the lines to corner."""
    u = np.array(at)[None, :, None]
    arc: Array = start[:, None] * (1 - u) ** 2 + corner[:, None] * 2 * u * (1 - u) + end[:, None] * u**2
    return arc
