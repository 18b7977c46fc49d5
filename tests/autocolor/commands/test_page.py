from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from autocolor import read_picture, render, save_page, write_picture
from tests.autocolor.commands.conftest import Run


@pytest.fixture
def saved(folder: Path, run: Run) -> Path:
    """A saved picture of the scene, of 64 x 48 pixels."""
    assert run("render", "scene", "--size", "64x48", "--smooth", "1", "--save", "scene.npz").code == 0
    return folder / "scene.npz"


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
    picture, scene = read_picture(saved)
    save_page("python.html", scene, picture)
    assert Path("scene.html").read_bytes() == Path("python.html").read_bytes()
    values = picture_in("scene.html")
    assert (values["name"], values["lines"], values["elements"]) == ("scene", 48, 64)
    assert values["lights"] is None


def test_a_scene_is_rendered_with_smooth_edges(folder: Path, run: Run) -> None:
    ran = run("page", "scene", "--size", "64x48", "--set", "surfaces.side.object_color=red", "-o", "a.html")
    assert ran == (0, "", "wrote a.html\n")
    values = picture_in("a.html")
    assert (values["lines"], values["elements"], values["smooth"]) == (96, 128, 2)
    assert values["surfaces"][1]["paint"]["object_color"] == "#ff0000"
    assert run("page", "two.obj", "--size", "64x48", "--smooth", "1").code == 0
    assert picture_in("two.html")["lines"] == 48


def test_a_scene_that_is_too_large_for_samples_has_none(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("autocolor.web.exported.LARGEST_CANVAS", 64 * 48)
    assert run("page", "scene", "--size", "64x48").code == 0
    assert picture_in("scene.html")["smooth"] == 1
    ran = run("page", "scene", "--size", "64x48", "--smooth", "2", "-o", "a.html")
    assert ran.code == 65
    assert "at most 3,072 pixels, which canvases of phones hold, not 128 x 96; render it smaller" in ran.err


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
        "paints": {"side": {"object_color": "#000080", "blend": 1.0}},
        "lights": {"key": {"intensity": 0.5}},
    }


def test_a_variant_that_replaces_a_ramp_is_told(saved: Path, run: Run) -> None:
    arguments = ("--set", "surfaces.side.ramp=[red, blue]", "--vary", "surfaces.side.object_color=red")
    ran = run("page", "scene.npz", *arguments)
    assert ran.code == 0
    assert "autocolor: side: two colors and their blend replace its ramp\n" in ran.err


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("-o", "side.png"), 2, "a page must be written to a file that ends in .html, not to side.png"),
        (("-o", "old.html"), 73, "an output must be a new file, not old.html, which exists;"),
        (("--size", "32x24"), 2, "--size and --smooth are for a scene, not for a picture file; leave"),
        (("--smooth", "1"), 2, "--size and --smooth are for a scene, not for a picture file; leave"),
        (("--set", "view.angle=3"), 2, "--set: a setting of a picture must need no rendering"),
        (("--vary", "view.angle=1,2"), 2, "variant '1': view.angle: a variant of a page must change paints"),
        (("--vary", "lights.key.on=true,false"), 2, "lights.key.on: the page must have lights for it; add"),
        (("--vary", "surfaces.sde.blend=0,1"), 2, "--vary surfaces.sde.blend: there is no surface 'sde'"),
        (("--table", "views.csv"), 65, "views.csv: variant '3': view.angle: a variant of a page must change"),
        (("--table", "none.csv"), 66, "there is no such file"),
    ],
)  # fmt: skip
def test_what_cannot_be_a_page_is_refused(
    saved: Path, run: Run, arguments: tuple[str, ...], code: int, message: str
) -> None:
    Path("old.html").write_text("old")
    Path("views.csv").write_text("view.angle\n3\n")
    ran = run("page", "scene.npz", *arguments)
    assert (ran.code, ran.out) == (code, "")
    assert message in ran.err
    assert Path("old.html").read_text() == "old"
    assert not Path("scene.html").exists()


def test_lights_of_a_picture_that_its_scene_does_not_give_are_refused(saved: Path, run: Run) -> None:
    picture, scene = read_picture(saved)
    write_picture("other.npz", scene.with_light("key", intensity=0.5), render(scene, 48, 64))
    ran = run("page", "other.npz", "--lights")
    assert ran.code == 65
    assert "the lights of a picture must be computed from the scene that it was rendered from" in ran.err
    assert picture.lines == 48
