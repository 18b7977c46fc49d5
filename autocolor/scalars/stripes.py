"""Zebra stripes: how a row of long lamps would be reflected, which shows where a surface is not smooth.

Assumed: the lamps are infinitely far, run along the scalar's direction and stand around it, as many in a half
turn as the scalar has stripes. A value is the phase from 0 to below 1 within the lamp and the gap after it
that the reflected ray meets. It is continuous around a full turn where the stripes of one are whole.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import chunks
from autocolor.scalars.places import unit_vector
from autocolor.scalars.ranges import UNIT, ScalarValues
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import PIXELS_AT_ONCE, REFLECTED_VIEW, VisiblePoints

BELOW_ONE: Final = float(np.nextafter(np.float32(1), np.float32(0)))


def zebra(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The phase of the lamp that the reflected ray meets, in [0, 1), by the normals of the picture."""
    run = unit_vector(scalar)
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
