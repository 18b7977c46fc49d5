"""The site: `python -m docs.generate.site` collects its pages in build/docs, and builds it in build/site.

SITE_URL is the address of the site, if it has one, such as https://example.com/autocolor/.

The documents are written for a clone, where a link leads to a file of the project. On the site, README.md is
the front page, with the live coupe in place of its picture; a link to a file outside `docs` leads to a page
that shows the file; the gallery has thumbnails; each public name has a page of its own.
"""

from __future__ import annotations

import inspect
import os
import pkgutil
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from posixpath import dirname, join, normpath, relpath, splitext
from typing import Any, Final

from PIL import Image, ImageOps

import autocolor
import ramtek_emu
from docs.generate.blocks import blocks_of

ROOT: Final = Path(__file__).resolve().parents[2]
FOLDER: Final = ROOT / "build" / "docs"
SITE: Final = ROOT / "build" / "site"

PAGES: Final = {
    "README.md": "index.md", "docs/README.md": "documents.md",
    "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md",
}  # fmt: skip
"""The documents outside `docs` and the first page of `docs`, and their places on the site."""

LANGUAGES: Final = {
    ".c": "c", ".csv": "text", ".gpl": "text", ".js": "javascript", ".py": "python", ".toml": "toml"
}  # fmt: skip
"""The files that a page shows, by suffix. Others are copied as they are."""

FULL_WIDTH: Final = "---\nhide: [navigation, toc]\n---\n"
"""The head of a page without columns beside its text."""

HERO: Final = re.compile(r"^!\[.*\]\(docs/recolor\.webp\)$", re.MULTILINE)
"""The picture of the README."""

LIVE: Final = (
    '<div class="live"><iframe src="coupe.html?embed" scrolling="no"'
    ' title="The coupe: choose a paint, and drag the picture to turn it"></iframe></div>'
)
"""The live coupe. It does not scroll, so that a wheel or a finger over it moves the page."""

POSTER: Final = re.compile(r"data:image/webp;base64,[^\"]+")
"""The picture that a page of `autocolor page` shows before its script has run."""

ENTRY: Final = re.compile(r"#+ (.+)\n\n!\[(.+)\]\((.+)\)\n\n\[.+\]\(\.\./(.+)\)\n+")
"""An entry of the gallery: its title, the picture with its description, and the script."""

CARD: Final = r"""
-   [![\2](\3.thumb.webp)](\3)

    **\1**

    [Script](../\4) · Download: [picture](\3){download=""}, <a href="source/\4" download>script</a>
"""

CODE: Final = re.compile(
    r"^ *(?P<fence>```+).*?^ *(?P=fence) *$"
    r"|(?<!`)(?P<ticks>`+)(?!`)(?:[^\n]|\n(?! *\n))+?(?<!`)(?P=ticks)(?!`)",
    re.DOTALL | re.MULTILINE,
)
"""A block of code, or code in a paragraph."""

LINK: Final = re.compile(r"(?<=\]\()[^)\s]+(?=\))")


def links_of(markdown: str) -> Iterator[re.Match[str]]:
    """The targets of links and images in a document, without those in code and on other sites."""
    code = [match.span() for match in CODE.finditer(markdown)]
    for match in LINK.finditer(markdown):
        if "://" not in match[0] and not any(start <= match.start() < end for start, end in code):
            yield match


def documents() -> dict[str, str]:
    """The texts of all documents. Files are named by their path in the project."""
    paths = [ROOT / name for name in PAGES] + sorted((ROOT / "docs").rglob("*.md"))
    return {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in paths}


def target_of(document: str, link: str) -> str:
    """The file that a link in a document leads to."""
    path = link.partition("#")[0]
    return normpath(join(dirname(document), path)) if path else document


def place_of(path: str) -> str:
    """The place of a file on the site."""
    suffix = splitext(path)[1]
    if path in PAGES:
        return PAGES[path]
    if path.startswith("docs/") and suffix not in LANGUAGES:
        return path.removeprefix("docs/")
    return f"source/{path}.md" if suffix in LANGUAGES else f"source/{path}"


PUBLIC: Final = {
    f"{package.__name__}.{name}" for package in (autocolor, ramtek_emu) for name in package.__all__
} | {"ramtek_emu.instructions"}
"""The names that have a page."""


def examples_in(markdown: str) -> dict[str, str]:
    """The first code block that has each public name."""
    examples: dict[str, str] = {}
    for block in blocks_of(markdown):
        for name in re.findall(r"\b(?:autocolor|ramtek_emu)\.\w+", block.text):
            if name in PUBLIC:
                examples.setdefault(name, block.text)
    return examples


