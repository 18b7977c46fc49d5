"""The page in a real browser, beside the display and the images of this package."""

from __future__ import annotations

import dataclasses
import io
import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image

import autocolor
from autocolor.files.settings import scene_with
from autocolor.images import display_image, image, save_image
from autocolor.mapping.colors import entries_of, white_of, with_white
from autocolor.scene.kinds import in_digits
from autocolor.scene.orbit import around
from autocolor.scene.surfaces import Paint
from autocolor.scene.swatches import car_paints
from autocolor.web.exported import export_of, paint_values
from ramtek_emu import GMR_9300, Ramtek9300
from tests.small import car
from tests.tables import first

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page, Request

ROOT = Path(__file__).parents[3]
MODULE = (ROOT / "autocolor" / "web" / "autocolor.js").read_text("utf-8")
Open = Callable[..., "Page"]
pytestmark = pytest.mark.needs("playwright")

# What a page shows, and what a display that shows the same has as red, green, blue and 255 for each pixel.
SHOWN = """async () => {
    const canvas = document.querySelector(".glass canvas");
    const copy = new OffscreenCanvas(canvas.width, canvas.height)
        .getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
    const digest = await crypto.subtle.digest("SHA-256", data);
    return Array.from(new Uint8Array(digest), byte => byte.toString(16).padStart(2, "0")).join("");
}"""
SHOWN_AFTER = f"""async (fragments) => {{
    const digests = [];
    for (const fragment of fragments) {{
        const done = new Promise(resolve => addEventListener("hashchange", resolve, {{once: true}}));
        location.hash = fragment;
        await done;
        digests.push(await ({SHOWN})());
    }}
    return digests;
}}"""


def digest(colors: np.ndarray[Any, np.dtype[np.uint8]]) -> str:
    opaque = np.dstack([colors, np.full(colors.shape[:2], 255, np.uint8)])
    return sha256(opaque.tobytes()).hexdigest()


@pytest.fixture(scope="module")
def coupe() -> autocolor.Scene:
    return autocolor.demo()


@pytest.fixture(scope="module")
def small(coupe: autocolor.Scene) -> autocolor.Picture:
    return autocolor.render(coupe, (160, 120), smooth=2)


@pytest.fixture
def opened(browser: Browser, tmp_path: Path) -> Iterator[Open]:
    """Opens a page from its file, without a network. At the end no page has asked or complained."""
    contexts: list[BrowserContext] = []
    troubles: list[str] = []

    def on_request(request: Request) -> None:
        if not request.url.startswith(("file:", "data:", "blob:")):
            troubles.append(request.url)

    def open_page(
        scene: autocolor.Scene,
        picture: autocolor.Picture | None,
        fragment: str = "",
        context: Any = None,
        **page: Any,
    ) -> Page:
        path = tmp_path / "page.html"
        autocolor.save_page(path, scene, picture, overwrite=True, **page)
        contexts.append(browser.new_context(offline=True, **(context or {})))
        shown = contexts[-1].new_page()
        shown.set_default_timeout(20_000)
        shown.on("console", lambda message: troubles.append(message.text))
        shown.on("pageerror", lambda error: troubles.append(str(error)))
        shown.on("request", on_request)
        shown.goto(path.as_uri() + (f"#{fragment}" if fragment else ""))
        shown.wait_for_selector(".desk")
        return shown

    yield open_page
    for context in contexts:
        context.close()
    assert troubles == []


