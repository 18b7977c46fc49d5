"""The default parts, surfaces, view and lights of a scene that does not define them.

Paper: "Introduction": tables with the part, surface and lighting parameters can be supplied as input or
created automatically by the system as they are needed. Assumed: all the values of these defaults.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from autocolor.arrays import Floats, chunks
from autocolor.scene.lights import Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.surfaces import Paint, Part, Surface
from autocolor.scene.view import View

FILLED: Final = 0.86
"""Assumed: the fraction of the width or height of the picture that a framed object fills."""

ASPECT: Final = 640 / 480
"""Assumed: that of the paper's display; a picture of another shape shows more or less at its sides."""

POINT: Final = 1e-12
"""Assumed: an object smaller than this fraction of its distance from the origin is treated as a point."""

POINTS_AT_ONCE: Final = 1 << 14
"""Few enough that numpy multiplies in one thread; waiting for threads is slow on shared processors."""

OBJECT_COLORS: Final = (
    "#b3202c", "#2f5fa8", "#c9a227", "#3f7f4f", "#7d4a94", "#c8642c",
    "#3a8c92", "#a8426a", "#7c8a3a", "#5561a8", "#8c5a3c", "#8a949e",
)  # fmt: skip
"""Assumed: distinguishable object colors, assigned to the surfaces in turn."""


def default_parts(mesh: Mesh, surface_of_part: Mapping[str, str]) -> tuple[Part, ...]:
    """A part for each part name of the mesh; its surface is that in `surface_of_part`, else its own name."""
    return tuple(Part(name, surface_of_part.get(name, name)) for name in mesh.part_names)


def default_surface(name: str, number: int) -> Surface:
    """A glossy surface; its object color is chosen by the number of the surface, counted from 0."""
    return Surface(name, paint=Paint(object_color=OBJECT_COLORS[number % len(OBJECT_COLORS)]))  # type: ignore[arg-type]


def default_view(mesh: Mesh) -> View:
    """A view from the front left and slightly above, at the distance that frames the whole object."""
    azimuth, elevation = math.radians(-125.0), math.radians(18.0)
    toward_eye = (
        math.cos(elevation) * math.cos(azimuth),
        math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation),
    )
    return framed(View(eye=toward_eye, target=(0.0, 0.0, 0.0)), mesh)


def framed(view: View, mesh: Mesh, filled: float = FILLED) -> View:
    """The view with the eye moved, but not turned, so that the object fills the picture, with a margin.

    Paper: Figure 5, RESCALE.
    """
    axes = view.axes
    center, radius = _sphere_around(mesh)
    if _is_a_point(mesh):
        points = center[:, None] + radius * np.array([[-0.5, 0.5]] * 3)
    else:
        points = mesh.used_coordinates.T

    # For an eye moved by `shift` and moved back by `distance`, a point is within the picture if
    # |x - shift| <= slope * (depth + distance), and likewise for y. The two extreme points of an axis give
    # its shift and its least distance; the larger of the two distances is taken.
    slope_y = filled * math.tan(math.radians(view.field_of_view) / 2)
    slopes = np.array([slope_y * ASPECT, slope_y])
    least, most, nearest, size = np.full(2, np.inf), np.full(2, -np.inf), np.inf, 0.0
    for chunk in chunks(points.shape[1], POINTS_AT_ONCE):
        camera_points = axes @ (points[:, chunk] - center[:, None])
        reach = slopes[:, None] * camera_points[2]
        least = np.minimum(least, (camera_points[:2] + reach).min(axis=1))
        most = np.maximum(most, (camera_points[:2] - reach).max(axis=1))
        nearest = min(nearest, float(camera_points[2].min()))
        size = max(size, float(np.abs(camera_points).max()))
    shifts = (least + most) / 2
    distances = (most - least) / (2 * slopes)
    distance = max(*distances.tolist(), size * 1e-3 - nearest)
    eye = center + axes.T @ np.array([*shifts, -distance])
    forward = axes[2]
    return view.replace(eye=tuple(eye), direction=tuple(forward))


def _is_a_point(mesh: Mesh) -> bool:
    """Whether the object is so small relative to its distance from the origin that it is a point."""
    low, high = mesh.bounds
    return float((high - low).max()) <= POINT * float(np.abs([low, high]).max())


def _sphere_around(mesh: Mesh) -> tuple[Floats, float]:
    """The center and radius of a sphere around the object; an object treated as a point gets some room."""
    low, high = mesh.bounds
    if _is_a_point(mesh):
        return (low + high) / 2, max(1.0, 1e3 * POINT * float(np.abs([low, high]).max()))
    # Scale by the largest extent first, as the squares of very small extents underflow.
    extent = (high - low).max()
    return (low + high) / 2, float(np.linalg.norm((high - low) / extent) * extent / 2)


def default_lights(mesh: Mesh, view: View) -> tuple[Light, ...]:
    """Four studio lights aimed at the object, with positions relative to the view.

    As seen from the eye, the key light is at the upper left, the fill light at the right, the top light above
    and the rim light behind, as around a car in a photographer's studio (Paper: "Light Controls").
    """
    center, radius = _sphere_around(mesh)
    right, down, forward = view.axes
    if abs(forward[2]) > 0.99:
        up, away = -down, forward
    else:
        up = np.array([0.0, 0.0, 1.0])
        away = np.array([forward[0], forward[1], 0.0])
        away /= np.linalg.norm(away)
        right = np.cross(away, up)

    def light(
        name: str, to_right: float, to_up: float, to_eye: float, intensity: float, concentration: float
    ) -> Light:
        position = center + radius * (to_right * right + to_up * up - to_eye * away)
        return Light(
            name, tuple(position.tolist()), intensity, aim=tuple(center.tolist()), concentration=concentration
        )  # fmt: skip

    return (
        light("key", -1.8, 2.0, 1.9, 1.0, 2.0),
        light("fill", 2.6, 0.7, 1.4, 0.35, 1.0),
        light("top", 0.3, 3.2, -0.3, 0.5, 3.0),
        light("rim", 1.0, 1.4, -2.8, 0.5, 2.0),
    )
