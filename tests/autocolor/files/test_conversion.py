from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, Scene, read_scene, scene_of
from autocolor.errors import OutputError, UsageError, WriteError
from autocolor.files.conversion import (
    SCENE,
    WHOLE_SCENE,
    OutputFormat,
    _named,
    beyond_materials,
    left_out,
    material_names,
    output_named,
    output_of,
    outputs,
    write_folder,
    write_obj,
)
from autocolor.files.formats import MESH_EXTRAS, MESH_FORMATS, NODE_SCALARS, PARTS, POLYGON_SCALARS
from autocolor.scene.scalar import NODE, MeshScalar
from autocolor.scene.surfaces import Surface
from tests.autocolor.meshes import cube, wall_scene

MESH_OUTPUTS = [each for each in outputs() if each.name in {known.name for known in MESH_FORMATS}]


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


def written(output: OutputFormat, folder: Path, overwrite: bool = False) -> Path:
    suffix = output.suffixes[0] if output.suffixes else ""
    path = folder / f"out{suffix}"
    files = output.write(path, scene_of(full_mesh(), surfaces="parts"), overwrite)
    assert all(file.is_file() for file in files)
    return path


@pytest.mark.parametrize("output", outputs(), ids=lambda output: output.name)
def test_a_scene_reads_back_with_all_that_the_format_holds(output: OutputFormat, tmp_path: Path) -> None:
    mesh, again = full_mesh(), read_scene(written(output, tmp_path), strict=True).mesh
    assert np.array_equal(again.coordinates, mesh.coordinates)
    assert np.array_equal(again.node_numbers, mesh.node_numbers)
    assert (again.part_names == mesh.part_names) == (PARTS in output.holds)
    given = {(each.name, each.of): each.values for each in mesh.scalars}
    found = {(each.name, each.of): each.values for each in again.scalars}
    for name, of in given:
        is_held = (NODE_SCALARS if of == NODE else POLYGON_SCALARS) in output.holds
        assert ((name, of) in found) == is_held
        assert not is_held or np.array_equal(found[name, of], given[name, of], equal_nan=True)


@pytest.mark.parametrize("output", outputs(), ids=lambda output: output.name)
def test_each_format_is_that_of_what_it_writes(output: OutputFormat, tmp_path: Path) -> None:
    path = written(output, tmp_path)
    assert output_of(path).name == output.name
    assert output_named(output.name.upper()).name == output.name


def test_the_format_is_that_of_the_name(tmp_path: Path) -> None:
    assert output_of(tmp_path / "CAR.OBJ").name == "OBJ"
    assert output_of(tmp_path / "car") is SCENE
    assert output_of(tmp_path / "car.toml") is SCENE
    assert output_of(tmp_path) is SCENE


def test_a_suffix_that_nothing_is_written_in_is_refused_with_the_nearest(tmp_path: Path) -> None:
    with pytest.raises(
        UsageError, match=r"^OUT must end in .*, not in '\.objj'; did you mean '\.obj'\?; name"
    ):
        output_of(tmp_path / "car.objj")
    with pytest.raises(UsageError, match=r"^--to must be .* or .*, not 'onj'; did you mean OBJ\?$"):
        output_named("onj")
    with pytest.raises(UsageError, match=r"not 'qqqqq'; choose one$"):
        output_named("qqqqq")


@pytest.mark.parametrize("name", ["x" * 300 + ".ply", "x" * 300])
def test_a_name_that_is_too_long_is_left_to_what_writes(tmp_path: Path, name: str) -> None:
    assert output_of(tmp_path / name).name == ("PLY" if name.endswith(".ply") else SCENE.name)


def test_a_scene_file_holds_everything_and_a_mesh_no_lights() -> None:
    assert SCENE.holds == WHOLE_SCENE
    meshes = {each.name for each in MESH_FORMATS}
    of_meshes = [each for each in outputs() if each.name in meshes]
    assert of_meshes
    for each in of_meshes:
        assert each.holds <= {*MESH_EXTRAS, "surfaces"}


