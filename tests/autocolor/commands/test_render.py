from __future__ import annotations

import errno
import os
import re
import shlex
import signal
import sys
from pathlib import Path

import click
import numpy as np
import pytest
from PIL import Image

from autocolor import Studio, demo, image, images, read_picture, read_scene, render, write_scene
from autocolor.commands.options import smooth_of
from autocolor.commands.render import render as command
from autocolor.images import SMOOTHNESS, SMOOTHNESSES
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import ROOT, Run


def pixels(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def test_a_bare_mesh_becomes_a_picture_of_its_name(folder: Path, run: Run) -> None:
    assert run("render", "two.obj") == (0, "", "wrote two.png\n")
    scene = read_scene("two.obj")
    assert (pixels(folder / "two.png") == image(scene, render(scene, smooth=2))).all()


def test_without_smooth_edges_a_picture_is_the_field_of_a_display(folder: Path, run: Run) -> None:
    assert run("render", "two.obj", "--smooth", "1") == (0, "", "wrote two.png\n")
    display = Ramtek9300()
    Studio(read_scene("two.obj"), display)
    assert (pixels(folder / "two.png") == display.field()).all()


def test_without_a_scene_the_demo_is_rendered(folder: Path, run: Run) -> None:
    assert run("render", "--size", "64x48", "--save", "new.npz") == (0, "", "wrote new.npz\n")
    assert run("render", "--size", "64x48") == (0, "", "wrote coupe.png\n")
    assert (pixels(folder / "coupe.png") == image(demo(), render(demo(), 48, 64, smooth=2))).all()
    assert read_picture("new.npz").scene.name == "coupe"
    assert run("render").code == 73


@pytest.mark.parametrize("smooth", [2, 3, 4])
def test_a_picture_with_smooth_edges_is_saved_and_recolored_with_them(
    folder: Path, run: Run, smooth: int
) -> None:
    common = ("--size", "90x60", "--smooth", str(smooth))
    assert run("render", "scene", *common, "-o", "a.png", "--save", "a.npz").code == 0
    scene = read_scene("scene")
    assert (pixels(folder / "a.png") == image(scene, render(scene, 60, 90, smooth=smooth))).all()
    picture = read_picture("a.npz").picture
    assert (picture.smooth, picture.lines, picture.elements) == (smooth, 60 * smooth, 90 * smooth)
    color = "surfaces.side.object_color=navy"
    assert run("recolor", "a.npz", "--set", color, "-o", "b.png", "--save", "b.npz").code == 0
    assert run("render", "scene", *common, "--set", color, "-o", "c.png").code == 0
    assert run("recolor", "b.npz", "side", "-o", "d.png").code == 0
    assert (folder / "b.png").read_bytes() == (folder / "c.png").read_bytes()
    assert (folder / "b.png").read_bytes() == (folder / "d.png").read_bytes()
    assert (folder / "b.png").read_bytes() != (folder / "a.png").read_bytes()


def test_the_smoothness_of_the_command_is_one_of_those_of_images() -> None:
    (option,) = [each for each in command.params if each.name == "smooth"]
    assert isinstance(option.type, click.Choice)
    assert [int(choice) for choice in option.type.choices] == list(SMOOTHNESSES)
    assert smooth_of(None, (3840, 2160)) == SMOOTHNESS
    assert smooth_of(None, (4096, 4096)) == 1
    assert smooth_of("4", (4096, 4096)) == 4


@pytest.mark.parametrize("smooth", ["5", "0", "x", "-1", "2.0", ""])
def test_an_impossible_smoothness_is_refused_in_a_sentence(folder: Path, run: Run, smooth: str) -> None:
    ran = run("render", "scene", "--smooth", smooth)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.endswith(f"Invalid value for '--smooth': {smooth!r} is not one of '1', '2', '3', '4'.\n")
    assert not (folder / "scene.png").exists()


def test_a_picture_that_is_too_large_with_smooth_edges_is_refused_with_its_own_size(
    folder: Path, run: Run
) -> None:
    assert run("render", "scene", "--size", "1600x1200", "--smooth", "4", "--limit", "0.5") == (
        65,
        "",
        "autocolor: a picture of 1600 x 1200 pixels, each the mean of 4 x 4, must take at most 2,000.0 MB of"
        " memory, not 2,949.2 MB; render fewer lines and elements, or with a smaller `smooth`, or allow it"
        " with --limit 0.8 (limit=0.8 in Python)\n",
    )


def test_a_folder_with_a_scene_becomes_a_picture_of_its_name(folder: Path, run: Run) -> None:
    assert run("render", "scene") == (0, "", "wrote scene.png\n")
    assert pixels(folder / "scene.png").shape == (480, 640, 3)


def test_an_output_in_another_folder_is_written_there_alone(folder: Path, run: Run) -> None:
    (folder / "out").mkdir()
    before = sorted(os.listdir(folder))
    assert run("render", "two.obj", "-o", "out/x.png").err == "wrote out/x.png\n"
    assert sorted(os.listdir(folder)) == before
    assert os.listdir(folder / "out") == ["x.png"]


def test_saving_alone_writes_no_png(folder: Path, run: Run) -> None:
    assert run("render", "two.obj", "--surfaces", "parts", "--save", "two.npz").err == "wrote two.npz\n"
    assert not (folder / "two.png").exists()
    picture, scene = read_picture("two.npz")
    assert picture.surfaces == ("front.low", "side")
    assert scene.name == "two"


def test_a_saved_picture_renders_as_its_scene(folder: Path, run: Run) -> None:
    run("render", "scene", "-o", "one.png", "--save", "two.npz")
    assert run("render", "two.npz", "-o", "two.png").code == 0
    assert (folder / "one.png").read_bytes() == (folder / "two.png").read_bytes()


def test_one_light_alone_is_the_scene_with_the_others_off(folder: Path, run: Run) -> None:
    assert run("render", "scene", "--light", "key", "-o", "one.png").code == 0
    assert run("render", "scene", "--set", "lights.key.2.on=false", "-o", "two.png").code == 0
    assert run("render", "scene", "--light", "key", "--light", "key.2", "-o", "both.png").code == 0
    assert run("render", "scene", "-o", "all.png").code == 0
    assert (folder / "one.png").read_bytes() == (folder / "two.png").read_bytes()
    assert (folder / "one.png").read_bytes() != (folder / "both.png").read_bytes()
    assert (folder / "all.png").read_bytes() == (folder / "both.png").read_bytes()


def test_a_named_view_is_rendered(folder: Path, run: Run) -> None:
    scene = read_scene("scene")
    write_scene(
        "scene", scene.with_view(angle=30).with_saved_view("tilted").replace(view=scene.view), overwrite=True
    )
    assert run("render", "scene", "--view", "tilted", "-o", "one.png").code == 0
    assert run("render", "scene", "--set", "view.angle=30", "-o", "two.png").code == 0
    assert run("render", "scene", "-o", "three.png").code == 0
    assert (folder / "one.png").read_bytes() == (folder / "two.png").read_bytes()
    assert (folder / "one.png").read_bytes() != (folder / "three.png").read_bytes()
    expected = "autocolor: there is no named view 'tited'; did you mean 'tilted'?\n"
    assert run("render", "scene", "--view", "tited") == (2, "", expected)
    assert "\nnamed views: tilted\n" in run("info", "scene").out


def test_a_picture_has_the_size_that_is_asked_for(folder: Path, run: Run) -> None:
    assert run("render", "scene", "--size", "90x60", "-o", "a.png", "--save", "a.npz").code == 0
    assert pixels(folder / "a.png").shape == (60, 90, 3)
    assert read_picture("a.npz").picture.intensity.shape == (2 * 60, 2 * 90)
    assert run("render", "scene", "--size", "90x60", "--hold-exposure", "-o", "b.png").code == 0
    assert (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()


def test_a_size_that_is_none_is_wrong_usage(folder: Path, run: Run) -> None:
    ran = run("render", "scene", "--size", "4097x10")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.endswith(
        "a size must be ELEMENTSxLINES, each from 1 to 4096, not '4097x10'; write it as in 1280x960\n"
    )
    assert not (folder / "scene.png").exists()


def test_an_unknown_light_is_told_the_nearest_right_name(folder: Path, run: Run) -> None:
    expected = "autocolor: there is no light 'kye'; did you mean 'key'?\n"
    assert run("render", "scene", "--light", "kye") == (2, "", expected)
    assert not (folder / "scene.png").exists()


def test_the_up_axis_turns_a_bare_mesh(folder: Path, run: Run) -> None:
    for up in "xyz":
        assert run("render", "two.obj", "--surfaces", "parts", "--up", up, "-o", f"{up}.png").code == 0
    pictures = {(folder / f"{up}.png").read_bytes() for up in "xyz"}
    assert len(pictures) == 3
    wrong = run("render", "two.obj", "--up", "w")
    assert wrong.code == 2
    assert "'x', 'y', 'z'" in wrong.err


def test_an_existing_output_is_kept_without_force(folder: Path, run: Run) -> None:
    for name, option in (("mine.png", "-o"), ("mine.npz", "--save")):
        (folder / name).write_bytes(b"mine")
        expected = (
            f"autocolor: an output must be a new file, not {name}, which exists; choose another name, or"
            " overwrite it with --force (overwrite=True in Python)\n"
        )
        assert run("render", "two.obj", option, name) == (73, "", expected)
        assert (folder / name).read_bytes() == b"mine"
        assert run("render", "two.obj", option, name, "--force").code == 0
        assert (folder / name).read_bytes() != b"mine"


def test_a_full_disk_leaves_what_was_there(folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "mine.png").write_bytes(b"mine")
    before = sorted(os.listdir(folder))

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    for arguments in (("-o", "mine.png", "--force"), ("-o", "new.png"), ("--save", "new.npz")):
        ran = run("render", "two.obj", *arguments)
        assert ran.code == 74
        assert "could not be (no space left on device)" in ran.err
    assert sorted(os.listdir(folder)) == before
    assert (folder / "mine.png").read_bytes() == b"mine"


def test_names_with_spaces_dashes_dots_and_foreign_letters_are_names(folder: Path, run: Run) -> None:
    for name in ("a b", "-x", ".hid", "купе é", "x" * 250, "--debug"):
        (folder / f"{name}.obj").write_bytes((folder / "two.obj").read_bytes())
        ran = run("render", "--", f"{name}.obj")
        assert ran.code == 0
        assert ran.err == f"wrote {name[:100]}.png\n"


def test_what_was_repaired_is_told_and_counts_under_strict(folder: Path, run: Run) -> None:
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\n")
    ran = run("render", "two.obj", "-o", "a.png")
    assert ran.code == 0
    assert ran.err.startswith("autocolor: two.obj")
    assert ran.err.endswith("\nwrote a.png\n")
    assert run("render", "two.obj", "-o", "b.png", "--strict").code == 1
    assert (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()


def test_problems_are_listed_each_on_a_line_of_its_own(folder: Path, run: Run) -> None:
    (folder / "scene" / "scene.toml").write_text(
        'ambient = -1\nscalling = "object"\n[[mesh]]\nfile = "no.obj"\n'
    )
    ran = run("render", "scene")
    assert ran.code == 65
    assert len(ran.err.splitlines()) == 3
    assert all(line.startswith("autocolor: scene.toml, line ") for line in ran.err.splitlines())
    assert "did you mean 'scaling'?" in ran.err


def test_a_broken_mesh_is_bad_input_and_one_that_is_not_there_is_missing(folder: Path, run: Run) -> None:
    (folder / "bad.obj").write_text("v 0 0\n")
    assert run("render", "bad.obj").code == 65
    expected = "autocolor: no.obj: there is no such file or folder; check the name\n"
    assert run("render", "no.obj") == (66, "", expected)
    assert run("render", "").code == 65
    assert run("render", "x" * 5000).code in (65, 66)


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_a_progress_bar_is_shown_on_a_terminal_alone(process: Run, run: Run, folder: Path) -> None:
    import pty

    outer, inner = pty.openpty()
    ran = process("render", "two.obj", stderr=inner)
    os.close(inner)
    shown = b""
    # The end of a terminal that nobody holds open is an error.
    while chunk := _read(outer):
        shown += chunk
    os.close(outer)
    assert ran.code == 0
    assert b"5/5" in shown
    assert shown.endswith(b"wrote two.png\r\n")
    assert run("render", "two.obj", "--force").err == "wrote two.png\n"


def _read(number: int) -> bytes:
    try:
        return os.read(number, 4096)
    except OSError:
        return b""


def test_a_terminated_render_leaves_the_old_picture_whole(process: Run, folder: Path) -> None:
    if os.name != "posix":
        pytest.skip("needs what POSIX says about signals")
    (folder / "two.png").write_bytes(b"mine")
    program = (
        "import os, signal, sys, autocolor.files.writing, autocolor.__main__ as m\n"
        "os.fsync = lambda number: os.kill(os.getpid(), signal.SIGKILL)\n"
        "sys.argv[1:] = ['render', 'two.obj', '--force']\n"
        "m.main()\n"
    )
    assert process(command=[sys.executable, "-c", program]).code == -signal.SIGKILL
    assert (folder / "two.png").read_bytes() == b"mine"


def test_with_the_exposure_held_one_light_alone_is_darker(folder: Path, run: Run) -> None:
    assert run("render", "scene", "--light", "key", "-o", "stretched.png").code == 0
    assert run("render", "scene", "--light", "key", "--hold-exposure", "-o", "held.png").code == 0
    assert run("render", "scene", "--hold-exposure", "-o", "all.png").code == 0
    assert run("render", "scene", "-o", "plain.png").code == 0
    held, stretched = pixels(folder / "held.png").astype(int), pixels(folder / "stretched.png").astype(int)
    assert (held <= stretched).all()
    assert held.sum() < 0.9 * stretched.sum()
    assert (folder / "all.png").read_bytes() == (folder / "plain.png").read_bytes()


CAR = """\
mtllib car.mtl
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 1 1 0
v 1 1 1
v 1 0 2
v 0 0 2
g front
usemtl red
f 1 2 3 4
usemtl glass
f 4 3 7 8
g side
usemtl rubber
f 2 5 6 3
"""
LIBRARY = """\
newmtl red
Kd 1 0 0
Ks 0
newmtl glass
Kd 0 0 1
Ks 0
newmtl rubber
Kd 0 1 0
Ks 0
"""


def test_a_mesh_is_rendered_in_the_colors_of_its_materials(folder: Path, run: Run) -> None:
    (folder / "car.obj").write_text(CAR)
    (folder / "car.mtl").write_text(LIBRARY)
    assert run("render", "car.obj", "--smooth", "1", "--save", "car.npz", "-o", "car.png") == (
        0,
        "",
        "wrote car.png\nwrote car.npz\n",
    )
    picture, scene = read_picture("car.npz")
    assert [(part.name, part.surface) for part in scene.parts] == [
        ("front", "red"),
        ("front glass", "glass"),
        ("side", "rubber"),
    ]
    assert picture.surfaces == ("red", "glass", "rubber")
    colors = pixels(folder / "car.png")
    # Each object color is of one component; no other is shown where the surface is seen.
    for number, component in ((1, 0), (2, 2), (3, 1)):
        seen = colors[picture.surface_number == number]
        assert len(seen)
        assert seen[:, component].any()
        assert not np.delete(seen, component, axis=1).any()


def test_surfaces_of_parts_come_before_those_of_materials_where_that_is_asked(folder: Path, run: Run) -> None:
    (folder / "car.obj").write_text(CAR)
    (folder / "car.mtl").write_text(LIBRARY)
    assert run("render", "car.obj", "--surfaces", "parts", "--save", "car.npz").code == 0
    assert read_picture("car.npz").picture.surfaces == ("front", "front glass", "side")
    setting = ("--set", "surfaces.front glass.object_color=#00ff00")
    assert run("render", "car.obj", "--surfaces", "parts", *setting).code == 0
    assert run("render", "car.obj", *setting, "--force").code == 2


def test_a_scene_file_gives_surfaces_before_the_materials_do(folder: Path, run: Run) -> None:
    (folder / "scene" / "two.obj").write_text(CAR)
    (folder / "scene" / "car.mtl").write_text(LIBRARY)
    (folder / "scene" / "scene.toml").write_text(
        '[[mesh]]\nfile = "two.obj"\n[parts.side]\nsurface = "body"\nstage = true\n'
        '[surfaces.body]\n[surfaces."front glass"]\n'
    )
    assert run("render", "scene", "--save", "scene.npz").code == 0
    scene = read_picture("scene.npz").scene
    assert [part.surface for part in scene.parts] == ["red", "front glass", "body"]
    assert [surface.name for surface in scene.surfaces] == ["body", "front glass", "red"]
    assert [part.stage for part in scene.parts] == [False, False, True]


def test_what_is_left_out_of_materials_is_told_and_counts_under_strict(folder: Path, run: Run) -> None:
    (folder / "car.obj").write_text(CAR)
    (folder / "car.mtl").write_text(LIBRARY + "map_Kd car.png\n")
    ran = run("render", "car.obj", "--strict")
    assert (ran.code, ran.out) == (1, "")
    assert ran.err == "autocolor: car.mtl: left out the textures of 1 material\nwrote car.png\n"


def test_words_that_stand_for_normals_are_asked_for_by_an_option_or_a_setting(folder: Path, run: Run) -> None:
    assert run("render", "scene", "--normals", "-o", "one.png").code == 0
    assert run("render", "scene", "--set", "words=normals", "-o", "two.png").code == 0
    assert run("render", "scene", "-o", "levels.png").code == 0
    assert (folder / "one.png").read_bytes() == (folder / "two.png").read_bytes()
    assert (pixels(folder / "one.png") != pixels(folder / "levels.png")).any()
    refused = run("render", "scene", "--set", "scalar.name=z", "--set", "words=normals", "-o", "three.png")
    assert refused.code == 2
    assert "words must be 'levels' where a scalar colors surfaces, not 'normals'" in refused.err


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
    assert ran.err.endswith("; take a smaller mesh or picture, or give the program more memory\n")
    assert not (folder / "scene.png").exists()


def test_layers_and_words_have_a_pixel_of_the_picture_each(folder: Path, run: Run) -> None:
    library = pytest.importorskip("OpenEXR")
    size = ("--size", "40x30")
    assert run("render", "scene", *size, "--save", "a.npz", "--smooth", "1").code == 0
    levels = [f"--set=surfaces.{name}.levels=50" for name in ("front.low", "side")]
    outputs = ("--layers", "a.exr", "--words", "w.png", "--indexed", "i.png")
    assert run("render", "a.npz", *size, *levels, *outputs) == (
        0,
        "",
        "wrote a.exr\nwrote w.png\nwrote i.png\n",
    )
    picture, scene = read_picture("a.npz")
    with library.File("a.exr", separate_channels=True) as file:
        assert (file.channels()["intensity.Y"].pixels == picture.intensity).all()
        assert {"key.diffuse.Y", "key_2.specular.Y"} <= file.channels().keys()
    with Image.open("w.png") as words:
        assert words.size == (40, 30)
    for name in ("front.low", "side"):
        scene = scene.with_surface(name, levels=50)
    assert (pixels(folder / "i.png") == image(scene, picture)).all()
    again = run("render", "scene", *size, "--smooth", "3", "--layers", "b.exr", "-o", "b.png")
    assert again.err == "wrote b.png\nwrote b.exr\n"
    with library.File("b.exr", separate_channels=True) as file:
        assert file.channels()["depth.Z"].pixels.shape == (90, 120)
    assert pixels(folder / "b.png").shape == (30, 40, 3)


def test_a_refused_indexed_png_leaves_no_other_output(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(images, "MOST_INDEXED", 5)
    ran = run("render", "scene", "--indexed", "i.png", "--words", "w.png", "-o", "o.png")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("autocolor: an indexed PNG must have at most 5 words in use, not ")
    assert not list(folder.glob("*.png"))


def test_layers_without_their_library_are_refused_before_any_work(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    ran = run("render", "scene", "--layers", "a.exr", "--save", "a.npz")
    assert (ran.code, ran.out) == (69, "")
    assert ran.err.endswith('run: pip install "OpenEXR>=3.5"\n')
    assert not (folder / "a.npz").exists()


def test_the_commands_and_the_python_of_the_page_on_layers_run(folder: Path, run: Run) -> None:
    pytest.importorskip("OpenEXR")
    pytest.importorskip("OpenImageIO")
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
            ran = run(*arguments)
            assert ran.code == 0, ran.err
    picture = read_picture("coupe.npz").picture
    hood = picture.part_number == 1 + picture.parts.index("hood")
    assert np.array_equal(np.asarray(names["mask"]), hood)
    assert hood.any()
    assert np.array_equal(np.asarray(names["colors"]), image(read_scene("scenes/coupe"), picture, smooth=1))
