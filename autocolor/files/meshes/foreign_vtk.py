"""Reading VTK files, legacy and XML, with VTK's own library, in the process of `foreign_worker`.

Of polygonal data, the polygons and the triangles of strips are read; of grids, the polygons and the outer
faces of volume cells. Quads stay quads. Of cells of higher order only the corners are read. Hidden and
duplicate cells are left out. The data of points and cells are scalars of the mesh (see `file_scalars`), and
the normals of points are the file's own normals. Nodes and cells are checked before VTK looks for the
surface: it trusts them.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from vtkmodules import vtkIOXML
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkCellArray
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkFiltersCore import vtkCellCenters
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOLegacy import vtkDataSetReader

from autocolor.arrays import Booleans, Floats, Indices, runs
from autocolor.checks import shown
from autocolor.files.meshes.cells import Flats, surface_sentences, turned_outward
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.foreign_mesh import ForeignMesh, ForeignRefusal, unreadable
from autocolor.files.meshes.repair import RawPolygons, printable_name
from autocolor.files.reading import HEAD, read_head, read_whole
from autocolor.scene.scalar import NODE, POLYGON

XML_TYPE: Final = re.compile(rb"<VTKFile\s[^>]*?type\s*=\s*[\"'](\w+)[\"']")

DATA_SETS: Final = ("PolyData", "UnstructuredGrid", "StructuredGrid", "RectilinearGrid", "ImageData")
"""The types of XML files that are read. Others name more files, or have no polygons."""

# Cells by the numbers of their types.

STRIP: Final = 6
POLYGON_CELL: Final = 7
POLYHEDRON: Final = 42
CORNERS: Final = {1: 1, 3: 2, 5: 3, 8: 4, 9: 4, 10: 4, 11: 8, 12: 8, 13: 6, 14: 5, 15: 10, 16: 12}
ANY_SIZE: Final = {0: 0, 2: 0, 4: 0, STRIP: 3, POLYGON_CELL: 3, POLYHEDRON: 4}
"""The fewest nodes of cells with any number of nodes."""

LINEAR: Final = {
    **dict.fromkeys((21, 35, 68, 75), 3),
    **dict.fromkeys((22, 34, 69, 76), 5),
    **dict.fromkeys((23, 28, 30, 70, 77), 9),
    **dict.fromkeys((24, 71, 78), 10),
    **dict.fromkeys((25, 29, 33, 72, 79), 12),
    **dict.fromkeys((26, 31, 32, 73, 80), 13),
    **dict.fromkeys((27, 37, 74, 81), 14),
    36: POLYGON_CELL,
}
"""The linear types of cells of higher order, whose corners come first."""

VOLUMES: Final = (*range(10, 17), POLYHEDRON)

NOT_SHOWN: Final = 1 | 32
"""The bits of cells that are duplicates of cells elsewhere, or hidden."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The surface of a VTK file of the kind "legacy" or "xml". Raises ForeignRefusal."""
    window = listening()
    data, sentences = (_xml if kind == "xml" else _legacy)(path)
    refuse_printed(window, path)
    _require_sound(data)
    higher = _make_linear(data) if data.IsA("vtkUnstructuredGrid") else 0
    found = _surface(data)
    refuse_printed(window, path)
    if higher:
        sentences.append(f"took the corners alone of cells of higher order: {higher:,}")
    sentences.extend(found.sentences)
    scalars, normals, messages = _attributes(data, found)
    polygons = RawPolygons(
        found.coordinates,
        found.flats.corners,
        found.flats.corner_counts,
        np.zeros(len(found.flats.cells), np.intp),
        (printable_name(path.stem) or "part",),
        scalars.scalars,
        normals=normals,
        corner_normals=None if normals is None else found.flats.corners,
    )
    return ForeignMesh(polygons, (*sentences, *messages))


