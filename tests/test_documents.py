"""Code, quotes, names of tests, links and pictures of README, CONTRIBUTING and docs are right."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import autocolor
import ramtek_emu
from docs.generate.blocks import blocks_of
from docs.generate.site import (
    EXAMPLES,
    PAGES,
    PUBLIC,
    ROOT,
    documents,
    links_of,
    page_of,
    place_of,
    place_of_name,
    target_of,
    value_of,
)
from docs.guides import pictures, pictures_of_displays
from docs.guides.pictures import GUIDES, path_of
from scenes.figures import Field
from scenes.title_picture import PATH, recolored
from tests.tables import first
from tests.test_architecture import WINGS

README = (ROOT / "README.md").read_text("utf-8")
(CODE,) = re.findall(r"^```python\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
(PRINTED,) = re.findall(r"^```text\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)


def test_the_lines_of_the_readme_print_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for _ in range(2):
        names: dict[str, Any] = {}
        exec(CODE, names)
        assert capsys.readouterr().out == PRINTED
    names["studio"].undo()
    scene = names["studio"].scene
    with Image.open("blue.png") as blue:
        assert (np.array(blue) == autocolor.image(scene, autocolor.render(scene, smooth=2))).all()


def test_the_picture_of_the_readme_is_that_of_its_script() -> None:
    frames = recolored()
    with Image.open(PATH) as film:
        for number in (0, len(frames) // 2, len(frames) - 1):
            film.seek(number)
            assert (np.array(film.convert("RGB")) == frames[number]).all(), (
                "run: python -m scenes.title_picture"
            )


TEXT = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
SOURCES = [
    (ROOT / path).read_text("utf-8")
    for path in (
        "autocolor/lighting/controls.py",
        "autocolor/lighting/light.py",
        "autocolor/scene/lights.py",
    )
]


@pytest.mark.parametrize("quote", re.findall(r"^```python\n(.*?)^```$", TEXT, re.DOTALL | re.MULTILINE))
def test_the_light_control_is_quoted_as_it_is_in_the_source(quote: str) -> None:
    assert any(quote in source for source in SOURCES)


@pytest.mark.parametrize("package", WINGS)
def test_all_parts_of_a_package_are_described_in_their_order(package: str) -> None:
    table = TEXT[TEXT.index(f"| `{package}` | subject |") :].split("\n\n")[0]
    names = re.findall(r"`(\w+)`", "".join(row.split("|")[1] for row in table.splitlines()))
    assert (*names, "__main__") == (package, *WINGS[package])


def test_the_tables_that_additions_need_are_in_their_files() -> None:
    tables = re.findall(r"`(\w+)` of `([^`]+\.py)`", TEXT[TEXT.index("## Add something else") :])
    assert tables
    for name, file in tables:
        assert re.search(rf"^(def )?{name}\b", (ROOT / file).read_text("utf-8"), re.MULTILINE), (name, file)


PROMISES = [
    line
    for line in (ROOT / "docs" / "SECURITY.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| **")
]
FILES = [*(ROOT / "tests").rglob("test_*.py")]


@pytest.mark.parametrize("promise", PROMISES, ids=lambda line: line[4:40])
def test_each_promise_names_tests_that_exist(promise: str) -> None:
    named = re.findall(r"`(test_\w+\.py)(?:::(test_\w+))?`", promise.split("|")[2])
    assert named
    for file, name in named:
        texts = [path.read_text(encoding="utf-8") for path in FILES if path.name == file]
        # A table of refusals is a test that is assigned.
        assert any(re.search(rf"^(def )?{name}", text, re.MULTILINE) for text in texts), (file, name)


DOCUMENTS = documents()
NAV = re.findall(r"([\w/]+\.md)$", (ROOT / "mkdocs.yml").read_text("utf-8"), re.MULTILINE)


@cache
def anchors_of(path: str) -> set[str]:
    """The anchors of a document's headings, as GitHub makes them."""
    text = re.sub(r"^ *```.*?^ *```$", "", DOCUMENTS[path], flags=re.DOTALL | re.MULTILINE)
    titles = re.findall(r"^#+ (.*)$", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-") for title in titles}


def is_lost(document: str, link: str) -> bool:
    """Whether a link leads to no file of the project, or to no heading."""
    target, anchor = target_of(document, link), link.partition("#")[2]
    if not (ROOT / target).is_file():
        return True
    return bool(anchor) and (target not in DOCUMENTS or anchor not in anchors_of(target))


@pytest.mark.parametrize("document", DOCUMENTS)
def test_every_link_of_a_document_leads_to_a_file_and_a_heading(document: str) -> None:
    lost = [link[0] for link in links_of(DOCUMENTS[document]) if is_lost(document, link[0])]
    assert not lost


def test_links_in_code_and_on_other_sites_are_left_alone() -> None:
    text = "[a](b.md) `[c](d.md)` ![e](f.png)\n```\n[g](h.md)\n```\n[i](https://j.org/k) [l](#m)\n"
    assert [link[0] for link in links_of(text)] == ["b.md", "f.png", "#m"]
    text = "`a\nb` [c](d.md) ``e ` [f](g.md)`` [h](i.md) `\n\n[j](k.md) `l`"
    assert [link[0] for link in links_of(text)] == ["d.md", "i.md", "k.md"]


def test_links_change_to_places_on_the_site() -> None:
    text = "[a](../scenes/figure_04.py) [b](../README.md#g) [c](COLUMNS.md) [d](#e) [f](generate/site.py)"
    assert page_of("docs/x.md", text) == (
        "[a](source/scenes/figure_04.py.md) [b](index.md#g) [c](COLUMNS.md) [d](#e)"
        " [f](source/docs/generate/site.py.md)"
    )
    assert page_of("docs/guides/x.md", "[a](../../CHANGELOG.md) [b](../../scenes/coupe/body.obj)") == (
        "[a](../changelog.md) [b](../source/scenes/coupe/body.obj)"
    )


def test_the_front_page_begins_with_the_live_coupe_instead_of_its_picture() -> None:
    page = page_of("README.md", README)
    assert page.index('<iframe src="coupe.html?embed"') < page.index("# AUTOCOLOR")
    assert "recolor.webp" not in page


def test_each_picture_of_the_gallery_has_a_thumbnail_its_script_and_downloads() -> None:
    entries = re.findall(
        r"^!\[.+\]\((.+)\)\n\n\[.+\]\(\.\./(.+)\)$", DOCUMENTS["docs/gallery.md"], re.MULTILINE
    )
    page = page_of("docs/gallery.md", DOCUMENTS["docs/gallery.md"])
    assert page.count("thumb.webp") == len(entries) > 20
    for picture, script in entries:
        for text in (
            f"]({picture}.thumb.webp)]({picture})",
            f"[Script](source/{script}.md)",
            f'[picture]({picture}){{download=""}}',
            f'<a href="source/{script}" download>',
        ):
            assert text in page


def test_the_page_of_python_links_to_the_page_of_every_name_below_its_example() -> None:
    page = page_of("docs/api.md", DOCUMENTS["docs/api.md"])
    for name in PUBLIC:
        before, _, after = page.partition(f"- [`{name}`]({place_of_name(name)}): ")
        assert EXAMPLES[name] in before, f"show {name} in an example of docs/api.md"
        assert after.partition("\n")[0]
    places = [place_of_name(name).lower() for name in PUBLIC]
    assert len(set(places)) == len(places)


def test_every_document_is_in_the_navigation_of_the_site_once() -> None:
    assert sorted(NAV) == sorted(place_of(path) for path in DOCUMENTS)
    assert set(PAGES) <= set(DOCUMENTS)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_lists_and_tables_of_a_document_look_alike_in_a_clone_and_on_the_site(document: str) -> None:
    lines = re.sub(r"^ *```.*?^ *```$", "", DOCUMENTS[document], flags=re.DOTALL | re.MULTILINE).split("\n")
    item, row = re.compile(r" *([-*]|\d+\.) "), re.compile(r" *\|")
    for before, line in zip(["", *lines], lines, strict=False):
        inside = before.startswith("  ") or item.match(before)
        assert not re.match(r" {1,3}([-*] |\d+\. |\|)", line), f"indent by four spaces: {line}"
        assert not item.match(line) or not before or inside, f"begin a list after an empty line: {line}"
        assert not row.match(line) or not before or row.match(before), f"after an empty line: {line}"


def docstrings() -> Iterator[tuple[str, str]]:
    """The docstrings of the public names, and of their public members."""
    for package in (autocolor, ramtek_emu):
        for name in package.__all__:
            value = getattr(package, name)
            yield f"{package.__name__}.{name}", inspect.getdoc(value) or ""
            for member, inner in vars(value).items() if inspect.isclass(value) else ():
                if not member.startswith("_") and (inspect.isroutine(inner) or isinstance(inner, property)):
                    yield f"{package.__name__}.{name}.{member}", inspect.getdoc(inner) or ""


def test_every_keyword_of_a_public_function_is_in_its_docstring() -> None:
    for function in filter(inspect.isfunction, (value_of(name) for name in PUBLIC)):
        keywords = inspect.signature(function).parameters.keys() - {"path", "overwrite"}
        text = inspect.getdoc(function) or ""
        assert not [each for each in keywords if not re.search(rf"\b{each}s?\b", text)], function


def test_examples_in_public_docstrings_are_indented_as_code() -> None:
    assert not [name for name, text in docstrings() if re.search("^>>>", text, re.MULTILINE)]


PICTURES = (*pictures.PICTURES, *pictures_of_displays.PICTURES)
MOST_BYTES = 60_000
CLOSE = 1.0
"""The mean difference of components. Fewer colors make 0.25 of it, and a missing drag at least 5."""

LOSSY = 1.5
"""The mean difference of components, as above, for WebP files that are not lossless."""

SCREENS = [picture for picture in PICTURES if "open_viewer" in inspect.getsource(picture)]
DRAWN = [picture for picture in PICTURES if re.search(r"upper_half|Inspector\(", inspect.getsource(picture))]
"""The pictures of the listings in display.md and inspect.md. They have few colors, so no color is lost."""


def test_every_image_is_small_and_in_a_guide() -> None:
    text = "".join(path.read_text("utf-8") for path in GUIDES.glob("*.md"))
    for path in (GUIDES / "images").iterdir():
        assert f"](images/{path.name})" in text, f"remove {path}, or show it"
        assert path.stat().st_size <= MOST_BYTES


def test_every_picture_is_in_its_guide() -> None:
    for picture in PICTURES:
        guide = GUIDES / f"{picture.__name__.partition('_')[0]}.md"
        assert f"](images/{path_of(picture).name})" in guide.read_text("utf-8")


BLOCKS = [block.text for block in blocks_of((GUIDES / "cookbook.md").read_text("utf-8"))]
RECIPES = pictures.recipes()


def test_each_script_of_the_cookbook_has_a_picture_and_at_most_ten_lines() -> None:
    assert [*RECIPES.values()] == BLOCKS
    assert len(RECIPES) == 20
    assert max(len([line for line in text.splitlines() if line]) for text in BLOCKS) <= 10


@pytest.mark.parametrize("name", RECIPES)
def test_a_script_of_the_cookbook_writes_its_picture(name: str, tmp_path: Path) -> None:
    made = pictures.cooked(name, tmp_path)
    with Image.open(GUIDES / "images" / f"cookbook-{name}.webp") as image:
        assert max(image.size) <= pictures.RECIPE[0]
        saved = np.asarray(image.convert("RGBA").convert("RGBa"), np.int16)
    if made.suffix != ".html":
        now = np.asarray(pictures.small_frames(made)[0].convert("RGBA").convert("RGBa"), np.int16)
        assert np.abs(saved - now).mean() < LOSSY, f"run: python -m docs.guides.pictures cookbook_{name}"


@pytest.mark.parametrize("picture", first(2, SCREENS), ids=lambda picture: picture.__name__)
def test_a_picture_of_a_screen_is_that_of_its_steps(picture: Callable[[], Field]) -> None:
    assert np.abs(saved(picture).astype(np.int16) - picture()).mean() < CLOSE, command(picture)


@pytest.mark.parametrize("picture", first(2, DRAWN), ids=lambda picture: picture.__name__)
def test_the_picture_of_a_listing_is_what_the_display_draws(picture: Callable[[], Field]) -> None:
    assert (saved(picture) == picture()).all(), command(picture)


def saved(picture: Callable[[], Field]) -> Field:
    """A picture as its guide shows it."""
    with Image.open(path_of(picture)) as image:
        return np.asarray(image.convert("RGB"))


def command(picture: Callable[[], Field]) -> str:
    """What to run if the saved picture is out of date."""
    return f"run: python -m {picture.__module__} {picture.__name__}"
