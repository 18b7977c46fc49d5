from __future__ import annotations

import dataclasses
import itertools
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from autocolor import Mesh, Scene, UsageError, Variant, render
from autocolor.batches.outputs import DAMAGED, FORMS, base_mark, form_of, mark_in, mark_of, marked, paths_of
from autocolor.files.writing import write_atomically
from autocolor.scene.scalar import MeshScalar
from ramtek_emu.png import chunks
from tests.small import wall, wall_scene

MARK = "0123456789abcdef" * 4


@pytest.mark.parametrize(
    ("pattern", "path"),
    [
        ("out/{number:03}-{name}.png", "out/007-a_b.png"),
        ("{number}{number:1}{number:12}.png", "77000000000007.png"),
        ("{surfaces.wall.object_color}.png", "1f3f8f.png"),
        ("{surfaces.wall.light_color}-{lights.key.cone_angle}-{scaling}.png", "ffffff-none-surface.png"),
        ("{view.eye}.webp", "1,2,3.webp"),
        ("{{{name}}}.png", "{a_b}.png"),
        ("{lights.key.flaps.x.minimum}{lights.key.on}.png", "nonetrue.png"),
        ("plain.png", "plain.png"),
    ],
)
def test_a_pattern_gives_each_variant_a_name(pattern: str, path: str) -> None:
    variant = Variant("a/b", {"surfaces.wall.object_color": "#1f3f8f", "view.eye": [1, 2, 3]})
    others = [Variant(f"other {number}", {"view.eye": [number, 0, 0]}) for number in range(6)]
    if "{n" not in pattern:
        others = []
    expected = path if others else path.replace("007", "001")
    assert paths_of(pattern, wall_scene(), [*others, variant])[-1] == expected


def test_a_long_name_of_any_letters_is_cut_to_a_file(tmp_path: Path) -> None:
    for letter, count in (("x", 100), ("車", 66), ("🚗", 50), ("\ud800", 100)):
        (path,) = paths_of(tmp_path / "{name}.png", wall_scene(), [Variant(letter * 300, {})])
        letter = letter if letter.isprintable() else "_"
        assert Path(path).name == f"{letter * count}.png"
        write_atomically(path, b"", overwrite=False)


@given(st.text(min_size=1), st.text())
def test_no_name_and_no_value_leaves_the_folder_of_the_pattern(name: str, value: str) -> None:
    variant = Variant(name, {"mapping": value})
    (path,) = paths_of(Path("out") / "{name}{mapping}.png", wall_scene(), [variant])
    assert Path(path).parent == Path("out")
    assert path.endswith(".png")
    assert "\0" not in path


@pytest.mark.parametrize(
    ("pattern", "sentence"),
    [
        ("{nam}.png", "a field of a name pattern must be a key of the scene, not 'nam'; did you mean"),
        ("{surfaces.wal.blend}.png", "a field of a name pattern must be a key of the scene, not"),
        ("{name.png", "a name pattern must have each brace closed, not '{name.png'; double a brace"),
        ("name}.png", "a name pattern must have each brace closed"),
        ("{number:x}.png", "a name pattern must have each brace closed"),
        ("{name:03}.png", "a field of a name pattern must be a key of the scene, not 'name:03'; did you"),
        ("{}.png", "a field of a name pattern must be a key of the scene, not ''"),
        ("{lights.key.on.on}.png", "a field of a name pattern must be a key of the scene, not"),
        ("{view.eye.x}.png", "a field of a name pattern must be a key of the scene, not 'view.eye.x'"),
        (f"{{{'x' * 300}:3}}.png", "a field of a name pattern must be a key of the scene, not 'xxx"),
    ],
)
def test_a_wrong_pattern_is_refused(pattern: str, sentence: str) -> None:
    with pytest.raises(UsageError) as refused:
        paths_of(pattern, wall_scene(), [Variant("a", {})])
    assert str(refused.value).startswith(sentence)
    assert len(str(refused.value)) < 250


def test_the_suffix_gives_the_form_and_a_form_without_an_output_is_taken() -> None:
    assert (form_of("a/b.PNG", None), form_of(Path("b.webp"), "webp")) == ("png", "webp")
    assert (form_of(None, None), form_of(None, "png")) == ("array", "png")


@pytest.mark.parametrize(
    ("output", "form", "sentence"),
    [
        (
            "a.jpg",
            None,
            "the pictures of a batch must be written to files that end in .png or .webp, not to 'a.jpg'",
        ),
        ("a.png", "webp", "the form of pictures must be that of the output, 'png', not 'webp'; leave it out"),
        (None, "jpg", "the form of pictures must be 'array', 'png' or 'webp', not 'jpg'"),
    ],
)
def test_a_wrong_form_is_refused(output: str | None, form: str | None, sentence: str) -> None:
    with pytest.raises(UsageError) as refused:
        form_of(output, form)
    assert str(refused.value).startswith(sentence)


