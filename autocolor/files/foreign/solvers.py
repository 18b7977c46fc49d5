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
from collections import Counter
from collections.abc import Iterator
from contextlib import redirect_stderr
from pathlib import Path
from typing import Any, Final

import meshio
import numpy as np

from autocolor.files.foreign.cells import CORNERS, Block, cell_surface
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal, part_names_of, unreadable
from autocolor.files.foreign.solver_text import Elements, abaqus, assembled, nastran
from autocolor.files.meshes.repair import RawPolygons

HARMLESS: Final = re.compile(r"tag data that|know (keyword \w+|Gmf(?!\w*[PQ]\d)\w+ type)\. Skip")
"""Warnings of meshio about partitions, and Medit's data other than cells."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The surface of a mesh in a format that meshio names `kind`. Raises ForeignRefusal and InputError."""
    skipped = Counter[str]()
    if kind in ("abaqus", "nastran"):
        points, cells = assembled(abaqus(path) if kind == "abaqus" else nastran(path), skipped)
    else:
        mesh = _read_gmsh(path, skipped) if kind == "gmsh" else _read_by_meshio(path, kind)
        points, cells = np.atleast_2d(mesh.points), _cells(mesh)
    coordinates = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    blocks, numbers, part_of_cell = list[Block](), dict[str, int](), list[int]()
    for kind, nodes, parts in cells:
        shape = kind.rstrip("0123456789")
        if shape not in CORNERS:
            skipped[f"cells of type {kind}"] += len(nodes)
            continue
        if nodes.shape[1] > CORNERS[shape]:
            skipped["nodes between corners of cells"] += nodes[:, CORNERS[shape] :].size
        rows = len(part_of_cell) + np.arange(len(nodes))
        blocks.append((shape, nodes[:, : CORNERS[shape]].astype(np.intp), rows))
        part_of_cell += [numbers.setdefault(part or path.stem, len(numbers)) for part in parts]
    if not part_of_cell:
        raise ForeignRefusal("the file must have elements with faces")
    surface = cell_surface(coordinates, blocks)
    used, part_numbers = np.unique(np.array(part_of_cell)[surface.flats.cells], return_inverse=True)
    polygons = RawPolygons(
        coordinates[surface.nodes],
        surface.flats.corners,
        surface.flats.corner_counts,
        part_numbers.reshape(-1),
        part_names_of([[*numbers][part] for part in used.tolist()]),
    )
    sentences = (f"skipped {what}: {count:,}" for what, count in skipped.items())
    return ForeignMesh(polygons, (*sentences, *surface.sentences))


def _read_by_meshio(path: Path, kind: str) -> Any:
    """The mesh of meshio. Raises ForeignRefusal with the warning that meshio prints."""
    # numpy warns of text that is no number, and gives fewer numbers.
    warnings.simplefilter("error", DeprecationWarning)
    with redirect_stderr(io.StringIO()) as printed:
        mesh = getattr(meshio, kind).read(str(path))
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
    except ValueError as error:
        if "gmsh:physical" not in str(error):
            raise
        # meshio needs each element in a physical group, or none.
        skipped["tables of physical groups, which some elements are not in"] += 1
        data = re.sub(rb"^\$Entities\s.*?^\$EndEntities\s*", b"", data, flags=re.S | re.M)
        Path(file.name).write_bytes(data)
        return _read_by_meshio(Path(file.name), "gmsh")


def _cells(mesh: Any) -> Iterator[Elements]:
    """The cells of a mesh of meshio; those with the same number are a part, and 0 is no number."""
    key = next((key for key in mesh.cell_data if key != "gmsh:geometrical"), None)
    # The physical groups of Gmsh have numbers of their own in each dimension.
    named = {(int(tag), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
    for row, block in enumerate(mesh.cells):
        tags = np.abs(mesh.cell_data[key][row]).tolist() if key else [0] * len(block)
        names = {tag: named.get((tag, block.dim), f"part {tag}" * (tag != 0)) for tag in set(tags)}
        yield block.type, block.data, [names[tag] for tag in tags]
