"""The division of the words among the surfaces that a scalar colors, in bands and shades."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from autocolor.errors import InputError
from autocolor.lighting.picture import Picture
from autocolor.mapping.level_ranges import FEWEST_LEVELS, SURFACE_WORDS, USEFUL_LEVELS
from autocolor.mapping.scalar_bands import Bands
from autocolor.scalars.ranges import UNIT, widened
from autocolor.scene.scalars.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface

MOST_SHADES: Final = 8
"""Assumed: the shades of each band where none are asked for; more are hardly seen within a band."""


def bands_by_surface(scene: Scene, picture: Picture) -> Mapping[str, Bands]:
    """The bands of each surface in use that the scalar colors, by name; none without a scalar.

    All have as many shades. Raises InputError if the words do not suffice for them.
    """
    scalar, values = scene.scalar, picture.scalar_values
    if scalar is None or values is None:
        return {}
    low, high = scalar.limits or own_limits(picture)
    colored = colored_surfaces(scene)
    used = {scene.parts[number].surface for number in scene.mesh.parts_in_use}
    lacking = {
        picture.surfaces[each.surface_number - 1]
        for each in picture.slices
        if np.isnan(values[each.pixels]).any()
    }
    rows = [surface for surface in scene.surfaces if surface.name in used]
    # Nothing of the object is beyond the scalar's own range; what is of the stage has the color of its ends.
    has_ends = scalar.limits is not None
    has_below, has_above = has_ends and scalar.below is not None, has_ends and scalar.above is not None
    bands = {
        row.name: Bands(low, high, scalar.bands, 1, has_below, has_above, row.name in lacking)
        for row in rows
        if row.name in colored
    }
    shades = _shades(scalar, rows, bands) if bands else 1
    return {name: each._replace(shades=shades) for name, each in bands.items()}


def colored_surfaces(scene: Scene) -> Sequence[str]:
    """The names of the surfaces that the scalar colors: those it tells, else all but those of the stage."""
    if scene.scalar is None:
        return ()
    if scene.scalar.surfaces is not None:
        return scene.scalar.surfaces
    return tuple(dict.fromkeys(part.surface for part in scene.parts if not part.stage))


def own_limits(picture: Picture) -> tuple[float, float]:
    """The own range of the scalar of a picture, where its first band begins and its last one ends.

    It does not depend on the color scale, such as by being symmetric for a diverging one, or another scale
    would change words. A picture that was made of rasters may have a range without extent; it is `widened`.
    """
    return widened(*(picture.scalar_limits or UNIT))


def _shades(scalar: Scalar, surfaces: Sequence[Surface], bands: Mapping[str, Bands]) -> int:
    """The shades of each band: as many as are asked for, else as many as the words suffice for.

    Assumed: the levels that a colored surface asks for are those for its paint, and its bands take what they
    need. The other surfaces have the levels that they ask for, and those that ask for none at least
    FEWEST_LEVELS, or USEFUL_LEVELS where the shades can be chosen. Raises InputError if there are too few
    words.
    """
    others = [surface.levels for surface in surfaces if surface.name not in bands]
    left = SURFACE_WORDS - sum(filter(None, others))
    room, useful = (left - others.count(None) * fewest for fewest in (FEWEST_LEVELS, USEFUL_LEVELS))
    if room < 0:
        # The other surfaces ask for too much; `level_ranges` refuses that.
        return 1
    total = sum(each.total for each in bands.values())
    shades = scalar.shades or max(1, min(MOST_SHADES, useful // total))
    if total * shades > room:
        first, *more = bands
        raise InputError(_refusal(scalar, first, len(more), total, shades, room))
    return shades


def _refusal(scalar: Scalar, name: str, others: int, total: int, shades: int, room: int) -> str:
    """What is said of bands and shades for which there are too few words.

    `total` bands are those of all surfaces that the scalar colors; `others` is how many these are besides the
    named one, and `room` the number of words.
    """
    label = f"surface {name!r}" + (f" and {others} more" if others else "")
    most = room // total
    remedy = (
        f"choose at most {most} shade{'s' * (most > 1)}, or fewer bands"
        if most
        else f"even one shade of each needs {total}; choose fewer bands, or let it color fewer surfaces"
    )
    return (
        f"{label}: the bands of scalar {scalar.name!r} times their shades must be at most the {room} words"
        f" that are left for them, not {total} x {shades} = {total * shades}; {remedy}"
    )
