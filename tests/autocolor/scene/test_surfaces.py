from __future__ import annotations

import ast
import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Paint, Part, Reflectance, Surface, UsageError, image, render, scene_of
from autocolor.arrays import Singles
from autocolor.scene.color_scales import COLOR_SCALES, IN_TURN, scale_colors
from autocolor.scene.columns import difference, from_plain, replaced, to_plain
from autocolor.scene.curves import CURVES, group_starts, mapping_curve
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong
from autocolor.scene.swatches import COLUMNS, FINISHES, ROWS, finished, mixed, swatches
from autocolor.testing import colors, paints, surfaces
from docs.generate.changes import WRITTEN, source
from tests.small import STRETCHED, sphere
from tests.tables import call, refused


def mapped(mapping: Any, intensities: Singles) -> Singles:
    """The fractions of intensities by the extent that they have themselves."""
    return mapping_curve(mapping)(intensities.min(), intensities.max(), intensities)(intensities)


@pytest.mark.parametrize("mapping", CURVES)
@given(steps=st.lists(st.integers(0, 50), min_size=2).filter(lambda steps: min(steps) < max(steps)))
def test_every_named_curve_goes_from_0_to_1_and_leaves_its_intensities_alone(
    mapping: str, steps: list[int]
) -> None:
    intensities = np.array(sorted(steps), np.float32)
    fractions = mapped(mapping, intensities)
    assert fractions[0] == 0
    assert fractions[-1] == pytest.approx(1)
    assert (np.diff(fractions) >= 0).all()
    assert intensities.tolist() == sorted(steps)


def test_gamma_and_logarithm_lift_the_dark() -> None:
    for mapping in ("gamma", "logarithm"):
        middle = mapped(mapping, np.array([0, 0.1, 0.5, 1], np.float32))[1:3]
        assert (middle > [0.3, 0.7]).all()


def test_points_are_joined_by_straight_lines() -> None:
    points = ((0, 0), (0.5, 0.2), (1, 1))
    assert mapped(points, np.array([10, 15, 17.5, 20], np.float32)).tolist() == pytest.approx(
        [0, 0.2, 0.6, 1]
    )


@given(st.lists(st.integers(0, 100), min_size=2, max_size=60, unique=True))
def test_equalize_shows_every_level_equally_often(steps: list[int]) -> None:
    intensities = np.array(steps, np.float32) ** 3
    fractions = mapped("equalize", intensities)
    assert sorted(fractions.tolist()) == pytest.approx(np.linspace(0, 1, len(steps)).tolist())
    assert np.argsort(fractions).tolist() == np.argsort(intensities).tolist()


def test_equalized_intensities_that_differ_by_rounding_have_one_level_and_a_smooth_ramp_stays_smooth() -> (
    None
):
    sheet = np.array([0.3, 0.622973084, 0.622973144, 0.622973084, 1.0], np.float32)
    fractions = mapped("equalize", sheet)
    assert fractions.tolist() == [0, 0.75, 0.75, 0.75, 1]
    ramp = np.linspace(0.5, 0.500001, 200).astype(np.float32)
    ramp = np.concatenate([ramp, np.linspace(0.51, 1, 9800).astype(np.float32)])
    assert np.diff(mapped("equalize", ramp)).max() < 0.012


@given(st.lists(st.integers(0, 60), min_size=1, unique=True), st.integers(0, 20))
def test_groups_begin_at_their_lowest_value_and_span_a_width(steps: list[int], width: int) -> None:
    values = np.array(sorted(steps), np.float32)
    starts: list[int] = []
    for place, value in enumerate(values.tolist()):
        if not starts or value > values[starts[-1]] + width:
            starts.append(place)
    assert group_starts(values, width).tolist() == starts


def test_the_types_are_those_of_the_columns() -> None:
    written = WRITTEN.read_text("utf-8")
    is_current = ast.dump(ast.parse(written)) == ast.dump(ast.parse(source()))
    assert is_current, "run: python -m docs.generate.changes"


