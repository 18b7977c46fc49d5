from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import os
import struct
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.budget import MEMORY, allowing
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError, UnavailableError
from autocolor.files.array_file import array_file_bytes
from autocolor.files.formats import read_mesh
from autocolor.files.meshes import foreign
from autocolor.files.meshes.cells import CORNERS
from autocolor.files.meshes.foreign import (
    FOREIGN,
    MOST_LEVELS,
    RESULT,
    ForeignFormat,
    ForeignMesh,
    foreign_mesh_bytes,
    largest_result,
    most_memory,
    most_seconds,
    read_foreign,
    read_foreign_mesh,
    read_in_own_process,
    size_of_3mf,
    size_of_file,
    size_of_gltf,
)
from autocolor.files.meshes.repair import MeshReport, Placement, RawPolygons, repaired
from autocolor.scene.scalar import MeshScalar
from tests.mutations import Seed, mutated

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
from autocolor.files.meshes import foreign_worker as worker
library, kind, size, *pairs = sys.argv[1:]
reader = worker.LIBRARIES[library](kind)
worker.LIBRARIES[library] = lambda kind: reader
for mesh, result in zip(pairs[::2], pairs[1::2]):
    child = os.fork()
    if child == 0:
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
        os._exit(worker.main([library, kind, mesh, result, size, "1"]))
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
"""Reads many files, each in a process of its own that has the library already."""


SIZE = 10_000
"""The size of a file that limits are for."""


def result_of(path: Path) -> Path:
    return path.with_name("result.npz")


def read_by_one_process(read_as: ForeignFormat, paths: list[Path]) -> list[int]:
    """The exit codes of the processes that read some files, all of which have the library from one."""
    arguments = [read_as.library, read_as.kind, str(SIZE)]
    arguments += [os.fspath(each) for path in paths for each in (path, result_of(path))]
    done = subprocess.run(
        [sys.executable, "-c", FORKING, *arguments], capture_output=True, text=True, timeout=500, check=True
    )
    codes = list(map(int, done.stdout.split()))
    assert len(codes) == len(paths)
    return codes


def report_of(read_as: ForeignFormat, path: Path) -> MeshReport:
    """The mesh of a file that was read by one process. Raises InputError."""
    found = read_foreign_mesh(result_of(path), path.name, read_as.library)
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
    codes = read_by_one_process(read_as, paths)
    assert codes == [0] * len(paths)
    for kind, path in zip(kinds, paths, strict=True):
        report = report_of(read_as, path)
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
        " which is not in its folder); correct the file, or write it as OBJ or PLY"
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
    for name, package, packages in (
        ("a.vtu", "meshio", "meshio"),
        ("a.3mf", "trimesh, networkx and lxml", "trimesh networkx lxml"),
    ):
        path = tmp_path / name
        path.write_bytes(b"PK\5\6" + bytes(18))
        with pytest.raises(UnavailableError) as caught:
            read_foreign(named(name), path)
        assert caught.value.exit_code == 69
        assert str(caught.value) == (
            f"{name}: to read {path.suffix} files, the package {package} must be installed; run: pip install"
            f" {packages}"
        )


