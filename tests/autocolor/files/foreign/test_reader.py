"""The process in which libraries read files, and the check of the mesh that comes back."""

from __future__ import annotations

import importlib.util
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.budget import MEMORY, allowing
from autocolor.errors import UnavailableError
from autocolor.files.foreign import reader
from autocolor.files.foreign.mesh import save
from autocolor.files.foreign.reader import ForeignFormat, most_memory, most_seconds, read_foreign
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import MeshReport, Placement
from autocolor.scene.geometry.normals import NodeNormals
from autocolor.scene.mesh import Mesh
from tests.autocolor.files.foreign.conftest import OWN
from tests.autocolor.files.foreign.test_gltf import Gltf
from tests.autocolor.files.foreign.test_solvers import (
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
from tests.autocolor.files.foreign.test_vtk import TEXT
from tests.autocolor.files.refusals import is_read_or_refused, refusal

FAKE = ForeignFormat("Fake", (".fake",), "json", "fake", 1)
END = "; correct the file, or write it as OBJ or PLY"
CANNOT = "a.fake: json must be able to read it, and cannot ({})" + END
MUST = "a.fake: json must give a whole mesh, and does not ({})" + END


def read(folder: Path, body: str) -> MeshReport:
    """The mesh that a library gives, which runs some lines."""
    path = folder / "a.fake"
    path.write_text(body)
    return read_foreign(FAKE, path, Placement("x", 2.0, normals="file"))


def test_a_mesh_comes_back_and_what_a_library_prints_goes_nowhere(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reader, "WORKER", OWN)
    report = read(
        tmp_path,
        "import os; print('noise' * 100000); os.write(2, b'noise'); os.write(1, b'noise')\n"
        "polygons = dataclasses.replace(mesh.polygons, normals=np.ones((3, 3)), corner_normals=np.arange(3),"
        " scalars=(MeshScalar('a', np.arange(3.0), 'node'),))\n"
        "mesh = ForeignMesh(polygons, ('left out',), {'p': 'red'}, {'red': (255, 0, 0), 'blue': (9, 9, 9)})",
    )
    assert capfd.readouterr() == ("", "")
    assert report.mesh.coordinates.tolist() == [[0, 0, 2], [2, 0, 0], [0, 2, 0]]
    assert report.mesh.own_normals is not None
    assert [(each.name, each.values.tolist()) for each in report.mesh.scalars] == [("a", [0, 1, 2])]
    assert (report.repairs, report.material_of_part) == (("a.fake: left out",), {"p": "red"})
    assert [(each.name, each.paint.object_color) for each in report.materials] == [("red", (255, 0, 0))]


@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("raise ValueError('no\\nnodes')", CANNOT.format("no nodes")),
        ("raise KeyError('x')",
         CANNOT.format("it is cut short or damaged, or has what json does not know")),
        ("import os; os.abort()", MUST.format("it crashed (code -6)")),
        ("mesh = [bytes(1 << 20) for _ in range(5000)]",
         CANNOT.format("it needs more memory than its size and --limit allow")),
        ("mesh.polygons.coordinates[2, 1] = np.nextafter(1e30, np.inf)",
         "a.fake: the coordinates of a node must be finite and at most 1e30 in size, not"
         f" [0.0, 1.0000000000000002e+30, 1.0] (node 3){END}"),
    ],
    ids=lambda text: text[-40:],
)  # fmt: skip
def test_a_library_may_fail_in_any_way_and_nothing_is_believed(
    tmp_path: Path, body: str, sentence: str
) -> None:
    assert refusal(read, tmp_path, body) == sentence


def test_what_is_no_mesh_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    normals = NodeNormals(np.eye(3, dtype=np.float32), np.array([[0, 1, 2, 2]]))
    mesh = Mesh(np.eye(3), normals.numbers, own_normals=normals)
    for table, values in (
        ("header", 2),
        ("node_numbers", [[0, 1, 2, -1]]),
        ("own_normal_number_0", [[9] * 4]),
    ):

        def call(
            command: tuple[str, ...], table: str = table, values: Any = values, **options: object
        ) -> int:
            save(MeshReport(mesh), Path(command[-4]))
            with np.load(command[-4]) as file:
                arrays = dict(file)
            with open(command[-4], "wb") as file:
                np.savez(file, allow_pickle=False, **arrays | {table: np.array(values, arrays[table].dtype)})
            return 0

        monkeypatch.setattr(subprocess, "call", call)
        assert refusal(read, tmp_path, "").startswith("a.fake: json must give a whole mesh, and does not (")


def test_a_library_that_hangs_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reader, "WORKER", OWN)
    monkeypatch.setattr(reader, "most_seconds", lambda size: 1)
    assert refusal(read, tmp_path, "import time; time.sleep(100)") == (
        "a.fake: json must read it within 1 seconds, and did not; write it as OBJ or PLY, or allow"
        " more with --limit"
    )


def test_limits_grow_with_the_size_of_the_file() -> None:
    assert (most_seconds(0), most_memory(0)) == (30, 1 << 30)
    assert (most_seconds(10 << 20), most_memory(10 << 20)) == (70, (1 << 30) + (600 << 20))
    with allowing(3):
        assert (most_seconds(0), most_memory(1 << 40)) == (90, (1 << 30) + 3 * MEMORY)


def test_a_missing_package_is_told_with_what_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    for name, library, extra in (("a.vtk", "VTK files, the library VTK", "vtk"),
                                 ("a.3mf", "3MF files, the library lib3mf", "meshes")):  # fmt: skip
        (tmp_path / name).write_bytes(b"")
        with pytest.raises(UnavailableError) as caught:
            read_mesh({"file": tmp_path / name})
        assert str(caught.value) == (
            f'{name}: to read {library} must be installed; run: pip install "autocolor[{extra}]"'
        )


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
