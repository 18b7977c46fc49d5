"""Tints and shades of a color: its three components raised or lowered together.

Paper: Figure 13. "The white bar can be used to quickly increase or decrease all three color components
equally to generate tints or shades." Assumed: the white of a color is the mean of its components, so that the
bar is empty for black alone and full for white alone. A component that reaches an end stays there while the
others go on; otherwise a full red would have no tints.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.checks import Color
from autocolor.mapping.rounding import half_up

FULL: Final = 255
"""The most that a component can be."""

AMOUNTS: Final = np.arange(-FULL, FULL + 1)
"""What can be added to the components."""


def white_of(color: Color) -> int:
    """The mean of the components, 0 to 255.

    >>> white_of((255, 0, 0)), white_of((10, 20, 31))
    (85, 20)
    """
    return half_up(sum(color) / 3)


def with_white(color: Color, white: int) -> Color:
    """The color with the same amount added to each component, such that their mean is `white`, 0 to 255.

    A component that would go beyond 0 or 255 stays there. Of two amounts that come as near, it is the lower.

    >>> with_white((255, 0, 0), 135), with_white((100, 60, 20), 40)
    ((255, 75, 75), (80, 40, 0))
    """
    tints = np.clip(np.array(color) + AMOUNTS[:, None], 0, FULL)
    red, green, blue = tints[np.abs(tints.sum(axis=1) - 3 * white).argmin()].tolist()
    return red, green, blue
