"""The default parts, surfaces, view and lights of a scene that does not define them.

Paper: "Introduction": tables with the part, surface and lighting parameters can be supplied as input or
created automatically by the system as they are needed. Assumed: all the values of these defaults.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Floats, bounds_of, chunks, underflowing
from autocolor.checks import Color
from autocolor.scene.lights import Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.surfaces import Paint, Part, Reflectance, Surface
from autocolor.scene.view import ASPECT, View

FILLED: Final = 0.86
"""Assumed: the fraction of the width or height of the picture that a framed object fills."""

LOWEST_EYE: Final = 21.0
HIGHEST_EYE: Final = 40.0
"""Assumed: the elevations of the eye of a new view, in degrees: above a solid object, and above a sheet."""

AZIMUTH: Final = -55.0
"""Assumed: the azimuth of the eye of a new view, in degrees from +x toward +y."""

FLAT: Final = 0.5
"""Assumed: an object whose height over the root of its ground area is less is seen from higher."""

POINT: Final = 1e-12
"""Assumed: an object smaller than this fraction of its distance from the origin is treated as a point."""

LEAST_EXTENT: Final = 1e-290
"""Assumed: a smaller object is treated as a point, because the reciprocals of its distances overflow."""

MOST_STEPS: Final = 8
"""Steps to center an object; three are usually enough."""

POINTS_AT_ONCE: Final = 1 << 14
"""Few enough that numpy multiplies in a single thread. Waiting for threads is slow on shared processors."""

OBJECT_COLORS: Final = (
    "#f4a39b", "#9ebeef", "#e2c24e", "#98d0a3", "#cda8e3", "#f3ab70",
    "#83d2d0", "#f49cbe", "#bec866", "#afb4f4", "#dab195", "#b7c1ca",
)  # fmt: skip
"""Assumed: distinguishable object colors, assigned to the surfaces in turn.

They are light, with a luma of 0.73 to 0.75, because shading darkens them."""

CREATED_REFLECTANCE: Final = Reflectance(0.7, 0.76, exponent=32.0)
"""Assumed: the reflectance of the surfaces of a bare mesh."""

PLAIN_PAINT: Final = Paint((164, 180, 198), blend=0.8)
"""Assumed: a steel blue, for the surface that all parts without a surface share."""

COLORED_PAINT: Final = Paint(PLAIN_PAINT.object_color, blend=0.88, light_percentage=60.0)
"""Assumed: the blending of all other surfaces of a bare mesh.

An evenly lit side may be the brightest of the object, and should still have its color. If the light color
began at 0.8 of the range, the top of a red box would be pink.
"""

TRIMMED: Final = "99.5 %"
"""Assumed: the exposure of a bare mesh. Specks that are seen through cracks do not set its range."""

MAPPING_FIELDS: Final = {
    "scaling": "object",
    "exposure": TRIMMED,
    "contrast": "floor",
    "mapping": ((0.0, 0.04), (0.12, 0.05), (0.3, 0.38), (0.55, 0.64), (0.8, 0.77), (1.0, 0.95)),
    "ambient": 0.13,
    "interpolation": "invariant",
}
"""Assumed: the mapping, the ambient light and the interpolation of a bare mesh.

Measured with the lights, colors and reflectance of this module: `python -m benchmarks.form` renders twenty
shapes and given meshes from three sides. It bounds the tone, the share of a picture that is too dark or too
bright, and the difference between the two sides of an edge (docs/FORM.md). A search over these shapes found
the values. The curve ends below 1, or an evenly lit face would be white all over.

