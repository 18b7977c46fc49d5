"""The export of a picture for a browser, as values that JSON can hold.

The browser has what the display has: the words of the raster, the 1024 entries, and the range of each
surface. So it recolors as the display does, by entries alone.

Words and planes are compressed twice: as differences between neighbors, which are small, and then by zlib,
which browsers can inflate. A smooth picture keeps all of its samples; the browser averages them.

Measured: the words of the coupe take 31.4 kB at 640 x 480 and 73.7 kB with smooth=2. Measured and rejected:
differences of 16 bits, 36.7 and 88.5 kB.
"""

from __future__ import annotations

import zlib
from base64 import b64encode
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from autocolor.arrays import Words
from autocolor.batches.table import Rows, variants_of
from autocolor.errors import InputError, UsageError
from autocolor.files.settings import place_of, scene_with
from autocolor.images import display_image, middles
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.legend import legend
from autocolor.scene.columns import fields_of
from autocolor.scene.kinds import in_digits
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Paint
from autocolor.sending import shown_words

FORMAT: Final = "autocolor page 1"

LARGEST_CANVAS: Final = 16_777_216
"""Limit: pixels of a picture in a browser. Canvases of phones hold no more."""

MOST_VARIANTS_SHOWN: Final = 1000
"""Limit: variants of a picture in a browser."""

LARGEST_STEP: Final = 60
"""Assumed: differences of words up to this size take one byte, as most do within a surface."""

FAR: Final = 128
"""The byte of a larger difference."""


def export_of(scene: Scene, picture: Picture, *, variants: Rows = ()) -> dict[str, Any]:
    """A picture in the colors of a scene, as values that JSON can hold.

    Raises InputError if the surfaces of the picture are not those of the scene, if the picture is larger than
    a canvas of a phone, and for an invalid value of a variant; UsageError for a variant that changes anything
    but paints, and for too many variants.
    """
    check_surfaces(scene, picture)
    if picture.lines * picture.elements > LARGEST_CANVAS:
        raise InputError(
            f"a picture in a browser must have at most {LARGEST_CANVAS:,} pixels, which canvases of phones"
            f" hold, not {picture.elements:,} x {picture.lines:,}; render it smaller or with less `smooth`"
        )
    image = display_image(scene, picture)
    values = values_of(image)
    return {
        **values,
        "smooth": picture.smooth,
        "words": _text(packed_words(image.words)),
        "entries": _text(zlib.compress(image.entries.tobytes(), 9)),
        "legend": _legend_values(image, picture.smooth),
        "variants": _variant_values(image, values, variants),
    }


def values_of(image: DisplayImage) -> dict[str, Any]:
    """Everything about an image but its words and entries, as values that JSON can hold.

    Nothing is smooth, the words contain the legend, if any, and there are no variants and no lights.
    """
    scene, (lines, elements) = image.scene, image.words.shape
    counts = np.bincount(image.words.ravel(), minlength=len(image.entries))
    surfaces = []
    for name, (first, levels) in image.ranges.items():
        bands = image.bands.get(name)
        surfaces.append(
            {
                "name": name,
                "first": first,
                "levels": levels,
                "shades": levels if bands is None else bands.shades,
                "floor": image.floor_of(name),
                "pixels": int(counts[first : first + levels].sum()),
                "fixed": _reason_of_fixed(image, name),
                "paint": paint_values(scene.surface(name).paint),
            }
        )
    notes = dict.fromkeys(surface["fixed"] for surface in surfaces if surface["fixed"])
    return {
        "format": FORMAT,
        "name": scene.name,
        "lines": lines,
        "elements": elements,
        "smooth": 1,
        "background": in_digits(scene.background),
        "surfaces": surfaces,
        "legend": None,
        "notes": list(notes),
        "variants": [],
        "lights": None,
    }


