"""The polygon that is visible at each pixel, for all scan lines at once.

Paper: "Introduction", [3, 21]: Watkins' scan-line algorithm. Departs: only the geometry is Watkins': the
edges, where the lines cross them, and the segments between the crossings. He keeps the active segments of a
line sorted by x and takes the nearest in each interval; here the nearest segment at each pixel is kept by a
depth buffer of keys that carry the number of the polygon. So nothing is sorted, and every step is one array
operation over the segments of all lines, some hundred times faster in numpy. The literal algorithm is in
`watkins`; both see the same polygon at every pixel, and tests hold that.

Measured and rejected: sorting the fragments (argsort and reduceat take 7 times, lexsort 37 times as long as
`np.maximum.at`), a loop over the lines (12 times), points in object space (twice the time of a whole frame),
depths as floats (twice the passes over the fragments), scattering the crossings to their rows (twice as long
as walking around the polygons in the order of the rows).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Indices, Numbers, chunks_of_runs, runs
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.culling import not_occluded
from autocolor.visibility.depth import DepthScale, depth_scale
from autocolor.visibility.interpolation import interpolated_points
from autocolor.visibility.projection import Projection, projection
from autocolor.visibility.segments import segments_of_polygons
from autocolor.visibility.visible_points import VisiblePoints

SEGMENTS_AT_ONCE: Final = 1 << 16
FRAGMENTS_AT_ONCE: Final = 1 << 16


def visible_surfaces(
    mesh: Mesh,
    view: View,
    surface_numbers: tuple[int, ...],
    lines: int = 480,
    elements: int = 640,
    one_sided: frozenset[int] = frozenset(),
) -> VisiblePoints:
    """What is visible at each pixel.

    `surface_numbers` has the surface number of each part of the mesh; `one_sided` are the surface numbers
    whose normals are not turned to the eye on polygons seen from behind.
    """
    # Project the nodes, and keep the polygons that may be visible.
    projected = projection(mesh, view, lines, elements)
    scale = depth_scale(projected)
    depth_buffer = np.zeros(lines * elements, np.int64)
    # Test the polygons that face the eye.
    depth_test(depth_buffer, projected, scale, np.flatnonzero(~projected.from_behind))
    # Test those seen from behind, except the many that the first ones occlude.
    behind = not_occluded(depth_buffer, projected, scale, np.flatnonzero(projected.from_behind))
    depth_test(depth_buffer, projected, scale, behind)
    # Keep the number of the nearest polygon from each key.
    depth_buffer &= scale.number_limit - 1
    # Interpolate point and normal along what is visible of the segments.
    return interpolated_points(projected, depth_buffer, surface_numbers, one_sided)


def depth_test(depth_buffer: Numbers, projected: Projection, scale: DepthScale, polygons: Indices) -> None:
    """Keep in the depth buffer, (lines * elements,), the largest key of some polygons at each pixel.

    The largest key is that of the nearest polygon, and of equally near ones the one with the highest number.
    """
    for chunk, _ in chunks_of_runs(projected.line_counts.take(polygons), SEGMENTS_AT_ONCE):
        # Find the segments of the polygons on all lines.
        segments = segments_of_polygons(projected, scale, polygons[chunk])
        # Step the keys along each segment, and keep the largest at each pixel.
        keys = segments.start + segments.number
        for part, _ in chunks_of_runs(segments.count, FRAGMENTS_AT_ONCE):
            count = segments.count[part]
            pixel = runs(segments.first_pixel[part], count)
            np.maximum.at(depth_buffer, pixel, runs(keys[part], count, segments.step[part]))
