"""Reading glTF and GLB files with VTK, in the process of `foreign_worker`.

`gltf_document` unpacks the arrays before; VTK places the nodes, and applies skins and the default weights of
morph targets. Each primitive of triangles of each node is a part. Nodes of a part with equal coordinates and
scalars are welded, since glTF writes a node again for each normal and texture coordinate.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkIOGeometry import vtkGLTFReader

from autocolor.arrays import Floats, Indices
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.foreign_mesh import ForeignMesh, ForeignRefusal, part_names_of
from autocolor.files.meshes.foreign_vtk import listening, polygons_of, refuse_printed
from autocolor.files.meshes.gltf_document import Completed, Primitive, completed
from autocolor.files.meshes.repair import RawPolygons
from autocolor.scene.scalar import NODE


class PlacedPart(NamedTuple):
    """A primitive at a node of the scene."""

    name: str
    material: str
    places: Floats
    triangles: Indices
    normals: Floats | None
    scalars: dict[str, Floats]


def read(path: Path, kind: str) -> ForeignMesh:
    """The parts of the default scene of a glTF file. Raises InputError and ForeignRefusal."""
    whole = completed(path)
    sentences = [f"{what}: {count:,}" for what, count in whole.left_out.items()]
    if not any(whole.primitives.values()):
        raise ForeignRefusal("; ".join(["its scene must have meshes of triangles", *sentences]))
    parts = list(_parts(_built(whole.glb, path), whole))
    part_names = part_names_of([part.name for part in parts])
    scalars = FileScalars()
    welded = [_welded(part.places, part.scalars) for part in parts]
    for key in dict.fromkeys(key for part in parts for key in part.scalars):
        values = [
            part.scalars.get(key, np.full(len(part.places), np.nan))[leaders]
            for part, (leaders, _) in zip(parts, welded, strict=True)
        ]
        scalars.add(key, np.concatenate(values), NODE)
    corners, corner_normals, normals = [], [], []
    nodes = vectors = 0
    for part, (leaders, rows) in zip(parts, welded, strict=True):
        corners.append(nodes + rows[part.triangles])
        nodes += len(leaders)
        if part.normals is None:
            corner_normals.append(np.full(part.triangles.shape, -1))
        else:
            corner_normals.append(vectors + part.triangles)
            normals.append(part.normals)
            vectors += len(part.normals)
    counts = [len(part.triangles) for part in parts]
    polygons = RawPolygons(
        np.concatenate([part.places[leaders] for part, (leaders, _) in zip(parts, welded, strict=True)]),
        np.concatenate(corners).ravel(),
        np.full(sum(counts), 3, np.intp),
        np.repeat(np.arange(len(counts)), counts),
        part_names,
        scalars.scalars,
        normals=np.concatenate(normals) if normals else None,
        corner_normals=np.concatenate(corner_normals).ravel() if normals else None,
    )
    materials = {name: part.material for name, part in zip(part_names, parts, strict=True) if part.material}
    return ForeignMesh(
        polygons,
        (*sentences, *scalars.messages),
        materials,
        {name: color for name, color in whole.colors.items() if name in materials.values()},
    )


def _built(glb: bytes, path: Path) -> Any:
    """VTK's scene of a GLB file that is written out in full. Raises ForeignRefusal."""
    window = listening()
    # The worker's folder for temporary files is removed with the result.
    with tempfile.NamedTemporaryFile(suffix=".glb", delete=False) as file:
        file.write(glb)
    reader = vtkGLTFReader()
    reader.SetFileName(file.name)
    reader.ApplyDeformationsToGeometryOn()
    reader.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    reader.Update()
    refuse_printed(window, path)
    return reader.GetOutputDataObject(0)


def _parts(scene: Any, whole: Completed) -> Iterator[PlacedPart]:
    """The parts of a scene. VTK names its blocks Node_3 and Mesh_1, by the numbers of nodes and meshes."""

    def blocks(parent: Any, node: int) -> Iterator[tuple[int, int, Any]]:
        for at in range(parent.GetNumberOfBlocks()):
            block = parent.GetBlock(at)
            what, _, number = parent.GetMetaData(at).Get(parent.NAME()).partition("_")
            if what == "Node":
                yield from blocks(block, int(number))
            else:
                yield node, int(number), block

    for node, mesh, block in blocks(scene, -1):
        primitives = whole.primitives[mesh]
        turned = len(primitives) > 0 and _is_mirrored(block.GetBlock(0).GetFieldData())
        for at, primitive in enumerate(primitives):
            data = block.GetBlock(at)
            found = polygons_of(data)
            if data.GetNumberOfPoints() != primitive.nodes or not (found.corner_counts == 3).all():
                raise ForeignRefusal(f"meshes {mesh}: VTK must give the nodes and triangles of the file")
            triangles = found.corners.reshape(-1, 3)
            normals = data.GetPointData().GetNormals()
            name, material = whole.names[node], _material(whole, primitive)
            yield PlacedPart(
                f"{name} {material}".strip() if len(primitives) > 1 else name,
                material,
                vtk_to_numpy(data.GetPoints().GetData()).astype(np.float64),
                triangles[:, ::-1] if turned else triangles,
                None if normals is None else vtk_to_numpy(normals).astype(np.float64),
                primitive.scalars,
            )


def _material(whole: Completed, primitive: Primitive) -> str:
    return "" if primitive.material is None else whole.materials[primitive.material]


def _is_mirrored(data: Any) -> bool:
    """Whether the node of a mesh, or its skin, turns triangles over."""
    matrices = [data.GetArray(name) for name in ("globalTransform", "jointMatrix_0")]
    signs = [np.linalg.det(vtk_to_numpy(each).reshape(4, 4)[:3, :3]) for each in matrices if each is not None]
    return bool(np.prod(np.sign(signs)) < 0)


def _welded(places: Floats, scalars: dict[str, Floats]) -> tuple[Indices, Indices]:
    """The first rows of equal coordinates and scalars, in their order; and the new row of each row."""
    columns = np.column_stack([places, *scalars.values()]) + 0.0
    _, first, rows = np.unique(columns, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), np.intp)
    rank[order] = np.arange(len(order))
    return first[order], rank[rows.reshape(-1)]
