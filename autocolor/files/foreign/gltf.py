"""Reading glTF and GLB files with VTK, in the process of `worker`.

VTK unpacks the arrays, places the nodes, and applies skins and the default weights of morph targets. Each
primitive of each node of the default scene is a part. Its nodes at the same place are welded, since glTF
writes a node again for each normal and texture coordinate.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkIOGeometry import vtkGLTFReader

from autocolor.arrays import Floats, Indices
from autocolor.checks import Color, listed
from autocolor.files.foreign.gltf_document import Row, completed, document, refuse_extensions, rows
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal, part_names_of
from autocolor.files.foreign.vtk import listening, places_of, polygons_of, refuse_printed
from autocolor.files.meshes.repair import RawPolygons, different, printable_name
from autocolor.files.meshes.welding import welded


class PlacedPrimitive(NamedTuple):
    """A primitive at a node of the scene; `material` is "" and `normals` are empty if it has none."""

    name: str
    material: str
    places: Floats
    triangles: Indices
    normals: Floats


def read(path: Path, kind: str) -> ForeignMesh:
    """The parts of the default scene of a glTF file. Raises InputError and ForeignRefusal."""
    described, binary = document(path)
    try:
        return _read(path, described, binary)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        raise ForeignRefusal("its JSON must describe a scene as glTF 2.0 does, and is damaged") from None


def _read(path: Path, described: Row, binary: bytes) -> ForeignMesh:
    refuse_extensions(described)
    sentences = _left_out(described)
    with tempfile.NamedTemporaryFile(suffix=".glb", delete=False) as file:
        file.write(completed(path, described, binary))
    window, reader = listening(), vtkGLTFReader()
    reader.SetFileName(file.name)
    reader.ApplyDeformationsToGeometryOn()
    reader.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    reader.Update()
    refuse_printed(window, path)
    materials, colors = _materials(described)
    all_parts = list(_parts(reader.GetOutputDataObject(0), described, materials, path.stem))
    parts = [part for part in all_parts if len(part.triangles)]
    if skipped := len(all_parts) - len(parts):
        sentences.append(f"skipped primitives of points or lines: {skipped:,}")
    if not parts:
        raise ForeignRefusal("; ".join(["its scene must have meshes of triangles", *sentences]))
    names = part_names_of([part.name for part in parts])
    material_of_part = {name: part.material for name, part in zip(names, parts, strict=True) if part.material}
    used = {name: color for name, color in colors.items() if name in material_of_part.values()}
    return ForeignMesh(_joined(parts, names), tuple(sentences), material_of_part, used)


def _joined(parts: list[PlacedPrimitive], names: tuple[str, ...]) -> RawPolygons:
    """The polygons of all parts."""
    nodes, corners, rows_of_normals, count, normals = [], [], [], 0, 0
    for part in parts:
        points, places = welded(part.places)
        nodes.append(points)
        corners.append(count + places[part.triangles])
        has_normals = len(part.normals) > 0
        rows_of_normals.append(np.where(has_normals, normals + part.triangles, -1))
        count, normals = count + len(points), normals + len(part.normals)
    counts, vectors = (
        [len(part.triangles) for part in parts],
        np.concatenate([part.normals for part in parts]),
    )
    return RawPolygons(
        np.concatenate(nodes),
        np.concatenate(corners).ravel(),
        np.full(sum(counts), 3, np.intp),
        np.repeat(np.arange(len(parts)), counts),
        names,
        normals=vectors.astype(np.float64) if len(vectors) else None,
        corner_normals=np.concatenate(rows_of_normals).ravel() if len(vectors) else None,
    )


def _parts(scene: Any, described: Row, materials: tuple[str, ...], stem: str) -> Iterator[PlacedPrimitive]:
    """The parts of a scene. VTK names its blocks Node_3 and Mesh_1, by the numbers of nodes and meshes."""

    def blocks(parent: Any, node: int) -> Iterator[tuple[int, int, Any]]:
        for at in range(parent.GetNumberOfBlocks()):
            block = parent.GetBlock(at)
            what, _, number = parent.GetMetaData(at).Get(parent.NAME()).partition("_")
            if what == "Node":
                yield from blocks(block, int(number))
            else:
                yield node, int(number), block

    nodes, meshes = rows(described, "nodes"), rows(described, "meshes")
    for node, mesh, block in blocks(scene, -1):
        name = _name(nodes[node]) or _name(meshes[mesh]) or stem
        weights = nodes[node].get("weights") or meshes[mesh].get("weights") or ()
        primitives = rows(meshes[mesh], "primitives")
        for at, primitive in enumerate(primitives):
            data, attributes = block.GetBlock(at), primitive["attributes"]
            count = rows(described, "accessors")[attributes["POSITION"]]["count"]
            if data.GetNumberOfPoints() != count:
                raise ForeignRefusal(f"meshes {mesh}: VTK must give the nodes of the file, and does not")
            if "JOINTS_1" in attributes:
                raise ForeignRefusal(f"meshes {mesh}: a node of a skin must have four joints at most")
            number = primitive.get("material")
            material = "" if number is None else materials[number]
            triangles, normals = polygons_of(data).corners.reshape(-1, 3), data.GetPointData().GetNormals()
            yield PlacedPrimitive(
                f"{name} {material}" if material and len(primitives) > 1 else name,
                material,
                places_of(data),
                triangles[:, ::-1] if _is_mirrored(block.GetBlock(0).GetFieldData()) else triangles,
                # Morph targets need not move normals.
                np.empty((0, 3)) if normals is None or any(weights) else vtk_to_numpy(normals),
            )


def _is_mirrored(data: Any) -> bool:
    """Whether the node of a mesh, or its skin, turns triangles over."""
    matrices = [data.GetArray(name) for name in ("globalTransform", "jointMatrix_0")]
    signs = [np.linalg.det(vtk_to_numpy(each).reshape(4, 4)[:3, :3]) for each in matrices if each is not None]
    return bool(np.prod(np.sign(signs)) < 0)


def _left_out(described: Row) -> list[str]:
    """A sentence about what the file has and a mesh does not."""
    attributes = [
        name
        for mesh in rows(described, "meshes")
        for primitive in rows(mesh, "primitives")
        for name in primitive.get("attributes") or ()
    ]
    kinds = {
        "animations": bool(described.get("animations")),
        "attributes of its own": any(name.startswith("_") for name in attributes),
        "cameras": bool(described.get("cameras")),
        "colors of nodes": any(name.startswith("COLOR_") for name in attributes),
        "lights": "KHR_lights_punctual" in json.dumps(described.get("nodes")),
        "other scenes": len(rows(described, "scenes")) > 1,
        "textures": _has_texture(described.get("materials")),
    }
    found = [kind for kind, is_there in kinds.items() if is_there]
    return [f"left out its {listed(found)}"] if found else []


# Materials.


def _has_texture(value: object) -> bool:
    return "Texture" in json.dumps(value)


def _materials(described: Row) -> tuple[tuple[str, ...], dict[str, Color]]:
    """The names of the materials, and the base colors of those that have no texture instead."""
    materials = rows(described, "materials")
    names = different([_name(row) or f"material {number}" for number, row in enumerate(materials)])
    colors: dict[str, Color] = {}
    for name, row in zip(names, materials, strict=True):
        shiny = (row.get("extensions") or {}).get("KHR_materials_pbrSpecularGlossiness") or {}
        rough = row.get("pbrMetallicRoughness") or {}
        color = rough.get("baseColorFactor") or shiny.get("diffuseFactor")
        if color is not None or not _has_texture({**rough, **shiny}):
            red, green, blue = (srgb(each) for each in (color or (1.0, 1.0, 1.0))[:3])
            colors[name] = (red, green, blue)
    return names, colors


def srgb(linear: float) -> int:
    """A linear component of a color, 0 to 1, as sRGB, 0 to 255.

    >>> srgb(0), srgb(0.5), srgb(1)
    (0, 188, 255)
    """
    linear = min(max(linear, 0.0), 1.0)
    return round(255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055))


def _name(row: Row) -> str:
    """The name of a row, printable; empty if it has none."""
    name = row.get("name")
    return printable_name(name) if isinstance(name, str) else ""
