from __future__ import annotations

import itertools
import math
import tracemalloc

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given

from autocolor import Mesh
from autocolor.arrays import Singles
from autocolor.scene.geometry import fans, node_normals, union_find
from autocolor.scene.geometry.fans import fans_of_corners, places_of_corners
from autocolor.scene.geometry.node_normals import polygon_normals
from tests.autocolor.meshes import grid, sphere
from tests.autocolor.strategies import meshes

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
def test_the_corners_of_a_fan_are_those_found_one_by_one(mesh: Mesh) -> None:
    slow = fans_one_by_one(mesh)
    for one, other in itertools.combinations(range(len(slow)), 2):
        assert (mesh.normals.numbers.flat[one] == mesh.normals.numbers.flat[other]) == (
            slow[one] is slow[other]
        )


@given(meshes())
def test_fans_are_numbered_by_their_first_corners_and_those_of_opposite_winding_come_in_pairs(
    mesh: Mesh,
) -> None:
    places = places_of_corners(mesh.coordinates.T, mesh.node_numbers.T)
    normals = polygon_normals(mesh.coordinates.T[:, mesh.node_numbers.T])
    numbers, opposite_pairs = fans_of_corners(places, mesh.part_numbers, normals, mesh.crease_angle)
    assert list(dict.fromkeys(numbers.tolist())) == list(range(numbers.max() + 1))
    for one, other in opposite_pairs:
        assert len(one) == len(other) > 0
        assert set(one) | set(other) <= set(numbers)


@given(meshes())
def test_corners_share_a_place_where_their_coordinates_are_equal(mesh: Mesh) -> None:
    corners = [tuple(place) for row in mesh.coordinates[mesh.node_numbers].tolist() for place in row]
    places = places_of_corners(mesh.coordinates.T, mesh.node_numbers.T).T.ravel().tolist()
    for one, other in itertools.combinations(range(len(corners)), 2):
        assert (places[one] == places[other]) == (corners[one] == corners[other])


def test_minus_zero_is_the_same_place_as_zero() -> None:
    rows: npt.NDArray[np.float64] = np.array([[0.0, -0.0], [1.0, 1.0], [-0.0, 0.0]])
    assert places_of_corners(rows, np.array([[0], [1], [0], [1]])).tolist() == [[0]] * 4


@pytest.mark.parametrize("at_once", [1, 7, 100])
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
    monkeypatch.setattr(fans, "AT_ONCE", at_once)
    monkeypatch.setattr(union_find, "AT_ONCE", at_once)
    monkeypatch.setattr(node_normals, "POLYGONS_AT_ONCE", at_once)
    for one, other in zip(whole, normals(), strict=True):
        assert one == pytest.approx(other, abs=1.2e-7)


def test_making_the_normals_needs_few_bytes_a_polygon() -> None:
    mesh = grid(400, 400, (0, 0, 0), (1, 0, 0), (0, 0, 1))
    tracemalloc.start()
    try:
        _ = mesh.normals
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 250 * len(mesh.node_numbers)
