from __future__ import annotations

import json
import re
from base64 import b64decode, b64encode
from hashlib import sha256
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from autocolor import (
    InputError,
    OutputError,
    Scene,
    Surface,
    UsageError,
    demo,
    image,
    render,
    save_page,
    scene_of,
)
from autocolor.images import display_image
from autocolor.web.exported import export_of
from autocolor.web.page import page_of, without_comments
from tests.small import car, sphere

SIZE = (32, 24)
WEB = Path(__file__).resolve().parents[3] / "autocolor" / "web"

HOSTILE = [
    "</script><script>alert(1)</script>",
    "<!--<script>",
    "\"onload='alert(1)' {style}",
    "&lt;b&gt; &amp; ]]>",
    "\u202etxt.exe\u2028\u0000",
    "\ud800",
    "car\nhood",
]


class Elements(HTMLParser):
    """The elements of a page with their attributes and their texts, in order."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None], str]] = []
        self.is_open = False
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs), ""))
        self.is_open = True

    def handle_endtag(self, tag: str) -> None:
        self.is_open = False

    def handle_data(self, data: str) -> None:
        if self.is_open:
            tag, attributes, text = self.elements[-1]
            self.elements[-1] = (tag, attributes, text + data)

    def all(self, tag: str) -> list[tuple[dict[str, str | None], str]]:
        return [(attributes, text) for name, attributes, text in self.elements if name == tag]


def page_with(scene: Scene, **options: Any) -> Elements:
    return Elements(page_of(export_of(scene, render(scene, SIZE), **options)))


def policy_of(page: Elements) -> dict[str, str]:
    (content,) = (
        attributes["content"] or ""
        for attributes, _ in page.all("meta")
        if attributes.get("http-equiv") == "Content-Security-Policy"
    )
    return {name: rest for name, _, rest in (rule.strip().partition(" ") for rule in content.split(";"))}


def test_the_policy_allows_this_script_and_this_style_and_no_request() -> None:
    page = page_with(car(), lights=True)
    (_, picture), (attributes, script) = page.all("script")
    ((_, style),) = page.all("style")
    assert attributes == {"type": "module"}
    assert json.loads(picture)["name"] == car().name
    assert policy_of(page) == {
        "default-src": "'none'",
        "img-src": "data: blob:",
        "base-uri": "'none'",
        "form-action": "'none'",
        "script-src": f"'sha256-{b64encode(sha256(script.encode()).digest()).decode()}'",
        "style-src": f"'sha256-{b64encode(sha256(style.encode()).digest()).decode()}'",
    }


def test_the_page_of_the_documents_has_the_present_script_and_style() -> None:
    live = Elements((WEB.parents[1] / "docs" / "coupe.html").read_text("utf-8"))
    (_, picture), (_, script) = live.all("script")
    made = Elements(page_of(json.loads(picture)))
    is_up_to_date = made.all("script")[1][1] == script and made.all("style") == live.all("style")
    assert is_up_to_date, "run: autocolor page scenes/coupe --views 12 -o docs/coupe.html --force"


@pytest.mark.parametrize("name", HOSTILE)
def test_names_of_strangers_are_never_markup(name: str) -> None:
    mesh = sphere(8, 6)
    scene = scene_of(
        mesh,
        surface_of_part={part: name for part in mesh.part_names},
        surfaces=[Surface(name)],
        name=name,
    )
    hostile = page_with(scene, lights=True, variants=[{"name": name}])
    plain = page_with(car(), lights=True)
    assert [(tag, [*attributes]) for tag, attributes, _ in hostile.elements] == [
        (tag, [*attributes]) for tag, attributes, _ in plain.elements
    ]
    values = json.loads(hostile.all("script")[0][1])
    assert values["name"] == name
    assert [surface["name"] for surface in values["surfaces"]] == [name]
    assert [variant["name"] for variant in values["variants"]] == [name]
    assert all(letter.isprintable() for letter in hostile.all("title")[0][1].strip())


@pytest.mark.parametrize("name", ["autocolor.js", "autocolor.css"])
def test_a_page_has_the_lines_of_the_module_without_comments(name: str) -> None:
    source = (WEB / name).read_text("utf-8")
    shown = without_comments(source).splitlines()
    assert not [line for line in shown if line.startswith(("//", "/*", " ")) or not line]
    lines = iter(line.strip() for line in re.sub(r"/\*\*[^\n]*?\*/ ?", "", source).splitlines())
    assert all(line.rstrip() in lines for line in shown), "lines are changed or in another order"
    # No text extends over several lines, and none ends the element that it is in.
    assert all(line.count("`") % 2 == 0 for line in without_comments(source).splitlines())
    assert not re.search("</(script|style)|<!--", source, re.IGNORECASE)


def test_a_page_has_no_part_for_notebooks() -> None:
    page = page_of(export_of(car(), render(car(), SIZE)))
    assert "export async function mount" in page
    assert "export default" not in page
    assert "export default" in (WEB / "autocolor.js").read_text("utf-8")


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("options", "most"),
    [
        ({}, 180_000),
        ({"lights": True}, 1_200_000),
        ({"views": 12}, 1_400_000),
        ({"views": 12, "lights": True}, 2_200_000),
    ],
)
def test_the_pages_of_the_coupe_are_small(tmp_path: Path, options: dict[str, Any], most: int) -> None:
    save_page(tmp_path / "coupe.html", demo(), **options)
    assert (tmp_path / "coupe.html").stat().st_size <= most


LINE = "General Motors, 1983: the picture is sent once; your paint changes {} of 1,024 colors."


def metas_of(page: Elements) -> dict[str, str]:
    """The contents of the elements that other sites read, by name or property."""
    rows = [attributes for attributes, _ in page.all("meta")]
    return {
        str(row.get("property") or row["name"]): str(row["content"])
        for row in rows
        if "property" in row or row.get("name") in ("description", "twitter:card")
    }


def test_a_page_tells_other_sites_what_it_is(tmp_path: Path) -> None:
    scene = car().replace(name="my car")
    address = "https://example.com/cars/"
    save_page(tmp_path / "my car.html", scene, size=SIZE, link=address)
    page = Elements((tmp_path / "my car.html").read_text("utf-8"))
    levels = display_image(scene, render(scene, SIZE, smooth=2)).ranges["body"].levels
    about = {"og:title": "my car", "og:description": LINE.format(levels), "description": LINE.format(levels)}
    assert metas_of(page) == {
        **about,
        "og:url": address,
        "og:image": "https://example.com/cars/my%20car.png",
        "twitter:card": "summary_large_image",
    }
    colors = np.asarray(Image.open(tmp_path / "my car.png").convert("RGB"))
    assert (colors == image(scene, size=SIZE, smooth=2)).all()
    save_page(tmp_path / "alone.html", scene, size=SIZE)
    assert metas_of(Elements((tmp_path / "alone.html").read_text("utf-8"))) == about
    assert not (tmp_path / "alone.png").exists()


def test_a_page_shows_a_small_image_before_its_script_runs(tmp_path: Path) -> None:
    save_page(tmp_path / "car.html", car(), size=(1300, 650), smooth=1)
    ((attributes, _),) = Elements((tmp_path / "car.html").read_text("utf-8")).all("img")
    source = attributes["src"] or ""
    data = b64decode(source.removeprefix("data:image/webp;base64,"))
    assert len(data) <= 12_000
    assert Image.open(BytesIO(data)).size == (640, 320)
    assert (attributes["width"], attributes["height"]) == ("1300", "650")


@pytest.mark.parametrize(
    "options",
    [
        *({"link": link} for link in ("coupe.html", "ftp://a.com/a.html", "javascript:alert(1)", "https:")),
        *({"link": link} for link in ("https://[", "https://a.com/a b", "https://a.com/\ud800", 5, None)),
        *({"size": size} for size in ((0, 1), 5, (32, "24"))),
        {"smooth": 0},
    ],
)
def test_an_option_that_is_wrong_is_refused(tmp_path: Path, options: dict[str, Any]) -> None:
    with pytest.raises(UsageError, match=r"^(a link must be the address|a size must|smooth must)"):
        save_page(tmp_path / "car.html", car(), **{"size": SIZE, **options})
    assert not [*tmp_path.iterdir()]


def test_a_page_with_a_link_never_overwrites_a_png_unasked(tmp_path: Path) -> None:
    (tmp_path / "car.png").write_text("mine")
    with pytest.raises(OutputError):
        save_page(tmp_path / "car.html", car(), size=SIZE, link="https://example.com/")
    assert (tmp_path / "car.png").read_text() == "mine"
    assert not (tmp_path / "car.html").exists()


def test_the_line_of_a_page_of_scalars_says_nothing_of_a_paint() -> None:
    scene = car().with_scalar(name="z")
    assert metas_of(page_with(scene))["description"] == "General Motors, 1983: the picture is sent once."


def test_a_page_is_never_written_over_unasked(tmp_path: Path) -> None:
    scene = car()
    picture = render(scene, SIZE)
    path = tmp_path / "car.html"
    save_page(path, scene, picture)
    before = path.read_bytes()
    # The page of a picture is the same every time.
    save_page(tmp_path / "again.html", scene, size=SIZE, smooth=1)
    assert before == (tmp_path / "again.html").read_bytes()
    with pytest.raises(OutputError):
        save_page(path, scene.with_surface("body", object_color="navy"), picture)
    assert path.read_bytes() == before
    save_page(path, scene.with_surface("body", object_color="navy"), picture, overwrite=True)
    assert path.read_bytes() != before


def test_a_page_of_another_scene_is_refused(tmp_path: Path) -> None:
    picture = render(car(), SIZE)
    with pytest.raises(UsageError, match="the scene must come before the picture"):
        save_page(tmp_path / "new.html", picture, car())  # type: ignore[arg-type]
    with pytest.raises(InputError):
        save_page(tmp_path / "car.png", demo(), picture)
    with pytest.raises(UsageError):
        save_page(tmp_path / "car.png", car(), picture)
    assert list(tmp_path.iterdir()) == []