@pytest.mark.parametrize("form", FORMS)
@given(seed=st.integers(0, 99))
def test_a_file_has_its_colors_and_its_mark_and_no_part_of_it_has(
    tmp_path_factory: pytest.TempPathFactory, form: str, seed: int
) -> None:
    colors = np.random.default_rng(seed).integers(0, 256, (5, 7, 3), np.uint8)
    data = marked(form, colors, None, MARK)
    path = tmp_path_factory.mktemp("marks") / f"a.{form}"
    path.write_bytes(data)
    with Image.open(BytesIO(data)) as image:
        image.load()
        assert (np.asarray(image.convert("RGB")) == colors).all()
        if form == "png":
            assert image.info["autocolor"].startswith(MARK)
    assert mark_in(str(path), form) == MARK
    for end, mark in ((0, DAMAGED), (1, ""), (len(data) // 2, ""), (len(data) - 2, DAMAGED)):
        path.write_bytes(data[:end])
        # An empty file is what a power failure leaves.
        assert mark_in(str(path), form) == mark


@pytest.mark.parametrize("form", FORMS)
def test_a_file_with_any_other_byte_is_of_a_batch_and_has_not_its_mark(form: str, tmp_path: Path) -> None:
    path = tmp_path / "a"
    data = marked(form, np.random.default_rng(1).integers(0, 256, (5, 7, 3), np.uint8), None, MARK)
    for place, bit in itertools.product(range(len(data)), (1, 64)):
        path.write_bytes(data[:place] + bytes([data[place] ^ bit]) + data[place + 1 :])
        assert mark_in(str(path), form) not in ("", MARK)


def test_a_png_is_what_strangers_read_to_the_last_chunk(tmp_path: Path) -> None:
    data = marked("png", np.zeros((2, 3, 3), np.uint8), 9, MARK)
    assert [kind for kind, _ in chunks(data)] == [b"IHDR", b"IDAT", b"tEXt", b"IEND"]


def test_the_file_of_a_stranger_and_a_missing_file_have_no_mark(tmp_path: Path) -> None:
    Image.new("RGB", (3, 3)).save(tmp_path / "a.png")
    assert mark_in(str(tmp_path / "a.png"), "png") == ""
    assert mark_in(str(tmp_path / "b.png"), "png") == ""
    assert mark_in(str(tmp_path), "png") == ""


def moved(scene: Scene) -> Scene:
    mesh = scene.mesh
    nodes = mesh.coordinates + 1e-9
    return scene.replace(mesh=Mesh(nodes, mesh.node_numbers, mesh.part_numbers, mesh.part_names))


def stressed(*stress: float, name: str = "stress") -> Scene:
    """A wall with a scalar of its nodes, which colors it."""
    return wall_scene(wall().with_scalars(MeshScalar(name, np.array(stress)))).with_scalar(name="z")


@pytest.mark.parametrize(
    ("base", "changed"),
    [
        (wall_scene(), moved(wall_scene())),
        (wall_scene(), wall_scene().replace(ambient=0.5)),
        (wall_scene(), wall_scene(wall(2))),
        (stressed(1, 2, 3, 4), stressed(1, 2, 3, 5)),
        (stressed(1, 2, 3, 4), stressed(1, 2, 3, 4, name="load")),
        (stressed(1, 2, 3, 4), wall_scene().with_scalar(name="z")),
    ],
)
def test_a_change_of_mesh_scalar_or_table_changes_the_mark(base: Scene, changed: Scene) -> None:
    assert base_mark(base, None, ()) != base_mark(changed, None, ())
    pictures = [render(scene, (8, 6)) for scene in (base, base.replace(ambient=0.7), base.with_view(angle=9))]
    marks = {base_mark(base, picture, drawn) for picture in (None, *pictures) for drawn in ((), (1,))}
    assert len(marks) == 8


def test_the_mark_of_a_picture_has_the_values_of_its_scalar() -> None:
    scene = stressed(1, 2, 3, 4).with_scalar(name="stress")
    picture = render(scene, (8, 6))
    assert picture.scalar_values is not None
    other = dataclasses.replace(picture, scalar_values=picture.scalar_values + 1)
    assert base_mark(scene, picture, ()) != base_mark(scene, other, ())


def test_the_mark_leaves_out_the_columns_that_no_picture_shows() -> None:
    base = base_mark(wall_scene(), None, ())
    assert base == base_mark(wall_scene().replace(name="moved", front="x"), None, ())


def test_the_mark_of_a_variant_depends_on_its_settings_and_not_on_its_name() -> None:
    one = Variant("a", {"ambient": 0.1, "mapping": "gamma"})
    assert mark_of(MARK, one) == mark_of(MARK, Variant("b", {"mapping": "gamma", "ambient": 0.1}, 3))
    assert mark_of(MARK, one) != mark_of(MARK, Variant("a", {"ambient": 0.1}))
    assert mark_of(MARK, one) != mark_of(MARK[::-1], one)
