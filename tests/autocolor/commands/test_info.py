from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from autocolor import read_scene, render, write_picture
from autocolor.images import display_image
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.commands.conftest import Run
from tests.small import LYING, wall_scene


def test_the_facts_stand_on_stdout_and_nothing_on_stderr(folder: Path, run: Run) -> None:
    ran = run("info", "two.obj")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.splitlines()[0] == "two: nodes 6, polygons 2 (three-sided 0), edges 7"
    assert ran.out.splitlines()[1] == "quads that are not flat and convex: warped 0, concave 0, crossed 0"
    assert "parts: front.low (surface), side (surface)" in ran.out
    assert "lights: key, fill, top, rim" in ran.out
    assert "parts: front.low (front.low), side (side)" in run("info", "two.obj", "--surfaces", "parts").out
    assert "created: a view was created that frames the object" in ran.out


def test_json_has_the_same_facts(folder: Path, run: Run) -> None:
    ran = run("info", "scene", "--json")
    assert (ran.code, ran.err) == (0, "")
    facts = json.loads(ran.out)
    picture = render(read_scene("scene"))
    assert (facts["name"], facts["nodes"], facts["polygons"], facts["edges"]) == ("scene", 6, 2, 7)
    assert facts["bounds"] == [[0, 0, 0], [1, 1, 1]]
    assert facts["parts"] == {"front.low": "front.low", "side": "side"}
    assert facts["lights"] == ["key", "key.2"]
    assert facts["pixels"] == len(picture.pixels)
    assert facts["intensities"] == list(picture.ranges.whole)
    side = display_image(read_scene("scene"), picture).ranges["side"]
    assert facts["surfaces"]["side"]["words"] == [side.first, side.last]
    assert facts["surfaces"]["side"]["intensities"] == list(picture.ranges.surfaces["side"])
    assert facts["repairs"] == []
    assert facts["created"] == ["a view was created that frames the object"]


def test_repairs_are_told_and_counted_under_strict(folder: Path, run: Run) -> None:
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\n")
    ran = run("info", "two.obj", "--json", "--strict")
    assert ran.code == 1
    assert [f"autocolor: {repair}" for repair in json.loads(ran.out)["repairs"]] == ran.err.splitlines()
    assert run("info", "two.obj").code == 0


def test_a_surface_that_is_not_seen_or_has_no_part_says_so(folder: Path, run: Run) -> None:
    scene = wall_scene(lights=[], view=wall_scene().view.replace(direction=(0, -1, 0)))
    scene = scene.replace(surfaces=(*scene.surfaces, scene.surfaces[0].replace(name="more")))
    write_picture("wall.npz", scene, render(scene))
    ran = run("info", "wall.npz")
    assert "pixels 0," in ran.out
    assert "lights: none" in ran.out
    assert "  wall: words 1 to 1007, not seen" in ran.out
    assert "  more: no words, not seen" in ran.out


def test_names_that_are_no_text_are_shown_with_backslashes(folder: Path, run: Run) -> None:
    scene = wall_scene(lights=[], name="\udcff")
    write_picture("wall.npz", scene, render(scene))
    assert json.loads(run("info", "wall.npz", "--json").out)["name"] == "\udcff"


def test_the_scalars_of_the_mesh_are_told_with_their_ranges_and_what_is_missing(
    folder: Path, run: Run
) -> None:
    scene = wall_scene()
    nodes, polygons = len(scene.mesh.coordinates), len(scene.mesh.node_numbers)
    scalars = (
        MeshScalar("stress", np.array([np.nan, *range(1, nodes)])),
        MeshScalar("area", np.full(polygons, 0.125), "polygon"),
        MeshScalar("none\nhere", np.full(nodes, np.nan)),
    )
    scene = scene.replace(mesh=scene.mesh.with_scalars(*scalars))
    write_picture("wall.npz", scene, render(scene))
    lines = run("info", "wall.npz").out.splitlines()
    at = lines.index("scalars:")
    assert lines[at + 1 : at + 4] == [
        f"  stress: of nodes, 1 to {nodes - 1}, missing 1",
        "  area: of polygons, 0.125 to 0.125",
        f"  none\\nhere: of nodes, no values, missing {nodes}",
    ]
    assert json.loads(run("info", "wall.npz", "--json").out)["scalars"] == [
        {"name": "stress", "of": "node", "range": [1, nodes - 1], "missing": 1},
        {"name": "area", "of": "polygon", "range": [0.125, 0.125], "missing": 0},
        {"name": "none\nhere", "of": "node", "range": None, "missing": nodes},
    ]
    assert "scalars:" not in run("info", "scene").out


@pytest.mark.parametrize(("name", "code"), [("none.obj", 66), ("scene/none", 66), (".", 65)])
def test_what_cannot_be_read_gives_no_facts(folder: Path, run: Run, name: str, code: int) -> None:
    ran = run("info", name, "--json")
    assert (ran.code, ran.out) == (code, "")
    assert ran.err.startswith("autocolor: ")


@pytest.mark.parametrize("command", ["info", "render"])
def test_a_mesh_that_lies_is_hinted_unless_up_is_given(folder: Path, run: Run, command: str) -> None:
    more = () if command == "info" else ("--save", "out.npz", "--force")
    Path("flag.obj").write_text(LYING)
    hint = "autocolor: flag.obj seems to lie on its side; try --up y, or give --up z"
    assert hint in run(command, "flag.obj", *more).err.splitlines()
    for up in "yz":
        assert "lie" not in run(command, "flag.obj", "--up", up, *more).err
    Path("scene.toml").write_text('[[mesh]]\nfile = "flag.obj"\n')
    assert "lie" not in run(command, "scene.toml", *more).err
