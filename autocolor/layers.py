"""The layers of a picture for compositors, in one OpenEXR file: light by light, depth, normals, identities.

docs/LAYERS.md lists the channels, whose names compositors know. The file has the lines and elements of the
picture, so each pixel sees one point, and every coverage is 1.

Assumed: all channels but R, G and B are 0 where nothing is visible. No visible point has the depth 0.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from io import BytesIO
from os import PathLike
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Bytes, PartNumbers, Singles, light_of, underflowing
from autocolor.budget import require_memory
from autocolor.errors import InputError, UnavailableError
from autocolor.files.writing import check_suffix, refuse_output, write_atomically
from autocolor.images import display_image
from autocolor.lighting.illumination import illuminate
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.lighting.shading import DIFFUSE, SPECULAR
from autocolor.rendering import Rendering, rendering
from autocolor.scene.scene import Scene

BYTES_OF_PIXEL: Final = 140
BYTES_OF_LIGHT: Final = 22
"""Measured where all pixels see polygons, with the bytes of the file: for each pixel, and for each light that
shines in it."""

FIXED_LAYERS: Final = ("intensity", "ambient", "depth", "position", "normal", "crypto_surface", "crypto_part")
"""The layers that belong to no light."""

LONGEST_LAYER: Final = 200
"""Limit: bytes of a light's layer. OpenEXR allows 255 for the name of a channel."""

CLOSE: Final = 1e-4
"""Assumed: how far an intensity may differ when it is computed again, as a share of the largest intensity. On
the same machine there is no difference. Another machine may round sums and powers differently."""


class Layers(NamedTuple):
    """The channels of a file by name, (lines, elements) float32 or float16, and its text attributes."""

    channels: Mapping[str, AnyArray]
    attributes: Mapping[str, str]


def save_layers(
    path: str | PathLike[str], scene: Scene, picture: Picture, *, overwrite: bool = False
) -> None:
    """Write the layers of a picture to an OpenEXR file, atomically; docs/LAYERS.md lists the channels.

    `scene` is the scene that the picture was rendered from; its colors and its mapping may differ. A picture
    has no depths and no normals, so its visible points and its lights are computed again. The file has the
    lines and elements of the picture: with `smooth`, more than its image.

    Raises UsageError for a name that does not end in .exr, UnavailableError without the package OpenEXR,
    InputError if the picture is not the scene's or the layers exceed the memory budget, and OutputError or
    WriteError if the file cannot be written.
    """
    check_surfaces(scene, picture)
    check_suffix(path, ".exr", "layers")
    library = open_exr()
    refuse_output(path, overwrite=overwrite)
    channels, attributes = layers_of(scene, picture)
    header = {"compression": library.ZIPS_COMPRESSION, "type": library.scanlineimage, **attributes}
    buffer = BytesIO()
    library.File(header, dict(channels)).write(buffer)
    write_atomically(path, buffer.getvalue(), overwrite=overwrite)


def open_exr() -> Any:
    """The module OpenEXR. Raises UnavailableError if it is not installed, or too old to write to memory."""
    try:
        import OpenEXR
    except ImportError:
        version = []
    else:
        version = list(map(int, re.findall(r"\d+", OpenEXR.__version__)[:2]))
    if version < [3, 5]:
        raise UnavailableError(
            "to write layers, the package OpenEXR must be installed, at least version 3.5; run: pip install"
            ' "OpenEXR>=3.5"'
        )
    return OpenEXR


def layers_of(scene: Scene, picture: Picture) -> Layers:
    """The layers of a picture and the scene that it was rendered from. Raises InputError as `save_layers`."""
    lights = [light.name for light in scene.lights if light.shines]
    lines, elements = picture.lines, picture.elements
    require_memory(
        (BYTES_OF_PIXEL + BYTES_OF_LIGHT * len(lights)) * lines * elements,
        f"the layers of {elements} x {lines} pixels and {len(lights):,} lights",
        "render fewer pixels or lights",
    )
    again = rendering(scene, lines, elements)
    check_rendered(picture, again.picture, "the layers")
    points, place = again.points, again.points.pixels

    def raster(values: AnyArray | np.float32) -> Singles:
        flat = np.zeros(lines * elements, np.float32)
        flat[place] = values
        return flat.reshape(lines, elements)

    shown = display_image(scene, picture)
    light = light_of(shown.entries.astype(np.float64)).astype(np.float16)
    channels: dict[str, AnyArray] = {name: light[:, k][shown.words] for k, name in enumerate("RGB")}
    channels |= {"intensity.Y": picture.intensity, "ambient.Y": raster(np.float32(scene.ambient))}
    layer_of_light = light_layers(lights)
    for name, diffuse, specular in light_shares(again, lights):
        channels[f"{layer_of_light[name]}.diffuse.Y"] = raster(diffuse)
        channels[f"{layer_of_light[name]}.specular.Y"] = raster(specular)
    channels["depth.Z"] = raster(points.depths)
    for layer, vectors in (("position", points.world_points), ("normal", points.world_normals)):
        channels |= {f"{layer}.{axis}": raster(vectors[:, k]) for k, axis in enumerate("XYZ")}
    surfaces = cryptomatte("crypto_surface", picture.surfaces, picture.surface_number)
    parts = cryptomatte("crypto_part", again.picture.parts, again.picture.part_number)
    names = {"autocolor/lights": json.dumps({layer: name for name, layer in layer_of_light.items()})}
    return Layers(
        {**channels, **surfaces.channels, **parts.channels},
        {**names, **surfaces.attributes, **parts.attributes},
    )


