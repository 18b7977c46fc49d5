"""The files of a batch: their names from a pattern, their forms, and their marks.

A mark is a checksum of the scene and the settings, at the end of a file. A file with the mark of a variant is
whole and need not be made again.
"""

from __future__ import annotations

import json
import os
import re
import struct
import zlib
from collections.abc import Callable, Mapping
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes
from autocolor.batches.table import Variant, stem_of
from autocolor.checks import either, nearest, shown
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


class Pattern:
    """A name for each variant's file, such as "out/{number:03}-{name}.png".

    The fields are `{number}`, which counts from 1 and can have a number of digits, `{name}`, and keys, such
    as `{lights.key.intensity}`. A key stands for the variant's value, or else for the scene's. Characters
    that a file name cannot have become "_". Doubled braces stand for braces.
    """

    def __init__(self, text: str | os.PathLike[str], scene: Scene) -> None:
        """Check the pattern. Raises UsageError for an unknown field or a brace without its counterpart."""
        self.text = os.fspath(text)
        self._own: dict[str, str] = {}
        for match in FIELD.finditer(self.text):
            key, digits, _, brace = match.groups()
            if brace is not None:
                raise UsageError(
                    f"a name pattern must have each brace closed, not {shown(self.text)}; double a brace that"
                    " belongs to the name"
                )
            if digits is not None and key != NUMBER:
                raise UsageError(
                    f"only {{number}} of a name pattern can have a number of digits, not {match[0]}; leave"
                    " the digits out"
                )
            if key not in (None, NUMBER, NAME):
                self._own[key] = _own_text(scene, key)

    def path(self, number: int, variant: Variant) -> str:
        """The path of a variant; its number counts from 1."""

        def part(match: re.Match[str]) -> str:
            key, digits, doubled, _ = match.groups()
            if doubled:
                return doubled[0]
            if key == NUMBER:
                return f"{number:0{int(digits or 1)}}"
            if key == NAME:
                return _safe(variant.name)
            settings = variant.settings
            return _safe(stem_of(settings[key])) if key in settings else self._own[key]

        return FIELD.sub(part, self.text)


def _own_text(scene: Scene, key: str) -> str:
    """The scene's own value of a key, as a part of a file name. Raises UsageError for an unknown key."""
    try:
        place = place_of(scene, key)
    except UsageError:
        close = nearest(key, (NUMBER, NAME))
        raise UsageError(
            f"a field of a name pattern must be a key of the scene, not {shown(key)}{close}"
        ) from None
    field = field_of(place)
    value = value_at(scene, place)
    plain = {} if field is None or value is None else field.kind.to_plain(place.path[-1], value)
    return _safe(stem_of(plain.get(place.path[-1])))


LONGEST_PART: Final = 200
"""Limit: bytes of a part of a file name, in UTF-8. Most systems allow 255 for the whole name."""


def _safe(text: str) -> str:
    """The text as a part of a file name, cut to LONGEST_PART."""
    stem = file_stem(text.replace("/", "_"))
    data = stem.encode("utf-8", "surrogatepass")
    return stem if len(data) <= LONGEST_PART else data[:LONGEST_PART].decode("utf-8", "ignore")


# Forms.

SHEET_MARK: Final = 64 * "0"
"""The mark of a contact sheet, which is made again each time."""

TEXT_OF_PNG: Final = b"autocolor\0"
END_OF_PNG: Final = b"\0\0\0\0IEND\xaeB`\x82"
PNG_TAIL: Final = re.compile(
    rb"tEXt" + TEXT_OF_PNG + rb"([0-9a-f]{64}).{4}" + re.escape(END_OF_PNG) + rb"\Z", re.DOTALL
)


def marked_png(colors: Bytes, level: int | None, mark: str) -> bytes:
    """A PNG file with a mark in its last text chunk."""
    from ramtek_emu.png import png_bytes

    data = png_bytes(colors, level)
    chunk = b"tEXt" + TEXT_OF_PNG + mark.encode()
    chunk = struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
    return data[: -len(END_OF_PNG)] + chunk + END_OF_PNG


XMP: Final = (
    '<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">'
    '<rdf:Description rdf:about="" xmlns:autocolor="urn:autocolor" autocolor:madeFrom="{}"/></rdf:RDF>'
    "</x:xmpmeta>"
)
WEBP_TAIL: Final = re.compile(rb'autocolor:madeFrom="([0-9a-f]{64})"/></rdf:RDF></x:xmpmeta>\0?\Z')


def _webp(colors: Bytes, level: int | None, mark: str) -> bytes:
    """A lossless WebP file with a mark in its XMP, which is the last chunk.

    Measured: the coupe in 6.5 ms and 54 kB; a method of 2 takes 67 ms for 43 kB. PNG takes 9.5 ms and 76 kB.
    """
    from PIL import Image

    buffer = BytesIO()
    picture = Image.fromarray(np.ascontiguousarray(colors))
    picture.save(buffer, "WEBP", lossless=True, quality=0, method=0, xmp=XMP.format(mark).encode())
    return buffer.getvalue()


class Form(NamedTuple):
    """A form of pictures: the suffix of its files, its encoder, and the end of a file with a mark."""

    suffix: str
    encoded: Callable[[Bytes, int | None, str], bytes]
    tail: re.Pattern[bytes]


FORMS: Final[Mapping[str, Form]] = {
    "png": Form(".png", marked_png, PNG_TAIL),
    "webp": Form(".webp", _webp, WEBP_TAIL),
}

ARRAY: Final = "array"
"""The form of pictures that are arrays."""


def form_of(output: str | os.PathLike[str] | None, form: str | None) -> str:
    """The form of the pictures. The suffix of the output gives it; without an output, `form` or else ARRAY.

    Raises UsageError for an unknown form, and for a form beside an output.
    """
    if output is None:
        if form is not None and form not in (ARRAY, *FORMS):
            raise UsageError(f"the form of pictures must be {either([ARRAY, *FORMS])}, not {shown(form)}")
        return form or ARRAY
    suffix = Path(output).suffix.lower()
    forms = {each.suffix: name for name, each in FORMS.items()}
    if suffix not in forms:
        raise UsageError(
            f"the pictures of a batch must be written to files that end in {' or '.join(forms)}, not to"
            f" {shown(str(output))}; rename them"
        )
    if form not in (None, forms[suffix]):
        raise UsageError(f"the suffix of {output} must belong to the form {shown(form)}; leave the form out")
    return forms[suffix]


# Marks.

EDITION: Final = 1
"""Raise this number when the same scene gives another picture, so that batches make their pictures again."""

LONGEST_TAIL: Final = 512
"""The bytes at the end of a file that are searched for its mark."""


def mark_in(path: str, form: str) -> str:
    """The mark of a file; empty if it has none, or if it is damaged or unreadable."""
    try:
        with open(path, "rb") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(max(0, size - LONGEST_TAIL))
            found = FORMS[form].tail.search(file.read(LONGEST_TAIL))
    except (OSError, ValueError):
        return ""
    return "" if found is None else found[1].decode()


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
