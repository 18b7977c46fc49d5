"""Abaqus, Nastran, Gmsh, Medit and UGRID.

The texts of Abaqus and Nastran are read by `solver_text`, the others by meshio. Of volume cells the outer
surface is taken, of cells of higher order the corners; cells without faces are skipped and counted. Parts
are the physical groups of Gmsh, the element sets of Abaqus, and the numbers by which the other formats tell
cells apart; a cell in none is in the part named after the file.
"""

from __future__ import annotations

import io
import re
import tempfile
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from contextlib import redirect_stderr
from pathlib import Path
from typing import Any, Final

import meshio
import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.files.foreign.cells import CORNERS, Flats, Volumes, cell_surface
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal, part_names_of, unreadable
from autocolor.files.foreign.solver_text import CORNERS_OF, Record, abaqus, nastran
from autocolor.files.meshes.repair import RawPolygons

Block = tuple[str, Indices, list[str]]
"""Cells of a type of meshio: the type, the rows of their nodes, (cells, nodes), and the part of each."""

HARMLESS: Final = re.compile(r"tag data that|know (keyword \w+|Gmf(?!\w*[PQ]\d)\w+ type)\. Skip")
"""Warnings of meshio about partitions, and Medit's data other than cells."""

SHAPE: Final = re.compile(r"(triangle|quad|tetra|hexahedron|wedge|pyramid)[0-9]*")


def read(path: Path, kind: str) -> ForeignMesh:
    """The surface of a mesh in a format that meshio names `kind`. Raises ForeignRefusal and InputError."""
    skipped: Counter[str] = Counter()
    if kind in ("abaqus", "nastran"):
        points, blocks = _assembled(abaqus(path) if kind == "abaqus" else nastran(path), skipped)
        return _surface(points, blocks, path.stem, skipped)
    mesh = _read_gmsh(path, skipped) if kind == "gmsh" else _read_by_meshio(path, kind)
    return _surface(mesh.points, _blocks(mesh), path.stem, skipped)


def _assembled(records: Iterable[Record], skipped: Counter[str]) -> tuple[Floats, list[Block]]:
    """The nodes, (nodes, 3), and the elements of a text, and the number of those without faces."""
    nodes: dict[int, list[float]] = {}
    elements = defaultdict[tuple[str, int], tuple[list[str], list[list[int]]]](lambda: ([], []))
    for place, kind, name, words in records:
        try:
            if kind == "skipped":
                skipped[f"elements of type {name}"] += 1
            elif kind == "node":
                nodes[int(words[0])] = [_number(word) for word in [*words[1:], "", "", ""][:3]]
            else:
                parts, numbers = elements[kind, len(words)]
                numbers.append([int(word) for word in words])
                parts.append(name)
        except ValueError as error:
            raise ForeignRefusal(f"nodes and elements must be given by numbers ({place}: {error})") from None
    rows = {number: row for row, number in enumerate(nodes)}
    blocks = [
        (kind, np.array([[rows.get(node, -1) for node in each] for each in numbers], np.intp), parts)
        for (kind, _), (parts, numbers) in elements.items()
    ]
    return np.array([*nodes.values()]), blocks


def _number(word: str) -> float:
    """A real number, whose exponent may be written as in FORTRAN: 1.5D3 or 1.5-3. Raises ValueError."""
    try:
        return float(word or 0)
    except ValueError:
        return float(re.sub(r"(?<=[\d.])(?=[-+])|D", "E", word.upper()))


def _read_by_meshio(path: Path, kind: str) -> Any:
    """The mesh of meshio. Raises ForeignRefusal with the reason that meshio prints or raises."""
    try:
        with redirect_stderr(io.StringIO()) as printed, warnings.catch_warnings():
            # numpy warns of text that is no number, and gives fewer numbers.
            warnings.simplefilter("error", DeprecationWarning)
            mesh = getattr(meshio, kind).read(str(path))
    except MemoryError:
        raise
    except Exception as error:
        # Most are Python's own, such as a KeyError, and say nothing to a user.
        told = isinstance(error, (OSError, meshio.ReadError, ValueError)) and "reshape" not in str(error)
        reason = " ".join(str(error).split()) * told
        raise unreadable("meshio", reason or "it is cut short, or has what meshio does not know") from None
    for warning in " ".join(printed.getvalue().split()).split("Warning: "):
        if warning and not HARMLESS.search(warning):
            raise unreadable("meshio", warning)
    return mesh


