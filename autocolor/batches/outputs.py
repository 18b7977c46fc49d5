"""The files of a batch: their names from a pattern, their forms and marks, and the contact sheet.

A mark is a checksum of the scene and the settings. It is at the end of a file, with a checksum of the bytes
before it. A file with the mark of a variant, whose bytes are those that were written, need not be made again.
A file with any other byte is made again. A file without a mark, such as the first half of a picture, could
be a file of another program, and is not replaced.
"""

from __future__ import annotations

import json
import math
import os
import re
import zlib
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes
from autocolor.batches.table import Variant, stem_of
from autocolor.checks import brief, either, is_whole, nearest, printable, shown
from autocolor.errors import UsageError
from autocolor.files.paths import file_stem
from autocolor.files.picture_file import plain_scene
from autocolor.files.settings import field_of, place_of, value_at
from autocolor.images import averaged
from autocolor.lighting.picture import Picture
from autocolor.scene.columns import Tier, fields_of
from autocolor.scene.scene import Scene

# Names.

NUMBER: Final = "number"
NAME: Final = "name"

FIELD: Final = re.compile(r"\{([^{}:]*)(?::0?([0-9]{1,2}))?\}|(\{\{|\}\})|([{}])")
"""A field of a pattern with its number of digits, a doubled brace, or an unmatched brace."""


LONGEST_PATH: Final = 1024
"""Limit: characters of the path of a picture, as on macOS."""


def paths_of(pattern: str | os.PathLike[str], scene: Scene, variants: Sequence[Variant]) -> tuple[str, ...]:
    """The path of each variant's picture by a name pattern, such as "out/{number:03}-{name}.png".

    The fields are `{number}`, which counts from 1 and can have a number of digits, `{name}`, and keys, such
    as `{lights.key.intensity}`. A key stands for the variant's value, or else for the scene's. Characters
    that a file name cannot have become "_". Doubled braces stand for braces.

    Raises UsageError for an unknown field, for a brace without its counterpart, if two variants have the same
    file, and if a path is too long.
    """
    text = os.fspath(pattern)
    own: dict[str, object] = {}
    for match in FIELD.finditer(text):
        key, digits, _, brace = match.groups()
        if brace is not None:
            raise UsageError(
                f"a name pattern must have each brace closed, not {shown(text)}; double a brace that belongs"
                " to the name"
            )
        if key not in (None, NUMBER, NAME) or (digits and key != NUMBER):
            # Only a number can have digits.
            own[key] = _own_value(scene, match[0][1:-1])
    paths: list[str] = []
    first: dict[str, str] = {}
    for number, variant in enumerate(variants, 1):
        path = FIELD.sub(partial(_part, variant, number, own), text)
        if len(path) > LONGEST_PATH:
            raise UsageError(
                f"the path of a picture must have at most {LONGEST_PATH:,} characters, not {len(path):,} as"
                f" for {shown(variant.name)}; shorten the name pattern"
            )
        paths.append(path)
        other = first.setdefault(same_file(path), variant.name)
        if len(first) < number:
            raise UsageError(
                f"a name pattern must give each variant a file of its own, and {brief(path)} is the file of"
                f" both {shown(other)} and {shown(variant.name)}; add {{name}} or {{number}}"
            )
    return tuple(paths)


def _part(variant: Variant, number: int, own: Mapping[str, object], field: re.Match[str]) -> str:
    """The text of a field of a pattern for a variant; `own` has the scene's own values of keys."""
    key, digits, doubled, _ = field.groups()
    if doubled:
        return str(doubled[0])
    if key == NUMBER:
        return f"{number:0{int(digits or 1)}}"
    return _safe(variant.name if key == NAME else stem_of(variant.settings.get(key, own[key])))


def same_file(path: str | os.PathLike[str]) -> str:
    """A text that is equal for names of one file, also where capitals do not matter."""
    return os.path.normcase(os.path.abspath(path)).casefold()


