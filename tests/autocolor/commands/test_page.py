from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from autocolor import read_picture, save_page
from tests.autocolor.commands.conftest import SMALL, Refused, Run, is_same


def picture_in(path: str) -> Any:
    """The exported picture of a page."""
    match = re.search(
        r'<script id="picture" type="application/json">(.*?)</script>', Path(path).read_text("utf-8")
    )
    assert match is not None
    return json.loads(match[1])


def test_a_picture_becomes_a_page_without_its_mesh(saved: Path, run: Run) -> None:
    (saved.parent / "scene" / "two.obj").unlink()
    assert run("page", "scene.npz") == (0, "", "wrote scene.html\n")
    scene, picture = read_picture(saved)
    save_page("python.html", scene, picture)
    assert is_same("scene.html", "python.html")
    values = picture_in("scene.html")
    assert (values["name"], values["lines"], values["elements"]) == ("scene", 24, 32)
    assert values["lights"] is None


def test_a_scene_is_rendered_with_smooth_edges(folder: Path, run: Run) -> None:
    color = ("--set", "surfaces.side.object_color=red")
    assert run("page", "scene", "--size", "64x48", *color, "-o", "a.html") == (0, "", "wrote a.html\n")
    values = picture_in("a.html")
    assert (values["lines"], values["elements"], values["smooth"]) == (96, 128, 2)
    assert values["surfaces"][1]["paint"]["object_color"] == "#ff0000"
    assert run("page", "two.obj", *SMALL).code == 0
    assert picture_in("two.html")["lines"] == 24


def test_a_scene_that_is_too_large_for_samples_has_none(
    folder: Path, run: Run, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("exported", "page"):
        monkeypatch.setattr(f"autocolor.web.{module}.LARGEST_CANVAS", 4 * 32 * 24)
    for size, smooth in (("32x24", 2), ("64x48", 1)):
        assert run("page", "scene", "--size", size, "--force").code == 0
        assert picture_in("scene.html")["smooth"] == smooth
    refused("page scene --size 64x48 --smooth 2 -o a.html", 65)


def test_a_page_has_lights_and_variants(saved: Path, run: Run) -> None:
    Path("looks.csv").write_text(
        "name,surfaces.side.object_color,lights.key.intensity\nracing,#b01020,\nevening,navy,0.5\n"
    )
    arguments = ("--table", "looks.csv", "--vary", "surfaces.side.blend=0.5,1", "--lights")
    assert run("page", "scene.npz", *arguments) == (0, "", "wrote scene.html\n")
    values = picture_in("scene.html")
    assert [row["name"] for row in values["lights"]["rows"]] == ["key", "key.2"]
    assert [variant["name"] for variant in values["variants"]] == [
        "racing-0.5", "racing-1", "evening-0.5", "evening-1",
    ]  # fmt: skip
    assert values["variants"][3] == {
        "name": "evening-1",
        "values": {
            "surfaces.side.object_color": "#000080",
            "surfaces.side.blend": 1.0,
            "lights.key.intensity": 0.5,
        },
    }


def test_a_page_turns_and_has_an_image_beside_it(folder: Path, run: Run) -> None:
    address = "https://example.com/scene.html"
    written = "wrote scene.html\nwrote scene.png\n"
    assert run("page", "scene", *SMALL, "--views", "3", "--link", address) == (0, "", written)
    values = picture_in("scene.html")
    assert [view["name"] for view in values["views"]] == ["0°", "120°", "240°"]
    assert values["link"] == address
    with Image.open("scene.png") as png:
        assert png.size == (32, 24)
