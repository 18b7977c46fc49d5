from __future__ import annotations

import os
from pathlib import Path

import pytest

from autocolor import read_palette, read_picture, render, write_palette, write_picture
from tests.autocolor.commands.conftest import Run
from tests.small import wall_scene


@pytest.fixture
def saved(folder: Path, run: Run) -> Path:
    """A saved picture of the scene, scene.npz, beside its picture scene.png."""
    assert run("render", "scene", "-o", "scene.png", "--save", "scene.npz").code == 0
    return folder / "scene.npz"


def test_nothing_changed_gives_the_rendered_picture_byte_for_byte(saved: Path, run: Run) -> None:
    assert run("recolor", "scene.npz", "side") == (0, "", "wrote scene-side.png\n")
    assert (saved.parent / "scene-side.png").read_bytes() == (saved.parent / "scene.png").read_bytes()


@pytest.mark.parametrize(
    ("options", "settings"),
    [
        (("--object", "#00ff80"), ("surfaces.side.object_color=#00ff80",)),
        (
            ("--source", "#ffe9c0", "--blend", "0"),
            ("surfaces.side.light_color=#ffe9c0", "surfaces.side.blend=0"),
        ),
        (
            ("--object-color", "#123456", "--light-color", "#ffe9c0", "--blend", "0"),
            (
                "surfaces.side.object_color=#123456",
                "surfaces.side.light_color=#ffe9c0",
                "surfaces.side.blend=0",
            ),
        ),
        (
            ("--object", "#123456", "--blend", "0.25", "--percentage", "50"),
            (
                "surfaces.side.object_color=#123456",
                "surfaces.side.blend=0.25",
                "surfaces.side.light_percentage=50",
            ),
        ),
        (("--ramp", "#200,#f60,#fff"), ("surfaces.side.ramp=#200,#f60,#fff",)),
        (("--ramp", "#200,#f60"), ('surfaces.side.ramp=["#200", "#ff6600"]',)),
        (("--ramp", "#200,#f60"), ("surfaces.side.ramp=[#200, #f60]",)),
    ],
)
def test_a_recolored_picture_is_the_one_rendered_in_the_new_colors(
    saved: Path, run: Run, options: tuple[str, ...], settings: tuple[str, ...]
) -> None:
    assert run("recolor", "scene.npz", "side", *options, "-o", "one.png").code == 0
    arguments = [part for setting in settings for part in ("--set", setting)]
    assert run("render", "scene", *arguments, "-o", "two.png").code == 0
    assert (saved.parent / "one.png").read_bytes() == (saved.parent / "two.png").read_bytes()
    assert (saved.parent / "one.png").read_bytes() != (saved.parent / "scene.png").read_bytes()


def test_colors_that_a_ramp_unsets_are_told_and_a_ramp_that_colors_unset(saved: Path, run: Run) -> None:
    ramp = ("recolor", "scene.npz", "side", "--ramp", "#200,#f60")
    told = "autocolor: side: the ramp replaces its two colors and their blend\n"
    assert run(*ramp, "--save", "hot.npz").err == f"{told}wrote hot.npz\n"
    assert run("recolor", "hot.npz", "side", "--ramp", "red,blue", "-o", "a.png").err == "wrote a.png\n"
    told = "autocolor: side: two colors and their blend replace its ramp\n"
    blend = ("recolor", "hot.npz", "side", "--blend", "0.5", "-o", "b.png")
    assert run(*blend).err == f"{told}wrote b.png\n"
    setting = ("--set", "surfaces.side.ramp=red,blue")
    vary = ("--vary", "surfaces.side.ramp=[red,navy]")
    for command in (
        ("render", "scene", *setting, "-o", "c.png"),
        ("recolor", "scene.npz", *setting, "-o", "d.png"),
        ("palette", "scene.npz", "side", *setting),
        ("palette", "scene", "side", *setting, "-o", "side.csv"),
        ("sweep", "scene.npz", *setting, *vary, "-o", "{name}.png"),
        ("sweep", "scene", *setting, *vary, "-o", "{name}-2.png"),
    ):
        assert run(*command).err.count("side: the ramp replaces") == 1, command


def test_the_mesh_is_not_needed(saved: Path, run: Run) -> None:
    for name in ("scene.toml", "two.obj"):
        (saved.parent / "scene" / name).unlink()
    assert run("recolor", "scene.npz", "side", "--object", "#00ff80").code == 0


