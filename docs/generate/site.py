"""The folder that the site is built from: `docs`, the front page, the live coupe, and sources.

`python -m docs.generate.site` writes it to build/docs, as `mkdocs.yml` expects.

The documents are written for a clone, where a link leads to a file of the project. On the site, README.md is
the front page, and a link to a file outside `docs` leads to a page that shows the file.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from posixpath import dirname, join, normpath, relpath, splitext
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[2]
FOLDER: Final = ROOT / "build" / "docs"

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

LIVE: Final = """## Try it here

<iframe class="live" src="coupe.html" title="The coupe, with colors and lights to change"></iframe>

Point at the body and mix a paint: your browser rewrites entries of the table, and computes no pixel again.
The picture is [one file](coupe.html), made by `autocolor page`, and works without a network.

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


def page_of(document: str, markdown: str) -> str:
    """The text of a document on the site, its links changed to places there."""
    here = dirname(place_of(document)) or "."
    for link in reversed(list(links_of(markdown))):
        path, mark, anchor = link[0].partition("#")
        if path:
            place = relpath(place_of(target_of(document, path)), here) + mark + anchor
            markdown = markdown[: link.start()] + place + markdown[link.end() :]
    if document == "README.md":
        markdown = FULL_WIDTH + markdown.replace("\n## ", f"\n{LIVE}## ", 1)
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


def write_live_coupe() -> None:
    """Write the coupe as a page, with its lights."""
    import autocolor

    scene = autocolor.demo()
    picture = autocolor.render(scene, smooth=2)
    autocolor.save_page(FOLDER / "coupe.html", scene, picture, lights=True, overwrite=True)


def main() -> None:
    """Write the whole folder."""
    texts = documents()
    shutil.rmtree(FOLDER, ignore_errors=True)
    own = shutil.ignore_patterns("*.md", "*.py", "__pycache__", "generate")
    shutil.copytree(ROOT / "docs", FOLDER, ignore=own)
    write_live_coupe()
    for document, text in texts.items():
        write(place_of(document), page_of(document, text).encode())
    for path in {target_of(document, link[0]) for document in texts for link in links_of(texts[document])}:
        if (place := place_of(path)).startswith("source/") and (ROOT / path).is_file():
            content = (ROOT / path).read_bytes()
            write(place, source_page(path, content.decode()).encode() if place.endswith(".md") else content)


if __name__ == "__main__":
    main()
