"""The process in which libraries read files, and the check of the mesh that comes back."""

from __future__ import annotations

import importlib.util
import io
import re
import zipfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.budget import MEMORY, allowing
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError, UnavailableError
from autocolor.files.formats import FILE_FORMATS, read_mesh, recognized
from autocolor.files.meshes import foreign
from autocolor.files.meshes.foreign import (
    ForeignFormat,
    most_memory,
    most_seconds,
    read_in_own_process,
    size_of_3mf,
)
from autocolor.files.meshes.foreign_mesh import ForeignMesh, part_names_of
from tests.autocolor.files.meshes.conftest import OWN
from tests.autocolor.files.meshes.test_foreign_gltf import Gltf
from tests.autocolor.files.meshes.test_foreign_vtk import TEXT
from tests.autocolor.files.meshes.test_meshio import (
    BULK,
    CELLS2,
    GRIDS,
    MEDIT,
    MSH2,
    NODES2,
    QUAD,
    REQUIRED,
    SHELL,
    SQUARE,
)
from tests.autocolor.files.refusals import is_read_or_refused, refusal

FAKE = ForeignFormat("Fake", (".fake",), "fake", "fake", "", 1)
END = "; correct the file, or write it as OBJ or PLY"
CANNOT = "a.fake: fake must be able to read it, and cannot ({})" + END
MUST = "a.fake: fake must give a whole mesh, and does not ({})" + END


def read(folder: Path, body: str) -> ForeignMesh:
    """The mesh that a library gives, which runs some lines."""
    path = folder / "a.fake"
    path.write_text(body)
    return read_in_own_process(FAKE, path, 10_000)


def mesh(**changes: str) -> str:
    """Lines that give a mesh of a triangle, some of whose arrays are others."""
    rows = {"coordinates": "np.eye(3)", "corners": "[0, 1, 2]", "corner_counts": "[3]", "part_numbers": "[0]"}
    arrays = ", ".join(f"{name}=np.array({row})" for name, row in (rows | changes).items())
    return f"mesh = ForeignMesh(RawPolygons({arrays}, part_names=('p',)))"


def test_a_mesh_comes_back_and_what_a_library_prints_goes_nowhere(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foreign, "WORKER", OWN)
    rows = {"normals": "np.eye(3) * 2", "corner_normals": "[2, -1, 0]"}
    printing = "import os; print('noise' * 100000); os.write(2, b'noise'); os.write(1, b'noise')\n"
    polygons = read(
        tmp_path, printing + mesh(coordinates=f"np.eye(3) * -{LARGEST_COORDINATE}", **rows)
    ).polygons
    assert capfd.readouterr() == ("", "")
    assert polygons.part_names == ("p",)
    assert polygons.coordinates.min() == -LARGEST_COORDINATE
    assert polygons.normals is not None
    assert polygons.corner_normals is not None
    assert polygons.normals[polygons.corner_normals[[0, 2]]].tolist() == [[0, 0, 2], [2, 0, 0]]


NODE_9 = "the coordinates of a node must be finite and at most 1e30 in size, not {}"
ABSENT = MUST.format("its numbers are of nodes, corners or parts that are not there")


@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("raise ValueError('no\\nnodes')", CANNOT.format("ValueError: no nodes")),
        ("raise ValueError('x' * 1000)", CANNOT.format("ValueError: " + "x" * 288)),
        ("raise ForeignRefusal('a cell must be flat', 'bend it')", "a.fake: a cell must be flat; bend it"),
        ("raise InputError('a.fake, line 2: it ends')", "a.fake, line 2: it ends"),
        ("import os; os.abort()", f"a.fake: fake must read it, and crashed (code -6){END}"),
        ("mesh = [bytes(1 << 20) for _ in range(5000)]",
         CANNOT.format("it needs more memory than its size and --limit allow")),
        (mesh(coordinates="np.full((3, 3), np.nan)"),
         f"a.fake: {NODE_9.format('[nan, nan, nan] (node 1)')}{END}"),
        (mesh(coordinates="[[0, 0, 0], [0, 0, 1], [0, np.nextafter(1e30, np.inf), 0]]"),
         f"a.fake: {NODE_9.format('[0.0, 1.0000000000000002e+30, 0.0] (node 3)')}{END}"),
        *(
            (mesh(**changes), ABSENT)
            for changes in (
                {"coordinates": "np.zeros((4, 2))"}, {"corners": "[0, 1, 3]"}, {"corners": "[0, 1, -1]"},
                {"corner_counts": "[4]"}, {"corner_counts": "[-1, 4]", "part_numbers": "[0, 0]"},
                {"part_numbers": "[1]"}, {"part_numbers": "[-1]"}, {"part_numbers": "[0, 0]"},
                {"corner_normals": "[0, 0]", "normals": "np.eye(3)"},
                {"corner_normals": "[0, 0, 0]", "normals": "np.zeros((4, 2))"},
            )
        ),
    ],
    ids=lambda text: text[-40:],
)  # fmt: skip
def test_a_library_may_fail_in_any_way_and_nothing_is_believed(
    tmp_path: Path, body: str, sentence: str
) -> None:
    assert refusal(read, tmp_path, body) == sentence


