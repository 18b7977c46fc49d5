from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import autocolor
from ramtek_emu import Ramtek9300
from scenes import figure_04, figure_15, figures

EXPECTED = {
    "04": {"figure-04.png", "figure-04-a.png", "figure-04-b.png", "figure-04-c.png"},
    "06": {"figure-06.png"},
    "07": {"figure-07.png"},
    "08": {"figure-08.png", *(f"figure-08-{name}.png" for name in ("key", "side", "back", "rim"))},
    "09": {"figure-09.png", "figure-09-a.png", "figure-09-b.png", "figure-09-c.png"},
    "10": {"figure-10.png", "figure-10-a.png", "figure-10-b.png", "figure-10-c.png"},
    "15": {"figure-15.png", "figure-15-a.png", "figure-15-b.png", "figure-15-c.png"},
}


@pytest.mark.parametrize("number", figures.FIGURES)
def test_each_figure_leaves_its_labeled_pictures(
    number: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["figure", str(tmp_path / "made")])
    importlib.import_module(f"scenes.figure_{number}").main()
    made = {path.name for path in (tmp_path / "made").iterdir()}
    assert made == EXPECTED[number]
    assert {Path(line).name for line in capsys.readouterr().out.splitlines()} == made
    for name in made:
        with Image.open(tmp_path / "made" / name) as image:
            pixels = np.asarray(image.convert("RGB"))
        assert pixels.shape[0] % (480 + figures.CAPTION_LINES) == 0
        assert (pixels[480 : 480 + figures.CAPTION_LINES, :640] > 200).any(), "the caption is empty"


def brightest_of_plane(scene: autocolor.Scene) -> float:
    picture = autocolor.render(scene, 240, 320)
    return picture.ranges.surfaces["plane"].maximum


def test_aiming_the_light_at_the_pyramid_takes_the_bright_spot_off_the_plane() -> None:
    point = autocolor.read_scene(figures.SCENES / "pyramid")
    flood = point.with_light("lamp", aim=figure_04.SIDE, concentration=1)
    spot = flood.with_light("lamp", concentration=40)
    assert point.light("lamp").axis is None
    assert brightest_of_plane(flood) < 0.5 * brightest_of_plane(point)
    assert brightest_of_plane(spot) < 0.2 * brightest_of_plane(point)
    side = autocolor.render(spot, 240, 320).ranges.surfaces["pyramid"]
    assert side.maximum > 0.9 * autocolor.render(flood, 240, 320).ranges.surfaces["pyramid"].maximum


def test_the_lamp_of_figure_4_stands_half_as_high_as_the_pyramid() -> None:
    scene = autocolor.read_scene(figures.SCENES / "pyramid")
    height = scene.mesh.bounds[1][2] - scene.mesh.bounds[0][2]
    assert scene.light("lamp").position[2] == pytest.approx(height / 2)


def test_the_three_blends_of_figure_15_differ_only_in_the_body() -> None:
    display = Ramtek9300()
    studio = autocolor.Studio(autocolor.read_scene(figures.SCENES / "coupe"), display)
    words, written = display.words.copy(), display.frame_buffer.written
    fields = []
    for _, blend, _ in figure_15.PANELS:
        studio.recolor("body", **figure_15.COLORS, blend=blend)
        fields.append(display.field())
    assert display.frame_buffer.written == written
    assert (display.words == words).all()
    body = studio.picture.surface_number == studio.picture.surfaces.index("body") + 1
    for field in fields[1:]:
        differs = (field != fields[0]).any(axis=2)
        assert not differs[~body].any()
        assert differs[body].mean() > 0.5
