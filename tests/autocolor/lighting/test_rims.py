from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given

from autocolor import Flap, Flaps, HalfSpace, Light, Mesh, Scene, UsageError, View, render
from autocolor.lighting.rims import Plane, Rim, rims
from autocolor.rendering import rendering
from autocolor.visibility.sight import Sight
from tests.autocolor.meshes import cube, grid, sphere, wall, wall_scene
from tests.autocolor.strategies import Vector, directions, numbers

LINES, ELEMENTS = 60, 80

FILLING = View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0)
"""A wall of half a width of 2 fills the picture."""

VIEWS = [FILLING, View((1.5, -4.0, 1.0), target=(0.1, 0.0, 0.2), field_of_view=35.0, angle=20.0)]


def sight_of(scene: Scene, block: int = 1) -> Sight:
    return Sight(scene, rendering(scene, LINES, ELEMENTS).points, block)


def points_at(sight: Sight, pixels: npt.NDArray[np.intp]) -> npt.NDArray[np.float64]:
    """The points seen at pixels, (n, 3)."""
    raster = np.full((LINES * ELEMENTS, 3), np.nan)
    raster[sight.points.pixels] = sight.points.world_points
    return raster.reshape(LINES, ELEMENTS, 3)[pixels[:, 0], pixels[:, 1]]


def lit_beside_dark(lit: npt.NDArray[np.bool_]) -> list[list[int]]:
    """The slow twin: the lit pixels with a dark one above, below, left or right of them."""
    return [
        [line, element]
        for line, element in np.argwhere(lit).tolist()
        if any(
            0 <= other < LINES and 0 <= another < ELEMENTS and not lit[other, another]
            for other, another in (
                (line - 1, element),
                (line + 1, element),
                (line, element - 1),
                (line, element + 1),
            )
        )
    ]


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("angle", [5.0, 9.0, 12.0])
def test_the_rim_of_a_cone_straight_above_a_plane_is_a_circle(view: View, angle: float) -> None:
    light = Light("light", (0.1, -3.0, 0.05), direction=(0.0, 1.0, 0.0), cone_angle=angle)
    sight = sight_of(wall_scene(wall(3, 2, half=2.0), view=view, lights=[light]))
    found = rims(sight, "light")
    assert list(found) == ["cone"]
    at = points_at(sight, found["cone"])
    radius, pixel = 3 * math.tan(math.radians(angle)), 2 * math.tan(math.radians(17.5)) * 5 / LINES
    distance = np.hypot(at[:, 0] - 0.1, at[:, 2] - 0.05)
    assert distance.max() <= radius + 1e-4
    assert distance.min() >= radius - 1.5 * pixel
    # It goes all the way around.
    around = np.sort(np.arctan2(at[:, 2] - 0.05, at[:, 0] - 0.1))
    assert np.diff(around, append=around[0] + 2 * math.pi).max() < 3 * pixel / radius


@given(numbers(1, 60), directions)
def test_the_rim_of_a_cone_is_where_the_light_ends(angle: float, direction: Vector) -> None:
    light = Light("light", (0.2, -1.0, 0.1), direction=direction, cone_angle=angle)
    scene = wall_scene(wall(3, 2, half=2.0), view=FILLING, lights=[light])
    lit = render(scene, LINES, ELEMENTS).planes["light"].diffuse > 0
    assert rims(sight_of(scene), "light")["cone"].tolist() == lit_beside_dark(lit)


FLAPS: list[tuple[Rim, Flaps]] = [
    (("x", "minimum"), Flaps(x=Flap(minimum=0.21))),
    (("x", "maximum"), Flaps(x=Flap(maximum=0.21))),
    (("y", "minimum"), Flaps(y=Flap(minimum=-0.3))),
    (("y", "maximum"), Flaps(y=Flap(maximum=-0.3))),
    (("z", "minimum"), Flaps(z=Flap(minimum=-0.43))),
    (("z", "maximum"), Flaps(z=Flap(maximum=-0.43))),
]


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize(("rim", "flaps"), FLAPS)
def test_the_rim_of_a_flap_is_where_the_light_ends(rim: Rim, flaps: Flaps, view: View) -> None:
    leaning = grid(4, 4, (-2.0, -0.8, -2.0), (4.0, 0.5, 0.0), (0.0, 0.7, 4.0))
    light = Light("light", (0.2, -9.0, 0.1), flaps=flaps)
    scene = wall_scene(leaning, view=view, lights=[light])
    picture = render(scene, LINES, ELEMENTS)
    lit = picture.planes["light"].diffuse > 0
    twin = [
        pixel
        for pixel in lit_beside_dark(lit | (picture.surface_number == 0))
        if picture.surface_number[tuple(pixel)]
    ]
    found = rims(sight_of(scene), "light")
    assert list(found) == [rim]
    assert len(twin) > 20
    assert found[rim].tolist() == twin


