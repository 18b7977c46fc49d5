from __future__ import annotations

import json
from base64 import b64decode
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import (
    InputError,
    Light,
    Scene,
    Surface,
    UsageError,
    image,
    read_picture,
    read_scene,
    render,
    scene_of,
    write_picture,
)
from autocolor.arrays import AnyArray
from autocolor.budget import MEMORY, allowing
from autocolor.files.settings import scene_with
from autocolor.images import averaged, display_image, smoothed
from autocolor.lighting.picture import IntensityRange
from autocolor.mapping.intensity import levels_of
from autocolor.rendering import rendering
from autocolor.scene.curves import mapping_curve
from autocolor.testing import MAPPINGS, numbers, scenes
from autocolor.web import exported
from autocolor.web.exported import (
    BYTES_OF_LIGHT,
    BYTES_OF_LIT_PIXEL,
    check_canvas,
    export_of,
    least_intensities,
    packed_words,
)
from tests.autocolor.web.twin import (
    entries_in,
    relit_words,
    unpacked_plane,
    unpacked_words,
    with_legend,
    words_in,
)
from tests.small import car, cube, wall_scene
from tests.tables import first

SIZE = (32, 24)
KEYS = (
    "background elements entries format legend lights lines name notes smooth surfaces swatches variants"
    " views words"
)


def values_through_json(scene: Scene, **options: Any) -> Any:
    return json.loads(json.dumps(export_of(scene, render(scene, SIZE), **options)))


# Words, planes and thresholds.


@given(
    st.lists(st.integers(0, 1023) | st.sampled_from([60, 61, 120, 121]), min_size=24, max_size=24),
    st.sampled_from([1, 2, 4, 24]),
)
def test_packed_words_are_unpacked_word_by_word(given_words: list[int], lines: int) -> None:
    words = np.array(given_words, np.uint16).reshape(lines, -1)
    assert (unpacked_words(packed_words(words), *words.shape) == words).all()


@given(
    st.sampled_from(MAPPINGS),
    numbers(0, 1),
    numbers(0.001, 3),
    st.integers(2, 40),
    st.sampled_from([1, 64]),
    st.lists(numbers(0, 4), min_size=1, max_size=20),
)
def test_a_threshold_is_the_least_intensity_of_its_level(
    mapping: Any, low: float, width: float, levels: int, steps: int, seen: list[float]
) -> None:
    limits = np.array([low, low + width], np.float32)
    extent = IntensityRange(*limits.tolist())
    everything = np.clip(np.array(seen, np.float32), *limits)
    fractions = mapping_curve(mapping)(limits[0], limits[1], everything)

    def level_of(intensity: AnyArray) -> AnyArray:
        mapped = fractions(np.clip(intensity, *limits))
        return levels_of(mapped, steps * (levels - 1) + 1)

    thresholds = least_intensities(fractions, extent, levels, steps)
    assert len(thresholds) == steps * (levels - 1)
    assert (np.diff(thresholds[np.isfinite(thresholds)]) >= 0).all()
    wanted = np.arange(1, len(thresholds) + 1)
    # At 64 steps a level, positions are rounded in double precision.
    slack = 0 if steps == 1 else 1
    reached = np.isfinite(thresholds)
    assert (level_of(thresholds[reached]) >= wanted[reached] - slack).all()
    below = np.nextafter(thresholds, np.float32(0))
    is_above = (thresholds > 0) & reached
    assert (level_of(below[is_above]) < wanted[is_above] + slack).all()
    assert (level_of(limits[1:]) < wanted[~reached] + slack).all()


def test_a_surface_without_extent_has_its_middle_level_in_any_light() -> None:
    extent = IntensityRange(0.5, 0.5)
    for steps in (1, 64):
        thresholds = least_intensities(lambda given: np.full_like(given, 0.5), extent, 8, steps)
        assert np.count_nonzero(thresholds == 0) == 4 * steps
        assert np.count_nonzero(np.isinf(thresholds)) == 3 * steps


# Words, entries and legends.


@given(scenes())
def test_an_export_has_the_words_the_entries_and_the_ranges_of_the_display_image(scene: Scene) -> None:
    try:
        shown = display_image(scene, render(scene, SIZE))
    except InputError:
        assume(False)
    values = values_through_json(scene)
    assert " ".join(sorted(values)) == KEYS
    assert (words_in(values) == shown.words).all()
    assert (entries_in(values) == shown.entries).all()
    assert [(each["name"], each["first"], each["levels"]) for each in values["surfaces"]] == [
        (name, *each) for name, each in shown.ranges.items()
    ]
    for each in values["surfaces"]:
        name = each["name"]
        assert bool(each["fixed"]) == (name in shown.bands)
        assert each["shades"] == (shown.bands[name].shades if name in shown.bands else each["levels"])


