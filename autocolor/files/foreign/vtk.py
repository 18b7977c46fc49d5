"""Reading VTK files, legacy and XML, with VTK's own library, in the process of `worker`.

Of polygonal data, the polygons and the triangles of strips are read; of grids, the polygons and the outer
faces of volume cells. Quads stay quads. Of cells of higher order only the corners are read. Hidden and
duplicate cells are left out. The data of points and cells are scalars of the mesh (see `file_scalars`), and
the normals of points are the file's own normals. VTK's filter gives the surface of grids in rows and columns
alone: it trusts the nodes of cells, and numbers the cells of a surface wrongly beside cells of higher order.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import Any, Final

import numpy as np
from vtkmodules import vtkIOXML
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOLegacy import vtkDataSetReader

from autocolor.arrays import AnyArray, Floats, Indices, cross, dot, runs
from autocolor.checks import listed, shown
from autocolor.files.foreign.cells import (
    CORNERS,
    CellSurface,
    Flats,
    Volumes,
    cell_surface,
    surface_sentences,
)
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal, unreadable
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.repair import RawPolygons, printable_name
from autocolor.files.reading import HEAD, read_head, read_whole
from autocolor.scene.scalar import NODE, POLYGON, MeshScalar

XML_TYPE: Final = re.compile(rb"<VTKFile\s[^>]*?type\s*=\s*[\"'](\w+)[\"']")

DATA_SETS: Final = ("PolyData", "UnstructuredGrid", "StructuredGrid", "RectilinearGrid", "ImageData")
"""The types of XML files that are read. Others name more files, or have no polygons."""

# Cells by the numbers of their types.

EMPTY: Final = 0
STRIP: Final = 6
ANY_POLYGON: Final = 7
PIXEL: Final = 8
VOXEL: Final = 11
POLYHEDRON: Final = 42
WITHOUT_FACES: Final = {1: "vertices", 2: "vertices", **dict.fromkeys((3, 4, 21, 35, 68, 75), "lines")}
TYPES: Final = {
    "triangle": (5, 22, 34, 69, 76),
    "quad": (PIXEL, 9, 23, 28, 30, 70, 77),
    "tetra": (10, 24, 71, 78),
    "pyramid": (14, 27, 37, 74, 81),
    "wedge": (13, 26, 31, 32, 73, 80),
    "hexahedron": (VOXEL, 12, 25, 29, 33, 72, 79),
}
"""The types of each shape. From 21 on they are of higher order; their corners come first."""

SHAPES: Final = {type_: shape for shape, types in TYPES.items() for type_ in types}
ALL_CORNERS: Final = {"triangle": 3, "quad": 4, **CORNERS}
HIGHER_ORDER: Final = 21
ALONG_AXES: Final = [0, 1, 3, 2, 4, 5, 7, 6]
"""The order in which the corners of a pixel or voxel go around it."""

DUPLICATE: Final = 1
HIDDEN: Final = 32
"""The bits of cells that are elsewhere, too, and of those that are not shown."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The surface of a VTK file of the kind "legacy" or "xml". Raises ForeignRefusal."""
    window = listening()
    data, sentences = (_xml if kind == "xml" else _legacy)(path)
    refuse_printed(window, path)
    # VTK prints of arrays that have other numbers of values than there are nodes or cells.
    data.CheckAttributes()
    refuse_printed(window, path)
    nodes, cells = data.GetNumberOfPoints(), data.GetNumberOfCells()
    if not nodes or not cells:
        raise ForeignRefusal(f"it must have nodes and cells, not {nodes:,} nodes and {cells:,} cells")
    ghosts = np.zeros(cells, np.uint8)
    if ghost_type := data.GetCellData().GetArray("vtkGhostType"):
        ghosts = vtk_to_numpy(ghost_type)
    read_surface = {"vtkUnstructuredGrid": _unstructured, "vtkPolyData": _flat}.get(
        data.GetClassName(), _structured
    )
    places, found = read_surface(data, ghosts)
    refuse_printed(window, path)
    sentences += found.sentences
    is_left_out = (ghosts & (DUPLICATE | HIDDEN)) != 0
    if is_left_out.any():
        sentences.append(f"left out hidden or duplicate cells: {np.count_nonzero(is_left_out):,}")
    flats = found.flats.chosen(~is_left_out[found.flats.cells])
    if not len(flats.cells):
        raise ForeignRefusal("; ".join(["it must have polygons or volume cells", *sentences]))
    scalars, normals = _attributes(data, found.nodes, flats.cells, sentences)
    polygons = RawPolygons(
        places,
        flats.corners,
        flats.corner_counts,
        np.zeros(len(flats.cells), np.intp),
        (printable_name(path.stem) or "part",),
        scalars,
        normals=normals,
        corner_normals=None if normals is None else flats.corners,
    )
    return ForeignMesh(polygons, tuple(sentences))


