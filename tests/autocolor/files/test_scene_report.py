from __future__ import annotations

import dataclasses
from typing import Any

from autocolor import Mesh, View
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_report import scene_report
from autocolor.scene.defaults import created_surface
from tests.small import cube

VIEW = View((0, -4, 0), target=(0, 0, 0))


def mesh_of(parts: int) -> Mesh:
    """A cube and more parts, named 0, 1 and so on, the others without polygons."""
    return dataclasses.replace(cube(), part_names=tuple(map(str, range(parts))))


def created(parts: int = 1, **fields: Any) -> tuple[str, ...]:
    """What is said to be created where only a view and no lights are given, unless `fields` say otherwise."""
    given = {"view": VIEW, "lights": (), "surfaces": "parts", **fields}
    return scene_report([MeshReport(mesh_of(parts))], **given).created


def test_a_list_of_many_surfaces_is_cut_and_says_how_many_more() -> None:
    names = ", ".join(f"'{part}'" for part in range(12))
    assert created(parts=12) == (f"12 surfaces were created: {names}",)
    assert created(parts=14) == (f"14 surfaces were created: {names} and 2 more",)

    # A part that shares a surface as asked is not counted.
    shared = {str(part): "0" for part in range(300)}
    assert created(parts=300, surface_of_part=shared) == ("surface '0' was created",)
    assert created(parts=300)[-1] == "46 parts share surface '254', because a scene has at most 255"


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
