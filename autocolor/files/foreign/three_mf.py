"""3MF read by lib3mf, the library of the format's own consortium.

Each mesh that the build places is a part, moved by the transforms above it. A mesh with several materials
is a part for each material. Base materials and colors of color groups become materials; 3MF's colors are
sRGB. Coordinates stay in the file's unit. lib3mf reads in its lax mode, because its strict mode refuses
every file without UUIDs; a warning that may mean missing geometry refuses the file.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import lib3mf
import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.checks import Color, shown
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal, PlacedPart, joined, unreadable
from autocolor.files.meshes.repair import printable_name

Mesh = tuple[Floats, Indices, list[tuple[str, Indices]]]
"""Nodes, (nodes, 3), triangles, (triangles, 3), and the rows of the triangles of each material."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The triangles of a 3MF file; `kind` is not used. Raises ForeignRefusal."""
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    try:
        reader.ReadFromFile(str(path))
        warnings = dict(reader.GetWarning(row) for row in range(reader.GetWarningCount()))
        # Warnings about a missing UUID, and about objects that are left out anyway.
        texts = [text for code, text in warnings.items() if code not in (0x80B0, 0x80BD)]
        for text in texts:
            if "extension" in text or "Element" in text:
                raise unreadable("lib3mf", text)
        if model.GetKeyStore().GetResourceDataCount():
            raise ForeignRefusal("the file must not be encrypted; save it without secure content")
        return _mesh_of_build(model, path.stem, [f"lib3mf: {text}" for text in texts])
    except lib3mf.ELib3MFException as error:
        raise unreadable("lib3mf", error.error_message or error.error_description) from None


def _mesh_of_build(model: Any, stem: str, sentences: list[str]) -> ForeignMesh:
    """All parts of the build; `stem` names objects without a name. Raises ForeignRefusal."""
    skipped, colors, parts = Counter[str](), dict[str, Color](), list[PlacedPart]()
    meshes: dict[int, Mesh] = {}
    items = model.GetBuildItems()
    while items.MoveNext():
        item = items.GetCurrent()
        above = _matrix(item.GetObjectTransform())
        for handle, name, transform in _placed(item.GetObjectResource(), stem, above, skipped):
            number = handle.GetUniqueResourceID()
            if number not in meshes:
                meshes[number] = _mesh(model, handle, shown(name), skipped, colors)
            nodes, triangles, materials = meshes[number]
            if np.linalg.det(transform[:3, :3]) < 0:
                # A reflection turns the triangles over.
                triangles = triangles[:, ::-1]
            nodes = nodes @ transform[:3, :3] + transform[3, :3]
            for material, rows in materials:
                own_name = f"{name} {material}" if material and len(materials) > 1 else name
                parts.append(PlacedPart(own_name, material, nodes, triangles[rows]))
    sentences += [f"left out {what}: {number:,}" for what, number in skipped.items()]
    if not parts:
        reason = ", ".join(sentences) or "the build is empty"
        raise ForeignRefusal(f"the build must have an object with triangles, not none ({reason})")
    return joined(parts, sentences, colors)


def _placed(
    handle: Any, name: str, transform: Floats, skipped: Counter[str]
) -> Iterator[tuple[Any, str, Floats]]:
    """The meshes that an object places, with names and transforms, (4, 4); a nameless one is named `name`."""
    name, kind = handle.GetName().strip() or name, handle.GetType().name
    if kind in ("Support", "SolidSupport", "Other"):
        skipped[f"objects of the type {kind.lower()}"] += 1
    elif handle.IsComponentsObject():
        for row in range(handle.GetComponentCount()):
            component = handle.GetComponent(row)
            # Coordinates are rows: the component's own transform comes first.
            matrix = _matrix(component.GetTransform()) @ transform
            yield from _placed(component.GetObjectResource(), name, matrix, skipped)
    else:
        yield handle, name, transform


def _mesh(model: Any, handle: Any, name: str, skipped: Counter[str], colors: dict[str, Color]) -> Mesh:
    """The mesh of an object, whose colors are noted. Raises ForeignRefusal unless it is all triangles."""
    lattice = handle.BeamLattice()
    if lattice.GetBeamCount() or lattice.GetBallCount():
        raise ForeignRefusal(f"object {name} must have triangles only, not a beam lattice")
    if handle.HasSlices(False) and handle.GetSlicesMeshResolution().name == "Lowres":
        raise ForeignRefusal(f"object {name} must have triangles of full detail, not slices")
    nodes = _table(handle.GetVertices(), 3, "<f4").astype(np.float64)
    triangles = _table(handle.GetTriangleIndices(), 3, "<u4").astype(np.intp)
    # The resource of each triangle, and the row of each corner in it.
    properties = _table(handle.GetAllTriangleProperties(), 4, "<u4")
    keys, key_of = np.unique(properties[:, :2], axis=0, return_inverse=True)
    names = [_material(model, resource, row, colors) for resource, row in keys.tolist()]
    numbers = {name: number for number, name in enumerate(dict.fromkeys(names))}
    material_of = np.array([numbers[name] for name in names], np.intp)[key_of.reshape(-1)]
    is_mixed = (properties[:, 1:2] != properties[:, 2:]).any(axis=1) | (material_of == numbers.get("", -1))
    if count := int((is_mixed & (properties[:, 0] > 0)).sum()):
        skipped["textures and mixed colors of triangles"] += count
    rows = np.split(np.argsort(material_of, kind="stable"), np.cumsum(np.bincount(material_of))[:-1])
    return nodes, triangles, list(zip(numbers, rows, strict=False))


def _material(model: Any, resource: int, row: int, colors: dict[str, Color]) -> str:
    """The name of the material in a row of a resource, whose color is noted; "" if it is not one color."""
    kind = model.GetPropertyTypeByID(resource).name if resource else ""
    if kind == "BaseMaterial":
        group = model.GetBaseMaterialGroupByID(resource)
        name, color = printable_name(group.GetName(row)), group.GetDisplayColor(row)
    elif kind == "Colors":
        name, color = "", model.GetColorGroupByID(resource).GetColor(row)
    else:
        return ""
    rgb = (color.Red, color.Green, color.Blue)
    code = f"#{bytes(rgb).hex()}"
    # Materials with the same name may have different colors.
    name = name if colors.setdefault(name or code, rgb) == rgb else f"{name} {code}"
    colors[name or code] = rgb
    return name or code


def _matrix(transform: Any) -> Floats:
    """A transform as (4, 4), whose first three rows are the images of the axes, the last the translation."""
    return np.column_stack([[list(row) for row in transform.Fields], [0, 0, 0, 1]])


def _table(rows: list[Any], columns: int, dtype: str) -> AnyArray:
    """The structures of a list of lib3mf as a table."""
    return np.frombuffer(b"".join(rows), dtype).reshape(-1, columns)
