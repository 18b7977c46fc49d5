"""Samples of the files of all formats, and the one way in which tests damage bytes.

A seed is a file that is read, or a folder of files. Its mutations are the same for the same number.
"""

from __future__ import annotations

import random
import struct
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from autocolor import Scene
from autocolor.files.formats import Format
from autocolor.files.opening import OUTPUTS
from autocolor.scene.scalar import MeshScalar
from tests.small import boxes

NUMBERS = (
    b"4294967296", b"4294967295", b"2147483648", b"2147483647", b"-1", b"0", b"nan", b"inf", b"1e999",
    b"-1e39",
    b"99999999999999999999", b"1.5", b"0x10", b"1_0", b"", b"\xd9\xa3", b"1,5", b"1e", b"\0", b"9" * 400,
    b"5e-324", b"1e-40", b"1e300", b"NaN", b"Infinity", b"null", b"true", b"[" * 300, b"\xe2\x80\xae",
    b"\x1b[2J",
)  # fmt: skip
"""Words that readers of numbers and names in text must take or refuse."""

BITS = tuple(
    struct.pack(layout, number)
    for layout, number in (
        ("<I", 2**32 - 1), (">I", 2**31), ("<I", 2**31 - 1), ("<q", -1), ("<q", 2**62), (">q", 2**40),
        ("<f", float("nan")), (">f", float("inf")), ("<d", 1e300), (">d", float("nan")), ("<H", 65535),
    )
)  # fmt: skip
"""The same for readers of numbers in bits."""


@dataclass(frozen=True)
class Seed:
    """Files to be damaged, by their names, and the one that is read; "" for their folder."""

    name: str
    files: Mapping[str, bytes]
    read: str = ""


def mutated(seed: Seed, number: int) -> Seed:
    """The mutation of that number of a seed; number 0 is the seed itself."""
    if number == 0:
        return seed
    chance = random.Random(f"{seed.name} {number}")
    name = chance.choice(sorted(seed.files))
    data = damaged(seed.files[name], chance, [each for each in seed.files.values() if each])
    return Seed(seed.name, {**seed.files, name: data}, seed.read)


def damaged(data: bytes, chance: random.Random, others: Sequence[bytes]) -> bytes:
    """The data, damaged at up to four places. Some of the damage is copied from the other data."""
    copy = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        _damage(copy, chance, others)
    return bytes(copy)


def _damage(data: bytearray, chance: random.Random, others: Sequence[bytes]) -> None:
    """Damage the data at one place."""
    at = chance.randrange(len(data) + 1)
    end = min(len(data), at + chance.choice((1, 1, 2, 4, 8, 40, 400)))
    kind = chance.randrange(9)
    if kind == 0 and at < len(data):
        data[at] ^= 1 << chance.randrange(8)
    elif kind == 1:
        del data[at:end]
    elif kind == 2:
        data[at:at] = chance.randbytes(chance.randint(1, 8))
    elif kind == 3:
        del data[at:]
    elif kind == 4:
        data[at:at] = data[at:end] * chance.choice((1, 1, 3, 50))
    elif kind == 5:
        other = chance.choice(others) if others else b""
        start = chance.randrange(len(other) + 1)
        data[at:end] = other[start : start + chance.randint(1, 60)]
    elif kind == 6:
        word = chance.choice(BITS)
        data[at : at + len(word)] = word
    else:
        _replace_word(data, chance, at)


def _replace_word(data: bytearray, chance: random.Random, at: int) -> None:
    """Put another number in place of the word that is next to a place."""
    spaces = b" \t\r\n,/"
    start = at
    while start < len(data) and data[start] in spaces:
        start += 1
    end = start
    while end < len(data) and data[end] not in spaces and end < start + 40:
        end += 1
    data[start:end] = chance.choice(NUMBERS)


@cache
def scene() -> Scene:
    """A cube of two parts with scalars of both kinds, under two lights."""
    stress = MeshScalar("stress", np.array([1, 2, np.nan, 4, 5, 6, 7, 8e10]))
    mesh = boxes().mesh.with_scalars(stress, MeshScalar("area", np.arange(6.0), "polygon"))
    return boxes().replace(mesh=mesh)