@pytest.fixture(scope="module")
def module(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """An empty page, from a file, with the module's functions as `autocolor`."""
    empty = tmp_path_factory.mktemp("web") / "empty.html"
    names = "entriesOf, fragmentOf, stateOfFragment, unpackWords, relighting, whiteOf, withWhite"
    empty.write_text("<!doctype html><title>empty</title>")
    page = browser.new_page()
    page.goto(empty.as_uri())
    page.add_script_tag(type="module", content=f"{MODULE}\nglobalThis.autocolor = {{{names}}};")
    page.wait_for_function("globalThis.autocolor")
    yield page
    page.close()


def random_paint(random: np.random.Generator) -> Paint:
    def color() -> Any:
        return tuple(random.integers(0, 256, 3).tolist())

    if random.random() < 0.3:
        return Paint(ramp=tuple(color() for _ in range(random.integers(2, 9))))
    blend, percentage = random.random(), random.choice([100.0, float(random.random() * 100)])
    if random.random() < 0.5:
        blend = round(blend, 2)
    return Paint(object_color=color(), light_color=color(), blend=blend, light_percentage=percentage)


def fragment_of(surface: str, paint: Paint) -> str:
    fields = paint_values(paint)
    texts = {key: "none" if value is None else str(value) for key, value in fields.items()}
    texts["ramp"] = ",".join(fields["ramp"]) if fields["ramp"] else "none"
    return "&".join(f"surfaces.{surface}.{key}={text.replace('#', '')}" for key, text in texts.items())


def test_entries_are_those_of_the_display_to_the_byte(module: Page) -> None:
    random = np.random.default_rng(1)
    cases = [
        (random_paint(random), int(random.choice([1, 2, 3, 16, 97, 249, 1007])), float(floor))
        for floor in np.repeat([0, 0.05, 0.3217, 1], 30)
    ]
    found = module.evaluate(
        "cases => cases.map(each => Array.from(autocolor.entriesOf(...each)))",
        [[paint_values(paint), levels, floor] for paint, levels, floor in cases],
    )
    for (paint, levels, floor), entries in zip(cases, found, strict=True):
        assert entries == entries_of(paint, levels, floor).ravel().tolist(), (paint, levels, floor)


def test_the_white_bar_is_that_of_the_studio(module: Page) -> None:
    random = np.random.default_rng(2)
    cases = [(*random.integers(0, 256, 3).tolist(), int(random.integers(0, 256))) for _ in range(100)]
    found = module.evaluate(
        """cases => cases.map(([red, green, blue, white]) =>
            [autocolor.whiteOf([red, green, blue]), autocolor.withWhite([red, green, blue], white)])""",
        cases,
    )
    assert found == [[white_of(each[:3]), list(with_white(each[:3], each[3]))] for each in cases]


@pytest.mark.parametrize(
    ("smooth", "recolorings"), [(1, 6), pytest.param(1, 50, marks=pytest.mark.thorough), (2, 3)]
)
def test_the_canvas_shows_the_field_of_the_display_after_recolorings(
    opened: Open, coupe: autocolor.Scene, smooth: int, recolorings: int
) -> None:
    configuration = dataclasses.replace(GMR_9300, lines=240 * smooth, elements=320 * smooth)
    display = Ramtek9300(configuration)
    studio = autocolor.Studio(coupe, display)
    page = opened(coupe, autocolor.render(coupe, (320, 240), smooth=smooth))
    assert page.evaluate(SHOWN) == digest(display.field())
    random = np.random.default_rng(4)
    fragments, fields = [], []
    for _ in range(recolorings):
        name = str(random.choice([surface.name for surface in coupe.surfaces]))
        paint = random_paint(random)
        fragments.append(fragment_of(name, paint))
        studio.edit(coupe.with_surface(name, paint=paint))
        fields.append(digest(display.field()))
    assert len(set(fields)) > 0.9 * recolorings
    assert page.evaluate(SHOWN_AFTER, fragments) == fields


def saved(page: Page, button: str) -> bytes:
    with page.expect_download() as download:
        page.get_by_role("button", name=button).click()
    return Path(download.value.path()).read_bytes()


def test_a_saved_png_has_the_legend_and_a_page_says_what_is_fixed(opened: Open, tmp_path: Path) -> None:
    scene = autocolor.read_scene(ROOT / "scenes" / "bracket").with_scalar(name="stress", limits=(0, 150))
    stress = scene, autocolor.render(scene, (400, 300), smooth=2)
    page = opened(*stress)
    png = np.asarray(Image.open(io.BytesIO(saved(page, "Save PNG"))).convert("RGB"))
    save_image(tmp_path / "stress.png", *stress)
    assert (png == np.asarray(Image.open(tmp_path / "stress.png").convert("RGB"))).all()
    assert (png != image(*stress)).any(), "the picture has no legend"
    page.get_by_role("radio", name="cast").check()
    assert "cannot be edited" in page.locator(".paint").inner_text()
    assert page.locator(".paint input").count() == 0


def test_saved_values_are_a_table_of_variants(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture, tmp_path: Path
) -> None:
    scene = coupe.with_surface("glass", ramp=["#200000", "#ff6600"]).with_surface(
        "trim", ramp=["#000", "#fff"]
    )
    page = opened(
        scene,
        small,
        "surfaces.body.object_color=1f3f8f&surfaces.body.blend=0.25&surfaces.stage.ramp=102030,405060",
    )
    page.get_by_role("radio", name="trim").check()
    page.get_by_role("button", name="Use two colors instead").click()
    (tmp_path / "values.csv").write_bytes(saved(page, "Save CSV"))
    (variant,) = autocolor.read_variants(tmp_path / "values.csv")
    found = scene_with(scene, variant.settings)
    assert found.surfaces["body"].paint == coupe.surfaces["body"].paint.replace(
        object_color="#1f3f8f", blend=0.25
    )
    assert found.surfaces["glass"].paint == scene.surfaces["glass"].paint
    assert found.surfaces["trim"].paint.ramp is None
    assert found.surfaces["stage"].paint == Paint(ramp=((16, 32, 48), (64, 80, 96)))
    assert page.evaluate(SHOWN) == digest(image(found, small, smooth=1))
    png = np.asarray(Image.open(io.BytesIO(saved(page, "Save PNG"))).convert("RGB"))
    assert (png == image(found, small)).all()


def test_saved_values_with_other_light_give_the_picture_of_the_page(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture, tmp_path: Path
) -> None:
    for link, differs in (("lights.key.intensity=0.3", True), ("surfaces.body.blend=0.25", False)):
        page = opened(coupe, small, link, lights=True)
        (tmp_path / "values.csv").write_bytes(saved(page, "Save CSV"))
        (variant,) = autocolor.read_variants(tmp_path / "values.csv")
        assert ("exposure" in variant.settings) == differs
        png = np.asarray(Image.open(io.BytesIO(saved(page, "Save PNG"))).convert("RGB"))
        for settings, is_same in (
            (variant.settings, True),
            ({key: value for key, value in variant.settings.items() if key != "exposure"}, not differs),
        ):
            found = scene_with(coupe, settings)
            colors = image(found, size=small.size, smooth=small.smooth)
            # The planes of the lights are rounded: a few words are off by one.
            assert ((np.abs(png.astype(int) - colors) <= 2).mean() > 0.999) == is_same


def test_a_drag_is_one_step_and_the_link_has_the_colors(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture
) -> None:
    page = opened(coupe, small)
    before = page.evaluate(SHOWN)
    box = page.get_by_label("Green of the object color of body", exact=True).bounding_box()
    assert box
    line = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 20, line)
    page.mouse.down()
    for share in (0.3, 0.5, 0.7):
        page.mouse.move(box["x"] + share * box["width"], line)
    page.mouse.up()
    page.wait_for_function("location.hash.length > 1")
    dragged, fragment = page.evaluate(SHOWN), page.evaluate("location.hash.slice(1)")
    assert dragged != before
    assert fragment.startswith("body=")
    assert "no word" in page.get_by_role("status").inner_text()
    page.keyboard.press("Control+z")
    assert page.evaluate(SHOWN) == before
    assert page.evaluate("location.hash") == ""
    page.keyboard.press("Control+Shift+z")
    assert page.evaluate(SHOWN) == dragged
    page.get_by_role("button", name="Undo").click()
    page.get_by_role("button", name="Redo").click()
    page.get_by_role("button", name="Reset").click()
    assert page.evaluate(SHOWN) == before
    page.keyboard.press("Control+z")
    assert page.evaluate(SHOWN) == dragged
    assert opened(coupe, small, fragment).evaluate(SHOWN) == dragged


