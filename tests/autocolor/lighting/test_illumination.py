from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Mesh, Scene, Surface, View, scene_of
from autocolor.lighting.illumination import Previous, illuminate
from autocolor.lighting.picture import Picture
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong, ReflectionModel, SpecularGrowth
from autocolor.testing import lights, scenes
from autocolor.visibility.visible_points import VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.small import cube, sphere

RASTER = (12, 16)
SOME_MODELS: list[ReflectionModel] = [
    Phong(5.0),
    Phong(30.0),
    Phong(5.0, SpecularGrowth(base_reflectance=0.04)),
    BlinnPhong(5.0),
    CookTorrance(0.4),
]


def points_of(scene: Scene) -> VisiblePoints:
    one_sided = frozenset(number for number, surface in enumerate(scene.surfaces, 1) if not surface.two_sided)
    return visible_surfaces(scene.mesh, scene.view, scene.surface_number_of_part, *RASTER, one_sided)


def two_surfaces() -> Scene:
    return scene_of(
        Mesh.joined([sphere(12, 8), cube(1.2)]),
        surfaces=[Surface("sphere"), Surface("cube")],
        view=View((3, -4, 2), target=(0.3, 0.3, 0.3)),
    )


def modeled(sphere: ReflectionModel, cube: ReflectionModel) -> Scene:
    """The two surfaces with these models."""
    return two_surfaces().with_surface("sphere", model=sphere).with_surface("cube", model=cube)


def same(one: Picture, other: Picture) -> bool:
    return one.relative.tobytes() == other.relative.tobytes() and one.scale == other.scale


@given(scenes(), st.data())
def test_any_other_lights_after_any_lights_give_the_same_picture_as_without_reuse(
    scene: Scene, data: st.DataObject
) -> None:
    points = points_of(scene)
    names = st.lists(st.sampled_from(["key", "fill", "rim"]), max_size=3, unique=True)
    previous = Previous(scene, illuminate(scene, points))
    for _ in range(3):
        drawn = tuple(data.draw(lights(name)) for name in data.draw(names))
        changed = previous.scene.replace(lights=drawn, ambient=data.draw(st.sampled_from([0.0, 0.5])))
        picture = illuminate(changed, points, previous)
        assert same(picture, illuminate(changed, points))
        previous = Previous(changed, picture)


some_models = st.sampled_from(SOME_MODELS)


@given(some_models, some_models, some_models)
def test_a_change_of_a_model_gives_the_same_picture_as_without_reuse(
    old: ReflectionModel, new: ReflectionModel, cube: ReflectionModel
) -> None:
    scene, changed = modeled(old, cube), modeled(new, cube)
    points = points_of(scene)
    before = illuminate(scene, points)
    after = illuminate(changed, points, Previous(scene, before))
    assert same(after, illuminate(changed, points))
    for name, planes in after.light_planes.items():
        assert (planes.values is before.light_planes[name].values) == (old == new)


def test_an_edit_of_s_that_grows_keeps_every_plane_and_one_of_its_growth_its_own_surface_alone() -> None:
    grown = SpecularGrowth(refractive_index=1.5)
    scene = modeled(Phong(growth=grown), BlinnPhong(growth=grown))
    points = points_of(scene)
    before = illuminate(scene, points)
    brighter = scene.with_surface("sphere", specular=0.9)
    after = illuminate(brighter, points, Previous(scene, before))
    assert same(after, illuminate(brighter, points))
    assert not same(after, before)
    assert [
        planes.values is before.light_planes[name].values for name, planes in after.light_planes.items()
    ] == [True] * len(scene.lights)
    denser = scene.with_surface("cube", refractive_index=2.4)
    changed = illuminate(denser, points, Previous(scene, before))
    assert same(changed, illuminate(denser, points))
    of_sphere, of_cube = points.slices
    for name, planes in changed.light_planes.items():
        old = before.light_planes[name].values
        assert planes.values[:, of_sphere.pixels].tobytes() == old[:, of_sphere.pixels].tobytes()
        assert planes.values[0, of_cube.pixels].tobytes() == old[0, of_cube.pixels].tobytes()
        assert planes.values[1, of_cube.pixels].tobytes() != old[1, of_cube.pixels].tobytes()


def test_a_light_that_moved_or_was_off_when_a_model_changed_is_computed_again() -> None:
    scene = two_surfaces()
    points = points_of(scene)
    off = scene.with_light("key", on=False).with_surface("cube", exponent=3)
    on = off.with_light("key", on=True)
    previous = Previous(scene, illuminate(scene, points))
    moved = on.with_light("key", position=(0, -3, 1))
    for changed in (off, on, moved, moved.with_surface("sphere", specular=0.9)):
        picture = illuminate(changed, points, previous)
        assert same(picture, illuminate(changed, points))
        previous = Previous(changed, picture)


def test_every_plane_of_a_picture_is_read_only() -> None:
    scene = two_surfaces()
    picture = illuminate(scene, points_of(scene))
    assert picture.light_planes
    for planes in picture.light_planes.values():
        assert not planes.values.flags.writeable
    assert not picture.relative.flags.writeable


def test_nothing_visible_is_a_picture_of_nothing() -> None:
    scene = two_surfaces().with_view(eye=(0, 40, 0), direction=(0, 1, 0))
    picture = illuminate(scene.replace(lights=(Light("key", (0, 0, 9)),)), points_of(scene))
    assert len(picture.relative) == 0
    assert not picture.intensity.any()
