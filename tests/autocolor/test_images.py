from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from PIL import Image

from autocolor import (
    InputError,
    OutputError,
    Scene,
    Studio,
    Surface,
    UsageError,
    image,
    render,
    save_image,
    scene_of,
    send_picture,
)
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import STRETCHED, cube, wall_scene
from tests.autocolor.sessions import SMALL, held, opened
from tests.autocolor.strategies import scenes


@given(scenes())
def test_the_colors_are_those_of_the_field_of_a_display_without_a_legend(scene: Scene) -> None:
    if scene.scalar is not None:
        scene = scene.with_scalar(legend=False)
    display = Ramtek9300()
    studio = Studio(scene, display)
    assert (image(scene, studio.picture) == display.field()).all()


def test_a_saved_image_has_the_legend_as_a_display_shows_it(tmp_path: Path) -> None:
    scene = scene_of(cube(), scalar={"name": "z"})
    display = Ramtek9300()
    studio = Studio(scene, display)
    path = tmp_path / "cube.png"
    save_image(path, scene, studio.picture)
    assert (np.asarray(Image.open(path)) == display.field()).all()
    assert (display.field() != image(scene, studio.picture)).any()
    assert studio._repr_png_() == display._repr_png_()


def test_a_picture_is_colored_by_any_scene_that_has_its_surfaces() -> None:
    scene = scene_of(cube(), surfaces="parts", **STRETCHED)
    picture = render(scene, 48, 64)
    blue = scene.with_surface("cube", object_color="#0000ff", light_color="#0000ff")
    assert image(scene, picture).shape == (48, 64, 3)
    colors = image(blue, picture)
    assert not colors[..., :2].any()
    assert colors[..., 2].max() == 255
    assert (colors[picture.surface_number == 0] == scene.background).all()


def test_an_image_is_written_as_a_png_and_never_over_a_file_unasked(tmp_path: Path) -> None:
    scene = scene_of(cube())
    picture = render(scene, 48, 64)
    path = tmp_path / "cube.png"
    save_image(path, scene, picture)
    assert (np.asarray(Image.open(path)) == image(scene, picture)).all()
    with pytest.raises(OutputError, match="exists"):
        save_image(path, scene, picture)
    save_image(path, scene, picture, overwrite=True)


def test_an_image_under_the_name_of_another_kind_is_refused(tmp_path: Path) -> None:
    scene = scene_of(cube())
    path = tmp_path / "cube.jpg"
    with pytest.raises(UsageError) as refusal:
        save_image(path, scene, render(scene, 48, 64))
    assert (
        str(refusal.value)
        == f"an image must be written to a file that ends in .png, not to {path}; rename it"
    )
    assert not path.exists()


def test_a_scene_and_a_picture_in_the_wrong_order_are_refused_in_words() -> None:
    scene = scene_of(cube())
    picture = render(scene, 24, 32)
    with pytest.raises(
        UsageError,
        match=r"a scene must be a Scene, not Picture\(.*; read a scene from files with `read_scene`",
    ):
        image(picture, scene)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match=r"a picture must be a Picture, not Scene\(.*; `render` makes one"):
        image(scene, scene)  # type: ignore[arg-type]


def test_a_picture_of_other_surfaces_is_refused() -> None:
    picture = render(scene_of(cube(), surfaces="parts"), 24, 32)
    other = scene_of(cube(), surfaces=[Surface("paint")], surface_of_part={"cube": "paint"})
    with pytest.raises(InputError, match=r"must be those of the scene, \['paint'\], not \['cube'\]"):
        image(other, picture)


def test_a_saved_picture_is_sent_without_rendering() -> None:
    studio, display = opened()
    other = Ramtek9300(SMALL)
    send_picture(studio.scene, studio.picture, other)
    assert held(other) == held(display)


def test_a_picture_of_other_surfaces_is_refused_and_leaves_the_display_as_it_was() -> None:
    studio, display = opened()
    before = held(display)
    other = scene_of(cube(), surfaces=[Surface("paint")], surface_of_part={"cube": "paint"})
    with pytest.raises(InputError, match="surfaces of a picture must be those of the scene"):
        send_picture(other, studio.picture, display)
    assert held(display) == before


def test_a_picture_larger_than_the_display_is_refused_and_a_smaller_one_is_shown_at_its_upper_left() -> None:
    scene = wall_scene()
    display = Ramtek9300(SMALL)
    lines, elements = SMALL.shown_lines, SMALL.shown_elements
    with pytest.raises(UsageError) as refusal:
        send_picture(scene, render(scene, lines, elements + 2), display)
    assert str(refusal.value) == (
        f"a picture must be at most {elements} x {lines}, as large as the display, not"
        f" {elements + 2} x {lines}; render it smaller, or take a larger configuration"
    )
    assert display.words_received == 0
    small = render(scene, lines // 2, elements // 2)
    send_picture(scene, small, display)
    shown = display.words != 0
    assert (shown[: lines // 2, : elements // 2] == (small.surface_number != 0)).all()
    assert shown.sum() == (small.surface_number != 0).sum()
