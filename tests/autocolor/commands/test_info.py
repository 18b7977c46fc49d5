from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from autocolor import Scene, read_scene, render, write_picture
from autocolor.images import display_image
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.commands.conftest import SMALL, Run
from tests.small import LYING, wall_scene


def test_the_facts_stand_on_stdout_and_nothing_on_stderr(folder: Path, run: Run) -> None:
    ran = run("info", "two.obj")
    assert (ran.code, ran.err) == (0, "")
    lines = ran.out.splitlines()
    assert lines[0] == "two: nodes 6, polygons 2 (three-sided 0), edges 7"
    assert lines[1] == "quads that are not flat and convex: warped 0, concave 0, crossed 0"
    assert lines[2].startswith("size 1 x 1 x 1, pixels ")
    assert {"parts: front.low (surface), side (surface)", "lights: key, fill, top, rim"} <= {*lines}
    assert not any(line.startswith("named views") for line in lines)
    assert "created: a view was created that frames the object" in ran.out
    assert "parts: front.low (front.low), side (side)" in run("info", "two.obj", "--surfaces", "parts").out


def test_json_has_the_same_facts(folder: Path, run: Run) -> None:
    ran = run("info", "scene", "--json")
    assert (ran.code, ran.err) == (0, "")
    facts = json.loads(ran.out)
    scene = read_scene("scene")
    picture = render(scene)
    assert (facts["name"], facts["nodes"], facts["polygons"], facts["edges"]) == ("scene", 6, 2, 7)
    assert facts["bounds"] == [[0, 0, 0], [1, 1, 1]]
    assert facts["parts"] == {"front.low": "front.low", "side": "side"}
    assert facts["lights"] == ["key", "key.2"]
    assert facts["view"]["eye"] == pytest.approx(scene.view.eye)
    assert facts["view"]["forward"] == pytest.approx(scene.view.axes[2])
    assert facts["pixels"] == len(picture.pixels)
    assert facts["intensities"] == list(picture.ranges.whole)
    side = display_image(scene, picture).ranges["side"]
    assert facts["surfaces"]["side"]["words"] == [side.first, side.last]
    assert facts["surfaces"]["side"]["intensities"] == list(picture.ranges.surfaces["side"])
    assert facts["repairs"] == []
    assert facts["created"] == ["a view was created that frames the object"]


def told(run: Run, scene: Scene, *options: str) -> str:
    """What is printed about a picture file of a scene."""
    write_picture("wall.npz", scene, render(scene, (32, 24)), overwrite=True)
    return run("info", "wall.npz", *options).out


def test_a_surface_that_is_not_seen_or_has_no_part_says_so(folder: Path, run: Run) -> None:
    scene = wall_scene(lights=[], view=wall_scene().view.replace(direction=(0, -1, 0)))
    scene = scene.replace(surfaces=(*scene.surfaces, scene.surfaces[0].replace(name="more")))
    lines = told(run, scene).splitlines()
    assert "pixels 0," in lines[2]
    assert {"lights: none", "  wall: words 1 to 1007, not seen", "  more: no words, not seen"} <= {*lines}


def test_the_scalars_of_the_mesh_are_told_with_their_ranges_and_what_is_missing(
    folder: Path, run: Run
) -> None:
    scene = wall_scene()
    scalars = (
        MeshScalar("stress", np.array([np.nan, 1, 2.5, 3])),
        MeshScalar("area", np.array([0.125]), "polygon"),
        MeshScalar("none\nhere", np.full(4, np.nan)),
    )
    scene = scene.replace(mesh=scene.mesh.with_scalars(*scalars))
    assert told(run, scene).partition("scalars:\n")[2].splitlines() == [
        "  stress: of nodes, 1 to 3, missing 1",
        "  area: of polygons, 0.125 to 0.125",
        "  none\\nhere: of nodes, no values, missing 4",
    ]
    assert json.loads(told(run, scene, "--json"))["scalars"] == [
        {"name": "stress", "of": "node", "range": [1, 3], "missing": 1},
        {"name": "area", "of": "polygon", "range": [0.125, 0.125], "missing": 0},
        {"name": "none\nhere", "of": "node", "range": None, "missing": 4},
    ]
    assert "scalars:" not in run("info", "scene").out


@pytest.mark.parametrize("command", ["info", "render"])
def test_a_mesh_that_lies_is_hinted_unless_up_is_given(folder: Path, run: Run, command: str) -> None:
    more = () if command == "info" else (*SMALL, "--force")
    Path("flag.obj").write_text(LYING)
    hint = "autocolor: flag.obj seems to lie on its side; try --up y, or give --up z"
    assert hint in run(command, "flag.obj", *more).err.splitlines()
    for up in "yz":
        assert "on its side" not in run(command, "flag.obj", "--up", up, *more).err
    Path("scene.toml").write_text('[[mesh]]\nfile = "flag.obj"\n')
    assert "on its side" not in run(command, "scene.toml", *more).err