def _own_value(scene: Scene, key: str) -> object:
    """The scene's own value of a key, plain. Raises UsageError for an unknown key."""
    with suppress(UsageError):
        place = place_of(scene, key)
        if (field := field_of(place)) is not None:
            value, name = value_at(scene, place), place.path[-1]
            return None if value is None else field.kind.to_plain(name, value).get(name)
    close = nearest(key, (NUMBER, NAME))
    raise UsageError(f"a field of a name pattern must be a key of the scene, not {shown(key)}{close}")


LONGEST_PART: Final = 200
"""Limit: bytes of a part of a file name, in UTF-8. Most systems allow 255 for the whole name."""


def _safe(text: str) -> str:
    """The text as a part of a file name, cut to LONGEST_PART; a surrogate without its pair becomes "_"."""
    stem = file_stem(text.replace("/", "_").encode("utf-8", "replace").decode())
    return stem.encode()[:LONGEST_PART].decode("utf-8", "ignore")


# Forms.

DIGITS: Final = 72
"""Hexadecimal digits at the end of a file: 64 of its mark, and 8 of the CRC-32 of the bytes before."""

END_OF_PNG: Final = b"\0\0\0\0IEND\xaeB`\x82"


def _png(colors: Bytes, level: int | None) -> bytes:
    """A PNG file without its end."""
    from ramtek_emu.png import png_bytes

    return png_bytes(colors, level)[: -len(END_OF_PNG)]


def _end_of_png(digits: str) -> bytes:
    """The end of a PNG file: a text chunk, and the chunk IEND."""
    from ramtek_emu.png import chunk

    return chunk(b"tEXt", b"autocolor\0" + digits.encode()) + END_OF_PNG


def _webp(colors: Bytes, level: int | None) -> bytes:
    """A lossless WebP file without its XMP, which is the last chunk.

    Measured: the coupe in 6.5 ms and 54 kB; a method of 2 takes 67 ms for 43 kB. PNG takes 9.5 ms and 76 kB.
    """
    from PIL import Image

    buffer, end = BytesIO(), _end_of_webp(DIGITS * "0")
    picture = Image.fromarray(np.ascontiguousarray(colors))
    picture.save(buffer, "WEBP", lossless=True, quality=0, method=0, xmp=end)
    return buffer.getvalue()[: -len(end)]


def _end_of_webp(digits: str) -> bytes:
    """The XMP of a WebP file, of an even length, since an odd chunk has a byte more."""
    xmp = (
        '<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">'
        '<rdf:Description rdf:about="" xmlns:autocolor="urn:autocolor"'
        f' autocolor:madeFrom="{digits}"/></rdf:RDF></x:xmpmeta>'
    )
    return xmp.encode() + b"\n" * (len(xmp) % 2)


Encoder = Callable[[Bytes, int | None], bytes]

FORMS: Final[Mapping[str, tuple[Encoder, Callable[[str], bytes]]]] = {
    "png": (_png, _end_of_png),
    "webp": (_webp, _end_of_webp),
}
"""What encodes colors up to the end of a file, and the end with its digits, by the suffix of files."""

ARRAY: Final = "array"
"""The form of pictures that are arrays."""


def form_of(output: str | os.PathLike[str] | None, form: str | None) -> str:
    """The form of the pictures. The suffix of the output gives it; without an output, `form` or else ARRAY.

    Raises UsageError for an unknown form, and for a form beside an output.
    """
    own = (form or ARRAY) if output is None else Path(output).suffix.lower()[1:]
    if output is not None and own not in FORMS:
        raise UsageError(
            f"the pictures of a batch must be written to files that end in .{' or .'.join(FORMS)}, not to"
            f" {shown(str(output))}; rename them"
        )
    if own not in (ARRAY, *FORMS) or form not in (None, own):
        rule = either([ARRAY, *FORMS]) if output is None else f"that of the output, {own!r}"
        raise UsageError(f"the form of pictures must be {rule}, not {shown(form)}; leave it out")
    return own


# Marks.

