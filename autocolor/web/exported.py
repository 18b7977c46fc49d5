"""The export of a picture for a browser, as values that JSON can hold.

The browser has what the display has: the words of the raster, the 1024 entries, and the range of each
surface. So it recolors as the display does, by entries alone. A smooth picture keeps all of its samples; the
browser averages them. The keys of an export:

- `format`, `name`, `background`; `lines`, `elements` and `smooth` of the picture, samples included;
- `words`: packed, see `packed_words`; `entries`: 1024 x 3 bytes by zlib, with zeros for the surfaces whose
  colors can be edited: the browser computes these from their paints;
- `surfaces`, in the order of their numbers: `name`, `first` and `levels` of the range; `shades`, the levels
  that light can give, fewer than `levels` on a surface with bands; `floor`, as `colors.entries_of` takes it;
  `fixed`, why the colors cannot be edited, or ""; `paint`, the fields of the paint;
- `views`: the `name` and the packed `words` of each view, in the order of a turn; none if there is one view.
  The words of the first are `words` of the picture. All views have the same entries;
- `swatches`: colors by name;
- `legend`: None, or `line`, `element`, `lines`, `elements` and packed `words` to draw over the words;
- `notes`: sentences about the picture;
- `variants`: the `name` of each, and the `values` that it changes, by key;
- `lights`: None, or what `_light_values` exports.

All bytes are base64. Words and planes are compressed twice: as differences between neighbors, which are
small, and then by zlib, which browsers can inflate.

With lights, the intensity at a visible point is

    ambient + sum over the lights that are on of  intensity x unit x q

where q is the light's number at the point in its `plane`, and unit its number for the surface in `units`.
The level is how many of the surface's thresholds in `levels` are at most the intensity. A word is then
first + band x shades + level, where the band is known from the exported word. With `dither`, each level has
64 steps: the level is floor((steps + k) / 64), where `steps` counts thresholds and k, 0 to 63, is the rank of
the pixel in the tile of `intensity.ordered_thresholds`.

Measured: the words of the coupe take 31.4 kB at 640 x 480 and 73.7 kB with smooth=2, those of twelve views
610 kB, the planes of its four lights 239 and 642 kB. Measured and rejected for the words: differences of 16
bits, 36.7 and 88.5 kB; the predictors of PNG (Paeth) and of JPEG-LS, 79 kB with smooth=2; the word above as a
second predictor, 72.3 kB for twice the code in the browser.
"""

from __future__ import annotations

import json
import zlib
from base64 import b64encode
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from autocolor.arrays import HALF, Singles, Words, underflowing
from autocolor.batches.table import Rows, Variant, variants_of
from autocolor.budget import require_memory
from autocolor.checks import brief, listed, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.settings import place_of, scene_with
from autocolor.images import display_image, middles
from autocolor.layers import check_rendered, light_shares
from autocolor.lighting.picture import IntensityRange, Picture, check_surfaces
from autocolor.mapping.bands import colored_surfaces
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import (
    WHOLE,
    fractions_by_surface,
    has_extent,
    levels_of,
    ranges_of,
)
from autocolor.mapping.legend import legend
from autocolor.rendering import render, rendering
from autocolor.scene.columns import fields_of
from autocolor.scene.curves import Fractions
from autocolor.scene.kinds import in_digits
from autocolor.scene.lights import Light
from autocolor.scene.scene import OBJECT, Scene
from autocolor.scene.surfaces import Paint
from autocolor.scene.swatches import car_paints
from autocolor.scene.view import NamedView
from autocolor.sending import shown_words
from autocolor.web.views import check_table, exposure_to_hold, held_scene

FORMAT: Final = "autocolor page 2"

LARGEST_CANVAS: Final = 16_777_216
"""Limit: pixels of a picture in a browser. Canvases of phones hold no more."""

MOST_PLANE_POINTS: Final = 1 << 26
"""Limit: visible points of all light planes together, for which a browser takes 134 MB: four lights on the
largest canvas."""

