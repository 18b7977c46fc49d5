"""Scenes that are opened, and opened again as they were then."""

from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import InputError, Mesh, read_scene
from autocolor.journal.opening import checksum_of, is_same_mesh, opened, opened_again
from autocolor.journal.places import Source, stamp_of
from autocolor.scene.columns import to_plain
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.sessions import car


@pytest.fixture
def source(tmp_path: Path) -> Source:
    autocolor.write_scene(tmp_path / "car", car())
    return Source(str(tmp_path / "car"))


def test_a_scene_is_opened_with_the_stamp_of_its_file(source: Source) -> None:
    scene, place = opened(source)
    assert checksum_of(scene) == checksum_of(read_scene(source.path))
    assert place.source == source
    assert place.stamp == stamp_of(Path(source.path) / "scene.toml")


def test_a_scene_that_was_saved_over_is_opened_as_it_was_and_not_saved_there_again(source: Source) -> None:
    then = opened(source).scene
    autocolor.write_scene(source.path, then.replace(ambient=0.75), overwrite=True)
    again = opened(source, to_plain(then), checksum_of(then))
    assert checksum_of(again.scene) == checksum_of(then)
    assert again.place.stamp is None
    assert opened(source, to_plain(again.scene.replace(ambient=0.75))).place.stamp is not None


def test_a_scene_of_another_checksum_is_refused(source: Source) -> None:
    with pytest.raises(InputError) as refusal:
        opened(source, checksum="9f")
    assert str(refusal.value) == (
        f"{source.path} must hold the mesh that it held when it was opened, and it was changed since; bring"
        " the old file back"
    )


def test_the_checksum_has_the_scalars_of_the_mesh(source: Source) -> None:
    scene = read_scene(source.path)
    heights = scene.mesh.coordinates[:, 2]
    scalars = [MeshScalar("z", heights), MeshScalar("height", heights), MeshScalar("z", heights + 1)]
    sums = {checksum_of(scene.replace(mesh=scene.mesh.with_scalars(scalar))) for scalar in scalars}
    assert len({checksum_of(scene), *sums}) == 4


def test_a_scene_that_is_opened_again_shares_the_mesh_if_it_is_the_same(source: Source) -> None:
    present = read_scene(source.path)
    again = opened_again(source, present)
    assert again.scene.equals(present)
    assert again.place.stamp == stamp_of(Path(source.path) / "scene.toml")
    mesh = present.mesh
    for other in (
        mesh.with_scalars(MeshScalar("z", mesh.coordinates[:, 2])),
        Mesh(mesh.coordinates + 1, mesh.node_numbers, mesh.part_numbers, mesh.part_names),
        Mesh(mesh.coordinates, mesh.node_numbers, mesh.part_numbers, mesh.part_names, crease_angle=1.0),
    ):
        assert not is_same_mesh(other, mesh)
        assert opened_again(source, present.replace(mesh=other)).scene.mesh is not other
