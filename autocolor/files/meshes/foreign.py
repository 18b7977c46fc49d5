"""The formats that trimesh and meshio read for us, of the extra `meshes`.

- glTF (.glb, .gltf) and 3MF: trimesh. glTF is y up by its specification: it is turned so unless it is read
  with x up, so that such a file stands as it does elsewhere. 3MF is z up. Neither is scaled: glTF is in
  meters, 3MF in its own unit.
- VTU, Abaqus (.inp), Gmsh (.msh), Nastran (.bdf, .nas, .fem), Medit (.mesh), SU2 and binary UGRID (as in
  .b8.ugrid): meshio, of which these formats need no further package.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import io
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, Final, NoReturn
from urllib.parse import unquote

import numpy as np

import autocolor.files
from autocolor.arrays import AnyArray
from autocolor.checks import LARGEST_COORDINATE, Color, listed, printable, shown
from autocolor.errors import InputError, UnavailableError
from autocolor.files.array_file import ArrayFileKind, array_file_bytes, read_array_file
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.files.meshes.found_scalars import FoundScalars
from autocolor.files.meshes.repair import (
    PLAIN,
    MeshReport,
    Placement,
    Polygons,
    different,
    printable_name,
    repaired,
)
from autocolor.files.paths import path_within
from autocolor.files.reading import LARGEST_MESH_FILE, read_bytes
from autocolor.files.reading import shown as shown_2
from autocolor.scene.columns import replaced
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from autocolor.scene.scalar import NODE, POLYGON
from autocolor.scene.surfaces import Surface

# -------------------- named_files
# The files that a glTF file names, and the size of what a 3MF file holds, known before either is read.
#
# A glTF file names buffers and images: in itself, in its folder, or by an address. No address is ever
# fetched: it is refused, as is a path out of the folder. A 3MF file is an archive, whose members say how
# large they are.

MOST_VALUES: Final = 2_000_000
"""Assumed: values in the JSON of a glTF file; numbers of meshes are in its buffers."""

MOST_MEMBERS: Final = 10_000
LARGEST_GROWTH: Final = 200
"""Assumed: how many times larger than the file what it holds may be. XML packs to a tenth."""

MAGIC: Final = b"glTF"
MOST_PROBLEMS: Final = 20


def size_of_gltf(path: Path) -> int:
    """The bytes of a glTF file and of the files that it names. Raises InputError."""
    data = read_bytes(path, LARGEST_MESH_FILE)
    described = _json(path.name, _json_text(path.name, data))
    problems: list[str] = []
    size = len(data)
    for what in ("buffers", "images"):
        listed = described.get(what, [])
        if not isinstance(listed, list):
            raise InputError(f"{path.name}: {what} must be a list; correct the file")
        for row, each in enumerate(listed):
            uri = each.get("uri") if isinstance(each, dict) else None
            if uri is None or (isinstance(uri, str) and uri[:5].lower() == "data:"):
                continue
            reasons: list[str] = []
            named = path_within(reasons, path.parent, unquote(uri) if isinstance(uri, str) else "")
            problems.extend(f"{path.name}: {what} {row}: it {reason}" for reason in reasons)
            if named is not None and what == "buffers":
                size += _size(path.name, row, named)
            if len(problems) >= MOST_PROBLEMS:
                raise InputError(problems)
    if problems:
        raise InputError(problems)
    if size > LARGEST_MESH_FILE:
        raise InputError(
            f"{path.name}: it and its buffers must have at most {LARGEST_MESH_FILE:,} bytes, not {size:,};"
            " split or simplify it"
        )
    return size


def _size(place: str, row: int, named: Path) -> int:
    """The size of the file of a buffer. Raises InputError if there is none."""
    if not named.is_file():
        raise InputError(
            f"{place}: buffers {row}: there is no file {named.name!r} in its folder; copy it there"
        )
    return os.stat(named).st_size


def _json_text(place: str, data: bytes) -> bytes:
    """The JSON of a glTF file, which is all of it or the first chunk of a binary one. Raises InputError."""
    if not data.startswith(MAGIC):
        return data
    if len(data) >= 20:
        version, length, size, kind = struct.unpack_from("<II I4s", data, 4)
        if version == 2 and length <= len(data) and size <= len(data) - 20 and kind == b"JSON":
            return data[20 : 20 + size]
    raise InputError(
        f"{place}: a binary glTF file must have version 2, its own length and a chunk of JSON first; the file"
        " is cut short or damaged"
    )


def _json(place: str, text: bytes) -> dict[str, Any]:
    """The described scene. Raises InputError if it is no JSON, or too much of it."""

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    try:
        if sum(map(text.count, (b",", b"[", b"{"))) > MOST_VALUES:
            raise ValueError(f"more than {MOST_VALUES:,} values")
        described = json.loads(text.decode("utf-8"), parse_constant=refuse)
        if not isinstance(described, dict):
            raise ValueError(f"a {type(described).__name__}")
    except json.JSONDecodeError as error:
        raise InputError(
            f"{place}: a glTF file must describe its scene in JSON, not as at line {error.lineno}, column"
            f" {error.colno}; write it again"
        ) from None
    except (ValueError, RecursionError) as error:
        found = " ".join(str(error).split())[:100]
        raise InputError(
            f"{place}: a glTF file must describe its scene in JSON, not {found}; write it again"
        ) from None
    return described


def size_of_3mf(path: Path) -> int:
    """The bytes of what a 3MF file holds. Raises InputError."""
    data = read_bytes(path, LARGEST_MESH_FILE)
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
    most = min(LARGEST_MESH_FILE, LARGEST_GROWTH * len(data))
    if len(members) > MOST_MEMBERS or size > most:
        raise InputError(
            f"{path.name}: a 3MF file of its size must hold at most {MOST_MEMBERS:,} files and {most:,}"
            f" bytes, not"
            f" {len(members):,} and {size:,}; simplify it"
        )
    return max(size, len(data))


def size_of_file(path: Path) -> int:
    """The bytes of a file that names no others. Raises InputError for one that is too large or no file."""
    return len(read_bytes(path, LARGEST_MESH_FILE))


# -------------------- foreign_mesh
# What comes back from the process of a library: polygons, materials, and sentences about what is left out.
#
# It comes as an array file, which is checked like any other: nothing is believed, and nothing unpickled.

FAILED: Final = b"!"
"""What a result begins with that is no mesh, but a sentence in UTF-8."""

LONGEST_SENTENCE: Final = 300
MOST_SENTENCES: Final = 100


@dataclass(frozen=True, eq=False)
class ForeignMesh:
    """A mesh as a library gives it.

    `material_of_part` has the names of materials by part, `colors` the color of those that have one, and
    `sentences` tell what was left out.
    """

    polygons: Polygons
    sentences: tuple[str, ...] = ()
    material_of_part: Mapping[str, str] = field(default_factory=dict)
    colors: Mapping[str, Color] = field(default_factory=dict)


KEYS: Final = ("part_names", "node_scalars", "polygon_scalars", "sentences", "materials", "colors")

ARRAYS: Final = {
    "coordinates": ("<f8", 2),
    "corners": ("<i8", 1),
    "corner_counts": ("<i8", 1),
    "part_numbers": ("<i8", 1),
    # One after the other: an array of no scalars would have as many columns as there are nodes.
    "node_values": ("<f8", 1),
    "polygon_values": ("<f8", 1),
}


def kind_of_file(largest: int) -> ArrayFileKind:
    """The kind of array file that a result is, of at most so many bytes."""
    return ArrayFileKind(
        noun="result of a reader",
        advice="write the mesh as OBJ or PLY",
        largest=largest,
        formats=("autocolor foreign mesh 1",),
        keys=frozenset(KEYS),
        arrays=ARRAYS,
    )


def foreign_mesh_bytes(mesh: ForeignMesh) -> bytes:
    """The content of the file that a mesh comes back in."""
    polygons = mesh.polygons
    of = {each: [scalar for scalar in polygons.scalars if scalar.of == each] for each in (NODE, POLYGON)}
    header = {
        "part_names": polygons.part_names,
        "node_scalars": [scalar.name for scalar in of[NODE]],
        "polygon_scalars": [scalar.name for scalar in of[POLYGON]],
        "sentences": mesh.sentences,
        "materials": dict(mesh.material_of_part),
        "colors": dict(mesh.colors),
    }
    values = {each: [scalar.values for scalar in scalars] for each, scalars in of.items()}
    arrays = {
        "coordinates": polygons.coordinates,
        "corners": polygons.corners,
        "corner_counts": polygons.corner_counts,
        "part_numbers": polygons.part_numbers,
        "node_values": np.concatenate([np.empty(0), *values[NODE]]),
        "polygon_values": np.concatenate([np.empty(0), *values[POLYGON]]),
    }
    return array_file_bytes(kind_of_file(0), header, arrays)


def read_foreign_mesh(path: Path, largest: int, place: str, library: str) -> ForeignMesh:
    """The mesh that a library gave for the file `place`, checked. Raises InputError."""

    def wrong(rule: str) -> InputError:
        return InputError(f"{place}: {library} gave {rule}; correct the file, or write it as OBJ or PLY")

    try:
        header, arrays = read_array_file(kind_of_file(largest), path)
    except InputError as error:
        raise wrong(f"no mesh ({str(error)[:LONGEST_SENTENCE]})") from None
    if problem := _problem(header, arrays):
        raise wrong(problem)
    scalars = FoundScalars()
    counts = {NODE: len(arrays["coordinates"]), POLYGON: len(arrays["corner_counts"])}
    for of, count in counts.items():
        for row, name in enumerate(header[f"{of}_scalars"]):
            scalars.add(name, arrays[f"{of}_values"][row * count : (row + 1) * count], of)
    polygons = Polygons(
        arrays["coordinates"].copy(),
        arrays["corners"].astype(np.intp),
        arrays["corner_counts"].astype(np.intp),
        arrays["part_numbers"].astype(np.intp),
        part_names_of(header["part_names"]),
        scalars.scalars,
    )
    renamed = dict(zip(header["part_names"], polygons.part_names, strict=True))
    sentences = (printable(each[:LONGEST_SENTENCE]) for each in header["sentences"][:MOST_SENTENCES])
    return ForeignMesh(
        polygons,
        (*sentences, *scalars.messages),
        {renamed[part]: _material(name) for part, name in header["materials"].items() if part in renamed},
        {_material(name): (color[0], color[1], color[2]) for name, color in header["colors"].items()},
    )


def _problem(header: Mapping[str, Any], arrays: Mapping[str, AnyArray]) -> str | None:
    """What is wrong with the tables, as the object of a sentence; None if nothing is."""
    nodes, corners, sizes = arrays["coordinates"], arrays["corners"], arrays["corner_counts"]
    parts = arrays["part_numbers"]
    lists = ("part_names", "node_scalars", "polygon_scalars", "sentences")
    if not all(
        isinstance(header[key], list) and all(isinstance(each, str) for each in header[key]) for key in lists
    ):
        return "names that are no texts"
    materials, colors = header["materials"], header["colors"]
    if not isinstance(materials, dict) or not all(isinstance(each, str) for each in materials.values()):
        return "materials that have no names"
    if not isinstance(colors, dict) or not all(map(_is_color, colors.values())):
        return "materials whose colors are no colors"
    if nodes.shape[1] != 3:
        return f"nodes of {nodes.shape[1]} coordinates, not three"
    wrong = np.flatnonzero(~(np.abs(nodes) <= LARGEST_COORDINATE).all(axis=1))
    if len(wrong):
        where = f"{shown(nodes[wrong[0]].tolist())} (node {wrong[0] + 1:,})"
        return f"a node whose coordinates are not finite and at most 1e30 in size, {where}"
    if sizes.sum() != len(corners) or not ((sizes >= 0) & (sizes <= len(corners))).all():
        return "polygons without all of their corners"
    wrong = np.flatnonzero((corners < 0) | (corners >= len(nodes)))
    if len(wrong):
        return f"a polygon with the node {corners[wrong[0]] + 1:,}, which must be from 1 to {len(nodes):,}"
    if len(parts) != len(sizes) or (
        len(parts) and not (parts.min() >= 0 and parts.max() < len(header["part_names"]))
    ):
        return "polygons of parts that are not there"
    for of, count in ((NODE, len(nodes)), (POLYGON, len(sizes))):
        if len(arrays[f"{of}_values"]) != count * len(header[f"{of}_scalars"]):
            return f"scalars without a value for each {of}"
    return None


def _is_color(value: object) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 3
        and all(type(each) is int and 0 <= each <= 255 for each in value)
    )


def part_names_of(names: Sequence[str]) -> tuple[str, ...]:
    """Names of parts that are printable and different; one without a name is "part"."""
    return different([printable_name(name) or "part" for name in names])


def _material(name: str) -> str:
    return printable_name(name) or "material"


# -------------------- own_process
# Running a library in a process of its own, which may hang, end or eat memory without harm to this one.
#
# Its limits are in proportion to the bytes that it has to read. They are set by the process itself, before
# it reads anything (see `worker`); a clock here is for what goes wrong before.

MEGABYTE: Final = 1 << 20

LEAST_SECONDS: Final = 2.0
SECONDS_A_MEGABYTE: Final = 1.0
"""Assumed: of computing, once the library is loaded. Measured: text takes 0.1 to 0.5 seconds a megabyte."""

LEAST_MEMORY: Final = 1 << 30
MEMORY_A_BYTE: Final = 60
"""Assumed: of addresses. The libraries alone take half of the least; text takes up to 40 times its size."""

LEAST_RESULT: Final = 16 << 20
RESULT_A_BYTE: Final = 30

STARTING_SECONDS: Final = 30.0
"""Assumed: to load a library on a busy machine, in addition to twice the time of computing."""

WORKER: Final = (sys.executable, "-P", "-m", "autocolor.files.meshes.foreign_worker")
"""The command; -P keeps modules in the current folder, which may be a stranger's, from being imported."""


