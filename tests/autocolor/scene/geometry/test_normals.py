from __future__ import annotations

import itertools
import math
import tracemalloc
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.arrays import Singles
from autocolor.scene.geometry import normals as normals_module
from autocolor.scene.geometry.normals import (
    node_normals,
    polygon_normals,
)
from autocolor.testing import meshes
from tests.small import cube, grid, sphere
from tests.tables import first

EPSILON = float(np.finfo(np.float32).eps)
"""Normals are computed in float64 and rounded once."""


def corner_normals(mesh: Mesh) -> Singles:
    """The normal at each corner of each polygon, (polygons, 4, 3)."""
    return mesh.normals.vectors[mesh.normals.numbers]


def with_polygons(mesh: Mesh, quads: object, crease_angle: float = 40.0) -> Mesh:
    quads = np.array(quads)
    return Mesh(mesh.coordinates, quads, np.zeros(len(quads), np.intp), ("all",), crease_angle)


def test_a_box_keeps_its_edges_sharp() -> None:
    mesh = cube()
    flat = polygon_normals(mesh.coordinates.T[:, mesh.node_numbers.T]).T
    assert corner_normals(mesh) == pytest.approx(np.repeat(flat[:, None], 4, axis=1))
    outward = mesh.coordinates[mesh.node_numbers].mean(axis=1) - 0.5
    assert (outward * flat).sum(axis=1) == pytest.approx(np.full(6, 0.5))


@given(st.integers(0, 1 << 32))
def test_polygons_of_opposite_winding_are_as_smooth_each_with_its_own_sign(seed: int) -> None:
    turned = np.random.default_rng(seed).integers(0, 2, 24 * 12).astype(bool).tolist()
    whole = sphere(24, 12)
    quads = [
        (quad[1], quad[0], quad[2], quad[2]) if turn and quad[2] == quad[3]
        else quad[::-1] if turn else quad
        for quad, turn in zip(whole.node_numbers.tolist(), turned, strict=True)
    ]  # fmt: skip
    mixed = with_polygons(whole, quads)
    outward = mixed.coordinates[mixed.node_numbers]
    sign = np.where(turned, -1.0, 1.0)[:, None, None]
    assert np.abs(corner_normals(mixed) * sign - outward).max() < 0.02


@pytest.mark.parametrize(("fold", "smooth"), [(39.0, True), (40.0, True), (41.0, False), (120.0, False)])
def test_an_edge_is_sharp_beyond_the_crease_angle(fold: float, smooth: bool) -> None:
    turn = math.radians(fold)
    roof = Mesh(
        np.array(
            [
                (-1, 0, 0),
                (-1, 1, 0),
                (0, 0, 0),
                (0, 1, 0),
                (math.cos(turn), 0, -math.sin(turn)),
                (math.cos(turn), 1, -math.sin(turn)),
            ]
        ),
        np.array([(0, 2, 3, 1), (2, 4, 5, 3)]),
        np.zeros(2, np.intp),
        ("roof",),
    )
    at_ridge = corner_normals(roof)[0, 1]
    expected = np.array((math.sin(turn / 2), 0, math.cos(turn / 2))) if smooth else np.array((0, 0, 1))
    assert at_ridge == pytest.approx(expected, abs=EPSILON)


def test_normals_that_cancel_leave_each_polygon_its_own() -> None:
    # Three panels around one edge, 120 degrees apart: their sum is nothing.
    panels = Mesh(
        np.array(
            [(0, 0, 0), (0, 0, 1)]
            + [
                (math.cos(turn), math.sin(turn), z)
                for turn in (0, 2 * math.pi / 3, 4 * math.pi / 3)
                for z in (0, 1)
            ]
        ),
        np.array([(0, 2, 3, 1), (0, 4, 5, 1), (0, 6, 7, 1)]),
        np.zeros(3, np.intp),
        ("panels",),
        crease_angle=180.0,
    )
    assert np.linalg.norm(panels.normals.vectors, axis=1) == pytest.approx(
        np.ones(len(panels.normals.vectors))
    )


@given(meshes(), st.sampled_from([1e-200, 1e-20, 1.0, 1e20]))
def test_every_normal_is_a_unit_vector_whatever_the_mesh(mesh: Mesh, size: float) -> None:
    normals = node_normals(mesh.coordinates * size, mesh.node_numbers, mesh.part_numbers, mesh.crease_angle)
    assert normals.numbers.shape == (len(mesh.node_numbers), 4)
    assert normals.numbers.max(initial=-1) < len(normals.vectors)
    assert np.linalg.norm(normals.vectors, axis=1) == pytest.approx(np.ones(len(normals.vectors)))


