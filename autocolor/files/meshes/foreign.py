"""Mesh files that libraries read for us, each in a process of its own.

- VTK (.vtk, and .vtp, .vtu, .vts, .vtr, .vti) and glTF (.glb, .gltf): VTK, the extra `vtk`. glTF is y up by
  its specification: the reader turns it so unless it is read with x up.
- 3MF: lib3mf; Abaqus (.inp), Gmsh (.msh), Nastran (.bdf, .nas, .fem), Medit (.mesh) and binary UGRID
  (as in .b8.ugrid): meshio, of which these formats need no further package. They are the extra `meshes`.

A library may hang, crash, print or eat memory without harm to this process. The other process
(`foreign_worker`) writes the mesh as an array file, which is checked like any other file.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import io
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

import autocolor.files
from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.budget import allowed_memory, validated_limit
from autocolor.checks import LARGEST_COORDINATE, printable, shown
from autocolor.errors import InputError, UnavailableError
from autocolor.files.array_file import (
    KEY,
    MESH_SCALARS,
    ArrayFileKind,
    array_file_bytes,
    read_array_file,
    scalar_members,
    scalar_rows,
    scalars_of,
)
from autocolor.files.meshes.foreign_mesh import REMEDY, ForeignMesh
from autocolor.files.meshes.gltf_document import size_of_gltf
from autocolor.files.meshes.meshio_text import size_of_text
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.reading import opened, read_bytes, read_whole, require_size
from autocolor.scene.columns import replaced
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from autocolor.scene.scalar import NODE

MEGABYTE: Final = 1 << 20

# The size of a file and of the files that it names, which gives the limits.

MOST_MEMBERS: Final = 10_000
LARGEST_GROWTH: Final = 200
"""Limit: how many times larger than a 3MF file its unpacked content may be. XML packs to a tenth."""


def size_of_file(path: Path) -> int:
    """The bytes of a file that names no others. Raises InputError if it is not regular."""
    with opened(path) as (_, status):
        return status.st_size


def size_of_3mf(path: Path) -> int:
    """The bytes of the unpacked files of a 3MF file, by the directory of the archive. Raises InputError."""
    data = read_whole(path, 1)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
    except (
        zipfile.BadZipFile,
        ValueError,
        OSError,
        EOFError,
        RuntimeError,
        LookupError,
        struct.error,
    ) as error:
        raise InputError(
            f"{path.name}: a 3MF file must be a whole ZIP archive, not damaged ({error}); write it again"
        ) from None
    size = sum(member.file_size for member in members)
    most = LARGEST_GROWTH * len(data)
    if len(members) > MOST_MEMBERS or size > most:
        raise InputError(
            f"{path.name}: a 3MF file of its size must hold at most {MOST_MEMBERS:,} files and {most:,}"
            f" bytes, not {len(members):,} and {size:,}; simplify it"
        )
    return max(size, len(data))


# The mesh that comes back from the other process.


RESULT: Final = ArrayFileKind(
    noun="result of a reader",
    advice="write the mesh as OBJ or PLY",
    formats=("autocolor foreign mesh 3",),
    keys=frozenset(("part_names", "sentences", "material_of_part", "colors")),
    arrays={
        "coordinates": ("<f8", 2),
        "corners": ("<i8", 1),
        "corner_counts": ("<i8", 1),
        "part_numbers": ("<i8", 1),
        "normals": ("<f8", 2),
        "corner_normals": ("<i8", 1),
    },
    series={KEY: MESH_SCALARS},
)
"""The array file that a mesh comes back in."""

LONGEST_SENTENCE: Final = 300
MOST_SENTENCES: Final = 100


def foreign_mesh_bytes(mesh: ForeignMesh) -> bytes:
    """The content of the array file that a mesh comes back in."""
    polygons = mesh.polygons
    header = {
        "part_names": polygons.part_names,
        "sentences": mesh.sentences,
        "material_of_part": dict(mesh.material_of_part),
        "colors": dict(mesh.colors),
        KEY: scalar_rows(polygons.scalars),
    }
    has_normals = polygons.normals is not None
    absent = {} if has_normals else {"normals": np.empty((0, 3)), "corner_normals": np.empty(0)}
    arrays = {name: vars(polygons)[name] for name in RESULT.arrays} | absent
    return array_file_bytes(RESULT, header, {**arrays, **scalar_members(polygons.scalars)})


def read_foreign_mesh(path: Path, place: str, library: str) -> ForeignMesh:
    """The mesh that a library gave for the file `place`, in an array file.

    Raises InputError unless all numbers of nodes, corners and parts are right.
    """
    try:
        header, arrays = read_array_file(RESULT, path)
        scalars = scalars_of(header, arrays)
    except InputError as error:
        raise InputError(
            f"{place}: {library} gave no mesh ({str(error)[:LONGEST_SENTENCE]}); {REMEDY}"
        ) from None
    if problem := _problem(arrays, len(header["part_names"])):
        raise InputError(f"{place}: {library} gave {problem}; {REMEDY}")
    for scalar in scalars:
        count = len(arrays["coordinates" if scalar.of == NODE else "corner_counts"])
        if len(scalar.values) != count:
            raise InputError(
                f"{place}: {library} gave a scalar without a value for each {scalar.of}; {REMEDY}"
            )
    normals = _normals(arrays)
    polygons = RawPolygons(
        arrays["coordinates"].copy(),
        arrays["corners"].astype(np.intp),
        arrays["corner_counts"].astype(np.intp),
        arrays["part_numbers"].astype(np.intp),
        tuple(header["part_names"]),
        scalars,
        normals=normals and normals[0],
        corner_normals=normals and normals[1],
    )
    sentences = (printable(each[:LONGEST_SENTENCE]) for each in header["sentences"][:MOST_SENTENCES])
    return ForeignMesh(polygons, tuple(sentences), header["material_of_part"], header["colors"])


def _problem(arrays: Mapping[str, AnyArray], parts: int) -> str | None:
    """The fault of a mesh with `parts` parts, as the object of a sentence; None if there is none."""
    nodes, corners, counts = arrays["coordinates"], arrays["corners"], arrays["corner_counts"]
    part_numbers = arrays["part_numbers"]
    if nodes.shape[1] != 3:
        return f"nodes of {nodes.shape[1]} coordinates, not three"
    wrong = np.flatnonzero(~(np.abs(nodes) <= LARGEST_COORDINATE).all(axis=1))
    if len(wrong):
        where = f"{shown(nodes[wrong[0]].tolist())} (node {wrong[0] + 1:,})"
        return f"a node whose coordinates are not finite and at most 1e30 in size, {where}"
    if counts.sum() != len(corners) or not ((counts >= 0) & (counts <= len(corners))).all():
        return "polygons without all of their corners"
    wrong = np.flatnonzero((corners < 0) | (corners >= len(nodes)))
    if len(wrong):
        return f"a polygon with the node {corners[wrong[0]] + 1:,}, which must be from 1 to {len(nodes):,}"
    normals, of_corners = arrays["normals"], arrays["corner_normals"]
    if normals.shape[1] != 3 or not ((of_corners >= -1) & (of_corners < len(normals))).all():
        return "normals of corners that are not there"
    if len(of_corners) not in (0, len(corners)):
        return "normals for some corners only"
    if len(part_numbers) != len(counts) or not ((part_numbers >= 0) & (part_numbers < parts)).all():
        return "polygons of parts that are not there"
    return None


def _normals(arrays: Mapping[str, AnyArray]) -> tuple[Floats, Indices] | None:
    """The normals and their rows by corner, None without any; a normal without direction is missing."""
    normals, rows = arrays["normals"], arrays["corner_normals"].astype(np.intp)
    is_sound = np.append(np.isfinite(normals).all(axis=1) & (normals != 0).any(axis=1), False)
    rows = np.where(is_sound[rows], rows, -1)
    return (normals.copy(), rows) if (rows >= 0).any() else None


# The other process. Its limits grow with the size of the file.

STARTING_SECONDS: Final = 30.0
"""Limit: of time to load a library on a busy machine, in addition to twice the time of computing."""

WORKER: Final = (sys.executable, "-P", "-m", "autocolor.files.meshes.foreign_worker")
"""The command; -P keeps modules in the current folder, which may be a stranger's, from being imported."""

