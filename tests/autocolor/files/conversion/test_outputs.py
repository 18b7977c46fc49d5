from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, read_scene, scene_of
from autocolor.errors import UsageError
from autocolor.files.conversion.output import Output
from autocolor.files.conversion.outputs import SCENE, output_named, output_of, outputs
from autocolor.files.meshes.formats import NODE_SCALARS, PARTS, POLYGON_SCALARS, mesh_formats
from autocolor.scene.scalars.mesh_scalars import NODE, MeshScalar

MESH_OUTPUTS = [each for each in outputs() if each.name in {known.name for known in mesh_formats()}]


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


def written(output: Output, folder: Path, overwrite: bool = False) -> Path:
    suffix = output.suffixes[0] if output.suffixes else ""
    path = folder / f"out{suffix}"
    files = output.write(path, scene_of(full_mesh(), surfaces="parts"), overwrite)
    assert all(file.is_file() for file in files)
    return path


@pytest.mark.parametrize("output", outputs(), ids=lambda output: output.name)
def test_what_is_written_reads_back_with_all_that_the_format_holds(output: Output, tmp_path: Path) -> None:
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
def test_each_format_is_that_of_what_it_writes(output: Output, tmp_path: Path) -> None:
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
