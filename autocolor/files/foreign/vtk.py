"""Reading VTK files, legacy and XML, with VTK's own library, in the process of `worker`.

Of polygonal data, the polygons and the triangles of strips are read; of grids, the polygons and the outer
faces of volume cells. Quads stay quads. Of cells of higher order only the corners are read. Hidden and
duplicate cells are left out. The data of points and cells are scalars of the mesh (see `file_scalars`), and
the normals of points are the file's own normals. VTK's filter gives the surface of grids in rows and columns
alone: it trusts the nodes of cells, and numbers the cells of a surface wrongly beside cells of higher order.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np
from vtkmodules import vtkIOXML
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkGenericCell
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOLegacy import vtkDataSetReader

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, cross, dot, runs
from autocolor.checks import listed, shown
from autocolor.files.foreign.cells import CORNERS, Block, CellSurface, Flats, cell_surface, surface_sentences
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal, unreadable
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.repair import RawPolygons, printable_name
from autocolor.files.reading import HEAD, read_head, read_whole
from autocolor.scene.scalar import NODE, POLYGON, MeshScalar

DATA_SETS: Final = "PolyData|UnstructuredGrid|StructuredGrid|RectilinearGrid|ImageData"
"""The types of XML files that are read. Others name more files, or have no polygons."""

SHAPE_OF_EDGES: Final = {3: "triangle", 4: "quad", 6: "tetra", 8: "pyramid", 9: "wedge", 12: "hexahedron"}
"""The shape of a cell by the number of its edges."""

ALONG_AXES: Final = [0, 1, 3, 2, 4, 5, 7, 6]
"""The order in which the corners of a pixel or voxel go around it."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The surface of a VTK file of the kind "vtk" or "vtk xml". Raises ForeignRefusal."""
    sentences = list[str]()
    with listening(path):
        data = _xml(path) if kind == "vtk xml" else _legacy(path)
        # VTK prints of arrays that have other numbers of values than there are nodes or cells.
        data.CheckAttributes()
    if not data.GetNumberOfPoints() or not data.GetNumberOfCells():
        raise ForeignRefusal("it must have nodes and cells, and has none")
    ghosts, is_turned = _ghosts(data), False
    if count := np.count_nonzero(ghosts):
        sentences.append(f"left out hidden or duplicate cells: {count:,}")
    if not data.IsA("vtkPolyData") and not data.IsA("vtkUnstructuredGrid"):
        with listening(path):
            data, is_turned = _outer(data, sentences)
        ghosts = _ghosts(data)
    surface = surface_of(data, (ghosts & vtkDataSetAttributes.HIDDENCELL) != 0)
    sentences += surface.sentences
    flats = surface.flats.chosen(ghosts[surface.flats.cells] == 0)
    if not len(flats.cells):
        raise ForeignRefusal("; ".join(["it must have polygons or volume cells", *sentences]))
    corners = flats.corners.reshape(-1, 4)[:, ::-1].ravel() if is_turned else flats.corners
    scalars, normals = _attributes(data, surface.nodes, flats.cells, sentences)
    polygons = RawPolygons(
        places_of(data)[surface.nodes],
        corners,
        flats.corner_counts,
        np.zeros(len(flats.cells), np.intp),
        (printable_name(path.stem) or "part",),
        scalars,
        normals=normals,
        corner_normals=None if normals is None else corners,
    )
    return ForeignMesh(polygons, tuple(sentences))


def _ghosts(data: Any) -> AnyArray:
    """For each cell, whether it is elsewhere, too, or not shown; otherwise 0."""
    array = data.GetCellData().GetArray("vtkGhostType")
    ghosts: AnyArray = vtk_to_numpy(array) if array else np.zeros(data.GetNumberOfCells(), np.uint8)
    ghosts = ghosts & (vtkDataSetAttributes.DUPLICATECELL | vtkDataSetAttributes.HIDDENCELL)
    return ghosts


def _legacy(path: Path) -> Any:
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
    return reader.GetOutputDataObject(0)


