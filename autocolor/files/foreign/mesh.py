"""What a module that calls a library returns or raises, and how the mesh comes back; it imports no library.

Each of `vtk`, `gltf`, `three_mf` and `solvers` has a function
`read(path: Path, kind: str) -> ForeignMesh`, which runs in the process of `worker`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.checks import LARGEST_COORDINATE, Color, printable, shown
from autocolor.files.array_file import ArrayFileKind, array_file_bytes, mesh_of, read_array_file
from autocolor.files.meshes.repair import (
    MeshReport,
    Placement,
    RawPolygons,
    different,
    printable_name,
    repaired,
)
from autocolor.scene.defaults import created_surface

REMEDY: Final = "correct the file, or write it as OBJ or PLY"


@dataclass(frozen=True, eq=False)
class ForeignMesh:
    """A mesh as a library gives it.

    `material_of_part` has the names of materials by part, `colors` the colors of materials that have a
    color, and `sentences` say what was left out.
    """

    polygons: RawPolygons
    sentences: tuple[str, ...] = ()
    material_of_part: Mapping[str, str] = field(default_factory=dict)
    colors: Mapping[str, Color] = field(default_factory=dict)


class ForeignRefusal(Exception):  # noqa: N818
    """A file cannot be read as it is.

    `reason` is the rule, what the file has instead, and the place: "cells must have nodes of the file, from 0
    to 5, not 99". The message to the user is the file's name, the reason and the remedy.
    """

    def __init__(self, reason: str, remedy: str = REMEDY) -> None:
        super().__init__(f"{reason}; {remedy}")


def unreadable(library: str, line: str) -> ForeignRefusal:
    """The refusal of a file that a library cannot read, with the line that the library printed."""
    return ForeignRefusal(f"{library} must be able to read it, and cannot ({line})")


def part_names_of(names: Sequence[str]) -> tuple[str, ...]:
    """Names of parts that are printable and different; a part without a name is "part"."""
    return different([printable_name(name) or "part" for name in names])


class PlacedPart(NamedTuple):
    """Triangles, (triangles, 3), of a part, whose nodes other parts may have, too.

    `material` is "" and `normals`, (corners, 3), are None if it has none.
    """

    name: str
    material: str
    coordinates: Floats
    triangles: Indices
    normals: Floats | None = None


def joined(parts: Sequence[PlacedPart], sentences: Sequence[str], colors: Mapping[str, Color]) -> ForeignMesh:
    """The mesh of at least one part."""
    names, counts = part_names_of([part.name for part in parts]), [len(part.triangles) for part in parts]
    # The same array of nodes, which several parts may have, is there once.
    nodes = {id(part.coordinates): part.coordinates for part in parts}
    ends = np.cumsum([len(each) for each in nodes.values()])
    firsts = dict(zip(nodes, [0, *ends.tolist()], strict=False))
    corners = np.concatenate([firsts[id(part.coordinates)] + part.triangles for part in parts]).ravel()
    normals = np.concatenate(
        [
            np.full((each.triangles.size, 3), np.nan) if each.normals is None else each.normals
            for each in parts
        ]
    )
    has_normals = not np.isnan(normals).all()
    polygons = RawPolygons(
        np.concatenate([*nodes.values()]),
        corners,
        np.full(sum(counts), 3, np.intp),
        np.repeat(np.arange(len(parts)), counts),
        names,
        normals=normals if has_normals else None,
        corner_normals=np.arange(len(normals)) if has_normals else None,
    )
    materials = {name: part.material for name, part in zip(names, parts, strict=True) if part.material}
    return ForeignMesh(polygons, tuple(sentences), materials, colors)


def report_of(mesh: ForeignMesh, name: str, placement: Placement) -> MeshReport:
    """The mesh of a file of this name, repaired. Raises ForeignRefusal, and InputError if nothing is left."""
    coordinates = mesh.polygons.coordinates
    wrong = np.flatnonzero(~(np.abs(coordinates) <= LARGEST_COORDINATE).all(axis=1))
    if len(wrong):
        raise ForeignRefusal(
            "the coordinates of a node must be finite and at most 1e30 in size, not"
            f" {shown(coordinates[wrong[0]].tolist())} (node {wrong[0] + 1:,})"
        )
    report = repaired(mesh.polygons, name, placement, skipped=mesh.sentences)
    names = [name for name in dict.fromkeys(mesh.material_of_part.values()) if name in mesh.colors]
    materials = tuple(created_surface(name, mesh.colors[name]) for name in names)
    return dataclasses.replace(report, material_of_part=mesh.material_of_part, materials=materials)


RESULT: Final = ArrayFileKind("mesh of a library", REMEDY, "autocolor mesh", {})
"""The file in which a mesh comes back."""


def save(report: MeshReport, result: Path) -> None:
    """Write a mesh to a file of arrays."""
    mesh = report.mesh
    header = {
        "names": (mesh.part_names, mesh.crease_angle, report.repairs, dict(report.material_of_part)),
        "colors": [(each.name, *each.paint.object_color) for each in report.materials],
    }
    result.write_bytes(array_file_bytes(RESULT, mesh, header, {}))


def loaded(result: Path) -> MeshReport:
    """The mesh of a file of arrays. Raises InputError and others if it is damaged or no sound mesh."""
    header, arrays = read_array_file(RESULT, result)
    names, angle, repairs, materials = header["names"]
    surfaces = tuple(created_surface(name, (red, green, blue)) for name, red, green, blue in header["colors"])
    mesh = mesh_of(header, arrays, names, angle)
    return MeshReport(mesh, tuple(printable(each[:300]) for each in repairs), materials, surfaces)