def _legacy(path: Path) -> tuple[Any, list[str]]:
    """The data set of a legacy file, with all of its arrays."""
    data = read_whole(path, 1)
    if b"ASCII" in data[:HEAD].upper().split(b"DATASET")[0]:
        # VTK takes the end of the file for the end of any list of numbers, but not an empty FIELD.
        data += b"\n\nFIELD end 0\n"
    reader: Any = vtkDataSetReader()
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


# The surface.


def places_of(data: Any) -> Floats:
    """The coordinates of the nodes, (nodes, 3)."""
    places: Floats = vtk_to_numpy(data.GetPoints().GetData()).astype(np.float64)
    return places


def _lists(cells: Any, count: int) -> tuple[Indices, Indices]:
    """The numbers in all lists of a cell array, one after the other, and the length of each list.

    Raises ForeignRefusal unless all are from 0 to below `count`.
    """
    arrays = (cells.GetConnectivityArray(), cells.GetOffsetsArray())
    numbers, offsets = (vtk_to_numpy(each).astype(np.intp) for each in arrays)
    if not len(numbers):
        return numbers, np.zeros(max(len(offsets) - 1, 0), np.intp)
    sizes = np.diff(offsets)
    if offsets[0] != 0 or offsets[-1] != len(numbers) or sizes.min() < 0:
        raise ForeignRefusal("the offsets of cells must rise from 0 to the number of their nodes")
    wrong = np.flatnonzero((numbers < 0) | (numbers >= count))
    if len(wrong):
        cell = int(np.searchsorted(offsets, wrong[0], side="right"))
        raise ForeignRefusal(
            f"a cell must have nodes of the file, from 0 to {count - 1:,}, not {numbers[wrong[0]]}"
            f" (cell {cell:,})"
        )
    return numbers, sizes


def polygons_of(data: Any) -> Flats:
    """The polygons of polygonal data, and the triangles of its strips. Raises ForeignRefusal."""
    first, several = data.GetNumberOfVerts() + data.GetNumberOfLines(), []
    for cells in (data.GetPolys(), data.GetStrips()):
        numbers, sizes = _lists(cells, data.GetNumberOfPoints())
        several.append(Flats(numbers, sizes, np.arange(first, first + len(sizes))))
        first += len(sizes)
    return Flats.joined([several[0], _triangles(several[1])])


def _flat(data: Any, ghosts: AnyArray) -> tuple[Floats, CellSurface]:
    """The coordinates of the nodes and the polygons of polygonal data. Raises ForeignRefusal."""
    skipped = {"vertices": data.GetNumberOfVerts(), "lines": data.GetNumberOfLines()}
    sentences = tuple(f"skipped {what}: {count:,}" for what, count in skipped.items() if count)
    return places_of(data), CellSurface(polygons_of(data), np.arange(data.GetNumberOfPoints()), sentences)


def _triangles(strips: Flats) -> Flats:
    """The triangles of strips: each node but the last two begins a triangle; every second is turned over."""
    strips = strips.chosen(strips.corner_counts > 2)
    sizes = strips.corner_counts - 2
    starts = runs(strips.starts, sizes)
    is_odd = runs(np.zeros(len(sizes), np.intp), sizes) % 2
    table = strips.corners[np.column_stack([starts + is_odd, starts + 1 - is_odd, starts + 2])]
    return Flats.of(table, np.repeat(strips.cells, sizes))


def _unstructured(grid: Any, ghosts: AnyArray) -> tuple[Floats, CellSurface]:
    """The coordinates of the nodes of a surface, and the surface. Raises ForeignRefusal for strange cells."""
    places = places_of(grid)
    numbers, sizes = _lists(grid.GetCells(), len(places))
    # The name of the array before VTK 9.6 is the second.
    types = vtk_to_numpy(getattr(grid, "GetCellTypesArray", grid.GetCellTypes)()).astype(np.intp)
    types[(ghosts & HIDDEN) != 0] = EMPTY
    cells = Flats(numbers, sizes, np.arange(len(sizes)))
    flats, volumes, polyhedra, skipped = list[Flats](), list[Volumes](), list[Flats](), Counter[str]()
    for type_ in np.unique(types).tolist():
        rows, shape = np.flatnonzero(types == type_), SHAPES.get(type_)
        if type_ in WITHOUT_FACES:
            skipped[f"skipped {WITHOUT_FACES[type_]}"] += len(rows)
        elif type_ in (STRIP, ANY_POLYGON):
            flats.append(_triangles(cells.chosen(rows)) if type_ == STRIP else cells.chosen(rows))
        elif type_ == POLYHEDRON:
            polyhedra.append(_faces(grid, rows))
        elif shape is not None:
            count, is_higher = ALL_CORNERS[shape], type_ >= HIGHER_ORDER
            is_wrong = sizes[rows] < count if is_higher else sizes[rows] != count
            if is_wrong.any():
                wrong = sizes[rows[is_wrong][0]]
                raise ForeignRefusal(f"a cell of the type {type_} must have {count} nodes, not {wrong}")
            if is_higher:
                skipped["took the corners alone of cells of higher order"] += len(rows)
            order = ALONG_AXES[:count] if type_ in (PIXEL, VOXEL) else range(count)
            table = numbers[cells.starts[rows, None] + np.array(order)]
            if shape in CORNERS:
                volumes.append(Volumes(shape, table, rows))
            else:
                flats.append(Flats.of(table, rows))
        elif type_ != EMPTY:
            raise ForeignRefusal(f"a cell must be of a type with faces, not of the type {type_}")
    surface = cell_surface(places, Flats.joined(flats), volumes, polyhedra)
    sentences = (*(f"{what}: {count:,}" for what, count in skipped.items()), *surface.sentences)
    return places[surface.nodes], surface._replace(sentences=sentences)