@pytest.mark.parametrize("smooth", first(1, [2, 1]))
def test_the_legend_of_an_export_is_that_of_the_image(smooth: int) -> None:
    scene = read_scene("scenes/bracket").with_scalar(name="stress")
    picture = render(scene, (400, 320), smooth=smooth)
    shown = display_image(scene, picture)
    values = export_of(scene, picture)
    words = with_legend(values)
    assert values["smooth"] == smooth
    assert (words != shown.words).any()
    assert (averaged(shown.entries, words, smooth) == smoothed(shown, smooth)).all()
    assert values["notes"] == ["The scalar “stress” colors cast and machined."]


# Lights.


def relit(scene: Scene, exposure: Any, strengths: Mapping[str, float]) -> Scene:
    """The scene with other strengths of all lights, and an exposure."""
    lights = tuple(light.replace(on=True, intensity=strengths[light.name]) for light in scene.lights)
    return scene.replace(lights=lights, exposure=exposure)


def for_lights(scene: Scene) -> Scene:
    """The scene with lights, and with a mapping that stays with the exposure."""
    mapping = "gamma" if scene.mapping == "equalize" else scene.mapping
    return scene.replace(lights=scene.lights or car().lights, mapping=mapping)


@given(scenes(words="levels").map(for_lights), st.tuples(*[numbers(0, 3)] * 3))
def test_planes_and_thresholds_give_the_words_of_a_rendering_in_other_light(
    scene: Scene, strengths: tuple[float, ...]
) -> None:
    picture = render(scene, SIZE)
    try:
        shown = display_image(scene, picture)
        values = json.loads(json.dumps(export_of(scene, picture, lights=True)))
    except InputError:
        # There are too many bands, or there is a single intensity.
        assume(False)
    # Each light is off by at most half a unit, and float32 rounds the sum.
    as_exported = {light.name: light.intensity * light.on for light in scene.lights}
    assert (relit_words(values, as_exported, -1) <= shown.words).all()
    assert (shown.words <= relit_words(values, as_exported, 1)).all()
    others = {light.name: strength for light, strength in zip(scene.lights, strengths, strict=False)}
    # A table that is saved from the page has this exposure.
    held = scene_with(scene, {"exposure": values["lights"]["exposure"]})
    other = relit(held, held.exposure, others)
    expected = display_image(other, render(other, SIZE)).words
    assert (relit_words(values, others, -1) <= expected).all()
    assert (expected <= relit_words(values, others, 1)).all()


def test_a_surface_with_the_name_of_the_range_of_the_object_has_that_range() -> None:
    scene = wall_scene()
    parts = tuple(part.replace(surface="object") for part in scene.parts)
    scene = scene.replace(surfaces=(Surface("object"),), parts=parts)
    exposure = values_through_json(scene, lights=True)["lights"]["exposure"]
    assert list(dict(scene_with(scene, {"exposure": exposure}).exposure)) == ["object"]  # type: ignore[arg-type]


def test_the_plane_of_a_light_is_within_half_a_unit_of_its_contribution() -> None:
    scene = car().with_light("key", on=False, intensity=3)
    picture = render(scene, SIZE)
    values = export_of(scene, picture, lights=True)
    for row in values["lights"]["rows"]:
        alone = scene.only_lights(row["name"]).with_light(row["name"], intensity=1).replace(ambient=0)
        intensity = render(alone, SIZE).intensity / picture.scale
        plane = np.array(unpacked_plane(b64decode(row["plane"])))
        for surface, unit in zip(picture.slices, row["units"], strict=True):
            shares = plane[surface.pixels]
            expected = intensity[picture.surface_number == surface.surface_number]
            assert shares.max() == 65535
            assert np.abs(shares * unit - expected).max() <= 0.501 * unit


def test_a_picture_from_a_file_has_the_same_planes(tmp_path: Any) -> None:
    scene = car().replace(lights=(*car().lights, Light("spare", (0, -5, 0), on=False, intensity=7)))
    picture = render(scene, SIZE)
    write_picture(tmp_path / "car.npz", scene, picture)
    saved = read_picture(tmp_path / "car.npz")
    values = export_of(saved.scene, saved.picture, lights=True)
    assert values == {**export_of(scene, picture, lights=True), "name": values["name"]}
    rows = [
        {key: row[key] for key in ("name", "on", "intensity", "most")} for row in values["lights"]["rows"]
    ]
    assert rows == [
        {"name": "key", "on": True, "intensity": 1.0, "most": 2},
        {"name": "fill", "on": True, "intensity": 0.4, "most": 2},
        {"name": "spare", "on": False, "intensity": 7, "most": 14},
    ]


def test_lights_whose_planes_do_not_fit_in_the_budget_are_exported_too() -> None:
    lights = [Light(f"light {number}", (0.1 * number - 1, -3.0, 0.5)) for number in range(20)]
    scene = wall_scene(view=None).replace(lights=tuple(lights))
    picture = render(scene, SIZE)
    usual = export_of(scene, picture, lights=True)["lights"]
    needed = (BYTES_OF_LIT_PIXEL + 20 * BYTES_OF_LIGHT) * SIZE[0] * SIZE[1]
    with allowing(1.001 * needed / MEMORY):
        assert len(rendering(scene, 24, 32).picture.light_planes) < 20
        in_turns = export_of(scene, picture, lights=True)["lights"]
    for row, other in zip(usual["rows"], in_turns["rows"], strict=True):
        assert np.allclose(row["units"], other["units"], rtol=1e-5)
    with (
        allowing(0.999 * needed / MEMORY),
        pytest.raises(InputError, match=r"the export of 32 x 24 pixels must take at most 0\.\d MB"),
    ):
        export_of(scene, picture, lights=True)


