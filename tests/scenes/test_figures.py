from __future__ import annotations

import importlib
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import autocolor
from autocolor.files.state import note_color, recent_colors
from autocolor.screens.light_and_view.marks import LIGHT, MovablePoint
from autocolor.screens.light_and_view.orthographic_views import SIDES
from autocolor.testing import Recoloring, check_recoloring_moves_no_word
from ramtek_emu import Ramtek9300
from ramtek_emu.instruction_set.decoder import Decoder
from scenes import (
    figure_04,
    figure_07,
    figure_10,
    figure_15,
    figure_curvature,
    figure_half_spaces,
    figure_highlight,
    figure_incidence,
    figure_links,
    figure_normals,
    figure_part,
    figures,
)
from tests.tables import first

EXPECTED = {
    "04": {"figure-04.png", "figure-04-a.png", "figure-04-b.png", "figure-04-c.png"},
    "05": {"figure-05.png"},
    "06": {"figure-06.png"},
    "07": {"figure-07.png"},
    "08": {"figure-08.png", *(f"figure-08-{name}.png" for name in ("key", "side", "back", "rim"))},
    "09": {"figure-09.png", "figure-09-a.png", "figure-09-b.png", "figure-09-c.png"},
    "10": {"figure-10.png", *(f"figure-10-{panel}.png" for panel in "abcdef")},
    "13": {"figure-13.png"},
    "14": {"figure-14.png"},
    "15": {"figure-15.png", "figure-15-a.png", "figure-15-b.png", "figure-15-c.png"},
    "part": {"figure-part.png", *(f"figure-part-{panel}.png" for panel in "abcd")},
    "links": {"figure-links.png", *(f"figure-links-{panel}.png" for panel in "abcdef")},
    "half-spaces": {"figure-half-spaces.png", *(f"figure-half-spaces-{panel}.png" for panel in "abcdef")},
    "curvature": {"figure-curvature.png", *(f"figure-curvature-{panel}.png" for panel in "abc")},
    "incidence": {"figure-incidence.png", *(f"figure-incidence-{panel}.png" for panel in "abcdef")},
    "following": {"figure-following.png", *(f"figure-following-{panel}.png" for panel in "abcdef")},
    "highlight": {"figure-highlight.png", *(f"figure-highlight-{panel}.png" for panel in "abcdef")},
    "normals": {"figure-normals.png", *(f"figure-normals-{panel}.png" for panel in "abcdef")},
}


