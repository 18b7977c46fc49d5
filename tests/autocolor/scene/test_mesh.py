from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import InputError, Mesh, Scene, scene_of
from autocolor.scene.columns import Tier
from autocolor.scene.mesh import has_same_tables
from autocolor.scene.scalar import MeshScalar
from autocolor.scene.scene import cost_of_edit
from autocolor.testing import meshes
from tests.small import cube, grid
from tests.tables import call, refused


def mesh_of(**fields: Any) -> Mesh:
    given_fields = {
        "coordinates": np.eye(3),
        "node_numbers": np.array([[0, 1, 2]]),
        "part_numbers": np.array([0]),
        "part_names": ("door",),
    }
    return Mesh(**{**given_fields, **fields})


def test_a_triangle_repeats_its_last_node() -> None:
    mesh = mesh_of()
    assert mesh.node_numbers.tolist() == [[0, 1, 2, 2]]
    assert mesh.triangle_count == 1


def test_a_mesh_is_a_copy_that_never_changes() -> None:
    coordinates = np.eye(3)
    mesh = mesh_of(coordinates=coordinates)
    coordinates[:] = 7
    assert mesh.coordinates.tolist() == np.eye(3).tolist()
    for table in (mesh.coordinates, mesh.node_numbers, mesh.part_numbers):
        assert not table.flags.writeable


@given(meshes())
def test_the_bounds_hold_the_nodes_that_polygons_use_and_no_other(mesh: Mesh) -> None:
    low, high = mesh.bounds
    used = mesh.coordinates[sorted(set(mesh.node_numbers.ravel().tolist()))]
    assert low.tolist() == used.min(axis=0).tolist()
    assert high.tolist() == used.max(axis=0).tolist()


ROWS = "polygon table: a node number must be a row of the node table (0 to 2), not"
NUMBERS = "it must be an array of numbers, not list; convert it"
WHOLE = "it must be an array of whole numbers, not"

test_a_mesh_that_breaks_a_rule_is_refused = refused(
    lambda fields: mesh_of(**fields),
    [
        (
            {"coordinates": np.array([[0, 0, 0], [0, math.nan, 0], [0, 0, 1]])},
            "node table: coordinates must be finite and at most 1e30 in size, not [0.0, nan, 0.0] (row 1)",
        ),
        # A fault of the nodes is not repeated for the polygons.
        ({"coordinates": np.eye(3)[:, :2]}, "node table: its shape must be (rows, 3), not (3, 2)"),
        ({"coordinates": [[1, 2], [3]]}, f"node table: {NUMBERS}"),
        ({"coordinates": [["1", "2", "3"]] * 3}, f"node table: {NUMBERS}"),
        ({"node_numbers": [[0, 1, 3]]}, f"{ROWS} [0, 1, 3, 3] (row 0)"),
        ({"node_numbers": [[0, 1, -1]]}, f"{ROWS} [0, 1, -1, -1] (row 0)"),
        (
            {"part_numbers": [1]},
            "polygon table: a part number must be a row of the part table (0 to 0), not 1 (row 0)",
        ),
        (
            {"part_numbers": [0, 0]},
            "polygon table: there must be one part number a polygon (1), not an array of shape (2,)",
        ),
        ({"part_names": ("door", "door")}, "part table: part names must differ, not repeat"),
        ({"crease_angle": 181}, "mesh: crease_angle must be a number from 0 to 180, not 181"),
    ],
)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"node_numbers": [[0, 1]]}, "polygon table: its shape must be (rows, 3) or (rows, 4), not (1, 2)"),
        ({"node_numbers": [[0, 1, 2.5]]}, f"polygon table: {WHOLE} of float64; convert it"),
        ({"part_numbers": [0.5]}, f"part numbers: {WHOLE} of float64; convert it"),
        ({"part_numbers": "x"}, f"part numbers: {WHOLE} str; convert it"),
    ],
)
def test_tables_of_no_numbers_are_refused(fields: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError) as refusal:
        mesh_of(**fields)
    assert sentence in refusal.value.problems


def test_an_empty_mesh_is_a_mesh() -> None:
    empty = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ())
    assert (empty.edge_count, empty.triangle_count, empty.parts_in_use) == (0, 0, ())
    assert [bound.tolist() for bound in empty.bounds] == [[0, 0, 0], [0, 0, 0]]
    assert len(empty.normals.vectors) == 0