def _read_gmsh(path: Path, skipped: Counter[str]) -> Any:
    """The mesh of meshio of a Gmsh file, from a copy that meshio reads right. Raises ForeignRefusal."""
    # meshio gives data to nodes and elements without a look at their numbers.
    pattern = rb"^\$((?:ElementNode|Element|Node)Data)\s.*?^\$End\1\s*"
    data, count = re.subn(pattern, b"", path.read_bytes(), flags=re.S | re.M)
    skipped.update({"sections of data": count} if count else {})
    if not re.match(rb"\s*(\$Comments.*\$EndComments\s+)?\$MeshFormat", data, re.S):
        raise ForeignRefusal("a Gmsh file must begin with $MeshFormat, as it does from MSH 2 on")
    # Gmsh wrote version 4.0 as "4", which meshio takes for 4.1.
    data = re.sub(rb"(\$MeshFormat\s+4) ", rb"\1.0 ", data, count=1)
    with tempfile.NamedTemporaryFile(suffix=".msh", delete=False) as file:
        file.write(data)
    try:
        return _read_by_meshio(Path(file.name), "gmsh")
    except ForeignRefusal as refusal:
        if "gmsh:physical" not in str(refusal):
            raise
        # meshio needs each element in a physical group, or none.
        skipped["tables of physical groups, which some elements are not in"] += 1
        data = re.sub(rb"^\$Entities\s.*?^\$EndEntities\s*", b"", data, flags=re.S | re.M)
        Path(file.name).write_bytes(data)
        return _read_by_meshio(Path(file.name), "gmsh")


def _blocks(mesh: Any) -> Iterator[Block]:
    """The cells of a mesh of meshio; those with the same number are a part, and 0 is no number."""
    key = next((key for key in mesh.cell_data if key != "gmsh:geometrical"), None)
    # The physical groups of Gmsh have numbers of their own in each dimension.
    named = {(int(tag), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
    for row, block in enumerate(mesh.cells):
        tags = np.abs(mesh.cell_data[key][row]).tolist() if key else [0] * len(block)
        names = {tag: named.get((tag, block.dim), f"part {tag}" * (tag != 0)) for tag in set(tags)}
        yield block.type, block.data, [names[tag] for tag in tags]


def _surface(points: Floats, blocks: Iterable[Block], stem: str, skipped: Counter[str]) -> ForeignMesh:
    """The surface of blocks of cells; a part without a name is named `stem`. Raises ForeignRefusal."""
    points = np.atleast_2d(points)
    coordinates = np.zeros((len(points), 3))
    coordinates[:, : points.shape[1]] = points
    flats: list[Flats] = []
    volumes: list[Volumes] = []
    part_numbers: dict[str, int] = {}
    part_of_cell: list[int] = []
    for kind, nodes, parts in blocks:
        match = SHAPE.fullmatch(kind)
        if match is None:
            skipped[f"cells of type {kind}"] += len(nodes)
            continue
        if not ((nodes >= 0) & (nodes < len(coordinates))).all():
            raise ForeignRefusal(f"a cell must have nodes of the file, which has {len(coordinates):,}")
        cells = len(part_of_cell) + np.arange(len(nodes))
        part_of_cell += [part_numbers.setdefault(part or stem, len(part_numbers)) for part in parts]
        corners = nodes[:, : CORNERS_OF[match[1]]].astype(np.intp)
        if nodes.shape[1] > corners.shape[1]:
            skipped["nodes between corners of cells"] += nodes.size - corners.size
        if match[1] in CORNERS:
            volumes.append(Volumes(match[1], corners, cells))
        else:
            flats.append(Flats.of(corners, cells))
    if not part_of_cell:
        raise ForeignRefusal("the file must have elements with faces")
    surface = cell_surface(coordinates, Flats.joined(flats), volumes)
    used, numbers = np.unique(np.array(part_of_cell)[surface.flats.cells], return_inverse=True)
    polygons = RawPolygons(
        coordinates[surface.nodes],
        surface.flats.corners,
        surface.flats.corner_counts,
        numbers.reshape(-1).astype(np.intp),
        part_names_of([[*part_numbers][part] for part in used.tolist()]),
    )
    sentences = (f"skipped {what}: {count:,}" for what, count in skipped.items())
    return ForeignMesh(polygons, (*sentences, *surface.sentences))
