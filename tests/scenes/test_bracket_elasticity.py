"""Closed forms of elasticity, on coarse solids of the hexahedra that the bracket is made of."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.blocks import along, around_hole, circle
from scenes.modeling.bracket.elasticity import displacements, node_stresses, von_mises
from scenes.modeling.bracket.elements import Material

STEEL = Material(young=210_000.0, poisson=0.3)


def solid_of(grid: Floats) -> tuple[Floats, Indices, Indices]:
    """Nodes, corners, and the rows of the nodes by their places in a grid of points, (i, j, k, 3)."""
    rows = np.arange(grid[..., 0].size).reshape(grid.shape[:3])
    low = [rows[:-1, :-1], rows[1:, :-1], rows[1:, 1:], rows[:-1, 1:]]
    corners = [each[..., :-1] for each in low] + [each[..., 1:] for each in low]
    return grid.reshape(-1, 3), np.stack(corners, axis=-1).reshape(-1, 8), rows


def box(counts: tuple[int, int, int], size: tuple[float, float, float]) -> Floats:
    axes = [np.linspace(0, length, count + 1) for count, length in zip(counts, size, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def nothing_held(nodes: Floats) -> NDArray[np.bool_]:
    return np.zeros(nodes.shape, np.bool_)


def test_a_bar_that_is_pulled_has_the_same_stress_everywhere_however_its_hexahedra_are_shaped() -> None:
    grid = box((4, 3, 3), (40.0, 12.0, 10.0))
    grid[1:-1, 1:-1, 1:-1] += np.random.default_rng(5).uniform(-0.8, 0.8, grid[1:-1, 1:-1, 1:-1].shape)
    nodes, corners, rows = solid_of(grid)
    held = nothing_held(nodes)
    held[rows[0], 0] = held[rows[:, 0], 1] = held[rows[:, :, 0], 2] = True
    # 90 MPa on the end: each node has its share of the area.
    shares = np.outer([0.5, 1, 1, 0.5], [0.5, 1, 1, 0.5]) / 9
    load = np.zeros_like(nodes)
    load[rows[-1], 0] = 90.0 * 12.0 * 10.0 * shares
    moved = displacements(nodes, corners, STEEL, load, held)
    stresses = node_stresses(nodes, corners, STEEL, moved)
    assert stresses == pytest.approx(np.tile([90.0, 0, 0, 0, 0, 0], (len(nodes), 1)), abs=1e-6)
    assert moved[rows[-1], 0] == pytest.approx(40.0 * 90.0 / 210_000.0)
    assert moved[rows[:, -1], 1] == pytest.approx(-0.3 * 12.0 * 90.0 / 210_000.0)


def test_a_cantilever_has_the_bending_stress_and_the_deflection_of_beam_theory() -> None:
    length, width, height, force = 100.0, 10.0, 10.0, 100.0
    nodes, corners, rows = solid_of(box((20, 2, 4), (length, width, height)))
    load, held = np.zeros_like(nodes), nothing_held(nodes)
    load[rows[-1].reshape(-1), 2] = -force / rows[-1].size
    held[rows[0].reshape(-1)] = True
    moved = displacements(nodes, corners, STEEL, load, held)
    inertia = width * height**3 / 12
    for at in (6, 10, 14):
        arm = length * (1 - at / 20)
        top = node_stresses(nodes, corners, STEEL, moved)[rows[at, :, -1]]
        assert top[:, 0] == pytest.approx(force * arm * height / 2 / inertia, rel=0.01)
        assert von_mises(top) == pytest.approx(top[:, 0], rel=0.01)
    # Bending, and the little that shear adds to it.
    deflection = force * length**3 / (3 * STEEL.young * inertia) * (1 + 0.78 * (height / length) ** 2)
    assert moved[rows[-1].reshape(-1), 2].mean() == pytest.approx(-deflection, rel=0.02)


def test_one_layer_of_thin_hexahedra_bends_without_locking() -> None:
    # Without Poisson's ratio, which stiffens a beam that is held where it wants to narrow.
    nodes, corners, rows = solid_of(box((10, 1, 1), (100.0, 10.0, 1.0)))
    load, held = np.zeros_like(nodes), nothing_held(nodes)
    load[rows[-1].reshape(-1), 2] = -0.1 / 4
    held[rows[0].reshape(-1)] = True
    moved = displacements(nodes, corners, Material(210_000.0, 0.0), load, held)
    deflection = 0.1 * 100.0**3 / (3 * STEEL.young * 10.0 / 12)
    assert moved[rows[-1].reshape(-1), 2].mean() == pytest.approx(-deflection, rel=0.02)


def test_a_hole_in_a_wide_plate_triples_the_stress_beside_it() -> None:
    # Kirsch, 1898; Howland's factor for a plate twenty times as wide as its hole is 3.0.
    radius, half = 1.0, 20.0
    quarter = np.linspace(0, np.pi / 2, 17)
    outline = np.stack([np.minimum(np.cos(quarter) / np.maximum(np.sin(quarter), 1e-9), 1),
                        np.minimum(np.tan(quarter), 1)], axis=-1) * half  # fmt: skip
    shares = (np.geomspace(1.0, half, 19) - 1) / (half - 1)
    hole = circle((0.0, 0.0), radius, quarter)
    flat = hole + np.multiply.outer(shares, outline - hole)
    grid = np.zeros((*flat.shape[:2], 2, 3))
    grid[..., :2], grid[:, :, 1, 2] = flat[:, :, None], 0.25
    nodes, corners, rows = solid_of(grid)
    held = nothing_held(nodes)
    held[rows[:, -1], 0] = held[rows[:, 0], 1] = held[rows[:, :, 0], 2] = True
    # 100 MPa on the side at the largest x.
    load = np.zeros_like(nodes)
    for low, high in zip(rows[-1][:8], rows[-1][1:9], strict=True):
        area = 0.25 * np.linalg.norm(nodes[high[0]] - nodes[low[0]])
        load[[*low, *high], 0] += 100.0 * area / 4
    stresses = node_stresses(nodes, corners, STEEL, displacements(nodes, corners, STEEL, load, held))
    beside, ahead = stresses[rows[0, -1]], stresses[rows[0, 0]]
    assert beside[:, 0] == pytest.approx(300.0, rel=0.04)
    assert ahead[:, 1] == pytest.approx(-100.0, rel=0.1)
    assert von_mises(beside) == pytest.approx(300.0, rel=0.05)


def test_a_solid_that_nothing_holds_is_refused() -> None:
    nodes, corners, rows = solid_of(box((2, 1, 1), (2.0, 1.0, 1.0)))
    load = np.zeros_like(nodes)
    load[rows[-1], 0] = 1.0
    with pytest.raises(ArithmeticError, match="must be held"):
        displacements(nodes, corners, STEEL, load, nothing_held(nodes))


def test_shear_alone_has_a_von_mises_stress_of_root_three_and_even_pressure_has_none() -> None:
    assert von_mises(np.array([[0.0, 0, 0, 10, 0, 0], [-50.0, -50, -50, 0, 0, 0]])) == pytest.approx(
        [10 * np.sqrt(3), 0]
    )


def test_the_lines_around_a_hole_begin_on_it_and_end_on_its_outline() -> None:
    outline = along(np.array([(3.0, -3.0), (3.0, 3.0), (-3.0, 3.0), (-3.0, -3.0), (3.0, -3.0)]), 24)
    block = around_hole((0.0, 0.0), [1.0, 1.5], outline, 0.5)
    assert block.shape == (5, 25, 2)
    assert np.linalg.norm(block[0], axis=1) == pytest.approx(1.0)
    assert block[-1] == pytest.approx(outline)
    sides = np.abs(outline).max(axis=1) - np.abs(outline).min(axis=1) > 0.1
    assert np.abs(block[-2]).max(axis=1)[sides] == pytest.approx(2.5)
    assert (block[:, 0] == block[:, -1]).all()
