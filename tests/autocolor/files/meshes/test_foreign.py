from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import os
import struct
import subprocess
import sys
import zipfile
from collections.abc import Iterator
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
    MOST_LEVELS,
    RESULT,
    ForeignMesh,
    largest_result,
    most_memory,
    most_seconds,
    read_foreign_mesh,
    read_in_own_process,
    size_of_3mf,
    size_of_gltf,
)
from autocolor.files.meshes.repair import MeshReport, Placement
from tests.autocolor.files.refusals import refusal
from tests.mutations import Seed, mutated
from tests.tables import first

needs_meshio = pytest.mark.needs("meshio")
needs_trimesh = pytest.mark.needs("trimesh", "networkx", "lxml")

FAKE = """
import sys
import numpy as np
from autocolor.files.meshes import foreign_worker as worker
from autocolor.files.meshes.foreign import ForeignMesh
from autocolor.files.meshes.repair import RawPolygons

def fake(kind):
    def read(path):
        polygons = RawPolygons(np.eye(3), np.arange(3), np.array([3]), np.array([0]), ("p",))
        names = {"mesh": ForeignMesh(polygons), "np": np, "RawPolygons": RawPolygons}
        exec(open(path).read(), globals() | names, names)
        return names["mesh"]
    return read

worker.LIBRARIES["fake"] = fake
"""
"""A worker with a library more, which runs the file that it is asked to read; the file may give `mesh`."""

OWN = [sys.executable, "-c", FAKE + "sys.exit(worker.main(sys.argv[1:]))"]
SHARED = [
    sys.executable,
    "-c",
    FAKE
    + """
import json, os
readers = {}
for line in sys.stdin:
    library, kind, *others = json.loads(line)
    if library not in readers:
        worker.LIBRARIES[library](kind)
    child = os.fork()
    if child == 0:
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
        os.dup2(1, 2)
        os._exit(worker.main([library, kind, *others]))
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
""",
]
"""Reads each file in a fork that has the library already, and prints its exit code."""


@pytest.fixture(scope="module")
def worker() -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        SHARED,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )
    yield process
    process.communicate(timeout=60)
    assert process.returncode == 0