@pytest.mark.parametrize("count", [2, 5, 16, 256])
def test_a_scale_runs_from_its_first_color_to_its_last(count: int) -> None:
    for name in (name for name in COLOR_SCALES if name not in IN_TURN):
        colors = scale_colors(name, count)
        ends = [bytes.fromhex(COLOR_SCALES[name][end][1:]) for end in (0, -1)]
        assert colors.shape == (count, 3)
        assert colors.dtype == np.uint8
        assert [bytes(colors[0]), bytes(colors[-1])] == ends, name


def test_the_middle_band_of_an_odd_number_has_the_middle_color_of_a_diverging_scale() -> None:
    assert bytes(scale_colors("coolwarm", 9)[4]).hex() == COLOR_SCALES["coolwarm"][16][1:]


def test_zebra_is_black_and_white_in_turn_however_many_bands_there_are() -> None:
    assert scale_colors("zebra", 5)[:, 0].tolist() == [0, 255, 0, 255, 0]
    assert scale_colors("zebra_r", 4)[:, 0].tolist() == [255, 0, 255, 0]


def test_a_list_of_colors_is_a_scale_whose_colors_are_mixed_between_them() -> None:
    assert scale_colors(((0, 0, 0), (200, 100, 0)), 3).tolist() == [[0, 0, 0], [100, 50, 0], [200, 100, 0]]


def test_swatches_have_grays_at_the_left_and_get_darker_down_to_the_muted_rows() -> None:
    field = swatches().reshape(ROWS, COLUMNS, 3).astype(int)
    assert field[[0, -1], 0].tolist() == [[255] * 3, [0] * 3]
    assert (np.ptp(field[:, 0], axis=1) == 0).all()
    assert (np.diff(field[:, 0, 0]) < 0).all()
    assert (np.diff((field[:8, 1:-1] @ [0.2126, 0.7152, 0.0722]), axis=0) < 0).all()
    assert len({*map(tuple, swatches().tolist())}) == ROWS * COLUMNS


names = st.sampled_from(list(FINISHES))


@given(surfaces("body"), names, names)
def test_a_finish_keeps_the_color_and_replaces_any_other_finish(
    surface: Surface, first: str, last: str
) -> None:
    once = surface.replace(**finished(surface, last))
    other = surface.replace(**finished(surface, first))
    assert other.replace(**finished(other, last)) == once
    assert once.paint.object_color == surface.paint.color
    assert (once.name, once.levels, once.two_sided) == (surface.name, surface.levels, surface.two_sided)


def test_the_finishes_of_a_menu_are_these() -> None:
    assert list(FINISHES) == ["plastic", "paint", "metallic", "metal", "rubber", "glass"]
    with pytest.raises(UsageError, match=r"^there is no finish 'metl'; did you mean 'metal'\?$"):
        finished(Surface("body"), "metl")


def test_each_finish_looks_different() -> None:
    scene = scene_of(
        sphere(24, 16), surfaces=[Surface("sphere").replace(object_color="#b01020")], **STRETCHED
    )
    images = {}
    for name in FINISHES:
        finish = scene.with_surface("sphere", **finished(scene.surfaces["sphere"], name))
        images[name] = image(finish, render(finish, (80, 60))).astype(float)
    for one, other in itertools.combinations(FINISHES, 2):
        assert np.abs(images[one] - images[other]).mean() > 1, (one, other)
    means = {name: found.mean() for name, found in images.items()}
    assert min(means, key=lambda name: means[name]) == "glass"
    # Glass and paint have a white highlight; that of metal has its color, and rubber has none.
    whitest = {name: found.min(axis=2).max() for name, found in images.items()}
    assert whitest["glass"] > 240
    assert whitest["paint"] > 240
    assert whitest["rubber"] < 100 < whitest["metal"] < 200


@given(colors(), colors(), st.floats(0, 1))
def test_a_mixed_color_lies_between_both(
    one: tuple[int, int, int], other: tuple[int, int, int], share: float
) -> None:
    for a, b, c in zip(one, other, mixed(one, other, share), strict=True):
        assert min(a, b) <= c <= max(a, b)
    assert mixed(one, other, 0) == one
    assert mixed(one, other, 1) == other


def test_a_surface_changes_its_own_fields_and_those_of_reflectance_and_paint() -> None:
    surface = Surface("body").replace(diffuse=0.2, blend=0.3, two_sided=False, object_color="#102030")
    assert surface.reflectance == Reflectance(diffuse=0.2)
    assert surface.paint == Paint(object_color=(16, 32, 48), blend=0.3)
    assert not surface.two_sided
    assert surface.replace(paint=Paint(), blend=0.1).paint == Paint(blend=0.1)


