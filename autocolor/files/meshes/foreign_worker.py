"""The process in which a library reads a file: the only module that imports trimesh and meshio.

It is started as `python -m autocolor.files.meshes.foreign_worker LIBRARY FORMAT MESH RESULT SIZE LIMIT`. SIZE
is the number of bytes to read, and LIMIT a factor for the budget. Once the library is loaded, the system
limits time, memory and the size of the result. From then on this process opens no file but in the folder of
the mesh and of Python, writes none but the result, and has no network. If the file cannot be read, the exit
code is FAILED and the result a sentence.
"""

from __future__ import annotations

import math
import mimetypes
import os
import re
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.budget import allowing
from autocolor.checks import Color
from autocolor.files.meshes.cells import CORNERS, Flats, Volumes, cell_surface
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.foreign import (
    FAILED,
    LONGEST_SENTENCE,
    ForeignMesh,
    foreign_mesh_bytes,
    largest_result,
    most_memory,
    most_seconds,
)
from autocolor.files.meshes.repair import RawPolygons, different, printable_name
from autocolor.scene.scalar import LARGEST_SCALAR, NODE, POLYGON

FORBIDDEN: Final = (
    "socket.", "subprocess.", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "pty.",
    "ctypes.dlopen", "urllib.", "http.", "ftplib.", "smtplib.", "os.remove", "os.rename", "os.rmdir",
    "os.mkdir", "os.link", "os.symlink", "os.truncate", "os.kill", "shutil.",
)  # fmt: skip
"""The beginnings of the names of audit events that no mesh reader needs."""

WRITING: Final = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


def main(arguments: list[str]) -> int:
    """Read a file and write its mesh, or the reason of a failure. Returns the exit code."""
    library, kind, mesh, result, size, factor = arguments
    warnings.simplefilter("ignore")
    code = 0
    try:
        read = LIBRARIES[library](kind)
        with allowing(float(factor)):
            limit(int(size))
        sys.addaudithook(guard(Path(mesh).parent, Path(result)))
        data = foreign_mesh_bytes(read(mesh))
    except (Exception, SystemExit) as error:
        code, data = FAILED, sentence_of(error).encode("utf-8", "replace")
    with open(result, "wb") as file:
        file.write(data)
    return code


def sentence_of(error: BaseException) -> str:
    """The message of an exception, in one line of at most LONGEST_SENTENCE letters."""
    if isinstance(error, MemoryError):
        return "it needs more memory than its size and --limit allow"
    if isinstance(error, SystemExit):
        return "it gave up"
    text = " ".join(str(error).split())
    name = type(error).__name__
    return (f"{name}: {text}" if text else name)[:LONGEST_SENTENCE]


def limit(size: int) -> None:
    """Limit the time, the memory and the result of this process for a file of `size` bytes."""
    if sys.platform == "win32":
        return
    import resource

    memory, largest = most_memory(size), largest_result(size)
    seconds = math.ceil(time.process_time() + most_seconds(size))
    for kind, soft, hard in (
        (resource.RLIMIT_AS, memory, memory),
        (resource.RLIMIT_FSIZE, largest, largest),
        (resource.RLIMIT_CORE, 0, 0),
        # At the hard limit a process is killed without a reason; a second before, SIGXCPU tells it.
        (resource.RLIMIT_CPU, seconds, seconds + 1),
    ):
        most = resource.getrlimit(kind)[1]
        if most != resource.RLIM_INFINITY:
            soft, hard = min(soft, most), min(hard, most)
        resource.setrlimit(kind, (soft, hard))


def guard(folder: Path, result: Path) -> Callable[[str, tuple[Any, ...]], None]:
    """An audit hook that raises PermissionError for files elsewhere, the network and other programs."""
    readable = [
        os.path.realpath(each) for each in {str(folder), sys.prefix, sys.base_prefix, *sys.path} if each
    ]
    written = os.path.realpath(result)

    def refuse(event: str, values: tuple[Any, ...]) -> None:
        if event == "open":
            path, _, flags = values
            if isinstance(path, int):
                return
            real = os.path.realpath(os.fsdecode(path))
            if real == written:
                return
            writes = isinstance(flags, int) and flags & WRITING
            if writes or not any(os.path.commonpath([real, each]) == each for each in readable):
                raise PermissionError(f"the file names {os.fsdecode(path)!r}, which is not in its folder")
        elif event.startswith(FORBIDDEN):
            raise PermissionError(f"{event} is not allowed")

    return refuse