def lit(edited: Scene, rendered: Scene | None = None) -> object:
    return export_of(edited, render(rendered or edited, SIZE), lights=True)


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (
            lambda: lit(car().with_light("key", intensity=0.9), car()),
            "the lights of a picture must be computed",
        ),
        (lambda: lit(car().with_view(angle=5), car()), "the lights of a picture must be computed"),
        (lambda: lit(car().replace(lights=()), car()), "a page with lights must have a light in its scene"),
        (lambda: lit(car().only_lights()), "the picture of a page with lights must have more than one"),
        (lambda: check_canvas(4096, 4097), "a picture in a browser must have at most 16,777,216 pixels"),
    ],
)
def test_what_a_browser_cannot_show_is_refused(act: Callable[[], object], sentence: str) -> None:
    check_canvas(4096, 4096)
    with pytest.raises((InputError, UsageError)) as caught:
        act()
    assert str(caught.value).startswith(sentence)


@pytest.mark.parametrize("off", [0, 1])
def test_more_planes_than_a_browser_holds_are_refused(monkeypatch: pytest.MonkeyPatch, off: int) -> None:
    picture = render(car(), SIZE)
    monkeypatch.setattr(exported, "MOST_PLANE_POINTS", 2 * len(picture.pixels) - off)
    with pytest.raises(InputError, match="must have at most") if off else nullcontext():
        export_of(car(), picture, lights=True)


def test_a_picture_that_sees_nothing_is_exported() -> None:
    scene = scene_of(cube()).with_view(eye=(0.0, -5.0, 0.0), direction=(0.0, -1.0, 0.0))
    picture = render(scene, SIZE)
    values = export_of(scene, picture)
    assert (
        averaged(display_image(scene, picture).entries, words_in(values), 1) == image(scene, picture)
    ).all()


# Variants.


def test_a_variant_has_the_fields_of_paints_and_lights_that_it_changes() -> None:
    scene = car().with_surface("glass", ramp=["#000", "#fff"])
    rows: list[Mapping[str, object]] = [
        {"name": "night", "surfaces.body.object_color": "navy", "lights.key.on": "false"},
        {"surfaces.glass.object_color": [1, 2, 3], "lights.fill.intensity": 0.4},
        {"surfaces.glass.ramp": "none", "surfaces.body.blend": "0.25", "lights.fill.intensity": "2"},
        # A table that was saved from a page may come back.
        {"name": "saved", "lights.key.on": "false", "exposure": '{ "object" = [0.0, 1.0] }'},
    ]
    assert values_through_json(scene, variants=rows, lights=True)["variants"] == [
        {"name": "night", "values": {"surfaces.body.object_color": "#000080", "lights.key.on": False}},
        {
            "name": "1,2,3-0.4",
            "values": {"surfaces.glass.object_color": "#010203", "surfaces.glass.ramp": None},
        },
        {
            "name": "2-none-0.25",
            "values": {
                "surfaces.body.blend": 0.25,
                "surfaces.glass.ramp": None,
                "lights.fill.intensity": 2.0,
            },
        },
        {"name": "saved", "values": {"lights.key.on": False}},
    ]


PAINTS = "a variant of a page must change paints"


@pytest.mark.parametrize(
    ("row", "sentence"),
    [
        ({"view.angle": 3}, f"variant '3': view.angle: {PAINTS}"),
        ({"surfaces.body.levels": 3}, f"variant '3': surfaces.body.levels: {PAINTS}"),
        ({"lights.key.position": [1, 2, 3]}, f"variant '1,2,3': lights.key.position: {PAINTS}"),
        (
            {"lights.key.on": True},
            "variant 'true': lights.key.on: the page must have lights",
        ),
        (
            {"surfaces.wheels.blend": 1},
            "variant '1': surfaces.wheels.blend: its colors",
        ),
        ({"surfaces.body.blend": 2}, "variant '2': surface 'body': "),
        ({"surfaces.bdy.blend": 2}, "surfaces.bdy.blend: "),
    ],
)
def test_what_a_page_cannot_change_is_refused(row: Mapping[str, object], sentence: str) -> None:
    scene = car().with_scalar(name="stress", surfaces=["wheels"])
    with pytest.raises((UsageError, InputError)) as caught:
        values_through_json(scene, variants=[row])
    assert str(caught.value).startswith(sentence)


@pytest.mark.parametrize("count", [1000, 1001])
def test_so_many_variants_are_refused(count: int) -> None:
    rows = [{"surfaces.body.blend": number / 2000} for number in range(count)]
    with pytest.raises(UsageError, match="at most 1,000 variants") if count > 1000 else nullcontext():
        values_through_json(car(), variants=rows)