FOREIGN_LINKS = {
    "surfaces.bdy.object_color=102030": "surfaces.bdy.object_color",
    "surfaces.body.blend=2&surfaces.glass.blend=0.1": "surfaces.body.blend",
    "surfaces.body.object_color=red": "“red”",
    "surfaces.body.ramp=102030": "“102030”",
    "lights.key.on=false": "lights.key.on",
    "chapter-2": "chapter-2",
    "view=2": "view",
    "%E0%A4%A": "%E0%A4%A",
    "__proto__=1": "__proto__",
}


def test_a_foreign_link_changes_nothing_and_says_so(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture
) -> None:
    page = opened(coupe, small, "surfaces.glass.blend=x")
    unchanged = digest(image(coupe, small, smooth=1))
    assert "surfaces.glass.blend" in page.get_by_role("status").inner_text()
    for link, says in FOREIGN_LINKS.items():
        assert page.evaluate(SHOWN_AFTER, [link]) == [unchanged]
        assert says in page.get_by_role("status").inner_text()


def test_the_keyboard_alone_recolors(opened: Open, coupe: autocolor.Scene, small: autocolor.Picture) -> None:
    page = opened(coupe, small)

    def focus_on(label: str) -> None:
        for _ in range(40):
            page.keyboard.press("Tab")
            if label in (page.evaluate("document.activeElement.ariaLabel ?? ''") or ""):
                return
        raise AssertionError(f"no way to {label} by Tab")

    page.get_by_role("radio", name="body").focus()
    page.keyboard.press("ArrowRight")
    assert page.get_by_role("radio", name="glass").is_checked()
    focus_on("#rrggbb")
    for color in ("sparkly", "rgb(0 0 0 / 50%)", "navy"):
        page.keyboard.press("Control+a")
        page.keyboard.type(color)
        page.keyboard.press("Enter")
        assert (f"not “{color}”" in page.get_by_role("status").inner_text()) == (color != "navy")
    focus_on("Blend of glass")
    # A key that is held is one step.
    for _ in range(3):
        page.keyboard.down("ArrowLeft")
    page.keyboard.up("ArrowLeft")
    blend = page.get_by_label("Blend of glass: where the light color begins", exact=True)
    assert blend.input_value() == "0.42"
    page.keyboard.press("Control+z")
    assert blend.input_value() == "0.45"
    page.keyboard.press("End")
    paint = coupe.surfaces["glass"].paint.replace(object_color="navy", blend=1.0)
    shown = coupe.with_surface("glass", paint=paint)
    assert page.evaluate(SHOWN) == digest(image(shown, small, smooth=1))