FAILED: Final = 3
"""The exit code if the file cannot be read; the result is then a sentence without the file's name."""

OUT_OF_TIME: Final = -int(getattr(signal, "SIGXCPU", 24))
"""The exit code of a process that computed for too long and was ended by the system."""


def most_seconds(size: int) -> float:
    """Limit: seconds of computing for a file of `size` bytes.

    Measured: text takes 0.1 to 0.5 a megabyte, a glTF file of many small parts up to 3.
    """
    return min((6 + 2 * size / MEGABYTE) * max(1, validated_limit(None)), 1e9)


def most_memory(size: int) -> int:
    """Limit: bytes of address space. Libraries take half a gigabyte, at times 40 times the size of a text."""
    return (1 << 30) + int(min(60 * size * max(1, validated_limit(None)), allowed_memory()))


def largest_result(size: int) -> int:
    """Limit: bytes of the result for a file of `size` bytes."""
    return 128 * MEGABYTE + 30 * size


def read_in_own_process(
    library: str,
    module: str,
    kind: str,
    path: Path,
    size: int,
    command: Sequence[str] = WORKER,
    starting: float = STARTING_SECONDS,
) -> ForeignMesh:
    """The mesh of a file of `size` bytes that a library reads as a format, `kind`. Raises InputError.

    `foreign_` and `module` are the name of the module that calls the library.
    """
    with tempfile.TemporaryDirectory(prefix="autocolor-") as folder:
        result = Path(folder) / "mesh.npz"
        limit = str(validated_limit(None))
        arguments = [library, module, kind, os.fspath(path.absolute()), os.fspath(result), str(size), limit]
        seconds = most_seconds(size)
        printed = Path(folder) / "printed"
        code = _exit_code([*command, *arguments], starting + 2 * seconds, printed)
        if code in (None, OUT_OF_TIME):
            raise InputError(
                f"{path.name}: {library} must read it within {seconds:.0f} seconds, for its size, and did"
                " not; write it as OBJ or PLY, or allow more with --limit (limit= in Python)"
            )
        if code == FAILED and result.is_file():
            sentence = read_bytes(result, 8 * LONGEST_SENTENCE).decode("utf-8", "replace")
            raise InputError(f"{path.name}: {printable(sentence)}")
        if code != 0 or not result.is_file():
            raise InputError(
                f"{path.name}: {library} must read it, and {_end_of(code)}{_last_line(printed)}; {REMEDY}"
            )
        return read_foreign_mesh(result, path.name, library)