@dataclass(frozen=True)
class Limits:
    """Of a process: seconds of computing, bytes of memory, bytes of its result."""

    seconds: float
    memory: int
    result: int


def limits_for(size: int) -> Limits:
    """The limits for reading so many bytes."""
    return Limits(
        LEAST_SECONDS + SECONDS_A_MEGABYTE * size / MEGABYTE,
        LEAST_MEMORY + MEMORY_A_BYTE * size,
        LEAST_RESULT + RESULT_A_BYTE * size,
    )


def read_in_own_process(
    library: str,
    kind: str,
    path: Path,
    limits: Limits,
    command: Sequence[str] = WORKER,
    starting: float = STARTING_SECONDS,
) -> ForeignMesh:
    """The mesh of a file that a library reads as a format, `kind`. Raises InputError."""
    with tempfile.TemporaryDirectory(prefix="autocolor-") as folder:
        result = Path(folder) / "mesh.npz"
        arguments = [library, kind, os.fspath(path.absolute()), os.fspath(result)]
        arguments += [str(limits.seconds), str(limits.memory), str(limits.result)]
        code = _run([*command, *arguments], starting + 2 * limits.seconds)
        if code in _OUT_OF_TIME:
            raise InputError(
                f"{path.name}: {library} must read it within {limits.seconds:.0f} seconds, for its size, and"
                " did not; write it as OBJ or PLY"
            )
        if code != 0 or not result.is_file():
            raise InputError(
                f"{path.name}: {library} must read it, and {_end_of(code)}; correct the file, or write it as"
                " OBJ or PLY"
            )
        with open(result, "rb") as file:
            head = file.read(4 * LONGEST_SENTENCE)
        if head.startswith(FAILED):
            sentence = head[len(FAILED) :].decode("utf-8", "replace")[:LONGEST_SENTENCE]
            found = printable(sentence)
            raise InputError(
                f"{path.name}: {library} must be able to read it, and cannot ({found}); correct the file, or"
                " write it as OBJ or PLY"
            )
        return read_foreign_mesh(result, limits.result, path.name, library)


