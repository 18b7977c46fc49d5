"""The light blending screen: the picture, and an upright bar of the chosen surface's own levels.

Paper: Figure 14. "The vertical bar indicates intensity with the highest intensity at the top and lowest at
the bottom. By selecting a new blend intensity on this bar, the image is redisplayed instantly". A second
handle is the control that the paper asks for, "to adjust the percentage of the specular color at the maximum
intensity".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Final

from autocolor.mapping.colors import blend_from, blend_level
from autocolor.screens.picture.over_picture import OverPicture, surface_row
from autocolor.screens.screen import Content, Surroundings
from autocolor.screens.session import BLENDING, MIXING
from autocolor.screens.surface.painting import change_paint, paint_rows
from autocolor.widgets.bars import LANE, LevelBar, PercentBar
from autocolor.widgets.items import CHARACTER, WIDTH, Area, text
from autocolor.widgets.menu import MENU
from autocolor.widgets.widget import TEXT_DOWN, Button, Gap, Widget

TOP: Final = 24
BOTTOM: Final = MENU.bottom - 24
BAR_ELEMENTS: Final = 24
PERCENT_ELEMENTS: Final = 36
BESIDE: Final = 5
"""Elements from the numbers to the menu, or to the right edge, where the pointer brings it."""


class BlendingScreen(OverPicture):
    """The picture, and how the two colors of the chosen surface blend."""

    name = BLENDING
    title = "light blending"
    help = "Pick a level on the bar: the light color blends in above it"
    has_menu = False

    def build(self, around: Surroundings) -> Content:
        content = replace(super().build(around), rows=self._rows, escape=self._escape)
        surface = self.session.chosen_surface
        if not around.has_panels or surface is None:
            return content
        # Where the menu comes, the bar moves to its left. It takes the legend's place.
        right = (MENU.left if around.has_menu else WIDTH) - BESIDE
        if surface.paint.ramp is None:
            return replace(content, items=(), widgets=self._bars(right))
        label = "a ramp has no blend; change the ramp in color mixing"
        return replace(content, items=[text(label, right - CHARACTER * len(label), TOP + TEXT_DOWN)])

    def _escape(self) -> bool:
        self.session.turn_to(MIXING)
        return True

    def _rows(self) -> Sequence[Widget]:
        session, surface = self.session, self.session.chosen_surface
        back = Button("< color mixing", "Back to color mixing.", run=partial(session.turn_to, MIXING))
        if surface is None:
            return [back]
        help = "The surface whose colors blend; a click in the picture chooses, too."
        return [back, surface_row(session, help), Gap("blend gap"), *paint_rows(session, surface.paint)]

    def _bars(self, right: int) -> Sequence[Widget]:
        """The bars of the blend level and of the percentage, whose numbers end before an element."""
        name, image = self.session.surface_name, self.session.studio.display_image
        paint, levels = self.session.scene.surfaces[name].paint, image.ranges[name].levels
        between = right - PERCENT_ELEMENTS
        return [
            LevelBar(
                "blend level",
                "The light color blends in above the handle; pick a level, or drag.",
                area=Area(between - BAR_ELEMENTS - LANE, TOP, between - 1, BOTTOM),
                words=image.words_at_levels(name),
                value=blend_level(paint.blend, levels),
                most=levels - 1,
                put=lambda level: change_paint(self.session, blend=blend_from(level, levels)),
                number=f"{paint.blend:.2f}",
                upright=True,
            ),
            PercentBar(
                "light color at the maximum",
                "The percentage of the light color at the highest level.",
                area=Area(between, TOP, right - 1, BOTTOM),
                value=paint.light_percentage,
                put=lambda value: change_paint(self.session, light_percentage=value),
            ),
        ]