MOST_VIEW_PIXELS: Final = 1 << 26
"""Limit: pixels of all views together, for whose words a browser takes 134 MB."""

MOST_VARIANTS_SHOWN: Final = 1000
"""Limit: variants of a picture in a browser."""

BYTES_OF_PIXEL: Final = 32
BYTES_OF_LIT_PIXEL: Final = 124
BYTES_OF_LIGHT: Final = 20
"""Measured where all pixels see polygons, up to the page: for each pixel without lights and with lights, and
for each light at it. Of a light's bytes, 12 are for the texts of a plane that zlib cannot compress."""

LARGEST_STEP: Final = 60
"""Assumed: differences of words up to this size take one byte, as most do within a surface."""

FAR: Final = 128
"""The byte of a larger difference."""

LARGEST_SHARE: Final = 65535
"""The number of a plane where its light contributes most to a surface."""

TILE: Final = 64
"""The thresholds of a tile of ordered dither."""

HELD: Final = "Exposure is held as exported: with less light, the picture is darker."


def export_of(
    scene: Scene,
    picture: Picture,
    *,
    lights: bool = False,
    variants: Rows = (),
    views: Sequence[NamedView] = (),
    progress: Callable[[str], object] | None = None,
) -> dict[str, Any]:
    """A picture in the colors of a scene, as values that JSON can hold.

    With `lights`, the scene is rendered again, and must give the same picture. With two `views` or more, the
    picture is the first of them, and the others are rendered in its size. `progress` is called with the name
    of each rendered view.

    Raises InputError if the surfaces of the picture are not those of the scene, if the picture or its light
    planes are too large for a browser or exceed the memory budget, and for an invalid value of a variant;
    UsageError for a variant with a key that a browser cannot change, and for too many variants. With
    `lights`, also InputError if the picture is not the scene's or has no lights. With `lights` or views, also
    as `views.exposure_to_hold`, and with views as `views.check_table`.
    """
    check_surfaces(scene, picture)
    check_canvas(picture.elements, picture.lines, len(views))
    lit_pixel = BYTES_OF_LIT_PIXEL + BYTES_OF_LIGHT * len(scene.lights)
    require_memory(
        (lit_pixel if lights else BYTES_OF_PIXEL) * picture.lines * picture.elements,
        f"the export of {picture.elements:,} x {picture.lines:,} pixels",
        "render fewer pixels or lights",
    )
    image = display_image(scene, picture)
    if len(views) > 1:
        image = display_image(held_scene(image), picture)
    values, entries = values_of(image), image.entries.copy()
    values |= {
        "smooth": picture.smooth,
        "words": _text(packed_words(image.words)),
        "legend": legend_values(image, picture.smooth),
        "variants": _variant_values(image, values, variants, lights),
        "lights": _light_values(image) if lights else None,
    }
    known = _visible(picture)
    for turned in views[1:]:
        scene = image.scene.replace(view=turned.view)
        other = display_image(scene, render(scene, picture.size, smooth=picture.smooth))
        check_table(turned.name, other, image)
        values["views"].append({"name": turned.name, "words": _text(packed_words(other.words))})
        for surface in values["surfaces"]:
            # The first view that shows a surface tells how bright its lowest level is.
            if surface["name"] in _visible(other.picture) - known:
                surface["floor"] = other.floor_of(surface["name"])
                entries[_run(surface)] = other.entries_of(surface["name"])
        known |= _visible(other.picture)
        if progress is not None:
            progress(turned.name)
    if values["views"]:
        values["views"].insert(0, {"name": views[0].name, "words": ""})
    for surface in values["surfaces"]:
        # The browser computes these. Measured: the page of the coupe loses 3 kB.
        if not surface["fixed"]:
            entries[_run(surface)] = 0
    return {**values, "entries": _text(zlib.compress(entries.tobytes(), 9))}


