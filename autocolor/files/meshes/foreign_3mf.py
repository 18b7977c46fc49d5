"""3MF read by lib3mf, the library of the format's own consortium.

Each mesh that the build places is a part, moved by the transforms above it. A mesh with several materials
is a part for each material. Base materials and colors of color groups become materials; 3MF's colors are
sRGB. Coordinates stay in the file's unit. lib3mf reads in its lax mode, because its strict mode refuses
every file without UUIDs; a warning that may mean missing geometry refuses the file.
"""

from __future__ import annotations

import ctypes
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

import lib3mf
import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.checks import Color, shown
from autocolor.files.meshes.foreign_mesh import ForeignMesh, ForeignRefusal, part_names_of, unreadable
from autocolor.files.meshes.repair import RawPolygons, printable_name

LIBRARY: Final = lib3mf.get_wrapper()

MOST_PLACED: Final = 10_000
"""Limit: objects that the build places; a few objects can name each other very often."""

LEFT_OUT: Final = ("Support", "SolidSupport", "Other")
"""The types of objects that are not a part of the product."""

NOUNS: Final = {"TexCoord": "textures", "Composite": "mixed materials", "Multi": "layered materials"}
"""Properties of triangles that are not one color."""

HARMLESS: Final = (0x80B0, 0x80BD)
"""Warnings about a missing UUID, and about objects that are left out anyway."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The triangles of a 3MF file; `kind` is not used. Raises ForeignRefusal."""
    model = LIBRARY.CreateModel()
    reader = model.QueryReader("3mf")
    try:
        reader.ReadFromFile(str(path))
        sentences = _sentences_of(reader)
        if model.GetKeyStore().GetResourceDataCount():
            raise ForeignRefusal("the file must not be encrypted; save it without secure content")
        parts = _Parts(model)
        for mesh, name, transform in _placed(model, path.stem, parts):
            parts.add(mesh, name, transform)
        return parts.joined(sentences)
    except lib3mf.ELib3MFException as error:
        raise unreadable("lib3mf", error.error_message or error.error_description) from None


def _sentences_of(reader: Any) -> list[str]:
    """The warnings of lib3mf. Raises ForeignRefusal if a warning may mean missing geometry."""
    warnings = dict(reader.GetWarning(row) for row in range(reader.GetWarningCount()))
    texts = [text for code, text in warnings.items() if code not in HARMLESS]
    for text in texts:
        if "extension" in text or "Element" in text:
            raise unreadable("lib3mf", text)
    return [f"lib3mf: {text}" for text in texts]


class _Mesh(NamedTuple):
    """Nodes, (nodes, 3), triangles, (triangles, 3), and the rows of the triangles of each material."""

    nodes: Floats
    triangles: Indices
    materials: list[tuple[str, Indices]]


class _Object(NamedTuple):
    """An object's own name, its mesh or None, and its components with their transforms."""

    name: str
    mesh: _Mesh | None
    components: list[tuple[Any, Floats]]


def _placed(model: Any, stem: str, parts: _Parts) -> Iterator[tuple[_Mesh, str, Floats]]:
    """The meshes that the build places, in the order of the file, with names and transforms, (4, 3).

    An object without a name has the name of the object that it is a component of, else `stem`.
    """
    objects: dict[int, _Object] = {}
    items, waiting = model.GetBuildItems(), []
    while items.MoveNext():
        item = items.GetCurrent()
        waiting.append((item, stem, _matrix(item.GetObjectTransform())))
    waiting.reverse()
    count = 0
    while waiting:
        item, name, transform = waiting.pop()
        count += 1
        if count > MOST_PLACED:
            raise ForeignRefusal(f"the build must place at most {MOST_PLACED:,} objects, not more")
        number = item.GetObjectResourceID()
        if number not in objects:
            objects[number] = _object(item.GetObjectResource(), parts)
        own_name, mesh, components = objects[number]
        for component, matrix in reversed(components):
            # Coordinates are rows: the component's own transform comes first.
            combined = matrix @ transform[:3]
            combined[3] += transform[3]
            waiting.append((component, own_name or name, combined))
        if mesh is not None:
            yield mesh, own_name or name, transform


def _object(handle: Any, parts: _Parts) -> _Object:
    """An object. Raises ForeignRefusal unless its shape is its triangles or its components."""
    name, kind = handle.GetName().strip(), handle.GetType().name
    components: list[tuple[Any, Floats]] = []
    if kind in LEFT_OUT:
        parts.skipped[f"left out objects of the type {kind.lower()}"] += 1
        return _Object(name, None, components)
    if handle.IsComponentsObject():
        for row in range(handle.GetComponentCount()):
            component = handle.GetComponent(row)
            components.append((component, _matrix(component.GetTransform())))
        return _Object(name, None, components)
    if not handle.IsMeshObject():
        raise ForeignRefusal(f"object {shown(name)} must be a mesh, not a level set")
    lattice = handle.BeamLattice()
    if lattice.GetBeamCount() or lattice.GetBallCount():
        raise ForeignRefusal(f"object {shown(name)} must have triangles only, not a beam lattice")
    if handle.HasSlices(False):
        if handle.GetSlicesMeshResolution().name == "Lowres":
            raise ForeignRefusal(f"object {shown(name)} must have triangles of full detail, not slices")
        parts.skipped["left out the slices of objects"] += 1
    if handle.GetVolumeData() is not None:
        parts.skipped["left out the volume data of objects"] += 1
    if not handle.GetTriangleCount():
        parts.skipped["skipped objects without triangles"] += 1
        return _Object(name, None, components)
    return _Object(name, parts.mesh_of(handle), components)


