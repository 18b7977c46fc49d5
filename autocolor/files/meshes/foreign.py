"""Mesh files that trimesh and meshio read for us, each in a process of its own: the extra `meshes`.

- glTF (.glb, .gltf) and 3MF: trimesh. glTF is y up by its specification: the reader turns it so unless it
  is read with x up. 3MF is z up. Neither is scaled: glTF is in meters, 3MF in its own unit.
- VTU, Abaqus (.inp), Gmsh (.msh), Nastran (.bdf, .nas, .fem), Medit (.mesh), SU2 and binary UGRID (as in
  .b8.ugrid): meshio, of which these formats need no further package.

A library may hang, crash, print or eat memory without harm to this process. The other process
(`foreign_worker`) writes the mesh as an array file, which is checked like any other file.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import io
import os
import signal
import struct
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote

import numpy as np

import autocolor.files
from autocolor.arrays import AnyArray
from autocolor.budget import allowed_memory, validated_limit
from autocolor.checks import LARGEST_COORDINATE, Color, listed, printable, shown
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
from autocolor.files.meshes.number_text import MOST_PROBLEMS
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.paths import path_within
from autocolor.files.reading import bounded_json, opened, read_bytes, read_whole, require_size
from autocolor.scene.columns import replaced
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from autocolor.scene.scalar import NODE

MEGABYTE: Final = 1 << 20

REMEDY: Final = "correct the file, or write it as OBJ or PLY"

# The size of a file and of the files that it names, checked before a library reads them.

MOST_VALUES: Final = 2_000_000
"""Limit: values in the JSON of a glTF file; numbers of meshes are in its buffers."""

MOST_MEMBERS: Final = 10_000
LARGEST_GROWTH: Final = 200
"""Limit: how many times larger than a 3MF file its unpacked content may be. XML packs to a tenth."""


def size_of_file(path: Path) -> int:
    """The bytes of a file that names no others. Raises InputError if it is not regular."""
    with opened(path) as (_, status):
        return status.st_size


def size_of_gltf(path: Path) -> int:
    """The bytes of a glTF file and of the buffers in its folder. Raises InputError.

    A file that is named by an address or out of the folder is refused: no address is ever fetched.
    """
    data = read_whole(path, 1)
    described = _gltf_json(path.name, data)
    problems: list[str] = []
    size = len(data)
    for key in ("buffers", "images"):
        rows = described.get(key, [])
        if not isinstance(rows, list):
            raise InputError(f"{path.name}: {key} must be a list; correct the file")
        for number, row in enumerate(rows):
            uri = row.get("uri") if isinstance(row, dict) else None
            if uri is None or (isinstance(uri, str) and uri[:5].lower() == "data:"):
                continue
            reasons: list[str] = []
            named = path_within(reasons, path.parent, unquote(uri) if isinstance(uri, str) else "")
            problems.extend(f"{path.name}: {key} {number}: it {reason}" for reason in reasons)
            if len(problems) >= MOST_PROBLEMS:
                raise InputError(problems)
            if named is None or key == "images":
                continue
            if not named.is_file():
                raise InputError(
                    f"{path.name}: buffers {number}: there is no file {named.name!r} in its folder; copy it"
                    " there"
                )
            size += os.stat(named).st_size
    if problems:
        raise InputError(problems)
    _refuse_deep_nodes(path.name, described.get("nodes"))
    return size


MOST_LEVELS: Final = 100
"""Limit: nodes of a glTF file above a node. The library places each node from the root, which takes time."""


def _refuse_deep_nodes(place: str, nodes: object) -> None:
    """Raise InputError if nodes of a glTF file are nested too deeply; the library finds other faults."""
    rows = nodes if isinstance(nodes, list) else []
    children: list[list[int]] = []
    for row in rows:
        numbers = row.get("children") if isinstance(row, dict) else None
        numbers = numbers if isinstance(numbers, list) else []
        children.append([each for each in numbers if type(each) is int and 0 <= each < len(rows)])
    # Go down from the roots, level by level, to each node once. Nodes in a circle have no root.
    level = set(range(len(rows))).difference(*children)
    reached = set(level)
    for _ in range(MOST_LEVELS + 1):
        level = {each for number in level for each in children[number]} - reached
        reached |= level
    if level:
        raise InputError(
            f"{place}: nodes {min(level)}: a node must have at most {MOST_LEVELS} nodes above it, not more;"
            " export the scene flat"
        )


def _gltf_json(place: str, data: bytes) -> dict[str, Any]:
    """The scene that a glTF file describes. Raises InputError if it is no JSON, or too much of it."""
    if data.startswith(b"glTF"):
        # A binary file begins with its version, its length, and a chunk of JSON with its size.
        version, length, size, kind = struct.unpack_from("<III4s", data.ljust(20, b"\0"), 4)
        if version != 2 or length > len(data) or size > len(data) - 20 or kind != b"JSON":
            raise InputError(
                f"{place}: a binary glTF file must have version 2, its own length and a chunk of JSON first;"
                " the file is cut short or damaged"
            )
        data = data[20 : 20 + size]

    try:
        described = bounded_json(data, MOST_VALUES)
        if not isinstance(described, dict):
            raise ValueError(f"a {type(described).__name__}")
    except ValueError as error:
        reason = " ".join(str(error).split())[:100]
        raise InputError(
            f"{place}: a glTF file must describe its scene in JSON, not {reason}; write it again"
        ) from None
    return described


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


RESULT: Final = ArrayFileKind(
    noun="result of a reader",
    advice="write the mesh as OBJ or PLY",
    formats=("autocolor foreign mesh 2",),
    keys=frozenset(("part_names", "sentences", "material_of_part", "colors")),
    arrays={
        "coordinates": ("<f8", 2),
        "corners": ("<i8", 1),
        "corner_counts": ("<i8", 1),
        "part_numbers": ("<i8", 1),
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
    arrays = {name: vars(polygons)[name] for name in RESULT.arrays}
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
    polygons = RawPolygons(
        arrays["coordinates"].copy(),
        arrays["corners"].astype(np.intp),
        arrays["corner_counts"].astype(np.intp),
        arrays["part_numbers"].astype(np.intp),
        tuple(header["part_names"]),
        scalars,
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
    if len(part_numbers) != len(counts) or not ((part_numbers >= 0) & (part_numbers < parts)).all():
        return "polygons of parts that are not there"
    return None


# The other process. Its limits grow with the size of the file.

STARTING_SECONDS: Final = 30.0
"""Limit: of time to load a library on a busy machine, in addition to twice the time of computing."""

WORKER: Final = (sys.executable, "-P", "-m", "autocolor.files.meshes.foreign_worker")
"""The command; -P keeps modules in the current folder, which may be a stranger's, from being imported."""