@given(meshes(), meshes())
def test_joined_meshes_keep_their_polygons_and_share_parts_of_the_same_name(one: Mesh, other: Mesh) -> None:
    joined = Mesh.joined([one, other])
    assert joined.part_names == one.part_names
    assert joined.part_numbers.tolist() == [*one.part_numbers, *other.part_numbers]
    corners = joined.coordinates[joined.node_numbers]
    both = [*one.coordinates[one.node_numbers], *other.coordinates[other.node_numbers]]
    assert corners.tolist() == [each.tolist() for each in both]


@given(meshes())
def test_a_mesh_of_tables_copies_nothing_and_has_the_given_normals_and_planes(mesh: Mesh) -> None:
    tables = (mesh.coordinates, mesh.node_numbers, mesh.part_numbers)
    held = Mesh.of_tables(*tables, mesh.part_names, 25.0, normals=mesh.normals, shared_planes=None)
    assert held.coordinates is mesh.coordinates
    assert held.node_numbers is mesh.node_numbers
    assert held.part_numbers is mesh.part_numbers
    assert (held.part_names, held.crease_angle) == (mesh.part_names, 25.0)
    assert held.normals is mesh.normals
    assert held.shared_planes is None
    computed = Mesh.of_tables(*tables, mesh.part_names, mesh.crease_angle)
    assert computed.normals.vectors.tobytes() == mesh.normals.vectors.tobytes()
    assert (computed.shared_planes is None) == (mesh.shared_planes is None)


def test_edges_are_counted_once() -> None:
    assert cube().edge_count == 12
    assert grid(3, 2, (0, 0, 0), (3, 0, 0), (0, 2, 0)).edge_count == 17
    assert mesh_of(node_numbers=np.array([[0, 1, 2], [2, 1, 0]]), part_numbers=[0, 0]).edge_count == 3


VALUES = np.array([1.0, np.nan, 3.0, 4.0])


def mesh(*scalars: MeshScalar, coordinates: object = None, part: str = "a", crease_angle: float = 40) -> Mesh:
    nodes = np.eye(4, 3) if coordinates is None else coordinates
    return Mesh(nodes, [[0, 1, 2]], [0], (part, "b"), crease_angle, scalars)  # type: ignore[arg-type]


def test_meshes_of_equal_tables_and_scalars_are_the_same_whatever_their_crease_angle() -> None:
    one, other = (mesh(MeshScalar("stress", VALUES.copy()), crease_angle=angle) for angle in (40.0, 20.0))
    assert has_same_tables(one, other)
    assert has_same_tables(one, one)


@pytest.mark.parametrize(
    "other",
    [
        mesh(),
        mesh(MeshScalar("strain", VALUES)),
        mesh(MeshScalar("stress", VALUES[:1], "polygon")),
        mesh(MeshScalar("stress", np.array([1.0, 2.0, 3.0, 4.0]))),
        mesh(MeshScalar("stress", VALUES), MeshScalar("strain", VALUES)),
        mesh(MeshScalar("stress", VALUES), part="c"),
        mesh(MeshScalar("stress", VALUES), coordinates=np.eye(4, 3) + 1),
    ],
    ids=["no scalar", "name", "of polygons", "a value", "one more", "part", "coordinates"],
)
def test_meshes_that_differ_in_anything_else_are_not_the_same(other: Mesh) -> None:
    one = mesh(MeshScalar("stress", VALUES))
    assert not has_same_tables(one, other)
    assert not has_same_tables(other, one)


NAN = math.nan


def stressed(**fields: Any) -> Scene:
    """A cube that has a scalar of its own, and shows it."""
    mesh = cube().with_scalars(MeshScalar("stress", np.arange(8.0)))
    scalar: Any = {"name": "stress", **fields}
    return scene_of(mesh, scalar=scalar)


@pytest.mark.parametrize(
    ("before", "change", "tier"),
    [
        ({}, {"scale": "grays"}, Tier.ENTRIES),
        ({}, {"missing": "#ffffff"}, Tier.ENTRIES),
        ({}, {"limits": [0, 1]}, Tier.LEVELS),
        ({}, {"bands": 5}, Tier.LEVELS),
        ({}, {"shades": 3}, Tier.LEVELS),
        ({}, {"name": "y"}, Tier.MIX),
        # A color beyond a limit has words of its own.
        ({}, {"below": "red"}, Tier.LEVELS),
        ({"below": "red"}, {"below": "blue"}, Tier.ENTRIES),
        ({"below": "red"}, {"below": None}, Tier.LEVELS),
    ],
)
def test_an_edit_costs_what_it_changes(before: Any, change: Any, tier: Tier) -> None:
    scene = stressed(**before)
    assert cost_of_edit(scene, scene.replace(scalar=change)) is tier