@pytest.fixture
def shared(worker: subprocess.Popen[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Files are read by forks of one process, so that a library is loaded once for all tests."""

    def exit_code(command: list[str], seconds: float) -> int:
        assert worker.stdin is not None
        assert worker.stdout is not None
        print(json.dumps(command[-6:]), file=worker.stdin, flush=True)
        return int(worker.stdout.readline())

    monkeypatch.setattr(foreign, "_exit_code", exit_code)


# Files that the libraries write are read again.

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


def by_meshio(folder: Path, suffix: str, *kinds: str, **data: Any) -> Path:
    """A file of the cube as cells of some kinds, written by meshio."""
    import meshio

    path = folder / f"cube.{suffix}"
    cells = [(kind, np.array(CELLS[kind])) for kind in kinds]
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
    for name, content in ({path.name: written} if isinstance(written, bytes) else written).items():
        (folder / name).write_bytes(content)
    return path


def volume_of(report: MeshReport) -> float:
    """The volume within the mesh, positive if it is turned outward."""
    a, b, c, d = report.mesh.coordinates[report.mesh.node_numbers.T]
    halves = [np.einsum("ij,ij->", a, np.cross(one, other)) for one, other in ((b, c), (c, d))]
    return float(sum(halves)) / 6


@needs_meshio
@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize(
    ("suffix", "kind"),
    # meshio's writer of SU2 fails with surfaces.
    [(suffix, kind) for suffix in MESHIO for kind in CELLS if suffix != "su2" or kind in CORNERS],
)
def test_a_cube_of_each_kind_of_cell_has_its_surface(tmp_path: Path, suffix: str, kind: str) -> None:
    path = by_meshio(tmp_path, suffix, kind)
    report = read_mesh({"file": path})
    mesh = report.mesh
    assert (mesh.triangle_count, len(mesh.node_numbers) - mesh.triangle_count) == SIDES[kind]
    assert len(mesh.coordinates) == 8
    assert volume_of(report) == pytest.approx(1)
    count = len(CELLS[kind])
    taken = f"{path.name}: took the outer surface of {count} volume cell{'s' * (count > 1)}"
    assert report.repairs == ((taken,) if kind in CORNERS else ())


@needs_meshio
@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize("suffix", ["vtu", "msh"])
def test_scalars_of_nodes_and_cells_are_kept(tmp_path: Path, suffix: str) -> None:
    point_data = {"stress": CUBE[:, 0] + 2, "v": CUBE * [3, 4, 0]}
    path = by_meshio(tmp_path, suffix, "quad", point_data=point_data, cell_data={"heat": [np.arange(6.0)]})
    mesh = read_mesh({"file": path}).mesh
    found = {each.name: each.values for each in mesh.scalars}
    assert found["stress"].tolist() == (mesh.coordinates[:, 0] + 2).tolist()
    assert found["v magnitude"].max() == 5
    assert found["heat"].tolist() == [0, 1, 2, 3, 4, 5]


@needs_trimesh
@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize("suffix", TRIMESH)
def test_the_parts_of_a_scene_are_placed_and_up(tmp_path: Path, suffix: str) -> None:
    path = by_trimesh(tmp_path, suffix)
    report = read_mesh({"file": path})
    mesh = report.mesh
    assert mesh.part_names == ("left wheel", "right wheel")
    assert (len(mesh.coordinates), len(mesh.node_numbers)) == (16, 24)
    assert volume_of(report) == pytest.approx(2)
    low, high = mesh.bounds
    y_up = suffix != "3mf"
    assert low.tolist() == ([-1, -1, 0] if y_up else [-1, 0, 0])
    assert high.tolist() == ([6, 0, 1] if y_up else [6, 1, 1])
    assert report.repairs == ()
    assert read_mesh({"file": path}, Placement("x", 2)).mesh.bounds[1].tolist() == [2, 2, 12]
    if y_up:
        assert report.material_of_part == {"left wheel": "red paint", "right wheel": "red paint"}
        assert [(each.name, each.paint.object_color) for each in report.materials] == [
            ("red paint", (200, 10, 20))
        ]


@needs_meshio
def test_a_file_that_includes_one_outside_its_folder_does_not_reach_it(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    outside = by_meshio(tmp_path, "inp", "quad")
    (folder / "a.inp").write_text(f"*HEADING\n*INCLUDE, INPUT={outside}\n")
    assert refusal(read_mesh, {"file": folder / "a.inp"}) == (
        f"a.inp: meshio must be able to read it, and cannot (PermissionError: the file names '{outside}',"
        " which is not in its folder); correct the file, or write it as OBJ or PLY"
    )


@needs_meshio
@needs_trimesh
@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize("start", first(1, range(0, 60, 10)))
@pytest.mark.parametrize("suffix", [*TRIMESH, *MESHIO])
def test_damaged_files_are_read_or_refused(tmp_path: Path, suffix: str, start: int) -> None:
    kinds = ("hexahedron",) if suffix in ("su2", "msh") else ("hexahedron", "quad")
    path = by_trimesh(tmp_path, suffix) if suffix in TRIMESH else by_meshio(tmp_path, suffix, *kinds)
    seed = Seed(path.name, {path.name: path.read_bytes()})
    for number in range(start + 1, start + 11):
        path.write_bytes(mutated(seed, number).files[path.name])
        try:
            read_mesh({"file": path})
        except InputError as error:
            told = str(error)
            assert told.startswith(path.name)
            assert len(told) < 4000


@pytest.mark.parametrize(
    ("name", "package", "packages"),
    [("a.vtu", "meshio", "meshio"), ("a.3mf", "trimesh, networkx and lxml", "trimesh networkx lxml")],
)
def test_a_missing_package_is_told_with_what_installs_it(
    tmp_path: Path, name: str, package: str, packages: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match="there is no such file or folder"):
        read_mesh({"file": tmp_path / name})
    (tmp_path / name).write_bytes(b"PK\5\6" + bytes(18))
    with pytest.raises(UnavailableError) as caught:
        read_mesh({"file": tmp_path / name})
    assert caught.value.exit_code == 69
    assert str(caught.value) == (
        f"{name}: to read {name[1:]} files, the package {package} must be installed; run: pip install"
        f" {packages}"
    )


# What a file of glTF or 3MF names and holds is known before a library reads it.


def write(folder: Path, name: str, data: bytes | dict[str, Any]) -> Path:
    (folder / name).write_bytes(json.dumps(data).encode() if isinstance(data, dict) else data)
    return folder / name


def archive(*members: bytes) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as opened:
        for number, data in enumerate(members):
            opened.writestr(f"{number}.model", data)
    return packed.getvalue()


@needs_trimesh
def test_buffers_in_the_folder_are_counted_and_data_in_the_file_are_not(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a b.bin").write_bytes(bytes(1000))
    described = {
        "buffers": [{"uri": "sub/a%20b.bin"}, {"uri": "DATA:;base64,AAAA"}, {}],
        "images": [{"uri": "missing.png"}, {"bufferView": 0}],
    }
    path = write(tmp_path, "a.gltf", described)
    assert size_of_gltf(path) == path.stat().st_size + 1000
    (tmp_path / "sub" / "a b.bin").unlink()
    assert refusal(size_of_gltf, path) == (
        "a.gltf: buffers 0: there is no file 'a b.bin' in its folder; copy it there"
    )
    with open(tmp_path / "sub" / "a b.bin", "wb") as file:
        file.truncate(1 << 30)
    assert refusal(read_mesh, {"file": path}).startswith("a.gltf: to read 1,073,741,9")


@pytest.mark.parametrize(
    ("uri", "sentence"),
    [
        *(
            (address, f"not the address {address!r}; fetch it and name the file")
            for address in ("http://example.org/a.bin", "file:///etc/passwd")
        ),
        *(
            (uri, f"in the scene's folder, not {name!r}; copy the file there")
            for uri, name in (("../a.bin", "../a.bin"), ("%2e%2e/a.bin", "../a.bin"), ("/etc/a", "/etc/a"))
        ),
        ("a%00.bin", "not 'a\\x00.bin'; correct it"),
        (7, "not ''; correct it"),
    ],
)
@pytest.mark.parametrize("what", ["buffers", "images"])
def test_no_address_is_fetched_and_no_file_out_of_the_folder_read(
    tmp_path: Path, what: str, uri: object, sentence: str
) -> None:
    path = write(tmp_path, "a.gltf", {what: [{}, {"uri": uri}]})
    told = refusal(read_mesh, {"file": path})
    assert told.startswith(f"a.gltf: {what} 1: it must be the name of a file")
    assert told.endswith(sentence)


HEAD = struct.Struct("<4sII I4s")
JSON = b'{"images": [{"uri": "https://x"}]}'
SHORT = (
    "a.glb: a binary glTF file must have version 2, its own length and a chunk of JSON first; the file is cut"
    " short or damaged"
)


def glb(
    version: int = 2, length: int = 20 + len(JSON), size: int = len(JSON), kind: bytes = b"JSON"
) -> bytes:
    return HEAD.pack(b"glTF", version, length, size, kind) + JSON


@pytest.mark.parametrize(
    ("name", "data", "sentence"),
    [
        *(
            ("a.gltf", data, "a.gltf: a glTF file must describe its scene in JSON, not ")
            for data in (b"", b"[]", b"{", b'{"a": NaN}', b"[" * 100_000, b"\xff")
        ),
        ("a.gltf", b"{\n a", "a.gltf: a glTF file must describe its scene in JSON, not Expecting property"),
        ("a.gltf", b'{"buffers": {}}', "a.gltf: buffers must be a list; correct the file"),
        ("a.glb", glb(), "a.glb: images 0: it must be the name of a file, not the address 'https://x'"),
        *(
            ("a.glb", data, SHORT)
            for data in (
                *(glb()[:19], glb()[:20], glb(version=1), glb(version=3), glb(kind=b"BIN\0")),
                *(glb(length=21 + len(JSON)), glb(size=len(JSON) + 1), b"glTF" + bytes(40)),
            )
        ),
        (
            "a.3mf",
            b"PK",
            "a.3mf: a 3MF file must be a whole ZIP archive, not damaged (File is not a zip file)",
        ),
        (
            "a.3mf",
            archive(bytes(10_000_000)),
            "a.3mf: a 3MF file of its size must hold at most 10,000 files and"
            f" {200 * len(archive(bytes(10_000_000))):,} bytes, not 1 and 10,000,000; simplify it",
        ),
    ],
    ids=str,
)
def test_what_is_no_scene_is_refused(tmp_path: Path, name: str, data: bytes, sentence: str) -> None:
    assert refusal(read_mesh, {"file": write(tmp_path, name, data)}).startswith(sentence)


@pytest.mark.parametrize("more", [-1, 0, 1])
def test_archives_and_json_have_limited_sizes(
    tmp_path: Path, more: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foreign, "MOST_MEMBERS", 3)
    monkeypatch.setattr(foreign, "MOST_VALUES", 9)
    members = write(tmp_path, "members.3mf", archive(*[b"<model/>"] * (3 + more)))
    data = archive(b"<model/>")
    size = 200 * len(data) + more
    # The size of the unpacked file stands in the directory, behind the size of the packed file.
    at = data.index(b"PK\1\2") + 24
    growing = write(tmp_path, "a.3mf", data[:at] + size.to_bytes(4, "little") + data[at + 4 :])
    # What opens a table or a list, and each comma, counts as a value.
    values = write(tmp_path, "a.gltf", {"extras": [0] * (8 + more)})
    if more <= 0:
        assert size_of_3mf(members) == members.stat().st_size
        assert size_of_3mf(growing) == size
        assert size_of_gltf(values) == values.stat().st_size
        return
    assert f"at most 3 files and {200 * members.stat().st_size:,} bytes, not 4 and 32;" in refusal(
        size_of_3mf, members
    )
    assert f" files and {size - 1:,} bytes, not 1 and {size:,};" in refusal(size_of_3mf, growing)
    assert refusal(size_of_gltf, values).startswith("a.gltf: a glTF file must describe its scene in JSON")


@pytest.mark.parametrize("levels", [MOST_LEVELS - 1, MOST_LEVELS, MOST_LEVELS + 1])
def test_nodes_of_a_gltf_file_have_a_limited_depth(tmp_path: Path, levels: int) -> None:
    nodes: list[dict[str, Any]] = [{"children": [number + 1]} for number in range(levels)]
    # The last node of this chain refers to the first, so that the circle has no root.
    circle = [*nodes, {"children": [0, "x", -1]}, {"children": [len(nodes) + 1]}]
    assert size_of_gltf(write(tmp_path, "a.gltf", {"nodes": circle})) > 0
    path = write(tmp_path, "a.gltf", {"nodes": [*nodes, {}]})
    if levels <= MOST_LEVELS:
        assert size_of_gltf(path) > 0
    else:
        assert refusal(size_of_gltf, path).startswith(
            "a.gltf: nodes 101: a node must have at most 100 nodes above it, not more"
        )


# A library may do anything.

SIZE = 10_000
"""The size of a file that limits are for."""

CANNOT = "a.glb: fake must be able to read it, and cannot ({}); correct the file, or write it as OBJ or PLY"
MUST = "a.glb: fake must read it, and {}; correct the file, or write it as OBJ or PLY"


def read(folder: Path, body: str, starting: float = 30, command: list[str] = OWN) -> tuple[str, ...]:
    """The names of the parts of the mesh that a library gives, which runs some lines."""
    path = write(folder, "a.glb", body.encode())
    return read_in_own_process("fake", "glb", path, SIZE, command, starting).polygons.part_names


def test_a_mesh_comes_back_and_what_a_library_prints_goes_nowhere(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    body = "import os; print('noise' * 100000); os.write(2, b'noise'); os.write(1, b'noise')"
    assert read(tmp_path, body) == ("p",)
    assert capfd.readouterr() == ("", "")


@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("raise ValueError('no\\nnodes')", CANNOT.format("ValueError: no nodes")),
        ("import sys; sys.exit(0)", CANNOT.format("it gave up")),
        ("mesh = None", CANNOT.format("AttributeError: 'NoneType' object has no attribute 'polygons'")),
        (
            "def f(f): f(f)\nf(f)",
            CANNOT.format("RecursionError: maximum recursion depth exceeded"),
        ),
        ("import os; os._exit(0)", MUST.format("ended without a mesh")),
        ("import os; os._exit(7)", MUST.format("ended with code 7")),
        ("import os; os.abort()", MUST.format("was ended by SIGABRT")),
        ("import signal; signal.raise_signal(40)", MUST.format("was ended by signal 40")),
        (
            "mesh = ForeignMesh(RawPolygons(np.zeros((800000, 3)), *[np.arange(0)] * 3, ()))",
            MUST.format("ended with code 1"),
        ),
    ],
    ids=lambda text: text[:30],
)
def test_a_library_may_fail_in_any_way(tmp_path: Path, body: str, sentence: str) -> None:
    assert refusal(read, tmp_path, body) == sentence


@pytest.mark.parametrize(
    ("body", "starting"),
    [("while True: pass", 30), ("import time; time.sleep(100)", -3)],
    ids=["busy", "idle"],
)
def test_a_library_that_hangs_is_ended(tmp_path: Path, body: str, starting: float) -> None:
    assert refusal(read, tmp_path, body, starting) == (
        "a.glb: fake must read it within 2 seconds, for its size, and did not; write it as OBJ or PLY,"
        " or allow more with --limit (limit= in Python)"
    )


def test_a_library_that_eats_memory_is_refused_it(tmp_path: Path) -> None:
    assert refusal(read, tmp_path, "mesh = [bytes(1 << 20) for _ in range(5000)]") == CANNOT.format(
        "it needs more memory than its size and --limit allow"
    )


def test_a_command_that_is_not_there_is_told(tmp_path: Path) -> None:
    sentence = refusal(read, tmp_path, "", 30, [str(tmp_path / "none")])
    assert sentence.startswith("the process of a reader cannot be started ")


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


# The mesh that comes back is checked like a file.

NODES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])

HEADER = {"part_names": ["p"], "mesh_scalars": [], "sentences": [], "material_of_part": {}, "colors": {}}
ARRAYS: dict[str, Any] = {
    "coordinates": NODES,
    "corners": [0, 1, 2],
    "corner_counts": [3],
    "part_numbers": [0],
}


def result(folder: Path, data: bytes) -> ForeignMesh:
    return read_foreign_mesh(write(folder, "result.npz", data), "a.glb", "trimesh")


FAR = "a node whose coordinates are not finite and at most 1e30 in size, "
TOO_FAR = [[0, 0, 0], [0, np.nextafter(1e30, np.inf), 0]]


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"coordinates": np.full((4, 3), np.nan)}, f"{FAR}[nan, nan, nan] (node 1)"),
        ({"coordinates": TOO_FAR}, f"{FAR}[0.0, 1.0000000000000002e+30, 0.0] (node 2)"),
        ({"coordinates": np.zeros((4, 2))}, "nodes of 2 coordinates, not three"),
        ({"corners": [0, 1, 4]}, "a polygon with the node 5, which must be from 1 to 4"),
        ({"corners": [0, 1, -1]}, "a polygon with the node 0, which must be from 1 to 4"),
        ({"corner_counts": [4]}, "polygons without all of their corners"),
        ({"corner_counts": [-1, 4], "part_numbers": [0, 0]}, "polygons without all of their corners"),
        ({"part_numbers": [1]}, "polygons of parts that are not there"),
        ({"part_numbers": [-1]}, "polygons of parts that are not there"),
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
    assert refusal(result, tmp_path, array_file_bytes(RESULT, header, arrays)) == (
        f"a.glb: trimesh gave {rule}; correct the file, or write it as OBJ or PLY"
    )


def test_a_coordinate_may_be_the_largest(tmp_path: Path) -> None:
    for value in (LARGEST_COORDINATE, -LARGEST_COORDINATE):
        data = array_file_bytes(RESULT, HEADER, {**ARRAYS, "coordinates": np.full((4, 3), value)})
        assert np.all(result(tmp_path, data).polygons.coordinates == value)


@pytest.mark.parametrize(
    "data", [b"", b"PK", b"\x80\x04N.", array_file_bytes(RESULT, HEADER, {**ARRAYS})[:-30]]
)
def test_what_is_no_result_is_refused(tmp_path: Path, data: bytes) -> None:
    assert refusal(result, tmp_path, data).startswith("a.glb: trimesh gave no mesh ")