def _xml(path: Path) -> Any:
    """The data set of an XML file, of all pieces. Raises ForeignRefusal for a type with other files."""
    match = re.search(rf"<VTKFile\s[^>]*?type\s*=\s*[\"']({DATA_SETS})[\"']".encode(), read_head(path))
    if match is None:
        types = DATA_SETS.replace("|", ", ")
        raise ForeignRefusal(
            f"the type of a VTK XML file must be one of {types}", "write its surface as .vtp"
        )
    reader = getattr(vtkIOXML, f"vtkXML{match[1].decode()}Reader")()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutputDataObject(0)


PRINTED: Final = re.compile(r"(?:ERROR|Warning): In .*\n(?:\w* ?\(\w+\): )?\s*(.+)")


@contextmanager
def listening(path: Path) -> Iterator[None]:
    """Raise ForeignRefusal at the end with the first error or warning, which may tell of lost data."""
    window = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    try:
        yield
    finally:
        if printed := PRINTED.search(_text(window.GetOutput())):
            raise unreadable("VTK", printed[1].replace(str(path), path.name).strip(" .")) from None


def _text(given: str | bytes | None) -> str:
    """A text of VTK's, which is bytes if it is not UTF-8."""
    return given.decode("latin-1") if isinstance(given, bytes) else given or ""


def places_of(data: Any) -> Floats:
    """The coordinates of the nodes, (nodes, 3)."""
    places: Floats = vtk_to_numpy(data.GetPoints().GetData()).astype(np.float64)
    return places


def _outer(data: Any, sentences: list[str]) -> tuple[Any, bool]:
    """The outer surface of a grid in rows and columns, as polygonal data, and whether it is inside out.

    Adds sentences about it. Raises ForeignRefusal.
    """
    extent = data.GetExtent()
    sides = tuple(high - low + 1 for low, high in zip(extent[::2], extent[1::2], strict=True))
    if data.IsA("vtkRectilinearGrid"):
        axes = (data.GetXCoordinates(), data.GetYCoordinates(), data.GetZCoordinates())
        if sides != tuple(axis.GetNumberOfTuples() for axis in axes):
            raise ForeignRefusal(f"a grid of {sides} nodes must have as many coordinates along its axes")
    geometry = vtkGeometryFilter()
    geometry.SetInputData(data)
    geometry.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    geometry.Update()
    outer = geometry.GetOutput()
    if min(sides) == 1 or not outer.GetNumberOfPolys():
        return outer, False
    sentences += surface_sentences(
        data.GetNumberOfCells(), data.GetNumberOfPoints() - outer.GetNumberOfPoints()
    )
    quads = _lists(outer.GetPolys())[0].reshape(-1, 4)
    a, b, c, d = (places_of(outer)[corners].T for corners in quads.T)
    # A left-handed grid is inside out.
    return outer, bool(dot(a, cross(b, c) + cross(c, d)).sum() < 0)


def _lists(cells: Any) -> tuple[Indices, Indices]:
    """The numbers in all lists of a cell array, one after the other, and the length of each list.

    Raises ForeignRefusal.
    """
    arrays = (cells.GetConnectivityArray(), cells.GetOffsetsArray())
    numbers, offsets = (vtk_to_numpy(each).astype(np.intp) for each in arrays)
    sizes = np.diff(offsets)
    if len(numbers) and (offsets[0] or offsets[-1] != len(numbers) or min(sizes.min(), numbers.min()) < 0):
        raise ForeignRefusal("nodes of cells must be 0 or more, and their offsets must rise to their number")
    return numbers, sizes if len(numbers) else np.zeros_like(sizes)


