from __future__ import annotations

import dataclasses
from contextlib import suppress
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, Scene, read_scene, scene_of
from autocolor.errors import OutputError, UsageError
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
    write_obj,
)
from autocolor.files.formats import (
    DOUBLES,
    MESH_EXTRAS,
    MESH_FORMATS,
    NODE_SCALARS,
    PARTS,
    POLYGON_SCALARS,
    QUADS,
)
from autocolor.scene.scalar import NODE, MeshScalar
from autocolor.scene.surfaces import Surface
from tests.kills import Killed, killed, steps
from tests.small import cube, wall_scene

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
    as_held = mesh.coordinates if DOUBLES in output.holds else mesh.coordinates.astype(np.float32)
    # A format without node numbers has its nodes in another order.
    assert sorted(again.coordinates.tolist()) == sorted(as_held.tolist())
    assert np.array_equal(again.node_numbers, mesh.node_numbers) == (QUADS in output.holds)
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


def colored(size: float = 1.0) -> Scene:
    """A cube whose one surface has a color and a highlight of its own."""
    scene = scene_of(cube(size), surfaces=[Surface("body")], parts={"cube": {"surface": "body"}})
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


def test_a_save_that_is_killed_mixes_no_surfaces_of_the_old_and_the_new_library(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("os.fsync", lambda _: None)
    path = tmp_path / "wall.obj"
    old, new = colored(), colored(2.0).with_surface("body", object_color=(1, 2, 3))
    read = []
    for number in count():
        write_obj(path, old, True)
        with suppress(Killed), steps(number, killed) as done:
            write_obj(path, new, True)
        scene = read_scene(path)
        read.append((scene.mesh.coordinates.max(), scene.surfaces[0].paint.object_color))
        if len(done) < number:
            break
    before, after = (1, (10, 20, 30)), (2, (1, 2, 3))
    assert read == [before] * read.count(before) + [after] * read.count(after)
    assert read[0] == before
    assert read[-1] == after
    assert len(list(tmp_path.glob("wall.*"))) == 2


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
        "6 quads (each is written as two triangles)",
        "the crease angle of 60 degrees",
    ]


def test_of_a_scene_its_surfaces_lights_view_and_settings_are_told() -> None:
    scene = scene_of(cube(), surfaces="parts").replace(background=(1, 2, 3))
    told = left_out(scene, NOTHING, is_bare=False)[1:]
    assert told[:3] == [
        "1 surface ('cube')",
        "4 lights ('key', 'fill', 'top', 'rim')",
        "the view",
    ]
    assert told[3] == "7 settings ('ambient', 'scaling', 'mapping', 'contrast', 'exposure' and 2 more)"


def test_what_materials_do_not_hold_of_surfaces_is_told() -> None:
    scene = scene_of(cube(), surfaces="parts").with_surface("cube", diffuse=0.25)
    assert left_out(scene, output_named("OBJ"), is_bare=False)[0] == (
        "what a material does not have of 1 of 1 surfaces ('cube')"
    )


def test_many_names_are_cut() -> None:
    mesh = dataclasses.replace(cube(), part_names=("cube", *map(str, range(9))))
    assert left_out(scene_of(mesh), NOTHING, is_bare=True) == [
        "10 parts ('cube', '0', '1', '2', '3' and 5 more)",
        "6 quads (each is written as two triangles)",
    ]


def test_quads_and_digits_are_counted_where_a_format_has_none() -> None:
    assert left_out(scene_of(full_mesh()), output_named("stl"), is_bare=True) == [
        "2 parts ('hood', 'roof')",
        "1 node scalar ('stress')",
        "1 polygon scalar ('fault')",
        "1 quad (each is written as two triangles)",
        "the double precision of 1 node (rounded to single)",
    ]
    triangle = Mesh(np.eye(3) / 4, np.array([[0, 1, 2]]))
    assert left_out(scene_of(triangle), output_named("stl"), is_bare=True) == []


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
