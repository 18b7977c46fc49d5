from __future__ import annotations

import errno
import os
import re
import shlex
import sys
from pathlib import Path

import click
import numpy as np
import pytest
from PIL import Image

from autocolor import Studio, demo, image, images, read_picture, read_scene, write_scene
from autocolor.commands.render import render as command
from autocolor.images import SMOOTHNESSES
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import ROOT, SMALL, Refused, Run, is_same, pixels


def test_a_bare_mesh_becomes_a_picture_of_its_name(folder: Path, run: Run) -> None:
    assert run("render", "two.obj") == (0, "", "wrote two.png\n")
    scene = read_scene("two.obj")
    assert (pixels("two.png") == image(scene)).all()


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


def test_one_light_alone_is_the_scene_with_the_others_off(folder: Path, run: Run) -> None:
    for name, options in (
        ("one", ("--light", "key")),
        ("two", ("--set", "lights.key.2.on=false")),
        ("both", ("--light", "key", "--light", "key.2")),
        ("held", ("--light", "key", "--hold-exposure")),
        ("all", ()),
    ):
        assert run("render", "scene", *SMALL, *options, "-o", f"{name}.png").code == 0
    assert is_same("one.png", "two.png")
    assert is_same("all.png", "both.png")
    assert not is_same("one.png", "both.png")
    # What the exposure of both lights shows of one is darker.
    dark, bright = pixels("held.png").astype(int), pixels("one.png").astype(int)
    assert (dark <= bright).all()
    assert dark.sum() < 0.9 * bright.sum()


def test_a_named_view_is_rendered(folder: Path, run: Run, refused: Refused) -> None:
    scene = read_scene("scene")
    scene = scene.with_view(angle=30).with_saved_view("tilted").replace(view=scene.view)
    write_scene("scene", scene, overwrite=True)
    for name, options in (
        ("one", ("--view", "tilted")),
        ("two", ("--set", "view.angle=30")),
        ("three", ()),
    ):
        assert run("render", "scene", *SMALL, *options, "-o", f"{name}.png").code == 0
    assert is_same("one.png", "two.png")
    assert not is_same("one.png", "three.png")
    refused("render scene --view tited", 2)
    assert "\nnamed views: tilted\n" in run("info", "scene").out


@pytest.mark.parametrize(
    ("line", "code", "sentence"),
    [
        *((f"scene --smooth {smooth}", 2, "Error: Invalid value for '--smooth'") for smooth in ("5", "x")),
        ("scene --size 4097x10", 2, "Error: Invalid value for '--size'"),
        ("two.obj --up w", 2, "Error: Invalid value for '--up'"),
        ("scene --light kye", 2, ""),
        ("two.obj --set ambiet=1", 2, ""),
        ("scene --set scalar.name=z --normals", 2, "--set: words must be 'levels' where a scalar"),
        ("scene --set scalar.name=z --set words=normals", 2, "--set: words must be 'levels'"),
        (
            "scene --size 1600x1200 --smooth 4 --limit 0.5",
            65,
            "a picture of 1600 x 1200 pixels, each the mean",
        ),
        ("scene -o missing/a.png", 73, ""),
        ("bad.obj", 65, ""),
        ("''", 65, ""),
    ],
)
def test_what_is_refused_writes_nothing(
    folder: Path, refused: Refused, line: str, code: int, sentence: str
) -> None:
    (folder / "bad.obj").write_text("v 0 0\n")
    assert refused(f"render {line}", code).startswith(sentence)


def test_a_full_disk_leaves_what_was_there(
    folder: Path, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "mine.png").write_bytes(b"mine")

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    for options in ("-o mine.png --force", "-o new.png", "--save new.npz"):
        assert "could not be (no space left on device)" in refused(
            f"render two.obj --size 32x24 {options}", 74
        )


@pytest.mark.parametrize("name", ["-x", ".hid é", "x" * 250])
def test_names_with_spaces_dashes_dots_and_foreign_letters_are_names(
    folder: Path, run: Run, name: str
) -> None:
    (folder / "two.obj").rename(folder / f"{name}.obj")
    assert run("render", *SMALL, "--", f"{name}.obj") == (0, "", f"wrote {name[:100]}.png\n")


def test_words_that_stand_for_normals_are_asked_for_by_an_option_or_a_setting(folder: Path, run: Run) -> None:
    for name, options in (
        ("one", ("--normals",)),
        ("two", ("--set", "words=normals")),
        ("levels", ()),
    ):
        assert run("render", "scene", *SMALL, *options, "-o", f"{name}.png").code == 0
    assert is_same("one.png", "two.png")
    assert (pixels("one.png") != pixels("levels.png")).any()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the limit of memory is Linux's")
def test_a_picture_too_large_for_the_memory_ends_with_what_was_being_done(folder: Path, process: Run) -> None:
    import resource

    ran = process(
        *("render", "scene", "--size", "4096x4096"),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (500 << 20, 500 << 20)),
    )
    assert (ran.code, ran.out) == (71, "")
    assert ran.err.startswith(
        "autocolor: memory must suffice, and it ran out (visible surfaces, 4096 x 4096: "
    )
    assert not (folder / "scene.png").exists()


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
