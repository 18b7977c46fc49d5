from __future__ import annotations

import io
import json
import logging
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View, read_scene, render, scene_of
from autocolor.arrays import AnyArray
from autocolor.errors import InputError, MissingInputError, OutputError, WriteError
from autocolor.files.formats import MESH_FORMATS, format_of_files, format_of_folder, read_mesh
from autocolor.files.meshes import npy_tables as room
from autocolor.files.meshes.npy_tables import (
    FORMAT,
    TableNotes,
    mapped,
    notes_text,
    npy_header,
    parsed_header,
    read_notes,
    scratch_array,
    write_npy_tables,
)
from autocolor.files.meshes.repair import Placement
from autocolor.scene.scalar import MeshScalar
from autocolor.testing import meshes, outside_views, views
from autocolor.visibility import projection as projection_room
from tests.autocolor.decals import decal_on_ground
from tests.autocolor.files.refusals import refusal
from tests.autocolor.strategies import rasters
from tests.small import cube, grid


def folder_of(folder: Path, **tables: AnyArray) -> Path:
    """A folder of tables, each named by its keyword."""
    folder.mkdir(exist_ok=True)
    for name, table in tables.items():
        np.save(folder / f"{name}.npy", table)
    return folder


def read(folder: Path, placement: Placement | None = None) -> Mesh:
    files = {"nodes": folder / "nodes.npy", "polygons": folder / "polygons.npy"}
    return read_mesh(files, placement or Placement()).mesh


@given(meshes(), views() | outside_views(), rasters, st.booleans())
def test_a_mapped_mesh_gives_the_same_picture_as_the_one_it_was_written_of(
    tmp_path_factory: pytest.TempPathFactory,
    mesh: Mesh,
    view: View,
    raster: tuple[int, int],
    is_large: bool,
) -> None:
    folder = tmp_path_factory.mktemp("tables")
    write_npy_tables(folder, mesh)
    found = read(folder)
    assert vars(found).keys() >= {"normals", "shared_planes"}
    with pytest.MonkeyPatch.context() as patch:
        if is_large:
            patch.setattr(projection_room, "LARGE", 0)
        pictures = [render(scene_of(each, view=view), *raster) for each in (found, mesh)]
    assert pictures[0].intensity.tobytes() == pictures[1].intensity.tobytes()
    assert pictures[0].surface_number.tobytes() == pictures[1].surface_number.tobytes()
    assert (found.part_names, found.crease_angle) == (mesh.part_names, mesh.crease_angle)


@given(meshes(), st.sampled_from(["<i4", "<i8", ">i8", "<u2"]), st.sampled_from("CF"))
def test_tables_of_any_type_and_order_give_the_same_mesh(
    tmp_path_factory: pytest.TempPathFactory, mesh: Mesh, dtype: str, order: Any
) -> None:
    folder = folder_of(
        tmp_path_factory.mktemp("tables"),
        nodes=np.array(mesh.coordinates, ">f8", order=order),
        polygons=np.array(mesh.node_numbers, dtype, order=order),
        parts=mesh.part_numbers.astype(dtype),
    )
    found = read(folder, Placement(crease_angle=mesh.crease_angle))
    assert found.coordinates.tobytes() == mesh.coordinates.tobytes()
    assert found.node_numbers.tolist() == mesh.node_numbers.tolist()
    assert found.part_numbers.tolist() == mesh.part_numbers.tolist()
    assert found.normals.vectors.tobytes() == mesh.normals.vectors.tobytes()
    for table in (found.coordinates, found.node_numbers):
        assert table.T.flags.c_contiguous
        assert not table.flags.writeable


