"""What a module that calls a library returns or raises, and how the mesh comes back; it imports no library.

Each of `vtk`, `gltf`, `three_mf` and `solvers` has a function
`read(path: Path, kind: str) -> ForeignMesh`, which runs in the process of `worker`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.checks import LARGEST_COORDINATE, Color, printable, shown
from autocolor.files.meshes.repair import RawPolygons, different, printable_name
from autocolor.immutable import read_only
from autocolor.scene.scalar import NODE, MeshScalar

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

    `reason` is the rule, what the file has instead, and the place: "a cell must have nodes of the file, from
    0 to 5, not 99 (cell 1)". The message to the user is the file's name, the reason and the remedy.
    """

    def __init__(self, reason: str, remedy: str = REMEDY) -> None:
        super().__init__(f"{reason}; {remedy}")


def unreadable(library: str, line: str) -> ForeignRefusal:
    """The refusal of a file that a library cannot read, with the line that the library printed."""
    return ForeignRefusal(f"{library} must be able to read it, and cannot ({line})")


def part_names_of(names: Sequence[str]) -> tuple[str, ...]:
    """Names of parts that are printable and different; a part without a name is "part"."""
    return different([printable_name(name) or "part" for name in names])


class Part(NamedTuple):
    """Triangles, (triangles, 3), of a part, whose nodes other parts may have, too.

    `material` is "" and `normals`, (corners, 3), are None if it has none.
    """

    name: str
    material: str
    coordinates: Floats
    triangles: Indices
    normals: Floats | None = None


def joined(parts: Sequence[Part], sentences: Sequence[str], colors: Mapping[str, Color]) -> ForeignMesh:
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


# The archive of numpy that a mesh comes back in.

ARRAYS: Final = ("coordinates", "corners", "corner_counts", "part_numbers")
NORMALS: Final = ("normals", "corner_normals")


def save(mesh: ForeignMesh, result: Path) -> None:
    """Write a mesh as an archive."""
    polygons = mesh.polygons
    scalars = [(each.name, each.of) for each in polygons.scalars]
    header = (polygons.part_names, mesh.sentences, mesh.material_of_part, mesh.colors, scalars)
    names = ARRAYS if polygons.normals is None else ARRAYS + NORMALS
    arrays: dict[str, AnyArray] = {name: vars(polygons)[name] for name in names}
    arrays |= {f"scalar_{number}": each.values for number, each in enumerate(polygons.scalars)}
    with open(result, "wb") as file:
        np.savez(file, allow_pickle=False, header=np.array(json.dumps(header)), **arrays)


def loaded(result: Path) -> ForeignMesh:
    """The mesh of an archive, in which all numbers of nodes, corners and parts are right.

    Raises ForeignRefusal for coordinates that a mesh cannot have, and ValueError, KeyError and others for a
    damaged archive.
    """
    with np.load(result, allow_pickle=False) as file:
        header = json.loads(str(file["header"]))
        arrays = {name: file[name] for name in file.files if name != "header"}
    coordinates, normals = arrays["coordinates"], arrays.get("normals")
    corners, counts, parts = (arrays[name].astype(np.intp) for name in ARRAYS[1:])
    wrong = np.flatnonzero(~(np.abs(coordinates) <= LARGEST_COORDINATE).all(axis=1))
    if len(wrong):
        raise ForeignRefusal(
            "the coordinates of a node must be finite and at most 1e30 in size, not"
            f" {shown(coordinates[wrong[0]].tolist())} (node {wrong[0] + 1:,})"
        )
    names, sentences, material_of_part, colors, rows = header
    scalars = [MeshScalar(name, read_only(arrays[f"scalar_{at}"]), of) for at, (name, of) in enumerate(rows)]
    of_corners = arrays.get("corner_normals")
    shapes = [(coordinates, (len(coordinates), 3)), (corners, (counts.sum(),)), (parts, counts.shape)]
    shapes += [(each.values, (len(coordinates if each.of == NODE else counts),)) for each in scalars]
    if normals is not None and of_corners is not None:
        shapes += [(normals, (len(normals), 3)), (of_corners, corners.shape)]
    limits = [(corners, len(coordinates)), (counts, len(corners) + 1), (parts, len(names))]
    if any(each.shape != shape for each, shape in shapes) or any(
        ((each < 0) | (each >= end)).any() for each, end in limits
    ):
        raise ValueError("its numbers are of nodes, corners or parts that are not there")
    polygons = RawPolygons(
        coordinates.astype(np.float64),
        corners,
        counts,
        parts,
        tuple(names),
        tuple(scalars),
        normals=normals,
        corner_normals=of_corners,
    )
    return ForeignMesh(polygons, tuple(printable(each[:300]) for each in sentences), material_of_part, colors)
