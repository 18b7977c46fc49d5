from __future__ import annotations

import numpy as np
import pytest

from autocolor import InputError, scene_of
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from tests.autocolor.meshes import cube


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
        "scalar.name must be a scalar of the mesh or a computed one, not 'strss'; did you mean 'stress'?",
    )
    with pytest.raises(InputError, match="not 'Z'; did you mean 'z'"):
        scene.replace(scalar={"name": "Z"})


def test_a_mesh_without_the_scalar_that_is_shown_is_refused() -> None:
    mesh = cube().with_scalars(MeshScalar("stress", np.arange(8.0)))
    scene = scene_of(mesh, scalar={"name": "stress"})
    with pytest.raises(InputError, match="a computed one, not 'stress'"):
        scene.replace(mesh=cube())
