"""Which properties of a PLY file are what: coordinates, corners, parts, scalars, and what is not used."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

from autocolor.files.repair.names import name_of

AXES: Final = ("x", "y", "z")
VERTEX: Final = "vertex"
FACE: Final = "face"
STRIPS: Final = "tristrips"
CORNERS: Final = ("vertex_indices", "vertex_index")

PART: Final = "part"
PARTS: Final = (PART, "material_index", "group")
"""Properties of faces that divide them into parts; the first of them that a file has does."""

MOST_UNNAMED_PARTS: Final = 10_000
"""Assumed: a number that has more values is no part, but a scalar."""

NOT_SCALARS: Final = frozenset(
    (
        *("nx", "ny", "nz", "normal_x", "normal_y", "normal_z"),
        *("s", "t", "u", "v", "s0", "t0", "u0", "v0", "texture_s", "texture_t", "texture_u", "texture_v"),
        *("texcoord", "texnumber", "flags"),
        *("r", "g", "b", "a", "red", "green", "blue", "alpha"),
        *(
            f"{kind}_{part}"
            for kind in ("ambient", "diffuse", "specular")
            for part in ("red", "green", "blue", "alpha", "coeff", "power")
        ),
    )
)
"""Normals, colors and texture coordinates, ignored as those of OBJ files are, and flags of other programs."""

NAMED_PART: Final = re.compile(r"part (\d{1,9}) (.+)")
NAMED_SCALAR: Final = re.compile(r"scalar (\S+) (.+)")
PLAIN_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_.\-]{0,63}")


class Comments(NamedTuple):
    """What comments name: parts by number, and scalars by their properties."""

    parts: Mapping[int, str]
    scalars: Mapping[str, str]


def named_in(comments: Sequence[str]) -> Comments:
    """The names in comments such as `part 0 hood` and `scalar value_0 von Mises`; others say nothing."""
    parts: dict[int, str] = {}
    scalars: dict[str, str] = {}
    for comment in comments:
        if match := NAMED_PART.fullmatch(comment):
            parts.setdefault(int(match[1]), name_of(match[2].encode()))
        elif match := NAMED_SCALAR.fullmatch(comment):
            scalars.setdefault(match[1], name_of(match[2].encode()))
    return Comments(parts, scalars)


def is_scalar(name: str, comments: Comments) -> bool:
    """Whether a property of a vertex or a face, which is a number, is a scalar of the mesh."""
    return name in comments.scalars or (name not in NOT_SCALARS and name not in AXES)


def property_of(scalar: str, number: int) -> str:
    """The property that a scalar is written as; where that is not its name, a comment must give it."""
    is_free = scalar not in NOT_SCALARS and scalar not in (*AXES, *PARTS, *CORNERS)
    is_free = is_free and not scalar.startswith("value_")
    return scalar if is_free and PLAIN_NAME.fullmatch(scalar) else f"value_{number}"