def test_a_missing_file_is_told_first(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file or folder"):
        read_foreign(named("a.vtu"), tmp_path / "a.vtu")


def damaged(folder: Path, source: Path, count: int) -> list[Path]:
    """Damaged copies of a file in folders of their own."""
    beside = [each for each in folder.iterdir() if each.is_file() and each != source]
    paths = []
    seed = Seed(source.name, {source.name: source.read_bytes()})
    for number in range(1, count + 1):
        own = folder / f"{number}"
        own.mkdir()
        for each in beside:
            os.link(each, own / each.name)
        paths.append(own / source.name)
        paths[-1].write_bytes(mutated(seed, number).files[source.name])
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
    for path in damaged(tmp_path, source, 60):
        length = length_of_refusal(lambda path=path: read_as.size_of(path))  # type: ignore[misc]
        assert length < 4000
        if not length:
            paths.append(path)
    codes = read_by_one_process(read_as, paths)
    for path, code in zip(paths, codes, strict=True):
        if code == 0:
            length = length_of_refusal(lambda path=path: report_of(read_as, path))  # type: ignore[misc]
            assert length < 4000


def write(folder: Path, data: bytes, name: str = "a.gltf") -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


def gltf(folder: Path, **described: Any) -> Path:
    return write(folder, json.dumps(described).encode())


def refusal(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        (size_of_3mf if path.suffix == ".3mf" else size_of_gltf)(path)
    return str(caught.value)


def test_buffers_in_the_folder_are_counted_and_data_in_the_file_are_not(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a b.bin").write_bytes(bytes(1000))
    path = gltf(
        tmp_path,
        buffers=[{"uri": "sub/a%20b.bin"}, {"uri": "data:;base64,AAAA"}, {}],
        images=[{"uri": "missing.png"}, {"bufferView": 0}],
    )
    assert size_of_gltf(path) == path.stat().st_size + 1000


@pytest.mark.parametrize(
    ("uri", "sentence"),
    [
        (
            "http://example.org/a.bin",
            "must be the name of a file, not the address 'http://example.org/a.bin'; fetch it and name"
            " the file",
        ),
        (
            "file:///etc/passwd",
            "must be the name of a file, not the address 'file:///etc/passwd'; fetch it and name the file",
        ),
        ("../a.bin", "must be the name of a file in the scene's folder, not '../a.bin'; copy the file there"),
        (
            "%2e%2e/a.bin",
            "must be the name of a file in the scene's folder, not '../a.bin'; copy the file there",
        ),
        (
            "/etc/passwd",
            "must be the name of a file in the scene's folder, not '/etc/passwd'; copy the file there",
        ),
        ("a%00.bin", "must be the name of a file, not 'a\\x00.bin'; correct it"),
        (7, "must be the name of a file, not ''; correct it"),
    ],
)
@pytest.mark.parametrize("what", ["buffers", "images"])
def test_no_address_is_fetched_and_no_file_out_of_the_folder_read(
    tmp_path: Path, what: str, uri: object, sentence: str
) -> None:
    assert refusal(gltf(tmp_path, **{what: [{"uri": uri}]})) == f"a.gltf: {what} 0: it {sentence}"


def test_a_buffer_that_is_missing_or_too_large_is_refused(tmp_path: Path) -> None:
    path = gltf(tmp_path, buffers=[{}, {"uri": "a.bin"}])
    assert refusal(path) == "a.gltf: buffers 1: there is no file 'a.bin' in its folder; copy it there"
    with open(tmp_path / "a.bin", "wb") as file:
        file.truncate(1 << 30)
    with pytest.raises(
        InputError, match=r"^a\.gltf: to read 1,073,74\d,\d\d\d bytes must take at most 4,000"
    ):
        read_mesh({"file": path})


@pytest.mark.parametrize(
    "data", [b"", b"[]", b"{", b'{"a": NaN}', b"[" * 100_000, b"\xff", b"{" + b'"a":[],' * 2_000_000]
)
def test_what_is_no_json_is_refused(tmp_path: Path, data: bytes) -> None:
    assert refusal(write(tmp_path, data)).startswith(
        "a.gltf: a glTF file must describe its scene in JSON, not "
    )
    assert " at line 2, column 2; write it again" in refusal(write(tmp_path, b"{\n a"))
    assert refusal(write(tmp_path, b'{"buffers": {}}')) == "a.gltf: buffers must be a list; correct the file"


def test_a_binary_file_has_its_json_first(tmp_path: Path) -> None:
    text = b'{"images": [{"uri": "https://x"}]}'
    head = struct.pack("<4sII I4s", b"glTF", 2, 20 + len(text), len(text), b"JSON")
    assert "the address 'https://x'" in refusal(write(tmp_path, head + text, "a.glb"))
    for data in (head[:19], head, head.replace(b"JSON", b"BIN\0") + text, b"glTF" + bytes(40)):
        assert refusal(write(tmp_path, data, "a.glb")) == (
            "a.glb: a binary glTF file must have version 2, its own length and a chunk of JSON first; the"
            " file is cut short or damaged"
        )


def test_what_an_archive_holds_is_known_before_it_is_read(tmp_path: Path) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", b"<model/>" * 1000)
    assert size_of_3mf(write(tmp_path, packed.getvalue(), "a.3mf")) == 8000
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", bytes(10_000_000))
    size = len(packed.getvalue())
    assert refusal(write(tmp_path, packed.getvalue(), "a.3mf")) == (
        f"a.3mf: a 3MF file of its size must hold at most 10,000 files and {200 * size:,} bytes, not 1 and"
        " 10,000,000; simplify it"
    )
    assert refusal(write(tmp_path, b"PK", "a.3mf")).startswith(
        "a.3mf: a 3MF file must be a whole ZIP archive, not"
    )


@pytest.mark.parametrize("members", [2, 3, 4])
def test_an_archive_has_a_limited_number_of_files(
    tmp_path: Path, members: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foreign, "MOST_MEMBERS", 3)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for number in range(members):
            archive.writestr(f"{number}.model", b"<model/>")
    path = write(tmp_path, packed.getvalue(), "a.3mf")
    if members <= 3:
        # An archive is never counted as smaller than it is on disk.
        assert size_of_3mf(path) == len(packed.getvalue())
    else:
        assert f"at most 3 files and {200 * len(packed.getvalue()):,} bytes, not 4 and 32;" in refusal(path)


@pytest.mark.parametrize("more", [-1, 0, 1])
def test_an_archive_has_a_limited_growth(tmp_path: Path, more: int) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("a.model", b"<model/>")
    data = packed.getvalue()
    size = 200 * len(data) + more
    # The size of the unpacked file stands in the directory, behind the size of the packed file.
    at = data.index(b"PK\1\2") + 24
    path = write(tmp_path, data[:at] + size.to_bytes(4, "little") + data[at + 4 :], "a.3mf")
    if more <= 0:
        assert size_of_3mf(path) == size
    else:
        assert f"at most 10,000 files and {size - 1:,} bytes, not 1 and {size:,};" in refusal(path)


@pytest.mark.parametrize("values", [8, 9, 10])
def test_the_json_of_a_gltf_file_has_a_limited_number_of_values(
    tmp_path: Path, values: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foreign, "MOST_VALUES", 9)
    # What opens a table or a list, and each comma, counts as a value.
    data = json.dumps({"extras": [0] * (values - 1)}).encode()
    path = write(tmp_path, data, "a.gltf")
    if values <= 9:
        assert size_of_gltf(path) == len(data)
    else:
        assert refusal(path).startswith("a.gltf: a glTF file must describe its scene in JSON, not")


def test_another_file_has_its_own_size(tmp_path: Path) -> None:
    assert size_of_file(write(tmp_path, b"12345")) == 5


GOOD = """
import numpy as np
from autocolor.files.meshes.foreign import ForeignMesh
from autocolor.files.meshes.repair import RawPolygons
polygons = RawPolygons(np.eye(3), np.arange(3), np.array([3]), np.array([0]), ("p",))
mesh = ForeignMesh(polygons)
"""


def command(body: str) -> list[str]:
    """A worker whose library runs some lines, which give `mesh`, when it is asked to read a file."""
    code = f"""
import sys
from autocolor.files.meshes import foreign_worker as worker
def reader(kind):
    def read(path):
        {"        ".join(line + chr(10) for line in (GOOD + body).splitlines())}
        return mesh
    return read
worker.LIBRARIES["fake"] = reader
sys.exit(worker.main(sys.argv[1:]))
"""
    return [sys.executable, "-c", code]


def read(folder: Path, body: str, starting: float = 30) -> tuple[str, ...]:
    path = folder / "a.glb"
    path.write_bytes(b"mesh")
    return read_in_own_process("fake", "glb", path, SIZE, command(body), starting).polygons.part_names


def refusal_in_process(folder: Path, body: str, starting: float = 30) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, body, starting)
    return str(caught.value)


def test_a_mesh_comes_back(tmp_path: Path) -> None:
    assert read(tmp_path, "") == ("p",)


def test_what_a_library_prints_goes_nowhere(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert read(tmp_path, "import os; print('noise' * 100000); os.write(2, b'noise'); os.write(1, b'noise')")
    assert capfd.readouterr() == ("", "")


def test_a_library_may_raise_or_exit(tmp_path: Path) -> None:
    said = "a.glb: fake must be able to read it, and cannot ({}); correct the file, or write it as OBJ or PLY"
    assert refusal_in_process(tmp_path, "raise ValueError('no\\nnodes')") == said.format(
        "ValueError: no nodes"
    )
    assert refusal_in_process(tmp_path, "sys.exit(0)") == said.format("it gave up")
    assert refusal_in_process(tmp_path, "mesh = None").startswith(
        "a.glb: fake must be able to read it, and cannot (Attr"
    )
    assert refusal_in_process(tmp_path, "def f(): f()\nf()").startswith(
        "a.glb: fake must be able to read it, and cannot (RecursionError: "
    )


def test_a_library_may_end_the_process(tmp_path: Path) -> None:
    said = "a.glb: fake must read it, and {}; correct the file, or write it as OBJ or PLY"
    assert refusal_in_process(tmp_path, "import os; os._exit(0)") == said.format("ended without a mesh")
    assert refusal_in_process(tmp_path, "import os; os._exit(7)") == said.format("ended with code 7")
    assert refusal_in_process(tmp_path, "import os; os.abort()") == said.format("was ended by SIGABRT")
    segfault = "import signal; signal.raise_signal(signal.SIGSEGV)"
    assert refusal_in_process(tmp_path, segfault) == said.format("was ended by SIGSEGV")


@pytest.mark.parametrize("body", ["while True: pass", "import time; time.sleep(100)"])
def test_a_library_that_hangs_is_ended(tmp_path: Path, body: str) -> None:
    started = time.monotonic()
    assert refusal_in_process(tmp_path, body, 3) == (
        "a.glb: fake must read it within 2 seconds, for its size, and did not; write it as OBJ or PLY,"
        " or allow more with --limit (limit= in Python)"
    )
    assert time.monotonic() - started < 30


def test_a_process_that_never_starts_reading_is_ended(tmp_path: Path) -> None:
    hanging = [sys.executable, "-c", "import time; time.sleep(100)"]
    with pytest.raises(InputError, match=r"fake must read it within 2 seconds, for its size, and did not"):
        read_in_own_process("fake", "glb", tmp_path / "a.glb", 0, hanging, -3.5)


def test_a_library_that_eats_memory_is_refused_it(tmp_path: Path) -> None:
    assert refusal_in_process(tmp_path, "mesh = [bytes(1 << 20) for _ in range(5000)]") == (
        "a.glb: fake must be able to read it, and cannot (it needs more memory than its size and"
        " --limit allow); correct the file, or write it as OBJ or PLY"
    )


def test_a_result_that_is_too_large_is_no_result(tmp_path: Path) -> None:
    table = "RawPolygons(np.zeros((1000000, 3)), np.arange(3), np.array([3]), np.array([0]), ('p',))"
    assert "a.glb: fake " in refusal_in_process(tmp_path, f"mesh = ForeignMesh({table})")


def test_a_command_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the process of a reader cannot be started "):
        read_in_own_process("fake", "glb", tmp_path / "a.glb", SIZE, [str(tmp_path / "none")])


@pytest.mark.parametrize("levels", [MOST_LEVELS - 1, MOST_LEVELS, MOST_LEVELS + 1])
def test_nodes_of_a_gltf_file_have_a_limited_depth(tmp_path: Path, levels: int) -> None:
    path = tmp_path / "deep.gltf"
    nodes = [{"children": [number + 1]} for number in range(levels)]
    path.write_text(
        json.dumps({"nodes": [*nodes, {"children": [0, "x", -1]}, {"children": [len(nodes) + 1]}]})
    )
    # The last node of the chain refers to the first, so that the circle has no root.
    assert size_of_gltf(path) > 0
    path.write_text(json.dumps({"nodes": [*nodes, {}]}))
    if levels <= MOST_LEVELS:
        assert size_of_gltf(path) > 0
        return
    with pytest.raises(
        InputError, match=r"deep.gltf: nodes 101: a node must have at most 100 nodes above it"
    ):
        size_of_gltf(path)


def test_limits_grow_with_the_size_of_the_file() -> None:
    assert (most_seconds(0), most_memory(0), largest_result(0)) == (2, 1 << 30, 16 << 20)
    assert most_seconds(10 << 20) == 12
    assert most_memory(10 << 20) == (1 << 30) + (600 << 20)
    assert largest_result(1 << 20) == 46 << 20
    assert most_memory(1 << 40) == (1 << 30) + MEMORY
    with allowing(3):
        assert (most_seconds(0), most_memory(1 << 40)) == (6, (1 << 30) + 3 * MEMORY)
    with allowing(0.5):
        assert (most_seconds(0), most_memory(1 << 40)) == (2, (1 << 30) + MEMORY // 2)


NODES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])

MESH = ForeignMesh(
    RawPolygons(
        NODES,
        np.array([0, 1, 2, 3, 0, 1, 2]),
        np.array([4, 3]),
        np.array([0, 1]),
        ("hood", "roof"),
        (
            MeshScalar("stress", np.array([1, 2, np.nan, 4])),
            MeshScalar("heat", np.array([5.0, 6.0]), "polygon"),
        ),
    ),
    ("skipped lines: 3",),
    {"hood": "red"},
    {"red": (200, 10, 20)},
)

HEADER = {
    "part_names": ["p"],
    "mesh_scalars": [],
    "sentences": [],
    "material_of_part": {},
    "colors": {},
}

ARRAYS: dict[str, Any] = {
    "coordinates": NODES,
    "corners": [0, 1, 2],
    "corner_counts": [3],
    "part_numbers": [0],
}


def result(folder: Path, data: bytes) -> ForeignMesh:
    path = folder / "result.npz"
    path.write_bytes(data)
    return read_foreign_mesh(path, "a.glb", "trimesh")


def test_a_mesh_comes_back_as_it_was_sent(tmp_path: Path) -> None:
    found = result(tmp_path, foreign_mesh_bytes(MESH))
    for name in ("coordinates", "corners", "corner_counts", "part_numbers", "part_names"):
        assert np.array_equal(getattr(found.polygons, name), getattr(MESH.polygons, name)), name
    assert [(each.name, each.of, str(each.values.tolist())) for each in found.polygons.scalars] == [
        ("stress", "node", "[1.0, 2.0, nan, 4.0]"),
        ("heat", "polygon", "[5.0, 6.0]"),
    ]
    assert found.sentences == MESH.sentences
    assert found.material_of_part == MESH.material_of_part
    assert {name: tuple(color) for name, color in found.colors.items()} == MESH.colors


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"coordinates": np.full((4, 3), np.nan)}, "a node whose coordinates are not finite and at"
         " most 1e30 in size, [nan, nan, nan] (node 1)"),
        ({"coordinates": np.zeros((4, 2))}, "nodes of 2 coordinates, not three"),
        ({"corners": [0, 1, 4]}, "a polygon with the node 5, which must be from 1 to 4"),
        ({"corners": [0, 1, -1]}, "a polygon with the node 0, which must be from 1 to 4"),
        ({"corner_counts": [4]}, "polygons without all of their corners"),
        ({"corner_counts": [-1, 4], "part_numbers": [0, 0]}, "polygons without all of their corners"),
        ({"part_numbers": [1]}, "polygons of parts that are not there"),
        ({"part_numbers": [0, 0]}, "polygons of parts that are not there"),
        ({"mesh_scalars": [{"name": "s", "of": "node"}], "mesh_scalar_0": [1.0]},
         "a scalar without a value for each node"),
        ({"mesh_scalars": [{"name": "s", "of": "polygon"}], "mesh_scalar_0": [np.inf]}, "no mesh ("
         "scalar 's': a value must be at most 1e30 in size, or NaN if it is missing, not inf (row 0))"),
    ],
)  # fmt: skip
def test_nothing_is_believed(tmp_path: Path, changes: dict[str, Any], rule: str) -> None:
    header = {key: changes.get(key, value) for key, value in HEADER.items()}
    arrays = {key: np.asarray(value) for key, value in {**ARRAYS, **changes}.items() if key not in HEADER}
    with pytest.raises(InputError) as caught:
        result(tmp_path, array_file_bytes(RESULT, header, arrays))
    assert str(caught.value) == f"a.glb: trimesh gave {rule}; correct the file, or write it as OBJ or PLY"


def test_a_coordinate_has_a_limited_size(tmp_path: Path) -> None:
    def changed(value: float) -> bytes:
        return array_file_bytes(RESULT, HEADER, {**ARRAYS, "coordinates": np.full((4, 3), value)})

    for value in (np.nextafter(LARGEST_COORDINATE, 0), LARGEST_COORDINATE, -LARGEST_COORDINATE):
        assert np.all(result(tmp_path, changed(value)).polygons.coordinates == value)
    with pytest.raises(InputError, match="not finite and at most 1e30 in size"):
        result(tmp_path, changed(np.nextafter(LARGEST_COORDINATE, np.inf)))


@pytest.mark.parametrize("data", [b"", b"PK", b"\x80\x04N.", foreign_mesh_bytes(MESH)[:-30]])
def test_what_is_no_result_is_refused(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(InputError, match=r"^a\.glb: trimesh gave no mesh "):
        result(tmp_path, data)
