from __future__ import annotations

import os
import re
import shlex
import sys
from pathlib import Path

import click
import numpy as np
import pytest
from PIL import Image

from autocolor import MissingInputError, Studio, demo, image, images, read_picture, read_scene, write_scene
from autocolor.commands.render import render as command
from autocolor.images import SMOOTHNESSES
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import ROOT, SMALL, Refused, Run, is_same, pixels


def test_a_bare_mesh_becomes_a_picture_of_its_name(folder: Path, run: Run) -> None:
    assert run("render", "two.obj") == (0, "", "wrote two.png\n")
    scene = read_scene("two.obj")
    assert (pixels("two.png") == image(scene)).all()


def test_a_stage_is_a_key_of_the_scene_by_another_name(folder: Path, run: Run, refused: Refused) -> None:
    assert run("render", "two.obj", *SMALL, "--stage", "bowl", "--save", "bowl.npz").code == 0
    scene = read_scene("two.obj").replace(stage="bowl")
    assert (image(*read_picture("bowl.npz")) == image(scene, size=(32, 24), smooth=1)).all()
    sentence = refused("sweep bowl.npz --stage floor --vary ambient=0,1 -o {ambient}.png", 2)
    assert sentence == "--stage is for a scene, not for a picture file; leave it out"


def test_without_smooth_edges_a_picture_is_the_field_of_a_display(folder: Path, run: Run) -> None:
    assert run("render", "scene", "--smooth", "1") == (0, "", "wrote scene.png\n")
    display = Ramtek9300()
    Studio(read_scene("scene"), display)
    assert (pixels("scene.png") == display.field()).all()


def test_without_a_scene_the_demo_is_rendered(folder: Path, run: Run, refused: Refused) -> None:
    assert run("render", *SMALL, "--save", "new.npz") == (0, "", "wrote new.npz\n")
    assert run("render", "--size", "32x24") == (0, "", "wrote coupe.png\n")
    assert (pixels("coupe.png") == image(demo(), size=(32, 24))).all()
    assert read_picture("new.npz").scene.name == "coupe"
    refused("render", 73)


@pytest.mark.parametrize("smooth", [2, pytest.param(3, marks=pytest.mark.thorough), 4])
def test_a_picture_with_smooth_edges_is_saved_and_recolored_with_them(
    folder: Path, run: Run, smooth: int
) -> None:
    common = ("--size", "45x30", "--smooth", str(smooth))
    assert run("render", "scene", *common, "-o", "a.png", "--save", "a.npz").code == 0
    scene = read_scene("scene")
    assert (pixels("a.png") == image(scene, size=(45, 30), smooth=smooth)).all()
    picture = read_picture("a.npz").picture
    assert (picture.smooth, picture.lines, picture.elements) == (smooth, 30 * smooth, 45 * smooth)
    color = "surfaces.side.object_color=navy"
    assert run("recolor", "a.npz", "--set", color, "-o", "b.png", "--save", "b.npz").code == 0
    assert run("render", "scene", *common, "--set", color, "-o", "c.png").code == 0
    assert run("recolor", "b.npz", "side", "-o", "d.png").code == 0
    assert is_same("b.png", "c.png", "d.png")
    assert not is_same("b.png", "a.png")


def test_the_smoothness_of_the_command_is_one_of_those_of_images() -> None:
    (option,) = [each for each in command.params if each.name == "smooth"]
    assert isinstance(option.type, click.IntRange)
    assert (option.type.min, option.type.max) == (SMOOTHNESSES[0], SMOOTHNESSES[-1])


@pytest.mark.parametrize(
    ("options", "settings"),
    [
        ("--light key", "--set lights.key.2.on=false"),
        ("--view tilted", "--set view.angle=30"),
        ("--normals", "--set words=normals"),
    ],
)
def test_an_option_is_a_setting(folder: Path, run: Run, options: str, settings: str) -> None:
    scene = read_scene("scene")
    scene = scene.with_view(angle=30).with_saved_view("tilted").replace(view=scene.view)
    write_scene("scene", scene, overwrite=True)
    for name, each in (("one", options), ("two", settings), ("all", "--light key --light key.2")):
        assert run("render", "scene", *SMALL, *each.split(), "-o", f"{name}.png").code == 0
    assert is_same("one.png", "two.png")
    assert not is_same("one.png", "all.png")


