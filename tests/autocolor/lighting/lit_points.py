"""Points of a wall, and what a control may ask about some of them."""

from __future__ import annotations

from autocolor import View
from autocolor.arrays import Singles
from autocolor.lighting.controls import LitPoints
from autocolor.visibility.visible_points import VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import wall


def wall_points() -> VisiblePoints:
    return visible_surfaces(wall(), View((1, -4, 1), target=(0, 0, 0)), (1,), 12, 12)


def lit_at(cosines: Singles) -> LitPoints:
    """Points at these cosines from the light's direction, whose places nobody asks for."""

    def nobody_asks() -> Singles:
        raise AssertionError

    return LitPoints(cosines, nobody_asks, nobody_asks)