def _legacy(path: Path) -> tuple[Any, list[str]]:
    """The data set of a legacy file, with all of its arrays."""
    data = read_whole(path, 1)
    if b"\n" not in data[:HEAD]:
        data = data.replace(b"\r", b"\n")
    if b"ASCII" in data[:HEAD].upper().split(b"DATASET")[0]:
        # VTK takes the end of the file for the end of any list of numbers, but not an empty FIELD.
        data += b"\n\nFIELD end 0\n"
    reader = vtkDataSetReader()
    reader.ReadFromInputStringOn()
    reader.SetBinaryInputString(data, len(data))
    for what in ("Scalars", "Vectors", "Tensors", "Normals", "Fields", "TCoords", "ColorScalars"):
        getattr(reader, f"ReadAll{what}On")()
    reader.Update()
    return reader.GetOutputDataObject(0), []


def _xml(path: Path) -> tuple[Any, list[str]]:
    """The data set of an XML file, of all pieces. Raises ForeignRefusal for a type with other files."""
    match = XML_TYPE.search(read_head(path))
    type_ = match[1].decode("latin-1") if match else "none"
    if type_ not in DATA_SETS:
        raise ForeignRefusal(
            f"the type of a VTK XML file must be {', '.join(DATA_SETS[:-1])} or {DATA_SETS[-1]}, not"
            f" {shown(type_)}",
            "write its surface as .vtp",
        )
    reader = getattr(vtkIOXML, f"vtkXML{type_}Reader")()
    reader.SetFileName(str(path))
    reader.Update()
    steps = reader.GetNumberOfTimeSteps()
    sentences = [f"took the first of {steps:,} time steps"] if steps > 1 else []
    return reader.GetOutputDataObject(0), sentences


# What VTK prints.

PRINTED: Final = re.compile(r"(ERROR|Generic ERROR|Warning|Generic Warning): In [^\n]*\n((?:[^\n]+\n)+)")
OBJECT: Final = re.compile(r"\w* ?\((?:0x)?(?:[0-9a-fA-F]+|nullptr)\): |\s+")


def listening() -> Any:
    """The window that VTK prints into from now on."""
    window = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    return window


def refuse_printed(window: Any, path: Path) -> None:
    """Raise ForeignRefusal with the first error that VTK printed, or warning: it may tell of lost data."""
    printed = PRINTED.findall(_text(window.GetOutput()))
    for _, lines in sorted(printed, key=lambda each: "ERROR" not in each[0]):
        line = " ".join(OBJECT.sub(" ", lines).replace(str(path), path.name).split())
        raise unreadable("VTK", line.rstrip("."))


def _text(given: str | bytes | None) -> str:
    """A text of VTK's, which is bytes if it is not UTF-8."""
    return given.decode("latin-1") if isinstance(given, bytes) else given or ""


# Checks of what VTK trusts.


def _require_sound(data: Any) -> None:
    """Raise ForeignRefusal unless all cells have nodes that are there, and all arrays a value for each."""
    nodes, cells = data.GetNumberOfPoints(), data.GetNumberOfCells()
    if not nodes or not cells:
        raise ForeignRefusal(f"it must have nodes and cells, not {nodes:,} nodes and {cells:,} cells")
    if data.IsA("vtkStructuredGrid") and nodes != math.prod(_dimensions(data)):
        raise ForeignRefusal(f"a grid of {_dimensions(data)} nodes must have as many, not {nodes:,}")
    if data.IsA("vtkRectilinearGrid"):
        counts = tuple(getattr(data, f"Get{axis}Coordinates")().GetNumberOfTuples() for axis in "XYZ")
        if counts != _dimensions(data):
            raise ForeignRefusal(f"a grid of {_dimensions(data)} nodes must have as many, not {counts}")
    if data.IsA("vtkPolyData"):
        for what in ("Verts", "Lines", "Polys", "Strips"):
            _require_nodes(getattr(data, f"Get{what}")(), nodes)
    if data.IsA("vtkUnstructuredGrid"):
        sizes = _require_nodes(data.GetCells(), nodes)
        types = _types(data)
        if len(types) != len(sizes):
            raise ForeignRefusal(f"each of the {len(sizes):,} cells must have a type, not {len(types):,}")
        for type_ in np.unique(types).tolist():
            corners = CORNERS.get(LINEAR.get(type_, type_), 0)
            least = corners or ANY_SIZE.get(LINEAR.get(type_, type_))
            if least is None:
                raise ForeignRefusal(f"a cell must be of a type with faces, not of the type {type_}")
            of_type = sizes[types == type_]
            most = corners if corners and type_ not in LINEAR else np.inf
            wrong = of_type[(of_type < least) | (of_type > most)]
            if len(wrong):
                raise ForeignRefusal(f"a cell of the type {type_} must have {least} nodes, not {wrong[0]}")
        if (types == POLYHEDRON).any():
            _require_nodes(data.GetPolyhedronFaces(), nodes)
    for owner, rows, what in ((data.GetPointData(), nodes, "node"), (data.GetCellData(), cells, "cell")):
        for at in range(owner.GetNumberOfArrays()):
            array = owner.GetAbstractArray(at)
            if array.GetNumberOfTuples() != rows:
                raise ForeignRefusal(
                    f"the array {shown(_text(array.GetName()))} must have a value for each of the {rows:,}"
                    f" {what}s, not {array.GetNumberOfTuples():,}"
                )