FAILED: Final = 3
"""The exit code if the library cannot read the file; the result is then a sentence in UTF-8."""

OUT_OF_TIME: Final = -int(getattr(signal, "SIGXCPU", 24))
"""The exit code of a process that computed for too long and was ended by the system."""


def most_seconds(size: int) -> float:
    """Limit: seconds of computing for a file of `size` bytes. Measured: text takes 0.1 to 0.5 a megabyte."""
    return min((2 + size / MEGABYTE) * max(1, validated_limit(None)), 1e9)


def most_memory(size: int) -> int:
    """Limit: bytes of address space. Libraries take half a gigabyte, at times 40 times the size of a text."""
    return (1 << 30) + int(min(60 * size * max(1, validated_limit(None)), allowed_memory()))


def largest_result(size: int) -> int:
    """Limit: bytes of the result for a file of `size` bytes."""
    return 16 * MEGABYTE + 30 * size


def read_in_own_process(
    library: str,
    kind: str,
    path: Path,
    size: int,
    command: Sequence[str] = WORKER,
    starting: float = STARTING_SECONDS,
) -> ForeignMesh:
    """The mesh of a file of `size` bytes that a library reads as a format, `kind`. Raises InputError."""
    with tempfile.TemporaryDirectory(prefix="autocolor-") as folder:
        result = Path(folder) / "mesh.npz"
        limit = str(validated_limit(None))
        arguments = [library, kind, os.fspath(path.absolute()), os.fspath(result), str(size), limit]
        seconds = most_seconds(size)
        code = _exit_code([*command, *arguments], starting + 2 * seconds)
        if code in (None, OUT_OF_TIME):
            raise InputError(
                f"{path.name}: {library} must read it within {seconds:.0f} seconds, for its size, and did"
                " not; write it as OBJ or PLY, or allow more with --limit (limit= in Python)"
            )
        if code == FAILED and result.is_file():
            sentence = read_bytes(result, 4 * LONGEST_SENTENCE).decode("utf-8", "replace")
            raise InputError(
                f"{path.name}: {library} must be able to read it, and cannot"
                f" ({printable(sentence[:LONGEST_SENTENCE])}); {REMEDY}"
            )
        if code != 0 or not result.is_file():
            raise InputError(f"{path.name}: {library} must read it, and {_end_of(code)}; {REMEDY}")
        return read_foreign_mesh(result, path.name, library)


