from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from autocolor import read_scene
from autocolor.scene.scene import Scene
from scenes.modeling.bracket import make
from scenes.modeling.bracket.elements import GAUSS, SIGNS
from scenes.modeling.bracket.measures import (
    AXIS,
    BORE,
    BOSS,
    HALF_WIDTH,
    LENGTH,
    PROJECTION,
    PROJECTION_BACK,
    SEAT,
    TOP,
    UPRIGHT,
)
from scenes.modeling.bracket.plan import half_plan
from scenes.modeling.bracket.skin import PARTS, Skin, both_halves, half_skin
from scenes.modeling.bracket.solid import Solid, half_solid
from scenes.modeling.bracket.stress import BACK, DOWN, bearing_load

FOLDER = Path(__file__).parents[2] / "scenes" / "bracket"


@pytest.fixture(scope="module")
def solid() -> Solid:
    return half_solid()


@pytest.fixture(scope="module")
def skin(solid: Solid) -> Skin:
    return half_skin(solid)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return read_scene(FOLDER)


def volumes_at(solid: Solid, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """How much of a solid a bit of the cube becomes, at places in each hexahedron, (places, hexahedra)."""
    corners = solid.nodes[solid.corners]
    found = []
    for place in places:
        factors = 1 + SIGNS * place
        slopes = SIGNS * np.stack([np.delete(factors, axis, 1).prod(axis=1) for axis in range(3)], axis=1) / 8
        found.append(np.linalg.det(np.einsum("ck,ecl->ekl", slopes, corners)))
    return np.array(found)


def enclosed(nodes: NDArray[np.float64], quads: NDArray[np.intp]) -> float:
    """The volume that quads enclose; a warped one counts as the mean of its two pairs of triangles."""
    a, b, c, d = (nodes[quads[:, corner]] for corner in range(4))
    fans = ((a, b, c), (a, c, d), (b, c, d), (b, d, a))
    return float(sum((p * np.cross(q, r)).sum() for p, q, r in fans) / 12)


def test_the_script_makes_the_committed_files(scene: Scene) -> None:
    assert (FOLDER / "floor.obj").read_bytes() == make.floor_obj().encode("ascii")
    made, kept = make.bracket_ply().splitlines(), (FOLDER / "bracket.ply").read_text("ascii").splitlines()
    first = made.index("end_header") + 1
    assert len(made) == len(kept)
    nodes = slice(first, first + len(scene.mesh.scalars[0].values))
    # Stresses are summed up in another order by another processor: the last digit may differ by one.
    ours, theirs = (
        np.array([float(line.split()[3]) for line in text[nodes][:10_000]]) for text in (made, kept)
    )
    assert np.abs(ours - theirs).max() < 0.0101
    for text in (made, kept):
        text[nodes] = [line.rpartition(" ")[0] for line in text[nodes]]
    assert made == kept


def test_no_hexahedron_is_turned_inside_out(solid: Solid) -> None:
    assert volumes_at(solid, SIGNS).min() > 0
    at_gauss = volumes_at(solid, GAUSS)
    assert (at_gauss.min(axis=0) / at_gauss.max(axis=0)).min() > 0.25


def test_the_skin_is_closed_and_every_quad_is_wound_counterclockwise_from_outside(
    solid: Solid, skin: Skin
) -> None:
    nodes, corners, parts, rows = both_halves(solid.nodes, skin)
    edges = [(a, b) for ring in corners.tolist() for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    # Three holes go through it, of four bolts and a shaft: a sphere has 2, each of them takes 2 away.
    assert len(nodes) - len(edges) // 2 + len(corners) == 2 - 2 * 5
    inside = volumes_at(solid, GAUSS).sum()
    assert enclosed(nodes, corners) == pytest.approx(2 * inside, rel=1e-9)
    assert len(rows) == len(nodes)
    assert set(parts.tolist()) == set(range(len(PARTS)))


def test_the_bracket_has_the_measures_of_its_drawing(scene: Scene) -> None:
    bracket = [number for number, name in enumerate(scene.mesh.part_names) if name != "floor"]
    places = scene.mesh.coordinates_of_parts(bracket)
    assert places.min(axis=0) == pytest.approx([-PROJECTION_BACK, -HALF_WIDTH, 0.0])
    assert places.max(axis=0) == pytest.approx([LENGTH, HALF_WIDTH, AXIS + TOP], abs=1e-3)
    faces = scene.mesh.coordinates_of_parts([scene.mesh.part_names.index("boss_faces")])
    assert faces[:, 0].max() == pytest.approx(UPRIGHT + PROJECTION)
    for part, radii in (
        ("bore", (BORE, BORE + 1)),
        ("seat", (BORE, SEAT + 1)),
        ("boss_faces", (BORE, BOSS + 1.5)),
    ):
        found = scene.mesh.coordinates_of_parts([scene.mesh.part_names.index(part)])
        distances = np.hypot(found[:, 1], found[:, 2] - AXIS)
        assert distances.min() > radii[0] - 0.01, part
        assert distances.max() < radii[1] + 0.01, part


def test_left_and_right_of_the_bracket_are_mirror_images_with_the_same_stress(scene: Scene) -> None:
    stress = scene.mesh.scalars[0].values
    rows = np.round(np.column_stack([scene.mesh.coordinates, stress])[np.isfinite(stress)], 4) + 0.0
    assert sorted(map(tuple, rows.tolist())) == sorted(map(tuple, (rows * [1, -1, 1, 1] + 0.0).tolist()))


def test_the_scene_has_cast_and_machined_surfaces_on_a_stage(scene: Scene) -> None:
    assert set(PARTS) | {"floor"} == set(scene.mesh.part_names)
    assert {part.surface for part in scene.parts if part.name in PARTS} == {"cast", "machined"}
    assert {part.name for part in scene.parts if part.stage} == {"floor"}
    assert 5_000 < len(scene.mesh.node_numbers) < 15_000
    assert scene.surface("machined").reflectance.exponent > 3 * scene.surface("cast").reflectance.exponent


def test_the_stress_is_that_of_a_part_that_is_loaded_and_does_not_break(scene: Scene) -> None:
    (stress,) = scene.mesh.scalars
    assert (stress.name, stress.of) == ("stress", "node")
    found = {}
    for number, name in enumerate(scene.mesh.part_names):
        nodes = np.unique(scene.mesh.node_numbers[scene.mesh.part_numbers == number])
        found[name] = stress.values[nodes]
    assert np.isnan(found["floor"]).all()
    assert min(found[name].min() for name in PARTS) >= 0
    assert 100 < found["rib"].max() < 250
    # The rib carries, and the round top nothing.
    assert np.median(found["rib"]) > 4 * np.median(found["upright"])


def test_the_load_of_the_bearing_is_half_of_what_the_shaft_presses_with(solid: Solid, skin: Skin) -> None:
    load = bearing_load(solid, skin)
    assert load.sum(axis=0)[[0, 2]] == pytest.approx([-BACK / 2, -DOWN / 2])
    # Where it presses down, it presses from inside the seat: half of it also sideways.
    assert load[:, 2].max() <= 1e-9
    assert (load[:, 1] >= -1e-9).all()


def test_the_quads_of_the_plan_are_well_shaped() -> None:
    plan = half_plan()
    corners = plan.points[plan.quads]
    ahead, behind = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    turned = ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]
    sines = turned / (np.linalg.norm(ahead, axis=2) * np.linalg.norm(behind, axis=2))
    assert sines.max() < -0.4