def test_a_touch_chooses_a_surface(opened: Open, coupe: autocolor.Scene, small: autocolor.Picture) -> None:
    page = opened(coupe, small, context={"has_touch": True, "viewport": {"width": 390, "height": 844}})
    numbers = small.surface_number
    box = page.locator(".glass").bounding_box()
    assert box
    for name in ("glass", "stage", "body"):
        at = np.argwhere(numbers == 1 + list(small.surfaces).index(name))
        line, element = at[len(at) // 3] + 0.5
        page.touchscreen.tap(
            box["x"] + element / small.elements * box["width"], box["y"] + line / small.lines * box["height"]
        )
        assert page.get_by_role("radio", name=name).is_checked()
    assert page.evaluate("document.documentElement.scrollWidth") == 390


RELIT = """async ([text, states]) => {
    const picture = JSON.parse(text);
    const {lines, elements, surfaces} = picture;
    const words = await autocolor.unpackWords(picture.words, lines, elements);
    const owner = new Uint8Array(1024);
    surfaces.forEach(({first, levels}, number) => owner.fill(number + 1, first, first + levels));
    const relight = await autocolor.relighting(picture, words, owner);
    return states.map(([state, name]) => {
        relight(state, name);
        return Array.from(words);
    });
}"""


@pytest.mark.parametrize("changes", first(1, [{"mapping": "gamma", "dither": "ordered"}, {}]))
def test_lights_give_the_levels_of_a_rendering(
    module: Page, coupe: autocolor.Scene, changes: dict[str, Any]
) -> None:
    scene = coupe.replace(**changes)
    display = Ramtek9300(dataclasses.replace(GMR_9300, lines=120, elements=160))
    studio = autocolor.Studio(scene, display)
    exported = export_of(studio.scene, studio.picture, lights=True)
    studio.hold_exposure()
    names = [light.name for light in scene.lights]
    states: list[Any] = []
    expected = []

    def light_as(strengths: Mapping[str, float]) -> None:
        """A state in which a strength of 0 is a light that is switched off."""
        state: dict[str, object] = {}
        for name, strength in strengths.items():
            studio.light(name, intensity=strength or 1.0, on=strength > 0)
            state |= {f"lights.{name}.intensity": strength or 1.0, f"lights.{name}.on": strength > 0}
        states.append([state, names[0]])
        expected.append(studio.words)

    random = np.random.default_rng(5)
    others = {name: round(float(random.random() * 2), 3) for name in names}
    # A drag of one light, all lights as exported, the drag again; then other lights.
    for strength in (0.3, 1.7, 0.9):
        light_as({**others, names[0]: strength})
    light_as({light.name: float(light.intensity) for light in scene.lights})
    light_as({**others, names[0]: 0.5})
    light_as({**others, names[1]: 0.0})
    light_as({**others, names[0]: 0.0, names[2]: 0.0})
    for found, words in zip(module.evaluate(RELIT, [json.dumps(exported), states]), expected, strict=True):
        away = np.abs(np.array(found).reshape(words.shape) - words.astype(int))
        assert away.max() <= 1
        for surface in exported["surfaces"]:
            of_surface = (words >= surface["first"]) & (words < surface["first"] + surface["levels"])
            assert (away[of_surface] > 0).sum() <= 1 + 0.005 * of_surface.sum()


def test_a_light_is_dimmed_and_switched_off(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture
) -> None:
    page = opened(coupe, small, lights=True)
    before = page.evaluate(SHOWN)
    assert "Exposure is held" in page.locator(".lights").inner_text()
    page.get_by_role("switch", name="Light key").uncheck()
    dark = page.evaluate(SHOWN)
    assert "no entry" in page.get_by_role("status").inner_text()
    page.get_by_label("Strength of light key, as a number").fill("0")
    page.get_by_role("switch", name="Light key").check()
    assert page.evaluate(SHOWN) == dark != before
    assert page.evaluate("location.hash") == "#key.intensity=0"
    page.get_by_role("button", name="Reset").click()
    assert page.evaluate(SHOWN) == before


VARIANTS: Sequence[Mapping[str, object]] = [
    {"name": "night", "surfaces.body.object_color": "#10203f", "surfaces.trim.blend": 0.9},
    {"name": "glow", "surfaces.body.ramp": ["#200000", "#ff6600", "#ffffff"]},
]


def test_a_variant_is_chosen_as_one_step_and_compared_with_before(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture
) -> None:
    page = opened(coupe, small, variants=VARIANTS)
    before = page.evaluate(SHOWN)
    for row in VARIANTS:
        page.get_by_role("button", name=str(row["name"])).click()
        settings = {key: value for key, value in row.items() if key != "name"}
        assert page.evaluate(SHOWN) == digest(image(scene_with(coupe, settings), small, smooth=1))
    page.get_by_role("button", name="Before").click()
    assert page.evaluate(SHOWN.replace(".glass canvas", ".glass .before")) == before
    page.get_by_label("Line between before and after").fill("80")
    assert page.locator(".glass").evaluate("glass => glass.style.getPropertyValue('--split')") == "80%"
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    assert page.evaluate(SHOWN) == before


def test_links_are_short_whatever_names_surfaces_and_lights_have(module: Page) -> None:
    names, paint = ("body", "body.blend", "view", "key"), paint_values(Paint())
    first = {f"surfaces.{name}.{field}": value for name in names for field, value in paint.items()}
    first |= {"lights.key.on": True, "lights.key.intensity": 1.0}
    picture = {"views": [{"name": "0°"}, {"name": "180°"}], "lights": None}
    for key, value, fragment in (
        ("surfaces.body.object_color", "#102030", "body=102030"),
        ("surfaces.body.light_color", "#102030", "body.light_color=102030"),
        ("surfaces.key.ramp", ["#102030", "#ffffff"], "key.ramp=102030%2Cffffff"),
        ("lights.key.on", False, "key.on=false"),
        # The short name of the second is that of the first.
        ("surfaces.body.blend", 0.5, "body.blend=0.5"),
        ("surfaces.body.blend.object_color", "#102030", "surfaces.body.blend.object_color=102030"),
        ("surfaces.view.object_color", "#102030", "surfaces.view.object_color=102030"),
    ):
        state = {**first, key: value}
        for link in (fragment, f"{key}={fragment.partition('=')[2]}"):
            found = module.evaluate(
                """([state, first, link, picture]) => [
                    autocolor.fragmentOf(state, first, 1), autocolor.stateOfFragment(link, picture, first),
                ]""",
                [state, first, link, picture],
            )
            assert found == [f"view=2&{fragment}", {"state": state, "view": 0}]


# A page that turns.


@pytest.fixture(scope="module")
def turning() -> tuple[autocolor.Scene, list[autocolor.Scene]]:
    """A scene, and the scenes that the four views of its page show."""
    scene = car().replace(contrast="floor", exposure="99 %")
    views = around(scene, 4)
    display = Ramtek9300(dataclasses.replace(GMR_9300, lines=240, elements=320))
    studio = autocolor.Studio(scene.replace(view=views[0]), display)
    studio.hold_exposure()
    for name, (_, levels) in studio.level_ranges.items():
        studio.surface(name, levels=levels)
    return scene, [studio.scene.replace(view=view) for view in views]


TURNING: dict[str, Any] = {"views": 4, "size": (160, 120), "smooth": 2}


def shown_by(scene: autocolor.Scene) -> str:
    return digest(image(scene, size=(320, 240), smooth=1))


def wait_for_view(page: Page, name: str) -> None:
    page.wait_for_function(
        "name => document.querySelector('[role=status]').textContent.startsWith(`View ${name}:`)", arg=name
    )


def test_every_view_shows_the_image_of_its_scene_before_and_after_a_recoloring(
    opened: Open, turning: tuple[autocolor.Scene, list[autocolor.Scene]]
) -> None:
    scene, views = turning
    page = opened(scene, None, **TURNING)
    for angle, shown in zip(("0°", "90°", "180°", "270°", "0°"), [*views, views[0]], strict=True):
        assert page.evaluate(SHOWN) == shown_by(shown)
        assert shown is views[0] or page.evaluate("location.hash") == f"#view={1 + views.index(shown)}"
        page.keyboard.press("ArrowRight")
        wait_for_view(page, {"0°": "90°", "90°": "180°", "180°": "270°", "270°": "0°"}[angle])
    page.get_by_role("button", name="gold").click()
    gold = [each.with_surface("body", object_color="#e0b030") for each in views]
    assert page.evaluate(SHOWN) == shown_by(gold[1])
    assert "no word" in page.get_by_role("status").inner_text()
    png = np.asarray(Image.open(io.BytesIO(saved(page, "Save PNG"))).convert("RGB"))
    assert (png == image(gold[1], size=(160, 120), smooth=2)).all()
    page.get_by_role("button", name="Turn left").click()
    wait_for_view(page, "0°")
    assert page.evaluate(SHOWN) == shown_by(gold[0])
    page.get_by_role("button", name="Before").click()
    page.get_by_role("button", name="Turn left").click()
    wait_for_view(page, "270°")
    assert page.evaluate(SHOWN) == shown_by(gold[3])
    assert page.evaluate(SHOWN.replace(".glass canvas", ".glass .before")) == shown_by(views[3])
    fragment = page.evaluate("location.hash.slice(1)")
    assert fragment == "view=4&body=e0b030"
    again = opened(scene, None, fragment, **TURNING)
    wait_for_view(again, "270°")
    assert again.evaluate(SHOWN) == shown_by(gold[3])


def test_a_drag_turns_and_chooses_no_surface(
    opened: Open, turning: tuple[autocolor.Scene, list[autocolor.Scene]]
) -> None:
    scene, views = turning
    page = opened(scene, None, **TURNING)
    page.get_by_role("radio", name="wheels").check()
    box = page.locator(".glass").bounding_box()
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - box["width"] / 4, y, steps=4)
    # The near side follows the pointer to the left, so the eye moves to the right.
    wait_for_view(page, "90°")
    page.mouse.move(x + box["width"] / 4, y, steps=4)
    wait_for_view(page, "270°")
    assert page.evaluate("location.hash") == ""
    page.mouse.up()
    assert page.evaluate("location.hash") == "#view=4"
    assert page.get_by_role("radio", name="wheels").is_checked()
    page.mouse.move(x, y)
    assert page.evaluate(SHOWN) == shown_by(views[3])
    page.mouse.down()
    page.mouse.move(x, y - 20)
    page.mouse.up()
    assert page.get_by_role("radio", name="wheels").is_checked()
    page.mouse.click(x, y)
    assert page.get_by_role("radio", name="body").is_checked()
    # The outline of the chosen surface does not stay over another view.
    page.keyboard.press("ArrowRight")
    wait_for_view(page, "0°")
    assert page.evaluate("document.querySelector('.outline').getAnimations().length") == 0


