"""The triangles of a scene of trimesh: each node of the scene with a mesh is a part, placed by its transform.

Nodes of a part with equal coordinates and scalars are welded: glTF writes a corner again for each normal and
texture coordinate that it has. Points and paths are skipped and counted. Of materials the name and the base
color are taken, of textures nothing. Nothing of trimesh is imported here.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.checks import Color
from autocolor.files.meshes.foreign.foreign_mesh import ForeignMesh, part_names_of
from autocolor.files.repair.polygons import Polygons
from autocolor.scene.scalars.mesh_scalars import LARGEST_SCALAR, MOST_SCALARS, NODE, MeshScalar

MOST_PLACED: Final = 100_000
"""Assumed: parts of a scene, of which many may be the same mesh."""


def polygons_of_trimesh(scene: Any, stem: str) -> ForeignMesh:
    """The triangles of a scene of trimesh; a part without a name has that of the file, `stem`."""
    order = {name: at for at, name in enumerate(scene.geometry)}
    placed = [(str(node), *scene.graph[node]) for node in scene.graph.nodes_geometry]
    if len(placed) > MOST_PLACED:
        raise ValueError(f"{len(placed):,} parts, and at most {MOST_PLACED:,} are read")
    placed.sort(key=lambda each: (order.get(each[2], len(order)), each[0]))
    coordinates: list[Floats] = []
    triangles: list[Indices] = []
    values: list[dict[str, Floats]] = []
    names: list[str] = []
    materials: list[tuple[str, Color | None]] = []
    skipped = textured = nodes = doubles = 0
    for name, transform, geometry in placed:
        mesh = scene.geometry[geometry]
        faces = getattr(mesh, "faces", None)
        if faces is None or not len(faces):
            skipped += 1
            continue
        scalars = _scalars_of(mesh)
        places, rows = _welded(_moved(np.asarray(mesh.vertices, np.float64), transform), scalars)
        table = np.asarray(faces, np.intp)
        if table.min() < 0 or table.max() >= len(rows[1]):
            raise ValueError(f"a triangle of {name} with a node that it does not have")
        doubles += len(rows[1]) - len(places)
        # A reflection turns the triangles over.
        turned = np.linalg.det(transform[:3, :3]) < 0
        triangles.append(nodes + rows[1][table[:, ::-1] if turned else table])
        coordinates.append(places)
        values.append({key: each[rows[0]] for key, each in scalars.items()})
        names.append(name.strip() or stem)
        material, has_texture = _material_of(mesh)
        materials.append(material)
        textured += has_texture
        nodes += len(places)
    if not names:
        raise ValueError("no triangles")
    part_names = part_names_of(names)
    keys = list(dict.fromkeys(key for each in values for key in each))[:MOST_SCALARS]
    scalars_found = tuple(
        MeshScalar(
            key,
            np.concatenate(
                [
                    each.get(key, np.full(len(places), np.nan))
                    for each, places in zip(values, coordinates, strict=True)
                ]
            ),
            NODE,
        )
        for key in keys
    )
    corners = np.concatenate(triangles)
    counts = [len(each) for each in triangles]
    polygons = Polygons(
        np.concatenate(coordinates),
        corners.ravel(),
        np.full(len(corners), 3, np.intp),
        np.repeat(np.arange(len(counts)), counts),
        part_names,
        scalars_found,
    )
    told = (
        ("skipped parts without triangles", skipped),
        ("left out the textures of parts", textured),
    )
    sentences = [f"{what}: {number:,}" for what, number in told if number]
    return ForeignMesh(
        polygons,
        tuple(sentences),
        {part: name for part, (name, _) in zip(part_names, materials, strict=True) if name},
        {name: color for name, color in materials if name and color is not None},
    )


def _moved(places: Floats, transform: AnyArray) -> Floats:
    """Coordinates after a transform of a scene, (4, 4)."""
    matrix = np.asarray(transform, np.float64)
    moved: Floats = places @ matrix[:3, :3].T + matrix[:3, 3]
    return moved


def _scalars_of(mesh: Any) -> dict[str, Floats]:
    """The attributes of the nodes that are one number each; too large ones become missing."""
    found = {}
    for name, values in (getattr(mesh, "vertex_attributes", None) or {}).items():
        numbers = np.asarray(values)
        numbers = numbers[:, 0] if numbers.ndim == 2 and numbers.shape[1] == 1 else numbers
        if numbers.shape == (len(mesh.vertices),) and numbers.dtype.kind in "iuf":
            numbers = numbers.astype(np.float64)
            found[str(name).removeprefix("_")] = np.where(np.abs(numbers) <= LARGEST_SCALAR, numbers, np.nan)
    return found


def _welded(places: Floats, scalars: dict[str, Floats]) -> tuple[Floats, tuple[Indices, Indices]]:
    """The coordinates without doubles, the row of each in the given ones, and the new row of each given."""
    columns = np.column_stack([places, *scalars.values()]) + 0.0
    _, first, rows = np.unique(columns, axis=0, return_index=True, return_inverse=True)
    # Keep the order of the file.
    order = np.argsort(first)
    rank = np.empty(len(order), np.intp)
    rank[order] = np.arange(len(order))
    kept = first[order]
    return places[kept], (kept, rank[rows.reshape(-1)])


def _material_of(mesh: Any) -> tuple[tuple[str, Color | None], bool]:
    """The name and base color of the material of a mesh, and whether it has a texture."""
    material = getattr(getattr(mesh, "visual", None), "material", None)
    name = getattr(material, "name", None)
    texture = getattr(material, "baseColorTexture", None) is not None
    color = getattr(material, "baseColorFactor", None)
    if not isinstance(name, str) or not name:
        return ("", None), texture
    if color is None or len(color) < 3:
        return (name, None), texture
    red, green, blue = (int(each) for each in np.asarray(color)[:3])
    return (name, (red, green, blue)), texture
