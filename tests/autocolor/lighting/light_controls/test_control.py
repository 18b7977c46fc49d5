from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Light, render
from autocolor.arrays import Booleans, Singles
from autocolor.lighting.light_controls import control as light_controls
from autocolor.lighting.light_controls.concentration import Concentration
from autocolor.lighting.light_controls.cone import Cone
from autocolor.lighting.light_controls.control import CONTROLS, LightControl, LitPoints, controls_of
from autocolor.lighting.light_controls.flap_sides import FlapSides
from autocolor.lighting.light_controls.half_spaces import HalfSpaces
from autocolor.lighting.light_controls.soft_cone import SoftCone
from autocolor.lighting.light_controls.soft_sides import SoftSides
from autocolor.visibility.visible_points import POINT, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.meshes import wall, wall_scene
from tests.autocolor.strategies import lights


def test_a_point_source_without_flaps_has_no_controls() -> None:
    for light in (Light("light", (0, -1, 0)), Light("light", (0, -1, 0), direction=(0, 1, 0))):
        assert controls_of(light, wall_points()) == ()


@given(lights())
def test_a_light_has_the_controls_that_its_fields_ask_for(light: Light) -> None:
    used = {type(control) for control in controls_of(light, wall_points())}
    limits = [flap for flap in (light.flaps.x, light.flaps.y, light.flaps.z) if flap is not None and flap.on]
    assert (FlapSides in used) == bool(limits)
    planes = [half_space for half_space in light.half_spaces if half_space.on]
    assert (HalfSpaces in used) == bool(planes)
    widths = [flap.edge_width for flap in limits] + [plane.edge_width for plane in planes]
    assert (SoftSides in used) == any(width > 0 for width in widths)
    assert (Cone in used) == (light.cone_angle is not None)
    is_soft = light.inner_angle is not None and light.inner_angle != light.cone_angle
    assert (SoftCone in used) == is_soft
    assert (Concentration in used) == (light.concentration > 0)


def test_controls_are_in_the_order_of_their_modules_whichever_is_imported_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert controls_of(Light("light", (0, -1, 0)), wall_points()) == ()
    present = [*CONTROLS]
    monkeypatch.setattr(light_controls, "CONTROLS", [])
    for control in reversed(present):
        light_controls.registered(control)
    assert present == light_controls.CONTROLS
    assert [each.__module__ for each in present] == sorted(each.__module__ for each in present)


def test_a_control_is_added_by_one_registered_class(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(light_controls, "CONTROLS", [*CONTROLS])

    @light_controls.registered
    class Ramp(LightControl):
        """Half the light left of the middle, and from cos(L) = 0.9 inward in proportion to it."""

        directed = True
        least_cosine = 0.9

        def __init__(self, points: VisiblePoints) -> None:
            self.points = points

        @classmethod
        def of(cls, light: Light, points: VisiblePoints) -> Ramp:
            return cls(points)

        def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
            return np.asarray(rows[POINT][0] > 0)

        def factor(self, lit: LitPoints, out: Singles) -> Singles:
            assert lit.cos_light is not None
            return np.divide(lit.cos_light, 2, out=out)

    light = Light("light", (0.0, -1.0, 0.0), direction=(0, 1, 0), concentration=3)
    controlled = render(wall_scene(lights=[light]), 40, 40)
    monkeypatch.undo()
    free = render(wall_scene(lights=[light.replace(concentration=0)]), 40, 40)
    points = visible_surfaces(wall(), wall_scene().view, (1,), 40, 40)
    x, _, z = points.world_points.T
    cos_light = np.zeros(1600)
    cos_light[points.pixels] = 1 / np.sqrt(1 + x * x + z * z)
    right = np.zeros(1600, np.bool_)
    right[points.pixels] = x > 0
    left_of_it = np.where((cos_light >= 0.9) & right, cos_light**3 * cos_light / 2, 0)
    assert controlled.intensity.ravel() == pytest.approx(left_of_it * free.intensity.ravel(), rel=1e-4)


@pytest.mark.parametrize("is_aimed", [True, False])
@pytest.mark.parametrize("few", [True, False])
def test_a_factor_may_depend_on_distance_and_place_of_any_light(
    monkeypatch: pytest.MonkeyPatch, is_aimed: bool, few: bool
) -> None:
    monkeypatch.setattr(light_controls, "CONTROLS", [*CONTROLS])

    @light_controls.registered
    class Falloff(LightControl):
        """Less with the distance, and less to the right."""

        def __init__(self, points: VisiblePoints) -> None:
            self.points = points

        @classmethod
        def of(cls, light: Light, points: VisiblePoints) -> Falloff:
            return cls(points)

        def lit_points(self, rows: Singles, pixels: slice) -> Booleans | None:
            return np.asarray(rows[POINT][1] > 0.8 * rows[POINT][1].max()) if few else None

        def factor(self, lit: LitPoints, out: Singles) -> Singles:
            size = np.float32(self.points.radius)
            out[:] = np.exp(-lit.distance() - lit.positions()[0] / size)
            return out

    given = {"direction": (0, 1, 0), "concentration": 2.0} if is_aimed else {}
    light = Light("light", (0.0, -1.0, 0.0), **given)  # type: ignore[arg-type]
    scene = wall_scene(lights=[light])
    controlled = render(scene, 40, 40)
    monkeypatch.undo()
    free = render(scene, 40, 40)
    points = visible_surfaces(wall(), scene.view, (1,), 40, 40)
    away = np.linalg.norm(points.world_points - np.array(light.position), axis=1) / points.unit
    expected = np.exp(-away - points.rows[POINT][0] / points.radius) * free.intensity.ravel()[points.pixels]
    is_lit = points.rows[POINT][1] > 0.8 * points.rows[POINT][1].max() if few else True
    intensities = controlled.intensity.ravel()[points.pixels]
    assert intensities == pytest.approx(np.where(is_lit, expected, 0), rel=1e-4)