def test_a_finger_turns_sideways_and_scrolls_the_page_up_and_down(
    opened: Open, turning: tuple[autocolor.Scene, list[autocolor.Scene]]
) -> None:
    phone = {"has_touch": True, "is_mobile": True, "viewport": {"width": 390, "height": 844}}
    page = opened(turning[0], None, context=phone, **TURNING)
    session = page.context.new_cdp_session(page)

    def swipe(right: int, down: int) -> None:
        for step in range(11):
            point = {"x": 195 + right * step / 10, "y": 260 + down * step / 10}
            kind = "touchMove" if step else "touchStart"
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [point]})
        session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    swipe(-100, 5)
    wait_for_view(page, "90°")
    assert page.evaluate("scrollY") == 0
    swipe(5, -150)
    page.wait_for_function("scrollY > 50")
    assert page.evaluate("location.hash") == "#view=2"


def test_lights_rest_in_other_views_and_shine_again_in_the_first(
    opened: Open, turning: tuple[autocolor.Scene, list[autocolor.Scene]]
) -> None:
    scene, views = turning
    page = opened(scene, None, **TURNING, lights=True)
    page.get_by_role("switch", name="Light key").uncheck()
    dark = page.evaluate(SHOWN)
    assert dark != shown_by(views[0])
    page.locator(".lights h2").click()
    page.keyboard.press("ArrowLeft")
    wait_for_view(page, "270°")
    assert page.evaluate(SHOWN) == shown_by(views[3])
    assert page.get_by_role("switch", name="Light key").is_disabled()
    assert "first view only" in page.locator(".lights").inner_text()
    page.get_by_role("button", name="Turn right").click()
    wait_for_view(page, "0°")
    assert page.evaluate(SHOWN) == dark
    page.get_by_role("switch", name="Light key").check()
    assert page.evaluate(SHOWN) == shown_by(views[0])