class _Parts:
    """The parts of a model, and what was skipped, with counts."""

    def __init__(self, model: Any) -> None:
        self.skipped: Counter[str] = Counter()
        self._model = model
        self._colors: dict[str, Color] = {}
        self._names: list[tuple[str, str]] = []
        self._coordinates: list[Floats] = []
        self._triangles: list[Indices] = []
        self._count = 0

    def add(self, mesh: _Mesh, name: str, transform: Floats) -> None:
        """Add a mesh under a transform, (4, 3), as a part for each of its materials."""
        nodes, triangles, materials = mesh
        if np.linalg.det(transform[:3]) < 0:
            # A reflection turns the triangles over.
            triangles = triangles[:, ::-1]
        self._coordinates.append(nodes @ transform[:3] + transform[3])
        for material, rows in materials:
            self._triangles.append(self._count + triangles[rows])
            self._names.append((f"{name} {material}" if material and len(materials) > 1 else name, material))
        self._count += len(nodes)

    def joined(self, sentences: list[str]) -> ForeignMesh:
        """All parts. Raises ForeignRefusal if there are none."""
        counted = [f"{sentence}: {number:,}" for sentence, number in self.skipped.items()]
        if not self._names:
            reason = ", ".join(counted) or "the build is empty"
            raise ForeignRefusal(f"the build must have an object with triangles, not none ({reason})")
        corners = np.concatenate(self._triangles)
        part_names = part_names_of([name for name, _ in self._names])
        polygons = RawPolygons(
            np.concatenate(self._coordinates),
            corners.ravel(),
            np.full(len(corners), 3, np.intp),
            np.repeat(np.arange(len(part_names)), [len(each) for each in self._triangles]),
            part_names,
        )
        materials = zip(part_names, (material for _, material in self._names), strict=True)
        return ForeignMesh(
            polygons, (*sentences, *counted), {part: each for part, each in materials if each}, self._colors
        )

    def mesh_of(self, handle: Any) -> _Mesh:
        """The mesh of a mesh object, whose colors are noted."""
        functions = LIBRARY.lib
        nodes = _table(handle, functions.lib3mf_meshobject_getvertices, lib3mf.Position, "<f4")
        triangles = _table(handle, functions.lib3mf_meshobject_gettriangleindices, lib3mf.Triangle, "<u4")
        properties = _table(
            handle, functions.lib3mf_meshobject_getalltriangleproperties, lib3mf.TriangleProperties, "<u4"
        )
        keys, key_of, counts = np.unique(properties[:, :2], axis=0, return_inverse=True, return_counts=True)
        names = [self._material(*numbers) for numbers in np.column_stack([keys, counts]).tolist()]
        numbers = {name: number for number, name in enumerate(dict.fromkeys(names))}
        material_of = np.array([numbers[name] for name in names], np.intp)[key_of.reshape(-1)]
        order = np.argsort(material_of, kind="stable")
        rows = np.split(order, np.searchsorted(material_of[order], range(1, len(numbers))))
        materials = sorted(zip(numbers, rows, strict=True), key=lambda each: int(each[1][0]))
        is_mixed = (properties[:, 1:2] != properties[:, 2:]).any(axis=1) & (material_of != numbers.get(""))
        if is_mixed.any():
            self.skipped["took the first color of triangles with several"] += int(is_mixed.sum())
        return _Mesh(nodes.astype(np.float64), triangles.astype(np.intp), materials)

    def _material(self, resource: int, row: int, triangles: int) -> str:
        """The name of the material in a row of a resource, whose color is noted; "" if there is none."""
        if not resource:
            return ""
        kind = self._model.GetPropertyTypeByID(resource).name
        if kind == "BaseMaterial":
            group = self._model.GetBaseMaterialGroupByID(resource)
            stem, color = printable_name(group.GetName(row)) or "material", group.GetDisplayColor(row)
        elif kind == "Colors":
            color = self._model.GetColorGroupByID(resource).GetColor(row)
            stem = f"#{color.Red:02x}{color.Green:02x}{color.Blue:02x}"
        else:
            self.skipped[f"left out {NOUNS.get(kind, kind)} of triangles"] += triangles
            return ""
        rgb, name, number = (color.Red, color.Green, color.Blue), stem, 1
        while self._colors.setdefault(name, rgb) != rgb:
            number += 1
            name = f"{stem} {number}"
        return name


def _matrix(transform: Any) -> Floats:
    """A transform as (4, 3): the images of the axes, then the translation."""
    return np.array([list(row) for row in transform.Fields], np.float64)


def _table(placed: Any, function: Any, row: Any, dtype: str) -> AnyArray:
    """The rows of a table of a mesh object, without a Python object for each, as in lib3mf's own lists."""
    count = ctypes.c_uint64()
    LIBRARY.checkError(placed, function(placed._handle, ctypes.c_uint64(), count, (row * 0)()))
    rows = (row * count.value)()
    LIBRARY.checkError(placed, function(placed._handle, count, count, rows))
    return np.frombuffer(rows, dtype).reshape(count.value, ctypes.sizeof(row) // 4)
