from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor import Light, Mesh, Reflectance, View, read_scene, render, write_picture, write_scene
from autocolor.batches.outputs import base_mark
from autocolor.files.meshes.obj import obj_text
from autocolor.files.meshes.repair import FILE, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.opening import output_of
from autocolor.journal.places import checksum_of
from autocolor.scene.geometry.normals import NodeNormals
from autocolor.scene.mesh import has_same_tables
from autocolor.scene.scalar import MeshScalar
from tests.small import sphere, wall_scene
from tests.tables import refused

SQUARE = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 3, 0], [3, 3, 1]]
UP = [0.0, 0.0, 1.0]


def mesh_of(
    polygons: list[list[int]], normals: Any, rows: list[list[int]], up: str = "z", scale: float = 1.0
) -> MeshReport:
    raw = RawPolygons(
        np.array(SQUARE, np.float64),
        np.concatenate([np.array(each, np.intp) for each in polygons]),
        np.array([len(each) for each in polygons]),
        np.zeros(len(polygons), np.intp),
        ("all",),
        normals=np.array(normals, np.float64).reshape(-1, 3),
        corner_normals=np.concatenate([np.array(each, np.intp) for each in rows]),
    )
    return repaired(raw, "a.obj", Placement(up, scale, normals=FILE), unused_nodes=True)


def vectors_of(mesh: Mesh) -> Any:
    """The own normal at each corner of each polygon; None where there is none."""
    own = mesh.own_normals
    if own is None:
        return None
    return [
        [own.vectors[row].tolist() if row >= 0 else None for row in rows] for rows in own.numbers.tolist()
    ]


def with_normals(mesh: Mesh, path: Path) -> Mesh:
    """A mesh around the origin whose own normals point away from it."""
    unit = (mesh.coordinates / np.linalg.norm(mesh.coordinates, axis=1)[:, None]).astype(np.float32)
    own = NodeNormals(np.asfortranarray(unit), mesh.node_numbers)
    path.write_bytes(obj_text(Mesh(mesh.coordinates, mesh.node_numbers, own_normals=own)))
    return read_scene(path).mesh


