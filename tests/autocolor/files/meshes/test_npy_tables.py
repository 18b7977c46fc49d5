from __future__ import annotations

import io
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View, read_scene, render, scene_of
from autocolor.arrays import AnyArray
from autocolor.budget import MEMORY, allowing
from autocolor.errors import InputError
from autocolor.files.formats import read_mesh
from autocolor.files.meshes import npy_tables as room
from autocolor.files.meshes.npy_tables import FORMAT, mapped, write_npy_tables
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


DECAL = decal_on_ground(1)[0]
NODES, POLYGONS = len(DECAL.coordinates), len(DECAL.node_numbers)
WHOLE = DECAL.with_scalars(
    MeshScalar("stress", np.append(np.nan, np.arange(1.0, NODES))),
    MeshScalar("load", np.arange(float(POLYGONS)), "polygon"),
)


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
        pictures = [render(scene_of(each, view=view), raster) for each in (found, mesh)]
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


def test_tables_in_the_order_of_rendering_are_mapped_and_others_copied(tmp_path: Path) -> None:
    mesh = cube()
    folder_of(tmp_path / "tables", nodes=mesh.coordinates, polygons=mesh.node_numbers)
    folder_of(tmp_path, corners=mesh.coordinates, sides=mesh.node_numbers)
    (tmp_path / "scene.toml").write_text('[[mesh]]\nnodes = "corners.npy"\npolygons = "sides.npy"\n')
    for path in (tmp_path / "tables", tmp_path / "scene.toml"):
        found = read_scene(path, limit=1e-7).mesh
        assert found.node_numbers.tolist() == mesh.node_numbers.tolist()
        assert not found.coordinates.flags.owndata
    folder_of(tmp_path, nodes=mesh.coordinates.astype(np.float32), polygons=mesh.node_numbers[:, :3])
    assert read(tmp_path).node_numbers.tolist() == mesh.node_numbers[:, [0, 1, 2, 2]].tolist()
    with allowing(340 / MEMORY):
        assert refusal(read, tmp_path).startswith("nodes.npy: to render 8 rows must take at most")


def test_a_folder_with_its_scalars_and_planes_is_read_back(tmp_path: Path) -> None:
    write_npy_tables(tmp_path, WHOLE)
    found = read(tmp_path)
    for one, other in zip(found.scalars, WHOLE.scalars, strict=True):
        assert (one.name, one.of) == (other.name, other.of)
        assert one.values.tobytes() == other.values.tobytes()
        assert not one.values.flags.owndata
    planes, expected = vars(found)["shared_planes"], WHOLE.shared_planes
    for name in ("normals", "points", "distances", "plane_of_polygon", "turned"):
        assert getattr(planes, name).tobytes() == getattr(expected, name).tobytes()


def test_a_turned_or_scaled_mesh_has_normals_of_its_own(tmp_path: Path) -> None:
    mesh = grid(3, 3, (0, 0, 0), (1, 0, 0), (0, 1, 0))
    write_npy_tables(tmp_path, mesh)
    turned = read(tmp_path, Placement("y", 2.0))
    assert (turned.normals.vectors.round(6) == [0, -1, 0]).all()
    assert "shared_planes" not in vars(turned)
    assert "normals" not in vars(read(tmp_path, Placement(crease_angle=1.0)))
    assert "coordinates must be finite and at most 1e30" in refusal(read, tmp_path, Placement(scale=2e30))


def test_parts_without_names_are_numbered_and_notes_of_a_user_name_them(tmp_path: Path) -> None:
    parts = np.array([0, 2, 2, 0, 0, 0])
    folder_of(tmp_path, nodes=cube().coordinates, polygons=cube().node_numbers, parts=parts)
    assert read(tmp_path).part_names == ("part 0", "part 1", "part 2")
    notes = {"format": FORMAT, "part_names": ["a", "b", "c"], "crease_angle": 30}
    (tmp_path / "tables.json").write_text(json.dumps(notes))
    assert (read(tmp_path).part_names, read(tmp_path).crease_angle) == (("a", "b", "c"), 30.0)


FAR = np.asfortranarray(np.zeros((8, 3)))
FAR[7, 1] = np.nan
WITHIN = "its numbers must be from -1e+30 to 1e+30"
UNITS = f"{WITHIN}, with normals of the length 1, not"
ROW = f"its numbers must be from 0 to {NODES - 1}, not"