def check_rendered(picture: Picture, again: Picture, subject: str) -> None:
    """Raise InputError unless rendering the scene again gave the same picture; `subject` needs that."""
    difference = np.abs(picture.intensity - again.intensity).max()
    if (
        difference > CLOSE * again.ranges.whole.maximum
        or (picture.surface_number != again.surface_number).any()
    ):
        raise InputError(
            f"{subject} of a picture must be computed from the scene that it was rendered from, not from one"
            " with other lights, another view or another mesh; render this scene"
        )


@underflowing
def light_shares(rendered: Rendering, lights: Sequence[str]) -> Iterator[tuple[str, Singles, Singles]]:
    """The name of each light, and its diffuse and specular share of the intensity at the visible points.

    The lights must shine in the rendered scene.
    """
    for name in lights:
        lit = rendered.picture
        if name not in lit.light_planes:
            # There are more lights than a picture keeps the planes of.
            lit = illuminate(rendered.scene.only_lights(name), rendered.points)
        planes = lit.light_planes[name]
        shares = np.empty_like(planes.values)
        for row in (DIFFUSE, SPECULAR):
            for surface in lit.slices:
                weight = np.float32(planes.weights[surface.surface_number][row] * lit.scale)
                np.multiply(planes.values[row, surface.pixels], weight, out=shares[row, surface.pixels])
        yield name, shares[DIFFUSE], shares[SPECULAR]


def light_layers(names: Iterable[str]) -> dict[str, str]:
    """The names of the layers of lights, by the names of the lights.

    Letters and digits, `_` and `-` stay. Every other character becomes `_`, because a period separates layers
    and few compositors read spaces. If two names become equal, or equal to a layer that is no light's, the
    later name gets a number.

    >>> light_layers(["key", "rim.left", "rim left", "depth"])
    {'key': 'key', 'rim.left': 'rim_left', 'rim left': 'rim_left_2', 'depth': 'depth_2'}
    """
    layers: dict[str, str] = {}
    taken = set(FIXED_LAYERS)
    for name in names:
        plain = "".join(letter if letter.isalnum() or letter in "_-" else "_" for letter in name)
        stem = plain.encode()[:LONGEST_LAYER].decode(errors="ignore")
        layer, number = stem, 2
        while layer in taken:
            layer, number = f"{stem}_{number}", number + 1
        taken.add(layer)
        layers[name] = layer
    return layers


# Cryptomatte: an identity is the hash of a name, written as a float32.


def cryptomatte(layer: str, names: Sequence[str], numbers: Bytes | PartNumbers) -> Layers:
    """Identities in Cryptomatte's layout. Number k at a pixel, from 1 on, is names[k - 1], and 0 is nothing.

    Of two ranks of identity and coverage, the first has the identity (R) and the coverage 1 (G), and the
    second is empty (B, A). The manifest has the names that are visible. Format: "Cryptomatte Specification",
    Psyop, 2018: version 1.2.
    """
    bits = [identity(murmur_hash(name.encode("utf-8", "replace"))) for name in names]
    identities = np.array([0, *bits], np.uint32).view(np.float32)
    none = np.zeros(numbers.shape, np.float32)
    channels = {
        f"{layer}00.R": identities[numbers],
        f"{layer}00.G": (numbers > 0).astype(np.float32),
        f"{layer}00.B": none,
        f"{layer}00.A": none,
    }
    visible = np.flatnonzero(np.bincount(numbers.ravel(), minlength=1 + len(names))[1:]).tolist()
    manifest = {names[k]: f"{bits[k]:08x}" for k in visible}
    key = f"cryptomatte/{murmur_hash(layer.encode()):08x}"[: len("cryptomatte/") + 7]
    attributes = {
        f"{key}/name": layer,
        f"{key}/hash": "MurmurHash3_32",
        f"{key}/conversion": "uint32_to_float32",
        f"{key}/manifest": json.dumps(manifest, ensure_ascii=False).encode("utf-8", "replace").decode(),
    }
    return Layers(channels, attributes)


def identity(number: int) -> int:
    """The bits of the float32 that stands for a hash: its own, so that the float is finite and not tiny.

    If all bits of the float's exponent would be equal, the last of them is flipped.

    >>> f"{identity(0x3F800000):x} {identity(0x7FC00000):x}"
    '3f800000 7f400000'
    """
    return number ^ 1 << 23 if number >> 23 & 255 in (0, 255) else number


def murmur_hash(data: bytes) -> int:
    """The 32-bit MurmurHash3 of bytes, with the seed 0.

    Source: A. Appleby, MurmurHash3_x86_32, in the public domain.

    >>> f"{murmur_hash(b'bunny'):08x}"
    '13851a76'
    """

    def scrambled(word: int) -> int:
        word = word * 0xCC9E2D51 & 0xFFFFFFFF
        return (word << 15 | word >> 17) * 0x1B873593 & 0xFFFFFFFF

    number = 0
    whole = len(data) // 4 * 4
    for start in range(0, whole, 4):
        number ^= scrambled(int.from_bytes(data[start : start + 4], "little"))
        number = (number << 13 | number >> 19) & 0xFFFFFFFF
        number = number * 5 + 0xE6546B64 & 0xFFFFFFFF
    number ^= scrambled(int.from_bytes(data[whole:], "little")) ^ len(data)
    number = (number ^ number >> 16) * 0x85EBCA6B & 0xFFFFFFFF
    number = (number ^ number >> 13) * 0xC2B2AE35 & 0xFFFFFFFF
    return number ^ number >> 16