def _require_nodes(cells: Any, nodes: int) -> Indices:
    """The number of nodes of each cell. Raises ForeignRefusal if a cell has nodes that are not there."""
    numbers, offsets = _lists(cells)
    if not len(numbers):
        return np.zeros(len(offsets) - 1, np.intp)
    sizes = np.diff(offsets)
    if offsets[0] != 0 or offsets[-1] != len(numbers) or sizes.min() < 0:
        raise ForeignRefusal("the offsets of cells must rise from 0 to the number of their nodes")
    wrong = np.flatnonzero((numbers < 0) | (numbers >= nodes))
    if len(wrong):
        cell = int(np.searchsorted(offsets, wrong[0], side="right"))
        raise ForeignRefusal(
            f"a cell must have nodes of the file, from 0 to {nodes - 1:,}, not {numbers[wrong[0]]}"
            f" (cell {cell:,})"
        )
    return sizes


def _lists(cells: Any) -> tuple[Indices, Indices]:
    """The nodes of all cells of a cell array, one after the other, and the offsets of the cells."""
    if cells is None:
        raise ForeignRefusal("its cells must have lists of their nodes")
    numbers, offsets = (vtk_to_numpy(each()) for each in (cells.GetConnectivityArray, cells.GetOffsetsArray))
    return numbers.astype(np.intp), offsets.astype(np.intp) if len(offsets) else np.zeros(1, np.intp)


def _dimensions(grid: Any) -> tuple[int, ...]:
    """The nodes along each axis of a structured grid."""
    extent = grid.GetExtent()
    return tuple(high - low + 1 for low, high in zip(extent[::2], extent[1::2], strict=True))


def _types(grid: Any) -> Indices:
    """The types of the cells of an unstructured grid, by the name that versions before 9.6 have for them."""
    types: Indices = vtk_to_numpy(getattr(grid, "GetCellTypesArray", grid.GetCellTypes)()).astype(np.intp)
    return types


def _make_linear(grid: Any) -> int:
    """Replace cells of higher order by their corners; returns their number.

    VTK's filter numbers the cells of a surface wrongly if any cell is of higher order.
    """
    types = _types(grid)
    is_higher = np.isin(types, list(LINEAR))
    if not is_higher.any():
        return 0
    numbers, offsets = _lists(grid.GetCells())
    sizes, linear = np.diff(offsets), types.copy()
    for type_ in np.unique(types[is_higher]).tolist():
        of_type = types == type_
        linear[of_type] = LINEAR[type_]
        sizes[of_type] = CORNERS.get(LINEAR[type_], 0) or sizes[of_type] // 2
    cells = vtkCellArray()
    ends = np.concatenate([[0], np.cumsum(sizes)])
    is_filled = sizes > 0
    chosen = numbers[runs(offsets[:-1][is_filled], sizes[is_filled])]
    cells.SetData(*(numpy_to_vtkIdTypeArray(each.astype(np.int64), deep=True) for each in (ends, chosen)))
    new_types = numpy_to_vtk(linear.astype(np.uint8), deep=True)
    if faces := grid.GetPolyhedronFaces():
        grid.SetPolyhedralCells(new_types, cells, grid.GetPolyhedronFaceLocations(), faces)
    else:
        grid.SetCells(new_types, cells)
    return int(is_higher.sum())