def _run(surface: Mapping[str, Any]) -> slice:
    """The entries of an exported surface."""
    return slice(surface["first"], surface["first"] + surface["levels"])


def _visible(picture: Picture) -> set[str]:
    """The names of the surfaces that a picture shows."""
    return {picture.surfaces[each.surface_number - 1] for each in picture.slices}


def check_canvas(elements: int, lines: int, views: int = 1) -> None:
    """Raise InputError for a picture larger than a canvas of a phone, samples included, or too many views."""
    if lines * elements > LARGEST_CANVAS:
        raise InputError(
            f"a picture in a browser must have at most {LARGEST_CANVAS:,} pixels, which canvases of phones"
            f" hold, not {elements:,} x {lines:,}; render it smaller or with less `smooth`"
        )
    if views * lines * elements > MOST_VIEW_PIXELS:
        raise InputError(
            f"the views of a page must have at most {MOST_VIEW_PIXELS:,} pixels together, not {views} x"
            f" {elements:,} x {lines:,}; ask for fewer views, or render them smaller"
        )


def values_of(image: DisplayImage) -> dict[str, Any]:
    """Everything about an image but its words and entries, as values that JSON can hold.

    Nothing is smooth, and there are no legend, no variants and no lights.
    """
    scene, (lines, elements) = image.scene, image.words.shape
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
                "fixed": _reason_of_fixed(image, name),
                "paint": paint_values(scene.surfaces[name].paint),
            }
        )
    return {
        "format": FORMAT,
        "name": scene.name,
        "lines": lines,
        "elements": elements,
        "smooth": 1,
        "background": in_digits(scene.background),
        "surfaces": surfaces,
        "swatches": {name: in_digits(color) for name, color in car_paints().items()},
        "views": [],
        "legend": None,
        "notes": _notes(image),
        "variants": [],
        "lights": None,
    }


def _reason_of_fixed(image: DisplayImage, name: str) -> str:
    """Why the colors of a surface cannot be edited; empty if they can."""
    if not image.has_light_in_words:
        return "Words stand for normals here, so the colors cannot be edited."
    return "Its colors stand for a scalar and cannot be edited." if name in image.bands else ""


def _notes(image: DisplayImage) -> list[str]:
    """A sentence about the scalar, if any."""
    scalar = image.scene.scalar
    if scalar is None or not image.bands:
        return []
    return [f"The scalar “{scalar.name}” colors {listed(image.bands)}."]


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


def legend_values(image: DisplayImage, smooth: int) -> dict[str, Any] | None:
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


def light_rows(scene: Scene) -> list[dict[str, Any]]:
    """The name, switch and intensity of each light, and `most`, the upper end of a slider."""
    bar = fields_of(Light)["intensity"].bar
    assert bar is not None
    return [
        {
            "name": light.name,
            "on": light.on,
            "intensity": light.intensity,
            "most": max(bar.high, 2 * light.intensity),
        }
        for light in scene.lights
    ]


