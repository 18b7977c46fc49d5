from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import InputError, Mesh, Picture, Scene, Surface, render, scene_of
from autocolor.mapping.band_division import bands_by_surface, colored_surfaces, own_limits
from autocolor.mapping.display_image import display_image
from autocolor.mapping.level_ranges import SURFACE_WORDS
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from tests.autocolor.meshes import grid
from tests.autocolor.strategies import scenes


def panes(count: int, *values: float, **scalar: Any) -> Scene:
    """Quads side by side, each of a surface of its own, with a scalar of the polygons."""
    mesh = Mesh.joined(
        [grid(1, 1, (2.0 * number, 0, 0), (1, 0, 0), (0, 0, 1), f"pane {number}") for number in range(count)]
    )
    given_values = np.resize(np.array(values or (0.0, 10.0)), count)
    return scene_of(
        mesh.with_scalars(MeshScalar("stress", given_values, "polygon")),
        surfaces=[Surface(name) for name in mesh.part_names],
        surface_of_part={name: name for name in mesh.part_names},
    ).with_scalar(**{"name": "stress", **scalar})


def bands_of(scene: Scene) -> Any:
    return bands_by_surface(scene, render(scene, 48, 64))


def test_without_a_scalar_there_are_no_bands() -> None:
    scene = panes(2)
    assert bands_of(scene.without_scalar()) == {}
    assert (
        bands_by_surface(
            scene,
            Picture.from_rasters(
                np.ones((2, 2), np.float32), np.ones((2, 2), np.uint8), ("pane 0", "pane 1"), 1.0
            ),
        )
        == {}
    )


def test_there_are_eight_shades_where_the_words_suffice_and_fewer_where_they_do_not() -> None:
    assert {each.shades for each in bands_of(panes(2)).values()} == {8}
    assert {each.shades for each in bands_of(panes(2, bands=100)).values()} == {5}
    assert {each.shades for each in bands_of(panes(60)).values()} == {1}


def test_as_many_shades_are_made_as_are_asked_for() -> None:
    (bands, other) = bands_of(panes(2, bands=30, shades=16)).values()
    assert bands == other
    assert (bands.bands, bands.shades) == (30, 16)


def test_too_many_are_refused_by_name_with_what_there_is_and_what_to_do() -> None:
    with pytest.raises(InputError) as refusal:
        bands_of(panes(2, bands=64, shades=8))
    assert str(refusal.value) == (
        "surface 'pane 0' and 1 more: the bands of scalar 'stress' times their shades must be at most the"
        " 1007 words that are left for them, not 128 x 8 = 1024; choose at most 7 shades, or fewer bands"
    )
    with pytest.raises(InputError) as refusal:
        bands_of(panes(5, bands=256))
    assert str(refusal.value) == (
        "surface 'pane 0' and 4 more: the bands of scalar 'stress' times their shades must be at most the"
        " 1007 words that are left for them, not 1280 x 1 = 1280; even one shade of each needs 1280;"
        " choose fewer bands, or let it color fewer surfaces"
    )


def test_the_surfaces_that_are_not_colored_share_the_rest_as_ever() -> None:
    scene = panes(3, surfaces=["pane 1"], shades=4)
    image = display_image(scene, render(scene, 48, 64))
    assert list(image.bands) == ["pane 1"]
    assert image.ranges["pane 1"].levels == 64
    assert sum(each.levels for each in image.ranges.values()) == SURFACE_WORDS
    equal = display_image(scene.replace(division="equal"), image.picture)
    assert [each.levels for each in equal.ranges.values()] == [(SURFACE_WORDS - 64) // 2, 64, 471]


def test_a_surface_of_stage_parts_alone_keeps_its_own_colors_unless_it_is_named() -> None:
    scene = panes(2).with_part("pane 0", stage=True)
    assert list(colored_surfaces(scene)) == ["pane 1"]
    assert list(colored_surfaces(scene.with_scalar(surfaces=["pane 0"]))) == ["pane 0"]
    assert list(colored_surfaces(scene.without_scalar())) == []


def test_missing_values_have_a_band_on_the_surfaces_where_they_are_seen() -> None:
    bands = bands_of(panes(2, np.nan, 3.0))
    assert bands["pane 0"].has_missing
    assert not bands["pane 1"].has_missing


def test_values_beyond_the_limits_have_bands_where_there_are_limits_and_colors() -> None:
    with_colors = {"below": "black", "above": "red"}
    (bands, *_) = bands_of(panes(2, limits=[2, 8], **with_colors)).values()
    assert (bands.has_below, bands.has_above) == (True, True)
    (bands, *_) = bands_of(panes(2, **with_colors)).values()
    assert (bands.has_below, bands.has_above) == (False, False)
    (bands, *_) = bands_of(panes(2, limits=[2, 8], above="red")).values()
    assert (bands.has_below, bands.has_above) == (False, True)


@pytest.mark.parametrize(
    ("values", "limits"),
    [
        ((2.0, 5.0), (2.0, 5.0)),
        ((4.0, 4.0), (2.0, 6.0)),
        ((0.0, 0.0), (-0.5, 0.5)),
        ((-4.0, -4.0), (-6.0, -2.0)),
        ((np.nan, np.nan), (0.0, 1.0)),
    ],
)
def test_the_own_limits_are_those_of_the_values_or_around_the_only_one(
    values: tuple[float, ...], limits: tuple[float, float]
) -> None:
    assert own_limits(render(panes(2, *values), 48, 64)) == limits


@given(scenes())
def test_every_word_of_a_colored_surface_tells_band_and_shade(scene: Scene) -> None:
    picture = render(scene, 9, 12)
    image = display_image(scene, picture)
    for name, bands in image.bands.items():
        first, levels = image.ranges[name]
        assert levels == bands.levels
        seen = image.words[picture.surface_number == picture.surfaces.index(name) + 1]
        assert ((seen >= first) & (seen < first + levels)).all()
