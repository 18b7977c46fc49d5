from __future__ import annotations

import json
from pathlib import Path

import pytest

from autocolor import read_scene, render
from autocolor.explanation.text import WIDTH
from tests.autocolor.commands.conftest import Refused, Run


def test_a_pixel_is_explained_in_rows_of_a_terminal(folder: Path, run: Run) -> None:
    ran = run("explain", "scene", "240", "320")
    assert (ran.code, ran.err) == (0, "")
    rows = ran.out.splitlines()
    assert rows[0].split(maxsplit=1) == ["pixel", "line 240, element 320 of scene"]
    assert max(map(len, rows)) <= WIDTH
    assert {"node 1", "light", "intensity", "level", "word", "color"} <= {row[:13].strip() for row in rows}


def test_json_has_the_intensity_of_the_picture_with_its_settings_and_size(folder: Path, run: Run) -> None:
    ran = run("explain", "scene", "12", "16", "--size", "32x24", "--set", "ambient=0.5", "--json")
    assert (ran.code, ran.err) == (0, "")
    facts = json.loads(ran.out)
    intensity = render(read_scene("scene").replace(ambient=0.5), (32, 24)).intensity[12, 16]
    assert facts["ambient"] == 0.5
    assert facts["intensity"] == pytest.approx(float(intensity), rel=1e-5)
    assert sorted(light["name"] for light in facts["lights"]) == ["key", "key.2"]


@pytest.mark.parametrize("pixel", ["24 0", "0 32"])
def test_a_pixel_outside_of_the_picture_is_refused(pixel: str, refused: Refused) -> None:
    refused(f"explain scene {pixel} --size 32x24", 2)