def test_a_polygon_without_area_adds_nothing() -> None:
    mesh = grid(1, 1, (0, 0, 0), (1, 0, 0), (0, 0, 1))
    sliver = with_polygons(mesh, [*mesh.node_numbers.tolist(), (0, 1, 1, 0), (2, 2, 2, 2)])
    assert corner_normals(sliver)[0] == pytest.approx(corner_normals(mesh)[0])


Side = tuple[int, int, bool]
"""A polygon, its corner, and whether the polygon shows its other side."""


def fans_one_by_one(mesh: Mesh) -> list[set[Side]]:
    """What shares a normal, found by comparing each polygon with each."""
    polygons = [[tuple(mesh.coordinates[node].tolist()) for node in row] for row in mesh.node_numbers]
    parts, normals = mesh.part_numbers.tolist(), polygon_normals(mesh.coordinates.T[:, mesh.node_numbers.T]).T
    edges: dict[object, list[tuple[int, int]]] = {}
    for number, places in enumerate(polygons):
        for corner in range(4):
            ends = frozenset([places[corner], places[(corner + 1) % 4]])
            if len(ends) == 2:
                edges.setdefault((ends, parts[number]), []).append((number, corner))
    pairs: list[tuple[tuple[int, int], tuple[int, int], bool]] = [
        ((number, 2), (number, 3), False) for number, places in enumerate(polygons) if places[2] == places[3]
    ]
    for users in edges.values():
        for (one, here), (other, there) in itertools.pairwise(users):
            opposite = polygons[one][here] == polygons[other][there]
            cosine = float(normals[one] @ normals[other]) * (-1 if opposite else 1)
            if cosine >= math.cos(math.radians(mesh.crease_angle)) - 1e-9:
                next_here, next_there = (here + 1) % 4, (there + 1) % 4
                ends_there = (there, next_there) if opposite else (next_there, there)
                pairs.append(((one, here), (other, ends_there[0]), opposite))
                pairs.append(((one, next_here), (other, ends_there[1]), opposite))
    fan_of: dict[Side, set[Side]] = {
        side: {side}
        for side in itertools.product(range(len(polygons)), range(4), (False, True))
    }  # fmt: skip
    for one_corner, other_corner, opposite in pairs:
        for turned in (False, True):
            one_fan, other_fan = fan_of[*one_corner, turned], fan_of[*other_corner, turned != opposite]
            if one_fan is not other_fan:
                one_fan |= other_fan
                fan_of.update(dict.fromkeys(other_fan, one_fan))
    return [fan_of[polygon, corner, False] for polygon in range(len(polygons)) for corner in range(4)]


@given(meshes())
def test_the_corners_of_a_fan_agree_with_a_search_one_by_one(mesh: Mesh) -> None:
    slow = fans_one_by_one(mesh)
    for one, other in itertools.combinations(range(len(slow)), 2):
        assert (mesh.normals.numbers.flat[one] == mesh.normals.numbers.flat[other]) == (
            slow[one] is slow[other]
        )