STL_TEXT = (
    b"solid plate\n"
    + b"".join(
        b"facet normal 0 0 1\nouter loop\nvertex %d 0 0\nvertex %d 0 0.5\nvertex 0 %d 1e-3\nendloop\n"
        b"endfacet\n" % (at, at + 1, at + 1)
        for at in range(4)
    )
    + b"endsolid plate\n"
)
STL_BITS = (
    b"\0" * 80
    + struct.pack("<I", 4)
    + b"".join(struct.pack("<12fH", 0, 0, 1, at, 0, 0, at + 1, 0, 0.5, 0, at + 1, 1e-3, 0) for at in range(4))
)
PLY_TEXT = (
    b"ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    b"property float z\nproperty uchar red\nproperty double stress\nelement face 2\n"
    b"property list uchar int vertex_indices\nend_header\n"
    b"0 0 0 255 1.5\n1 0 0 0 2\n1 1 0 1 3\n0 1 0.5 2 -4e3\n4 0 1 2 3\n3 0 1 2\n"
)
PLY_BITS = (
    b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    b"property float z\nproperty uchar red\nelement face 2\nproperty list uchar uint vertex_indices\n"
    b"property short load\nend_header\n"
    + b"".join(struct.pack(">3fB", *place, 9) for place in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.5)))
    + struct.pack(">B4IhB3Ih", 4, 0, 1, 2, 3, 7, 3, 0, 1, 2, -7)
)
BYU_TEXT = (
    b"       2       6       3      11\n       1       2       3       3\n"
    b" 0.00000E+00 0.00000E+00 0.00000E+00 1.00000E+00 0.00000E+00 0.00000E+00\n"
    b" 1.00000E+00 1.00000E+00 0.00000E+00 0.00000E+00 1.00000E+00 5.00000E-01\n"
    b" 2.00000E+00 1.00000E+00 0.00000E+00 2.00000E+00 2.00000E+00 1.00000E+00\n"
    b"       1       2       3      -4       2       5      -3       3       5       6\n      -4\n"
)
BYU_FREE = (
    b"2 8 6 24\n1 5 6 6\n0 0 0 1 0 0 0 1 0 1 1 0\n0 0 1 1 0 1 0 1 1 1 1 1\n"
    b"1 3 4 -2 5 6 8 -7 1 2 6 -5\n3 7 8 -4 1 5 7 -3 2 4 8 -6\n"
)


OBJ_TEXT = (
    b"# by hand\nmtllib car.mtl\no hood\nusemtl red\nv 0 0 0\nv 1.5e0 0 0 1\nv 1 1 0\nv 0 1 .5\n"
    b"vt 0 0\nvn 0 0 1\n"
    b"f 1/1/1 2/1/1 3/1/1 4/1/1\ng roof wide\ns 1\nv 2 2 2\nf -1 -3 2\nf 1 2 3 \\\n4 5\nl 1 2\n"
)
MTL_TEXT = b"newmtl red\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 20\nmap_Kd car.png\nd 0.5\n"
TOML_TEXT = (
    b'ambient = 0.1\n[[mesh]]\nfile = "car.obj"\nscale = 2\n[parts.hood]\nsurface = "red"\n'
    b'[surfaces.red]\nobject_color = "#b01020"\n[[lights]]\nname = "key"\nposition = [4, -6, 5]\n'
    b'[scalar]\nname = "z"\nbands = 4\n'
)

OFF_TEXT = (
    b"OFF\n# a plate\n5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n2 0.5 1\n4 0 1 2 3\n3 1 4 2 255 0 0\n5 0 1 4 2 3\n"
)
OFF_NORMALS = b"NOFF\n4 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0.5 0 0 1\n4 0 1 2 3\n3 0 1 2 9 9\n"

BY_HAND = (
    Seed("OBJ by hand", {"car.obj": OBJ_TEXT, "car.mtl": MTL_TEXT}, "car.obj"),
    Seed("STL in text", {"plate.stl": STL_TEXT}, "plate.stl"),
    Seed("STL in bits", {"plate.stl": STL_BITS}, "plate.stl"),
    Seed("STL in bits that begins solid", {"plate.stl": b"solid" + STL_BITS[5:]}, "plate.stl"),
    Seed("PLY in text", {"plate.ply": PLY_TEXT}, "plate.ply"),
    Seed("PLY in bits", {"plate.ply": PLY_BITS}, "plate.ply"),
    Seed("OFF with normals", {"plate.off": OFF_NORMALS}, "plate.off"),
    Seed("OFF", {"plate.off": OFF_TEXT}, "plate.off"),
    Seed("Movie.BYU", {"plate.g": BYU_TEXT}, "plate.g"),
    Seed("Movie.BYU in words", {"plate.g": BYU_FREE}, "plate.g"),
    Seed("scene file", {"scene.toml": TOML_TEXT, "car.obj": OBJ_TEXT, "car.mtl": MTL_TEXT}),
)
"""Samples of what is only read, and of kinds of files that are read and not written."""


def written_seed(output: Format) -> Seed:
    """The small scene as a format writes it."""
    with tempfile.TemporaryDirectory() as name:
        suffix = output.suffixes[0] if output.suffixes else ""
        target = Path(name) / f"small{'' if output.in_folder else suffix}"
        assert output.write is not None
        output.write(target, scene(), False)
        if not output.in_folder:
            return Seed(f"{output.name} as written", {target.name: target.read_bytes()}, target.name)
        found = sorted(path for path in target.rglob("*") if path.is_file())
        files = {path.relative_to(target).as_posix(): path.read_bytes() for path in found}
        return Seed(f"{output.name} as written", files)


def seeds() -> Iterator[Seed]:
    """Samples of all formats: those by hand, and one for each format that is written."""
    yield from BY_HAND
    for output in OUTPUTS:
        yield written_seed(output)
