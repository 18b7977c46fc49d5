from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import write_palette
from tests.autocolor.commands.conftest import SMALL, Run, is_same

SAME = "autocolor: surface 'side' has these colors already; the recoloring changes nothing\n"


def settings(*texts: str) -> list[str]:
    return [part for text in texts for part in ("--set", text)]


def test_nothing_changed_gives_the_rendered_picture_byte_for_byte(saved: Path, run: Run) -> None:
    assert run("recolor", "scene.npz", "side") == (0, "", f"{SAME}wrote scene-side.png\n")
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
        ("--palette hot.gpl", ["ramp=#200,#f60,#fff"]),
        ("--set mapping=gamma --object navy", ["object_color=navy", "blend=0.6"]),
    ],
)
def test_a_recolored_picture_is_the_one_rendered_in_the_new_colors(
    saved: Path, run: Run, options: str, fields: list[str]
) -> None:
    write_palette("hot.gpl", ["#200", "#f60", "#fff"])
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
    assert run("recolor", "z.npz", *others).err == "wrote z-recolored.png\n"
    assert run("render", "scene", *SMALL, *shown, *others, "-o", "two.png").code == 0
    assert is_same("z-recolored.png", "two.png")
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
