from __future__ import annotations

from pathlib import Path

from autocolor.screens.board.main_menu import page_of_menu, rows_of_menu
from autocolor.screens.viewer import Viewer
from autocolor.widgets.widget import Button, Place, Widget
from tests.autocolor.screens.boards import desk_viewer


def rows(viewer: Viewer, name: str) -> list[Widget]:
    return rows_of_menu(viewer.session, viewer.screens[name], viewer.screens.values())


def test_the_picture_leads_to_every_screen_and_every_screen_back(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    labels = [row.label for row in rows(viewer, "picture")]
    for name, screen in viewer.screens.items():
        if name == "picture":
            continue
        assert (screen.title in labels) is screen.is_in_menu
        back = next(row for row in rows(viewer, name) if row.label == "< picture")
        viewer.session.turn_to(name)
        back.pick(Place(0, 0))
        assert viewer.session.screen == "picture"


def test_each_menu_undoes_and_redoes(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    session, before = viewer.session, viewer.studio.scene
    for name in viewer.screens:
        session.edit(before.replace(ambient=0.7))
        after = session.scene
        undo = next(row for row in rows(viewer, name) if row.help.startswith("Undo"))
        undo.nudge(-1)
        assert session.scene is before
        undo.nudge(1)
        assert session.scene is after
        session.undo()


def test_the_last_row_of_a_page_turns_to_the_next_and_around() -> None:
    rows: list[Widget] = [Button(str(number)) for number in range(60)]
    seen: list[int] = []
    number = 0
    for _ in range(3):
        page = page_of_menu(rows, number, seen.append)
        page[-1].pick(Place(0, 0))
        number = seen[-1]
    assert seen == [1, 2, 0]
    assert [row.label for row in page_of_menu(rows, 9, seen.append)] == [
        row.label for row in page_of_menu(rows, 2, seen.append)
    ]
