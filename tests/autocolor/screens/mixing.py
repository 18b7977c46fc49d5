"""A hand at the color mixing screen, and whether its shades and its blend bar show what they should."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from autocolor import Scene
from autocolor.screens.surface.mixing_screen import BLEND
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import LANE
from autocolor.widgets.items import Area
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.painting_hand import PaintingHand

STRIP = Area(BLEND.left, BLEND.top + LANE, BLEND.right, BLEND.bottom - LANE)
SHADES = {"light source": Area(8, 36, 172, 96), "object": Area(8, 159, 172, 219)}
ZERO = 192
"""The element of a bar at which a component is 0; each of the next is one more."""


def mixing(scene: Scene, folder: Path) -> PaintingHand:
    """A hand at the color mixing screen of a scene."""
    hand = PaintingHand(Viewer(scene, Ramtek9300(), folder))
    hand.turn_to("color mixing")
    assert hand.viewer.page == "mixing"
    return hand


def shades_are_right(hand: PaintingHand) -> bool:
    """Whether shade k of the 64 of each color is k / 63 of its color, rounded half up."""
    steps = np.floor(np.arange(165) * 63 / 164 + 0.5)
    paint = hand.paint
    return all(
        np.array_equal(
            hand.colors(SHADES[title]),
            np.broadcast_to(np.floor(np.outer(steps, color) / 63 + 0.5), (61, 165, 3)),
        )
        for title, color in (("light source", paint.light_color), ("object", paint.object_color))
    )


def bar_is_right(hand: PaintingHand, most_off: int = 0) -> bool:
    """Whether the blend bar has the entries of the surface's levels, rising to the right."""
    first, levels = hand.viewer.studio.level_ranges[hand.viewer.session.surface_name]
    entries = hand.viewer.studio.entries[first : first + levels]
    wanted = np.floor(np.arange(STRIP.width) * (levels - 1) / (STRIP.width - 1) + 0.5).astype(int)
    near = [np.clip(wanted + off, 0, levels - 1) for off in range(-most_off, most_off + 1)]
    is_near = [(hand.colors(STRIP)[[0, -1]] == entries[each]).all(axis=(0, 2)) for each in near]
    return bool(np.logical_or.reduce(is_near).all())
