"""Rendering a scene to a picture; everything that did not change is reused from the previous picture.

| changed | recomputed |
|---|---|
| mesh, stage, view, interpolation, the surface of a part, two_sided | everything |
| a light's position, aim, controls, links to parts | the two planes of the light, the sum |
| the aim of a light that others follow | the two planes of the light and of its followers, the sum |
| a surface's reflection model | all lights, for the chunks of points that contain the surface; the sum |
| a light's intensity, switch or links to surfaces, ambient, D, S | the sum |
| the scalar's name, direction, stripes | its values |
| what words stand for | nothing, but the picture gains or loses its normals |
| anything else | nothing |
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np

from autocolor.budget import allowing, require_memory
from autocolor.checks import is_whole, nearest, shown
from autocolor.errors import UsageError
from autocolor.lighting.illumination import Previous, illuminate
from autocolor.lighting.picture import Picture, check_smooth
from autocolor.logs import logger_of, timed
from autocolor.scalars.computed import scalar_values
from autocolor.scene.columns import Tier, cost, with_values
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import NORMALS, Scene, check_scene, costs_at_least
from autocolor.visibility.visible_points import VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from autocolor.visibility.watkins import watkins

LOG: Final = logger_of(__name__)

SIZE: Final = (640, 480)
"""The width and height of a picture, unless its user chooses others: those of the display of 1983."""

LARGEST_RASTER: Final = 16384
"""Limit: lines, and elements. The memory budget refuses a picture with this many of both."""

BYTES_OF_PIXEL: Final = 96
"""Measured where all pixels see polygons: 64 bytes, and 8 for each of four lights. Planes of more lights have
a budget of their own (see `illumination`)."""

ALGORITHMS: Final[dict[str, Callable[..., VisiblePoints]]] = {"batch": visible_surfaces, "watkins": watkins}


@dataclass(frozen=True, eq=False)
class Rendering:
    """A scene with its visible points and its picture."""

    scene: Scene
    points: VisiblePoints
    picture: Picture


def render(
    scene: Scene,
    size: tuple[int, int] = SIZE,
    algorithm: str = "batch",
    *,
    limit: float | None = None,
    smooth: int = 1,
) -> Picture:
    """The picture of a scene; `size` is its width and height, up to 16,384 each. A display ends at 4,096.

    The arrays of a picture are [line, element], so a picture of the size (640, 480) has the shape (480, 640).
    With `smooth`, it has `smooth` times the lines and elements: `image` and `save_image` average squares of
    its pixels, so that edges are smooth.

    `algorithm` is "batch", which processes all lines at once, or "watkins", the literal scan-line algorithm,
    which gives the same picture some fifteen times slower. `limit` is a factor for the memory budget. Raises
    InputError if an intensity exceeds the range of float32, or if the picture needs more memory than the
    budget allows; UsageError for an invalid size, algorithm, limit or `smooth`.
    """
    elements, lines = checked_size(size, smooth)
    if not isinstance(algorithm, str) or algorithm not in ALGORITHMS:
        raise UsageError(f"there is no algorithm {shown(algorithm)}{nearest(algorithm, ALGORITHMS)}")
    smooth = int(smooth)
    with allowing(limit):
        if smooth > 1:
            require_memory(
                BYTES_OF_PIXEL * lines * elements * smooth**2,
                f"a picture of {elements} x {lines} pixels, each the mean of {smooth} x {smooth},",
                "render it smaller, or with a smaller `smooth`",
            )
        picture = rendering(scene, smooth * lines, smooth * elements, algorithm=algorithm).picture
    return picture if smooth == 1 else dataclasses.replace(picture, smooth=smooth)


def checked_size(size: tuple[int, int], smooth: int = 1) -> tuple[int, int]:
    """The width and the height of a picture with this `smooth`, as integers of Python. Raises UsageError.

    Integers of numpy would change the types of arrays.
    """
    check_smooth(smooth)
    most = LARGEST_RASTER // smooth
    is_pair = isinstance(size, (tuple, list)) and len(size) == 2
    if not is_pair or not all(is_whole(count, 1, most) for count in size):
        where = f" where smooth is {smooth}" if smooth > 1 else ""
        raise UsageError(
            f"a size must be (width, height), each from 1 to {most}{where}, not {shown(size)}; write it as in"
            " (640, 480)"
        )
    width, height = map(int, size)
    return width, height


def rendering(
    scene: Scene,
    lines: int = 480,
    elements: int = 640,
    before: Rendering | None = None,
    algorithm: str = "batch",
) -> Rendering:
    """The rendering of a scene; whatever did not change is reused from the earlier rendering `before`.

    Raises UsageError for anything else than a scene.
    """
    check_scene(scene)
    if before is not None and (before.picture.lines, before.picture.elements) != (lines, elements):
        before = None
    seen = scene.staged
    if before is not None and sees_the_same(before.scene, scene):
        if not costs_at_least(before.scene, scene, Tier.MIX):
            return Rendering(scene, before.points, _with_normals(before.picture, scene, before.points))
        points = before.points
    else:
        before = None
        require_memory(
            BYTES_OF_PIXEL * lines * elements,
            f"a picture of {elements} x {lines} pixels",
            "render it smaller",
        )
        _keep_arrays()
        one_sided = frozenset(row + 1 for row, surface in enumerate(scene.surfaces) if not surface.two_sided)
        with timed(LOG, f"visible surfaces, {elements} x {lines}"):
            points = ALGORITHMS[algorithm](
                seen.mesh,
                seen.view,
                seen.surface_number_of_part,
                lines,
                elements,
                one_sided,
                scene.interpolation,
            )
    if before is not None and _is_lit_the_same(before.scene, scene):
        picture = before.picture
    else:
        previous = None if before is None else Previous(before.scene, before.picture)
        with timed(LOG, "illumination"):
            picture = illuminate(scene, points, previous)
    picture = _with_normals(_with_scalar(picture, scene, points, before), scene, points)
    LOG.debug("%r", picture)
    return Rendering(scene, points, picture)


def _with_scalar(picture: Picture, scene: Scene, points: VisiblePoints, before: Rendering | None) -> Picture:
    """The picture with the values of the scene's scalar, reused from an earlier picture if they are equal.

    `before` is None, or has the same visible points.
    """
    values, limits = None, None
    if scene.scalar is not None:
        old = None if before is None else before.scene.scalar
        if (
            before is not None
            and old is not None
            and _has_the_same_values(old, scene.scalar)
            and _stage(before.scene) == _stage(scene)
        ):
            values, limits = before.picture.scalar_values, before.picture.scalar_limits
        else:
            with timed(LOG, "scalar values"):
                seen = scene.staged
                of_object = seen.object_coordinates if any(_stage(seen)) else None
                values, limits = scalar_values(seen.mesh, scene.scalar, points, of_object)
    if values is picture.scalar_values:
        return picture
    return dataclasses.replace(picture, scalar_values=values, scalar_limits=limits)


def _with_normals(picture: Picture, scene: Scene, points: VisiblePoints) -> Picture:
    """The picture; it has the normals of its points if words stand for normals, else none."""
    normals = points.normals if scene.words == NORMALS else None
    if picture.normals is normals:
        return picture
    return dataclasses.replace(picture, normals=normals)


def _stage(scene: Scene) -> list[bool]:
    """Whether each part is stage. The range of a scalar does not include the coordinates of the stage."""
    return [part.stage for part in scene.parts]


def _has_the_same_values(old: Scalar, new: Scalar) -> bool:
    """Whether two scalars have the same values at the same points of the same mesh."""
    costs = cost(old, new)
    return costs is None or costs < Tier.MIX


def _is_lit_the_same(old: Scene, new: Scene) -> bool:
    """Whether two scenes with the same visible points differ in their scalars at most."""
    return not costs_at_least(with_values(old, {"scalar": new.scalar}), new, Tier.MIX)


def sees_the_same(old: Scene, new: Scene) -> bool:
    """Whether two scenes have the same visible points, including the surface number of each."""
    is_other = costs_at_least(old, new, Tier.FRAME)
    one, other = old.staged, new.staged
    is_other = is_other or one.mesh is not other.mesh
    return not is_other and one.surface_number_of_part == other.surface_number_of_part


@cache
def _keep_arrays() -> None:
    """Make glibc reuse the memory of arrays of up to 32 MB.

    By default glibc returns the memory to the system and maps it again, page by page, for every picture. Once
    an array of this size was freed, glibc holds the memory. Measured: this saves 4 to 15 ms for each picture.
    """
    _ = np.empty(30 << 20, np.uint8)


# Pacing. While a picture moves, it may be coarse, so that its fields follow each other fast enough. A coarse
# picture has a half or a quarter of the lines and elements, and the display shows every pixel of it as a
# block of 2 x 2 or 4 x 4 pixels.

BLOCKS: Final = (1, 2, 4)
"""The lines and elements of a block; 1 is the whole picture."""

PICTURE_SECONDS: Final = 1 / 36
"""Limit: the longest time that a picture may take while it moves. The rest of a thirtieth of a second is for
the field, which a window of 1280 x 960 shows in 6 to 14 ms without a graphics processor."""

MARGIN: Final = 0.75
"""Assumed: a finer picture is tried again if it is expected to take this fraction of PICTURE_SECONDS, so that
the picture does not change back and forth between two blocks."""


def blocks_of(lines: int, elements: int) -> tuple[int, ...]:
    """The blocks that divide a raster.

    >>> blocks_of(480, 640), blocks_of(480, 642)
    ((1, 2, 4), (1, 2))
    """
    return tuple(block for block in BLOCKS if lines % block == 0 and elements % block == 0)


def block_for(blocks: Sequence[int], block: int, seconds: float) -> int:
    """The smallest block whose picture is expected to be fast enough, else the largest block.

    `seconds` is the time that the last picture took, and `block` its block. Assumed: the time falls with the
    lines. Measured for blocks of 1, 2 and 4: 54, 28 and 13 ms for 87,000 polygons, 197, 90 and 52 ms for a
    million.

    >>> block_for(BLOCKS, 1, 0.020), block_for(BLOCKS, 1, 0.045), block_for(BLOCKS, 4, 0.013)
    (1, 2, 4)
    """
    for next_block in blocks:
        limit = PICTURE_SECONDS if next_block >= block else MARGIN * PICTURE_SECONDS
        if seconds * block <= limit * next_block:
            return next_block
    return blocks[-1]