RAMP = ((34, 0, 0), (255, 102, 0), (255, 255, 255))


def test_a_ramp_and_two_colors_with_their_blend_unset_each_other() -> None:
    surface = Surface("body").replace(object_color="#102030", light_color="red", blend=0.3, diffuse=0.2)
    glowing = surface.replace(ramp=["#200", "#f60", "#fff"])
    assert glowing.paint == Paint(ramp=RAMP)
    assert glowing.reflectance == surface.reflectance
    changes = {"object_color": "#102030", "light_color": "red", "blend": 0.3, "light_percentage": 50}
    for name, value in changes.items():
        assert glowing.replace(**{name: value}).paint == Paint().replace(**{name: value})  # type: ignore[arg-type]
    assert glowing.replace(ramp=None).paint == Paint()
    assert surface.replace(ramp=None) == surface


@given(paints(), paints())
def test_a_paint_becomes_another_by_their_difference_and_comes_back_from_its_values(
    one: Paint, other: Paint
) -> None:
    assert replaced(one, difference(one, other)) == other
    assert from_plain(Paint, to_plain(one)) == one
    unset = {"object_color", "light_color", "blend", "light_percentage"} if one.ramp else {"ramp"}
    assert not unset & to_plain(one).keys()


def test_the_color_of_a_ramp_is_in_its_middle() -> None:
    assert Paint(ramp=RAMP).color == (255, 102, 0)
    assert Paint(ramp=RAMP[:2]).color == (145, 51, 0)
    assert Paint((176, 16, 32)).color == (176, 16, 32)


def test_a_reflectance_has_phongs_model_unless_it_is_given_another() -> None:
    assert Reflectance().model == Phong(20)
    assert Reflectance(0.1, 0.2, 30) == Reflectance(0.1, 0.2, Phong(30)) == Reflectance(0.1, 0.2, exponent=30)
    for exponent in (np.float32(20), np.int64(20), 20):
        assert Reflectance(0.7, 0.5, exponent).model == Phong(20)  # type: ignore[arg-type]
    assert Reflectance(model="blinn").model == BlinnPhong()
    assert Reflectance(model="blinn", exponent=7).model == BlinnPhong(7)
    assert Reflectance(model=CookTorrance(0.2)).model == CookTorrance(0.2)


def test_the_exponent_of_a_reflectance_is_that_of_its_model() -> None:
    assert Reflectance(exponent=7).exponent == 7
    with pytest.raises(AttributeError, match="must have an exponent, not CookTorrance"):
        _ = Reflectance(model="cook-torrance").exponent


BODY: Any = Surface("body")
A_RAMP = (
    "ramp must stand without object_color, light_color, blend and light_percentage, not beside them; leave"
    " out the ramp or these"
)

test_surfaces_and_parts_that_break_a_rule_are_refused_with_their_names = refused(
    call,
    [
        (lambda: Paint((1, 2, 3), ramp=RAMP), A_RAMP),
        (lambda: from_plain(Paint, {"ramp": RAMP, "blend": 0.5}), A_RAMP),
        (lambda: Paint().replace(ramp=RAMP, light_percentage=0), A_RAMP),
        (lambda: BODY.replace(object_color="red").replace(ramp=RAMP, blend=0.6), f"surface 'body': {A_RAMP}"),
        (
            lambda: Reflectance(0.7, 0.5, 20, exponent=3),
            "exponent must be given once, not twice; leave one out",
        ),
        *(
            (
                lambda wrong=wrong: BODY.replace(reflectance=wrong, diffuse=0.5),
                f"surface 'body': reflectance must be a Reflectance, not {wrong!r}",
            )
            for wrong in (None, 5, Phong(3), np.zeros(3))
        ),
        (lambda: Surface("a", paint=0.5), "surface 'a': paint must be a Paint, not 0.5"),  # type: ignore[arg-type]
        (
            lambda: Part("door", "body").replace(surfaces="glass"),  # type: ignore[call-arg]
            "part 'door': there is no field 'surfaces'; did you mean 'surface'?",
        ),
    ],
)
