from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Studio, read_palette, read_picture, read_scene, write_palette
from autocolor.images import display_image
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import Run


@pytest.fixture
def saved(folder: Path, run: Run) -> Path:
    """A saved picture of the scene, of 64 x 48 pixels."""
    assert run("render", "scene", "--size", "64x48", "--smooth", "1", "--save", "scene.npz").code == 0
    return folder / "scene.npz"


@pytest.mark.parametrize("suffix", [".gpl", ".csv"])
def test_the_entries_of_a_picture_are_written_without_its_mesh(saved: Path, run: Run, suffix: str) -> None:
    (saved.parent / "scene" / "two.obj").unlink()
    assert run("palette", "scene.npz", "side", "-o", f"side{suffix}") == (0, "", f"wrote side{suffix}\n")
    picture, scene = read_picture(saved)
    image = display_image(scene, picture)
    first, levels = image.ranges["side"]
    assert np.array_equal(read_palette(f"side{suffix}").colors, image.entries[first : first + levels])


def test_the_entries_of_a_scene_are_those_of_the_display(folder: Path, run: Run) -> None:
    said = run("palette", "scene", "front.low", "--set", "surfaces.side.levels=3")
    assert said == (0, "", "wrote scene-front.low.gpl\n")
    display = Ramtek9300()
    studio = Studio(read_scene("scene").with_surface("side", levels=3), display)
    first, levels = studio.level_ranges["front.low"]
    entries = display.entries[first : first + levels]
    assert np.array_equal(read_palette("scene-front.low.gpl").colors, entries)
    assert run("palette", "scene", "side", "--set", "surfaces.side.levels=3", "-o", "side.act").code == 0
    assert len(read_palette("side.act")) == 3


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("sde",), 2, "there is no surface 'sde'; did you mean 'side'?"),
        (
            ("side", "-o", "side.png"),
            2,
            "side.png: a palette must end in .act, .csv or .gpl, not in '.png'; rename",
        ),
        (("side", "-o", "old.gpl"), 73, "an output must be a new file, not old.gpl, which exists;"),
        (("side", "--set", "view.angle=3"), 2, "--set: a setting of a picture must need no rendering"),
    ],
)
def test_what_cannot_be_written_is_refused(
    saved: Path, run: Run, arguments: tuple[str, ...], code: int, message: str
) -> None:
    write_palette("old.gpl", ["red"])
    ran = run("palette", "scene.npz", *arguments)
    assert (ran.code, ran.out) == (code, "")
    assert ran.err.startswith(f"autocolor: {message}")
    assert {path.name for path in saved.parent.iterdir()} == {"scene", "scene.npz", "two.obj", "old.gpl"}


def test_a_surface_that_no_part_has_has_no_levels(folder: Path, run: Run) -> None:
    scene = folder / "scene" / "scene.toml"
    scene.write_text(f"{scene.read_text()}[surfaces.spare]\n")
    ran = run("palette", "scene", "spare")
    assert ran.code == 2
    assert ran.err == (
        "autocolor: surface 'spare' has no levels, because no part has it; choose 'front.low' or 'side'\n"
    )
