from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Scene
from autocolor.files.scene_sources import read_scene_with_report
from autocolor.files.scenes.scene_text import scene_text
from tests.autocolor.linked_scenes import linked_scenes
from tests.autocolor.strategies import of_mesh

MESH = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\no {}\nf 1 2 3 4\no {}\nf 1 2 3\n"


def read_back(
    folder: Path, scene: Scene, mesh_files: tuple[dict[str, str], ...], without_defaults: bool = False
) -> Scene:
    text = scene_text(scene, mesh_files, without_defaults=without_defaults)
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    report = read_scene_with_report(folder)
    assert without_defaults or report.created == ()
    return report.scene


def same(one: Scene, other: Scene) -> bool:
    fields = {field.name for field in dataclasses.fields(Scene)} - {"mesh", "name"}
    arrays = ("coordinates", "node_numbers", "part_numbers")
    return (
        all(getattr(one, name) == getattr(other, name) for name in fields)
        and all(np.array_equal(getattr(one.mesh, name), getattr(other.mesh, name)) for name in arrays)
        and one.mesh.part_names == other.mesh.part_names
        and one.mesh.crease_angle == other.mesh.crease_angle
    )


@pytest.mark.parametrize("without_defaults", [False, True])
@given(drawn=linked_scenes(), up=st.sampled_from("xyz"))
def test_a_scene_that_was_written_reads_back_equal(
    without_defaults: bool, drawn: Scene, up: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    (folder / "car.obj").write_text(MESH.format(*drawn.mesh.part_names))
    mesh = read_scene_with_report(folder / "car.obj", up=up).scene.mesh
    angle = drawn.mesh.crease_angle
    scene = of_mesh(drawn, dataclasses.replace(mesh, crease_angle=angle))
    assert same(scene, read_back(folder, scene, ({"file": "car.obj", "up": up},), without_defaults))


@given(
    names=st.lists(
        # A backslash at the end of a line would continue it.
        st.text(min_size=1, max_size=20)
        .map(lambda name: name.strip().rstrip("\\").rstrip())
        .filter(lambda name: bool(name) and name.isprintable()),
        min_size=2,
        max_size=2,
        unique=True,
    )
)
def test_any_names_are_written(names: list[str], tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("scene")
    (folder / "car.obj").write_text(MESH.format(*names), encoding="utf-8")
    report = read_scene_with_report(folder / "car.obj")
    assert report.scene.mesh.part_names == tuple(names)
    assert same(report.scene, read_back(folder, report.scene, report.mesh_files))  # type: ignore[arg-type]


def test_what_was_created_is_written_out_and_read_back(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj", surfaces="parts")
    assert len(report.created) == 3
    text = scene_text(report.scene, report.mesh_files)
    for table in ("[view]", "[[mesh]]", "[parts.hood]", "[surfaces.roof]", "[[lights]]"):
        assert table in text
    (tmp_path / "scene.toml").write_text(text)
    assert same(report.scene, read_scene_with_report(tmp_path).scene)


def test_ends_of_flaps_that_are_nowhere_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj")
    scene = report.scene.with_light("key", flaps=Flaps(z=Flap(minimum=0.5), x=Flap(on=False)))
    text = scene_text(scene, report.mesh_files)
    assert "flaps.x = { on = false, edge_width = 0.0 }\n" in text
    assert "flaps.z = { minimum = 0.5, on = true, edge_width = 0.0 }\n" in text
    (tmp_path / "scene.toml").write_text(text)
    assert same(scene, read_scene_with_report(tmp_path).scene)


def test_half_spaces_have_a_line_each_and_links_are_lists(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj")
    scene = report.scene.with_light(
        "key",
        half_spaces={
            "left": {"point": (1, 0, 0), "direction": (1, 0, 0)},
            "a door": {"point": (0, 0, 0), "direction": (0, 1, 0), "edge_width": 0.5, "on": False},
        },
        flaps=Flaps(z=Flap(minimum=0.5)),
        only_parts=["hood"],
        except_surfaces=[],
        follows="eye",
    )
    text = scene_text(scene, report.mesh_files, without_defaults=True)
    assert (
        """
flaps.z = { minimum = 0.5 }
half_spaces."a door" = { point = [0.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], edge_width = 0.5, on = false }
half_spaces.left = { point = [1.0, 0.0, 0.0], direction = [1.0, 0.0, 0.0] }
follows = "eye"
except_surfaces = []
only_parts = ["hood"]
"""
        in text
    )
    whole = scene_text(scene, report.mesh_files)
    assert "direction = [1.0, 0.0, 0.0], edge_width = 0.0, carried = false, on = true }\n" in whole
