from __future__ import annotations

from pathlib import Path

from autocolor.screens.board.main_menu import last_rows, page_of_menu, rows_of_menu
from autocolor.screens.viewer import Viewer
from autocolor.widgets.colors import GRAY, NIGHT, WHITE
from autocolor.widgets.items import text
from autocolor.widgets.menu import MENU
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
    for screen in viewer.screens.values():
        session.edit(before.replace(ambient=0.7))
        after = session.scene
        undo = next(row for row in last_rows(session, screen) if row.help.startswith("Undo"))
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
        page = page_of_menu(rows, (), number, seen.append)
        page[-1].pick(Place(0, 0))
        number = seen[-1]
    assert seen == [1, 2, 0]
    assert [row.label for row in page_of_menu(rows, (), 9, seen.append)] == [
        row.label for row in page_of_menu(rows, (), 2, seen.append)
    ]


def test_every_page_of_a_long_menu_ends_with_undo(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    rows: list[Widget] = [Button(str(number)) for number in range(60)]
    last = last_rows(viewer.session, viewer.screens["picture"])
    labels = []
    for number in range(3):
        page = page_of_menu(rows, last, number, lambda _: None)
        assert [row.label for row in page[-3:]] == [row.label for row in last]
        assert all(MENU.covers(row.area) for row in page)
        labels += [row.label for row in page[:-4]]
    assert labels == [row.label for row in rows]


def test_undo_and_redo_are_dim_while_there_is_no_step_for_them(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    session = viewer.session

    def inks() -> list[int]:
        undo = last_rows(session, viewer.screens["desk"])[1].at(MENU)
        return [
            next(
                word
                for word in (WHITE, GRAY)
                if text(label, item.area.left, item.area.top, word, NIGHT) == item
            )
            for label, item in zip(("undo", "redo"), undo.items(lit=False)[1:], strict=True)
        ]

    undo = last_rows(session, viewer.screens["desk"])[1]
    assert (inks(), undo.why_not) == ([GRAY, GRAY], "there is no step to undo")
    session.edit(session.scene.replace(ambient=0.7))
    assert inks() == [WHITE, GRAY]
    session.undo()
    assert inks() == [GRAY, WHITE]
    assert not last_rows(session, viewer.screens["desk"])[1].why_not
