"""The scripts of `examples` run, and their pictures show what they say."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

import autocolor
from examples import choose_paint, light_a_scan, stress_on_a_bracket
from scenes.modeling import head

pytestmark = pytest.mark.thorough

ROOT = Path(__file__).parents[1]
PICTURES = {"paints.png", "scan.png", "flatter.png", "stress.png", "stress-viridis.png"}

Pixels = npt.NDArray[np.uint8]


def pixels_of(path: Path) -> Pixels:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def specks(panel: npt.NDArray[np.float64]) -> float:
    """The share of the pixels that are a third brighter than both neighbors on their line."""
    left, middle, right = panel[:, :-2], panel[:, 1:-1], panel[:, 2:]
    is_seen = np.minimum(np.minimum(left, right), middle) > 30
    return float((middle > 0.65 * (left + right))[is_seen].mean())


def test_the_pictures_of_all_examples_are_in_the_documents() -> None:
    made = {path.name for path in (ROOT / "docs" / "examples").iterdir()}
    assert made == PICTURES, "run: python -m examples.NAME docs/examples"


def test_the_sheet_of_paints_has_25_of_200_and_no_two_look_alike(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    choose_paint.main(tmp_path)
    shown, form = map(int, re.findall(r"\d+", capsys.readouterr().out))
    assert (shown, len(set(choose_paint.COLORS.names))) == (200, 25)
    assert choose_paint.SHOWN < form < 200
    sheet = pixels_of(tmp_path / "paints.png")
    assert sheet.shape[1] == 8 + 5 * (160 + 8)
    step = (sheet.shape[0] - 8) // 5
    cells = [
        sheet[8 + row * step :, 8 + column * 168 :][:120, :160].astype(float)
        for row in range(5)
        for column in range(5)
    ]
    differences = [np.abs(one - other).mean() for n, one in enumerate(cells) for other in cells[:n]]
    assert min(differences) > 0.5


@pytest.mark.needs("scipy")
def test_scipy_finds_about_the_place_of_the_light_that_the_coupe_s_scene_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The author of the scene placed the light by eye. Coming from above, it shows no crease."""
    from examples import flatter

    monkeypatch.setattr(flatter, "LINES", 120)
    monkeypatch.setattr(flatter, "ELEMENTS", 160)
    flatter.main(tmp_path)
    _, azimuth, elevation, contrast = map(float, re.findall(r"[\d.]+", capsys.readouterr().out))
    x, y, z = np.array(autocolor.demo().lights[flatter.LIGHT].position) - flatter.CENTER
    assert azimuth == pytest.approx(np.degrees(np.arctan2(y, x)), abs=10)
    assert elevation == pytest.approx(np.degrees(np.arctan2(z, np.hypot(x, y))), abs=15)
    assert contrast > 3
    picture = pixels_of(tmp_path / "flatter.png")
    assert picture.shape == (120, 320, 3)
    before, after = picture[:, :160], picture[:, 160:]
    assert np.median(before[30:60, 40:100]) > np.median(after[30:60, 40:100])


def test_a_scan_stands_up_and_its_own_lights_leave_one_side_dark(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(light_a_scan, "SIZE", (240, 180))
    light_a_scan.main(tmp_path)
    picture = pixels_of(tmp_path / "scan.png").astype(float).mean(axis=2)
    top, bottom = np.split(picture, [180])
    (lying, upright), (smooth, lit) = (np.split(row, [240], axis=1) for row in (top, bottom))
    for panel, is_upright in ((lying, False), (upright, True), (smooth, True)):
        down, across = np.nonzero(panel > 10)
        assert (np.ptp(down) > np.ptp(across)) == is_upright
    assert specks(upright) > 2 * specks(smooth)
    on_head = smooth > 10
    assert (lit[on_head] < 30).mean() > 0.2 > (smooth[on_head] < 30).mean()


def test_the_scanned_head_is_noisy_and_has_a_hole(tmp_path: Path) -> None:
    head.main(tmp_path / "head.obj")
    mesh = autocolor.read_scene(tmp_path / "head.obj").mesh
    low, high = mesh.bounds
    assert np.argmax(high - low) == 1
    # An edge of a single polygon is at the rim of a hole: the crown, and the neck below.
    nodes = mesh.node_numbers
    edges = np.sort(np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, polygons = np.unique(edges, axis=0, return_counts=True)
    heights = mesh.coordinates[edges[polygons == 1].ravel(), 1]
    # Sides of noisy polygons that cross are split there, which their neighbors are not.
    assert np.isin(np.round(heights, 1), [round(low[1], 1), round(high[1], 1)]).mean() > 0.9
    radius = head.measured_radius()[2]
    noise = np.diff(radius, 2, axis=1) / np.sqrt(6)
    assert np.median(np.abs(noise)) == pytest.approx(0.6745 * head.NOISE, rel=0.05)


def test_the_stress_of_the_bracket_is_read_and_its_colors_change_by_entries_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    stress_on_a_bracket.main(tmp_path)
    place, tables, recoloring = capsys.readouterr().out.splitlines()
    value = float(re.search(r"[\d.]+ MPa", place)[0].removesuffix(" MPa"))  # type: ignore[index]
    polygon, *nodes = map(int, re.findall(r"\d+", tables)[:-1])
    mesh = autocolor.read_scene(stress_on_a_bracket.BRACKET).mesh
    assert (mesh.node_numbers[polygon - 1] + 1).tolist() == nodes
    at_nodes = mesh.scalars[0].values[np.array(nodes) - 1]
    assert at_nodes.min() - 0.05 <= value <= at_nodes.max() + 0.05
    assert value > 150
    assert recoloring.endswith(" 0 words written")
    first, second = (pixels_of(tmp_path / name) for name in ("stress.png", "stress-viridis.png"))
    assert 0.1 < (first != second).any(axis=2).mean() < 0.6
