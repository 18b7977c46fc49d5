"""What a browser does with an export, as plain Python: unpacking, words for other lights, colors."""

from __future__ import annotations

import zlib
from base64 import b64decode
from collections.abc import Mapping
from typing import Any

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.mapping.colors import entries_of
from autocolor.scene.surfaces import Paint

BAYER = [
    [0, 32, 8, 40, 2, 34, 10, 42],
    [48, 16, 56, 24, 50, 18, 58, 26],
    [12, 44, 4, 36, 14, 46, 6, 38],
    [60, 28, 52, 20, 62, 30, 54, 22],
    [3, 35, 11, 43, 1, 33, 9, 41],
    [51, 19, 59, 27, 49, 17, 57, 25],
    [15, 47, 7, 39, 13, 45, 5, 37],
    [63, 31, 55, 23, 61, 29, 53, 21],
]
"""The tile of ordered dither, as in Bayer's paper."""


ROUNDING = 2.0**-20
"""How far float32 may be off, as a fraction of the sum of all lights."""


def inflated(text: str) -> bytes:
    return zlib.decompress(b64decode(text, validate=True))


def unpacked_words(packed: bytes, lines: int, elements: int) -> AnyArray:
    """The words of a raster, pixel by pixel."""
    data = zlib.decompress(packed)
    steps, far = data[: lines * elements], iter(np.frombuffer(data[lines * elements :], "<u2").tolist())
    words: list[int] = []
    for at, step in enumerate(steps):
        left = words[-1] if at % elements else 0
        words.append(next(far) if step == 128 else left + (step - 256 if step > 128 else step))
    assert next(far, None) is None
    return np.array(words).reshape(lines, elements)


def words_in(part: Mapping[str, Any]) -> AnyArray:
    """The words of an export, or of its legend."""
    return unpacked_words(b64decode(part["words"], validate=True), part["lines"], part["elements"])


def entries_in(values: Mapping[str, Any]) -> AnyArray:
    """The entries of an export, with those that its paints give."""
    entries = np.frombuffer(inflated(values["entries"]), np.uint8).reshape(1024, 3).copy()
    for each in values["surfaces"]:
        if not each["fixed"]:
            entries_of_surface = entries[each["first"] : each["first"] + each["levels"]]
            assert not entries_of_surface.any()
            entries_of_surface[:] = entries_of(Paint(**each["paint"]), each["levels"], each["floor"])
    return entries


def with_legend(values: Mapping[str, Any]) -> AnyArray:
    """The words with the legend drawn over them."""
    legend, words = values["legend"], words_in(values).astype(np.uint16)
    if legend is not None:
        line, element = legend["line"], legend["element"]
        words[line : line + legend["lines"], element : element + legend["elements"]] = words_in(legend)
    return words


def unpacked_plane(packed: bytes) -> list[int]:
    """The numbers of a plane."""
    data = zlib.decompress(packed)
    number, numbers = 0, []
    for low, high in zip(data[: len(data) // 2], data[len(data) // 2 :], strict=True):
        number = (number + low + 256 * high) % 65536
        numbers.append(number)
    return numbers


def relit_words(values: Mapping[str, Any], strengths: Mapping[str, float], shift: int = 0) -> AnyArray:
    """The words for other strengths of the lights; a light that is switched off has the strength 0.

    With a `shift` of -1 or 1, the least and the highest words that rounding allows.
    """
    lights, words = values["lights"], words_in(values)
    planes = {row["name"]: np.array(unpacked_plane(b64decode(row["plane"]))) for row in lights["rows"]}
    relit, start = words.copy(), 0
    tile = np.array(BAYER)
    for place, surface in enumerate(values["surfaces"]):
        first, shades = surface["first"], surface["shades"]
        at = np.nonzero((words >= first) & (words < first + surface["levels"]))
        end = start + len(at[0])
        intensity = np.full(end - start, lights["ambient"])
        for row in lights["rows"]:
            unit = strengths[row["name"]] * row["units"][place]
            intensity += unit * (planes[row["name"]][start:end] + 0.5 * shift)
        intensity *= 1 + shift * ROUNDING
        thresholds = np.frombuffer(inflated(lights["levels"][place]), "<f4").astype(float)
        levels = np.searchsorted(thresholds, intensity, side="right")
        if lights["dither"]:
            levels = (levels + tile[at[0] % 8, at[1] % 8]) // 64
        relit[at] = first + (words[at] - first) // shades * shades + levels
        start = end
    assert all(len(plane) == start for plane in planes.values())
    return relit