def test_a_coarse_sphere_with_its_own_normals_is_lit_as_a_fine_one(tmp_path: Path) -> None:
    fields = {
        "reflectance": Reflectance(1.0, 0.0),
        "view": View((0.0, -40.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=3.0),
        "lights": (Light("far", (0.6, -0.8, 0.0), aim=(0.0, 0.0, 0.0), at_infinity=True),),
    }
    # Its polygons meet at 45 degrees, which is a crease where normals are computed.
    own = with_normals(sphere(8, 4), tmp_path / "sphere.obj")
    pictures = [
        render(wall_scene(mesh, **fields), (60, 60))  # type: ignore[arg-type]
        for mesh in (sphere(128, 64), own)
    ]
    fine, coarse = (np.where(each.surface_number > 0, each.intensity, np.nan) for each in pictures)
    assert np.nanmax(np.abs(coarse - fine)) < 0.2


def test_pieces_and_repaired_polygons_keep_their_normals() -> None:
    normals: list[list[float]] = [UP, [1, 0, 1], [0, 1, 1], [-1, 0, 1], [0, -1, 1]]
    mesh = mesh_of([[0, 1, 2, 4, 3], [0, 0, 1, 2]], normals, [[0, 1, 2, 3, 4], [9, 0, 1, 2]]).mesh
    own = dict(zip([0, 1, 2, 4, 3], normals, strict=True))
    for nodes, vectors in zip(mesh.node_numbers.tolist(), vectors_of(mesh)[:-1], strict=False):
        for node, vector in zip(nodes, vectors, strict=True):
            assert vector == pytest.approx(np.array(own[node]) / np.linalg.norm(own[node]))
    assert vectors_of(mesh)[-1][0] == pytest.approx(UP)


def test_normals_turn_with_the_coordinates_and_are_not_scaled() -> None:
    mesh = mesh_of([[0, 1, 2, 3]], [UP], [[0, 0, 0, 0]], "y", 1000.0).mesh
    side = np.cross(mesh.coordinates[1] - mesh.coordinates[0], mesh.coordinates[3] - mesh.coordinates[0])
    assert vectors_of(mesh) == [[(side / np.linalg.norm(side)).tolist()] * 4]


@pytest.mark.parametrize(
    ("rows", "missing"), [([0, 0, 0, 0], []), ([0, -1, 0, 2], [1, 3]), ([2, 1, 1, 9], None)]
)
def test_missing_and_broken_normals_are_computed_and_counted(
    rows: list[int], missing: list[int] | None
) -> None:
    report = mesh_of([[0, 1, 2, 3]], [[0, 0, 1e-100], [0, 0, 1e-200], [np.inf, 0, 1]], [rows])
    count = 4 if missing is None else len(missing)
    told = f"a.obj: computed the normals of corners that have none: {count}"
    assert report.repairs == (told,) * (count > 0)
    vectors = vectors_of(report.mesh)
    assert vectors == (None if missing is None else [[None if at in missing else UP for at in range(4)]])
    assert report.mesh.normals.vectors[report.mesh.normals.numbers].tolist() == [[UP] * 4]


def test_the_normals_of_a_polygon_that_winds_the_other_way_are_turned_over() -> None:
    report = mesh_of(
        [[0, 1, 2, 3], [3, 2, 1, 0], [0, 2, 1]], [UP, [4, 0, -3]], [[0] * 4, [0, 0, 0, 1], [0] * 3]
    )
    assert report.repairs == ("a.obj: turned over the normals of polygons that wind the other way: 2",)
    first, second, third = vectors_of(report.mesh)
    assert first == [UP] * 4
    assert second[:3] == third[:3] == [[0, 0, -1]] * 3
    # Only together do they point to the back.
    assert second[3] == pytest.approx([-0.8, 0, 0.6])


def test_joined_meshes_keep_their_own_normals_and_the_others_are_computed(tmp_path: Path) -> None:
    own = with_normals(sphere(6, 4), tmp_path / "a.obj")
    other = Mesh(own.coordinates, own.node_numbers, part_names=("other",))
    for meshes in ([own, other], [other, own]):
        joined = Mesh.joined(meshes).normals
        expected = [mesh.normals.vectors[mesh.normals.numbers] for mesh in meshes]
        assert np.array_equal(joined.vectors[joined.numbers], np.concatenate(expected))
    assert Mesh.joined([other, other]).own_normals is None


def test_copies_of_a_mesh_keep_its_own_normals_which_make_it_another_scene(tmp_path: Path) -> None:
    own = with_normals(sphere(6, 4), tmp_path / "a.obj")
    scene = read_scene(tmp_path / "a.obj")
    for same in (pickle.loads(pickle.dumps(own)), own.with_scalars(MeshScalar("a", np.arange(20.0)))):
        assert has_same_tables(own, same.with_scalars())
    bare = Mesh(own.coordinates, own.node_numbers, part_names=own.part_names)
    assert not has_same_tables(own, bare)
    assert checksum_of(scene) != checksum_of(scene.replace(mesh=bare))
    assert base_mark(scene, None, ()) != base_mark(scene.replace(mesh=bare), None, ())


@pytest.mark.parametrize("name", ["a.tables", "a.npz", "npy/nodes.npy"])
def test_what_is_written_is_read_with_the_same_normals(tmp_path: Path, name: str) -> None:
    mesh = with_normals(sphere(6, 4), tmp_path / "from.obj").with_scalars(MeshScalar("a", np.arange(20.0)))
    scene = read_scene(tmp_path / "from.obj").replace(mesh=mesh)
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    if name == "a.npz":
        write_picture(path, scene, render(scene, (8, 8)))
    else:
        write = output_of(path).write
        assert write is not None
        write(path, scene, False)
    again = read_scene(path.parent if "/" in name else path).mesh
    assert np.array_equal(
        again.normals.vectors[again.normals.numbers], mesh.normals.vectors[mesh.normals.numbers]
    )


def test_a_scene_asks_for_the_normals_of_its_file(tmp_path: Path) -> None:
    mesh = with_normals(sphere(6, 4), tmp_path / "a.obj")
    scene = tmp_path / "scene.toml"
    for key, is_own in (("", False), ('normals = "file"', True), ('normals = "computed"', False)):
        scene.write_text(f'[[mesh]]\nfile = "a.obj"\n{key}\n')
        assert (read_scene(scene).mesh.own_normals is not None) is is_own
    # A scene that is written beside the file looks the same.
    scene.unlink()
    write_scene(tmp_path, read_scene(tmp_path / "a.obj"))
    assert has_same_tables(read_scene(tmp_path).mesh, mesh)
    assert 'file = "a.obj"' in scene.read_text()


def refuse(own: tuple[list[list[float]], list[list[int]]]) -> None:
    normals = NodeNormals(np.array(own[0], np.float32), np.array(own[1]))
    Mesh(np.array(SQUARE[:3], float), np.array([[0, 1, 2]]), own_normals=normals)


test_a_mesh_refuses_normals_that_do_not_fit = refused(
    refuse,
    [
        (([UP], [[0, 0, 0, 1]]), "own normals: a number must be from -1 to 0; correct it"),
        (([UP], [[0, 0, 0]]), "own normals: their numbers must be intp of shape (1, 4), not (1, 3)"),
        (([[0, 0, np.nan]], [[0] * 4]),
         "own normals: they must be unit vectors of float32; normalize them"),
    ],
)  # fmt: skip
