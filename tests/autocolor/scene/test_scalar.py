from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from autocolor import InputError, Mesh, scene_of
from autocolor.scene.columns import Tier, cost
from autocolor.scene.scalar import MeshScalar, Scalar
from autocolor.scene.scene import cost_of_edit
from tests.small import cube, grid


@pytest.mark.parametrize(
    ("change", "tier"),
    [
        ({"scale": "grays"}, Tier.ENTRIES),
        ({"missing": "#ffffff"}, Tier.ENTRIES),
        ({"limits": [0, 1]}, Tier.LEVELS),
        ({"bands": 5}, Tier.LEVELS),
        ({"shades": 3}, Tier.LEVELS),
        ({"name": "y"}, Tier.MIX),
    ],
)
def test_an_edit_costs_what_it_changes(change: Any, tier: Tier) -> None:
    scene = scene_of(cube(), scalar={"name": "x"})
    edited = scene.replace(scalar=change)
    assert isinstance(edited.scalar, Scalar)
    assert cost_of_edit(scene, edited) is tier


def test_surfaces_that_it_colors_must_exist() -> None:
    with pytest.raises(InputError, match="'glas' is not in the surface table"):
        scene_of(cube(), scalar={"name": "x", "surfaces": ["glas"]})


@pytest.mark.parametrize("limits", [(1, 1), (2, 1), (0, float("nan")), (0, float("inf")), (1,), "12", 5])
def test_limits_are_two_finite_numbers_the_second_above_the_first(limits: object) -> None:
    with pytest.raises(InputError, match=r"must be two finite numbers, the second above the"):
        Scalar("stress", limits)  # type: ignore[arg-type]


def test_a_color_beyond_a_limit_has_words_of_its_own() -> None:
    without, red, blue = (Scalar("stress", below=color) for color in (None, (255, 0, 0), (0, 0, 255)))
    assert cost(without, red) is Tier.LEVELS
    assert cost(red, blue) is Tier.ENTRIES


def test_all_color_scales_are_named_where_none_is_near() -> None:
    with pytest.raises(InputError, match=r"not 'jet'; choose 'viridis', .*'coolwarm'") as refusal:
        Scalar("stress", scale="jet")
    assert "_r'" not in str(refusal.value)


def test_an_unknown_color_scale_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(InputError, match=r"must be the name of a color scale, or a list of 2"):
        Scalar("stress", scale="virids")
    with pytest.raises(InputError, match=r"did you mean 'coolwarm'\?"):
        Scalar("stress", scale="cool-warm")
    for colors in (["red", "#00f"], "red, #00f", "[red, '#00f']"):
        assert Scalar("stress", scale=colors).scale == ((255, 0, 0), (0, 0, 255))  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"scale\[2\] must be \"#rrggbb\""):
        Scalar("stress", scale="red, grean")


def test_a_scalar_of_the_mesh_and_a_computed_one_can_be_shown() -> None:
    mesh = cube().with_scalars(MeshScalar("stress", np.arange(8.0)))
    for name in ("stress", "z"):
        scene = scene_of(mesh, scalar={"name": name})
        assert scene.scalar is not None
        assert scene.scalar.name == name


def test_an_unknown_scalar_is_refused_with_the_nearest_of_both() -> None:
    mesh = cube().with_scalars(MeshScalar("stress", np.arange(8.0)))
    scene = scene_of(mesh, scalar={"name": "stress"})
    with pytest.raises(InputError) as refused:
        scene.replace(scalar={"name": "strss"})
    assert refused.value.problems == (
        "scalar.name must be a scalar of the mesh or a computed scalar, not 'strss'; did you mean 'stress'?",
    )
    with pytest.raises(InputError, match="not 'Z'; did you mean 'z'"):
        scene.replace(scalar={"name": "Z"})


def test_a_mesh_without_the_scalar_that_is_shown_is_refused() -> None:
    mesh = cube().with_scalars(MeshScalar("stress", np.arange(8.0)))
    scene = scene_of(mesh, scalar={"name": "stress"})
    with pytest.raises(InputError, match="a computed scalar, not 'stress'"):
        scene.replace(mesh=cube())


NAN = float("nan")


def plate(*scalars: MeshScalar) -> Mesh:
    return grid(2, 1, (0, 0, 0), (1, 0, 0), (0, 1, 0)).with_scalars(*scalars)


def test_values_are_float64_and_a_copy_unless_they_are_read_only() -> None:
    given = np.arange(6)
    scalar = MeshScalar("stress", given)  # type: ignore[arg-type]
    given[:] = 7
    assert scalar.values.dtype == np.float64
    assert scalar.values.tolist() == [0, 1, 2, 3, 4, 5]
    assert MeshScalar("again", scalar.values).values is scalar.values


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"name": ""}, "a scalar must have a name, not ''; give it a name"),
        ({"of": "part"}, "scalar 'stress': it must be of 'node' or 'polygon', not 'part'; choose one"),
        (
            {"values": [1.0, np.inf]},
            "scalar 'stress': a value must be at most 1e30 in size, or NaN if it is missing, not inf (row 1)",
        ),
        (
            {"values": np.zeros((2, 2))},
            "scalar 'stress': its values must be numbers in one dimension, not float64 of shape (2, 2);"
            " convert them",
        ),
    ],
)
def test_what_is_no_scalar_is_refused(fields: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        MeshScalar(**{"name": "stress", "values": [0.0, 1.0], **fields})
    assert str(caught.value) == sentence


def test_a_mesh_has_one_value_for_each_row_and_one_scalar_of_each_name() -> None:
    with pytest.raises(InputError, match=r"scalar 'a': there must be one value a node \(6\), not 2"):
        plate(MeshScalar("a", np.zeros(2)))
    with pytest.raises(InputError, match=r"scalar 'a': its name must be unique, not repeated; rename one"):
        plate(MeshScalar("a", np.zeros(6)), MeshScalar("a", np.zeros(2), "polygon"))


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
