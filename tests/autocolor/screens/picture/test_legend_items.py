from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor.mapping.legend import legend
from autocolor.screens.picture.legend_items import legend_items
from autocolor.screens.viewer import Viewer
from autocolor.sending import drawn_legend
from autocolor.studio import Studio
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boxes import boxes


def test_without_a_legend_there_is_nothing_to_draw() -> None:
    assert legend_items(None) == ()


def test_a_screen_draws_the_same_legend_as_a_studio(tmp_path: Path) -> None:
    scene = boxes().with_scalar(name="z")
    found = legend(Studio(scene, Ramtek9300()).image)
    assert found is not None
    drawn, by_items = Ramtek9300(), Ramtek9300()
    drawn.send(drawn_legend(found))
    for item in legend_items(found):
        by_items.send(np.frombuffer(item.stream, np.uint16))
    assert (drawn.words == by_items.words).all()
    assert drawn.words.any()
    viewer, display = Viewer(scene, Ramtek9300(), tmp_path), Ramtek9300()
    viewer.clear()
    Studio(scene, display)
    assert isinstance(viewer.display, Ramtek9300)
    assert (viewer.display.words == display.words).all()


@pytest.mark.parametrize(
    ("screen", "left", "right"), [("scalar", 8, 100), ("mapping", 350, 500), ("picture", 500, 640)]
)
def test_it_stands_where_a_screen_has_room(tmp_path: Path, screen: str, left: int, right: int) -> None:
    viewer = Viewer(boxes().with_scalar(name="z"), Ramtek9300(), tmp_path)
    viewer.session.turn_to(screen)
    viewer.tell("")
    area = viewer.board.screen.items()[0].area
    assert left <= area.left <= area.right < right
    viewer.session.turn_to("blending")
    viewer.tell("")
    assert not viewer.board.screen.items()
