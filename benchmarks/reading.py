"""How long it takes to read a million polygons, beside trimesh and meshio: `python -m benchmarks reading`.

Hills of a million triangles and of a million quads are written to a temporary folder as binary PLY (float
coordinates), binary STL and text OBJ, and read in turns by every reader as it reads by default. trimesh makes
two triangles of a quad, and STL has triangles alone. What each found is told beside its time. Memory is the
peak over that of the imports, in a process of its own: `python -m benchmarks.reading READER FILE`.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from autocolor import Mesh
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.obj import obj_text
from benchmarks.cases import Case, spread, timed
from benchmarks.hills import hills, side_of
from benchmarks.memory import forget_peak, peak
from benchmarks.targets import Target, between, row, target_lines

ROOT = Path(__file__).parents[1]
ROUNDS = 5
POLYGONS, QUICK_POLYGONS = 1_000_000, 100_000
OURS, PEERS = "autocolor", ("trimesh", "meshio")
TRIANGLES, QUADS = "triangles", "quads"
FILES = {
    f"{TRIANGLES}.ply": 3,
    f"{TRIANGLES}.stl": 3,
    f"{TRIANGLES}.obj": 3,
    f"{QUADS}.ply": 4,
    f"{QUADS}.obj": 4,
}
"""The files, and the sides of their polygons."""

MEGABYTE = 1e6


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """Milliseconds and MB of every reader and file, what each found, and whether ours is ahead."""
    present = {name: reason for name in PEERS if (reason := absence(name))}
    readers = [name for name in (OURS, *PEERS) if name not in present]
    with TemporaryDirectory() as folder:
        paths = written(Path(folder), QUICK_POLYGONS if quick else POLYGONS)
        cases = [
            Case(case_of(reader, name), partial(read, reader, path))
            for name, path in paths.items()
            for reader in readers
        ]
        seconds = timed(cases, rounds)
        found = {case.name: counts(case.run()) for case in cases}
        megabytes = {
            case_of(reader, name): memory(reader, path) for name, path in paths.items() for reader in readers
        }
    verdicts = {name: ("skipped", reason) for name, reason in present.items()}
    targets = [
        Target(name, f"of {peer}'s time", 1, between(case_of(OURS, name), case_of(peer, name)), needs=peer)
        for name in FILES
        for peer in PEERS
    ]
    return {
        "rounds": rounds,
        "cases ms": {name: spread(each).times(1e3)._asdict() for name, each in seconds.items()},
        "best ms": {name: 1e3 * min(each) for name, each in seconds.items()},
        "found": found,
        "memory MB": megabytes,
        "targets": [row(target, seconds, verdicts, quick) for target in targets],
    }


def case_of(reader: str, name: str) -> str:
    """The name of the case of a reader and a file."""
    return f"{name}: {reader}"


def absence(package: str) -> str:
    """Why a peer can't take part; empty if it can."""
    try:
        importlib.import_module(package)
    except ImportError as error:
        return f"{error}; pip install '.[peers]'"
    return ""


def written(folder: Path, polygons: int) -> dict[str, Path]:
    """The files by name, with about so many polygons each."""
    quads = hills(side_of(polygons))
    halves = hills(side_of(polygons // 2))
    corners = halves.node_numbers
    triangles = Mesh(halves.coordinates, np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]))
    content = {".ply": binary_ply, ".stl": binary_stl, ".obj": obj_text}
    paths = {name: folder / name for name in FILES}
    for name, sides in FILES.items():
        mesh = triangles if sides == 3 else quads
        paths[name].write_bytes(content[paths[name].suffix](mesh))
    return paths


def binary_ply(mesh: Mesh) -> bytes:
    """The mesh, whose polygons all have as many sides, as most programs write it."""
    sides = 3 if mesh.triangle_count else 4
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.coordinates)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(mesh.node_numbers)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(mesh.node_numbers), [("count", "u1"), ("corners", "<i4", (sides,))])
    faces["count"] = sides
    faces["corners"] = mesh.node_numbers[:, :sides]
    return header.encode() + mesh.coordinates.astype("<f4").tobytes() + faces.tobytes()


def binary_stl(mesh: Mesh) -> bytes:
    """The triangles of the mesh."""
    facets = np.zeros(
        len(mesh.node_numbers), [("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    )
    facets["corners"] = mesh.coordinates[mesh.node_numbers[:, :3]]
    return bytes(80) + len(facets).to_bytes(4, "little") + facets.tobytes()


def read(reader: str, path: Path) -> Any:
    """What a reader makes of a file."""
    if reader == OURS:
        return read_mesh({"file": path}).mesh
    module = importlib.import_module(reader)
    make: Callable[[Path], Any] = module.load if reader == "trimesh" else module.read
    # What a peer prints is no part of the table.
    with contextlib.redirect_stdout(io.StringIO()):
        return make(path)


def counts(mesh: Any) -> dict[str, int]:
    """How many nodes and polygons were found."""
    if isinstance(mesh, Mesh):
        return {"nodes": len(mesh.coordinates), "polygons": len(mesh.node_numbers)}
    if hasattr(mesh, "points"):
        return {"nodes": len(mesh.points), "polygons": sum(len(block.data) for block in mesh.cells)}
    parts = list(mesh.geometry.values()) if hasattr(mesh, "geometry") else [mesh]
    return {
        "nodes": sum(len(part.vertices) for part in parts),
        "polygons": sum(len(part.faces) for part in parts),
    }


def memory(reader: str, path: Path) -> float:
    """MB at the peak of reading a file in a fresh process, over that of the imports."""
    command = [sys.executable, "-m", "benchmarks.reading", reader, str(path)]
    told = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout
    return float(told)


def memory_here(reader: str, path: Path) -> float:
    """MB at the peak of reading a file here, what is read included, over what was held before."""
    with TemporaryDirectory() as folder:
        # Some modules are imported on the way.
        small = written(Path(folder), 8)[path.name]
        read(reader, small)
    forget_peak()
    imported = peak()
    mesh = read(reader, path)
    assert counts(mesh)["polygons"]
    return (peak() - imported) * (1 << 20) / MEGABYTE


def text(measured: dict[str, Any]) -> str:
    """The time, the memory and what was found of each case, and the targets."""
    rows = [f"{'a file and who reads it':28}{'ms':>8}{'best':>8}{'MB':>8}{'nodes':>12}{'polygons':>12}"]
    for name, case in measured["cases ms"].items():
        found = measured["found"][name]
        rows.append(
            f"{name:28}{case['median']:8,.0f}{measured['best ms'][name]:8,.0f}"
            f"{measured['memory MB'][name]:8,.0f}{found['nodes']:12,}{found['polygons']:12,}"
        )
    return "\n".join([*rows, "", *target_lines(measured)])


if __name__ == "__main__":
    print(memory_here(sys.argv[1], Path(sys.argv[2])))