EDITION: Final = 1
"""Raise this number when the same scene gives another picture, so that batches make their pictures again."""

MARK: Final = re.compile(rb"[0-9a-f]{%d}" % DIGITS)

SHEET_MARK: Final = 64 * "0"
"""The mark of a contact sheet, which is made again each time."""

DAMAGED: Final = "damaged"
"""The mark of a file with other bytes than were written."""


def marked(form: str, colors: Bytes, level: int | None, mark: str) -> bytes:
    """A file of a form, with a mark and a checksum of its other bytes. `level` is as in `save_image`."""
    encoded, end = FORMS[form]
    start = encoded(colors, level)
    return start + end(f"{mark}{zlib.crc32(start):08x}")


def mark_in(path: str, form: str) -> str:
    """The mark of a file of a form, DAMAGED if its bytes are not those that were written; "" for other files.

    An empty file, which a power failure leaves after a write without `sync`, is damaged.
    """
    end = FORMS[form][1]
    try:
        data = Path(path).read_bytes()
    except (OSError, ValueError):
        return ""
    start, tail = data[: -len(end(DIGITS * "0"))], data[-len(end(DIGITS * "0")) :]
    found = MARK.search(tail)
    digits = found[0].decode() if found else ""
    if tail == end(digits) and f"{zlib.crc32(start):08x}" == digits[64:]:
        return digits[:64]
    # A damaged byte leaves either the digits or the name.
    return DAMAGED if not data or digits or b"autocolor" in tail else ""


def base_mark(scene: Scene, picture: Picture | None, drawn: tuple[object, ...]) -> str:
    """The checksum of the scene with its mesh, of its picture, and of the numbers of the drawing.

    Columns of the scene that no picture depends on, such as its name, are left out. Measured: 1 ms for the
    coupe, 3 ms with its picture, 45 ms for a million polygons.
    """
    plain = plain_scene(scene)
    for name, field in fields_of(Scene).items():
        if field.tier is Tier.NOTHING:
            plain.pop(name, None)
    mesh = scene.mesh
    arrays: list[Any] = [mesh.coordinates, mesh.node_numbers, mesh.part_numbers]
    if mesh.own_normals is not None:
        arrays += [mesh.own_normals.vectors, mesh.own_normals.numbers]
    for scalar in mesh.scalars:
        plain.setdefault("scalars", []).append(scalar.name)
        arrays.append(scalar.values)
    if picture is not None:
        plain["picture"] = [picture.lines, picture.elements, picture.scale]
        arrays += [picture.relative, picture.pixels, picture.surface_number]
        arrays += [] if picture.scalar_values is None else [picture.scalar_values]
    check = sha256(_text([EDITION, plain, drawn]))
    for array in arrays:
        check.update(f"{array.shape} {array.dtype}".encode())
        check.update(np.ascontiguousarray(array).data)
    return check.hexdigest()


def mark_of(base: str, variant: Variant) -> str:
    """The checksum of a variant's settings and of the scene that they change."""
    return sha256(base.encode() + _text(dict(variant.settings))).hexdigest()


def _text(value: object) -> bytes:
    """The value as text, in which the order of keys does not matter."""
    return json.dumps(value, sort_keys=True, default=repr).encode("utf-8", "surrogatepass")


# The contact sheet: a labeled thumbnail of each variant, in rows and columns.

GROUND: Final = 32
"""The gray of the background."""

NO_PICTURE: Final = 64
"""The gray of a cell without a picture."""

INK: Final = 224
"""The gray of the labels."""

GAP: Final = 8
"""Pixels between cells, and around them."""

LABEL_LINES: Final = 16

MOST_COLUMNS: Final = 100
"""Limit: columns of a sheet that are asked for."""


class Box(NamedTuple):
    """The most elements and lines of a thumbnail."""

    elements: int
    lines: int


BOXES: Final = ((400, Box(160, 120)), (2500, Box(80, 60)), (10_000, Box(48, 36)))
"""Limit: the most variants of a sheet, for each size of its thumbnails. A sheet has at most 19 MB."""