Measured and rejected: a low key light at the left and a strong fill light. Of thirty meshes, 29 have a tone
of 0.42 to 0.58, but 47 of 903 edges do not show, and the top of a cube is its darkest side. The same eye from
the front left: the bounds then need a key light below the eye.
"""


def object_coordinates(mesh: Mesh, parts: Sequence[Part]) -> Floats:
    """The coordinates of the nodes of the object, (nodes, 3).

    The object is all parts that are not stage; if all parts are stage, it is the whole mesh.
    """
    numbers = _object_parts(mesh, parts)
    return mesh.used_coordinates if numbers is None else mesh.coordinates_of_parts(numbers)


def object_bounds(mesh: Mesh, parts: Sequence[Part]) -> tuple[Floats, Floats]:
    """The least and the largest coordinates of the object, (3,) each; for the whole mesh they are cached."""
    numbers = _object_parts(mesh, parts)
    return mesh.bounds if numbers is None else bounds_of(mesh.coordinates_of_parts(numbers))


def stage_top(mesh: Mesh, parts: Sequence[Part]) -> float:
    """The largest z coordinate of the stage; minus infinity without a stage beside the object."""
    numbers = _object_parts(mesh, parts)
    if numbers is None:
        return -math.inf
    stage = [number for number in mesh.parts_in_use if number not in numbers]
    return float(mesh.coordinates_of_parts(stage)[:, 2].max())


def _object_parts(mesh: Mesh, parts: Sequence[Part]) -> Sequence[int] | None:
    """The part numbers of the object; None for the whole mesh."""
    numbers = [number for number in mesh.parts_in_use if not parts[number].stage]
    return numbers if 0 < len(numbers) < len(mesh.parts_in_use) else None


def default_surface(name: str, number: int) -> Surface:
    """The surface of an empty table in a scene file; its number, from 0, determines its object color."""
    return Surface(name).replace(object_color=color_in_turn(number))


def color_in_turn(number: int) -> str:
    """The object color of a surface by its number, counted from 0."""
    return OBJECT_COLORS[number % len(OBJECT_COLORS)]


def created_surface(name: str, object_color: str | Color | None = None) -> Surface:
    """A glossy surface for parts without a surface; without an object color it has PLAIN_PAINT."""
    if object_color is None:
        return Surface(name, CREATED_REFLECTANCE, PLAIN_PAINT)
    return Surface(name, CREATED_REFLECTANCE, COLORED_PAINT.replace(object_color=object_color))


def default_view(coordinates: Floats) -> View:
    """A view from the front right and above, at the distance that frames the whole object.

    The flatter the object, the higher is the eye. `coordinates`, here and below, are the coordinates of the
    object's nodes, (nodes, 3).
    """
    azimuth, elevation = math.radians(AZIMUTH), math.radians(_elevation_above(*bounds_of(coordinates)))
    toward_eye = (
        math.cos(elevation) * math.cos(azimuth),
        math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation),
    )
    return framed(View(eye=toward_eye, target=(0.0, 0.0, 0.0)), coordinates)


@underflowing
def _elevation_above(low: Floats, high: Floats) -> float:
    """The elevation of the eye in degrees, LOWEST_EYE to HIGHEST_EYE, for the bounds of an object.

    It falls with the height of the object over the square root of its ground area, down to LOWEST_EYE for an
    object of FLAT or more. The ground area of a wall that stands is small, and it is seen from LOWEST_EYE.
    """
    if _is_a_point(low, high):
        return LOWEST_EYE
    width, depth, height = ((high - low) / (high - low).max()).tolist()
    ground = FLAT * math.sqrt(width * depth)
    flatness = max(0.0, 1 - height / ground) if ground else 0.0
    return LOWEST_EYE + (HIGHEST_EYE - LOWEST_EYE) * flatness


@underflowing
def framed(view: View, coordinates: Floats, aspect: float = ASPECT) -> View:
    """The view with the eye moved, but not turned, so that the object fills the picture, with a margin.

    `aspect` is the width of the picture over its height. Paper: Figure 5, RESCALE.
    """
    axes = view.axes
    low, high = bounds_of(coordinates)
    center, radius = sphere_around(low, high)
    points = coordinates.T
    if _is_a_point(low, high):
        points = center[:, None] + radius * np.array([[-0.5, 0.5]] * 3)

    # If the eye moves sideways by `shift` and back by `distance`, a point is within the picture if
    # |x - shift| <= slope * (depth + distance), and likewise for y. The two extreme points of an axis give
    # its shift and its least distance. Use the larger of the two distances.
    slope_y = FILLED * view.half_height(aspect)
    slopes = np.array([slope_y * aspect, slope_y])
    camera_points = np.concatenate(
        [axes @ (points[:, chunk] - center[:, None]) for chunk in chunks(points.shape[1], POINTS_AT_ONCE)],
        axis=1,
    )
    reach = slopes[:, None] * camera_points[2]
    least, most = (camera_points[:2] + reach).min(axis=1), (camera_points[:2] - reach).max(axis=1)
    distances = (most - least) / (2 * slopes)
    size = float(np.abs(camera_points).max())
    distance = max(*distances.tolist(), size * 1e-3 - float(camera_points[2].min()))
    shifts = _centering_shifts(camera_points, distance, (least + most) / 2)
    eye = center + axes.T @ np.array([*shifts, -distance])
    forward = axes[2]
    return view.replace(eye=tuple(eye), direction=tuple(forward))


def _centering_shifts(camera_points: Floats, distance: float, shifts: Floats) -> Floats:
    """The shifts of the eye, right and down, that put the object into the middle of the picture.

    A step finds the two points at opposite borders, and centers them. A few steps are enough.
    """
    for _ in range(MOST_STEPS):
        on_screen = (camera_points[:2] - shifts[:, None]) / (camera_points[2] + distance)
        at_borders = np.stack([on_screen.argmin(axis=1), on_screen.argmax(axis=1)], axis=1)
        # Make the screen coordinates of both points of an axis opposite.
        weights = 1 / (camera_points[2].take(at_borders) + distance)
        across = camera_points[[[0], [1]], at_borders]
        centered = (across * weights).sum(axis=1) / weights.sum(axis=1)
        if (np.abs(centered - shifts) <= 1e-9 * distance).all():
            break
        shifts = centered
    return shifts


def _is_a_point(low: Floats, high: Floats) -> bool:
    """Whether an object is treated as a point: it is tiny, or tiny for its distance from the origin."""
    return float((high - low).max()) <= max(POINT * float(np.abs([low, high]).max()), LEAST_EXTENT)


@underflowing
def sphere_around(low: Floats, high: Floats) -> tuple[Floats, float]:
    """The center and the radius of a sphere around an object. An object treated as a point gets some room."""
    if _is_a_point(low, high):
        return (low + high) / 2, max(1.0, 1e3 * POINT * float(np.abs([low, high]).max()))
    # Scale by the largest extent first, as the squares of very small extents underflow.
    extent = (high - low).max()
    return (low + high) / 2, float(np.linalg.norm((high - low) / extent) * extent / 2)


@underflowing
def studio_axes(view: View) -> tuple[Floats, Floats, Floats]:
    """The unit vectors to the right, up and away, as seen from the eye; up is the world's up.

    If the view is almost vertical, up is the picture's up.
    """
    right, down, forward = view.axes
    if abs(forward[2]) > 0.99:
        return right, -down, forward
    up = np.array([0.0, 0.0, 1.0])
    away = np.array([forward[0], forward[1], 0.0])
    away /= np.linalg.norm(away)
    return np.cross(away, up), up, away


def default_lights(coordinates: Floats, view: View) -> tuple[Light, ...]:
    """Four studio lights aimed at the object, with positions relative to the view.

    As seen from the eye, the key light is at the upper left and the fill light at the right. The top light is
    above, and the rim light behind, as around a car in a photographer's studio (Paper: "Light Controls").
    """
    center, radius = sphere_around(*bounds_of(coordinates))
    right, up, away = studio_axes(view)

    def light(
        name: str, to_right: float, to_up: float, to_eye: float, intensity: float, concentration: float
    ) -> Light:
        position = center + radius * (to_right * right + to_up * up - to_eye * away)
        return Light(
            name, tuple(position.tolist()), intensity, aim=tuple(center.tolist()), concentration=concentration
        )  # fmt: skip

    return (
        light("key", -3.1, 2.8, 4.3, 1.03, 2.8),
        light("fill", 2.7, 1.3, 4.5, 0.77, 0.0),
        light("top", -0.8, 4.9, -0.4, 0.67, 5.8),
        light("rim", -0.2, 3.9, -3.7, 0.65, 1.1),
    )
