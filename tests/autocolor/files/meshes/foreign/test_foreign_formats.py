from __future__ import annotations

import contextlib
import importlib.util
import io
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.errors import InputError, UnavailableError
from autocolor.files.meshes.foreign.foreign_formats import FOREIGN, ForeignFormat, read_foreign
from autocolor.files.meshes.foreign.foreign_mesh import FAILED, read_foreign_mesh
from autocolor.files.meshes.foreign.own_process import Limits, limits_for
from autocolor.files.meshes.formats import read_mesh
from autocolor.files.repair.cells import CORNERS
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.placement import Placement
from autocolor.files.repair.polygons import MeshReport
from tests.autocolor.files.meshes.mutations import mutations

needs_meshio = pytest.mark.skipif(importlib.util.find_spec("meshio") is None, reason="needs meshio")
needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs os.fork")
needs_trimesh = pytest.mark.skipif(
    any(importlib.util.find_spec(name) is None for name in ("trimesh", "networkx", "lxml")),
    reason="needs trimesh, networkx and lxml",
)

CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1.0)])

CELLS: dict[str, list[list[int]]] = {
    "hexahedron": [[0, 1, 3, 2, 4, 5, 7, 6]],
    "wedge": [[0, 1, 3, 4, 5, 7], [0, 3, 2, 4, 7, 6]],
    "tetra": [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]],
    "quad": [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]],
    "triangle": [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5],
                 [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6]],
}  # fmt: skip
"""The unit cube as cells of each kind, or as its surface."""

SIDES = {"hexahedron": (0, 6), "wedge": (4, 4), "tetra": (12, 0), "quad": (0, 6), "triangle": (12, 0)}

MESHIO = {"vtu": "vtu", "inp": "abaqus", "msh": "gmsh", "bdf": "nastran", "mesh": "medit", "su2": "su2",
          "b8.ugrid": "ugrid"}  # fmt: skip
TRIMESH = ("glb", "gltf", "3mf")


def named(name: str) -> ForeignFormat:
    suffix = Path(name).suffix
    return next(each for each in FOREIGN if suffix in each.suffixes)


def by_meshio(folder: Path, suffix: str, cells: Any, **data: Any) -> Path:
    """A file of some cells, written by meshio."""
    import meshio

    path = folder / f"cube.{suffix}"
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        meshio.Mesh(CUBE, cells, **data).write(path, file_format=MESHIO[suffix])
    return path


def by_trimesh(folder: Path, suffix: str) -> Path:
    """Two wheels, each a cube of one mesh, one moved and one mirrored, written by trimesh."""
    import trimesh

    cube = trimesh.Trimesh(CUBE, np.array(CELLS["triangle"]), process=False)
    paint = trimesh.visual.material.PBRMaterial(name="red paint", baseColorFactor=[200, 10, 20, 255])
    cube.visual = trimesh.visual.TextureVisuals(material=paint)
    scene = trimesh.Scene()
    moved = np.eye(4)
    moved[0, 3] = 5
    scene.add_geometry(cube, node_name="left wheel", geom_name="wheel", transform=moved)
    scene.add_geometry(cube, node_name="right wheel", geom_name="wheel", transform=np.diag([-1.0, 1, 1, 1]))
    path = folder / f"model.{suffix}"
    written = scene.export(file_type=suffix)
    if isinstance(written, bytes):
        path.write_bytes(written)
    else:
        for name, content in written.items():
            (folder / name).write_bytes(content)
    return path


def volume_of(report: MeshReport) -> float:
    """The volume within the mesh, positive if it is turned outward."""
    a, b, c, d = report.mesh.coordinates[report.mesh.node_numbers.T]
    halves = [np.einsum("ij,ij->", a, np.cross(one, other)) for one, other in ((b, c), (c, d))]
    return float(sum(halves)) / 6