@pytest.mark.parametrize(
    ("name", "table", "sentence"),
    [
        ("nodes", FAR, f"{WITHIN}, not [0.0, nan, 0.0] (row 7, counted from 0); correct that row"),
        ("polygons", np.zeros((2, 5), int), "its shape must be (rows, 4), not (2, 5); write it again"),
        ("polygons", np.full((2, 4), NODES), f"{ROW} [{NODES}, {NODES}, {NODES}, {NODES}] (row 0"),
        ("polygons", np.zeros((2, 4)), "its numbers must be whole, not float64; convert them"),
        ("parts", np.zeros(5, int), f"its shape must be ({POLYGONS},), not (5,); write it again"),
        ("parts", np.arange(POLYGONS) // 4 * 9, "its numbers must be from 0 to 1, not 9 (row 4"),
        ("normals", np.ones((24, 3)), f"{UNITS} [1.0, 1.0, 1.0] (row 0"),
        ("normal_numbers", np.full((POLYGONS, 4), 1 << 40), "its numbers must be from 0 to"),
        ("scalars/1", np.zeros(7), f"its shape must be ({NODES},), not (7,)"),
        ("planes", np.zeros((2, 7)), UNITS),
        ("plane_numbers", np.full(POLYGONS, 9), "its numbers must be from -1 to"),
    ],
)
def test_a_bad_or_missing_table_is_refused_with_its_name_its_row_and_the_remedy(
    tmp_path: Path, name: str, table: AnyArray, sentence: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(room, "ROWS_AT_ONCE", 3)
    write_npy_tables(tmp_path, WHOLE)
    path = tmp_path / f"{name}.npy"
    np.save(path, table)
    assert refusal(read, tmp_path).startswith(f"{name}.npy: {sentence}")
    path.unlink()
    if name in ("parts", "normals"):
        assert len(read(tmp_path).normals.numbers) == POLYGONS
    else:
        assert f"{name}.npy: there is no such file" in refusal(read, tmp_path)


@given(st.integers(0, 1 << 32))
def test_tables_with_changed_bytes_are_refused_or_give_a_mesh_that_renders(
    tmp_path_factory: pytest.TempPathFactory, seed: int
) -> None:
    random = np.random.default_rng(seed)
    folder = tmp_path_factory.mktemp("tables")
    write_npy_tables(folder, WHOLE)
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
    assert np.isfinite(render(scene_of(found), (8, 6)).intensity).all()


HEADER = b"{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }"


def saved(table: AnyArray) -> bytes:
    file = io.BytesIO()
    np.save(file, table)
    return file.getvalue()


def described(text: bytes) -> bytes:
    """A table of 24 bytes with any description."""
    return b"\x93NUMPY\1\0" + len(text).to_bytes(2, "little") + text + bytes(24)


@pytest.mark.parametrize(
    "data",
    [
        *(saved(np.array(value)) for value in (["a"], 3.0)),
        *(b"", b"\x80\4N.", saved(np.zeros((10, 3)))[:-1]),
        *(described(text) for text in (HEADER.replace(b"3,", b"9" * 19 + b","), b"(" * 900)),
    ],
    ids=repr,
)
def test_what_is_no_table_of_numbers_is_refused_in_a_sentence(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "nodes.npy"
    path.write_bytes(data)
    sentence = refusal(mapped, path, "nodes.npy")
    assert sentence.startswith("nodes.npy: ")
    assert sentence.endswith("; write it with numpy.save")
    assert sentence.isprintable()
    assert len(sentence) < 400


def test_a_sparse_table_is_refused_before_it_is_read(tmp_path: Path) -> None:
    path = folder_of(tmp_path, polygons=cube().node_numbers) / "nodes.npy"
    path.write_bytes(described(HEADER.replace(b"(3,)", b"(300000000, 3)").replace(b"False", b"True")))
    os.truncate(path, path.stat().st_size - 24 + 7_200_000_000)
    assert refusal(read, tmp_path).startswith("nodes.npy: to render 300,000,000 rows must take at most 4,000")


@pytest.mark.parametrize(
    "wrong",
    [
        *({"more": 1}, {"part_names": ["a", "a"]}, {"part_names": 2}, {"crease_angle": 181}, {"planes": 2}),
        *({"scalars": [{"name": "x", "of": []}]}, {"scalars": 2}, {"scalars": [{}]}, {"format": "2"}),
    ],
)
def test_notes_that_say_something_else_are_refused(tmp_path: Path, wrong: dict[str, object]) -> None:
    write_npy_tables(tmp_path, WHOLE)
    notes = tmp_path / "tables.json"
    notes.write_text(json.dumps({**json.loads(notes.read_text()), **wrong}))
    sentence = refusal(read, tmp_path)
    assert sentence.startswith("tables.json: it must be as a conversion writes it, and is not (")
    assert sentence.endswith("); convert the mesh again, or correct it")


def test_a_folder_may_be_converted_to_itself_and_nothing_of_the_older_mesh_is_left(tmp_path: Path) -> None:
    write_npy_tables(tmp_path, DECAL)
    write_npy_tables(tmp_path, cube(), overwrite=True)
    assert not (tmp_path / "planes.npy").exists()
    # Its tables are mapped meanwhile.
    older = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    write_npy_tables(tmp_path, read(tmp_path), overwrite=True)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == older