def write_two(folder: Path, mesh: Mesh) -> None:
    (folder / "nodes").write_text(str(len(mesh.coordinates)))
    (folder / "polygons").write_text(str(len(mesh.node_numbers)))
    (folder / "scalars").mkdir()
    (folder / "scalars" / "1").write_text("")


def test_the_files_of_a_mesh_are_written_to_a_new_folder(tmp_path: Path) -> None:
    target = tmp_path / "out"
    assert write_folder(target, cube(), write_two, overwrite=False) == [
        target / "nodes",
        target / "polygons",
        target / "scalars" / "1",
    ]
    assert (target / "polygons").read_text() == "6"
    assert list(tmp_path.iterdir()) == [target]


def test_files_are_overwritten_only_where_that_is_allowed_and_others_stay(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "polygons").write_text("old")
    (tmp_path / "out" / "notes").write_text("mine")
    with pytest.raises(OutputError, match=r"must be new files, not .*polygons, which exists"):
        write_folder(tmp_path / "out", cube(), write_two, overwrite=False)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["notes", "polygons"]
    assert (tmp_path / "out" / "polygons").read_text() == "old"
    write_folder(tmp_path / "out", cube(), write_two, overwrite=True)
    assert (tmp_path / "out" / "polygons").read_text() == "6"
    assert (tmp_path / "out" / "notes").read_text() == "mine"


def test_a_failed_write_leaves_nothing(tmp_path: Path) -> None:
    def fail(folder: Path, mesh: Mesh) -> None:
        write_two(folder, mesh)
        raise OSError(28, "No space left on device")

    with pytest.raises(WriteError, match="must be written whole"):
        write_folder(tmp_path / "out", cube(), fail, overwrite=True)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_has_a_folder_to_be_in_and_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"must be in an existing folder, not .*none; create it"):
        write_folder(tmp_path / "none" / "out", cube(), write_two, overwrite=False)
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="must be a folder, not the file"):
        write_folder(tmp_path / "file", cube(), write_two, overwrite=True)


def test_a_folder_whose_name_is_too_long_cannot_be_made(tmp_path: Path) -> None:
    with pytest.raises(WriteError, match=r"could not be .*; make room or choose another place"):
        write_folder(tmp_path / ("x" * 300), cube(), lambda folder, mesh: None, overwrite=False)
    assert not list(tmp_path.iterdir())


def test_an_overwriting_that_is_cut_off_never_mixes_two_meshes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "out"
    target.mkdir()
    for name in ("nodes", "polygons"):
        (target / name).write_text("old")

    def cut_off(source: object, place: Path) -> None:
        (target / "nodes").write_text("new")
        raise OSError("cut off")

    monkeypatch.setattr("os.replace", cut_off)
    with pytest.raises(WriteError):
        write_folder(target, cube(), write_two, overwrite=True)
    assert [(path.name, path.read_text()) for path in target.iterdir() if path.is_file()] == [
        ("nodes", "new")
    ]


def colored() -> Scene:
    """A cube whose one surface has a color and a highlight of its own."""
    scene = scene_of(cube(), surfaces=[Surface("body")], parts={"cube": {"surface": "body"}})
    return scene.with_surface("body", object_color=(10, 20, 30), specular=0.25, exponent=7.5)


def test_surfaces_become_materials_that_read_back(tmp_path: Path) -> None:
    path = tmp_path / "box.obj"
    assert write_obj(path, colored(), False) == [path, tmp_path / "box.mtl"]
    again = read_scene(path, strict=True)
    assert again.mesh.part_names == ("cube",)
    (body,) = again.surfaces
    assert (body.name, body.paint.object_color) == ("body", (10, 20, 30))
    assert (body.reflectance.specular, body.reflectance.exponent) == (0.25, 7.5)


