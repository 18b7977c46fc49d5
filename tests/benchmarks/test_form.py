from __future__ import annotations

import dataclasses
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import autocolor
from autocolor import Mesh
from autocolor.rendering import rendering
from benchmarks import form
from benchmarks.form import sheet
from benchmarks.form.creases import Creases, visible_creases
from benchmarks.form.measures import Measures, edge_medians, measure, worst
from benchmarks.form.sight import Sight, Subject, is_curved, sights, subjects, views
from benchmarks.shapes import shapes

LINES = 60
CUBE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n" + (
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
)


@pytest.fixture(scope="module")
def meshes() -> dict[str, Mesh]:
    return {name: shape.mesh for name, shape in shapes().items()}


@pytest.fixture(scope="module")
def cube(meshes: dict[str, Mesh]) -> Sight:
    return next(sights(Subject("cube", autocolor.scene_of(meshes["cube"]), is_curved=False), LINES))


def creases_of(mesh: Mesh, view: str = "created") -> Creases:
    scene = autocolor.scene_of(mesh, view=views(mesh)[view])
    return visible_creases(mesh, rendering(scene, LINES, 80).points)


def test_a_cube_shows_three_edges_between_its_sides(cube: Sight) -> None:
    points, creases = cube.rendering.points, cube.creases
    assert len(creases.pairs_of_edge) == 3
    sides = np.full(LINES * 80, -1)
    sides[points.pixels] = points.polygon_numbers
    assert (sides[creases.one] >= 0).all()
    assert (sides[creases.other] >= 0).all()
    assert (sides[creases.one] != sides[creases.other]).all()
    assert set((creases.other - creases.one).tolist()) == {1, 80}


def test_an_inward_corner_is_a_crease(meshes: dict[str, Mesh]) -> None:
    assert len(creases_of(meshes["stairs"]).pairs_of_edge) >= 9


@pytest.mark.parametrize("name", ["sphere", "torus", "saddle", "waves"])
@pytest.mark.parametrize("view", ["created", "turned", "low"])
def test_neither_smooth_shading_nor_a_silhouette_is_a_crease(
    meshes: dict[str, Mesh], name: str, view: str
) -> None:
    assert len(creases_of(meshes[name], view).one) == 0


def test_polygons_that_repeat_nodes_at_a_place_share_its_edges(meshes: dict[str, Mesh]) -> None:
    mesh = meshes["cube"]
    apart = Mesh(
        mesh.coordinates[mesh.node_numbers].reshape(-1, 3),
        np.arange(24).reshape(-1, 4),
        mesh.part_numbers,
        mesh.part_names,
    )
    assert len(creases_of(apart).one) == len(creases_of(mesh).one) > 0


def test_the_winding_of_polygons_makes_no_difference(meshes: dict[str, Mesh]) -> None:
    mesh = meshes["cube"]
    numbers = mesh.node_numbers.copy()
    numbers[::2] = numbers[::2, ::-1]
    turned = Mesh(mesh.coordinates, numbers, mesh.part_numbers, mesh.part_names)
    assert len(creases_of(turned).one) == len(creases_of(mesh).one)


def test_the_median_is_taken_along_each_edge_that_is_long_enough() -> None:
    edges = np.array([0] * 6 + [1] * 5 + [2] * 7)
    differences = np.array([5, 1, 2, 3, 9, 4] + [0] * 5 + [7, 6, 5, 4, 3, 2, 1], np.float32)
    creases = Creases(edges, edges, edges)
    assert edge_medians(differences, creases).tolist() == [3.5, 4]


def test_the_measures_of_a_picture_are_those_of_its_gray() -> None:
    gray = np.array([0, 23, 24, 100, 250, 251, 255, 99] * 25, np.uint8)
    one, other = np.arange(3, 195, 8), np.arange(4, 196, 8)
    pixels = np.flatnonzero(gray != 99)
    found = measure(gray, pixels, Creases(one, other, np.zeros_like(one)))
    assert [found.dark, found.bright] == pytest.approx([2 / 7, 2 / 7])
    assert found.spread == 255
    assert (found.edges, found.edges_shown, found.pairs_shown, found.faintest) == (1, 1, 1, 150)


def test_a_picture_of_nothing_breaks_no_bound_but_the_spread() -> None:
    nothing = np.zeros(0, np.intp)
    found = measure(np.zeros(4, np.uint8), nothing, Creases(nothing, nothing, nothing))
    assert found.broken(is_curved=False) == ()
    assert found.broken(is_curved=True) == ("spread",)


def test_the_worst_of_two_is_the_worst_of_each_measure() -> None:
    one = Measures(0.0, 0.03, 95, 100, 3, 0.9, 0.8, 7)
    other = dataclasses.replace(one, dark=0.1, bright=0.0, spread=80, edges_shown=None, faintest=None)
    both = worst([one, other])
    assert (both.dark, both.bright, both.spread, both.edges_shown, both.faintest) == (0.1, 0.03, 80, 0.9, 7)
    assert both.broken(is_curved=True) == ("dark", "bright", "spread", "edges")
    assert both.broken(is_curved=False) == ("dark", "bright", "edges")