def test_tables_in_the_order_of_rendering_are_held_and_others_copied_and_told(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    mesh = cube()
    with caplog.at_level(logging.INFO, "autocolor"):
        held = read(folder_of(tmp_path, nodes=mesh.coordinates, polygons=mesh.node_numbers))
    assert "copied" not in caplog.text
    assert not held.coordinates.flags.owndata
    with caplog.at_level(logging.INFO, "autocolor"):
        folder_of(tmp_path, nodes=mesh.coordinates.astype(np.float32), polygons=mesh.node_numbers[:, :3])
        triangles = read(tmp_path)
    assert "nodes.npy: copied, for it is not float64 stored by columns, but float32" in caplog.text
    assert "polygons.npy: copied, for its triangles do not repeat their last node" in caplog.text
    assert triangles.triangle_count == len(mesh.node_numbers)


def test_a_folder_with_its_scalars_parts_and_planes_is_read_back(tmp_path: Path) -> None:
    mesh, _ = decal_on_ground(1)
    random = np.random.default_rng(2)
    whole = Mesh(
        mesh.coordinates, mesh.node_numbers, mesh.part_numbers, mesh.part_names, 25.0,
        (
            MeshScalar("stress", np.append(random.normal(size=len(mesh.coordinates) - 1), np.nan)),
            MeshScalar("load", random.normal(size=len(mesh.node_numbers)), "polygon"),
        ),
    )  # fmt: skip
    write_npy_tables(tmp_path, whole)
    found = read(tmp_path)
    assert found.crease_angle == 25
    for one, other in zip(found.scalars, whole.scalars, strict=True):
        assert (one.name, one.of) == (other.name, other.of)
        assert one.values.tobytes() == other.values.tobytes()
        assert not one.values.flags.owndata
    planes, expected = vars(found)["shared_planes"], whole.shared_planes
    assert expected is not None
    for name in ("normals", "points", "distances", "plane_of_polygon", "turned"):
        assert getattr(planes, name).tobytes() == getattr(expected, name).tobytes()


def test_a_scene_file_and_a_folder_name_the_tables_alike(tmp_path: Path) -> None:
    mesh = cube()
    folder_of(tmp_path / "tables", nodes=mesh.coordinates, polygons=mesh.node_numbers)
    folder_of(tmp_path, corners=mesh.coordinates, sides=mesh.node_numbers)
    (tmp_path / "scene.toml").write_text('[[mesh]]\nnodes = "corners.npy"\npolygons = "sides.npy"\n')
    for path in (tmp_path / "tables", tmp_path, tmp_path / "scene.toml"):
        assert read_scene(path).mesh.node_numbers.tolist() == mesh.node_numbers.tolist()


def test_files_that_are_mapped_need_no_memory(tmp_path: Path) -> None:
    folder_of(tmp_path, nodes=cube().coordinates, polygons=cube().node_numbers)
    (tmp_path / "scene.toml").write_text('[[mesh]]\nnodes = "nodes.npy"\npolygons = "polygons.npy"\n')
    assert len(read_scene(tmp_path, limit=1e-9).mesh.node_numbers) == 6


def test_a_turned_or_scaled_mesh_has_normals_of_its_own(tmp_path: Path) -> None:
    mesh = grid(3, 3, (0, 0, 0), (1, 0, 0), (0, 1, 0))
    write_npy_tables(tmp_path, mesh)
    turned = read(tmp_path, Placement("y", 2.0))
    low, high = turned.bounds
    assert (low.tolist(), high.tolist()) == ([0, -0.0, 0], [2, 0, 2])
    assert (turned.normals.vectors.round(6) == [0, -1, 0]).all()
    assert "shared_planes" not in vars(read(tmp_path, Placement("y")))
    assert read(tmp_path, Placement(crease_angle=mesh.crease_angle)).normals.numbers.base is not None
    assert "normals" not in vars(read(tmp_path, Placement(crease_angle=1.0)))


def test_a_mesh_that_is_scaled_too_large_is_refused(tmp_path: Path) -> None:
    folder_of(tmp_path, nodes=np.full((3, 3), 1e29), polygons=np.array([[0, 1, 2]]))
    with pytest.raises(InputError, match=r"scaled coordinates must be at most 1e30 in size.*give a smaller"):
        read(tmp_path, Placement(scale=100))


def test_parts_without_names_are_numbered(tmp_path: Path) -> None:
    mesh = cube()
    folder_of(
        tmp_path, nodes=mesh.coordinates, polygons=mesh.node_numbers, parts=np.array([0, 2, 2, 0, 0, 0])
    )
    found = read(tmp_path)
    assert found.part_names == ("part 0", "part 1", "part 2")
    assert found.parts_in_use == (0, 2)


BAD: list[tuple[str, AnyArray, str]] = [
    (
        "nodes",
        np.where(np.arange(24).reshape(8, 3) == 7, np.inf, 0.5),
        "nodes.npy: coordinates must be finite and at most 1e30 in size, not [0.5, inf, 0.5] (row 2, counted"
        " from 0); correct that row",
    ),
    (
        "nodes",
        np.full((8, 3), 2e30),
        "nodes.npy: coordinates must be finite and at most 1e30 in size, not [2e+30, 2e+30, 2e+30] (row 0,"
        " counted from 0); correct that row",
    ),
    (
        "nodes",
        np.zeros((8, 2)),
        "nodes.npy: the shape of coordinates must be (rows, 3), not (8, 2); write it again",
    ),
    (
        "polygons",
        np.array([[0, 1, 2, 3], [0, 1, 8, 8]]),
        "polygons.npy: node numbers must be rows of the node table (0 to 7), not [0, 1, 8, 8] (row 1, counted"
        " from 0); correct that row",
    ),
    (
        "polygons",
        np.array([[0, 1, 2, -3]]),
        "polygons.npy: node numbers must be rows of the node table (0 to 7), not [0, 1, 2, -3] (row 0,"
        " counted from 0); correct that row",
    ),
    (
        "polygons",
        np.zeros((2, 4)),
        "polygons.npy: node numbers must be whole numbers, not float64; convert them",
    ),
    (
        "parts",
        np.zeros(5, np.intp),
        "parts.npy: the shape of part numbers must be (6,), not (5,); write it again",
    ),
    (
        "parts",
        np.array([0, 0, 0, 1, 0, 0]),
        "parts.npy: part numbers must be rows of the part table (0 to 0), not 1 (row 3, counted from 0);"
        " correct that row",
    ),
    (
        "normals",
        np.ones((24, 3), np.float32),
        "normals.npy: a normal must be a unit vector, not [1.0, 1.0, 1.0] (row 0, counted from 0);"
        " correct that row",
    ),
    (
        "normal_numbers",
        np.full((6, 4), 24),
        "normal_numbers.npy: normal numbers must be rows of the normals (0 to 23), not [24, 24, 24, 24]"
        " (row 0, counted from 0); correct that row",
    ),
    (
        "normal_numbers",
        np.zeros((5, 4), np.intp),
        "normal_numbers.npy: the shape of normal numbers must be (6, 4), not (5, 4); write it again",
    ),
    (
        "scalars/1",
        np.full(8, np.inf),
        "scalars/1.npy: a value must be at most 1e30 in size, or NaN if it is missing, not inf (row 0,"
        " counted from 0); correct that row",
    ),
    (
        "scalars/1",
        np.zeros(9),
        "scalars/1.npy: the shape of a scalar of each node must be (8,), not (9,); write it again",
    ),
]


@pytest.mark.parametrize(("name", "table", "sentence"), BAD)
def test_a_bad_table_is_refused_with_its_name_its_row_and_the_remedy(
    tmp_path: Path, name: str, table: AnyArray, sentence: str
) -> None:
    write_npy_tables(tmp_path, cube().with_scalars(MeshScalar("stress", np.zeros(8))))
    np.save(tmp_path / f"{name}.npy", table)
    assert refusal(read, tmp_path) == sentence


@pytest.mark.parametrize(
    ("name", "table", "rule"),
    [
        ("planes", np.zeros((1, 7)), "planes.npy: the normal of a plane must be a unit vector"),
        ("planes", np.full((1, 7), np.nan), "planes.npy: numbers must be finite"),
        ("plane_numbers", "high", "plane_numbers.npy: plane numbers must be -1 or rows of the planes"),
        ("plane_sides", "high", "plane_sides.npy: a side must be 0 or 1, not 9"),
    ],
)
def test_bad_planes_are_refused(tmp_path: Path, name: str, table: AnyArray | str, rule: str) -> None:
    mesh, _ = decal_on_ground(1)
    write_npy_tables(tmp_path, mesh)
    if isinstance(table, str):
        table = np.full(len(mesh.node_numbers), 9, np.uint8 if name == "plane_sides" else np.intp)
    np.save(tmp_path / f"{name}.npy", table)
    assert refusal(read, tmp_path).startswith(rule)


def test_normals_without_their_numbers_are_refused(tmp_path: Path) -> None:
    write_npy_tables(tmp_path, cube())
    (tmp_path / "normal_numbers.npy").unlink()
    assert refusal(read, tmp_path) == (
        "normals.npy: normals.npy and normal_numbers.npy must be in the folder together; delete it"
    )
    (tmp_path / "normals.npy").unlink()
    assert read(tmp_path).normals.numbers.tolist() == cube().normals.numbers.tolist()


@given(st.integers(0, 1 << 32))
def test_tables_with_changed_bytes_are_refused_or_give_a_mesh_that_renders(
    tmp_path_factory: pytest.TempPathFactory, seed: int
) -> None:
    random = np.random.default_rng(seed)
    folder = tmp_path_factory.mktemp("tables")
    write_npy_tables(folder, cube().with_scalars(MeshScalar("stress", np.zeros(8))))
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    path = paths[random.integers(len(paths))]
    data = bytearray(path.read_bytes())
    for _ in range(random.integers(1, 4)):
        data[random.integers(len(data))] = random.integers(256)
    path.write_bytes(data[: random.integers(len(data) + 1)] if random.random() < 0.2 else data)
    try:
        found = read(folder)
    except InputError:
        return
    assert np.isfinite(render(scene_of(found), 6, 8).intensity).all()


def test_notes_alone_are_believed_for_the_names_of_parts(tmp_path: Path) -> None:
    folder_of(tmp_path, nodes=cube().coordinates, polygons=cube().node_numbers)
    notes = {
        "format": "autocolor npy tables 1", "part_names": ["box"], "crease_angle": 30.0, "scalars": [],
        "planes": None,
    }  # fmt: skip
    (tmp_path / "tables.json").write_text(json.dumps(notes))
    found = read(tmp_path)
    assert (found.part_names, found.crease_angle) == (("box",), 30.0)


@pytest.mark.parametrize("row", [0, 2, 3, 8])
@pytest.mark.parametrize("order", ["C", "F"])
def test_the_first_wrong_row_is_named_in_whichever_chunk_it_lies(
    monkeypatch: pytest.MonkeyPatch, row: int, order: Any
) -> None:
    monkeypatch.setattr(room, "ROWS_AT_ONCE", 3)
    table = np.zeros((9, 3), order=order)
    table[row:, 1] = np.nan
    arguments = ("nodes.npy", table, "coordinates must be finite", room.are_coordinates, "correct it")
    assert refusal(room.checked, *arguments) == (
        f"nodes.npy: coordinates must be finite, not [0.0, nan, 0.0] (row {row}, counted from 0); correct it"
    )


@pytest.mark.parametrize(
    ("numbers", "right"),
    [
        (np.array([0, 4]), True),
        (np.array([0, 5]), False),
        (np.array([-1, 0]), False),
        (np.array([2**63 + 1, 0], np.uint64), False),
        (np.array([-128, 0], np.int8), False),
    ],
)
def test_numbers_are_compared_in_their_own_type(numbers: AnyArray, right: bool) -> None:
    assert bool(room.within(5)(numbers[None]).all()) == right


@pytest.mark.parametrize(
    ("vector", "right"),
    [((0, 0, 1), True), ((0.6, 0.8, 0), True), ((0, 0, 1.1), False), ((0, 0, np.nan), False)],
)
def test_normals_must_have_the_length_of_one(vector: tuple[float, ...], right: bool) -> None:
    assert room.are_unit_vectors(np.array([vector], np.float32).T).tolist() == [right]


@pytest.mark.parametrize(
    ("table", "held"),
    [
        (np.zeros((5, 3), order="F"), True),
        (np.zeros((5, 3)), False),
        (np.zeros((5, 3), np.float32, order="F"), False),
        (np.zeros((5, 3), ">f8", order="F"), False),
        (np.zeros(5), True),
        (np.zeros(5, np.int8), False),
    ],
)
def test_only_what_rendering_does_not_read_as_it_is_is_copied(
    table: AnyArray, held: bool, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(room, "ROWS_AT_ONCE", 2)
    table[3] = 7
    with caplog.at_level(logging.INFO, "autocolor"):
        read = room.as_read("nodes.npy", table, np.float64)
    assert (read is table) == held
    assert read.dtype == np.float64
    assert read.T.flags.c_contiguous
    assert read.tolist() == table.tolist()
    assert ("nodes.npy: copied" in caplog.text) == (not held)


def test_a_table_of_another_shape_or_kind_is_refused() -> None:
    assert refusal(room.is_shaped, "parts.npy", np.zeros((4, 2)), "part numbers", 4, (0,)) == (
        "parts.npy: the shape of part numbers must be (4,), not (4, 2); write it again"
    )
    with pytest.raises(InputError, match=r"must be \(rows, 4\) or \(rows, 3\), not \(2, 5\)"):
        room.is_shaped("polygons.npy", np.zeros((2, 5)), "a polygon table", None, (4, 3))
    assert refusal(room.is_of, "parts.npy", np.zeros(4), "part numbers", "iu") == (
        "parts.npy: part numbers must be whole numbers, not float64; convert them"
    )


@pytest.mark.parametrize("dtype", [np.float16, ">f2", np.float32, np.float64])
def test_coordinates_are_finite_in_any_precision(dtype: str | type[Any]) -> None:
    rows = np.array([[0, np.inf, -np.inf, np.nan, 1]] * 3, dtype)
    assert room.are_coordinates(rows).tolist() == [True, False, False, False, True]


DTYPES = ("<f8", ">f8", "<f4", "<i4", "<u2", "|i1", ">i8", "<u8")


def saved(table: AnyArray) -> bytes:
    file = io.BytesIO()
    np.save(file, table)
    return file.getvalue()


@given(
    st.sampled_from(DTYPES),
    st.sampled_from([(0,), (1,), (5,), (0, 3), (1, 4), (7, 3), (6, 4), (9, 1)]),
    st.sampled_from("CF"),
)
def test_a_table_that_numpy_saved_is_mapped_with_its_numbers(
    tmp_path_factory: pytest.TempPathFactory, dtype: str, shape: tuple[int, ...], order: str
) -> None:
    count = int(np.prod(shape))
    table = np.arange(count).reshape(shape).astype(dtype, order="F" if order == "F" else "C")
    path = tmp_path_factory.mktemp("npy") / "table.npy"
    np.save(path, table)
    found = mapped(path)
    assert found.dtype == table.dtype
    assert found.tolist() == table.tolist()
    assert not found.flags.writeable
    if order == "F":
        assert found.T.flags.c_contiguous


def test_what_is_mapped_takes_no_memory_and_outlives_the_name_of_its_file(tmp_path: Path) -> None:
    path = tmp_path / "table.npy"
    np.save(path, np.arange(100_000.0))
    found = mapped(path)
    path.unlink()
    assert found.base is not None
    assert found.sum() == 99_999 * 50_000


@pytest.mark.parametrize(
    ("table", "found"),
    [
        (np.array(["a"]), "<U1"),
        (np.array([1 + 2j]), "<c16"),
        (np.zeros((2, 2, 2)), "(2, 2, 2)"),
        (np.array(3.0), "()"),
        (np.array([True]), "|b1"),
        (np.zeros(2, [("x", "<f8")]), "[('x', '<f8')]"),
        (np.array(["2026-01-01"], "M8[D]"), "<M8[D]"),
    ],
)
def test_what_is_no_table_of_numbers_is_refused(tmp_path: Path, table: AnyArray, found: str) -> None:
    np.save(tmp_path / "nodes.npy", table)
    with pytest.raises(InputError) as refusal:
        mapped(tmp_path / "nodes.npy")
    sentence = str(refusal.value)
    assert sentence.startswith(
        "nodes.npy: it must be an .npy file with a table of whole numbers or floating-point numbers, not"
    )
    assert found in sentence
    assert sentence.endswith("; write it with numpy.save")


def test_objects_are_never_unpickled(tmp_path: Path) -> None:
    np.save(tmp_path / "nodes.npy", np.array([{}], object), allow_pickle=True)
    with pytest.raises(InputError, match=r"it must be an \.npy file with a table"):
        mapped(tmp_path / "nodes.npy")


@pytest.mark.parametrize("change", [-1, -300, 1, 4096])
def test_a_file_of_another_size_than_its_header_says_is_refused(tmp_path: Path, change: int) -> None:
    data = saved(np.zeros((10, 3)))
    path = tmp_path / "nodes.npy"
    path.write_bytes(data[:change] if change < 0 else data + bytes(change))
    with pytest.raises(InputError) as refusal:
        mapped(path)
    if change > -240:
        assert str(refusal.value) == (
            "nodes.npy: a table of shape (10, 3) and type float64 must have 368 bytes, not"
            f" {368 + change:,}; write it again"
        )


def test_a_table_of_too_many_rows_is_refused_before_anything_is_mapped() -> None:
    head = saved(np.zeros(7)).replace(b"(7,), }" + b" " * 11, b"(999999999999,), }")
    with pytest.raises(
        InputError, match="must have at most 200,000,000 rows, not 999,999,999,999; divide it"
    ):
        parsed_header("nodes.npy", head)


def test_files_that_are_missing_or_no_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MissingInputError):
        mapped(tmp_path / "nodes.npy")
    with pytest.raises(InputError, match="it must be a regular file, not a folder"):
        mapped(tmp_path)
    with pytest.raises(InputError, match="a file name must be valid"):
        mapped(tmp_path / "a\0b")
    (tmp_path / "empty.npy").write_bytes(b"")
    with pytest.raises(InputError, match=r"it must be an \.npy file"):
        mapped(tmp_path / "empty.npy")


@given(st.integers(0, 255))
@pytest.mark.thorough
def test_any_other_byte_in_the_header_is_refused_or_gives_a_table_of_the_same_size(
    tmp_path_factory: pytest.TempPathFactory, byte: int
) -> None:
    data = saved(np.asfortranarray(np.arange(12.0).reshape(4, 3)))
    path = tmp_path_factory.mktemp("npy") / "table.npy"
    read = 0
    for place in range(128):
        path.write_bytes(data[:place] + bytes([byte]) + data[place + 1 :])
        try:
            found = mapped(path)
        except InputError:
            continue
        assert found.nbytes == 96
        read += 1
    assert read < 128


def test_the_second_version_of_the_format_is_read_and_a_long_header_is_not() -> None:
    data = saved(np.zeros(3))
    second = b"\x93NUMPY\x02\x00" + (118).to_bytes(4, "little") + data[10:]
    assert parsed_header("a.npy", second[: 12 + 118]).shape == (3,)
    long = b"\x93NUMPY\x02\x00" + (1 << 31).to_bytes(4, "little") + data[10:]
    with pytest.raises(InputError):
        parsed_header("a.npy", long)
    assert room.LARGEST_HEADER >= 128


RIGHT: dict[str, Any] = {
    "format": FORMAT,
    "part_names": ["hood", "roof"],
    "crease_angle": 30,
    "scalars": [{"name": "stress", "of": "node"}],
    "planes": None,
}


@pytest.mark.parametrize("planes", [True, False, None])
def test_notes_are_read_as_they_were_written(tmp_path: Path, planes: bool | None) -> None:
    notes = TableNotes(("hood", "Türe \n"), 12.5, (("stress", "node"), ("load", "polygon")), planes)
    (tmp_path / "tables.json").write_bytes(notes_text(notes))
    assert read_notes(tmp_path / "tables.json") == notes


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({"format": "another"}, "its format must be 'autocolor npy tables 1'"),
        ({"more": 1}, "with the keys crease_angle, format, part_names, planes, scalars, not another"),
        ({"part_names": "hood"}, "part_names must be strings, one for each part, not others"),
        ({"part_names": [""]}, "part_names must be strings, one for each part, not others"),
        ({"part_names": ["a", "a"]}, "part_names must differ, not repeat"),
        ({"crease_angle": 181}, "crease_angle must be a number from 0 to 180, not 181"),
        ({"crease_angle": "wide"}, "not 'wide'"),
        ({"scalars": [{"name": "x", "of": "edge"}]}, "each of 'node' or 'polygon', not others"),
        ({"scalars": [{"name": "x", "of": []}]}, "each of 'node' or 'polygon', not others"),
        ({"scalars": 3}, "scalars must be at most 1000 names"),
        ({"planes": 1}, "planes must be true, false or null, not another"),
    ],
)
def test_notes_that_say_something_else_are_refused(
    tmp_path: Path, change: dict[str, object], rule: str
) -> None:
    path = tmp_path / "tables.json"
    path.write_text(json.dumps({**RIGHT, **change}))
    with pytest.raises(InputError) as refusal:
        read_notes(path)
    assert rule in str(refusal.value)
    assert str(refusal.value).startswith("tables.json: ")
    assert str(refusal.value).endswith("; convert the mesh again, or correct it")