FORKING = """
import os, sys
from autocolor.files.meshes.foreign import worker
library, kind, seconds, memory, largest, *pairs = sys.argv[1:]
reader = worker.LIBRARIES[library](kind)
worker.LIBRARIES[library] = lambda kind: reader
for mesh, result in zip(pairs[::2], pairs[1::2]):
    child = os.fork()
    if child == 0:
        os._exit(worker.main([library, kind, mesh, result, seconds, memory, largest]))
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
"""Reads many files, each in a process of its own that has the library already."""


def result_of(path: Path) -> Path:
    return path.with_name("result.npz")


def read_by_one_process(read_as: ForeignFormat, paths: list[Path], limits: Limits) -> list[int]:
    """The exit codes of the processes that read some files, all of which have the library from one."""
    arguments = [read_as.library, read_as.kind, str(limits.seconds), str(limits.memory), str(limits.result)]
    arguments += [os.fspath(each) for path in paths for each in (path, result_of(path))]
    done = subprocess.run(
        [sys.executable, "-c", FORKING, *arguments], capture_output=True, text=True, timeout=500, check=True
    )
    codes = list(map(int, done.stdout.split()))
    assert len(codes) == len(paths)
    return codes


def report_of(read_as: ForeignFormat, path: Path, limits: Limits) -> MeshReport:
    """The mesh of a file that was read by one process. Raises InputError."""
    found = read_foreign_mesh(result_of(path), limits.result, path.name, read_as.library)
    return repaired(found.polygons, path.name, skipped=found.sentences)


@needs_meshio
@needs_fork
@pytest.mark.parametrize("suffix", MESHIO)
def test_a_cube_of_each_kind_of_cell_has_its_surface(tmp_path: Path, suffix: str) -> None:
    # The writer of SU2 of meshio fails with surfaces.
    kinds = [kind for kind in CELLS if suffix != "su2" or kind in CORNERS]
    paths = []
    for kind in kinds:
        (tmp_path / kind).mkdir()
        paths.append(by_meshio(tmp_path / kind, suffix, [(kind, np.array(CELLS[kind]))]))
    read_as = named(paths[0].name)
    codes = read_by_one_process(read_as, paths, limits_for(10_000))
    assert codes == [0] * len(paths)
    for kind, path in zip(kinds, paths, strict=True):
        report = report_of(read_as, path, limits_for(10_000))
        mesh = report.mesh
        assert (mesh.triangle_count, len(mesh.node_numbers) - mesh.triangle_count) == SIDES[kind]
        assert len(mesh.coordinates) == 8
        assert volume_of(report) == pytest.approx(1)
        count = len(CELLS[kind])
        taken = f"{path.name}: took the outer surface of {count} volume cell{'s' * (count > 1)}"
        assert report.repairs == ((taken,) if kind in CORNERS else ())


@needs_meshio
@pytest.mark.parametrize("suffix", ["vtu", "msh"])
def test_scalars_of_nodes_and_cells_are_kept(tmp_path: Path, suffix: str) -> None:
    data = {
        "point_data": {"stress": CUBE[:, 0] + 2, "v": CUBE * [3, 4, 0]},
        "cell_data": {"heat": [np.arange(6.0)]},
    }
    mesh = read_mesh({"file": by_meshio(tmp_path, suffix, [("quad", np.array(CELLS["quad"]))], **data)}).mesh
    found = {each.name: each.values for each in mesh.scalars}
    assert found["stress"].tolist() == (mesh.coordinates[:, 0] + 2).tolist()
    assert found["v magnitude"].max() == 5
    assert found["heat"].tolist() == [0, 1, 2, 3, 4, 5]


@needs_trimesh
@pytest.mark.parametrize("suffix", TRIMESH)
def test_the_parts_of_a_scene_are_placed_and_up(tmp_path: Path, suffix: str) -> None:
    report = read_mesh({"file": by_trimesh(tmp_path, suffix)})
    mesh = report.mesh
    assert mesh.part_names == ("left wheel", "right wheel")
    assert (len(mesh.coordinates), len(mesh.node_numbers)) == (16, 24)
    assert volume_of(report) == pytest.approx(2)
    low, high = mesh.bounds
    y_up = suffix != "3mf"
    assert low.tolist() == ([-1, -1, 0] if y_up else [-1, 0, 0])
    assert high.tolist() == ([6, 0, 1] if y_up else [6, 1, 1])
    assert report.repairs == ()
    if y_up:
        assert report.material_of_part == {"left wheel": "red paint", "right wheel": "red paint"}
        assert [(each.name, each.paint.object_color) for each in report.materials] == [
            ("red paint", (200, 10, 20))
        ]


@needs_trimesh
def test_gltf_is_y_up_unless_it_is_read_with_x_up(tmp_path: Path) -> None:
    path = by_trimesh(tmp_path, "glb")
    heights = [read_mesh({"file": path}, Placement(up)).mesh.bounds[1][2] for up in ("z", "y", "x")]
    assert heights == [1, 1, 6]


@needs_meshio
def test_a_file_that_includes_one_outside_its_folder_does_not_reach_it(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    outside = by_meshio(tmp_path, "inp", [("quad", np.array(CELLS["quad"]))])
    path = folder / "a.inp"
    path.write_text(f"*HEADING\n*INCLUDE, INPUT={outside}\n")
    with pytest.raises(InputError) as caught:
        read_mesh({"file": path})
    assert str(caught.value) == (
        f"a.inp: meshio must be able to read it, and cannot (PermissionError: the file names '{outside}',"
        f" which"
        " is not in its folder); correct the file, or write it as OBJ or PLY"
    )


@needs_meshio
@pytest.mark.parametrize("data", [b"", b"nonsense", b"\0" * 100])
@pytest.mark.parametrize("suffix", MESHIO)
def test_what_is_no_mesh_is_refused(tmp_path: Path, suffix: str, data: bytes) -> None:
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(data)
    with pytest.raises(InputError, match=f"^a.{suffix}: "):
        read_mesh({"file": path})


def test_a_missing_package_is_told_with_what_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    for name, package in (("a.vtu", "meshio"), ("a.3mf", "trimesh, networkx and lxml")):
        path = tmp_path / name
        path.write_bytes(b"PK\5\6" + bytes(18))
        with pytest.raises(UnavailableError) as caught:
            read_foreign(named(name), path)
        assert caught.value.exit_code == 69
        assert str(caught.value) == (
            f"{name}: to read {path.suffix} files, the package {package} must be installed; run: pip install"
            ' "autocolor[meshes]"'
        )


def test_a_missing_file_is_told_first(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file or folder"):
        read_foreign(named("a.vtu"), tmp_path / "a.vtu")


def damaged(folder: Path, source: Path, count: int) -> list[Path]:
    """Damaged copies of a file in folders of their own."""
    beside = [each for each in folder.iterdir() if each.is_file() and each != source]
    paths = []
    for number, mutant in enumerate(mutations(source.read_bytes(), count)):
        own = folder / f"{number}"
        own.mkdir()
        for each in beside:
            os.link(each, own / each.name)
        paths.append(own / source.name)
        paths[-1].write_bytes(mutant)
    return paths


def length_of_refusal(act: Callable[[], object]) -> int:
    """The length of the sentences with which something is refused; 0 if it is not."""
    try:
        act()
    except InputError as error:
        return len(str(error))
    return 0


@needs_meshio
@needs_trimesh
@needs_fork
@pytest.mark.parametrize("suffix", [*TRIMESH, *MESHIO])
def test_damaged_files_are_read_or_refused(tmp_path: Path, suffix: str) -> None:
    if suffix in TRIMESH:
        source = by_trimesh(tmp_path, suffix)
    else:
        kinds = ("hexahedron",) if suffix in ("su2", "msh") else ("hexahedron", "quad")
        source = by_meshio(tmp_path, suffix, [(kind, np.array(CELLS[kind])) for kind in kinds])
    read_as = named(source.name)
    paths = []
    for path in damaged(tmp_path, source, 200):
        length = length_of_refusal(lambda path=path: read_as.size_of(path))  # type: ignore[misc]
        assert length < 4000
        if not length:
            paths.append(path)
    limits = replace(limits_for(100_000), seconds=1.0)
    codes = read_by_one_process(read_as, paths, limits)
    for path, code in zip(paths, codes, strict=True):
        if code == 0 and not result_of(path).read_bytes().startswith(FAILED):
            length = length_of_refusal(lambda path=path: report_of(read_as, path, limits))  # type: ignore[misc]
            assert length < 4000