# The triangles of a scene of trimesh: each node of the scene with a mesh is a part, placed by its
# transform.
#
# Nodes of a part with equal coordinates and scalars are welded: glTF writes a corner again for each normal
# and texture coordinate. Points and paths are skipped and counted. Materials have their name and base color;
# textures are left out.

MOST_PLACED: Final = 100_000
"""Limit: parts of a scene, of which many may be the same mesh."""


def polygons_of_trimesh(scene: Any, stem: str) -> ForeignMesh:
    """The triangles of a scene of trimesh; a part without a name is named `stem`."""
    order = {name: at for at, name in enumerate(scene.geometry)}
    placed = [(str(node), *scene.graph[node]) for node in scene.graph.nodes_geometry]
    if len(placed) > MOST_PLACED:
        raise ValueError(f"{len(placed):,} parts, and at most {MOST_PLACED:,} are read")
    placed.sort(key=lambda each: (order.get(each[2], len(order)), each[0]))
    coordinates: list[Floats] = []
    triangles: list[Indices] = []
    values: list[dict[str, Floats]] = []
    names: list[str] = []
    materials: list[tuple[str, Color | None]] = []
    skipped = textured = nodes = 0
    for name, transform, geometry in placed:
        mesh = scene.geometry[geometry]
        faces = getattr(mesh, "faces", None)
        if faces is None or not len(faces):
            skipped += 1
            continue
        attributes = _scalars_of(mesh)
        matrix = np.asarray(transform, np.float64)
        moved = np.asarray(mesh.vertices, np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        places, rows = _welded(moved, attributes)
        table = np.asarray(faces, np.intp)
        if table.min() < 0 or table.max() >= len(rows[1]):
            raise ValueError(f"a triangle of {name} with a node that it does not have")
        # A reflection turns the triangles over.
        turned = np.linalg.det(matrix[:3, :3]) < 0
        triangles.append(nodes + rows[1][table[:, ::-1] if turned else table])
        coordinates.append(places)
        values.append({key: each[rows[0]] for key, each in attributes.items()})
        names.append(name.strip() or stem)
        material, has_texture = _material_of(mesh)
        materials.append(material)
        textured += has_texture
        nodes += len(places)
    if not names:
        raise ValueError("no triangles")
    part_names = part_names_of(names)
    scalars = FileScalars()
    for key in dict.fromkeys(key for each in values for key in each):
        of_parts = [
            each.get(key, np.full(len(places), np.nan))
            for each, places in zip(values, coordinates, strict=True)
        ]
        scalars.add(key, np.concatenate(of_parts), NODE)
    corners = np.concatenate(triangles)
    counts = [len(each) for each in triangles]
    polygons = RawPolygons(
        np.concatenate(coordinates),
        corners.ravel(),
        np.full(len(corners), 3, np.intp),
        np.repeat(np.arange(len(counts)), counts),
        part_names,
        scalars.scalars,
    )
    counted = (("skipped parts without triangles", skipped), ("left out the textures of parts", textured))
    sentences = [f"{sentence}: {number:,}" for sentence, number in counted if number]
    return ForeignMesh(
        polygons,
        (*sentences, *scalars.messages),
        {part: name for part, (name, _) in zip(part_names, materials, strict=True) if name},
        {name: color for name, color in materials if name and color is not None},
    )


def part_names_of(names: Sequence[str]) -> tuple[str, ...]:
    """Names of parts that are printable and different; a part without a name is "part"."""
    return different([printable_name(name) or "part" for name in names])


def _scalars_of(mesh: Any) -> dict[str, Floats]:
    """The attributes with one number for each node; a number that is too large becomes missing."""
    attributes = {}
    for name, values in (getattr(mesh, "vertex_attributes", None) or {}).items():
        numbers = np.asarray(values)
        numbers = numbers[:, 0] if numbers.ndim == 2 and numbers.shape[1] == 1 else numbers
        if numbers.shape == (len(mesh.vertices),) and numbers.dtype.kind in "iuf":
            numbers = numbers.astype(np.float64)
            attributes[str(name).removeprefix("_")] = np.where(
                np.abs(numbers) <= LARGEST_SCALAR, numbers, np.nan
            )
    return attributes


def _welded(places: Floats, scalars: dict[str, Floats]) -> tuple[Floats, tuple[Indices, Indices]]:
    """The different coordinates; their rows in `places`; and the new row of each row of `places`."""
    columns = np.column_stack([places, *scalars.values()]) + 0.0
    _, first, rows = np.unique(columns, axis=0, return_index=True, return_inverse=True)
    # Keep the order of the file.
    order = np.argsort(first)
    rank = np.empty(len(order), np.intp)
    rank[order] = np.arange(len(order))
    leaders = first[order]
    return places[leaders], (leaders, rank[rows.reshape(-1)])


def _material_of(mesh: Any) -> tuple[tuple[str, Color | None], bool]:
    """The name and base color of the material of a mesh, and whether it has a texture."""
    material = getattr(getattr(mesh, "visual", None), "material", None)
    name = getattr(material, "name", None)
    texture = getattr(material, "baseColorTexture", None) is not None
    color = getattr(material, "baseColorFactor", None)
    if not isinstance(name, str) or not name:
        return ("", None), texture
    name = printable_name(name) or "material"
    if color is None or len(color) < 3:
        return (name, None), texture
    red, green, blue = (int(each) for each in np.clip(np.asarray(color)[:3], 0, 255))
    return (name, (red, green, blue)), texture


# The surface of a mesh of meshio: its polygons, the outer faces of its volume cells, parts and scalars.
#
# Of cells of higher order the corners are taken. Vertices, lines and cells of other kinds are skipped and
# counted. Parts are the physical groups of Gmsh, the sets of cells of Abaqus and others, or the numbers
# with which Medit, Nastran and SU2 tell cells apart. A cell in several sets belongs to the first set, and a
# cell in no set to the part named after the file.

SHAPE: Final = re.compile(r"(triangle|quad|tetra|hexahedron|wedge|pyramid)([0-9]*)")
POLYGONS: Final = re.compile(r"polygon[0-9]*")
ALL_CORNERS: Final = {"triangle": 3, "quad": 4, **CORNERS}

GROUPS: Final = ("gmsh:physical", "medit:ref", "nastran:ref", "su2:tag", "ugrid:ref", "cell_tags")
"""The cell data with group numbers, in order of preference."""

INTERNAL: Final = re.compile(r"(gmsh|medit|nastran|su2|ugrid|abaqus):")


def polygons_of_meshio(mesh: Any, stem: str) -> ForeignMesh:
    """The surface of a mesh of meshio; cells in no group are the part `stem`."""
    points = np.asarray(mesh.points, np.float64)
    if points.ndim != 2 or points.shape[1] > 3:
        raise ValueError(f"nodes of shape {points.shape}")
    coordinates = np.zeros((len(points), 3))
    coordinates[:, : points.shape[1]] = points

    flats: list[Flats] = []
    volumes: list[Volumes] = []
    skipped: dict[str, int] = {}
    higher_order = count = 0
    for block in mesh.cells:
        rows = np.arange(count, count + len(block.data))
        count += len(rows)
        shape = SHAPE.fullmatch(block.type)
        if shape is None and not POLYGONS.fullmatch(block.type):
            skipped[block.type] = skipped.get(block.type, 0) + len(rows)
            continue
        if shape is None:
            sizes = np.array([len(row) for row in block.data], np.intp)
            flats.append(Flats(_rows(np.concatenate([np.empty(0, np.intp), *block.data])), sizes, rows))
            continue
        table = np.asarray(block.data).reshape(len(rows), -1)
        name, corners = shape[1], ALL_CORNERS[shape[1]]
        higher_order += len(rows) if table.shape[1] > corners else 0
        table = _rows(table[:, :corners])
        if len(rows) and table.shape[1] != corners:
            raise ValueError(f"cells of type {block.type} with {table.shape[1]} corners")
        if name in CORNERS:
            volumes.append(Volumes(name, table, rows))
        else:
            flats.append(Flats.of(table, rows))
    every = Flats.joined(flats)
    for numbers in (every.corners, *(each.corners.ravel() for each in volumes)):
        if len(numbers) and not (numbers.min() >= 0 and numbers.max() < len(coordinates)):
            raise ValueError(f"a cell with a node that is none of the {len(coordinates):,} of the file")
    surface = cell_surface(coordinates, every, volumes)
    part_of_cell, part_names = _parts(mesh, count, stem)
    scalars = _scalars(mesh, surface.nodes, surface.flats.cells)
    used, part_numbers = np.unique(part_of_cell[surface.flats.cells], return_inverse=True)
    polygons = RawPolygons(
        coordinates[surface.nodes],
        surface.flats.corners,
        surface.flats.corner_counts,
        part_numbers.reshape(-1).astype(np.intp),
        part_names_of([part_names[part] for part in used.tolist()]),
        scalars.scalars,
    )
    sentences = [f"skipped cells of type {kind}: {number:,}" for kind, number in skipped.items()]
    if higher_order:
        sentences.append(f"took the corners alone of cells of higher order: {higher_order:,}")
    return ForeignMesh(polygons, (*sentences, *surface.sentences, *scalars.messages))


def _rows(numbers: AnyArray) -> Indices:
    """Node numbers as rows. Raises ValueError if a number is not whole."""
    with np.errstate(invalid="ignore"):
        rows = numbers.astype(np.intp)
    if not np.array_equal(rows, numbers):
        raise ValueError("node numbers that are not whole")
    return rows


def _parts(mesh: Any, count: int, stem: str) -> tuple[Indices, list[str]]:
    """The part number of each cell, and the names of the parts."""
    data = getattr(mesh, "cell_data", {}) or {}
    for key in GROUPS:
        tags = _joined(data.get(key), count)
        if tags is not None and tags.ndim == 1 and tags.dtype.kind in "iu":
            named = {
                int(value[0]): str(name)
                for name, value in (getattr(mesh, "field_data", {}) or {}).items()
                if np.size(value) >= 1
            }
            numbers, parts = np.unique(tags, return_inverse=True)
            names = [named.get(number, f"part {number}") for number in numbers.tolist()]
            return parts.reshape(-1).astype(np.intp), names
    part_of_cell = np.zeros(count, np.intp)
    names = [stem]
    starts = np.cumsum([0, *(len(block.data) for block in mesh.cells)])
    for name, blocks in (getattr(mesh, "cell_sets", {}) or {}).items():
        if INTERNAL.match(str(name)):
            continue
        names.append(str(name))
        for start, end, chosen in zip(starts, starts[1:], blocks, strict=False):
            rows = np.asarray([] if chosen is None else chosen)
            rows = start + rows.astype(np.intp)
            rows = rows[(rows >= start) & (rows < end)]
            part_of_cell[rows[part_of_cell[rows] == 0]] = len(names) - 1
    return part_of_cell, names


def _joined(blocks: Any, count: int) -> AnyArray | None:
    """The data of the cells of all blocks; None if they do not fit together."""
    try:
        joined = np.concatenate([np.asarray(each) for each in blocks])
    except (TypeError, ValueError):
        return None
    return joined if len(joined) == count else None


def _scalars(mesh: Any, nodes: Indices, cells: Indices) -> FileScalars:
    """The scalars of nodes and cells at the given rows."""
    scalars = FileScalars()
    count = sum(len(block.data) for block in mesh.cells)
    of_nodes = {name: np.asarray(each) for name, each in (mesh.point_data or {}).items()}
    of_cells = {name: _joined(each, count) for name, each in (mesh.cell_data or {}).items()}
    for of, arrays, rows, length in (
        (NODE, of_nodes, nodes, len(mesh.points)),
        (POLYGON, of_cells, cells, count),
    ):
        for name, values in arrays.items():
            if INTERNAL.match(str(name)) or name in GROUPS:
                continue
            if values is None or len(values) != length or values.dtype.kind not in "iufb":
                scalars.sentences.append(
                    f"skipped the {of} array {name!r}, which has no number for each {of}"
                )
            else:
                scalars.add(str(name), values, of, rows)
    return scalars


def meshio_reader(kind: str) -> Callable[[str], ForeignMesh]:
    """The function that reads a file of a format with meshio, which is loaded."""
    import meshio

    def read(path: str) -> ForeignMesh:
        return polygons_of_meshio(meshio.read(path, kind), Path(path).stem)

    return read


def trimesh_reader(kind: str) -> Callable[[str], ForeignMesh]:
    """The function that reads a file of a format with trimesh, which is loaded."""
    import trimesh

    # mimetypes reads files outside of Python's folders, which `guard` forbids later.
    mimetypes.init()

    def read(path: str) -> ForeignMesh:
        scene = trimesh.load_scene(path, file_type=kind, process=False)
        return polygons_of_trimesh(scene, Path(path).stem)

    return read


LIBRARIES: Final[dict[str, Callable[[str], Callable[[str], ForeignMesh]]]] = {
    "meshio": meshio_reader,
    "trimesh": trimesh_reader,
}

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
