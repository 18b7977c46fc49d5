from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View, read_scene, render, scene_of
from autocolor.arrays import AnyArray
from autocolor.errors import InputError
from autocolor.files.meshes.formats import read_mesh
from autocolor.files.meshes.npy.npy_writing import write_npy_tables
from autocolor.files.repair.placement import Placement
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from autocolor.visibility import projection as projection_room
from tests.autocolor.meshes import cube, decal_on_ground, grid
from tests.autocolor.strategies import meshes, outside_views, rasters, views


def folder_of(folder: Path, **tables: AnyArray) -> Path:
    """A folder of tables, each named by its keyword."""
    folder.mkdir(exist_ok=True)
    for name, table in tables.items():
        np.save(folder / f"{name}.npy", table)
    return folder


def read(folder: Path, placement: Placement | None = None) -> Mesh:
    files = {"nodes": folder / "nodes.npy", "polygons": folder / "polygons.npy"}
    return read_mesh(files, placement or Placement()).mesh


def refusal_of(folder: Path) -> str:
    with pytest.raises(InputError) as refusal:
        read(folder)
    return str(refusal.value)


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


def test_files_that_are_mapped_may_be_larger_than_those_that_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from autocolor.files.scenes import scene_meshes

    folder_of(tmp_path, nodes=cube().coordinates, polygons=cube().node_numbers)
    (tmp_path / "scene.toml").write_text('[[mesh]]\nnodes = "nodes.npy"\npolygons = "polygons.npy"\n')
    monkeypatch.setattr(scene_meshes, "LARGEST_MESH_FILE", 10)
    assert len(read_scene(tmp_path).mesh.node_numbers) == 6


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
        "nodes.npy: the shape of a node table must be (rows, 3), not (8, 2); write it again",
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
    assert refusal_of(tmp_path) == sentence


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
    assert refusal_of(tmp_path).startswith(rule)


def test_normals_without_their_numbers_are_refused(tmp_path: Path) -> None:
    write_npy_tables(tmp_path, cube())
    (tmp_path / "normal_numbers.npy").unlink()
    assert refusal_of(tmp_path) == (
        "normals.npy: normals.npy and normal_numbers.npy must both be there or neither, not one alone;"
        " delete it"
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