def test_a_computed_scalar_is_shown_as_well_as_one_of_the_mesh() -> None:
    scene = stressed().replace(scalar={"name": "z"})
    assert scene.scalar is not None
    assert scene.scalar.name == "z"
    assert scene.scalar_names[:3] == ("stress", "x", "y")


RULE = "scalar.name must be a scalar of the mesh or a computed scalar, not"

test_a_scalar_that_does_not_go_with_its_scene_is_refused = refused(
    call,
    [
        (
            lambda: stressed().replace(scalar={"name": "strss"}),
            f"{RULE} 'strss'; did you mean 'stress'?",
        ),
        (lambda: stressed().replace(scalar={"name": "Z"}), f"{RULE} 'Z'; did you mean 'z'?"),
        (
            lambda: stressed().replace(scalar={"surfaces": ["surfac"]}),
            "scalar 'stress': surfaces 'surfac' is not in the surface table; did you mean 'surface'?",
        ),
        (
            lambda: stressed().replace(words="normals"),
            "words must be 'levels' where a scalar colors surfaces, not 'normals'; change it, or remove the"
            " scalar",
        ),
    ],
)


def test_a_mesh_without_the_scalar_that_is_shown_is_refused() -> None:
    with pytest.raises(ValueError, match=f"^{RULE} 'stress'; choose 'x', "):
        stressed().replace(mesh=cube())


def plate(*scalars: MeshScalar) -> Mesh:
    return grid(2, 1, (0, 0, 0), (1, 0, 0), (0, 1, 0)).with_scalars(*scalars)


def test_values_are_float64_and_a_copy_unless_they_are_read_only() -> None:
    given = np.arange(6)
    scalar = MeshScalar("stress", given)  # type: ignore[arg-type]
    given[:] = 7
    assert scalar.values.dtype == np.float64
    assert scalar.values.tolist() == [0, 1, 2, 3, 4, 5]
    assert MeshScalar("again", scalar.values).values is scalar.values


def test_values_are_at_most_1e30_in_size_or_missing() -> None:
    assert MeshScalar("a", np.array([1e30, -1e30, NAN])).values[:2].tolist() == [1e30, -1e30]


test_what_is_no_scalar_of_a_mesh_is_refused = refused(
    call,
    [
        (
            lambda: MeshScalar("", np.zeros(2), "part"),
            "a scalar must have a name, not ''; give it a name\n"
            "scalar '': it must be of 'node' or 'polygon', not 'part'; choose one",
        ),
        *(
            (
                lambda value=value: MeshScalar("stress", np.array([1.0, NAN, value])),
                "scalar 'stress': a value must be at most 1e30 in size, or NaN if it is missing, not"
                f" {value:g} (row 2)",
            )
            for value in (
                math.inf,
                -math.inf,
                math.nextafter(1e30, math.inf),
                -math.nextafter(1e30, math.inf),
            )
        ),
        (
            lambda: MeshScalar("stress", np.zeros((2, 2))),
            "scalar 'stress': its values must be numbers in one dimension, not float64 of shape (2, 2);"
            " convert them",
        ),
        (
            lambda: plate(MeshScalar("a", np.zeros(2)), MeshScalar("b", np.zeros(3), "polygon")),
            "scalar 'a': there must be one value a node (6), not 2\n"
            "scalar 'b': there must be one value a polygon (2), not 3",
        ),
        (
            lambda: plate(MeshScalar("a", np.zeros(6)), MeshScalar("a", np.zeros(2), "polygon")),
            "scalar 'a': its name must be unique, not repeated; rename one",
        ),
    ],
)


def test_a_mesh_with_other_scalars_shares_its_tables_and_what_was_computed_of_them() -> None:
    mesh = plate()
    normals = mesh.normals
    other = mesh.with_scalars(MeshScalar("stress", np.zeros(6)))
    assert other.coordinates is mesh.coordinates
    assert other.normals is normals
    assert mesh.scalars == ()


def test_joined_meshes_keep_their_scalars_and_miss_those_of_others() -> None:
    one = plate(MeshScalar("stress", np.arange(6.0)))
    other = plate(MeshScalar("stress", np.array([1.0, 2.0]), "polygon"), MeshScalar("heat", np.full(6, 5.0)))
    joined = {scalar.name: scalar for scalar in Mesh.joined([one, other]).scalars}
    assert list(joined) == ["stress", "stress of polygons", "heat"]
    np.testing.assert_array_equal(joined["stress"].values, [0, 1, 2, 3, 4, 5, *[NAN] * 6])
    np.testing.assert_array_equal(joined["stress of polygons"].values, [NAN, NAN, 1, 2])
    np.testing.assert_array_equal(joined["heat"].values, [*[NAN] * 6, *[5] * 6])