EXAMPLES: Final = examples_in((ROOT / "docs" / "api.md").read_text("utf-8"))


def value_of(name: str) -> Any:
    """The value of a public name, such as `autocolor.render`."""
    return pkgutil.resolve_name(name.replace(".", ":"))


def place_of_name(name: str) -> str:
    """The place of the page of a public name. Some disks hold no `View` beside a `view`."""
    package, name = name.split(".")
    return f"api/{package}/{'functions' if name.islower() else 'classes'}/{name}.md"


def summary_of(name: str) -> str:
    """A link to the page of a public name, and the first paragraph of its docstring."""
    value = value_of(name)
    is_constant = name.split(".")[1].isupper()
    text = f"A {type(value).__name__}." if is_constant else (inspect.getdoc(value) or "").partition("\n\n")[0]
    return f"[`{name}`]({place_of_name(name)}): {' '.join(text.split())}"


def page_of(document: str, markdown: str) -> str:
    """The text of a document on the site, its links changed to places there."""
    if document == "README.md":
        markdown = f"{FULL_WIDTH}{LIVE}\n\n{HERO.sub('', markdown)}"
    if document == "docs/gallery.md":
        markdown = FULL_WIDTH + re.sub(
            rf"(?:{ENTRY.pattern})+",
            lambda run: f'<div class="grid cards" markdown>\n{ENTRY.sub(CARD, run[0])}\n</div>\n\n',
            markdown,
        )
    if document == "docs/api.md":
        for example in dict.fromkeys(EXAMPLES.values()):
            block = f"```python\n{example}```\n"
            names = [f"- {summary_of(name)}" for name in EXAMPLES if EXAMPLES[name] == example]
            markdown = markdown.replace(block, "\n".join([block, *names, ""]))
    here = dirname(place_of(document)) or "."
    for link in reversed(list(links_of(markdown))):
        path, mark, anchor = link[0].partition("#")
        if path:
            place = relpath(place_of(target_of(document, path)), here) + mark + anchor
            markdown = markdown[: link.start()] + place + markdown[link.end() :]
    return markdown


def source_page(path: str, text: str) -> str:
    """A page that shows a source; the search leaves it out."""
    language = LANGUAGES[splitext(path)[1]]
    return f"---\nsearch: {{exclude: true}}\n---\n# {path}\n\n~~~~~{language}\n{text}\n~~~~~\n"


def write(place: str, content: bytes) -> None:
    """Write a file of the site."""
    path = FOLDER / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def collect() -> None:
    """Write the whole folder of pages."""
    texts = documents()
    shutil.rmtree(FOLDER, ignore_errors=True)
    own = shutil.ignore_patterns("*.md", "*.py", "__pycache__", "generate", "404.html")
    shutil.copytree(ROOT / "docs", FOLDER, ignore=own)
    for document, text in texts.items():
        write(place_of(document), page_of(document, text).encode())
    for path in {target_of(document, link[0]) for document in texts for link in links_of(texts[document])}:
        if (place := place_of(path)).startswith("source/") and (ROOT / path).is_file():
            content = (ROOT / path).read_bytes()
            write(f"source/{path}", content)
            if place.endswith(".md"):
                write(place, source_page(path, content.decode()).encode())
    for name in EXAMPLES:
        write(place_of_name(name), f"[Python](../../../api.md) / `{name}`\n\n::: {name}\n".encode())
    for _, _, picture, _ in ENTRY.findall(texts["docs/gallery.md"]):
        with Image.open(FOLDER / picture) as image:
            thumbnail = ImageOps.fit(image.convert("RGB"), (480, 360))
        thumbnail.save(FOLDER / f"{picture}.thumb.webp")
    # The picture of the live coupe is shown before the coupe is loaded.
    (poster,) = POSTER.findall((FOLDER / "coupe.html").read_text("utf-8"))
    with (FOLDER / "assets" / "site.css").open("a") as style:
        style.write(f'.live {{ background-image: url("{poster}"); }}\n')


def main() -> None:
    """Collect the pages and build the site."""
    collect()
    command = [sys.executable, "-m", "zensical", "build", "--clean", "--strict"]
    subprocess.run(command, cwd=ROOT, check=True)
    if "SITE_URL" not in os.environ:
        (SITE / "sitemap.xml").unlink()
        # Its links are right in any folder of a server, and those of the theme's page are not.
        shutil.copy(ROOT / "docs" / "assets" / "404.html", SITE)


if __name__ == "__main__":
    main()