def test_the_rims_of_all_controls_are_found_by_themselves() -> None:
    flaps = Flaps(Flap(-0.5, 0.5), Flap(-0.4, 0.4), Flap(-0.3, 0.3))
    light = Light("light", (0.2, -6.0, 0.1), aim=(0.0, 0.0, 0.0), cone_angle=6, flaps=flaps)
    scene = wall_scene(sphere(64, 32), view=VIEWS[1], lights=[light])
    found = rims(sight_of(scene), "light")
    assert len(found) == 7
    for rim, pixels in found.items():
        alone = Light("light", light.position, aim=light.aim)
        if rim == "cone":
            alone = alone.replace(cone_angle=6)
        else:
            assert not isinstance(rim, Plane)
            axis, end = rim
            limit = getattr(getattr(flaps, axis), end)
            alone = alone.replace(flaps=Flaps(**{axis: Flap(**{end: limit})}))
            # The pixels are next to the end of the flap, also where the sphere turns away from the eye.
            coordinate = points_at(sight_of(scene), pixels)[:, "xyz".index(axis)]
            inward = coordinate - limit if end == "minimum" else limit - coordinate
            assert inward.min(initial=0.0) > -1e-5
            assert inward.max(initial=0.0) < 0.2
        assert rims(sight_of(scene.replace(lights=[alone])), "light")[rim].tolist() == pixels.tolist()
    assert len(found["cone"]) > 20
    assert len(found["y", "maximum"]) == 0


def test_a_silhouette_is_no_rim() -> None:
    floating = Mesh.joined([cube(0.7), grid(2, 2, (-3.0, 4.0, -3.0), (6.0, 0.0, 0.0), (0.0, 0.0, 6.0))])
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(y=Flap(maximum=2.0)))
    scene = wall_scene(floating, view=FILLING, lights=[light])
    picture = render(scene, LINES, ELEMENTS)
    assert len(lit_beside_dark(picture.planes["light"].diffuse > 0)) > 20
    assert rims(sight_of(scene), "light")["y", "maximum"].tolist() == []


def test_the_end_of_a_line_is_no_neighbor_of_the_next() -> None:
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(minimum=0.0)))
    scene = wall_scene(wall(1, 1, half=3.0), view=FILLING, lights=[light])
    assert rims(sight_of(scene), "light")["x", "minimum"].tolist() == [
        [line, ELEMENTS // 2] for line in range(LINES)
    ]


def test_only_what_ends_has_a_rim() -> None:
    for light in (
        Light("light", (0.0, -9.0, 0.0)),
        Light("light", (0.0, -9.0, 0.0), aim=(0, 0, 0), concentration=5),
        Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(0.0, 1.0, on=False), z=Flap())),
    ):
        assert rims(sight_of(wall_scene(lights=[light])), "light") == {}
    aside = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(minimum=50.0)))
    found = rims(sight_of(wall_scene(lights=[aside])), "light")
    assert {rim: pixels.shape for rim, pixels in found.items()} == {("x", "minimum"): (0, 2)}
    away = View((0.0, -4.0, 0.0), direction=(0.0, -1.0, 0.0))
    nothing = rims(sight_of(wall_scene(view=away, lights=[aside])), "light")
    assert nothing["x", "minimum"].shape == (0, 2)


def test_the_rim_of_a_coarse_picture_is_in_the_middle_of_its_blocks() -> None:
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(minimum=0.3)))
    scene = wall_scene(lights=[light])
    fine, coarse = (rims(sight_of(scene, block), "light")["x", "minimum"] for block in (1, 2))
    assert coarse.tolist() == (2 * fine + 1).tolist()


def test_the_rims_of_an_unknown_light_are_refused() -> None:
    with pytest.raises(UsageError, match=r"there is no light 'kee'"):
        rims(sight_of(wall_scene()), "kee")


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("edge_width", [0.0, 0.4])
@pytest.mark.parametrize("carried", [False, True])
def test_the_rim_of_a_half_space_is_where_the_light_ends(
    view: View, edge_width: float, carried: bool
) -> None:
    plane = HalfSpace("left", (0.13, 0.2, 0.1), (1.0, 0.1, 0.5), edge_width, carried)
    light = Light("light", (0.2, -9.0, 0.1), aim=(0.0, 0.0, 0.0), half_spaces=(plane,))
    scene = wall_scene(wall(3, 2, half=2.5), view=view, lights=[light])
    picture = render(scene, LINES, ELEMENTS)
    lit = picture.planes["light"].diffuse > 0
    found = rims(sight_of(scene), "light")
    assert list(found) == [Plane("left")]
    twin = [
        p for p in lit_beside_dark(lit | (picture.surface_number == 0)) if picture.surface_number[tuple(p)]
    ]
    assert len(twin) > 20
    assert found[Plane("left")].tolist() == twin


def test_a_soft_cone_ends_at_its_cone_angle() -> None:
    light = Light("light", (0.1, -3.0, 0.05), direction=(0.0, 1.0, 0.0), cone_angle=9)
    found = [
        rims(sight_of(wall_scene(wall(half=2.0), view=FILLING, lights=[each])), "light")["cone"].tolist()
        for each in (light, light.replace(inner_angle=4))
    ]
    assert found[0] == found[1]


def test_any_number_of_half_spaces_have_rims_of_their_own() -> None:
    planes = tuple(
        HalfSpace(f"plane {number}", (0.1 * number - 0.9, 0, 0), (1, 0, 0.1)) for number in range(19)
    )
    light = Light("light", (0.2, -6.0, 0.1), half_spaces=planes, flaps=Flaps(z=Flap(-0.5, 0.5)))
    found = rims(sight_of(wall_scene(wall(half=2.0), view=FILLING, lights=[light])), "light")
    assert len(found) == 21
    for plane in planes:
        alone = light.replace(half_spaces=(plane,), flaps=Flaps())
        rim = rims(sight_of(wall_scene(wall(half=2.0), view=FILLING, lights=[alone])), "light")
        assert found[Plane(plane.name)].tolist() == rim[Plane(plane.name)].tolist() != []
