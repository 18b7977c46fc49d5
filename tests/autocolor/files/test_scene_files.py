from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import Any

import pytest

from autocolor import InputError, Mesh, Surface, View
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_files import MOST_LISTED, Openable, kind_of, openables_of, stays_within
from autocolor.files.scene_report import scene_report
from autocolor.scene.defaults import created_surface
from tests.small import cube, wall_scene


def test_what_can_be_opened_is_listed_in_natural_order_with_folders_last(tmp_path: Path) -> None:
    files = "car10.obj car2.obj Car3.OBJ notes.txt .hidden.obj lights.toml a.npz a.db b.GPL d.csv"
    for name in files.split():
        (tmp_path / name).write_text("")
    for name in ("b", "a scene", "a mesh", ".git"):
        (tmp_path / name).mkdir()
    (tmp_path / "a scene" / "scene.toml").write_text("")
    for name in ("nodes.csv", "polygons.csv"):
        (tmp_path / "a mesh" / name).write_text("")
    assert [(path.name, kind) for path, kind in openables_of(tmp_path)] == [
        ("a mesh", "mesh"),
        ("a scene", "scene"),
        ("a.db", "store"),
        ("a.npz", "picture"),
        ("b.GPL", "paints"),
        ("car2.obj", "mesh"),
        ("Car3.OBJ", "mesh"),
        ("car10.obj", "mesh"),
        ("lights.toml", "scene"),
        ("b", "folder"),
    ]


def test_no_more_than_some_names_are_looked_at(tmp_path: Path) -> None:
    for number in range(MOST_LISTED + 5):
        (tmp_path / f"{number}.obj").touch()
    assert len(openables_of(tmp_path)) == MOST_LISTED


@pytest.mark.parametrize("missing", ["gone", "file.obj"])
def test_a_folder_that_cannot_be_read_is_refused(tmp_path: Path, missing: str) -> None:
    (tmp_path / "file.obj").write_text("")
    with pytest.raises(
        InputError, match=rf"^{missing}: a folder must be readable, and is not \(.+\); choose"
    ):
        openables_of(tmp_path / missing)


def test_what_is_no_regular_file_cannot_be_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.obj")
    (tmp_path / "broken.obj").symlink_to(tmp_path / "gone.obj")
    assert kind_of(tmp_path / "pipe.obj") == kind_of(tmp_path / "broken.obj") == ""
    assert kind_of(tmp_path / ("long" * 100 + ".obj")) == kind_of(tmp_path / "gone.obj") == ""
    assert openables_of(tmp_path) == []


def test_links_are_followed_before_a_path_is_within_a_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    (inside / "a").mkdir(parents=True)
    outside.mkdir()
    (outside / "car.obj").touch()
    (inside / "link.obj").symlink_to(outside / "car.obj")
    (inside / "up").symlink_to(tmp_path)
    (inside / "to a").symlink_to(inside / "a")
    assert stays_within(inside, inside)
    assert stays_within(inside / "to a", inside)
    assert stays_within(inside / "a" / ".." / "a", inside)
    for path in ("link.obj", "up", "..", "a/../..", "up/outside/car.obj", "up/inside/../outside"):
        assert not stays_within(inside / path, inside), path


def test_a_folder_whose_scene_file_is_a_link_out_is_not_within(tmp_path: Path) -> None:
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    for name in ("scene", "mesh"):
        (inside / name).mkdir(parents=True)
    outside.mkdir()
    for name in ("scene.toml", "nodes.csv", "polygons.csv"):
        (outside / name).touch()
    (inside / "scene" / "scene.toml").symlink_to(outside / "scene.toml")
    (inside / "mesh" / "nodes.csv").symlink_to(outside / "nodes.csv")
    (inside / "mesh" / "polygons.csv").symlink_to(outside / "polygons.csv")
    assert openables_of(inside) == [
        Openable(inside / "mesh", "mesh"),
        Openable(inside / "scene", "scene"),
    ]
    assert not stays_within(inside / "scene", inside)
    assert not stays_within(inside / "mesh", inside)


