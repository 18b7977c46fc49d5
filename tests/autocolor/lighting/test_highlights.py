from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from autocolor import Light, Mesh, Reflectance, Scene, UsageError, View, render
from autocolor.lighting.highlights import highlight_of
from autocolor.lighting.light_drags import highlight_placed
from autocolor.rendering import Rendering, rendering
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong, ReflectionModel
from autocolor.visibility.sight import Sight, seen_at
from tests.autocolor.meshes import cube, grid, sphere, wall, wall_scene
from tests.autocolor.reference import minus, plus, times
from tests.autocolor.sessions import car
from tests.autocolor.strategies import lights, numbers, vectors

LINES, ELEMENTS = 60, 80

BALL = sphere(96, 48)

VIEWS = [
    View((0.0, -6.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0),
    View((4.0, 3.0, 2.5), target=(0.1, 0.0, 0.2), field_of_view=30.0, angle=25.0),
    View((0.0, 0.0, 7.0), direction=(0.0, 0.0, -1.0), field_of_view=22.0),
]


def sight_of(rendered: Rendering) -> Sight:
    return Sight(rendered.scene, rendered.points)


def rendered(scene: Scene) -> Rendering:
    return rendering(scene, LINES, ELEMENTS)


def on_ball(model: ReflectionModel, view: View, light: Light) -> Scene:
    return wall_scene(BALL, view=view, lights=[light, Light("other", (1.0, 1.0, 1.0))]).with_surface(
        "sphere", reflectance=Reflectance(0.6, 0.5, model)
    )


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("pixel", [(30, 40), (20, 33), (41, 52), (33, 27)])
@pytest.mark.parametrize("model", [Phong(20.0), Phong(1.0), BlinnPhong(30.0)])
@pytest.mark.parametrize(
    "controls", [{}, {"aim": (0.0, 0.0, 0.0), "concentration": 10.0, "cone_angle": 30.0}]
)
def test_a_highlight_is_found_where_it_was_placed_and_nothing_is_brighter(
    view: View, pixel: tuple[int, int], model: ReflectionModel, controls: dict[str, object]
) -> None:
    light = Light("light", (3.0, -6.0, 4.0), **controls)  # type: ignore[arg-type]
    before = rendered(on_ball(model, view, light))
    scene = highlight_placed(before.scene, seen_at(sight_of(before), *pixel), "light")
    after = rendering(scene, LINES, ELEMENTS, before)
    assert highlight_of(sight_of(after), "light") == pixel
    # cos(E) is 1 there: so is its power, up to rounding.
    specular = after.picture.planes["light"].specular
    assert specular[pixel] == pytest.approx(1.0, abs=2e-5)
    assert specular[pixel] >= specular.max() - 1e-6


@pytest.mark.parametrize("pixel", [(30, 40), (20, 33), (41, 52)])
def test_the_peak_of_a_fine_metal_is_within_a_pixel(pixel: tuple[int, int]) -> None:
    before = rendered(on_ball(CookTorrance(0.1), VIEWS[0], Light("light", (3.0, -6.0, 4.0))))
    scene = highlight_placed(before.scene, seen_at(sight_of(before), *pixel), "light")
    specular = rendering(scene, LINES, ELEMENTS, before).picture.planes["light"].specular
    line, element = np.unravel_index(int(specular.argmax()), specular.shape)
    assert max(abs(int(line) - pixel[0]), abs(int(element) - pixel[1])) <= 1


@given(vectors(numbers(-1.2, 1.2)), numbers(0.5, 5))
def test_the_highlight_on_a_wall_is_where_the_mirror_image_of_the_light_is_seen(
    beside: tuple[float, float, float], before: float
) -> None:
    view = View((0.5, -4.0, 0.25), target=(0.0, 0.0, 0.0), field_of_view=40.0)
    light = Light("light", (beside[0], -before, beside[2]))
    sight = sight_of(rendered(wall_scene(wall(3, 3, half=3.0), view=view, lights=[light])))
    seen = seen_at(sight, *(highlight_of(sight, "light") or (0, 0)))
    assert seen is not None
    image = (beside[0], before, beside[2])
    expected = plus(view.eye, times(4.0 / (4.0 + before), minus(image, view.eye)))
    pixel = 2 * math.tan(math.radians(20)) * 4.1 / LINES
    assert math.dist(seen.point, expected) < pixel


@given(lights())
def test_it_is_the_pixel_with_the_largest_cosine_of_all_and_of_each_surface(light: Light) -> None:
    # With an exponent of 1, Phong's specular plane is cos(E), where cos(I) is above 0.
    scene = car()
    for surface in scene.surfaces:
        scene = scene.with_surface(surface.name, reflectance=Reflectance(0.5, 0.5, Phong(1.0)))
    # Controls and switches are left out of it.
    bare = Light(light.name, light.position, direction=light.direction, at_infinity=light.at_infinity)
    cosines = render(scene.replace(lights=[bare]), LINES, ELEMENTS).planes[light.name].specular
    sight = sight_of(rendered(scene.replace(lights=[light])))
    numbers_at = rendered(scene).picture.surface_number
    for name in (None, "body", "glass", "wheels"):
        found = highlight_of(sight, light.name, name)
        number = 0 if name is None else [each.name for each in scene.surfaces].index(name) + 1
        here = cosines if name is None else np.where(numbers_at == number, cosines, 0)
        if found is None:
            assert here.max() <= 1e-6
        else:
            assert name is None or numbers_at[found] == number
            assert here[found] == pytest.approx(here.max(), abs=2e-5)


def test_there_is_no_highlight_where_no_light_is_reflected_to_the_eye() -> None:
    behind = wall_scene(lights=[Light("light", (0.0, 3.0, 0.0))])
    assert highlight_of(sight_of(rendered(behind)), "light") is None
    before = behind.with_light("light", position=(0.0, -3.0, 0.0))
    assert highlight_of(sight_of(rendered(before)), "light") is not None
    # A cube behind the wall is in use, but not seen.
    hidden = grid(1, 1, (-0.5, 1.0, -0.5), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), "hidden")
    both = wall_scene(Mesh.joined([wall(), hidden]), lights=before.lights)
    assert highlight_of(sight_of(rendered(both)), "light", "wall") is not None
    assert highlight_of(sight_of(rendered(both)), "light", "hidden") is None
    nothing = wall_scene(view=View((0.0, -4.0, 0.0), direction=(0.0, -1.0, 0.0)), lights=before.lights)
    assert highlight_of(sight_of(rendered(nothing)), "light") is None


def test_the_highlight_of_a_coarse_picture_is_in_the_middle_of_a_block() -> None:
    points = rendered(wall_scene(lights=[Light("light", (0.1, -3.0, 0.3))]))
    line, element = highlight_of(sight_of(points), "light") or (0, 0)
    assert highlight_of(Sight(points.scene, points.points, 4), "light") == (4 * line + 2, 4 * element + 2)


def test_unknown_lights_and_surfaces_are_refused() -> None:
    sight = sight_of(rendered(wall_scene(cube(), lights=[Light("key", (0.1, -3.0, 0.3))])))
    with pytest.raises(UsageError, match=r"there is no light 'kee'; did you mean 'key'\?"):
        highlight_of(sight, "kee")
    with pytest.raises(UsageError, match=r"there is no surface 'cub'; did you mean 'cube'\?"):
        highlight_of(sight, "key", "cub")