def _exit_code(command: Sequence[str], seconds: float) -> int | None:
    """The exit code of a command, whose output is dropped; None if it took longer than `seconds`."""
    root = str(Path(autocolor.files.__path__[0]).parents[1])
    inherited = os.environ.get("PYTHONPATH")
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([root, inherited] if inherited else [root]),
        # Each thread reserves memory, which is limited.
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
    }
    nowhere = subprocess.DEVNULL
    try:
        return subprocess.run(
            command,
            stdin=nowhere,
            stdout=nowhere,
            stderr=nowhere,
            env=environment,
            timeout=seconds,
            check=False,
        ).returncode
    except subprocess.TimeoutExpired:
        return None
    except OSError as error:
        raise InputError(
            f"the process of a reader cannot be started ({shown(str(error))}); free memory"
        ) from None


def _end_of(code: int) -> str:
    """How a process ended, in words."""
    if code < 0:
        try:
            return f"was ended by {signal.Signals(-code).name}"
        except ValueError:
            return f"was ended by signal {-code}"
    return "ended without a mesh" if code == 0 else f"ended with code {code}"


@dataclass(frozen=True)
class ForeignFormat:
    """A format that a library reads: its name, its suffixes, the library and its word for the format.

    `packages` must be installed. `size_of` gives the number of bytes to read, and checks which files the file
    names; `up` is the file's up axis. `growth` is how many times its size a file takes, as measured.
    """

    name: str
    suffixes: tuple[str, ...]
    library: str
    kind: str
    packages: tuple[str, ...]
    growth: float
    size_of: Callable[[Path], int] = size_of_file
    up: str = "z"


FOREIGN: Final = (
    ForeignFormat("glTF", (".glb",), "trimesh", "glb", ("trimesh", "networkx"), 12, size_of_gltf, "y"),
    ForeignFormat("glTF text", (".gltf",), "trimesh", "gltf", ("trimesh", "networkx"), 12, size_of_gltf, "y"),
    ForeignFormat("3MF", (".3mf",), "trimesh", "3mf", ("trimesh", "networkx", "lxml"), 20, size_of_3mf),
    ForeignFormat("VTU", (".vtu",), "meshio", "vtu", ("meshio",), 15),
    ForeignFormat("Abaqus", (".inp",), "meshio", "abaqus", ("meshio",), 8),
    ForeignFormat("Gmsh", (".msh",), "meshio", "gmsh", ("meshio",), 8),
    ForeignFormat("Nastran", (".bdf", ".nas", ".fem"), "meshio", "nastran", ("meshio",), 8),
    ForeignFormat("Medit", (".mesh",), "meshio", "medit", ("meshio",), 8),
    ForeignFormat("SU2", (".su2",), "meshio", "su2", ("meshio",), 8),
    ForeignFormat("UGRID", (".ugrid",), "meshio", "ugrid", ("meshio",), 8),
)


def read_foreign(read_as: ForeignFormat, path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a file, which a library reads in its own process, and what was left out or repaired.

    Raises InputError, and UnavailableError if a package is missing.
    """
    size = read_as.size_of(path)
    missing = [name for name in read_as.packages if importlib.util.find_spec(name) is None]
    if missing:
        raise UnavailableError(
            f"{path.name}: to read {read_as.suffixes[0]} files, the package {listed(missing)} must be"
            f" installed; run: pip install {' '.join(missing)}"
        )
    require_size(path.name, size, read_as.growth)
    mesh = read_in_own_process(read_as.library, read_as.kind, path, size)
    if placement.up == "z":
        placement = dataclasses.replace(placement, up=read_as.up)
    report = repaired(mesh.polygons, path.name, placement, skipped=mesh.sentences)
    materials = [name for name in dict.fromkeys(mesh.material_of_part.values()) if name in mesh.colors]
    return dataclasses.replace(
        report,
        material_of_part=dict(mesh.material_of_part),
        materials=tuple(
            replaced(created_surface(name, COLORED_PAINT.object_color), {"object_color": mesh.colors[name]})
            for name in materials
        ),
    )