# What a stranger sees first.


def test_named_paints_and_a_surprise_recolor_the_chosen_surface(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture, tmp_path: Path
) -> None:
    page = opened(coupe.with_surface("glass", ramp=["#000", "#fff"]), small)
    for name in ("body", "glass"):
        page.get_by_role("radio", name=name).check()
        levels = display_image(coupe, small).ranges[name].levels
        assert f"your paint changes {levels} of 1,024 colors" in page.locator(".head").inner_text()
    for name, color in car_paints().items():
        button = page.get_by_role("group", name="Paints for glass").get_by_role("button", name=name)
        button.click()
        assert button.get_attribute("aria-pressed") == "true"
        assert page.get_by_label("The object color of glass as #rrggbb").input_value() == in_digits(color)
    before = page.evaluate(SHOWN)
    page.get_by_role("button", name="Surprise me").click()
    surprised = page.evaluate(SHOWN)
    assert surprised != before
    (tmp_path / "values.csv").write_bytes(saved(page, "Save CSV"))
    (variant,) = autocolor.read_variants(tmp_path / "values.csv")
    assert surprised == digest(image(scene_with(coupe, variant.settings), small, smooth=1))
    page.keyboard.press("Control+z")
    assert page.evaluate(SHOWN) == before


def test_a_page_with_an_address_gives_code_to_embed_it(
    browser: Browser, coupe: autocolor.Scene, small: autocolor.Picture, tmp_path: Path
) -> None:
    autocolor.save_page(tmp_path / "coupe.html", coupe, small)
    context = browser.new_context(permissions=["clipboard-read", "clipboard-write"])
    page = context.new_page()
    page.route("**", lambda route: route.fulfill(body=(tmp_path / "coupe.html").read_bytes()))
    page.goto("https://example.com/coupe.html?a=1&b=2#body=102030")
    page.get_by_role("button", name="Copy embed code").click()
    page.wait_for_function("document.querySelector('[role=status]').textContent.startsWith('Copied')")
    source = "https://example.com/coupe.html?a=1&amp;b=2&amp;embed=1#body=102030"
    assert f'src="{source}"' in page.evaluate("navigator.clipboard.readText()")
    context.close()