@pytest.mark.parametrize("data", [b"", b"PK", b"\x80\x04N."])
def test_what_is_no_mesh_is_refused(tmp_path: Path, data: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        foreign, "_exit_code", lambda command, _: Path(command[-3]).write_bytes(data) - len(data)
    )
    assert refusal(read, tmp_path, "").startswith("a.fake: fake must give a whole mesh, and does not (")


@pytest.mark.parametrize(
    ("body", "starting"),
    [("while True: pass", 30), ("import time; time.sleep(100)", -11)],
    ids=["busy", "idle"],
)
def test_a_library_that_hangs_is_ended(
    tmp_path: Path, body: str, starting: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foreign, "WORKER", OWN)
    monkeypatch.setattr(foreign, "STARTING_SECONDS", starting)
    assert refusal(read, tmp_path, body) == (
        "a.fake: fake must read it within 6 seconds, for its size, and did not; write it as OBJ or PLY,"
        " or allow more with --limit (limit= in Python)"
    )


def test_limits_grow_with_the_size_of_the_file() -> None:
    assert (most_seconds(0), most_memory(0)) == (6, 1 << 30)
    assert (most_seconds(10 << 20), most_memory(10 << 20)) == (26, (1 << 30) + (600 << 20))
    assert most_memory(1 << 40) == (1 << 30) + MEMORY
    with allowing(3):
        assert (most_seconds(0), most_memory(1 << 40)) == (18, (1 << 30) + 3 * MEMORY)


def test_names_of_parts_are_made_unique_and_printable() -> None:
    assert part_names_of(["a", "a", "a 2", "", "b\0", "a"]) == ("a", "a 2", "a 2 2", "part", "b?", "a 3")


# The formats.


@pytest.mark.parametrize(
    ("name", "head", "told", "extra"),
    [
        ("a.vtu", b"<VTKFile>", "VTK XML files, the library VTK", "vtk"),
        ("a.glb", b"glTF\2\0\0\0\x16\0\0\0\2\0\0\0JSON{}", "glTF files, the library VTK", "vtk"),
        ("a.3mf", b"PK\5\6" + bytes(18), "3MF files, the library lib3mf", "meshes"),
        ("a.inp", b"*NODE", "Abaqus files, the library meshio", "meshes"),
    ],
)
def test_a_missing_package_is_told_with_what_installs_it(
    tmp_path: Path, name: str, head: bytes, told: str, extra: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match="there is no such file or folder"):
        read_mesh({"file": tmp_path / name})
    (tmp_path / name).write_bytes(head)
    with pytest.raises(UnavailableError) as caught:
        read_mesh({"file": tmp_path / name})
    assert str(caught.value) == (
        f'{name}: to read {told} must be installed; run: pip install "autocolor[{extra}]"'
    )


@pytest.mark.parametrize(
    ("head", "name"),
    [
        (b"# vtk DataFile Version 3.0\n", "VTK"),
        (b'<?xml version="1.0"?>\n<!-- by hand -->\n<VTKFile type="PolyData">', "VTK XML"),
        (b"glTF\2\0\0\0", "glTF"),
    ],
)
def test_files_of_vtk_and_gltf_are_known_by_how_they_begin(tmp_path: Path, head: bytes, name: str) -> None:
    (tmp_path / "a.model").write_bytes(head)
    found = recognized(tmp_path / "a.model", FILE_FORMATS)
    assert found is not None
    assert found.name == name


def test_the_size_of_a_3mf_file_is_that_of_its_content(tmp_path: Path) -> None:
    packed, path = io.BytesIO(), tmp_path / "a.3mf"
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for number in range(3):
            archive.writestr(f"{number}.model", bytes(1_000_000))
    path.write_bytes(packed.getvalue())
    assert size_of_3mf(path) == 3_000_000
    path.write_bytes(b"PK")
    assert refusal(size_of_3mf, path) == (
        "a.3mf: a 3MF file must be a whole ZIP archive, not damaged (File is not a zip file); write it again"
    )


# Damage.

TEXTS = {
    "a.vtk": ("vtkmodules", TEXT.decode()),
    "a.gltf": ("vtkmodules", Gltf().text),
    "a.inp": ("meshio", SQUARE + SHELL),
    "a.bdf": ("meshio", BULK.format(GRIDS + QUAD)),
    "a.msh": ("meshio", MSH2 + NODES2 + CELLS2),
    "a.mesh": ("meshio", MEDIT + REQUIRED),
}
WORDS = ("", "-1", "0", "7", "2147483648", "9" * 30, "1.5", "nan", "1e300", "x", '"x"', "[]", "{}", "null")


@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.needs(TEXTS[name][0])) for name in TEXTS]
)
@given(at=st.integers(0), words=st.lists(st.sampled_from(WORDS), max_size=3))
def test_a_file_in_which_any_word_is_another_or_the_last_is_read_or_refused(
    name: str, at: int, words: list[str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    pieces = re.split(r"([\w.+-]+)", TEXTS[name][1])
    place = at % (len(pieces) // 2) * 2 + 1
    rest = pieces[place + 1 :] if words else []
    text = "".join([*pieces[:place], " ".join(words), *rest])
    assert is_read_or_refused(tmp_path_factory.getbasetemp() / name, text.encode())
