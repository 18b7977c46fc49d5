from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Scene, read_palette, render, write_palette, write_picture
from tests.autocolor.commands.conftest import SMALL, Refused, Run, is_same
from tests.small import wall_scene
from tests.tables import first


def settings(*texts: str) -> list[str]:
    return [part for text in texts for part in ("--set", text)]


def test_nothing_changed_gives_the_rendered_picture_byte_for_byte(saved: Path, run: Run) -> None:
    assert run("recolor", "scene.npz", "side") == (0, "", "wrote scene-side.png\n")
    assert is_same("scene-side.png", "scene.png")


@pytest.mark.parametrize(
    ("options", "fields"),
    [
        ("--object #00ff80", ["object_color=#00ff80"]),
        ("--source #ffe9c0 --blend 0", ["light_color=#ffe9c0", "blend=0"]),
        (
            "--object-color #123456 --light-color #ffe9c0 --blend 0.25 --percentage 50",
            ["object_color=#123456", "light_color=#ffe9c0", "blend=0.25", "light_percentage=50"],
        ),
        ("--ramp #200,#f60,#fff", ["ramp=#200,#f60,#fff"]),
        ("--set mapping=gamma --object navy", ["object_color=navy", "blend=0.6"]),
    ],
)
def test_a_recolored_picture_is_the_one_rendered_in_the_new_colors(
    saved: Path, run: Run, options: str, fields: list[str]
) -> None:
    (saved.parent / "scene" / "two.obj").rename("two")
    assert run("recolor", "scene.npz", "side", *options.split(), "-o", "one.png").code == 0
    Path("two").rename(saved.parent / "scene" / "two.obj")
    rest = settings("mapping=gamma") if "gamma" in options else []
    same = settings(*(f"surfaces.side.{field}" for field in fields))
    assert run("render", "scene", *SMALL, *rest, *same, "-o", "two.png").code == 0
    assert is_same("one.png", "two.png")
    assert not is_same("one.png", "scene.png")


def test_the_scale_limits_and_bands_of_a_scalar_are_set_in_a_saved_picture(saved: Path, run: Run) -> None:
    shown = settings("scalar.name=z")
    assert run("render", "scene", *SMALL, *shown, "--save", "z.npz").code == 0
    others = settings("scalar.scale=turbo", "scalar.limits=[0,0.5]", "scalar.bands=5")
    assert run("recolor", "z.npz", *others, "-o", "one.png").code == 0
    assert run("render", "scene", *SMALL, *shown, *others, "-o", "two.png").code == 0
    assert is_same("one.png", "two.png")
    assert run("recolor", "z.npz", "side", "--object", "navy", "-o", "three.png").code == 0


RAMP = "autocolor: side: the ramp replaces its two colors and their blend\n"
COLORS = "autocolor: side: two colors and their blend replace its ramp\n"


def test_colors_that_a_ramp_unsets_are_told_and_a_ramp_that_colors_unset(saved: Path, run: Run) -> None:
    ran = run("recolor", "scene.npz", "side", "--ramp", "#200,#f60", "--save", "hot.npz")
    assert ran.err == f"{RAMP}wrote hot.npz\n"
    assert run("recolor", "hot.npz", "side", "--ramp", "red,blue", "-o", "a.png").err == "wrote a.png\n"
    ran = run("recolor", "hot.npz", "side", "--blend", "0.5", "-o", "b.png")
    assert ran.err == f"{COLORS}wrote b.png\n"


@pytest.mark.parametrize(
    "line",
    [
        "render scene --size 32x24",
        "recolor scene.npz",
        "palette scene.npz side",
        "palette scene side",
        "sweep scene.npz --vary surfaces.side.ramp=[red,navy] -o {name}.png",
        "sweep scene --size 32x24 --vary surfaces.side.ramp=[red,navy] -o {name}.png",
        "animate scene.npz --vary surfaces.side.ramp=[red,navy],[red,white] --frames 2 -o a.webp",
        "page scene.npz --vary surfaces.side.ramp=[red,navy]",
    ],
)
def test_every_command_with_settings_tells_once_what_a_ramp_unsets(saved: Path, run: Run, line: str) -> None:
    (saved.parent / "scene.png").unlink()
    ran = run(*line.split(), "--set", "surfaces.side.ramp=red,blue")
    assert (ran.code, ran.err.count(RAMP)) == (0, 1)


