from __future__ import annotations

import json
import zlib
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, image, render, scene_of, write_scene
from autocolor.commands import view
from autocolor.commands.validate import COLORS, fault_lines, fault_scene, fault_values
from autocolor.images import display_image
from autocolor.journal.history import History
from autocolor.mapping.legend import legend
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
    assert (ran.code, first[:23]) == (0, "scene: it can be render")
    assert border.startswith(" 1 border ")
    ran = run("validate", "scene", "--json", "--strict")
    assert (ran.code, json.loads(ran.out)["faults"][0]["kind"]) == (1, "border")


def test_faults_are_shown_in_a_picture(folder: Path, run: Run) -> None:
    ran = run("validate", "two.obj", "--show", "-o", "faults.png")
    assert (ran.code, ran.err.splitlines()[-1]) == (0, "wrote faults.png")
    assert (folder / "faults.png").read_bytes().startswith(b"\x89PNG")
    assert run("validate", "two.obj", "--show", "-o", "faults.png").code == 73
    assert run("validate", "two.obj", "-o", "other.png").code == 2
    assert not (folder / "other.png").exists()


def test_faults_are_shown_in_a_window(folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[History] = []
    monkeypatch.setattr(view, "show", shown.append)
    assert run("validate", "two.obj", "--show").code == 0
    scalar = shown[0].scene.scalar
    assert scalar is not None
    assert scalar.name == "fault"


def test_every_problem_is_told_at_once(folder: Path, run: Run) -> None:
    text = (folder / "scene" / "scene.toml").read_text().replace("aim", "aimm").replace("minimum", "minimmum")
    (folder / "scene" / "scene.toml").write_text("ambeint = 3\n" + text)
    ran = run("validate", "scene")
    assert (ran.code, ran.out) == (65, "")
    sentences = ran.err.splitlines()
    assert len(sentences) == 3
    for sentence, line, right in zip(
        sentences, (1, 10, 11), ("'ambient'", "'aim'", "'minimum'"), strict=True
    ):
        assert sentence.startswith(f"autocolor: scene.toml, line {line}, ")
        assert sentence.endswith(f"; did you mean {right}?")
    ran = run("validate", "scene", "--json")
    assert ran.code == 65
    assert [f"autocolor: {problem}" for problem in json.loads(ran.out)["problems"]] == ran.err.splitlines()


def test_repairs_are_no_problems_but_count_under_strict(folder: Path, run: Run) -> None:
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\n")
    ran = run("validate", "two.obj")
    assert (ran.code, ran.out.splitlines()[0][:27]) == (0, "two.obj: it can be rendered")
    assert ran.err.count("\n") == 1
    ran = run("validate", "two.obj", "--strict", "--json")
    assert ran.code == 1
    assert len(json.loads(ran.out)["repairs"]) == 1


def test_what_is_not_there_is_missing(folder: Path, run: Run) -> None:
    ran = run("validate", "none.obj", "--json")
    assert ran.code == 66
    assert json.loads(ran.out)["problems"] == ["none.obj: there is no such file or folder; check the name"]


def test_a_mesh_that_is_not_there_is_missing_too(folder: Path, run: Run) -> None:
    (folder / "scene" / "two.obj").unlink()
    ran = run("validate", "scene")
    assert ran.code == 66
    assert ran.err.count("\n") == 1


SHEET = Mesh(np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 1], [9, 9, 9.0]]), np.array([[0, 1, 2, 3]]))


def test_a_line_has_the_number_of_the_kind_how_many_and_rows_from_one() -> None:
    border, loop, unused, warped = fault_lines(mesh_faults(SHEET))
    assert border.startswith(" 1 border 4: edges of one polygon alone, ")
    assert border.endswith(" (nodes 1-2, 4-1, 2-3, 3-4)")
    assert loop == "     a closed loop of 4 edges, 8.472 long, around (1, 1, 0.5), at node 1"
    assert unused == " 3 unused 1: nodes that no polygon uses (5)"
    assert warped == " 4 warped 1: quads that are not flat (1)"


def test_many_rows_are_cut_in_a_line_and_whole_in_json() -> None:
    mesh = Mesh(np.vstack([SHEET.coordinates, np.full((20, 3), 5.0)]), SHEET.node_numbers)
    faults = mesh_faults(mesh)
    assert list(fault_lines(faults))[2] == " 3 unused 21: nodes that no polygon uses (5, 6, 7, 8, 9, ...)"
    values = json.loads(json.dumps(fault_values(faults)))
    assert values[1] == {
        "kind": "unused", "number": 3, "of": "node", "count": 21, "rows": list(range(5, 26)), "polygons": []
    }  # fmt: skip
    assert values[0]["loops"][0]["closed"] is True
    assert values[0]["polygons"] == [1]


@pytest.mark.parametrize(("sheets", "told"), [(6, "and 1 shorter loop"), (7, "and 2 shorter loops")])
def test_loops_that_are_not_told_are_counted(sheets: int, told: str) -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    apart = np.arange(sheets)[:, None, None] * np.array([3.0, 0, 0])
    corners = np.arange(4 * sheets).reshape(sheets, 4)
    lines = list(fault_lines(mesh_faults(Mesh((square + apart).reshape(-1, 3), corners))))
    assert lines[6].strip() == told


@pytest.mark.parametrize(("count", "told"), [(0, 0), (9_999, 9_999), (10_000, 10_000), (10_001, 10_000)])
def test_json_has_at_most_10_000_rows_of_a_kind(count: int, told: int) -> None:
    (values,) = fault_values([Fault("turned", POLYGON, np.arange(count), np.arange(count))])
    assert (values["count"], values["rows"]) == (count, list(range(1, told + 1)))


def test_there_is_a_color_for_each_kind() -> None:
    assert len(COLORS) == len(set(COLORS)) == len(KINDS)
    # If a color changes on purpose, look at it, and copy the new number from the failure.
    assert zlib.crc32(bytes(part for color in COLORS for part in color)) == 3240921849


def test_the_faults_color_the_scene_whatever_surfaces_it_has() -> None:
    mesh = cube()
    turned = mesh.node_numbers.copy()
    turned[0] = turned[0, ::-1]
    mesh = type(mesh)(mesh.coordinates, turned).with_scalars(
        MeshScalar("stress", np.zeros(8)), MeshScalar("fault", np.zeros(8))
    )
    scene = fault_scene(scene_of(mesh, surfaces="parts"), mesh_faults(mesh))
    assert [scalar.name for scalar in scene.mesh.scalars] == ["stress", "fault"]
    assert [scalar.of for scalar in scene.mesh.scalars] == ["node", "polygon"]
    colors = {tuple(color) for color in image(scene, render(scene, 60, 80)).reshape(-1, 3).tolist()}
    red, green, blue = COLORS[list(KINDS).index("turned")]
    # A shade of the kind's color: its components keep their order.
    assert any(g > b > r for r, g, b in colors), (red, green, blue)


def test_the_legend_has_the_numbers_of_the_kinds_and_0_for_none() -> None:
    scene = fault_scene(scene_of(cube()), ())
    found = legend(display_image(scene, render(scene)))
    assert found is not None
    assert [each.text for each in found.labels] == ["fault", *map(str, range(len(KINDS) + 1))]