def test_a_mesh_whose_surface_was_created_has_no_library(tmp_path: Path) -> None:
    path = tmp_path / "box.obj"
    assert write_obj(path, scene_of(cube()), False) == [path]
    assert b"usemtl" not in path.read_bytes()


@pytest.mark.parametrize("existing", ["wall.obj", "wall.mtl"])
def test_neither_file_is_overwritten_unless_that_is_allowed(tmp_path: Path, existing: str) -> None:
    (tmp_path / existing).write_text("mine")
    with pytest.raises(OutputError, match="must be a new file"):
        write_obj(tmp_path / "wall.obj", colored(), False)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(existing, "mine")]
    write_obj(tmp_path / "wall.obj", colored(), True)
    assert len(list(tmp_path.iterdir())) == 2


def test_names_of_materials_are_readable_and_differ() -> None:
    assert material_names(["body", "a\nb", "a?b", ""]) == {
        "body": "body",
        "a\nb": "a?b",
        "a?b": "a?b 2",
        "": "surface",
    }


def test_what_a_library_does_not_hold_is_found_by_reading_it() -> None:
    scene = read_back = wall_scene()
    assert beyond_materials(read_back.surfaces) == [each.name for each in scene.surfaces]


NOTHING = OutputFormat("NOTHING", (), lambda path, scene, overwrite: [], frozenset())
MESH = cube().with_scalars(
    MeshScalar("stress", np.zeros(8)),
    MeshScalar("u", np.zeros(8)),
    MeshScalar("fault", np.zeros(6), "polygon"),
)


def test_a_scene_file_leaves_nothing_out() -> None:
    assert left_out(scene_of(MESH), SCENE, is_bare=False) == []


def test_scalars_are_named_where_a_format_has_none() -> None:
    assert left_out(scene_of(MESH), output_named("obj"), is_bare=True) == [
        "2 node scalars ('stress', 'u')",
        "1 polygon scalar ('fault')",
    ]


def test_of_a_bare_mesh_only_what_is_of_the_mesh_is_told() -> None:
    two = dataclasses.replace(MESH, part_names=("cube", "lid"), crease_angle=60)
    assert left_out(scene_of(two), NOTHING, is_bare=True) == [
        "2 parts ('cube', 'lid')",
        "2 node scalars ('stress', 'u')",
        "1 polygon scalar ('fault')",
        "the crease angle of 60 degrees",
    ]


def test_of_a_scene_its_surfaces_lights_view_and_settings_are_told() -> None:
    scene = scene_of(cube(), surfaces="parts").replace(background=(1, 2, 3))
    told = left_out(scene, NOTHING, is_bare=False)
    assert told[:3] == [
        "1 surface ('cube')",
        "4 lights ('key', 'fill', 'top', 'rim')",
        "the view",
    ]
    assert "'background'" in told[3]


def test_what_materials_do_not_hold_of_surfaces_is_told() -> None:
    scene = scene_of(cube(), surfaces="parts").with_surface("cube", diffuse=0.25)
    assert left_out(scene, output_named("OBJ"), is_bare=False)[0] == (
        "what a material does not have of 1 of 1 surfaces ('cube')"
    )


def test_many_names_are_cut() -> None:
    mesh = dataclasses.replace(cube(), part_names=("cube", *map(str, range(9))))
    assert left_out(scene_of(mesh), NOTHING, is_bare=True) == [
        "10 parts ('cube', '0', '1', '2', '3' and 5 more)"
    ]


@pytest.mark.parametrize(
    ("count", "text"),
    [
        (1, "'0'"),
        (4, "'0', '1', '2', '3'"),
        (5, "'0', '1', '2', '3', '4'"),
        (6, "'0', '1', '2', '3', '4' and 1 more"),
        (2005, "'0', '1', '2', '3', '4' and 2,000 more"),
    ],
)
def test_at_most_five_names_are_written_out(count: int, text: str) -> None:
    assert _named([str(number) for number in range(count)]) == text