@pytest.fixture(autouse=True)
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Panels are rendered at their own size, which takes a sixteenth of the time."""
    monkeypatch.setattr(figures, "SMOOTH", 1)


@pytest.mark.parametrize("number", first(2, figures.FIGURES))
def test_each_figure_leaves_its_labeled_pictures(
    number: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["figure", str(tmp_path / "made")])
    importlib.import_module(f"scenes.figure_{number.replace('-', '_')}").main()
    made = {path.name for path in (tmp_path / "made").iterdir()}
    assert made == EXPECTED[number]
    assert {Path(line).name for line in capsys.readouterr().out.splitlines()} == made
    for name in made:
        with Image.open(tmp_path / "made" / name) as image:
            pixels = np.asarray(image.convert("RGB"))
        assert pixels.shape[0] % (480 + figures.CAPTION_LINES) == 0
        assert (pixels[480 : 480 + figures.CAPTION_LINES, :640] > 200).any(), "the caption is empty"


def test_the_gallery_shows_the_picture_of_every_script() -> None:
    folder = figures.SCENES.parent / "docs"
    page = (folder / "gallery.md").read_text("utf-8")
    shown = re.findall(r"!\[[^]]+\]\((figures/[^)]+)\)\s+\[(scenes/[^]]+)\]\(../\2\)", page)
    assert dict(shown) == {
        f"figures/figure-{number}.webp": f"scenes/figure_{number.replace('-', '_')}.py"
        for number in figures.FIGURES
    }
    missing = [name for name, _ in shown if not (folder / name).exists()]
    assert not missing, "run: python -m scenes.figures docs/figures --webp"


@pytest.mark.thorough
def test_a_figure_of_the_docs_is_one_lossless_picture_of_its_panels(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fields = []
    for options in (["--webp"], []):
        monkeypatch.setattr("sys.argv", ["figure", str(tmp_path), *options])
        figure_04.main()
        (path,) = tmp_path.glob("figure-04.webp" if options else "figure-04.png")
        with Image.open(path) as image:
            fields.append(np.asarray(image.convert("RGB")))
    lossless, png = fields
    assert np.array_equal(lossless, png)
    assert png.shape == (480 + figures.CAPTION_LINES, 3 * 640, 3)


def test_a_click_on_a_bar_of_a_screen_mixes_a_color_and_leaves_the_words_and_the_user_s_colors() -> None:
    note_color((1, 2, 3))
    with figures.open_viewer("coupe", "mixing") as (viewer, _):
        words = viewer.studio.words
        assert not recent_colors()
        figures.click(viewer, "object, blue", 0.75)
        assert viewer.studio.scene.surfaces["body"].paint.object_color[2] > 200
        figures.click(viewer, "blend bar", 0.25)
        assert viewer.studio.scene.surfaces["body"].paint.blend == pytest.approx(0.25, abs=0.01)
        assert viewer.studio.words is words
    assert recent_colors() == ((1, 2, 3),)


def test_the_views_of_figure_5_show_the_object_and_marks_for_all_lights_and_the_eye() -> None:
    with figures.open_viewer("coupe", "light and view") as (viewer, _):
        handles = viewer.board.content.handles
        names = {light.name for light in viewer.studio.scene.lights}
        for side in SIDES:
            points = {each.key for each in handles if side.area.has(each.element, each.line)}
            assert points >= {MovablePoint(LIGHT, side, name) for name in names}
            assert MovablePoint("eye", side) in points


def test_under_a_light_at_the_eye_the_body_of_the_coupe_is_about_as_bright_as_under_four_lights() -> None:
    medians = []
    for scene in (figures.read_scene("coupe"), figure_07.coupe()):
        picture = autocolor.render(scene, (320, 240))
        body = picture.surface_number == picture.surfaces.index("body") + 1
        medians.append(np.median(autocolor.image(scene, picture)[body].max(axis=1)))
    assert medians[1] > 0.8 * medians[0]


def test_no_panel_of_lacquer_is_brighter_than_the_range_of_all_panels() -> None:
    coupe = figure_incidence.lit_coupe()
    assert isinstance(coupe.exposure, tuple)
    ((_, (_, most)),) = coupe.exposure
    for position in (coupe.view.eye, figure_incidence.BEHIND):
        lacquered = figure_incidence.lacquered(coupe.with_light("lamp", position=position))
        assert autocolor.render(lacquered, (1280, 960)).ranges.whole.maximum < most


def brightest_of_plane(scene: autocolor.Scene) -> float:
    picture = autocolor.render(scene, (320, 240))
    return picture.ranges.surfaces["plane"].maximum


def test_aiming_the_light_at_the_pyramid_takes_the_bright_spot_off_the_plane() -> None:
    point = autocolor.read_scene(figures.SCENES / "pyramid")
    flood = point.with_light("lamp", aim=figure_04.SIDE, concentration=1)
    spot = flood.with_light("lamp", concentration=40)
    assert point.lights["lamp"].axis is None
    assert brightest_of_plane(flood) < 0.5 * brightest_of_plane(point)
    assert brightest_of_plane(spot) < 0.2 * brightest_of_plane(point)
    side = autocolor.render(spot, (320, 240)).ranges.surfaces["pyramid"]
    assert side.maximum > 0.9 * autocolor.render(flood, (320, 240)).ranges.surfaces["pyramid"].maximum


def test_the_three_blends_of_figure_15_differ_only_in_the_body() -> None:
    display = Ramtek9300()
    studio = autocolor.Studio(autocolor.read_scene(figures.SCENES / "coupe"), display)
    fields = []
    for _, blend, _ in figure_15.PANELS:
        check_recoloring_moves_no_word(studio, Recoloring("body", {**figure_15.COLORS, "blend": blend}))
        fields.append(display.field())
    body = studio.picture.surface_number == studio.picture.surfaces.index("body") + 1
    for field in fields[1:]:
        differs = (field != fields[0]).any(axis=2)
        assert not differs[~body].any()
        assert differs[body].mean() > 0.5


def test_the_levels_of_figure_8_add_up_to_those_of_figure_6_where_the_exposure_is_held_from_zero() -> None:
    coupe = autocolor.read_scene(figures.SCENES / "coupe").replace(scaling="object", mapping="linear")
    brightest = autocolor.render(coupe).ranges.whole.maximum
    coupe = coupe.replace(exposure={"object": (0.0, brightest)})
    together = autocolor.Studio(coupe, Ramtek9300())
    total = np.zeros(together.words.shape, int)
    for row, light in enumerate(coupe.lights):
        # The ambient light is in one panel only.
        panel = coupe.only_lights(light.name).replace(ambient=0.0 if row else coupe.ambient)
        total += levels_of(autocolor.Studio(panel, Ramtek9300()))
    assert np.abs(total - levels_of(together)).max() <= len(coupe.lights) / 2


def levels_of(studio: autocolor.Studio) -> np.ndarray[tuple[int, ...], np.dtype[np.int_]]:
    """The level at each pixel, 0 where nothing is seen."""
    firsts = [0, *(studio.level_ranges[name].first for name in studio.picture.surfaces)]
    levels: np.ndarray[tuple[int, ...], np.dtype[np.int_]] = (
        studio.words.astype(int) - np.array(firsts)[studio.picture.surface_number]
    )
    return levels


def test_the_cones_of_figure_10_pick_out_three_objects_of_the_row_and_one() -> None:
    row = autocolor.read_scene(figures.SCENES / "row")
    for (_, angle, _), names in zip(figure_10.IN_A_ROW[1:], ({"pawn", "bottle"}, set()), strict=True):
        picked = row.with_light("lamp", aim=figure_10.BOWL, cone_angle=angle)
        ranges = autocolor.render(picked).ranges.surfaces
        lit = {name for name, (_, most) in ranges.items() if most > row.ambient * 1.001}
        assert lit == {"bowl", "floor"} | names
    every = autocolor.render(row.with_light("lamp", aim=figure_10.BOWL)).ranges.surfaces
    assert all(most > 3 * row.ambient for _, most in every.values())


def test_the_plane_of_figure_4_has_one_spot_that_is_lighter_than_its_paint() -> None:
    studio = autocolor.Studio(autocolor.read_scene(figures.SCENES / "pyramid"), Ramtek9300())
    paint = studio.scene.surfaces["plane"].paint
    first, levels = studio.level_ranges["plane"]
    is_plane = studio.picture.surface_number == studio.picture.surfaces.index("plane") + 1
    lines, elements = np.nonzero(is_plane & (studio.words - first > paint.blend * (levels - 1)))
    assert 100 < len(lines) < 0.02 * is_plane.sum()
    assert max(np.ptp(lines), np.ptp(elements)) < 100


def test_no_gap_between_the_panels_of_the_coupe_is_lighter_than_its_paint() -> None:
    studio = autocolor.Studio(autocolor.read_scene(figures.SCENES / "coupe"), Ramtek9300())
    first, levels = studio.level_ranges["gaps"]
    body = studio.picture.surface_number == studio.picture.surfaces.index("body") + 1
    darkest_paint = np.percentile(studio.entries[studio.words[body]].max(axis=1), 1)
    assert studio.entries[first : first + levels].max() < darkest_paint


def test_under_a_light_at_the_eye_the_glass_of_the_coupe_is_darker_than_its_paint() -> None:
    coupe = autocolor.read_scene(figures.SCENES / "coupe")
    at_eye = coupe.replace(lights=[autocolor.Light("eye", coupe.view.eye)])
    picture = autocolor.render(at_eye)
    gray = autocolor.image(at_eye, picture).max(axis=2)
    glass, body = (
        gray[picture.surface_number == picture.surfaces.index(name) + 1] for name in ("glass", "body")
    )
    assert np.percentile(glass, 95) < np.percentile(body, 95)


def test_the_panels_of_the_links_differ_from_that_of_everything_only_where_the_light_is_not() -> None:
    coupe = figure_links.coupe()
    every = autocolor.render(coupe, (320, 240))
    for _, links, _ in figure_links.ON_THE_COUPE[1:]:
        picture = autocolor.render(coupe.with_light("more", **links), (320, 240))
        names = links.get("only_parts") or links["only_surfaces"]
        of = ("part_number", "parts") if "only_parts" in links else ("surface_number", "surfaces")
        numbers, known = (getattr(picture, field) for field in of)
        is_linked = np.isin(numbers, [known.index(name) + 1 for name in names])
        assert np.allclose(picture.intensity[is_linked], every.intensity[is_linked], atol=1e-5)
        is_darker = picture.intensity < every.intensity - 1e-3
        assert not (is_darker & is_linked).any()
        assert is_darker[~is_linked & (picture.surface_number > 0)].mean() > 0.5


def test_without_the_lamp_on_the_plane_the_bright_spot_of_figure_4_is_gone_and_the_side_stays() -> None:
    point = autocolor.read_scene(figures.SCENES / "pyramid")
    linked = point.with_light("lamp", **figure_links.ON_THE_PYRAMID[1][1])
    before, after = (autocolor.render(scene, (320, 240)).ranges.surfaces for scene in (point, linked))
    assert after["plane"].maximum == after["plane"].minimum == pytest.approx(point.ambient)
    assert after["pyramid"].maximum == pytest.approx(before["pyramid"].maximum)


def test_the_bands_of_the_machined_part_keep_its_shading_and_flat_codes_do_not() -> None:
    bracket = autocolor.read_scene(figures.SCENES / "bracket").replace(exposure=figure_part.EXPOSURE)
    studio = autocolor.Studio(bracket, Ramtek9300())
    is_cast = studio.picture.surface_number == studio.picture.surfaces.index("cast") + 1
    colors = []
    for shades in (20, 1):
        studio.scalar(**figure_part.STRESS, scale=figure_part.COLORS, shades=shades)
        first, levels = studio.level_ranges["cast"]
        assert levels >= figure_part.STRESS["bands"] * shades
        assert np.unique((studio.words[is_cast] - first) // shades).size >= figure_part.STRESS["bands"]
        colors.append(len(np.unique(studio.entries[studio.words[is_cast]], axis=0)))
    assert colors[0] > 100
    assert colors[1] <= figure_part.STRESS["bands"] + 1


def test_the_stress_of_the_part_is_largest_on_its_rib_among_what_is_seen_of_the_cast_surface() -> None:
    bracket = autocolor.read_scene(figures.SCENES / "bracket").with_scalar(**figure_part.STRESS)
    picture = autocolor.render(bracket, (320, 240))
    assert picture.scalar is not None
    is_metal = np.isin(
        picture.surface_number, [picture.surfaces.index(name) + 1 for name in ("cast", "machined")]
    )
    assert np.isfinite(picture.scalar[is_metal]).all()
    assert 100 < picture.scalar[is_metal].max() < 250
    floor = picture.surface_number == picture.surfaces.index("floor") + 1
    assert np.isnan(picture.scalar[floor]).all()


def test_the_roof_of_the_coupe_bulges_and_only_its_body_is_colored_by_curvature() -> None:
    plain = autocolor.Studio(autocolor.read_scene(figures.SCENES / "coupe"), Ramtek9300())
    curved = autocolor.Studio(plain.scene.with_scalar(**figure_curvature.MEAN), Ramtek9300())
    picture = curved.picture
    assert picture.scalar is not None
    body = picture.surface_number == picture.surfaces.index("body") + 1
    assert np.isfinite(picture.scalar[body]).all()
    assert np.median(picture.scalar[body]) > 0
    assert set(np.unique(picture.surface_number[np.isfinite(picture.scalar)])) >= {
        picture.surfaces.index("body") + 1
    }
    colors = curved.entries[curved.words[~body]].astype(int) - plain.entries[plain.words[~body]]
    # Other surfaces have fewer levels, but the same colors.
    assert np.percentile(np.abs(colors), 95) < 12


def test_the_lacquer_of_the_coupe_and_the_wet_floor_shine_under_the_lamp_behind_and_not_from_the_eye() -> (
    None
):
    at_eye = figure_incidence.lit_coupe().only_lights("lamp")
    behind = at_eye.with_light("lamp", position=figure_incidence.BEHIND)
    times = {}
    for where, scene in (("eye", at_eye), ("behind", behind)):
        grown = scene
        for name in figure_incidence.SURFACES:
            grown = grown.with_surface(name, refractive_index=figure_incidence.LACQUER)
        constant, more = (autocolor.render(each, (320, 240)) for each in (scene, grown))
        for name in figure_incidence.SURFACES:
            is_there = constant.surface_number == constant.surfaces.index(name) + 1
            brightest = [float(picture.intensity[is_there].max()) for picture in (constant, more)]
            times[where, name] = brightest[1] / brightest[0]
    assert all(0.999 < times["eye", name] < 1.02 for name in figure_incidence.SURFACES)
    assert times["behind", "body"] > 3
    assert times["behind", "stage"] > 1.5


def test_a_lacquered_plane_shines_more_where_the_lamp_behind_the_pyramid_grazes_it() -> None:
    constant = figure_incidence.lit_pyramid()
    grown = constant.with_surface("plane", refractive_index=figure_incidence.LACQUER)
    pictures = [autocolor.render(each, (320, 240)) for each in (constant, grown)]
    is_plane = pictures[0].surface_number == pictures[0].surfaces.index("plane") + 1
    times = pictures[1].intensity[is_plane] / pictures[0].intensity[is_plane]
    assert times.max() > 2
    assert times.min() > 0.999


@pytest.mark.parametrize("caption", figure_highlight.ON_THE_COUPE)
def test_the_highlights_of_the_coupe_are_where_their_crosses_are(caption: str) -> None:
    place = figure_highlight.ON_THE_COUPE[caption]
    studio = autocolor.Studio(autocolor.read_scene(figures.SCENES / "coupe"), Ramtek9300())
    seen = studio.seen_at(*place)
    assert seen is not None
    assert seen.part == "hood"
    studio.place_highlight("back", *place)
    assert studio.highlight_of("back", seen.surface) == place


@pytest.mark.thorough
def test_a_recorded_round_of_the_light_is_a_picture_and_then_loads_of_the_table_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.argv", ["figure", str(tmp_path), "--stream"])
    figure_normals.main()
    words = np.fromfile(tmp_path / "figure-normals.ramtek", "<u2").astype(np.uint16)
    names = [each.format.name for each in Decoder().feed(words)]
    picture = len(names) - figure_normals.STEPS
    assert set(names[picture:]) == {"LAM"}
    assert names[picture - 1] == "WI"
    display = Ramtek9300()
    display.send(words)
    around = Ramtek9300()
    autocolor.Studio(figure_normals.coupe().replace(words="normals"), around)
    assert (display.field() == around.field()).all()


def test_the_barn_doors_of_the_figure_leave_a_part_of_what_the_lamp_lights() -> None:
    lamp = autocolor.Light("lamp", (3.0, -5.0, 4.0), aim=(0.3, -0.3, 0.4))
    pyramid = autocolor.read_scene(figures.SCENES / "pyramid").replace(lights=(lamp,), ambient=0.0)
    behind = pyramid.with_light("lamp", half_spaces=figure_half_spaces.DOORS)
    opened = pyramid.with_light(
        "lamp", half_spaces=[each.replace(on=False) for each in figure_half_spaces.DOORS]
    )
    free, doors, off = (autocolor.render(each, (160, 120)).intensity for each in (pyramid, behind, opened))
    assert off.tobytes() == free.tobytes()
    lit = doors > 0
    assert doors[lit].tolist() == free[lit].tolist()
    assert 0.02 < lit.sum() / (free > 0).sum() < 0.2
