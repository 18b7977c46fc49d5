from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, InputError, Light, Scene, read_picture, render, write_picture
from autocolor.files.array_file import array_file_bytes, read_array_file
from autocolor.files.picture_file import PICTURE_FILE
from autocolor.files.plain_scene import plain_scene, scene_of_plain
from autocolor.scene.columns import keys_of
from autocolor.scene.surfaces import Paint, Reflectance, Surface
from tests.autocolor.linked_scenes import linked_scenes
from tests.autocolor.meshes import wall_scene

NESTED = (("reflectance", Reflectance), ("paint", Paint))


def read_again(values: object, scene: Scene) -> Scene:
    """The scene of the values, and of the arrays of a scene's mesh."""
    mesh = scene.mesh
    return scene_of_plain(values, mesh.coordinates, mesh.node_numbers, mesh.part_numbers, mesh.scalars)


def columns(scene: Scene) -> dict[str, Any]:
    """Everything of a scene but the arrays of its mesh."""
    described = (scene.mesh.part_names, scene.mesh.crease_angle)
    return {
        **{name: value for name, value in vars(scene).items() if name in keys_of(Scene)},
        "mesh": described,
    }


def nested(values: dict[str, Any]) -> dict[str, Any]:
    """The values as the first picture files had them: reflectance and paint as tables of a surface."""
    rows = []
    for surface in values["surfaces"]:
        row = dict(surface)
        for table, cls in NESTED:
            row[table] = {key: row.pop(key) for key in list(row) if key in keys_of(cls)}
        rows.append(row)
    return {**values, "surfaces": rows}


@given(linked_scenes())
def test_a_scene_comes_back_from_its_values_through_json(scene: Scene) -> None:
    text = json.dumps(plain_scene(scene), allow_nan=False)
    again = read_again(json.loads(text), scene)
    assert columns(again) == columns(scene)
    assert json.dumps(plain_scene(again), allow_nan=False) == text


@given(linked_scenes())
def test_the_values_of_the_first_picture_files_give_the_same_scene(scene: Scene) -> None:
    values = json.loads(json.dumps(plain_scene(scene)))
    old = nested(values)
    assert set(old["surfaces"][0]) <= {"name", "reflectance", "paint", "two_sided", "levels"}
    # Phong's model was the only one, and had no name.
    for surface in old["surfaces"]:
        if surface["reflectance"].get("model") == "phong":
            del surface["reflectance"]["model"]
    assert columns(read_again(old, scene)) == columns(scene)


@pytest.mark.parametrize("old", ["autocolor picture 1", "autocolor picture 2", "autocolor picture 3"])
def test_a_picture_file_of_an_older_format_is_still_read(tmp_path: Path, old: str) -> None:
    scene = wall_scene(ambient=0.5)
    picture = render(scene, 6, 8)
    write_picture(tmp_path / "new.npz", picture, scene)
    header, arrays = read_array_file(PICTURE_FILE, tmp_path / "new.npz")
    if old == "autocolor picture 3":
        header = {key: header[key] for key in (*PICTURE_FILE.keys, *PICTURE_FILE.series)}
    else:
        header = {key: header[key] for key in PICTURE_FILE.keys}
    del arrays["part_number"]
    older = dataclasses.replace(PICTURE_FILE, formats=(old,), added=frozenset())
    older = dataclasses.replace(older, arrays={name: PICTURE_FILE.arrays[name] for name in arrays})
    if old == "autocolor picture 1":
        header["scene"] = nested(header["scene"])
    (tmp_path / "old.npz").write_bytes(array_file_bytes(older, header, arrays))
    again = read_picture(tmp_path / "old.npz")
    assert columns(again.scene) == columns(scene)
    assert (again.picture.intensity == picture.intensity).all()
    assert (again.picture.surface_number == picture.surface_number).all()
    # It does not know its parts, also once it is written again.
    write_picture(tmp_path / "again.npz", again.picture, again.scene)
    for each in (again, read_picture(tmp_path / "again.npz")):
        assert each.picture.parts == ()
        assert each.picture.part_number.shape == (6, 8)
        assert not each.picture.part_number.any()


def test_what_is_absent_or_endless_is_left_out() -> None:
    lights = [Light("key", (0, -1, 0), flaps=Flaps(z=Flap(maximum=2.0)))]
    values = plain_scene(wall_scene(lights=lights))
    (light,) = values["lights"]
    assert light["flaps"] == {"z": {"maximum": 2.0, "on": True, "edge_width": 0.0}}
    assert not {"direction", "aim", "cone_angle"} & set(light)
    assert values["mesh"] == {"part_names": ("wall",), "crease_angle": 40.0}


@pytest.mark.parametrize("values", [None, [], "scene", 3, {}, {"mesh": None}, {"mesh": []}])
def test_what_is_no_scene_of_tables_is_refused(values: object) -> None:
    with pytest.raises(InputError, match="scene: it must be tables, its mesh among them, not "):
        read_again(values, wall_scene())


@pytest.mark.parametrize("table", ["parts", "surfaces", "lights", "view"])
def test_a_table_that_is_missing_is_named_and_not_created(table: str) -> None:
    values = plain_scene(wall_scene())
    del values[table]
    with pytest.raises(InputError, match=f"{table} must be .*, not missing; add it"):
        read_again(values, wall_scene())


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)


@given(key=st.sampled_from(sorted(plain_scene(wall_scene()))), value=JSON)
def test_any_value_of_any_table_gives_a_sound_scene_or_a_sentence(key: str, value: object) -> None:
    scene = wall_scene()
    try:
        again = read_again({**plain_scene(scene), key: value}, scene)
    except InputError as error:
        problems = error.problems
    else:
        problems = ()
        assert columns(read_again(plain_scene(again), again)) == columns(again)
    assert all(problem and "\n" not in problem for problem in problems)


def test_a_crease_angle_that_is_left_out_is_refused() -> None:
    values = plain_scene(wall_scene())
    values["mesh"] = {"part_names": ["wall"]}
    with pytest.raises(InputError, match="crease_angle must be a number from 0 to 180, not nan"):
        read_again(values, wall_scene())
    values["mesh"]["crease_angle"] = math.inf
    with pytest.raises(InputError, match="crease_angle"):
        read_again(values, wall_scene())


def test_wrong_arrays_are_refused_with_the_rules_of_a_mesh() -> None:
    scene = wall_scene()
    with pytest.raises(InputError, match="node"):
        scene_of_plain(plain_scene(scene), scene.mesh.coordinates, np.array([[0, 1, 9]]), np.array([0]))


def test_a_surface_of_another_model_keeps_its_parameters() -> None:
    surface = Surface("wall", Reflectance(0.5, 0.25, "cook-torrance"))
    scene = wall_scene().replace(surfaces=[surface])
    assert read_again(plain_scene(scene), scene).surfaces == (surface,)
