"""A page: one HTML file that shows a picture and recolors it, in any browser and without a network.

The file has a style, the picture as JSON and a script. Its policy allows nothing else: no request, no other
script. The names of a scene never become markup.
"""

from __future__ import annotations

import json
import re
from base64 import b64encode
from collections.abc import Callable
from hashlib import sha256
from html import escape
from importlib.resources import files
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote, urljoin

from autocolor.arrays import Bytes
from autocolor.batches.table import Rows
from autocolor.checks import printable, shown
from autocolor.errors import UsageError
from autocolor.files.writing import check_suffix, refuse_output, write_atomically
from autocolor.images import default_smooth, image, save_image
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.rendering import SIZE, checked_size, render
from autocolor.scene.scene import Scene, check_scene
from autocolor.scene.view import NamedView
from autocolor.web.exported import LARGEST_CANVAS, check_canvas, export_of
from autocolor.web.views import views_of

PAGE: Final = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
{metas}
<link rel="icon" href="{icon}">
<style>{style}</style>
</head>
<body>
<div id="autocolor" class="autocolor page">
<div class="desk"><div class="stage">{poster}</div></div>
<noscript>This page shows and recolors its picture by a script; allow scripts to see it.</noscript>
</div>
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

LINE: Final = "General Motors, 1983: the picture is sent once; your paint changes {} of 1,024 colors."
"""The line below the title, with the number of levels of the chosen surface."""

ICON: Final = (
    "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E"
    "%3Ccircle cx='8' cy='8' r='8' fill='%23b01020'/%3E%3Ccircle cx='5.5' cy='5' r='2' fill='%23fff'/%3E"
    "%3C/svg%3E"
)
"""A red ball with its highlight."""


def save_page(
    path: str | PathLike[str],
    scene: Scene,
    picture: Picture | None = None,
    *,
    size: tuple[int, int] | None = None,
    smooth: int | None = None,
    views: int | str | None = None,
    lights: bool = False,
    variants: Rows = (),
    link: str = "",
    overwrite: bool = False,
    progress: Callable[[str], object] | None = None,
) -> None:
    """Write a page that shows a picture and recolors it in any browser, as one HTML file, atomically.

        autocolor.save_page("coupe.html", scene)
        autocolor.save_page("turning.html", scene, views=12)

    Without a `picture` the scene is rendered, with `size` and `smooth` as in `save_image`. The page has the
    samples of a smooth picture, and its browser averages them.

    With `views`, visitors can turn the picture. A number from 2 to 64 is the number of views from all around
    the object; "cameras" stands for the scene's view and its named views. All views have the levels and the
    exposure of the first view. With `lights`, the lights of the first view can be changed.

    `variants` are a list of `Variant`s, or of tables of values by key, which change paints alone: the page
    shows them as a strip. Scalar colors, a legend, and words that stand for normals are shown but cannot be
    edited. `link` is the address that the page will have: then a PNG with the name of the page is written
    beside it, which other sites show. `progress` is called with the name of each view that is rendered.

    Raises UsageError for a name that does not end in .html, for a size or views beside a picture, for other
    views and links, and for variants that change anything else; InputError if the surfaces of the picture are
    not those of the scene, if it has more than 16,777,216 pixels, for an invalid value of a variant, and if
    the views cannot have one table; OutputError and WriteError as `save_image`.
    """
    if picture is None:
        check_scene(scene)
    else:
        check_surfaces(scene, picture)
        if views is not None or size is not None or smooth is not None:
            raise UsageError(
                "views, size and smooth must be for a scene that is rendered, not for its picture; give the"
                " scene alone"
            )
    check_suffix(path, ".html", "a page")
    check_link(link)
    png = Path(path).with_suffix(".png")
    for output in (path, png)[: 1 + bool(link)]:
        refuse_output(output, overwrite=overwrite)
    rows: tuple[NamedView, ...] = ()
    if picture is None:
        width, height = size = checked_size(SIZE if size is None else size, 1 if smooth is None else smooth)
        if smooth is None:
            smooth = default_smooth(size)
            smooth = smooth if width * height * smooth**2 <= LARGEST_CANVAS else 1
        check_canvas(width * smooth, height * smooth)
        rows = views_of(scene, views, width / height)
        scene = scene.replace(view=rows[0].view)
        picture = render(scene, size, smooth=smooth)
        if progress is not None:
            progress(rows[0].name)
    values = export_of(scene, picture, lights=lights, variants=variants, views=rows, progress=progress)
    page = page_of({**values, "link": link}, image(scene, picture), png.name)
    if link:
        save_image(png, scene, picture, overwrite=overwrite)
    write_atomically(path, page.encode(), overwrite=overwrite)


ADDRESS: Final = re.compile(r"https?://[\w.-]+(:\d+)?([/?#]\S*)?", re.ASCII)


def check_link(link: str) -> None:
    """Raise UsageError unless a link is the address of a page, or empty."""
    if link != "" and not (isinstance(link, str) and link.isprintable() and ADDRESS.fullmatch(link)):
        raise UsageError(
            "a link must be the address of the page, such as https://example.com/coupe.html, not"
            f" {shown(link)}; give it whole"
        )


def page_of(picture: dict[str, Any], colors: Bytes | None = None, png: str = "") -> str:
    """The HTML of the page of an exported picture.

    `colors`, (lines, elements, 3) uint8, are shown until the script has run. If the picture has a link, `png`
    is the name of its image beside the page.
    """
    folder = files("autocolor.web")
    style = without_comments(folder.joinpath("autocolor.css").read_text("utf-8"))
    module, _, _ = folder.joinpath("autocolor.js").read_text("utf-8").partition(FOR_NOTEBOOKS)
    script = without_comments(module) + START
    name = printable(picture["name"])
    policy = (
        "default-src 'none'; img-src data: blob:; base-uri 'none'; form-action 'none';"
        f" script-src '{_hash(script)}'; style-src '{_hash(style)}'"
    )
    levels = [each["levels"] for each in picture["surfaces"] if not each["fixed"]]
    line = LINE.format(levels[0]) if levels else f"{LINE.partition(';')[0]}."
    metas = {"description": line, "og:title": name or "autocolor", "og:description": line}
    if link := picture.get("link", ""):
        metas |= {"og:url": link, "og:image": urljoin(link, quote(png))}
        metas["twitter:card"] = "summary_large_image"
    return PAGE.format(
        policy=policy,
        title=escape(f"{name} - autocolor" if name else "autocolor"),
        metas="\n".join(
            f'<meta {"property" if ":" in key else "name"}="{key}" content="{escape(text)}">'
            for key, text in metas.items()
        ),
        icon=ICON,
        style=style,
        poster="" if colors is None else _poster(colors),
        # In JSON, "<" only occurs in texts. Escaped, no text can end the script.
        picture=json.dumps({"line": LINE, **picture}, separators=(",", ":")).replace("<", "\\u003c"),
        script=script,
    )


POSTER_QUALITY: Final = 80
"""The quality of the WebP that is shown first, 1 to 100. Measured: the WebP of the coupe has 9 kB."""


def _poster(colors: Bytes) -> str:
    """An element that shows colors, at most SIZE[0] wide."""
    from PIL import Image

    data, poster = BytesIO(), Image.fromarray(colors)
    poster.thumbnail((SIZE[0], SIZE[0]))
    poster.save(data, "WEBP", quality=POSTER_QUALITY, method=6)
    lines, elements = colors.shape[:2]
    source = b64encode(data.getvalue()).decode()
    return f'<img alt="" width="{elements}" height="{lines}" src="data:image/webp;base64,{source}">'


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
