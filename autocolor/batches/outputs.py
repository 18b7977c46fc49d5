"""The files of a batch: their names from a pattern, their forms, and their marks.

A mark is a checksum of the scene and the settings. It is at the end of a file, with a checksum of the bytes
before it. A file with the mark of a variant, whose bytes are those that were written, need not be made again.
"""

from __future__ import annotations

import json
import os
import re
import struct
import zlib
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
from autocolor.checks import brief, either, nearest, shown
from autocolor.errors import UsageError
from autocolor.files.paths import file_stem
from autocolor.files.picture_file import plain_scene
from autocolor.files.settings import field_of, place_of, value_at
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
    own: dict[str, str] = {}
    for match in FIELD.finditer(text):
        key, digits, _, brace = match.groups()
        if brace is not None:
            raise UsageError(
                f"a name pattern must have each brace closed, not {shown(text)}; double a brace that belongs"
                " to the name"
            )
        if key not in (None, NUMBER, NAME) or (digits and key != NUMBER):
            # Only a number can have digits.
            own[key] = _own_text(scene, match[0][1:-1])
    paths: list[str] = []
    first: dict[str, str] = {}
    for number, variant in enumerate(variants, 1):
        path = FIELD.sub(partial(_part, number=number, variant=variant, own=own), text)
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


def _part(match: re.Match[str], number: int, variant: Variant, own: Mapping[str, str]) -> str:
    """The text of a field of a pattern for a variant; `own` has the scene's own texts of keys."""
    key, digits, doubled, _ = match.groups()
    if doubled:
        return str(doubled[0])
    if key == NUMBER:
        return f"{number:0{int(digits or 1)}}"
    if key == NAME:
        return _safe(variant.name)
    return _safe(stem_of(variant.settings[key])) if key in variant.settings else own[key]


def same_file(path: str | os.PathLike[str]) -> str:
    """A text that is equal for names of one file, also where capitals do not matter."""
    return os.path.normcase(os.path.abspath(path)).casefold()


def _own_text(scene: Scene, key: str) -> str:
    """The scene's own value of a key, as a part of a file name. Raises UsageError for an unknown key."""
    with suppress(UsageError):
        place = place_of(scene, key)
        if (field := field_of(place)) is not None:
            value, name = value_at(scene, place), place.path[-1]
            plain = {} if value is None else field.kind.to_plain(name, value)
            return _safe(stem_of(plain.get(name)))
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
    chunk = b"tEXtautocolor\0" + digits.encode()
    return struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk)) + END_OF_PNG


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


class Form(NamedTuple):
    """A form of pictures: the suffix of its files, what encodes them up to their end, and their end."""

    suffix: str
    encoded: Callable[[Bytes, int | None], bytes]
    end: Callable[[str], bytes]


FORMS: Final[Mapping[str, Form]] = {
    "png": Form(".png", _png, _end_of_png),
    "webp": Form(".webp", _webp, _end_of_webp),
}

ARRAY: Final = "array"
"""The form of pictures that are arrays."""


def form_of(output: str | os.PathLike[str] | None, form: str | None) -> str:
    """The form of the pictures. The suffix of the output gives it; without an output, `form` or else ARRAY.

    Raises UsageError for an unknown form, and for a form beside an output.
    """
    forms = {each.suffix: name for name, each in FORMS.items()}
    own = (form or ARRAY) if output is None else forms.get(Path(output).suffix.lower(), "")
    if output is not None and not own:
        raise UsageError(
            f"the pictures of a batch must be written to files that end in {' or '.join(forms)}, not to"
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
    start = FORMS[form].encoded(colors, level)
    return start + FORMS[form].end(f"{mark}{zlib.crc32(start):08x}")


def mark_in(path: str, form: str) -> str:
    """The mark of a file, DAMAGED if its bytes before the mark are damaged; "" without a whole mark.

    An empty file, which a power failure leaves after a write without `sync`, is damaged.
    """
    end = FORMS[form].end
    try:
        with open(path, "rb") as file:
            start = max(0, file.seek(0, os.SEEK_END) - len(end(DIGITS * "0")))
            file.seek(start)
            tail = file.read()
            if not tail:
                return DAMAGED
            found = MARK.search(tail)
            if found is None or end(found[0].decode()) != tail:
                return ""
            file.seek(0)
            check = zlib.crc32(file.read(start))
    except (OSError, ValueError):
        return ""
    digits = found[0].decode()
    return digits[:64] if f"{check:08x}" == digits[64:] else DAMAGED


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