def surface_of(data: Any, is_hidden: Booleans | bool = False) -> CellSurface:
    """The surface of polygonal data or an unstructured grid. Raises ForeignRefusal for strange cells."""
    if data.IsA("vtkPolyData"):
        arrays = (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips())
        numbers, sizes = (np.concatenate(each) for each in zip(*map(_lists, arrays), strict=True))
        # The types of vertices, lines, polygons and strips.
        types = np.repeat([1, 3, 7, 6], [each.GetNumberOfCells() for each in arrays])
    else:
        numbers, sizes = _lists(data.GetCells())
        # The name of the array before VTK 9.6 is the second.
        types = vtk_to_numpy(getattr(data, "GetCellTypesArray", data.GetCellTypes)()).astype(np.intp)
    cells = Flats(numbers, sizes, np.arange(len(sizes)))
    # Zero is the type of empty cells.
    types = np.where(is_hidden, 0, types)
    blocks, flats, polyhedra, skipped = list[Block](), list[Flats](), list[Flats](), list[str]()
    for type_ in np.unique(types).tolist():
        rows, example = np.flatnonzero(types == type_), vtkGenericCell.InstantiateCell(type_)
        name = "" if example is None else example.GetClassName()
        if name == "vtkTriangleStrip":
            flats.append(_triangles(cells.chosen(rows)))
        elif name == "vtkPolygon":
            flats.append(cells.chosen(rows))
        elif name == "vtkPolyhedron":
            polyhedra.append(_faces(data, rows))
        elif name and example.GetCellDimension() < 2:
            what = ("vertices", "lines")[example.GetCellDimension()]
            skipped += [f"skipped {what}: {len(rows):,}"] * (type_ > 0)
        elif name and (shape := SHAPE_OF_EDGES.get(example.GetNumberOfEdges())):
            count, sizes = CORNERS[shape], cells.corner_counts[rows]
            if min(sizes) < count or (example.IsLinear() and max(sizes) > count):
                raise ForeignRefusal(f"all cells of the type {type_} must have {count} nodes")
            if not example.IsLinear():
                skipped.append(f"took the corners alone of cells of the type {type_}: {len(rows):,}")
            order = ALONG_AXES[:count] if name in ("vtkPixel", "vtkVoxel") else range(count)
            blocks.append((shape, cells.corners[cells.starts[rows, None] + np.array(order)], rows))
        else:
            raise ForeignRefusal(f"a cell must be of a type with faces, not of the type {type_}")
    surface = cell_surface(places_of(data), blocks, flats, polyhedra)
    return surface._replace(sentences=(*skipped, *surface.sentences))


def _triangles(strips: Flats) -> Flats:
    """The triangles of strips: each node but the last two begins a triangle; every second is turned over."""
    strips = strips.chosen(strips.corner_counts > 2)
    sizes = strips.corner_counts - 2
    starts = runs(strips.starts, sizes)
    is_odd = runs(np.zeros(len(sizes), np.intp), sizes) % 2
    table = strips.corners[np.column_stack([starts + is_odd, starts + 1 - is_odd, starts + 2])]
    return Flats.of(table, np.repeat(strips.cells, sizes))


def _faces(grid: Any, rows: Indices) -> Flats:
    """The faces of the polyhedra in some rows of a grid. Raises ForeignRefusal."""
    corners, corner_counts = _lists(grid.GetPolyhedronFaces())
    faces, face_counts = _lists(grid.GetPolyhedronFaceLocations())
    of_cells = Flats(faces, face_counts, np.arange(len(face_counts))).chosen(rows)
    owners = np.repeat(of_cells.cells, of_cells.corner_counts)
    chosen = Flats(corners, corner_counts, np.arange(len(corner_counts))).chosen(of_cells.corners)
    return Flats(chosen.corners, chosen.corner_counts, owners[corner_counts[of_cells.corners] > 0])


def _attributes(
    data: Any, nodes: Indices, cells: Indices, sentences: list[str]
) -> tuple[tuple[MeshScalar, ...], Floats | None]:
    """The scalars of a surface, and the normals of its nodes or None; adds sentences about other arrays."""
    scalars, normals, left_out = FileScalars(), None, list[str]()
    for of, owner, rows in ((NODE, data.GetPointData(), nodes), (POLYGON, data.GetCellData(), cells)):
        for at in range(owner.GetNumberOfArrays()):
            array = owner.GetAbstractArray(at)
            name, width = _text(array.GetName()), array.GetNumberOfComponents()
            is_color = array.IsA("vtkUnsignedCharArray") and width in (3, 4)
            if array is owner.GetNormals() or (name.lower() == "normals" and width == 3):
                normals = vtk_to_numpy(array)[rows].astype(np.float64) if of == NODE else normals
            elif is_color or not array.IsNumeric():
                left_out.append(shown(name))
            elif name != "vtkGhostType" and array is not owner.GetTCoords():
                scalars.add(name, vtk_to_numpy(array), of, rows)
    if left_out:
        sentences.append(f"left out arrays that are no scalars: {listed(left_out)}")
    sentences += scalars.messages
    return scalars.scalars, normals
