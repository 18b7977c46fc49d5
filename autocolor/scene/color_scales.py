"""Color scales: the colors from the lowest to the highest value of a scalar.

viridis, plasma, inferno, magma and cividis are perceptually uniform: equal steps of the value look equally
large, and stay in order in a print without colors. turbo and rainbow have more distinguishable colors, but
misleading steps. coolwarm and RdBu diverge from a light middle, for values around zero. zebra is black and
white in turn, for lines of equal value, and shows how smooth a surface is.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color
from autocolor.immutable import read_only
from autocolor.scene.kinds import ColorKind

# The perceptually uniform scales come from matplotlib: viridis, plasma, inferno and magma by N. Smith, S. van
# der Walt and E. Firing, 2015; cividis by J. Nuñez, C. Anderton and R. Renslow, 2018, "Optimizing colormaps
# with consideration for color vision deficiency". Turbo is by A. Mikhailov, 2019, coolwarm by K. Moreland,
# 2009, "Diverging color maps for scientific visualization", and RdBu by C. Brewer.
#
# Measured: a mixed color between two of the 33 colors is within 5 of 255 of the original, which has 256
# colors. RdBu has 11 colors in the original, too.

SCALE_TABLES: Final[Mapping[str, str]] = {
    "viridis": """
        440154 470d60 48186a 482374 472d7b 453781 424086 3e4989 3b528b 375b8d 33638d
        2f6b8e 2c728e 297a8e 26828e 23898e 21918c 1f988b 1fa088 22a785 28ae80 32b67a
        3fbc73 4ec36b 5ec962 70cf57 84d44b 98d83e addc30 c2df23 d8e219 ece51b fde725
    """,
    "plasma": """
        0d0887 220690 310597 3f049c 4c02a1 5901a5 6600a7 7201a8 7e03a8 8a09a5 9511a1
        a01a9c aa2395 b32c8e bc3587 c43e7f cc4778 d35171 da5a6a e06363 e66c5c eb7655
        f0804e f58b47 f89540 fba139 fdac33 feb82c fdc527 fcd225 f8df25 f4ed27 f0f921
    """,
    "inferno": """
        000004 040312 0b0724 150b37 210c4a 2f0a5b 3d0965 4a0c6b 57106e 64156e 71196e
        7d1e6d 8a226a 972766 a32c61 b0315b bc3754 c73e4c d24644 db503b e45a31 eb6628
        f1731d f68013 f98e09 fb9d07 fcac11 fbbc21 f9cb35 f5db4c f2ea69 f3f68a fcffa4
    """,
    "magma": """
        000004 030312 0a0822 130d34 1d1147 29115a 36106b 440f76 51127c 5d177f 6a1c81
        762181 832681 902a81 9c2e7f aa337d b73779 c43c75 d0416f dc4869 e75263 ef5d5e
        f56b5c f9795d fc8961 fd9869 fea772 feb67c fec488 fed395 fde2a3 fcf0b2 fcfdbf
    """,
    "cividis": """
        00224e 00285b 002e6a 053371 1a386f 273e6e 32436d 3b496c 434e6c 4b546c 535a6d
        5a5f6e 61656f 686a71 6f7073 767676 7d7c78 848279 8c8878 938e78 9b9476 a39a74
        aba072 b4a76f bcae6c c4b468 cdbb63 d5c25e dec958 e7d150 f0d846 f9e03a fee838
    """,
    "turbo": """
        30123b 392a73 4040a2 4456c7 466be3 4680f6 4294ff 37a8fa 28bceb 1ccdd8 18ddc2
        1fe9af 32f298 4ef97d 6dfe62 8bff4b a4fc3c b9f635 cdec34 dfdf37 eecf3a f8be39
        fdac34 fe962b fb7e21 f46617 eb500e df3f08 d02f05 be2102 a91601 920b01 7a0403
    """,
    "coolwarm": """
        3b4cc0 445acc 4e68d8 5875e1 6282ea 6c8ff1 779af7 82a6fb 8db0fe 98b9ff a3c2fe
        aec9fc b9d0f9 c3d5f4 ccd9ed d5dbe5 dddcdc e5d8d1 ecd3c5 f1ccb8 f5c4ac f7ba9f
        f7b093 f6a586 f4987a f08b6e eb7d62 e46e56 dd5f4b d44e41 ca3b37 be242e b40426
    """,
    "RdBu": """
        67001f b1182b d6604d f3a481 fddbc7 f6f7f7 d1e5f0 90c4dd 4393c3 2065ab 053061
    """,
    "rainbow": "0000ff 00ffff 00ff00 ffff00 ff0000",
    "grays": "000000 ffffff",
    "zebra": "000000 ffffff",
}
"""Hexadecimal colors by the name of the scale, at equal distances from the lowest value to the highest."""

REVERSED: Final = "_r"
"""The end of the name of a scale in reverse order, as in matplotlib."""

IN_TURN: Final = ("zebra", f"zebra{REVERSED}")
"""The scales whose colors repeat from band to band. Other scales mix their colors."""


COLOR_SCALES: Final[Mapping[str, tuple[str, ...]]] = {
    name + end: tuple(f"#{color}" for color in table.split()[::step])
    for name, table in SCALE_TABLES.items()
    for end, step in (("", 1), (REVERSED, -1))
}
"""The colors of each named scale, at equal distances."""


@lru_cache(maxsize=64)
def scale_colors(scale: str | tuple[Color, ...], count: int) -> Bytes:
    """The colors of `count` bands, (count, 3) uint8, read-only.

    Assumed: the first and the last band have the colors of the scale's ends, and the others are at equal
    distances between them, so that few bands differ as much as the scale allows. The middle band of an odd
    number has the middle color of a diverging scale.

    >>> scale_colors("grays", 3).tolist()
    [[0, 0, 0], [128, 128, 128], [255, 255, 255]]
    """
    colors = COLOR_SCALES[scale] if isinstance(scale, str) else scale
    given = np.array([ColorKind().accepted(color) for color in colors], np.float64)
    if isinstance(scale, str) and scale in IN_TURN:
        return read_only(given[np.arange(count) % len(given)].astype(np.uint8))
    places = np.linspace(0, len(given) - 1, count)
    mixed = [np.interp(places, np.arange(len(given)), component) for component in given.T]
    return read_only(np.floor(np.stack(mixed, axis=1) + 0.5).astype(np.uint8))