def test_with_a_held_exposure_one_light_of_two_is_darker(folder: Path, run: Run) -> None:
    for name, options in (("held", ("--hold-exposure",)), ("auto", ())):
        assert run("render", "scene", *SMALL, "--light", "key", *options, "-o", f"{name}.png").code == 0
    dark, bright = pixels("held.png").astype(int), pixels("auto.png").astype(int)
    assert (dark <= bright).all()
    assert dark.sum() < 0.9 * bright.sum()


@pytest.mark.parametrize("name", ["-x", ".hid é", "x" * 250])
def test_names_with_spaces_dashes_dots_and_foreign_letters_are_names(
    folder: Path, run: Run, name: str
) -> None:
    (folder / "two.obj").rename(folder / f"{name}.obj")
    assert run("render", *SMALL, "--", f"{name}.obj") == (0, "", f"wrote {name[:100]}.png\n")


def test_a_demo_that_is_not_there_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("autocolor.files.paths.EXAMPLE_PLACES", (tmp_path,))
    with pytest.raises(MissingInputError, match="install autocolor again"):
        demo()


# Other outputs.


def test_words_have_a_pixel_of_the_picture_each(saved: Path, run: Run) -> None:
    levels = [f"--set=surfaces.{name}.levels=50" for name in ("front.low", "side")]
    # Neither option averages pixels, and so the picture file's pixels are computed again.
    outputs = ("--size", "32x24", "--words", "w.png", "--indexed", "i.png")
    assert run("render", "scene.npz", *levels, *outputs) == (0, "", "wrote w.png\nwrote i.png\n")
    scene, picture = read_picture(saved)
    with Image.open("w.png") as words:
        assert words.size == (32, 24)
    for name in ("front.low", "side"):
        scene = scene.with_surface(name, levels=50)
    assert (pixels("i.png") == image(scene, picture)).all()


@pytest.mark.needs("OpenEXR")
def test_layers_have_a_pixel_of_each_sample(saved: Path, run: Run) -> None:
    import OpenEXR

    assert run("render", "scene.npz", "--size", "32x24", "--layers", "a.exr").err == "wrote a.exr\n"
    with OpenEXR.File("a.exr", separate_channels=True) as file:
        assert (file.channels()["intensity.Y"].pixels == read_picture(saved).picture.intensity).all()
        assert {"key.diffuse.Y", "key_2.specular.Y"} <= file.channels().keys()
    again = run("render", "scene", "--size", "32x24", "--smooth", "3", "--layers", "b.exr", "-o", "b.png")
    assert again.err == "wrote b.png\nwrote b.exr\n"
    with OpenEXR.File("b.exr", separate_channels=True) as file:
        assert file.channels()["depth.Z"].pixels.shape == (72, 96)
    assert pixels("b.png").shape == (24, 32, 3)


def test_a_refused_indexed_png_leaves_no_other_output(
    refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(images, "MOST_INDEXED", 5)
    refused("render scene --size 32x24 --indexed i.png --words w.png -o o.png --save a.npz", 2)


def test_layers_without_their_library_are_refused_before_any_work(
    refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    assert 'pip install "OpenEXR>=3.5"' in refused("render scene --layers a.exr --save a.npz", 69)


@pytest.mark.thorough
@pytest.mark.needs("OpenEXR", "OpenImageIO")
def test_the_commands_and_the_python_of_the_page_on_layers_run(folder: Path, run: Run) -> None:
    os.rename("scene", "other")
    os.symlink(ROOT / "scenes", "scenes")
    text = (ROOT / "docs" / "LAYERS.md").read_text("utf-8")
    names: dict[str, object] = {}
    blocks = re.findall(r"^```(python)?\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    assert len(blocks) == 6
    for language, block in blocks:
        if language:
            exec(block, names)
            continue
        for line in block.splitlines():
            program, *arguments = shlex.split(line)
            assert program == "autocolor"
            assert run(*arguments).code == 0
    picture = read_picture("coupe.npz").picture
    hood = picture.part_number == 1 + picture.parts.index("hood")
    assert np.array_equal(np.asarray(names["mask"]), hood)
    assert hood.any()
    assert np.array_equal(np.asarray(names["colors"]), image(read_scene("scenes/coupe"), picture, smooth=1))
