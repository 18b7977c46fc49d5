from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from autocolor import Mesh, Scene, scene_of
from autocolor.scene.columns import Tier
from autocolor.scene.scalar import MeshScalar
from autocolor.scene.scene import cost_of_edit
from tests.small import cube, grid
from tests.tables import call, refused

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
