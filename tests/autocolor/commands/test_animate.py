from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import image, read_scene, render
from autocolor.files.settings import scene_with
from tests.autocolor.commands.conftest import SMALL, Refused, Run
from tests.ramtek_emu.film_reader import decoded

PAINT = "surfaces.side.object_color"


def test_lists_run_together_and_a_loop_comes_back(folder: Path, run: Run) -> None:
    varies = ("--vary", f"{PAINT}=red,blue,red", "--vary", "background=black,white,black")
    ran = run("animate", "scene", *varies, "--frames", "4", *SMALL, "-o", "a.webp")
    assert ran == (0, "", "wrote a.webp, 4 frames\n")
    scene = read_scene("scene")
    expected = [("red", "#000000"), ("#800080", "#808080"), ("blue", "#ffffff"), ("#800080", "#808080")]
    for shown, (paint, background) in zip(decoded("a.webp"), expected, strict=True):
        frame = scene_with(scene, {PAINT: paint, "background": background})
        assert np.array_equal(shown, image(frame, render(frame, (32, 24))))


def test_a_picture_file_cycles_its_colors_without_its_mesh(saved: Path, run: Run, refused: Refused) -> None:
    for name in ("scene.toml", "two.obj"):
        (saved.parent / "scene" / name).unlink()
    ran = run("animate", "scene.npz", "--vary", f"{PAINT}=red,blue", "--frames", "5", "-o", "cycle.ramtek")
    assert ran == (0, "", "wrote cycle.ramtek, 5 frames\n")
    refused("animate scene.npz --vary view.angle=0,9 --frames 5 -o cycle.ramtek --force", 65)
    assert refused("animate scene.npz --turn 9 --normals -o a.webp", 2) == (
        "--normals is for a scene, not for a picture file; leave it out"
    )


@pytest.mark.parametrize("source", ["scene", "scene.npz"])
def test_with_a_held_exposure_less_light_is_darker(saved: Path, run: Run, source: str) -> None:
    """In a picture file, whose light stays, another mapping of all intensities is held instead."""
    for name, options in (("auto.webp", ()), ("held.webp", ("--hold-exposure",))):
        vary = "lights.key.intensity=1,0.2" if source == "scene" else "mapping=linear,gamma"
        size = SMALL if source == "scene" else ()
        ran = run("animate", source, "--vary", vary, *options, "--frames", "2", *size, "-o", name)
        assert ran.code == 0
    (bright, same), (first, dark) = (decoded(name) for name in ("auto.webp", "held.webp"))
    assert np.array_equal(bright, first)
    assert dark.mean() < 0.9 * same.mean() if source == "scene" else np.array_equal(dark, same)