# The surface.


class GridSurface(NamedTuple):
    """The polygons of a surface, its nodes, their rows in the file, and what was left out."""

    flats: Flats
    coordinates: Floats
    nodes: Indices
    sentences: list[str]


def polygons_of(data: Any) -> Flats:
    """The polygons of polygonal data, and the triangles of its strips."""
    numbers, offsets = _lists(data.GetPolys())
    first, polygons = data.GetNumberOfVerts() + data.GetNumberOfLines(), len(offsets) - 1
    if not data.GetNumberOfStrips():
        return Flats(numbers, np.diff(offsets), np.arange(first, first + polygons))
    strips, ends = _lists(data.GetStrips())
    is_long = np.diff(ends) > 2
    begins, sizes = ends[:-1][is_long], np.diff(ends)[is_long] - 2
    # Each node of a strip but its last two begins a triangle; every second triangle is turned over.
    starts = runs(begins, sizes)
    is_odd = runs(np.zeros(len(sizes), np.intp), sizes) % 2
    triangles = strips[np.column_stack([starts + is_odd, starts + 1 - is_odd, starts + 2])]
    return Flats(
        np.concatenate([numbers, triangles.ravel()]),
        np.concatenate([np.diff(offsets), np.full(len(triangles), 3, np.intp)]),
        first + np.concatenate([np.arange(polygons), polygons + np.repeat(np.flatnonzero(is_long), sizes)]),
    )


def _surface(data: Any) -> GridSurface:
    """The surface of a data set: its polygons in the order of their cells."""
    geometry = vtkGeometryFilter()
    geometry.SetInputData(data)
    geometry.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    geometry.PassThroughCellIdsOn()
    geometry.PassThroughPointIdsOn()
    geometry.Update()
    output = geometry.GetOutput()
    if not output.GetNumberOfPoints():
        raise ForeignRefusal("it must have polygons or volume cells, not points and lines alone")
    rows = vtk_to_numpy(output.GetPointData().GetArray("vtkOriginalPointIds")).astype(np.intp)
    cell_rows = vtk_to_numpy(output.GetCellData().GetArray("vtkOriginalCellIds")).astype(np.intp)
    places = vtk_to_numpy(output.GetPoints().GetData()).astype(np.float64)
    found = polygons_of(output)
    found = Flats(found.corners, found.corner_counts, cell_rows[found.cells])
    skipped = {"vertices": output.GetNumberOfVerts(), "lines": output.GetNumberOfLines()}
    sentences = [f"skipped {what}: {count:,}" for what, count in skipped.items() if count]

    # Leave out cells that are not shown. VTK leaves out those of volumes alone.
    if ghosts := data.GetCellData().GetArray("vtkGhostType"):
        is_shown = (vtk_to_numpy(ghosts) & NOT_SHOWN) == 0
        if number := int(np.count_nonzero(~is_shown)):
            sentences.append(f"left out hidden or duplicate cells: {number:,}")
            found = found.chosen(is_shown[found.cells])
    is_volume = _volumes(data)
    if count := int(is_volume.sum()):
        is_face = _repeat_faces(found, is_volume)
        if number := int(is_face.sum()):
            sentences.append(f"left out polygons that are faces of volume cells: {number:,}")
        is_outer = is_volume[found.cells]
        flats, faces = found.chosen(~is_face & ~is_outer), found.chosen(is_outer)
        found = Flats.joined([flats, turned_outward(places, faces, _centers(data))])
        sentences.extend(surface_sentences(count, data.GetNumberOfPoints() - len(np.unique(found.corners))))
    if not len(found.cells):
        raise ForeignRefusal("; ".join(["it must have polygons or volume cells", *sentences]))

    # Number the polygons and the nodes in the order of the file.
    found = Flats.joined([found])
    order = np.argsort(rows, kind="stable")
    rank = np.empty(len(order), np.intp)
    rank[order] = np.arange(len(order))
    flats = Flats(rank[found.corners], found.corner_counts, found.cells)
    return GridSurface(flats, places[order], rows[order], sentences)


