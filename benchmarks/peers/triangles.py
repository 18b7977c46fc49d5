"""The mesh as peers take it: triangles with a normal at each corner, surface by surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from autocolor import Scene


@dataclass(frozen=True, eq=False)
class Triangles:
    """The triangles of one surface.

    `corners` is (triangles, 3) int32, rows of `places` and `normals`, which are (rows, 3) float32: triangles
    that share a node and its normal share the row. `surface` is a row of the surface table.
    """

    surface: int
    places: npt.NDArray[np.float32]
    normals: npt.NDArray[np.float32]
    corners: npt.NDArray[np.int32]


def triangles(scene: Scene) -> list[Triangles]:
    """The triangles of the scene's mesh, for each surface that has any; quads are cut from corner 0 to 2."""
    mesh = scene.mesh
    surface_of_polygon = np.array(scene.surface_number_of_part)[mesh.part_numbers] - 1
    found = []
    for surface in np.unique(surface_of_polygon).tolist():
        polygons = surface_of_polygon == surface
        nodes, normals = mesh.node_numbers[polygons], mesh.normals.numbers[polygons]
        used, rows = np.unique(np.stack([nodes.ravel(), normals.ravel()]), axis=1, return_inverse=True)
        quads = rows.reshape(-1, 4)
        whole = nodes[:, 2] != nodes[:, 3]
        found.append(
            Triangles(
                surface,
                mesh.coordinates[used[0]].astype(np.float32),
                mesh.normals.vectors[used[1]].astype(np.float32),
                np.concatenate([quads[:, :3], quads[whole][:, [0, 2, 3]]]).astype(np.int32),
            )
        )
    return found