def test_new_colors_are_kept_where_that_is_asked(saved: Path, run: Run) -> None:
    assert (
        run("recolor", "scene.npz", "side", "--object", "#00ff80", "--save", "new.npz").err
        == "wrote new.npz\n"
    )
    assert read_picture("new.npz").scene.surface("side").paint.object_color == (0, 255, 128)
    assert run("recolor", "new.npz", "side", "-o", "one.png").code == 0
    assert run("recolor", "scene.npz", "side", "--object", "#00ff80", "-o", "two.png").code == 0
    assert (saved.parent / "one.png").read_bytes() == (saved.parent / "two.png").read_bytes()


def test_a_picture_may_be_recolored_in_its_own_file(saved: Path, run: Run) -> None:
    before = saved.read_bytes()
    assert run("recolor", "scene.npz", "side", "--blend", "1", "--save", "scene.npz").code == 73
    assert saved.read_bytes() == before
    assert run("recolor", "scene.npz", "side", "--blend", "1", "--save", "scene.npz", "--force").code == 0
    assert read_picture(saved).scene.surface("side").paint.blend == 1


def test_the_surface_s_name_in_the_output_s_is_made_one_of_a_file(folder: Path, run: Run) -> None:
    scene = wall_scene(lights=[])
    surface = scene.surfaces[0].replace(name="a/b")
    part = scene.parts[0].replace(surface="a/b")
    scene = scene.replace(surfaces=(surface,), parts=(part,))
    write_picture("wall.npz", scene, render(scene))
    assert run("recolor", "wall.npz", "a/b").err == "wrote wall-b.png\n"


def test_pictures_of_another_size_keep_it(folder: Path, run: Run) -> None:
    from PIL import Image

    scene = wall_scene(lights=[], ambient=0.5)
    write_picture("wall.npz", scene, render(scene, 30, 50))
    assert run("recolor", "wall.npz", "wall").code == 0
    with Image.open("wall-wall.png") as image:
        assert image.size == (50, 30)


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (("scene.npz", "sid"), 2, "there is no surface 'sid'; did you mean 'side'?"),
        (("scene.npz", "side", "--object", "rde"), 2, "'rde'; did you mean 'red'?"),
        (("scene.npz", "side", "--blend", "2"), 2, "blend must be a number from 0 to 1, not 2.0"),
        (("scene.npz", "side", "--blend", "nan"), 2, "blend must be a number from 0 to 1, not nan"),
        (("scene.npz", "side", "--blend", "much"), 2, "'much' is not a valid float"),
        (("scene.npz", "side", "--percentage", "101"), 2, "light_percentage must be a number from 0 to 100"),
        (("scene.npz", "side", "--ramp", "#200,#g00"), 2, "ramp[2] must be"),
        (("scene.npz", "side", "--ramp", "#200"), 2, "ramp must be a list of 2 to 1024 colors, not '#200'"),
        (("scene.npz", "side", "--ramp", "#200,#f60", "--blend", "0"), 2, "ramp must stand without object_"),
        (("scene.npz",), 2, "recolor must have a SURFACE"),
        (("none.npz", "side"), 66, "none.npz: there is no such file or folder"),
        (("two.obj", "side"), 65, "two.obj: a picture file must be whole and as autocolor wrote it"),
        (("scene", "side"), 65, "scene: it must be a regular file, not a folder"),
        (("scene.npz", "side", "-o", "scene.png"), 73, "not scene.png, which exists"),
        (("scene.npz", "side", "-o", "new.gif"), 2, "-o must be the name of a PNG, not 'new.gif'"),
    ],
)
def test_what_is_refused_writes_nothing(
    saved: Path, run: Run, arguments: tuple[str, ...], code: int, sentence: str
) -> None:
    before = {path: (saved.parent / path).stat().st_mtime_ns for path in os.listdir(saved.parent)}
    ran = run("recolor", *arguments)
    assert ran.code == code
    assert sentence in ran.err
    assert ran.out == ""
    after = {path: (saved.parent / path).stat().st_mtime_ns for path in os.listdir(saved.parent)}
    assert after == before


