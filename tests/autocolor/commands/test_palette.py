from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Studio, read_palette, read_picture, read_scene
from autocolor.images import display_image
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import Refused, Run


@pytest.mark.parametrize("suffix", [".gpl", ".csv"])
def test_the_entries_of_a_picture_are_written_without_its_mesh(saved: Path, run: Run, suffix: str) -> None:
    (saved.parent / "scene" / "two.obj").unlink()
    assert run("palette", "scene.npz", "side", "-o", f"side{suffix}") == (0, "", f"wrote side{suffix}\n")
    scene, picture = read_picture(saved)
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


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("spare", "surface 'spare' has no levels, because no part has it; choose 'front.low' or 'side'"),
        ("sde", ""),
        ("side -o side.png", ""),
    ],
)
def test_what_cannot_be_written_is_refused(folder: Path, refused: Refused, line: str, sentence: str) -> None:
    scene = folder / "scene" / "scene.toml"
    scene.write_text(f"{scene.read_text()}[surfaces.spare]\n")
    assert refused(f"palette scene {line}", 2).startswith(sentence)