def _faces(grid: Any, rows: Indices) -> Flats:
    """The faces of the polyhedra in some rows of a grid. Raises ForeignRefusal."""
    corners, corner_counts = _lists(grid.GetPolyhedronFaces(), grid.GetNumberOfPoints())
    faces, face_counts = _lists(grid.GetPolyhedronFaceLocations(), len(corner_counts))
    of_cells = Flats(faces, face_counts, np.arange(len(face_counts))).chosen(rows)
    owners = np.repeat(of_cells.cells, of_cells.corner_counts)
    chosen = Flats(corners, corner_counts, np.arange(len(corner_counts))).chosen(of_cells.corners)
    return Flats(chosen.corners, chosen.corner_counts, owners[corner_counts[of_cells.corners] > 0])


def _structured(data: Any, ghosts: AnyArray) -> tuple[Floats, CellSurface]:
    """The same for a grid in rows and columns. Raises ForeignRefusal."""
    extent = data.GetExtent()
    sides = tuple(high - low + 1 for low, high in zip(extent[::2], extent[1::2], strict=True))
    wanted, given = (np.prod(sides),), (data.GetNumberOfPoints(),)
    if data.IsA("vtkRectilinearGrid"):
        axes = (data.GetXCoordinates(), data.GetYCoordinates(), data.GetZCoordinates())
        wanted, given = sides, tuple(axis.GetNumberOfTuples() for axis in axes)
    if wanted != given:
        raise ForeignRefusal(f"a grid of {sides} nodes must have as many, not {given}")
    geometry = vtkGeometryFilter()
    geometry.SetInputData(data)
    geometry.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    geometry.PassThroughCellIdsOn()
    geometry.PassThroughPointIdsOn()
    geometry.Update()
    output = geometry.GetOutput()
    if not output.GetNumberOfPolys():
        raise ForeignRefusal("it must have polygons or volume cells, not points and lines alone")
    nodes = vtk_to_numpy(output.GetPointData().GetArray("vtkOriginalPointIds")).astype(np.intp)
    cells = vtk_to_numpy(output.GetCellData().GetArray("vtkOriginalCellIds")).astype(np.intp)
    flats, places, sentences = polygons_of(output), places_of(output), list[str]()
    quads = flats.corners.reshape(-1, 4)
    if min(sides) > 1:
        sentences = surface_sentences(data.GetNumberOfCells(), data.GetNumberOfPoints() - len(nodes))
        a, b, c, d = (places[corners].T for corners in quads.T)
        # A left-handed grid is inside out.
        if dot(a, cross(b, c) + cross(c, d)).sum() < 0:
            quads = quads[:, ::-1]
    flats = Flats(quads.ravel(), flats.corner_counts, cells[flats.cells])
    return places, CellSurface(flats, nodes, tuple(sentences))


def _attributes(
    data: Any, nodes: Indices, cells: Indices, sentences: list[str]
) -> tuple[tuple[MeshScalar, ...], Floats | None]:
    """The scalars of a surface, and the normals of its nodes or None; adds sentences about other arrays."""
    scalars, normals, left_out = FileScalars(), None, list[str]()
    for of, owner, rows in ((NODE, data.GetPointData(), nodes), (POLYGON, data.GetCellData(), cells)):
        for at in range(owner.GetNumberOfArrays()):
            array = owner.GetAbstractArray(at)
            name, width = _text(array.GetName()), array.GetNumberOfComponents()
            is_normals = array is owner.GetNormals() or (name.lower() == "normals" and width == 3)
            is_color = array.IsA("vtkUnsignedCharArray") and width in (3, 4)
            if is_normals and of == NODE:
                normals = vtk_to_numpy(array)[rows].astype(np.float64)
            elif is_normals or is_color or not array.IsNumeric() or array.IsA("vtkBitArray"):
                left_out.append(shown(name))
            elif name != "vtkGhostType" and array is not owner.GetTCoords():
                scalars.add(name, vtk_to_numpy(array), of, rows)
    if left_out:
        sentences.append(f"left out arrays that are no scalars: {listed(left_out)}")
    sentences += scalars.messages
    return scalars.scalars, normals