def _light_values(image: DisplayImage) -> dict[str, Any]:
    """The contributions of the lights to an image, and the levels of intensities, for its exposure.

    Intensities are relative to the scale of the picture. The values: `held`, a sentence about the exposure;
    `exposure`, the ranges that it holds, as a value of a table; `ambient`; `rows` as `light_rows`, each with
    its `units` and its `plane`; `levels`, the thresholds of each surface as float32, low byte first, by zlib;
    `dither`.
    """
    scene, picture = image.scene, image.picture
    if not scene.lights:
        raise InputError("a page with lights must have a light in its scene, not none; leave the lights out")
    exposure_to_hold(image, "lights")
    extents = ranges_of(scene, picture)
    if len(picture.pixels) * len(scene.lights) > MOST_PLANE_POINTS:
        raise InputError(
            f"a page with lights must have at most {MOST_PLANE_POINTS:,} visible points of all lights"
            f" together, not {len(picture.pixels):,} of {len(scene.lights):,} lights; render fewer pixels or"
            " lights, or leave the lights out"
        )
    again = rendering(scene, picture.lines, picture.elements)
    check_rendered(picture, again.picture, "the lights")
    bright = scene.replace(lights=tuple(light.replace(on=True, intensity=1.0) for light in scene.lights))
    bright_rendering = rendering(bright, picture.lines, picture.elements, again)
    names = [light.name for light in scene.lights]
    # Points are in the order of the polygons, but a browser finds them again in the raster.
    order = np.arange(len(picture.pixels))
    for surface in again.picture.slices:
        order[surface.pixels] = surface.start + again.points.pixels[surface.pixels].argsort()
    planes = {
        name: _plane_values(image, (diffuse + specular).take(order))
        for name, diffuse, specular in light_shares(bright_rendering, names)
    }
    return {
        "held": HELD,
        "exposure": _exposure_text(picture, extents),
        "ambient": scene.ambient / picture.scale,
        "rows": [{**row, **planes[row["name"]]} for row in light_rows(scene)],
        "levels": [
            _text(zlib.compress(thresholds.astype("<f4").tobytes(), 9))
            for thresholds in _thresholds(image, extents)
        ],
        "dither": scene.dither == "ordered",
    }


def _exposure_text(picture: Picture, extents: Mapping[int, IntensityRange]) -> str:
    """The ranges that are mapped, as a value of `exposure` in a table for `autocolor sweep`."""
    ranges = []
    for number, extent in extents.items():
        name = picture.surfaces[number - 1] if number else OBJECT
        # A surface with the name of the object's range has that range.
        if has_extent(extent) and (number == WHOLE or name != OBJECT):
            limits = extent.minimum * picture.scale, extent.maximum * picture.scale
            ranges.append(f"{json.dumps(name, ensure_ascii=False)} = {[*limits]}")
    return f"{{ {', '.join(ranges)} }}"


@underflowing
def _plane_values(image: DisplayImage, contribution: Singles) -> dict[str, Any]:
    """The `units` and the `plane` of a light by its contributions to the visible points, in raster order."""
    picture = image.picture
    units = dict.fromkeys(image.ranges, 0.0)
    shares = np.zeros(len(contribution), np.uint16)
    for surface in picture.slices:
        exact = contribution[surface.pixels].astype(np.float64)
        unit = float(exact.max()) / LARGEST_SHARE
        if unit > 0:
            shares[surface.pixels] = np.floor(exact / unit + HALF)
            units[picture.surfaces[surface.surface_number - 1]] = unit / picture.scale
    return {"units": list(units.values()), "plane": _text(packed_plane(shares))}


def packed_plane(shares: Words) -> bytes:
    """The numbers of a plane, (n,) uint16, in few bytes: differences to the number before, modulo 65536.

    The low bytes of all differences come before the high bytes; zlib.
    """
    steps = np.diff(shares, prepend=np.uint16(0))
    return zlib.compress(
        (steps & 255).astype(np.uint8).tobytes() + (steps >> 8).astype(np.uint8).tobytes(), 9
    )


@underflowing
def _thresholds(image: DisplayImage, extents: Mapping[int, IntensityRange]) -> list[Singles]:
    """The thresholds of each surface with a range, in order; none for a surface that is not visible.

    `extents` are the ranges of intensities that are mapped to levels, by surface number.
    """
    scene, picture = image.scene, image.picture
    fractions = fractions_by_surface(picture, extents, scene.mapping)
    thresholds = dict.fromkeys(image.ranges, np.empty(0, np.float32))
    for number, of_surface in fractions.items():
        name = picture.surfaces[number - 1]
        levels = image.bands[name].shades if name in image.bands else image.ranges[name].levels
        steps = TILE if scene.dither == "ordered" else 1
        thresholds[name] = least_intensities(of_surface, extents[number], levels, steps)
    return list(thresholds.values())


LARGEST_BITS: Final = 0x7F800000
"""The bits of infinity as float32. Bits as whole numbers have the order of the intensities."""