_KILLED_BY_CLOCK: Final = 1 << 16
"""The code of a process that was ended here; no system gives it."""

_OUT_OF_TIME: Final = (
    _KILLED_BY_CLOCK,
    *(-getattr(signal, name) for name in ("SIGXCPU", "SIGALRM") if hasattr(signal, name)),
)


def _run(command: Sequence[str], seconds: float) -> int:
    """The exit code of a process, which is ended after so many seconds; what it prints goes nowhere."""
    root = str(Path(autocolor.files.__path__[0]).parents[1])
    inherited = os.environ.get("PYTHONPATH")
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([root, inherited] if inherited else [root]),
        # Threads reserve memory each, of which there is a limit.
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
    }
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=environment,
            close_fds=True,
        )
    except OSError as error:
        raise InputError(
            f"the process of a reader cannot be started ({shown_2(str(error))}); free memory"
        ) from None
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        return _KILLED_BY_CLOCK
    finally:
        # Also if the user interrupts.
        if process.poll() is None:
            process.kill()
            process.wait()


def _end_of(code: int) -> str:
    """How a process ended, in words."""
    if code < 0:
        try:
            return f"was ended by {signal.Signals(-code).name}"
        except ValueError:
            return f"was ended by signal {-code}"
    return "ended without a mesh" if code == 0 else f"ended with code {code}"