@pytest.mark.parametrize("at_once", first(1, [7, 1, 100]))
def test_the_normals_do_not_depend_on_how_many_corners_are_worked_on_at_once(
    at_once: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    ball = sphere(24, 12)
    turned = np.where((np.arange(24 * 12) % 3 == 0)[:, None], ball.node_numbers[:, ::-1], ball.node_numbers)

    def normals() -> list[Singles]:
        both = [
            Mesh(ball.coordinates, nodes, ball.part_numbers, ("all",))
            for nodes in (ball.node_numbers, turned)
        ]
        return [mesh.normals.vectors[mesh.normals.numbers] for mesh in both]

    whole = normals()
    monkeypatch.setattr(normals_module, "CORNERS_AT_ONCE", at_once)
    monkeypatch.setattr(normals_module, "POLYGONS_AT_ONCE", at_once)
    for one, other in zip(whole, normals(), strict=True):
        assert one == pytest.approx(other, abs=1.2e-7)


@pytest.mark.thorough
def test_making_the_normals_needs_few_bytes_a_polygon() -> None:
    mesh = grid(400, 400, (0, 0, 0), (1, 0, 0), (0, 0, 1))
    tracemalloc.start()
    try:
        _ = mesh.normals
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 250 * len(mesh.node_numbers)


Array = npt.NDArray[np.float64]


def nodes_of_normals(mesh: Mesh) -> npt.NDArray[np.intp]:
    """A node at each normal."""
    nodes = np.zeros(len(mesh.normals.vectors), np.intp)
    nodes[mesh.normals.numbers.ravel()] = mesh.node_numbers.ravel()
    return nodes


def places(mesh: Mesh) -> Array:
    """The coordinates at each normal, (normals, 3)."""
    found: Array = mesh.coordinates[nodes_of_normals(mesh)]
    return found


def torus(around: int, across: int, ring: float = 1.0, tube: float = 0.4) -> Mesh:
    """A ring about z of `around` x `across` quads, facing outward."""
    turn, bend = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across)
    off_axis = ring + tube * np.cos(bend)
    coordinates = np.stack([off_axis * np.cos(turn), off_axis * np.sin(turn), tube * np.sin(bend)], axis=-1)
    row, column = np.arange(across)[:, None], np.arange(around)

    def node(row: npt.NDArray[np.intp], column: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
        return row % across * around + column % around

    corners = (node(row, column), node(row, column + 1), node(row + 1, column + 1), node(row + 1, column))
    quads = np.stack(corners, axis=-1).reshape(-1, 4)
    return Mesh(coordinates.reshape(-1, 3), quads, part_names=("torus",))


def heights(columns: int, rows: int, height: Callable[[Array, Array], Array], size: float = 1.0) -> Mesh:
    """A patch around the origin over [-size, size] in x and y, facing up."""
    flat = grid(columns, rows, (-size, -size, 0.0), (2 * size, 0.0, 0.0), (0.0, 2 * size, 0.0))
    x, y, _ = flat.coordinates.T
    return Mesh(np.stack([x, y, height(x, y)], axis=1), flat.node_numbers, part_names=("patch",))


def test_the_mean_curvature_of_a_sphere_is_the_inverse_of_its_radius() -> None:
    for columns, rows, radius in ((60, 120, 0.5), (120, 60, 20.0)):
        mesh = sphere(columns, rows, radius)
        assert mesh.curvatures.mean * radius == pytest.approx(1, abs=0.01)
        assert mesh.curvatures.gaussian * radius**2 == pytest.approx(1, abs=0.01)
        inward = Mesh(mesh.coordinates, mesh.node_numbers[:, ::-1], part_names=("sphere",))
        assert inward.curvatures.mean * radius == pytest.approx(-1, abs=0.03)


@pytest.mark.parametrize("tube", first(2, [0.7, 0.25, 0.4]))
@pytest.mark.parametrize("sides", first(1, [(80, 160), (160, 80)]))
def test_both_curvatures_of_a_torus_are_those_of_the_formula(tube: float, sides: tuple[int, int]) -> None:
    mesh = torus(*sides, tube=tube)
    x, y, _ = places(mesh).T
    cosine = (np.hypot(x, y) - 1) / tube
    of_ring = cosine / (1 + tube * cosine)
    mean, gaussian = (1 / tube + of_ring) / 2, of_ring / tube
    assert mesh.curvatures.mean == pytest.approx(mean, abs=0.005 * np.abs(mean).max())
    assert mesh.curvatures.gaussian == pytest.approx(gaussian, abs=0.005 * np.abs(gaussian).max())


@pytest.mark.parametrize("bands", [1, 5])
def test_a_cylinder_bends_one_way_up_to_its_rims(bands: int) -> None:
    count, radius = 48, 3.0
    turns = np.arange(count) * 2 * np.pi / count
    rings = [
        np.stack([radius * np.cos(turns), radius * np.sin(turns), np.full(count, height)], axis=1)
        for height in np.linspace(0, 2, bands + 1)
    ]
    first = (np.arange(bands)[:, None] * count + np.arange(count)).ravel()
    after = first - first % count + (first + 1) % count
    quads = np.stack([first, after, after + count, first + count], axis=1)
    mesh = Mesh(np.concatenate(rings), quads, part_names=("cylinder",))
    assert mesh.curvatures.mean == pytest.approx(1 / (2 * radius), rel=0.01)
    assert mesh.curvatures.gaussian == pytest.approx(0, abs=1e-5)


@pytest.mark.parametrize("scale", [1e-20, 1e20])
def test_curvature_scales_with_the_object(scale: float) -> None:
    mesh = torus(24, 16)
    scaled = Mesh(mesh.coordinates * scale, mesh.node_numbers, part_names=("torus",))
    assert scaled.curvatures.mean * scale == pytest.approx(mesh.curvatures.mean, rel=1e-4, abs=1e-5)
    assert scaled.curvatures.gaussian * scale**2 == pytest.approx(
        mesh.curvatures.gaussian, rel=1e-4, abs=1e-5
    )


def test_a_crease_has_no_curvature_across_it() -> None:
    # Two cylinders that meet in a ridge.
    def shape(x: Array, y: Array) -> Array:
        return np.sqrt(4 - (np.abs(x) + 1) ** 2 + 0 * y)

    mesh = heights(20, 6, shape, 0.8)
    assert len(mesh.normals.vectors) > len(mesh.coordinates)
    assert mesh.curvatures.mean == pytest.approx(0.25, rel=0.05)


@given(meshes())
def test_any_mesh_has_finite_curvatures(mesh: Mesh) -> None:
    for values in (mesh.curvatures.mean, mesh.curvatures.gaussian):
        assert values.shape == (len(mesh.normals.vectors),)
        assert np.isfinite(values).all()
        assert not values.flags.writeable
