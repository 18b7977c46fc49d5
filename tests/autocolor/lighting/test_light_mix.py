from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Light, Part, Reflectance, Surface, render
from autocolor.lighting.light_mix import light_mix
from autocolor.scene.lights.links import Links
from autocolor.scene.reflection_models import CookTorrance, Phong, ReflectionModel
from tests.autocolor.meshes import sphere, wall_scene
from tests.autocolor.strategies import lights, numbers, surfaces

PHONG: dict[int, ReflectionModel] = {1: Phong(), 2: Phong()}


def named(names: list[str]) -> st.SearchStrategy[tuple[Light, ...]]:
    return st.tuples(*(lights(name) for name in names))


both = st.tuples(surfaces("one"), surfaces("other"))


@given(both, named(["key", "fill", "rim"]), numbers(0, 2))
def test_the_weights_are_intensity_times_d_and_s_in_proportion_to_the_largest(
    both: tuple[Surface, Surface], lights: tuple[Light, ...], ambient: float
) -> None:
    mix = light_mix(PHONG, both, lights, ambient, ())
    assert list(mix.lights) == [light.name for light in lights if light.on and light.intensity > 0]
    every = [ambient / mix.scale]
    for light in lights:
        for number, weights in mix.lights.get(light.name, {}).items():
            reflectance = both[number - 1].reflectance
            for weight, property_ in zip(weights, (reflectance.diffuse, reflectance.specular), strict=True):
                assert weight * mix.scale == pytest.approx(light.intensity * property_, rel=1e-6)
                every.append(float(weight))
    assert mix.ambient * mix.scale == pytest.approx(ambient, rel=1e-6)
    assert max(every) in (0.0, 1.0)


@given(both, named(["key", "fill"]), numbers(0, 2), st.integers(-40, 40))
def test_lights_and_ambient_2_to_the_k_times_as_strong_have_the_same_weights(
    both: tuple[Surface, Surface], lights: tuple[Light, ...], ambient: float, k: int
) -> None:
    stronger = [light.replace(intensity=light.intensity * 2.0**k) for light in lights]
    one, other = (
        light_mix(PHONG, both, lights, ambient, ()),
        light_mix(PHONG, both, stronger, ambient * 2.0**k, ()),
    )
    assert (one.ambient, one.lights) == (other.ambient, other.lights)


def test_only_visible_surfaces_have_weights() -> None:
    both = (Surface("one"), Surface("other"))
    mix = light_mix({2: Phong()}, both, [Light("key", (0, 0, 0))], 0.0, ())
    assert list(mix.lights["key"]) == [2]


def test_a_light_has_no_weight_on_a_surface_that_it_is_not_linked_to() -> None:
    both = (Surface("one"), Surface("other"))
    parts = (Part("left", "one"), Part("middle", "other"), Part("right", "other"))
    for links, lit in (
        ({"only_surfaces": ["one"]}, {1}),
        ({"except_surfaces": ["one"]}, {2}),
        ({"only_surfaces": []}, set()),
        ({"except_surfaces": []}, {1, 2}),
        ({"only_parts": ["left"]}, {1}),
        ({"except_parts": ["middle"]}, {1, 2}),
        ({"except_parts": ["middle", "right"]}, {1}),
        ({"only_parts": ["right"], "except_surfaces": ["other"]}, set()),
    ):
        light = Light("key", (0, 0, 0), 2.0, links=Links(**links))
        mix = light_mix(PHONG, both, [light], 0.0, parts)
        assert list(mix.lights["key"]) == [1, 2]
        assert {number for number, weights in mix.lights["key"].items() if any(weights)} == lit


def test_a_light_of_any_intensity_is_not_refused_for_surfaces_that_it_does_not_reach() -> None:
    strong = Light("key", (2, -3, 3), 1e39)
    for links in ({"except_surfaces": ["sphere"]}, {"except_parts": ["sphere"]}):
        scene = wall_scene(sphere(), lights=[strong.replace(**links)], ambient=0.5)  # type: ignore[arg-type]
        picture = render(scene, 12, 16)
        assert set(picture.intensity[picture.surface_number > 0].tolist()) == {0.5}
    with pytest.raises(InputError, match="surface 'sphere' under light 'key': intensities must stay below"):
        render(wall_scene(sphere(), lights=[strong.replace(only_parts=["sphere"])]), 12, 16)


def test_nothing_at_all_has_a_scale_of_1() -> None:
    assert light_mix({}, (), (), 0.0, ()) == (1.0, np.float32(0), {})


def test_what_a_model_may_add_counts_against_the_range_of_float32() -> None:
    both = (Surface("one", Reflectance(0.0, 1.0, 20.0)), Surface("other"))
    lights = [Light("key", (0, 0, 0), 1e37)]
    light_mix({1: Phong()}, both, lights, 0.0, ())
    with pytest.raises(InputError) as refused:
        light_mix({1: CookTorrance(0.3, 0.05)}, both, lights, 0.0, ())
    assert str(refused.value) == (
        "surface 'one' under light 'key': intensities must stay below 3.4e+38, not reach 9.81012e+38; lower"
        " the light's intensity or the surface's diffuse and specular"
    )


def test_intensities_that_float32_cannot_hold_are_refused_with_surface_and_light() -> None:
    lights = [Light("key", (2, -3, 3), 1e39), Light("fill", (2, -3, 3), 1.0)]
    with pytest.raises(
        InputError, match=r"surface 'sphere' under light 'key': intensities must stay below 3.4e\+38"
    ):
        render(wall_scene(sphere(), lights=lights))
    with pytest.raises(InputError, match=r"ambient must stay below 3.4e\+38, not 1e\+39; lower it"):
        render(wall_scene(sphere(), lights=[], ambient=1e39))
    huge = wall_scene(sphere(), lights=[Light("key", (2, -3, 3), 1e300)])
    with pytest.raises(InputError, match="lower the light's intensity"):
        render(huge.with_surface("sphere", reflectance=Reflectance(1e300, 0, 1)))


def test_an_ambient_that_float32_cannot_hold_is_refused_even_where_nothing_is_visible() -> None:
    scene = wall_scene().replace(ambient=1e39)
    for each in (scene, scene.with_view(eye=(0, 40, 0), direction=(0, 1, 0))):
        with pytest.raises(InputError) as refused:
            render(each, 9, 12)
        assert str(refused.value) == "ambient must stay below 3.4e+38, not 1e+39; lower it"