@dataclasses.dataclass(frozen=True)
class ForeignFormat:
    """A format: its name, suffixes, the library and its word for it, and the packages that it needs.

    `size_of` is the number of bytes to read, after what the file names was checked; `up` the file's up axis.
    """

    name: str
    suffixes: tuple[str, ...]
    library: str
    kind: str
    packages: tuple[str, ...]
    size_of: Callable[[Path], int] = size_of_file
    up: str = "z"


FOREIGN: Final = (
    ForeignFormat("glTF", (".glb",), "trimesh", "glb", ("trimesh", "networkx"), size_of_gltf, "y"),
    ForeignFormat("glTF text", (".gltf",), "trimesh", "gltf", ("trimesh", "networkx"), size_of_gltf, "y"),
    ForeignFormat("3MF", (".3mf",), "trimesh", "3mf", ("trimesh", "networkx", "lxml"), size_of_3mf),
    ForeignFormat("VTU", (".vtu",), "meshio", "vtu", ("meshio",)),
    ForeignFormat("Abaqus", (".inp",), "meshio", "abaqus", ("meshio",)),
    ForeignFormat("Gmsh", (".msh",), "meshio", "gmsh", ("meshio",)),
    ForeignFormat("Nastran", (".bdf", ".nas", ".fem"), "meshio", "nastran", ("meshio",)),
    ForeignFormat("Medit", (".mesh",), "meshio", "medit", ("meshio",)),
    ForeignFormat("SU2", (".su2",), "meshio", "su2", ("meshio",)),
    ForeignFormat("UGRID", (".ugrid",), "meshio", "ugrid", ("meshio",)),
)


