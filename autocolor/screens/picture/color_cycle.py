"""The object colors that a key goes through: those that surfaces are given in turn, and a surface's own."""

from __future__ import annotations

from autocolor.scene.defaults import OBJECT_COLORS


def color_after(present: str, own: str, step: int) -> str:
    """The color that is `step` positions further than the present one.

    The colors are OBJECT_COLORS, and before them the surface's own if it is none of these. A color that is
    not among them is followed by the first one.

    >>> color_after("#ff0000", "#ff0000", 1), color_after("#b3202c", "#ff0000", -1)
    ('#b3202c', '#ff0000')
    """
    colors = OBJECT_COLORS if own in OBJECT_COLORS else (own, *OBJECT_COLORS)
    place = colors.index(present) + step if present in colors else 0
    return colors[place % len(colors)]
