from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, image, render, scene_of, write_scene
from autocolor.commands.validate import COLORS, fault_lines, fault_scene, fault_values
from autocolor.journal.history import History
from autocolor.scene.mesh_faults import KINDS, Fault, mesh_faults
from autocolor.scene.scalar import POLYGON, MeshScalar
from tests.autocolor.commands.conftest import Run
from tests.small import cube


def test_a_scene_without_a_problem_says_so(folder: Path, run: Run) -> None:
    write_scene("whole", scene_of(cube()))
    assert run("validate", "whole") == (0, "whole: no problem\n", "")
    ran = run("validate", "whole", "--json", "--strict")
    assert (ran.code, json.loads(ran.out)) == (0, {"problems": [], "repairs": [], "faults": []})


def test_faults_of_the_mesh_are_listed_and_count_under_strict(folder: Path, run: Run) -> None:
    ran = run("validate", "scene")
    first, border, *_ = ran.out.splitlines()
    assert (ran.code, first) == (0, "scene: it can be rendered, with 1 kind of faults in its mesh")
    assert border.startswith(" 1 border ")
    ran = run("validate", "scene", "--json", "--strict")
    assert (ran.code, json.loads(ran.out)["faults"][0]["kind"]) == (1, "border")


def test_faults_are_shown_in_a_window(folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[History] = []
    monkeypatch.setattr("autocolor.commands.view.show", shown.append)
    assert run("validate", "two.obj", "--show").code == 0
    assert shown[0].scene.scalar is not None
    assert shown[0].scene.scalar.name == "fault"


def test_every_problem_is_told_at_once(folder: Path, run: Run) -> None:
    text = (folder / "scene" / "scene.toml").read_text().replace("aim", "aimm").replace("minimum", "minimmum")
    (folder / "scene" / "scene.toml").write_text("ambeint = 3\n" + text)
    ran = run("validate", "scene")
    assert (ran.code, ran.out) == (65, "")
    sentences = ran.err.splitlines()
    assert [sentence.split(",")[1] for sentence in sentences] == [" line 1", " line 10", " line 11"]
    ran = run("validate", "scene", "--json")
    assert ran.code == 65
    assert [f"autocolor: {problem}" for problem in json.loads(ran.out)["problems"]] == ran.err.splitlines()


def test_repairs_are_no_problems_but_count_under_strict(folder: Path, run: Run) -> None:
    write_scene("whole", scene_of(cube()))
    mesh = Path("whole") / "mesh.obj"
    mesh.write_text(f"{mesh.read_text()}f 1 1 2\n")
    ran = run("validate", "whole")
    assert (ran.code, ran.out, ran.err.count("\n")) == (0, "whole: no problem\n", 1)
    ran = run("validate", "whole", "--strict", "--json")
    assert ran.code == 1
    assert len(json.loads(ran.out)["repairs"]) == 1


SHEET = Mesh(np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 1], [9, 9, 9.0]]), np.array([[0, 1, 2, 3]]))


def test_a_line_has_the_number_of_the_kind_how_many_and_rows_from_one() -> None:
    border, loop, unused, warped = fault_lines(mesh_faults(SHEET))
    assert border.startswith(" 1 border 4: edges of one polygon alone, ")
    assert border.endswith(" (nodes 1-2, 4-1, 2-3, 3-4)")
    assert loop == "     a closed loop of 4 edges, 8.472 long, around (1, 1, 0.5), at node 1"
    assert unused == " 3 unused 1: nodes that no polygon uses (5)"
    assert warped == " 4 warped 1: quads that are not flat (1)"


@pytest.mark.parametrize(
    ("count", "told"),
    [(5, "unused 5: nodes that no polygon uses (5, 6, 7, 8, 9)"), (6, "(5, 6, 7, 8, 9, ...)")],
)
def test_many_rows_are_cut_in_a_line_and_whole_in_json(count: int, told: str) -> None:
    mesh = Mesh(np.vstack([SHEET.coordinates, np.full((count - 1, 3), 5.0)]), SHEET.node_numbers)
    faults = mesh_faults(mesh)
    assert list(fault_lines(faults))[2].endswith(told)
    border, unused, _ = json.loads(json.dumps(fault_values(faults)))
    assert unused == {
        "kind": "unused",
        "number": 3,
        "of": "node",
        "count": count,
        "rows": list(range(5, 5 + count)),
        "polygons": [],
    }
    assert border["polygons"] == [1]
    assert border["loops"] == [
        {
            "edges": 4,
            "length": pytest.approx(4 + 2 * 5**0.5),
            "center": [1, 1, 0.5],
            "node": 1,
            "closed": True,
        }
    ]


@pytest.mark.parametrize(
    ("sheets", "told"), [(5, ""), (6, "     and 1 shorter loop"), (7, "     and 2 shorter loops")]
)
def test_loops_that_are_not_told_are_counted(sheets: int, told: str) -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    apart = np.arange(sheets)[:, None, None] * np.array([3.0, 0, 0])
    corners = np.arange(4 * sheets).reshape(sheets, 4)
    lines = list(fault_lines(mesh_faults(Mesh((square + apart).reshape(-1, 3), corners))))
    assert sum("a closed loop" in line for line in lines) == 5
    assert lines[6:] == ([told] if told else [])


@pytest.mark.parametrize(("count", "told"), [(0, 0), (9_999, 9_999), (10_000, 10_000), (10_001, 10_000)])
def test_json_has_at_most_10_000_rows_of_a_kind(count: int, told: int) -> None:
    (values,) = fault_values([Fault("turned", POLYGON, np.arange(count), np.arange(count))])
    assert (values["count"], values["rows"]) == (count, list(range(1, told + 1)))
    assert values["polygons"] == values["rows"]


def test_the_faults_color_the_scene_whatever_surfaces_it_has() -> None:
    mesh = cube()
    turned = mesh.node_numbers.copy()
    turned[0] = turned[0, ::-1]
    mesh = Mesh(mesh.coordinates, turned).with_scalars(
        MeshScalar("stress", np.zeros(8)), MeshScalar("fault", np.zeros(8))
    )
    scene = scene_of(mesh, surfaces="parts", exposure={"object": (0, 9)}, parts={"mesh": {"stage": True}})
    scene = fault_scene(scene, mesh_faults(mesh))
    assert [(scalar.name, scalar.of) for scalar in scene.mesh.scalars] == [
        ("stress", "node"),
        ("fault", "polygon"),
    ]
    assert ([part.stage for part in scene.parts], scene.exposure) == ([False], "auto")
    colors = {tuple(color) for color in image(scene, render(scene, (80, 60))).reshape(-1, 3).tolist()}
    red, green, blue = COLORS[list(KINDS).index("turned")]
    # A shade of the kind's color: its components keep their order.
    assert any(g > b > r for r, g, b in colors), (red, green, blue)