def _exit_code(command: Sequence[str], seconds: float, printed: Path) -> int | None:
    """The exit code of a command, which prints errors to a file; None if it took longer than `seconds`."""
    root = str(Path(autocolor.files.__path__[0]).parents[1])
    inherited = os.environ.get("PYTHONPATH")
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([root, inherited] if inherited else [root]),
        # Each thread reserves memory, which is limited.
        **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "VTK_SMP_MAX_THREADS"), "1"),
    }
    nowhere = subprocess.DEVNULL
    try:
        with open(printed, "wb") as errors:
            return subprocess.call(
                command, stdin=nowhere, stdout=nowhere, stderr=errors, env=environment, timeout=seconds
            )
    except subprocess.TimeoutExpired:
        return None
    except OSError as error:
        raise InputError(
            f"the process of a reader cannot be started ({shown(str(error))}); free memory"
        ) from None


LAST: Final = 4096
"""Bytes at the end of what a library printed that are searched for its last line."""


NOISE: Final = re.compile(r"^.*\b(ERR|WARN)\| |\x1b\[[0-9;]*m|\w+ \(0x[0-9a-f]+\): ")


def _last_line(printed: Path) -> str:
    """The last line that a library printed before its process ended, in parentheses; empty without one."""
    with open(printed, "rb") as file:
        file.seek(max(0, os.fstat(file.fileno()).st_size - LAST))
        lines = file.read(LAST).decode("utf-8", "replace").splitlines()
    # Colors, and before a bar the time and the place in the source, and addresses say nothing to a reader.
    plain = (NOISE.sub("", line).strip() for line in reversed(lines))
    line = next((each for each in plain if each), "")
    return f" ({printable(line[:LONGEST_SENTENCE])})" if line else ""


