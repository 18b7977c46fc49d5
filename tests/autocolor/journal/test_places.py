"""Scenes that are opened from files, as they are and as they were, and files that may be saved to again."""

from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import InputError, Mesh, read_scene
from autocolor.files.paths import PACKAGE
from autocolor.files.stamps import stamp_of
from autocolor.journal.places import NO_STAMP, Source, checksum_of, opened, place_of
from autocolor.scene.columns import to_plain
from autocolor.scene.scalar import MeshScalar
from tests.small import car


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
    assert again.place.stamp == NO_STAMP
    assert opened(source, to_plain(again.scene.replace(ambient=0.75))).place.stamp
    # What the scene did not have then is not taken from the file.
    now = then.replace(front="x", stage="floor").with_scalar(name="z")
    autocolor.write_scene(source.path, now, overwrite=True)
    assert checksum_of(opened(source, to_plain(then), checksum_of(then)).scene) == checksum_of(then)


def test_a_scene_of_another_checksum_is_refused(source: Source) -> None:
    with pytest.raises(InputError) as refusal:
        opened(source, checksum="9f")
    assert str(refusal.value) == (
        f"{source.path} must hold the mesh that it held when it was opened, and it was changed since; bring"
        " the old file back"
    )


def test_the_checksum_is_that_of_all_values_and_scalars(source: Source) -> None:
    scene = read_scene(source.path)
    assert checksum_of(scene) == checksum_of(read_scene(source.path))
    assert checksum_of(scene) == checksum_of(scene.replace(exposure="auto"))
    mesh, heights = scene.mesh, scene.mesh.coordinates[:, 2]
    scalars = [MeshScalar("z", heights), MeshScalar("height", heights), MeshScalar("z", heights + 1)]
    others = [
        scene.replace(ambient=0.2),
        scene.replace(mesh=Mesh(mesh.coordinates * 2, mesh.node_numbers, mesh.part_numbers, mesh.part_names)),
        *(scene.replace(mesh=mesh.with_scalars(scalar)) for scalar in scalars),
    ]
    assert len({checksum_of(each) for each in (scene, *others)}) == 6


def test_a_scene_that_is_opened_again_shares_the_mesh_if_it_is_the_same(source: Source) -> None:
    present = read_scene(source.path)
    again = opened(source, known=[present])
    assert again.scene.equals(present)
    assert again.place.stamp == stamp_of(Path(source.path) / "scene.toml")
    mesh = present.mesh
    for other in (
        mesh.with_scalars(MeshScalar("z", mesh.coordinates[:, 2])),
        Mesh(mesh.coordinates + 1, mesh.node_numbers, mesh.part_numbers, mesh.part_names),
        Mesh(mesh.coordinates, mesh.node_numbers, mesh.part_numbers, mesh.part_names, crease_angle=1.0),
    ):
        assert opened(source, known=[present.replace(mesh=other)]).scene.mesh is not other


def test_meshes_and_files_of_the_package_have_no_stamp(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text("v 0 0 0\n")
    assert place_of(Source(str(tmp_path / "car.obj"))).stamp is None
    inside = PACKAGE / "examples" / "coupe" / "scene.toml"
    assert place_of(Source(str(inside))).stamp is None
    assert Path(autocolor.__file__).parent == PACKAGE


def test_a_path_that_cannot_be_read_has_no_stamp(tmp_path: Path) -> None:
    (tmp_path / "loop.toml").symlink_to(tmp_path / "loop.toml")
    for path in (str(tmp_path / "loop.toml"), "a\0.toml", "\ud800.toml", f"{'x' * 5000}.toml"):
        assert place_of(Source(path)).stamp is None
