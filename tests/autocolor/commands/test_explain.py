from __future__ import annotations

import json
from pathlib import Path

import pytest

from autocolor import read_scene, render
from autocolor.explanation.text import WIDTH
from tests.autocolor.commands.conftest import Run


def test_a_pixel_is_explained_in_rows_of_a_terminal(folder: Path, run: Run) -> None:
    ran = run("explain", "scene", "240", "320")
    assert (ran.code, ran.err) == (0, "")
    rows = ran.out.splitlines()
    assert rows[0].split(maxsplit=1) == ["pixel", "line 240, element 320 of scene"]
    assert max(map(len, rows)) <= WIDTH
    assert {"node 1", "light", "intensity", "level", "word", "color"} <= {row[:13].strip() for row in rows}


def test_json_has_the_intensity_of_the_picture(folder: Path, run: Run) -> None:
    ran = run("explain", "scene", "240", "320", "--json")
    assert (ran.code, ran.err) == (0, "")
    facts = json.loads(ran.out)
    intensity = float(render(read_scene("scene")).intensity[240, 320])
    assert facts["intensity"] == pytest.approx(intensity, rel=1e-5)
    assert [light["name"] for light in facts["lights"]] != []


def test_settings_and_the_size_count(folder: Path, run: Run) -> None:
    ran = run("explain", "scene", "12", "16", "--size", "32x24", "--set", "ambient=0.5", "--json")
    facts = json.loads(ran.out)
    assert facts["ambient"] == 0.5
    scene = read_scene("scene").replace(ambient=0.5)
    assert facts["intensity"] == pytest.approx(float(render(scene, 24, 32).intensity[12, 16]), rel=1e-5)


def test_on_the_background_nothing_is_seen(folder: Path, run: Run) -> None:
    ran = run("explain", "scene", "0", "0")
    assert (ran.code, ran.err) == (0, "")
    assert "nothing: the background" in ran.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("480", "0"), "autocolor: a line must be 0 to 479, not 480; choose another"),
        (("0", "640"), "autocolor: an element must be 0 to 639, not 640; choose another"),
        (("0", "24", "--size", "24x24"), "autocolor: an element must be 0 to 23, not 24; choose another"),
    ],
)
def test_a_pixel_outside_of_the_picture_is_refused(
    arguments: tuple[str, ...], message: str, folder: Path, run: Run
) -> None:
    ran = run("explain", "scene", *arguments)
    assert (ran.code, ran.out, ran.err.splitlines()) == (2, "", [message])
