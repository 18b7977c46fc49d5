"""The light blending screen: the picture, and an upright bar of the chosen surface's own levels.

Paper: Figure 14. "The vertical bar indicates intensity with the highest intensity at the top and lowest at
the bottom. By selecting a new blend intensity on this bar, the image is redisplayed instantly". A second
handle is the control that the paper asks for, "to adjust the percentage of the specular color at the maximum
intensity".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from autocolor.mapping.colors import blend_from, blend_level
from autocolor.screens.input import Gesture
from autocolor.screens.picture.over_picture import OverPicture, surface_row
from autocolor.screens.screen import Content, Surroundings
from autocolor.screens.surface.painting import change_paint, paint_rows
from autocolor.widgets.bars import LANE, LevelBar, PercentBar
from autocolor.widgets.items import WIDTH, Area
from autocolor.widgets.menu import MENU
from autocolor.widgets.widget import Gap, Widget

TOP: Final = 24
BOTTOM: Final = MENU.bottom - 24
BAR_ELEMENTS: Final = 24
PERCENT_ELEMENTS: Final = 36
BESIDE: Final = 5
"""Elements from the numbers to the menu, or to the right edge, where the pointer brings it."""


class BlendingScreen(OverPicture):
    """The picture, and how the two colors of the chosen surface blend."""

    name = "blending"
    title = "light blending"
    word = "blend"
    help = "Pick a level on the bar: the light color blends in above it"
    has_menu = False

    def enter(self) -> None:
        self._explain_missing_bar()

    def pick(self, gesture: Gesture) -> None:
        before = self.session.surface_name
        super().pick(gesture)
        if self.session.surface_name != before:
            self._explain_missing_bar()

    def _choose(self, name: str) -> None:
        self.session.choose_surface(name)
        self._explain_missing_bar()

    def _explain_missing_bar(self) -> None:
        surface = self.session.chosen_surface
        if surface is not None and surface.paint.ramp is not None:
            self.session.tell(f"{surface.name} has a ramp and no blend; change the ramp in color mixing")

    def build(self, around: Surroundings) -> Content:
        content = replace(super().build(around), rows=self._rows)
        if not around.has_panels:
            return content
        # The bar takes the legend's place.
        return replace(content, items=(), widgets=self._bars(around.has_menu))

    def _rows(self) -> Sequence[Widget]:
        surface = self.session.chosen_surface
        if surface is None:
            return []
        return [
            surface_row(
                self.session,
                "The surface whose colors blend; a click in the picture chooses, too.",
                self._choose,
            ),
            Gap("blend gap"),
            *paint_rows(self.session, surface.paint),
        ]

    def _bars(self, has_menu: bool) -> Sequence[Widget]:
        surface = self.session.chosen_surface
        if surface is None or surface.paint.ramp is not None:
            return []
        levels = self.session.studio.level_ranges[surface.name].levels
        # Where the menu comes, the bar moves to its left.
        right = (MENU.left if has_menu else WIDTH) - BESIDE
        between = right - PERCENT_ELEMENTS
        paint = surface.paint
        return [
            LevelBar(
                "blend level",
                "The light color blends in above the handle; pick a level, or drag.",
                area=Area(between - BAR_ELEMENTS - LANE, TOP, between - 1, BOTTOM),
                words=self.session.studio.display_image.words_at_levels(surface.name),
                level=blend_level(paint.blend, levels),
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
