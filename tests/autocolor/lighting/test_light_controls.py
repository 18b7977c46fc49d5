from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light, View, render
from autocolor.arrays import Booleans, Singles
from autocolor.lighting import light_controls
from autocolor.lighting.light_controls import (
    CONTROLS,
    Concentration,
    Cone,
    FlapSides,
    LightControl,
    LitPoints,
    controls_of,
    flap_sides,
    flaps_of,
    is_inside,
)
from autocolor.visibility.visible_points import POINT, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import wall, wall_scene
from tests.autocolor.strategies import lights, numbers


def wall_points() -> VisiblePoints:
    return visible_surfaces(wall(), View((1, -4, 1), target=(0, 0, 0)), (1,), 12, 12)


def lit_at(cosines: Singles) -> LitPoints:
    """Points at these cosines from the light's direction, whose places nobody asks for."""

    def nobody_asks() -> Singles:
        raise AssertionError

    return LitPoints(cosines, nobody_asks, nobody_asks)


def factor(cosines: list[float], concentration: float) -> Singles:
    given_as = np.array(cosines, np.float32)
    return Concentration(concentration).factor(lit_at(given_as), out=np.empty_like(given_as))


@given(numbers(0, 60), numbers(1e-6, 1))
def test_the_concentrated_light_is_the_cosine_to_the_power_of_the_concentration(
    concentration: float, cosine: float
) -> None:
    value = factor([cosine], concentration)[0]
    assert value == pytest.approx(float(np.float32(cosine)) ** concentration, rel=2e-5, abs=1e-30)


@pytest.mark.parametrize(("concentration", "degrees"), [(1, 60.0), (10, 21.1), (40, 10.6)])
def test_half_is_left_at_the_papers_angles(concentration: float, degrees: float) -> None:
    assert factor([math.cos(math.radians(degrees))], concentration)[0] == pytest.approx(0.5, abs=0.005)


@given(st.lists(numbers(-1, 1), min_size=2), st.sampled_from([0.5, 1, 2, 40, 1e6, 1e30, 1e300]))
def test_the_factor_never_leaves_0_to_1(cosines: list[float], concentration: float) -> None:
    values = factor([*cosines, 1.0000002], concentration)
    assert ((values >= 0) & (values <= 1)).all()


def test_a_factor_may_overwrite_the_cosines() -> None:
    cosines = np.array([0.5, 1.0], np.float32)
    assert Concentration(2.0).factor(lit_at(cosines), out=cosines) is cosines
    assert cosines.tolist() == [0.25, 1.0]


def test_a_point_source_without_flaps_has_no_controls() -> None:
    for light in (Light("light", (0, -1, 0)), Light("light", (0, -1, 0), direction=(0, 1, 0))):
        assert controls_of(light, wall_points()) == ()


@given(lights())
def test_a_light_has_the_controls_that_its_fields_ask_for(light: Light) -> None:
    used = {type(control) for control in controls_of(light, wall_points())}
    limits = [flap for flap in (light.flaps.x, light.flaps.y, light.flaps.z) if flap is not None and flap.on]
    assert (FlapSides in used) == bool(limits)
    assert (Cone in used) == (light.cone_angle is not None)
    assert (Concentration in used) == (light.concentration > 0)


@given(lights(), st.lists(st.tuples(*[numbers(-1, 1)] * 3), min_size=1, max_size=20))
def test_a_point_is_inside_a_side_of_a_flap_up_to_its_coordinate(
    light: Light, world: list[tuple[float, float, float]]
) -> None:
    points = wall_points()
    rows = np.array([points.camera_point(point) for point in world], np.float32).T
    sides = flap_sides(light, points)
    for number, (axis, flap) in enumerate(flaps_of(light).items()):
        for end in ("minimum", "maximum"):
            assert ((axis, end) in sides) == (flap is not None and flap.on)
            if flap is None or not flap.on:
                continue
            inside = is_inside(sides[axis, end].astype(np.float32), rows)
            for point, value in zip(world, inside.tolist(), strict=True):
                beyond = point[number] - flap.minimum if end == "minimum" else flap.maximum - point[number]
                assert value == (beyond >= 0) or abs(beyond) < 1e-5


@pytest.mark.parametrize(
    ("cosine", "cone_angle", "concentration", "lit"),
    [
        (0.5, 60.0, 0.0, True),
        (0.49999, 60.0, 0.0, False),
        (-0.5, 121.0, 0.0, True),
        (-0.5, 121.0, 1.0, False),
        (0.0, 90.0, 0.0, True),
        (0.0, 90.0, 1.0, False),
        (0.0, None, 1.0, False),
        (1e-6, None, 1.0, True),
        (1e-45, None, 1.0, True),
        (-1.0, 180.0, 0.0, True),
        (1.0, 0.001, 40.0, True),
    ],
)
def test_a_point_is_in_the_cone_up_to_its_rim_and_before_a_concentrated_light(
    cosine: float, cone_angle: float | None, concentration: float, lit: bool
) -> None:
    light = Light(
        "light", (0, -1, 0), direction=(0, 1, 0), cone_angle=cone_angle, concentration=concentration
    )
    controls = controls_of(light, wall_points())
    assert all(control.directed for control in controls)
    least = max(control.least_cosine for control in controls)
    assert bool(np.float32(cosine) >= np.float32(least)) == lit


@given(numbers(0.001, 180), numbers(-1, 1))
def test_the_largest_least_cosine_is_the_cone_and_the_hemisphere(cone_angle: float, cosine: float) -> None:
    light = Light("light", (0, -1, 0), direction=(0, 1, 0), cone_angle=cone_angle, concentration=1)
    least = np.float32(max(control.least_cosine for control in controls_of(light, wall_points())))
    rim = np.float32(math.cos(math.radians(cone_angle)) - np.finfo(np.float32).eps)
    for each in (np.float32(cosine), rim, np.float32(0), np.nextafter(rim, np.float32(-2))):
        assert (each >= least) == (each >= rim and each > 0)


@given(numbers(-1, 1), numbers(0, 1), st.sampled_from("xz"))
def test_a_point_is_within_a_flap_up_to_both_its_ends(least: float, extent: float, axis: str) -> None:
    points = wall_points()
    flap = Flap(least, least + extent)
    (control,) = controls_of(Light("light", (0, -1, 0), flaps=Flaps(**{axis: flap})), points)
    lit = control.lit_points(points.rows)
    assert lit is not None
    coordinate = points.world_points[:, "xyz".index(axis)]
    clear = np.minimum(np.abs(coordinate - flap.minimum), np.abs(coordinate - flap.maximum)) > 1e-5
    expected = (flap.minimum <= coordinate) & (coordinate <= flap.maximum)
    assert lit[clear].tolist() == expected[clear].tolist()


def test_flaps_that_are_off_or_without_limits_are_no_control() -> None:
    for flaps in (Flaps(x=Flap(0, 1, on=False)), Flaps(x=Flap(), y=Flap())):
        assert controls_of(Light("light", (0, -1, 0), flaps=flaps), wall_points()) == ()


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

        def lit_points(self, rows: Singles) -> Booleans:
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

        def lit_points(self, rows: Singles) -> Booleans | None:
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
