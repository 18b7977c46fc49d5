"""What every screen draws over its base, as checksums: a golden of places, inks, labels and numerals.

If a screen changes on purpose, look at it, and copy the new number from the failure.
"""

from __future__ import annotations

import os
from pathlib import Path

from autocolor.screens.board import rows_of_menu
from autocolor.screens.session import LastEdit
from autocolor.screens.tutorial import Tutorial
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import Bar
from autocolor.widgets.menu import WIDE_BAR, laid_out
from ramtek_emu import Ramtek9300, instructions
from tests.autocolor.widgets.drawing import checksum
from tests.small import boxes

PAGES = {
    "picture": 473489948,
    "light and view": 3442920221,
    "lights": 2635481227,
    "reflectance": 571573069,
    "mixing": 1_328_086_564,
    "blending": 4232246749,
    "mapping": 2296462326,
    "scalar": 648425415,
    "variants": 378967624,
    "history": 158829111,
    "file": 2987804811,
    "explain": 4211328274,
    "split": 1133462600,
    "entries": 3253356514,
    "sent": 2886095108,
    "help": 111038151,
    "tutorial": 3473960918,
}


def test_every_screen_is_drawn_as_it_was(tmp_path: Path) -> None:
    folder = tmp_path / "scenes"
    (folder / "more").mkdir(parents=True)
    (folder / "car.obj").touch()
    # A row shows the year of an old file.
    os.utime(folder / "car.obj", (1e9, 1e9))
    viewer = Viewer(boxes().with_scalar(name="z"), Ramtek9300(), folder)
    viewer.studio.keep_variant("first")
    viewer.studio.keep_variant()
    # Words of the picture would depend on the rounding of the light.
    after = viewer.studio.scene.with_paint("low", object_color="#24c")
    entries = instructions.load_entries(1, [(number, 0, 7) for number in range(60)])
    edit = LastEdit(viewer.studio.scene, after, entries, 1234)
    board = viewer.board
    board.is_pinned = True
    pages = {}
    for name, screen in viewer.screens.items():
        viewer.session.turn_to(name)
        viewer.tell("")
        viewer.session.last_edit = edit
        items = list(board.page().items)
        for widget in board.widgets():
            items += widget.items(lit=True)
        # The rows of all pages of the menu, and their wide bars.
        for row in rows_of_menu(viewer.session, screen, viewer.screens.values()):
            for widget in laid_out([row]):
                items += widget.items(lit=False)
            if isinstance(row, Bar):
                items += row.at(WIDE_BAR).items(lit=False)
        pages[name] = checksum(items, skips_images=True)
    viewer.session.turn_to("picture")
    tutorial = Tutorial(viewer.session)
    board.over = tutorial.widgets
    viewer.tell("")
    items = list(board.page().items)
    for widget in tutorial.widgets():
        items += widget.items(lit=True)
    pages["tutorial"] = checksum(items)
    changed = {name: number for name, number in pages.items() if PAGES.get(name) != number}
    assert not changed, changed
