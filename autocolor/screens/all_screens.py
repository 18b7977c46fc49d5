"""Every screen, in the order of the main menu. A new screen is its module, and its line here."""

from __future__ import annotations

from typing import Final

from autocolor.screens.entries_screen import EntriesScreen
from autocolor.screens.help_screen import HelpScreen
from autocolor.screens.picture_screen import PictureScreen
from autocolor.screens.screen import Screen

SCREENS: Final[tuple[type[Screen], ...]] = (PictureScreen, EntriesScreen, HelpScreen)
