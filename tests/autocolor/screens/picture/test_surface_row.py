from __future__ import annotations

from pathlib import Path

from autocolor.screens.picture.surface_row import surface_row
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.sessions import car


def test_the_row_has_the_surfaces_in_use_and_chooses_one(tmp_path: Path) -> None:
    session = Viewer(car(), Ramtek9300(), tmp_path).session
    row = surface_row(session, "which")
    assert (tuple(row.names), row.present) == (("body", "glass", "wheels"), "body")
    row.nudge(1)
    assert session.surface_name == "glass"
    chosen: list[str] = []
    surface_row(session, "which", chosen.append).nudge(1)
    assert chosen == ["wheels"]
    assert session.surface_name == "glass"