def box_of(variants: Sequence[Variant], columns: int | None = None) -> Box:
    """The box of each thumbnail of a sheet. Raises UsageError for too many variants or wrong columns."""
    most = BOXES[-1][0]
    if len(variants) > most:
        raise UsageError(
            f"a contact sheet must have at most {most:,} variants, not {len(variants):,}; make sheets of"
            " parts of the table"
        )
    if columns is not None and not is_whole(columns, 1, MOST_COLUMNS):
        raise UsageError(
            f"the columns of a sheet must be a whole number from 1 to {MOST_COLUMNS}, not {shown(columns)};"
            " choose another"
        )
    return next(box for count, box in BOXES if len(variants) <= count)


def sheet_png(
    variants: Sequence[Variant], thumbnails: Mapping[int, Bytes | None], columns: int | None = None
) -> bytes:
    """A contact sheet as a PNG file, with thumbnails by the numbers of their variants, from 0; see `box_of`.

    A thumbnail is in the middle of its cell. By default `columns_of` gives the columns.
    """
    from PIL import Image, ImageDraw, ImageFont

    box = box_of(variants, columns)
    across = min(columns, len(variants)) if columns else columns_of(variants)
    width, height = box.elements + GAP, box.lines + LABEL_LINES + GAP
    size = across * width + GAP, -(-len(variants) // across) * height + GAP
    image = Image.new("RGB", size, (GROUND, GROUND, GROUND))
    draw, font = ImageDraw.Draw(image), ImageFont.load_default()
    for number, variant in enumerate(variants):
        left, top = GAP + number % across * width, GAP + number // across * height
        small = thumbnails.get(number)
        if small is None:
            small = np.full((box.lines, box.elements, 3), NO_PICTURE, np.uint8)
        lines, elements, _ = small.shape
        middle = left + (box.elements - elements) // 2, top + (box.lines - lines) // 2
        image.paste(Image.fromarray(np.ascontiguousarray(small)), middle)
        label = printable(variant.name)
        while len(label) > 1 and font.getlength(label) > box.elements:
            label = f"{label.rstrip('.')[:-1]}.."
        draw.text((left, top + box.lines + 2), label, fill=(INK, INK, INK), font=font)
    return marked("png", np.asarray(image), None, SHEET_MARK)


def columns_of(variants: Sequence[Variant]) -> int:
    """The columns that make a sheet nearly square, and of a grid a multiple of the values of its last key."""
    values = {(key, repr(value)): key for variant in variants for key, value in variant.settings.items()}
    axes = [count for count in Counter(values.values()).values() if count > 1]
    square = max(1, math.ceil(math.sqrt(len(variants))))
    if len(axes) < 2 or math.prod(axes) != len(variants) or axes[-1] > 2 * square:
        return square
    return axes[-1] * max(1, round(square / axes[-1]))


ALL_LEVELS: Final = np.arange(256, dtype=np.uint8)
"""The table that shows each component as itself."""


def thumbnail(colors: Bytes, box: Box) -> Bytes:
    """The colors, averaged as light over the smallest squares for which they fit in a box, uint8.

    Lines and elements at the lower right that fill no square are left out. A very narrow picture is cut at
    the box. Measured: 4.5 ms for 640 x 480.
    """
    side = max(1, -(-colors.shape[0] // box.lines), -(-colors.shape[1] // box.elements))
    side = min(side, *colors.shape[:2])
    lines, elements = (count // side * side for count in colors.shape[:2])
    small = averaged(ALL_LEVELS, colors[:lines, :elements], side)
    return small[: box.lines, : box.elements]


def read_thumbnail(path: str, box: Box) -> Bytes | None:
    """The thumbnail of a whole picture of a batch; None if it is too large for Pillow."""
    from PIL import Image

    with suppress(Image.DecompressionBombError), Image.open(path) as image:
        return thumbnail(np.asarray(image.convert("RGB")), box)
    return None