@pytest.mark.parametrize(
    "data", [b"", b"{", b"\xff\xfe", b"[" * 100_000, b"3", b'{"crease_angle": NaN}', b"9" * 5000]
)
def test_bytes_that_are_no_notes_are_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "tables.json"
    path.write_bytes(data)
    with pytest.raises(InputError, match="convert the mesh again, or correct it"):
        read_notes(path)


def read_table(folder: Path) -> Mesh:
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
    assert read_table(folder).normals.vectors.tobytes() == mesh.normals.vectors.tobytes()
    assert read_table(folder).normals.numbers.tobytes() == mesh.normals.numbers.tobytes()
    assert all(path.suffix in (".npy", ".json") for path in folder.iterdir())


def test_tables_without_normals_are_converted_to_tables_with_them(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    np.save(tmp_path / "one" / "nodes.npy", cube().coordinates)
    np.save(tmp_path / "one" / "polygons.npy", cube().node_numbers)
    write_npy_tables(tmp_path / "two", read_table(tmp_path / "one"))
    assert np.load(tmp_path / "two" / "normals.npy").tobytes() == cube().normals.vectors.tobytes()
    # A folder may be converted to itself while its files are mapped.
    write_npy_tables(tmp_path / "one", read_table(tmp_path / "one"), overwrite=True)
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
    assert read_table(tmp_path).node_numbers.tolist() == cube().node_numbers.tolist()


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
from autocolor.files.meshes.npy_tables import read_npy_tables
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


def test_tables_are_known_by_the_names_of_their_files_or_how_they_begin(tmp_path: Path) -> None:
    for name in ("nodes", "polygons"):
        np.save(tmp_path / f"{name}.npy", cube().coordinates)
    found = format_of_folder(tmp_path)
    assert found is not None
    assert found.name == "npy"
    (tmp_path / "nodes.npy").rename(tmp_path / "corners")
    for nodes, name in (("corners", "npy"), ("a.NPY", "npy"), ("nodes.csv", "CSV"), ("nodes.txt", "CSV")):
        files = {"nodes": tmp_path / nodes, "polygons": tmp_path / "polygons"}
        recognized = format_of_files(files)
        assert recognized is not None
        assert recognized.name == name


def test_the_format_is_written_too_and_holds_all_that_a_mesh_has(tmp_path: Path) -> None:
    npy = next(each for each in MESH_FORMATS if each.name == "npy")
    assert npy.write is not None
    npy.write(tmp_path, cube())
    mesh = npy.read(tmp_path / "nodes.npy", tmp_path / "polygons.npy").mesh
    assert mesh.node_numbers.tolist() == cube().node_numbers.tolist()