def named(name: str) -> Scene:
    """A wall whose surface has a name."""
    scene = wall_scene(lights=[])
    parts = (scene.parts[0].replace(surface=name),)
    return scene.replace(surfaces=(scene.surfaces[0].replace(name=name),), parts=parts)


def test_the_surface_s_name_in_the_output_s_is_made_one_of_a_file(folder: Path, run: Run) -> None:
    scene = named("a/b")
    write_picture("wall.npz", scene, render(scene, (32, 24)))
    assert run("recolor", "wall.npz", "a/b").err == "wrote wall-b.png\n"
    assert run("recolor", "wall.npz", *settings("mapping=gamma")).err == "wrote wall-recolored.png\n"


NO_SURFACE = (
    "recolor must have a SURFACE, or --set KEY=VALUE without colors; write it as in recolor PICTURE body"
    " --object navy"
)
RENDERS = (
    "--set: a setting of a picture must need no rendering, such as colors, the mapping, or limits and bands"
    " of a scalar; use it with `autocolor render`"
)


@pytest.mark.parametrize(
    ("line", "code", "sentence"),
    [
        ("scene.npz", 2, NO_SURFACE),
        ("scene.npz --object navy --set mapping=gamma", 2, NO_SURFACE),
        ("scene.npz --palette one.csv --set mapping=gamma", 2, NO_SURFACE),
        ("scene.npz --set ambient=0.5", 2, RENDERS),
        ("scene.npz --set scalar.name=x", 2, RENDERS),
        (
            "scene.npz side --palette one.csv --blend 1",
            2,
            "--palette gives all colors of a surface; leave the other options of colors out",
        ),
        (
            "scene.npz side --palette one.csv",
            65,
            "one.csv: a ramp must have 2 to 1,024 colors, not 1; use --object for a single color",
        ),
        (
            "scene.npz side --palette many.csv",
            65,
            "many.csv: a ramp must have 2 to 1,024 colors, not 1,025; choose some of them",
        ),
        ("scene.npz side --palette no.gpl", 66, ""),
        ("scene.npz sid", 2, ""),
        ("scene.npz side --blend much", 2, ""),
        ("scene.npz side --ramp #200,#f60 --blend 0", 2, ""),
        ("two.obj side", 65, ""),
        ("scene.npz side -o new.gif", 2, ""),
    ],
)
def test_what_is_refused_writes_nothing(
    saved: Path, refused: Refused, line: str, code: int, sentence: str
) -> None:
    write_palette("one.csv", ["red"])
    write_palette("many.csv", ["red"] * 1025)
    assert refused(f"recolor {line}", code).startswith(sentence)


@pytest.mark.parametrize("suffix", first(1, [".gpl", ".csv"]))
def test_the_entries_of_a_range_come_back_from_a_palette_file(saved: Path, run: Run, suffix: str) -> None:
    levels = settings("surfaces.side.levels=200")
    assert run("recolor", "scene.npz", *levels, "-o", "before.png", "--save", "few.npz").code == 0
    assert run("palette", "few.npz", "side", "-o", f"side{suffix}").code == 0
    assert run("recolor", "few.npz", "side", "--object", "lime", "-o", "other.png").code == 0
    again = ("few.npz", "side", "--palette", f"side{suffix}")
    assert run("recolor", *again, "-o", "after.png", "--save", "new.npz").code == 0
    assert is_same("before.png", "after.png")
    assert not is_same("after.png", "other.png")
    assert run("palette", "new.npz", "side", "-o", f"again{suffix}").code == 0
    one, two = (read_palette(f"{name}{suffix}") for name in ("side", "again"))
    assert one == two
    assert len(one) == 200
