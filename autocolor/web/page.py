"""A page: one HTML file that shows a picture and recolors it, in any browser and without a network.

The file has a style, the picture as JSON and a script. Its policy allows nothing else: no request, no other
script. The names of a scene never become markup.
"""

from __future__ import annotations

import json
import re
from base64 import b64encode
from hashlib import sha256
from html import escape
from importlib.resources import files
from os import PathLike
from typing import Any, Final

from autocolor.batches.table import Rows
from autocolor.checks import printable
from autocolor.files.writing import check_suffix, refuse_output, write_atomically
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.scene.scene import Scene
from autocolor.web.exported import export_of

PAGE: Final = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="description" content="Recolor {name}: choose a surface and mix its colors.">
<title>{title}</title>
<link rel="icon" href="{icon}">
<style>{style}</style>
</head>
<body>
<div id="autocolor"></div>
<noscript>This page shows and recolors its picture by a script; allow scripts to see it.</noscript>
<script id="picture" type="application/json">{picture}</script>
<script type="module">{script}</script>
</body>
</html>
"""

START: Final = """
await mount(document.getElementById("autocolor"), JSON.parse(document.getElementById("picture").textContent));
"""
"""The end of the script of a page."""

FOR_NOTEBOOKS: Final = "// For notebooks: a page has only what is above this line."
"""The line of the module before the part that pages do not need."""

ICON: Final = (
    "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E"
    "%3Ccircle cx='8' cy='8' r='8' fill='%23b01020'/%3E%3Ccircle cx='5.5' cy='5' r='2' fill='%23fff'/%3E"
    "%3C/svg%3E"
)
"""A red ball with its highlight."""


def save_page(
    path: str | PathLike[str],
    scene: Scene,
    picture: Picture,
    *,
    lights: bool = False,
    variants: Rows = (),
    overwrite: bool = False,
) -> None:
    """Write a page that shows a picture and recolors it in any browser, as one HTML file, atomically.

        picture = autocolor.render(scene, smooth=2)
        autocolor.save_page("coupe.html", scene, picture)

    The page has the samples of a smooth picture, and its browser averages them. `variants` are a list of
    `Variant`s, or of tables of values by key, which change paints alone: the page shows them as a strip.
    Scalar colors, a legend, and words that stand for normals are shown but cannot be edited.

    Raises UsageError for a name that does not end in .html, and for variants that change anything else;
    InputError if the surfaces of the picture are not those of the scene, if it has more than 16,777,216
    pixels, and for an invalid value of a variant; OutputError and WriteError as `save_image`.
    """
    check_surfaces(scene, picture)
    check_suffix(path, ".html", "a page")
    refuse_output(path, overwrite=overwrite)
    page = page_of(export_of(scene, picture, lights=lights, variants=variants))
    write_atomically(path, page.encode(), overwrite=overwrite)


def page_of(picture: dict[str, Any]) -> str:
    """The HTML of the page of an exported picture."""
    folder = files("autocolor.web")
    style = without_comments(folder.joinpath("autocolor.css").read_text("utf-8"))
    module, _, _ = folder.joinpath("autocolor.js").read_text("utf-8").partition(FOR_NOTEBOOKS)
    script = without_comments(module) + START
    name = printable(picture["name"])
    policy = (
        "default-src 'none'; img-src data: blob:; base-uri 'none'; form-action 'none';"
        f" script-src '{_hash(script)}'; style-src '{_hash(style)}'"
    )
    return PAGE.format(
        policy=policy,
        name=escape(name or "a picture"),
        title=escape(f"{name} - autocolor" if name else "autocolor"),
        icon=ICON,
        style=style,
        # In JSON, "<" only occurs in texts. Escaped, no text can end the script.
        picture=json.dumps(picture, separators=(",", ":")).replace("<", "\\u003c"),
        script=script,
    )


COMMENTS: Final = re.compile(
    r"^[ \t]*(?:/\*(?:[^*]|\*(?!/))*\*/[ \t]*|//[^\n]*)\n|/\*\*(?:[^*]|\*(?!/))*\*/ ?", re.MULTILINE
)
"""Comments that have lines of their own, and types within a line."""


def without_comments(source: str) -> str:
    r"""A script or a style without its `COMMENTS`, indentation and empty lines.

    No text in it may extend over several lines. Measured: a page has 45 of the 65 kB of script and style.

    >>> without_comments("// Two.\nlet two = [\n  2, // Not 3.\n];\n").splitlines()
    ['let two = [', '2, // Not 3.', '];']
    """
    return re.sub(r"\n\s+", "\n", COMMENTS.sub("", source)).lstrip()


def _hash(text: str) -> str:
    """The hash by which a policy allows a script or a style."""
    return "sha256-" + b64encode(sha256(text.encode()).digest()).decode()