VIEW = View((0, -4, 0), target=(0, 0, 0))


def read(mesh: Mesh, **fields: Any) -> list[MeshReport]:
    """That one mesh was read."""
    return [MeshReport(mesh, **fields)]


def mesh_of(parts: int) -> Mesh:
    """A cube and more parts, named 0, 1 and so on, the others without polygons."""
    return dataclasses.replace(cube(), part_names=tuple(map(str, range(parts))))


def created(parts: int = 1, **fields: Any) -> tuple[str, ...]:
    """What is said to be created where only a view and no lights are given, unless `fields` say otherwise."""
    given = {"view": VIEW, "lights": (), "surfaces": "parts", **fields}
    return scene_report(read(mesh_of(parts)), **given).created


def test_of_a_bare_mesh_everything_is_created_and_said() -> None:
    report = scene_report(read(cube()))
    assert report.created == (
        "a view was created that frames the object",
        "4 studio lights were created",
        "surface 'surface' was created",
    )
    assert (report.is_view_created, report.are_lights_created) == (True, True)


def test_nothing_is_said_of_what_was_given() -> None:
    fields: dict[str, Any] = {"view": VIEW, "lights": (), "surfaces": [Surface("cube")]}
    report = scene_report(read(cube()), mesh_files=({"file": "car.obj"},), **fields)
    assert (report.created, report.mesh_files) == ((), ({"file": "car.obj"},))
    assert (report.is_view_created, report.are_lights_created) == (False, False)
    assert (report.scene.view, report.scene.lights) == (VIEW, ())


def test_a_list_of_many_surfaces_is_cut_and_says_how_many_more() -> None:
    names = ", ".join(f"'{part}'" for part in range(12))
    assert created(parts=12) == (f"12 surfaces were created: {names}",)
    assert created(parts=14) == (f"14 surfaces were created: {names} and 2 more",)


def test_a_part_that_shares_a_surface_as_asked_is_not_counted() -> None:
    shared = {str(part): "0" for part in range(300)}
    assert created(parts=300, surface_of_part=shared) == ("surface '0' was created",)
    assert created(parts=300)[-1] == "46 parts share surface '254', because a scene has at most 255"


def test_of_parts_and_materials_of_several_meshes_the_first_count() -> None:
    red, blue = Surface("red"), Surface("red", two_sided=False)
    reports = [
        *read(wall_scene().mesh, material_of_part={"wall": "red"}, materials=(red,)),
        *read(wall_scene().mesh, material_of_part={"wall": "glass"}, materials=(blue,)),
        *read(cube(), material_of_part={"cube": "red"}),
    ]
    report = scene_report(reports, view=VIEW, lights=())
    assert [part.surface for part in report.scene.parts] == ["red", "red"]
    assert report.scene.surfaces == (red,)
    assert report.created == ("surface 'red' was created",)


def test_materials_of_one_name_that_differ_are_kept_apart() -> None:
    def report(part: str, color: tuple[int, int, int]) -> MeshReport:
        material = created_surface("Material", color)
        mesh = dataclasses.replace(cube(), part_names=(part,))
        return MeshReport(mesh, material_of_part={part: "Material"}, materials=(material,))

    read = [report("hood", (255, 0, 0)), report("door", (0, 0, 255)), report("roof", (255, 0, 0))]
    scene = scene_report(read).scene
    assert [part.surface for part in scene.parts] == ["Material", "Material 2", "Material"]
    assert [surface.paint.object_color for surface in scene.surfaces] == [(255, 0, 0), (0, 0, 255)]


def test_a_part_of_several_meshes_has_the_first_material_and_the_others_are_told() -> None:
    read = [
        MeshReport(cube(), ("one", "two")),
        MeshReport(cube(), ("three",), material_of_part={"cube": "red"}),
        MeshReport(cube(), material_of_part={"cube": "blue"}),
    ]
    report = scene_report(read)
    assert report.scene.parts[0].surface == "red"
    assert report.repairs == (
        "one",
        "two",
        "three",
        "part 'cube' is in several meshes: it has material 'red'",
    )
