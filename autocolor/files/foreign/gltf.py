"""Reading glTF and GLB files with VTK, in the process of `worker`.

VTK unpacks the arrays, places the nodes, and applies skins and the default weights of morph targets. Each
primitive of each node of the default scene is a part. Its nodes at the same place are welded, since glTF
writes a node again for each normal and texture coordinate.
"""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkIOGeometry import vtkGLTFReader

from autocolor.arrays import components_of
from autocolor.checks import Color, listed
from autocolor.files.foreign.gltf_document import Row, completed, document, refuse_extensions, rows
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal, PlacedPart, joined
from autocolor.files.foreign.vtk import listening, places_of, surface_of
from autocolor.files.meshes.repair import different, printable_name
from autocolor.files.meshes.welding import welded

LEFT_OUT: Final = {
    "animations": r'"animations": \[{',
    "attributes of its own": r'"_\w+": \d',
    "cameras": r'"cameras": \[{',
    "colors of nodes": r'"COLOR_\d": \d',
    "lights": r'"KHR_lights_punctual": {"light": ',
    "textures": r'Texture": {',
}
"""What a mesh does not have, and how a file that has it writes it."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The parts of the default scene of a glTF file. Raises InputError and ForeignRefusal."""
    described, binary = document(path)
    refuse_extensions(described)
    left_out = [kind for kind, key in LEFT_OUT.items() if re.search(key, json.dumps(described))]
    left_out += ["other scenes"] * (len(rows(described, "scenes")) > 1)
    sentences = [f"left out its {listed(left_out)}"] if left_out else []
    with tempfile.NamedTemporaryFile(suffix=".glb", delete=False) as file:
        file.write(completed(path, described, binary))
    reader = vtkGLTFReader()
    reader.SetFileName(file.name)
    reader.ApplyDeformationsToGeometryOn()
    reader.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    with listening(path):
        reader.Update()
    names, colors = _materials(described)
    all_parts = list(_parts(reader.GetOutputDataObject(0), described, names, path.stem))
    parts = [part for part in all_parts if len(part.triangles)]
    if skipped := len(all_parts) - len(parts):
        sentences.append(f"skipped primitives of points or lines: {skipped:,}")
    if not parts:
        raise ForeignRefusal("; ".join(["its scene must have meshes of triangles", *sentences]))
    return joined(parts, sentences, colors)


def _parts(scene: Any, described: Row, materials: tuple[str, ...], stem: str) -> Iterator[PlacedPart]:
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
            data = block.GetBlock(at)
            if "JOINTS_1" in primitive["attributes"]:
                raise ForeignRefusal(f"meshes {mesh}: a node of a skin must have four joints at most")
            material = materials[primitive["material"]] if "material" in primitive else ""
            triangles = surface_of(data).flats.corners.reshape(-1, 3)
            matrices = map(block.GetBlock(0).GetFieldData().GetArray, ("globalTransform", "jointMatrix_0"))
            places = [vtk_to_numpy(each).reshape(4, 4)[:3, :3] for each in matrices if each is not None]
            if np.prod([np.sign(np.linalg.det(each)) for each in places]) < 0:
                # The node of a mesh, or its skin, turns triangles over.
                triangles = triangles[:, ::-1]
            coordinates, row_of = welded(places_of(data))
            normals = data.GetPointData().GetNormals()
            yield PlacedPart(
                f"{name} {material}" if material and len(primitives) > 1 else name,
                material,
                coordinates,
                row_of[triangles],
                # Morph targets need not move normals.
                None if normals is None or any(weights) else vtk_to_numpy(normals)[triangles.ravel()],
            )


def _materials(described: Row) -> tuple[tuple[str, ...], dict[str, Color]]:
    """The names of the materials, and the base colors of those that have no texture instead."""
    materials = rows(described, "materials")
    names = different([_name(row) or f"material {number}" for number, row in enumerate(materials)])
    colors: dict[str, Color] = {}
    for name, row in zip(names, materials, strict=True):
        shiny = (row.get("extensions") or {}).get("KHR_materials_pbrSpecularGlossiness") or {}
        rough = row.get("pbrMetallicRoughness") or {}
        color = rough.get("baseColorFactor") or shiny.get("diffuseFactor")
        if color is not None or "Texture" not in json.dumps([rough, shiny]):
            linear = np.clip((color or (1.0, 1.0, 1.0))[:3], 0, 1)
            red, green, blue = components_of(linear).tolist()
            colors[name] = (red, green, blue)
    return names, colors


def _name(row: Row) -> str:
    """The name of a row, printable; empty if it has none."""
    return printable_name(str(row.get("name") or ""))
