from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, Scene, read_scene, scene_of
from autocolor.errors import OutputError, UsageError
from autocolor.files.formats import PARTS, QUADS, SCALARS, Format
from autocolor.files.meshes.obj import material_names, write_obj
from autocolor.files.opening import OUTPUTS, SCENE, left_out, output_named, output_of
from autocolor.scene.scalar import MeshScalar
from autocolor.scene.surfaces import Surface
from tests.small import cube


def full_mesh() -> Mesh:
    """A mesh of a quad and a triangle in two parts, with scalars of both kinds."""
    return Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.25], [0, 1, 0], [2, 0.1, 1 / 3]]),
        np.array([[0, 1, 2, 3], [1, 4, 2, 2]]),
        np.array([0, 1]),
        ("hood", "roof"),
        scalars=(
            MeshScalar("stress", np.array([0.1, np.nan, 3, -4e20, 1 / 3])),
            MeshScalar("fault", np.array([1.0, 2.0]), "polygon"),
        ),
    )


@pytest.mark.parametrize("output", OUTPUTS, ids=lambda output: output.name)
def test_a_scene_reads_back_with_all_that_the_format_holds(output: Format, tmp_path: Path) -> None:
    path = tmp_path / f"out{output.suffixes[0] if output.suffixes else ''}"
    assert output_of(path).name == output.name
    assert output.write is not None
    files = output.write(path, scene_of(full_mesh(), surfaces="parts"), False)
    assert all(file.is_file() for file in files)
    assert output_of(path).name == output_named(output.name.upper()).name == output.name
    mesh, again = full_mesh(), read_scene(path, strict=True).mesh
    is_single = output.name == "STL"
    coordinates = mesh.coordinates.astype(np.float32) if is_single else mesh.coordinates
    # A format without node numbers has its nodes in another order.
    assert sorted(again.coordinates.tolist()) == sorted(coordinates.tolist())
    assert np.array_equal(again.node_numbers, mesh.node_numbers) == (QUADS in output.holds)
    assert (again.part_names == mesh.part_names) == (PARTS in output.holds)
    found = {(each.name, each.of): each.values for each in again.scalars}
    assert len(found) == (2 if SCALARS in output.holds else 0)
    for each in mesh.scalars if found else ():
        assert np.array_equal(found[each.name, each.of], each.values, equal_nan=True)


def test_the_format_is_that_of_the_name(tmp_path: Path) -> None:
    names = {"CAR.OBJ": "OBJ", "car": "scene", "t/nodes.csv": "CSV", ".": "scene", "x" * 300: "scene"}
    for name, output in names.items():
        assert output_of(tmp_path / name).name == output


def test_a_format_that_nothing_is_written_in_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"^OUT must end in .*'\.objj'; did you mean '\.obj'\?; name"):
        output_of(tmp_path / "car.objj")
    with pytest.raises(UsageError) as caught:
        output_named("onj")
    listed = "CSV, npy, OBJ, PLY, scene, STL, store or tables"
    assert str(caught.value) == f"--to must be {listed}, not 'onj'; choose one"


def colored() -> Scene:
    """A cube whose one surface has a color and a highlight of its own."""
    scene = scene_of(cube(), surfaces=[Surface("body")], parts={"cube": {"surface": "body"}})
    return scene.with_surface("body", object_color=(10, 20, 30), specular=0.25, exponent=7.5)


def test_neither_file_is_overwritten_unless_that_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "wall.mtl").write_text("mine")
    with pytest.raises(OutputError, match="must be a new file"):
        write_obj(tmp_path / "wall.obj", colored(), False)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("wall.mtl", "mine")]
    assert write_obj(tmp_path / "wall.obj", colored(), True) == [tmp_path / "wall.obj", tmp_path / "wall.mtl"]
    # A surface that was created has no library.
    assert write_obj(tmp_path / "cube.obj", scene_of(cube()), False) == [tmp_path / "cube.obj"]


def test_names_of_materials_are_readable_and_differ() -> None:
    names = {"body": "body", "a\nb": "a?b", "a?b": "a?b 2", "": "surface"}
    assert material_names(names) == names


NOTHING = Format(name="NOTHING", suffixes=(), read=read_scene, holds=frozenset())
OBJ, STL = output_named("obj"), output_named("stl")
QUADS_TOLD = "the quads (6, each written as two triangles)"


@pytest.mark.parametrize(
    ("mesh", "output", "phrases"),
    [
        (full_mesh(), SCENE, []),
        (Mesh(np.eye(3) / 4, np.array([[0, 1, 2]])), STL, []),
        (
            full_mesh(),
            STL,
            [
                "2 parts ('hood', 'roof')",
                "2 scalars ('stress', 'fault')",
                "the quads (1, each written as two triangles)",
            ],
        ),
        (
            dataclasses.replace(cube(), crease_angle=60, part_names=("cube", *map(str, range(1, 2005)))),
            NOTHING,
            [
                "2,005 parts ('cube', '1', '2', '3', '4' and 2,000 more)",
                QUADS_TOLD,
                "the crease angle of 60 degrees",
            ],
        ),
    ],
)
def test_of_a_bare_mesh_only_what_is_of_the_mesh_is_told(
    mesh: Mesh, output: Format, phrases: list[str]
) -> None:
    assert left_out(scene_of(mesh), output, is_bare=True) == phrases


def test_of_a_scene_its_surfaces_and_settings_are_told() -> None:
    scene = scene_of(cube(), surfaces="parts").with_surface("cube", diffuse=0.25)
    settings = "the lights, the views and the settings of the scene"
    assert left_out(scene, SCENE, is_bare=False) == []
    assert left_out(scene, NOTHING, is_bare=False) == [QUADS_TOLD, "1 surface ('cube')", settings]
    assert left_out(scene, OBJ, is_bare=False) == [
        "what a material does not have of 1 surface ('cube')",
        settings,
    ]