def test_the_tone_is_the_median_luma_of_the_colors_that_people_get(cube: Sight) -> None:
    scene = cube.subject.scene
    colors = autocolor.image(scene, autocolor.render(scene, LINES, 80)).reshape(-1, 3)
    lumas = colors[cube.rendering.picture.pixels] @ (0.299, 0.587, 0.114)
    found = cube.measures()
    assert found.tone == pytest.approx(np.median(lumas) / 255)
    assert "tone" not in dataclasses.replace(found, tone=0.42).broken(is_curved=False)
    assert "tone" in dataclasses.replace(found, tone=0.41).broken(is_curved=False)
    assert "tone" in dataclasses.replace(found, tone=0.59).broken(is_curved=False)
    assert worst([dataclasses.replace(found, tone=None), found]).tone == found.tone


def test_another_light_keeps_the_visible_points(cube: Sight, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = cube.rendering.scene
    other = scene.with_light("key", position=(3, 3, 3), intensity=2.0).replace(mapping="gamma")
    fresh = autocolor.image(other, autocolor.render(other, LINES, 80))[..., 0].ravel()

    def never(*_: object) -> None:
        raise AssertionError("visible points must not be computed again")

    monkeypatch.setattr("autocolor.rendering.ALGORITHMS", {"batch": never})
    np.testing.assert_array_equal(cube.gray(other), fresh)
    assert cube.measures(other) != cube.measures()


def test_gray_is_the_mapped_intensity(cube: Sight) -> None:
    picture = cube.rendering.picture
    relative = (picture.relative - picture.relative.min()) / np.ptp(picture.relative)
    linear = cube.rendering.scene.replace(mapping="linear", contrast="stretch")
    np.testing.assert_allclose(cube.gray(linear)[picture.pixels], 255 * relative, atol=1)


def test_the_meshes_of_a_folder_are_judged_too(tmp_path: Path) -> None:
    (tmp_path / "box.obj").write_text(CUBE, encoding="utf-8")
    (tmp_path / "notes.txt").write_text("no mesh", encoding="utf-8")
    *own, box = subjects([tmp_path])
    assert [subject.name for subject in own] == list(shapes())
    assert (box.name, box.is_curved) == ("box", False)


def test_a_mesh_is_curved_where_it_is_shaded_smoothly(meshes: dict[str, Mesh]) -> None:
    assert [is_curved(meshes[name]) for name in ("cube", "gear", "icosahedron")] == [False] * 3
    assert [is_curved(meshes[name]) for name in ("torus", "blob", "waves")] == [True] * 3


def test_the_table_has_a_row_for_each_mesh_and_its_worst_view(monkeypatch: pytest.MonkeyPatch) -> None:
    two = [subject for subject in subjects() if subject.name in ("cube", "torus")]
    monkeypatch.setattr(form, "subjects", lambda folders: two)
    measured = json.loads(json.dumps(form.measure(lines=LINES)))
    assert len(measured["rows"]) == 2 * 4
    assert [line.split()[0] for line in form.text(measured).splitlines()[1:3]] == ["cube", "torus"]
    assert len(form.text(measured, every_view=True).splitlines()) == len(form.text(measured).splitlines()) + 6


def no_pyvista(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sheet, "find_spec", lambda name: None)


def no_opengl(monkeypatch: pytest.MonkeyPatch) -> None:
    ended: subprocess.CompletedProcess[str] = subprocess.CompletedProcess([], -6)
    monkeypatch.setattr(sheet, "find_spec", lambda name: object())
    monkeypatch.setattr(subprocess, "run", lambda *arguments, **options: ended)


@pytest.mark.parametrize(
    ("missing", "said"),
    [
        (no_pyvista, "; only ours: pyvista is not installed; pip install '.[peers]'"),
        (no_opengl, "; only ours: VTK finds no OpenGL; install Mesa's EGL, libegl1"),
    ],
)
def test_without_pyvista_the_sheet_has_only_our_pictures(
    missing: Callable[[pytest.MonkeyPatch], None], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    missing(monkeypatch)
    cube = [next(iter(subjects()))]
    monkeypatch.setattr(sheet, "subjects", lambda folders: cube)
    assert sheet.write_sheet(tmp_path / "new" / "sheet.png") == said
    assert (tmp_path / "new" / "sheet.png").read_bytes().startswith(b"\x89PNG")


def test_pyvista_sees_a_mesh_where_we_do(meshes: dict[str, Mesh]) -> None:
    pytest.importorskip("pyvista")
    if sheet.absence():
        pytest.skip(sheet.absence())
    scene = autocolor.scene_of(meshes["blob"]).replace(background=(0, 0, 255))
    ours = (sheet.our_picture(scene) != scene.background).any(axis=2)
    theirs = sheet.pyvista_picture(scene)
    covered = (theirs != theirs[0, 0]).any(axis=2)
    assert np.mean(ours != covered) < 0.01


def test_the_program_leaves_with_1_where_a_bound_is_broken_only_when_asked() -> None:
    command = [sys.executable, "-m", "benchmarks.form", "--lines", "24"]
    root = Path(__file__).parents[2]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    broken = "break a bound" in run.stdout
    assert run.returncode == 0
    checked = subprocess.run([*command, "--check"], cwd=root, capture_output=True, text=True, check=False)
    assert checked.returncode == broken
