from __future__ import annotations

from typing import Any

import pytest

from autocolor import InputError, scene_of
from autocolor.scene.columns.column import Tier
from autocolor.scene.scalars.scalar import Scalar
from autocolor.scene.scene import cost_of_edit
from tests.autocolor.meshes import cube


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