def _reason_of_fixed(image: DisplayImage, name: str) -> str:
    """Why the colors of a surface cannot be edited; empty if they can."""
    scalar = image.scene.scalar
    if not image.has_light_in_words:
        return "Words stand for normals here, so colors are shown as they were exported."
    if scalar is not None and name in image.bands:
        return f"Colors stand for the scalar “{scalar.name}” here and cannot be edited."
    return ""


def paint_values(paint: Paint) -> dict[str, Any]:
    """The fields of a paint, with colors as "#rrggbb"."""
    return {
        "object_color": in_digits(paint.object_color),
        "light_color": in_digits(paint.light_color),
        "blend": paint.blend,
        "light_percentage": paint.light_percentage,
        "ramp": None if paint.ramp is None else [in_digits(color) for color in paint.ramp],
    }


def packed_words(words: Words, effort: int = 9) -> bytes:
    """Words of at most 16 bits, (lines, elements), packed by `_steps` and by zlib with an effort, 1 to 9."""
    return zlib.compress(_steps(words), effort)


def _steps(words: Words) -> bytes:
    """One byte a pixel, and then the words of some pixels, low byte first, in raster order.

    The byte is the difference to the word on the left, 0 at the left edge, modulo 256. FAR stands for a
    larger difference than LARGEST_STEP; the words of these pixels follow.
    """
    steps = np.diff(words.astype(np.int32), axis=1, prepend=0)
    is_far = np.abs(steps) > LARGEST_STEP
    steps[is_far] = FAR
    return steps.astype(np.uint8).tobytes() + words[is_far].astype("<u2").tobytes()


def _text(data: bytes) -> str:
    return b64encode(data).decode("ascii")


def _legend_values(image: DisplayImage, smooth: int) -> dict[str, Any] | None:
    """The area and the words of the legend, at the size of the samples of a smooth picture; None without."""
    small = middles(image, smooth)
    key = legend(small)
    if key is None:
        return None
    left, top, right, bottom, _ = key.swatches[0]
    words = shown_words(small)[top : bottom + 1, left : right + 1]
    words = words.repeat(smooth, axis=0).repeat(smooth, axis=1)
    lines, elements = words.shape
    return {
        "line": top * smooth,
        "element": left * smooth,
        "lines": lines,
        "elements": elements,
        "words": _text(packed_words(words)),
    }


def _variant_values(image: DisplayImage, values: Mapping[str, Any], variants: Rows) -> list[dict[str, Any]]:
    """What each variant changes of the paints in the export `values` of an image.

    Raises UsageError for a key that no page can change, InputError for an invalid value.
    """
    rows = variants_of(variants)
    if len(rows) > MOST_VARIANTS_SHOWN:
        raise UsageError(
            f"a picture in a browser must have at most {MOST_VARIANTS_SHOWN:,} variants, not {len(rows):,};"
            " leave some out"
        )
    before = {surface["name"]: surface["paint"] for surface in values["surfaces"]}
    fixed = {surface["name"]: surface["fixed"] for surface in values["surfaces"]}
    exported = []
    for variant in rows:
        for key in variant.settings:
            table, name, path = place_of(image.scene, key)
            if table != "surfaces" or path[0] not in fields_of(Paint):
                raise UsageError(
                    f"variant {variant.name!r}: {key}: a variant of a page must change paints alone, such as"
                    " surfaces.body.object_color; leave this key out"
                )
            if fixed.get(name):
                raise UsageError(f"variant {variant.name!r}: {key}: {fixed[name]} Leave this key out")
        try:
            scene = scene_with(image.scene, variant.settings)
        except InputError as error:
            raise InputError(f"variant {variant.name!r}: {problem}" for problem in error.problems) from None
        paints = {}
        for name, old in before.items():
            new = paint_values(scene.surface(name).paint)
            if new != old:
                paints[name] = {key: value for key, value in new.items() if value != old[key]}
        exported.append({"name": variant.name, "paints": paints, "lights": {}})
    return exported