def _end_of(code: int) -> str:
    """How a process ended, in words."""
    if code < 0:
        try:
            return f"was ended by {signal.Signals(-code).name}"
        except ValueError:
            return f"was ended by signal {-code}"
    return "ended without a mesh" if code == 0 else f"ended with code {code}"


class Library(NamedTuple):
    """A library: its name, the package to import, and the extra that installs it."""

    name: str
    package: str
    extra: str


VTK: Final = Library("VTK", "vtkmodules", "vtk")
LIB3MF: Final = Library("lib3mf", "lib3mf", "meshes")
MESHIO: Final = Library("meshio", "meshio", "meshes")


@dataclass(frozen=True)
class ForeignFormat:
    """A format that a library reads: its name, its suffixes, the library, and what first bytes `begin` it.

    `module` and `kind` are what the worker calls the reader and the format. `growth` is how many times its
    size a file takes, as measured. `size_of` gives the number of bytes to read, and checks which files the
    file names. `up` is the file's up axis if the format says it.
    """

    name: str
    suffixes: tuple[str, ...]
    library: Library
    module: str
    kind: str
    growth: float
    begins: Callable[[bytes], bool] | None = None
    size_of: Callable[[Path], int] = size_of_file
    up: str = ""


def begins_as_vtk(head: bytes) -> bool:
    """Whether the first bytes are those of a legacy VTK file."""
    return head[:14].lower() == b"# vtk datafile"


def begins_as_vtk_xml(head: bytes) -> bool:
    """Whether the first bytes are those of a VTK XML file, also after a declaration or comments."""
    return head.lstrip().startswith(b"<") and b"<VTKFile" in head


def begins_as_glb(head: bytes) -> bool:
    """Whether the first bytes are those of a binary glTF file."""
    return head.startswith(b"glTF")


XML_SUFFIXES: Final = (".vtp", ".vtu", ".vts", ".vtr", ".vti")

FOREIGN: Final = (
    ForeignFormat("VTK", (".vtk",), VTK, "vtk", "legacy", 10, begins_as_vtk),
    ForeignFormat("VTK XML", XML_SUFFIXES, VTK, "vtk", "xml", 15, begins_as_vtk_xml),
    ForeignFormat("glTF", (".glb", ".gltf"), VTK, "gltf", "", 12, begins_as_glb, size_of_gltf, "y"),
    ForeignFormat("3MF", (".3mf",), LIB3MF, "3mf", "", 20, None, size_of_3mf, "z"),
    ForeignFormat("Abaqus", (".inp",), MESHIO, "meshio", "abaqus", 8, size_of=size_of_text("abaqus")),
    ForeignFormat("Gmsh", (".msh",), MESHIO, "meshio", "gmsh", 8),
    ForeignFormat(
        "Nastran", (".bdf", ".nas", ".fem"), MESHIO, "meshio", "nastran", 8, size_of=size_of_text("nastran")
    ),
    ForeignFormat("Medit", (".mesh", ".meshb"), MESHIO, "meshio", "medit", 8),
    ForeignFormat("UGRID", (".ugrid",), MESHIO, "meshio", "ugrid", 8),
)


def read_foreign(read_as: ForeignFormat, path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a file, which a library reads in its own process, and what was left out or repaired.

    Raises InputError, and UnavailableError if a package is missing.
    """
    size = read_as.size_of(path)
    library = read_as.library
    if importlib.util.find_spec(library.package) is None:
        raise UnavailableError(
            f"{path.name}: to read {read_as.name} files, the library {library.name} must be installed; run:"
            f' pip install "autocolor[{library.extra}]"'
        )
    require_size(path.name, size, read_as.growth)
    mesh = read_in_own_process(library.name, read_as.module, read_as.kind, path, size)
    if placement.up == "z" and read_as.up:
        placement = dataclasses.replace(placement, up=read_as.up)
    report = repaired(mesh.polygons, path.name, placement, skipped=mesh.sentences)
    names = [name for name in dict.fromkeys(mesh.material_of_part.values()) if name in mesh.colors]
    paint = COLORED_PAINT.object_color
    return dataclasses.replace(
        report,
        material_of_part=dict(mesh.material_of_part),
        materials=tuple(
            replaced(created_surface(name, paint), {"object_color": mesh.colors[name]}) for name in names
        ),
    )
