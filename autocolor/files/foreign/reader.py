"""Mesh files that libraries read for us, each in a process of its own.

- VTK (.vtk, and .vtp, .vtu, .vts, .vtr, .vti) and glTF (.glb, .gltf): VTK, the extra `vtk`. glTF is y up by
  its specification: the reader turns it so unless it is read with x up.
- 3MF: lib3mf; Abaqus (.inp), Gmsh (.msh), Nastran (.bdf, .nas, .fem), Medit (.mesh) and binary UGRID
  (as in .b8.ugrid): meshio, of which these formats need no further package. They are the extra `meshes`.

A library may hang, crash, print or eat memory without harm to this process. The other process
(`worker`) writes the mesh as a file of arrays, which is checked.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import autocolor.files
from autocolor.budget import allowed_memory, validated_limit
from autocolor.checks import printable
from autocolor.errors import InputError, UnavailableError
from autocolor.files.foreign.gltf_document import size_of_gltf
from autocolor.files.foreign.mesh import REMEDY, loaded
from autocolor.files.foreign.solver_text import size_of_text
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement
from autocolor.files.reading import opened, require_size

WORKER: Final = (sys.executable, "-P", "-m", "autocolor.files.foreign.worker")
"""The command; -P keeps modules in the current folder, which may be a stranger's, from being imported."""

FAILED: Final = 3
"""The exit code if the file cannot be read; the result is then a sentence."""


def most_seconds(size: int) -> float:
    """Limit: seconds for a file of `size` bytes, of which half a minute is to load a library.

    Measured: text takes 0.1 to 0.5 a megabyte, a glTF file of many small parts up to 3.
    """
    return min((30 + 4 * size / (1 << 20)) * max(1, validated_limit(None)), 1e9)


def most_memory(size: int) -> int:
    """Limit: bytes of address space. Libraries take half a gigabyte, at times 40 times the size of a text."""
    return (1 << 30) + int(min(60 * size * max(1, validated_limit(None)), allowed_memory()))


@dataclass(frozen=True)
class ForeignFormat:
    """A format that a library reads: its name, its suffixes, and the name of the library.

    `module` is what the worker calls the reader. `growth` is how many times its size a file takes, as
    measured. `begins` is whether first bytes may be those of a file, as in `Format`. `size_of` gives the
    number of bytes to read, and checks which files the file names. `up` is the file's up axis if the format
    says it.
    """

    name: str
    suffixes: tuple[str, ...]
    library: str
    module: str
    growth: float
    begins: Callable[[bytes], object] | None = None
    size_of: Callable[[Path], int] | None = None
    up: str = ""


XML_SUFFIXES: Final = (".vtp", ".vtu", ".vts", ".vtr", ".vti")

FOREIGN: Final = (
    ForeignFormat("VTK", (".vtk",), "VTK", "vtk", 10, re.compile(rb"(?i)# vtk datafile").match),
    ForeignFormat("VTK XML", XML_SUFFIXES, "VTK", "vtk", 15, re.compile(rb"(?s)\s*<(.*<)?VTKFile").match),
    ForeignFormat(
        "glTF", (".glb", ".gltf"), "VTK", "gltf", 12, re.compile(b"glTF").match, size_of_gltf, up="y"
    ),
    # It is packed.
    ForeignFormat("3MF", (".3mf",), "lib3mf", "three_mf", 100, up="z"),
    ForeignFormat("Abaqus", (".inp",), "meshio", "solvers", 8, size_of=size_of_text),
    ForeignFormat("Gmsh", (".msh",), "meshio", "solvers", 8),
    ForeignFormat("Nastran", (".bdf", ".nas", ".fem"), "meshio", "solvers", 8, size_of=size_of_text),
    ForeignFormat("Medit", (".mesh", ".meshb"), "meshio", "solvers", 8),
    ForeignFormat("UGRID", (".ugrid",), "meshio", "solvers", 8),
)


def read_foreign(read_as: ForeignFormat, path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a file, which a library reads in its own process, and what was left out or repaired.

    Raises InputError, and UnavailableError if a package is missing.
    """
    with opened(path) as (_, status):
        size = read_as.size_of(path) if read_as.size_of else status.st_size
    library, nowhere = read_as.library, subprocess.DEVNULL
    package, extra = ("vtkmodules", "vtk") if library == "VTK" else (library, "meshes")
    if importlib.util.find_spec(package) is None:
        raise UnavailableError(
            f"{path.name}: to read {read_as.name} files, the library {library} must be installed;"
            f' run: pip install "autocolor[{extra}]"'
        )
    require_size(path.name, size, read_as.growth)
    if placement.up == "z" and read_as.up:
        placement = dataclasses.replace(placement, up=read_as.up)
    seconds, code = most_seconds(size), None
    paths = [str(Path(autocolor.files.__path__[0]).parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])]
    # Each thread reserves memory, which is limited.
    one = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "VTK_SMP_MAX_THREADS"), "1")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **one}
    with tempfile.TemporaryDirectory(prefix="autocolor-") as folder:
        result, file = Path(folder) / path.name, os.fspath(path.absolute())
        numbers = (str(size), str(validated_limit(None)), json.dumps(dataclasses.astuple(placement)))
        try:
            code = subprocess.call(
                (*WORKER, library, read_as.module, read_as.name.lower(), file, os.fspath(result), *numbers),
                stdin=nowhere, stdout=nowhere, stderr=nowhere, env=environment, timeout=seconds,
            )  # fmt: skip
            if code == 0:
                return loaded(result)
            reason = f"it crashed (code {code})"
        except subprocess.TimeoutExpired:
            raise InputError(
                f"{path.name}: {library} must read it within {seconds:.0f} seconds, and did not; write it as"
                " OBJ or PLY, or allow more with --limit"
            ) from None
        except (ValueError, LookupError, TypeError) as error:
            reason = str(error)[:300]
        sentence = f"{library} must give a whole mesh, and does not ({reason}); {REMEDY}"
        if code == FAILED and result.is_file():
            sentence = printable(result.read_text("utf-8", "replace")[:2000])
    raise InputError(sentence if sentence.startswith(path.name) else f"{path.name}: {sentence}")