def test_a_picture_cut_short_is_bad_input_and_old_files_stay(saved: Path, run: Run) -> None:
    whole = saved.read_bytes()
    (saved.parent / "out.png").write_bytes(b"mine")
    # Around each member's beginning and end, and at both ends of the file.
    starts = [place for place in range(len(whole)) if whole.startswith((b"PK", b"\x93NUMPY"), place)]
    assert len(starts) >= 19
    lengths = {0, 1, 2, len(whole) // 2, len(whole) - 1, len(whole) - 23}
    lengths |= {
        place + step for place in starts for step in (-1, 0, 1, 4, 10, 30) if place + step < len(whole)
    }
    for length in sorted(lengths):
        saved.write_bytes(whole[: max(0, length)])
        ran = run("recolor", "scene.npz", "side", "-o", "out.png", "--force")
        assert ran.code == 65
        assert ran.err.startswith("autocolor: scene.npz: a picture file must be whole")
    assert (saved.parent / "out.png").read_bytes() == b"mine"


def test_what_renders_nothing_is_set_in_a_saved_picture(saved: Path, run: Run) -> None:
    settings = ("--set", "surfaces.side.object_color=navy", "--set", "mapping=gamma")
    assert run("recolor", "scene.npz", *settings, "-o", "one.png").code == 0
    assert run("render", "scene", *settings, "-o", "two.png").code == 0
    assert (saved.parent / "one.png").read_bytes() == (saved.parent / "two.png").read_bytes()


def test_the_scale_limits_and_bands_of_a_scalar_are_set_in_a_saved_picture(saved: Path, run: Run) -> None:
    shown = ("--set", "scalar.name=z")
    assert run("render", "scene", *shown, "--save", "z.npz").code == 0
    settings = ("--set", "scalar.scale=turbo", "--set", "scalar.limits=[0,0.5]", "--set", "scalar.bands=5")
    assert run("recolor", "z.npz", *settings, "-o", "one.png").code == 0
    assert run("render", "scene", *shown, *settings, "-o", "two.png").code == 0
    assert (saved.parent / "one.png").read_bytes() == (saved.parent / "two.png").read_bytes()
    assert run("recolor", "z.npz", "side", "--object", "navy", "-o", "three.png").code == 0


@pytest.mark.parametrize("setting", ["ambient=0.5", "view.angle=10", "scalar.name=x"])
def test_what_would_render_again_is_refused(saved: Path, run: Run, setting: str) -> None:
    result = run("recolor", "scene.npz", "--set", setting)
    assert result.code == 2
    assert "a setting of a picture must need no rendering" in result.err


def test_colors_need_a_surface_and_nothing_at_all_is_refused(saved: Path, run: Run) -> None:
    for options in ((), ("--object", "navy"), ("--object", "navy", "--set", "mapping=gamma")):
        result = run("recolor", "scene.npz", *options)
        assert result.code == 2
        assert "recolor must have a SURFACE, or --set KEY=VALUE without colors" in result.err


@pytest.mark.parametrize("suffix", [".gpl", ".csv", ".act"])
def test_the_entries_of_a_range_come_back_from_a_palette_file(saved: Path, run: Run, suffix: str) -> None:
    levels = "surfaces.side.levels=200"
    assert run("recolor", "scene.npz", "--set", levels, "-o", "before.png", "--save", "few.npz").code == 0
    assert run("palette", "few.npz", "side", "-o", f"side{suffix}").code == 0
    assert run("recolor", "few.npz", "side", "--object", "lime", "-o", "other.png").code == 0
    again = ("few.npz", "side", "--palette", f"side{suffix}")
    assert run("recolor", *again, "-o", "after.png", "--save", "new.npz").code == 0
    before, other, after = [
        (saved.parent / f"{name}.png").read_bytes() for name in ("before", "other", "after")
    ]
    assert before == after != other
    assert run("palette", "new.npz", "side", "-o", f"again{suffix}").code == 0
    one, two = (read_palette(f"{name}{suffix}") for name in ("side", "again"))
    assert one == two
    assert len(one) == 200


def test_a_palette_of_few_colors_is_a_ramp_over_the_levels(saved: Path, run: Run) -> None:
    write_palette("hot.gpl", ["#200", "#f60", "#fff"], names=["low", "middle", "high"])
    assert run("recolor", "scene.npz", "side", "--palette", "hot.gpl", "--save", "hot.npz").code == 0
    ramp = read_picture("hot.npz").scene.surface("side").paint.ramp
    assert ramp == ((34, 0, 0), (255, 102, 0), (255, 255, 255))


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (
            ("side", "--palette", "one.csv"),
            65,
            "one.csv: a ramp must have 2 to 1,024 colors, not 1; use --object for a single color",
        ),
        (("side", "--palette", "many.csv"), 65, "colors, not 1,025; choose some of them"),
        (("side", "--palette", "no.gpl"), 66, "no.gpl: there is no such file"),
        (("side", "--palette", "one.csv", "--blend", "1"), 2, "--palette gives all colors of a surface;"),
        (("--palette", "one.csv"), 2, "recolor must have a SURFACE"),
    ],
)
def test_a_palette_that_is_no_ramp_is_refused(
    saved: Path, run: Run, arguments: tuple[str, ...], code: int, message: str
) -> None:
    write_palette("one.csv", ["red"])
    write_palette("many.csv", ["red"] * 1025)
    ran = run("recolor", "scene.npz", *arguments)
    assert (ran.code, ran.out) == (code, "")
    assert message in ran.err
