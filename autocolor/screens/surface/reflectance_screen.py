"""The reflectance screen: D, S, and the reflection model of the chosen surface with its parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from autocolor.screens.picture.over_picture import OverPicture, surface_row
from autocolor.screens.screen import Content, Surroundings
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Gap, Widget


class ReflectanceScreen(OverPicture):
    """The chosen surface, without its colors."""

    name = "reflectance"
    title = "reflectance"
    word = "surface"
    help = "How the chosen surface reflects; click in the picture: choose another"

    def build(self, around: Surroundings) -> Content:
        return replace(super().build(around), rows=self._rows)

    def _rows(self) -> Sequence[Widget]:
        session = self.session
        surface = session.chosen_surface
        if surface is None:
            return []

        def put(changes: Mapping[str, Any]) -> None:
            session.edit(session.scene.with_surface(surface.name, **changes))

        return [
            surface_row(session, "The surface whose properties are shown."),
            Gap("properties gap"),
            *rows_of(surface, put, session.world, leave_out=("name", "paint")),
        ]