def least_intensities(fractions: Fractions, extent: IntensityRange, levels: int, steps: int = 1) -> Singles:
    """The least intensity of each level from 1 on, or of each of `steps` steps a level, float32.

    It is infinite for a level that no intensity reaches. `fractions` maps the intensities of `extent`. With
    one step, levels are those of `intensity.levels_of`. Bisection finds them for every nondecreasing curve.
    """
    numbers = np.arange(1, steps * (levels - 1) + 1)
    low, high = np.zeros(len(numbers), np.uint32), np.full(len(numbers), LARGEST_BITS, np.uint32)
    minimum, maximum = np.float32(extent.minimum), np.float32(extent.maximum)
    while (low < high).any():
        middle = (low + high) >> 1
        mapped = fractions(np.clip(middle.view(np.float32), minimum, maximum))
        if steps == 1 or not has_extent(extent):
            reached = levels_of(mapped, levels) * steps
        else:
            reached = np.floor(mapped.astype(np.float64) * (steps * (levels - 1)) + HALF)
        is_reached = reached >= numbers
        high = np.where(is_reached, middle, high)
        low = np.where(is_reached, low, np.minimum(middle + 1, high))
    return high.view(np.float32)


def _variant_values(
    image: DisplayImage, values: Mapping[str, Any], variants: Rows, lights: bool
) -> list[dict[str, Any]]:
    """What each variant changes of the paints and lights in the export `values` of an image.

    Raises UsageError for a key that a browser cannot change, InputError for an invalid value.
    """
    rows = variants_of(variants)
    if len(rows) > MOST_VARIANTS_SHOWN:
        raise UsageError(
            f"a page must have at most {MOST_VARIANTS_SHOWN:,} variants, not {len(rows):,}; leave some out"
        )
    check_variants(image.scene, rows, lights)
    editable = [surface["name"] for surface in values["surfaces"] if not surface["fixed"]]
    before = _state(image.scene, editable)
    exported = []
    for variant in rows:
        try:
            state = _state(scene_with(image.scene, variant.settings), editable)
        except InputError as error:
            raise InputError(
                f"variant {shown(variant.name)}: {problem}" for problem in error.problems
            ) from None
        changes = {key: value for key, value in state.items() if value != before[key]}
        exported.append({"name": variant.name, "values": changes})
    return exported


def _state(scene: Scene, editable: Sequence[str]) -> dict[str, Any]:
    """The values that a browser can change, by key: of the paints of some surfaces, and of all lights."""
    paints = {name: paint_values(scene.surfaces[name].paint) for name in editable}
    state = {
        f"surfaces.{name}.{key}": value for name, paint in paints.items() for key, value in paint.items()
    }
    for row in light_rows(scene):
        state |= {f"lights.{row['name']}.{key}": row[key] for key in ("on", "intensity")}
    return state


def check_variants(scene: Scene, variants: Sequence[Variant], lights: bool) -> None:
    """Raise UsageError for a variant with a key that a browser cannot change."""
    colored = colored_surfaces(scene)
    for variant in variants:
        for key in variant.settings:
            table, name, path = place_of(scene, key)
            is_paint = table == "surfaces" and path[0] in fields_of(Paint)
            is_strength = table == "lights" and path in (("on",), ("intensity",))
            if is_paint and name in colored:
                problem = "its colors must stand for a paint, not for a scalar; leave this key out"
            elif is_strength and not lights:
                problem = "the page must have lights for it; add --lights (lights=True in Python)"
            elif key == "exposure" and lights:
                # A table that was saved from a page has it. The page holds its own exposure.
                continue
            elif not is_paint and not is_strength:
                problem = (
                    "a variant of a page must change paints, such as surfaces.body.object_color, or `on` and"
                    " `intensity` of lights; leave this key out"
                )
            else:
                continue
            raise UsageError(f"variant {shown(variant.name)}: {brief(key)}: {problem}")