def test_an_embedded_page_has_the_picture_and_the_paints_and_prints_the_picture(
    opened: Open, coupe: autocolor.Scene, small: autocolor.Picture
) -> None:
    def is_visible(page: Page) -> list[bool]:
        return [
            page.locator(each).is_visible() for each in (".glass", ".paints", ".panel", ".tools", ".table")
        ]

    page = opened(coupe, small, link="https://example.com/coupe.html")
    assert page.get_by_role("link", name="coupe").get_attribute("href") == "https://example.com/coupe.html"
    assert is_visible(page) == [True, True, True, True, True]
    page.emulate_media(media="print")
    assert is_visible(page) == [True, False, False, False, False]
    page.emulate_media(media="screen")
    page.goto(page.url + "?embed")
    page.wait_for_selector(".glass canvas")
    assert is_visible(page) == [True, True, False, False, False]
    page.get_by_role("button", name="blue").click()
    assert page.evaluate(SHOWN) == digest(
        image(coupe.with_surface("body", object_color="#1e4a80"), small, smooth=1)
    )


AXE = Path(os.environ.get("AXE_CORE", "not set"))


@pytest.mark.skipif(not AXE.is_file(), reason="AXE_CORE is not the path of axe.min.js of axe-core")
@pytest.mark.parametrize("scheme", first(1, ["light", "dark"]))
def test_the_accessibility_checker_finds_nothing(opened: Open, coupe: autocolor.Scene, scheme: str) -> None:
    context = {"color_scheme": scheme, "bypass_csp": True}
    page = opened(coupe, None, "view=2", context, **TURNING, lights=True, variants=VARIANTS)
    wait_for_view(page, "90°")
    page.get_by_role("button", name="Before").click()
    page.locator("summary").click()
    page.evaluate(AXE.read_text("utf-8"))
    found = page.evaluate("async () => (await axe.run()).violations")
    assert [(each["id"], each["impact"], [node["html"] for node in each["nodes"]]) for each in found] == []
