from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.arrays import AnyArray
from autocolor.errors import OutputError, WriteError
from autocolor.files.meshes.formats import read_mesh
from autocolor.files.meshes.npy import npy_writing as room
from autocolor.files.meshes.npy.npy_writing import npy_header, scratch_array, write_npy_tables
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from tests.autocolor.meshes import cube, decal_on_ground
from tests.autocolor.strategies import meshes


def read(folder: Path) -> Mesh:
    return read_mesh({"nodes": folder / "nodes.npy", "polygons": folder / "polygons.npy"}).mesh


@given(
    st.sampled_from(["<f8", "<i8", "<f4", "|u1"]), st.sampled_from([(7,), (0, 3), (5, 3), (123_456_789, 4)])
)
def test_a_header_is_the_one_that_numpy_writes(dtype: str, shape: tuple[int, ...]) -> None:
    file = io.BytesIO()
    order = len(shape) > 1
    described = {"descr": dtype, "fortran_order": order, "shape": shape}
    np.lib.format.write_array_header_1_0(file, described)
    assert npy_header(np.dtype(dtype), shape)[:10] == file.getvalue()[:10]
    assert npy_header(np.dtype(dtype), shape) == file.getvalue() or shape[0] > 1_000_000
    if shape[0] < 1_000_000:
        content = npy_header(np.dtype(dtype), shape) + bytes(int(np.prod(shape)) * np.dtype(dtype).itemsize)
        assert np.load(io.BytesIO(content)).shape == shape


@given(meshes())
def test_numpy_reads_every_table_as_it_is_in_the_mesh(
    tmp_path_factory: pytest.TempPathFactory, mesh: Mesh
) -> None:
    folder = tmp_path_factory.mktemp("tables")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "NUMBERS_AT_ONCE", 3)
        write_npy_tables(folder, mesh)
    expected: dict[str, AnyArray] = {
        "nodes": mesh.coordinates,
        "polygons": mesh.node_numbers,
        "parts": mesh.part_numbers,
        "normals": mesh.normals.vectors,
        "normal_numbers": mesh.normals.numbers,
    }
    for name, table in expected.items():
        found = np.load(folder / f"{name}.npy")
        assert (found.dtype, found.shape) == (table.dtype, table.shape)
        assert found.T.flags.c_contiguous
        assert found.tobytes() == table.tobytes()


@given(meshes())
def test_normals_that_are_computed_in_files_are_the_same_to_the_bit(
    tmp_path_factory: pytest.TempPathFactory, mesh: Mesh
) -> None:
    folder = tmp_path_factory.mktemp("tables")
    fresh = Mesh(mesh.coordinates, mesh.node_numbers, mesh.part_numbers, mesh.part_names, mesh.crease_angle)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "LARGE", 0)
        write_npy_tables(folder, fresh)
    assert "normals" not in vars(fresh)
    assert read(folder).normals.vectors.tobytes() == mesh.normals.vectors.tobytes()
    assert read(folder).normals.numbers.tobytes() == mesh.normals.numbers.tobytes()
    assert all(path.suffix in (".npy", ".json") for path in folder.iterdir())


def test_tables_without_normals_are_converted_to_tables_with_them(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    np.save(tmp_path / "one" / "nodes.npy", cube().coordinates)
    np.save(tmp_path / "one" / "polygons.npy", cube().node_numbers)
    write_npy_tables(tmp_path / "two", read(tmp_path / "one"))
    assert np.load(tmp_path / "two" / "normals.npy").tobytes() == cube().normals.vectors.tobytes()
    # A folder may be converted to itself while its files are mapped.
    write_npy_tables(tmp_path / "one", read(tmp_path / "one"), overwrite=True)
    for path in (tmp_path / "two").iterdir():
        assert (tmp_path / "one" / path.name).read_bytes() == path.read_bytes()


def test_files_that_are_there_are_not_written_over_unless_it_is_wanted(tmp_path: Path) -> None:
    decal, _ = decal_on_ground(1)
    write_npy_tables(tmp_path, decal)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(OutputError, match="an output must be a new file"):
        write_npy_tables(tmp_path, cube())
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    write_npy_tables(tmp_path, cube(), overwrite=True)
    # Nothing of the planes of the older mesh is left.
    assert not (tmp_path / "planes.npy").exists()
    assert read(tmp_path).node_numbers.tolist() == cube().node_numbers.tolist()


def test_a_mesh_that_cannot_be_written_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "scalars").write_text("in the way")
    with pytest.raises(OutputError, match=r"scalars: it cannot be made .*; choose another place"):
        write_npy_tables(tmp_path, cube().with_scalars(MeshScalar("stress", np.zeros(8))))

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.posix_fallocate", full)
    monkeypatch.setattr(room, "LARGE", 0)
    with pytest.raises(WriteError, match=r"there must be room to work in \(.*\); make some"):
        write_npy_tables(tmp_path, cube())
    assert [path.name for path in tmp_path.iterdir()] == ["scalars"]


def test_an_array_in_a_file_is_zero_and_its_file_has_no_name(tmp_path: Path) -> None:
    array = scratch_array(tmp_path, (3, 4), np.float64)
    assert array.tolist() == [[0.0] * 4] * 3
    array[1] = 7
    assert array.sum() == 28
    assert list(tmp_path.iterdir()) == []
    assert scratch_array(tmp_path, (0,), np.intp).shape == (0,)


MEASURED = """
import sys, threading, time
from pathlib import Path
import numpy as np
from autocolor import View, render, scene_of
from autocolor.files.meshes.npy.npy_tables import read_npy_tables
from autocolor.visibility import projection

def anonymous():
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) >> 10 for line in lines if line.startswith("RssAnon:"))

folder, projection.LARGE = Path(sys.argv[1]), 0
begin, peak, done = anonymous(), [0], threading.Event()
def look():
    while not done.wait(0.001):
        peak[0] = max(peak[0], anonymous())
thread = threading.Thread(target=look)
thread.start()
mesh = read_npy_tables(folder / "nodes.npy", folder / "polygons.npy").mesh
picture = render(scene_of(mesh, view=View((1.2, -2.6, 2.4), target=(0, 0, 0))), 120, 160)
done.set()
thread.join()
assert picture.intensity.any()
print(max(peak[0], anonymous()) - begin)
"""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="only Linux tells of anonymous memory")
def test_rendering_mapped_tables_takes_a_small_part_of_their_size(tmp_path: Path) -> None:
    side = 700
    at = np.arange(side + 1) / side
    across, along = np.meshgrid(at, at)
    nodes = np.stack([across, along, 0.1 * np.sin(9 * across)], axis=-1).reshape(-1, 3)
    row = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    quads = np.stack([row[:-1, :-1], row[:-1, 1:], row[1:, 1:], row[1:, :-1]], axis=-1).reshape(-1, 4)
    write_npy_tables(tmp_path, Mesh(nodes, quads))
    tables = sum(path.stat().st_size for path in tmp_path.iterdir()) >> 20
    told = subprocess.run(
        [sys.executable, "-c", MEASURED, str(tmp_path)],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    # The whole mesh is 50 MiB, and the projection of all of its nodes would take another 40.
    assert tables >= 45
    assert int(told.stdout) < 30
