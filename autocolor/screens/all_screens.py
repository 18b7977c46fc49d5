"""Every screen, in the order of the main menu. A new screen is its module, and its line here."""

from __future__ import annotations

from typing import Final

from autocolor.screens.colors.blending_screen import BlendingScreen
from autocolor.screens.colors.mixing_screen import MixingScreen
from autocolor.screens.entries_screen import EntriesScreen
from autocolor.screens.files.file_screen import FileScreen
from autocolor.screens.help_screen import HelpScreen
from autocolor.screens.kept_screen import KeptScreen
from autocolor.screens.light_and_view.light_and_view_screen import LightAndViewScreen
from autocolor.screens.lights.lights_screen import LightsScreen
from autocolor.screens.mapping.mapping_screen import MappingScreen
from autocolor.screens.picture.picture_screen import PictureScreen
from autocolor.screens.reflectance_screen import ReflectanceScreen
from autocolor.screens.scalars.scalar_screen import ScalarScreen
from autocolor.screens.screen import Screen

SCREENS: Final[tuple[type[Screen], ...]] = (
    PictureScreen,
    LightAndViewScreen,
    LightsScreen,
    ReflectanceScreen,
    MixingScreen,
    BlendingScreen,
    MappingScreen,
    ScalarScreen,
    KeptScreen,
    FileScreen,
    EntriesScreen,
    HelpScreen,
)
