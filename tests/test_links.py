"""Links of the documents lead somewhere, in a clone and on the site; nothing is fetched."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from functools import cache

import pytest

import autocolor
import ramtek_emu
from docs.generate.site import PAGES, ROOT, documents, links_of, page_of, place_of, target_of

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


def test_the_front_page_shows_the_live_coupe_before_its_second_heading() -> None:
    page = page_of("README.md", "# A\n\ntext\n\n## B\n\n## C\n")
    assert re.findall("^## .*|^<iframe.*src=.coupe.html.", page, re.MULTILINE) == [
        "## Try it here", '<iframe class="live" src="coupe.html"', "## B", "## C",
    ]  # fmt: skip


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


def test_the_reference_of_python_has_every_public_name() -> None:
    shown = re.findall(r"^::: (.*)$", DOCUMENTS["docs/api.md"], re.MULTILINE)
    public = [f"{package.__name__}.{name}" for package in (autocolor, ramtek_emu) for name in package.__all__]
    assert sorted(shown) == sorted([*public, "ramtek_emu.instructions"])


def test_examples_in_public_docstrings_are_indented_as_code() -> None:
    assert not [name for name, text in docstrings() if re.search("^>>>", text, re.MULTILINE)]