def read_foreign(
    read_as: ForeignFormat, path: Path, placement: Placement = PLAIN, *, command: Sequence[str] = WORKER
) -> MeshReport:
    """The mesh of a file, which a library reads in its own process, and what was left out or repaired.

    Raises InputError, and UnavailableError if a package is missing.
    """
    missing = [name for name in read_as.packages if importlib.util.find_spec(name) is None]
    size = read_as.size_of(path)
    if missing:
        raise UnavailableError(
            f"{path.name}: to read {read_as.suffixes[0]} files, the package {listed(missing)} must be"
            ' installed; run: pip install "autocolor[meshes]"'
        )
    found = read_in_own_process(read_as.library, read_as.kind, path, limits_for(size), command)
    if placement.up == "z":
        placement = dataclasses.replace(placement, up=read_as.up)
    report = repaired(found.polygons, path.name, placement, skipped=found.sentences)
    materials = dict.fromkeys(found.material_of_part.values())
    return dataclasses.replace(
        report,
        material_of_part=dict(found.material_of_part),
        materials=tuple(_surface(name, found.colors[name]) for name in materials if name in found.colors),
    )


def _surface(name: str, color: Color) -> Surface:
    """The surface of a material, of which the base color is known."""
    return replaced(created_surface(name, COLORED_PAINT.object_color), {"object_color": color})


for _each in FOREIGN:
    register(MeshFormat(_each.name, partial(read_foreign, _each), _each.suffixes))