def _volumes(data: Any) -> Booleans:
    """Which cells are volumes."""
    if data.IsA("vtkPolyData"):
        return np.zeros(data.GetNumberOfCells(), np.bool_)
    if data.IsA("vtkUnstructuredGrid"):
        is_volume: Booleans = np.isin(_types(data), VOLUMES)
        return is_volume
    return np.full(data.GetNumberOfCells(), min(_dimensions(data)) > 1)


def _repeat_faces(found: Flats, is_volume: Booleans) -> Booleans:
    """Which polygons have the corners of an outer face: programs often write boundaries besides volumes."""
    is_face = is_volume[found.cells]
    repeat = np.zeros(len(is_face), np.bool_)
    for count in np.unique(found.corner_counts[~is_face]).tolist():
        rows = np.flatnonzero(found.corner_counts == count)
        corners = np.sort(found.corners[found.starts[rows, None] + np.arange(count)], axis=1)
        groups = np.unique(corners, axis=0, return_inverse=True)[1].reshape(-1)
        repeat[rows] = ~is_face[rows] & (np.bincount(groups, is_face[rows])[groups] > 0)
    return repeat


def _centers(data: Any) -> Floats:
    """The centers of all cells. Raises ForeignRefusal if a cell has none."""
    # Without the array of hidden cells, each cell has a center.
    plain = data.NewInstance()
    plain.CopyStructure(data)
    plain.GetCellData().Initialize()
    centers = vtkCellCenters()
    centers.SetInputData(plain)
    centers.CopyArraysOff()
    centers.Update()
    places: Floats = vtk_to_numpy(centers.GetOutput().GetPoints().GetData()).astype(np.float64)
    if len(places) != data.GetNumberOfCells():
        raise ForeignRefusal("it must have no empty cells beside volume cells")
    return places


def _attributes(data: Any, found: GridSurface) -> tuple[FileScalars, Floats | None, list[str]]:
    """The scalars of a surface, the normals of its nodes or None, and what was skipped."""
    scalars, normals, skipped = FileScalars(), None, Counter[str]()
    for of, owner, rows in (
        (NODE, data.GetPointData(), found.nodes),
        (POLYGON, data.GetCellData(), found.flats.cells),
    ):
        roles = {
            _text(each.GetName()): what
            for each, what in (
                (owner.GetNormals(), "normals of cells"),
                (owner.GetTCoords(), "texture coordinates"),
                (owner.GetTangents(), "tangents"),
                (owner.GetGlobalIds(), "arrays of numbers for identification"),
                (owner.GetPedigreeIds(), "arrays of numbers for identification"),
            )
            if each is not None
        }
        for at in range(owner.GetNumberOfArrays()):
            array = owner.GetAbstractArray(at)
            name = _text(array.GetName())
            is_normals = roles.get(name) == "normals of cells" or name.lower() == "normals"
            if name == "vtkGhostType":
                continue
            if of == NODE and is_normals and array.GetNumberOfComponents() == 3:
                normals = vtk_to_numpy(array)[rows].astype(np.float64)
            elif what := roles.get(name) or _ignored(array):
                skipped[what] += 1
            else:
                scalars.add(name, vtk_to_numpy(array), of, rows)
    sentences = [f"skipped {what}: {count:,}" for what, count in skipped.items()]
    return scalars, normals, [*scalars.messages, *sentences]


def _ignored(array: Any) -> str:
    """What messages call an array that is skipped for its type; empty for a scalar, vector or tensor."""
    if not array.IsNumeric():
        return "arrays of texts"
    if array.IsA("vtkBitArray"):
        return "arrays of bits"
    is_color = array.IsA("vtkUnsignedCharArray") and array.GetNumberOfComponents() in (3, 4)
    return "arrays of colors" if is_color else ""
