from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light
from autocolor.lighting.light_controls.control import controls_of
from autocolor.lighting.light_controls.flap_sides import flap_sides, flaps_of
from autocolor.lighting.light_controls.sides import is_inside
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.strategies import lights, numbers


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
            inside = is_inside(sides[axis, end], rows)
            for point, value in zip(world, inside.tolist(), strict=True):
                beyond = point[number] - flap.minimum if end == "minimum" else flap.maximum - point[number]
                assert value == (beyond >= 0) or abs(beyond) < 1e-5


@given(numbers(-1, 1), numbers(0, 1), st.sampled_from("xz"))
def test_a_point_is_within_a_flap_up_to_both_its_ends(least: float, extent: float, axis: str) -> None:
    points = wall_points()
    flap = Flap(least, least + extent)
    (control,) = controls_of(Light("light", (0, -1, 0), flaps=Flaps(**{axis: flap})), points)
    lit = control.lit_points(points.rows, slice(None))
    assert lit is not None
    coordinate = points.world_points[:, "xyz".index(axis)]
    clear = np.minimum(np.abs(coordinate - flap.minimum), np.abs(coordinate - flap.maximum)) > 1e-5
    expected = (flap.minimum <= coordinate) & (coordinate <= flap.maximum)
    assert lit[clear].tolist() == expected[clear].tolist()


def test_flaps_that_are_off_or_without_limits_are_no_control() -> None:
    for flaps in (Flaps(x=Flap(0, 1, on=False)), Flaps(x=Flap(), y=Flap())):
        assert controls_of(Light("light", (0, -1, 0), flaps=flaps), wall_points()) == ()
