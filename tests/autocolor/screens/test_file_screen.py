from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Light, Scene, read_scene, write_rig, write_scene
from autocolor.errors import AutocolorError
from autocolor.files.state import note_file
from autocolor.screens.file_screen import LEFT, MOST_ROWS, RIGHT, FileRow
from autocolor.screens.session import PICTURE
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import Choice
from tests.autocolor.meshes import LYING, wall_scene
from tests.autocolor.screens.boxes import boxes, hand_at, told, undo
from tests.autocolor.screens.hand import Hand


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a scene, a mesh, a rig, what is broken, and a folder; beside it, another scene."""
    inside = tmp_path / "inside"
    (inside / "deeper").mkdir(parents=True)
    write_scene(inside / "wall", wall_scene(name="wall"))
    write_scene(tmp_path / "outside", wall_scene(name="outside"))
    (inside / "deeper" / "triangle.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
    (inside / "broken.obj").write_text("v 0 0 0\nf 1 2 3\nf 1 x 2\n")
    write_rig(inside / "rig.toml", wall_scene(lights=[Light("lamp", (0, -2, 0), aim=(0, 0, 0))]))
    return inside


@pytest.fixture
def hand(folder: Path) -> Hand:
    return hand_at(folder, "file")


def scene_of(hand: Hand) -> Scene:
    return hand.viewer.studio.scene


def rows_of(hand: Hand, recent: bool = False) -> dict[str, FileRow]:
    """The rows of files, by the names that are shown."""
    column = RIGHT if recent else LEFT
    rows = hand.viewer.board.screen.widgets()
    return {row.shown: row for row in rows if isinstance(row, FileRow) and column.covers(row.area)}


def labels(hand: Hand) -> list[str]:
    return [widget.label for widget in hand.viewer.board.widgets()]


def pick(hand: Hand, name: str, recent: bool = False) -> None:
    area = rows_of(hand, recent)[name].area
    hand.click(area.left + 40, area.top + 8)


def test_files_are_listed_with_their_kinds(hand: Hand) -> None:
    assert {name: row.value for name, row in rows_of(hand).items()} == {
        "broken.obj": "mesh",
        "rig.toml": "rig",
        "wall": "scene",
        "deeper": "folder",
    }


def test_a_file_is_opened_by_a_click_and_undo_brings_the_scene_back(hand: Hand) -> None:
    before = scene_of(hand)
    pick(hand, "wall")
    assert scene_of(hand).name == "wall"
    assert told(hand) == ("opened wall; undo goes back", False)
    assert hand.viewer.session.screen == PICTURE
    hand.open_menu()
    undo(hand)
    assert scene_of(hand) is before
    hand.pick(" ", 0.8)
    assert scene_of(hand).name == "wall"


def test_a_file_in_a_folder_below_is_opened(hand: Hand) -> None:
    pick(hand, "deeper")
    assert list(rows_of(hand)) == ["..", "triangle.obj"]
    pick(hand, "..")
    pick(hand, "deeper")
    pick(hand, "triangle.obj")
    assert scene_of(hand).name == "triangle"


def test_a_mesh_that_lies_is_hinted_and_set_up_by_a_row_as_one_step(hand: Hand, folder: Path) -> None:
    before = scene_of(hand)
    (folder / "spire.obj").write_text(LYING)
    hand.pick("refresh")
    pick(hand, "spire.obj")
    lying = scene_of(hand)
    assert told(hand) == ("opened spire.obj; lying? up: y; undo goes back", False)
    hand.open_menu()
    hand.pick("lying? up: y")
    assert told(hand) == ("read again with y up; undo goes back", False)
    assert np.ptp(scene_of(hand).mesh.coordinates, axis=0).tolist() == [4, 4, 5]
    assert "lying? up: y" not in labels(hand)
    undo(hand)
    assert scene_of(hand) is lying
    assert "lying? up: y" in labels(hand)
    undo(hand)
    assert scene_of(hand) is before
    assert "lying? up: y" not in labels(hand)


def test_a_mesh_that_is_read_with_an_axis_is_not_hinted(hand: Hand, folder: Path) -> None:
    (folder / "spire.obj").write_text(LYING)
    hand.viewer.session.place_meshes("y", 1.0)
    hand.pick("refresh")
    pick(hand, "spire.obj")
    assert told(hand) == ("opened spire.obj; undo goes back", False)


def test_a_rig_is_put_on_the_scene_and_fitted(hand: Hand) -> None:
    before = scene_of(hand)
    pick(hand, "rig.toml")
    (lamp,) = scene_of(hand).lights
    assert scene_of(hand).mesh is before.mesh
    # The wall is 2 x 0 x 2 around the origin, the cube 1 x 1 x 1 around its middle.
    scale = (3 / 8) ** 0.5
    assert lamp.position == pytest.approx((0.5, 0.5 - 2 * scale, 0.5))
    assert lamp.aim == pytest.approx((0.5, 0.5, 0.5))
    assert told(hand) == ("the lights of rig.toml, fitted to boxes; undo goes back", False)
    hand.open_menu()
    undo(hand)
    assert scene_of(hand) is before


def test_an_unreadable_file_is_refused_in_an_orange_sentence(hand: Hand) -> None:
    before = scene_of(hand)
    pick(hand, "broken.obj")
    message, is_warning = told(hand)
    assert is_warning
    assert message.startswith("broken.obj")
    assert "\n" not in message
    assert scene_of(hand) is before
    assert hand.viewer.session.screen == "file"


def test_a_file_that_is_gone_since_is_refused(hand: Hand, folder: Path) -> None:
    (folder / "broken.obj").unlink()
    pick(hand, "broken.obj")
    assert told(hand)[1]
    hand.pick("refresh")
    assert "broken.obj" not in rows_of(hand)


def test_a_folder_that_is_gone_since_is_refused(hand: Hand, folder: Path) -> None:
    for path in (folder / "deeper").iterdir():
        path.unlink()
    (folder / "deeper").rmdir()
    pick(hand, "deeper")
    message, is_warning = told(hand)
    assert is_warning
    assert message.startswith("deeper: a folder must be readable")
    assert "wall" in rows_of(hand)


def test_a_session_in_a_folder_that_is_gone_still_shows_its_screen(tmp_path: Path) -> None:
    (tmp_path / "gone").mkdir()
    hand = hand_at(tmp_path / "gone", "kept")
    (tmp_path / "gone").rmdir()
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("file")
    message, is_warning = told(hand)
    assert is_warning
    assert message.startswith("gone: a folder must be readable")
    assert rows_of(hand) == {}


def test_a_pointer_from_elsewhere_keeps_to_the_folder(hand: Hand, folder: Path) -> None:
    (folder / "link").symlink_to(folder.parent)
    (folder / "scene link").symlink_to(folder.parent / "outside")
    (folder / "file link.obj").symlink_to(folder / "deeper" / "triangle.obj")
    note_file(folder.parent / "outside")
    note_file(folder / "wall" / "scene.toml")
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("file")
    assert list(rows_of(hand)) == ["broken.obj", "file link.obj", "rig.toml", "wall", "deeper"]
    assert list(rows_of(hand, recent=True)) == ["wall/scene.toml"]


def test_a_listed_file_that_became_a_link_out_is_refused(hand: Hand, folder: Path) -> None:
    before = scene_of(hand)
    (folder / "broken.obj").unlink()
    (folder / "broken.obj").symlink_to(folder.parent / "outside" / "scene.toml")
    pick(hand, "broken.obj")
    assert told(hand) == (
        "broken.obj: a file to open must be in the folder inside, and not a link to elsewhere;"
        " choose another",
        True,
    )
    for path in (folder / "deeper").iterdir():
        path.unlink()
    (folder / "deeper").rmdir()
    (folder / "deeper").symlink_to(folder.parent)
    pick(hand, "deeper")
    assert told(hand)[1]
    assert next(iter(rows_of(hand))) == "broken.obj"
    assert scene_of(hand) is before


def test_a_user_elsewhere_sees_no_path_of_the_machine(hand: Hand, folder: Path) -> None:
    pick(hand, "deeper")
    shown = [row.help for row in rows_of(hand).values()]
    assert shown == ["Look into inside", "Open inside/deeper/triangle.obj"]


def test_the_user_of_the_machine_goes_up_and_opens_recent_files(folder: Path) -> None:
    note_file(folder.parent / "outside")
    note_file(folder / "gone")
    hand = hand_at(folder, "kept")
    hand.viewer.session.is_at_hand = True
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("file")
    assert list(rows_of(hand, recent=True)) == ["outside"]
    pick(hand, "..")
    assert {"inside", "outside"} <= set(rows_of(hand))
    pick(hand, "outside", recent=True)
    assert scene_of(hand).name == "outside"


def test_home_is_the_folder_of_the_session(hand: Hand) -> None:
    pick(hand, "deeper")
    hand.pick("refresh", 0.75)
    assert "wall" in rows_of(hand)


def test_saving_shows_a_message_and_lists_the_saved_files(hand: Hand, folder: Path) -> None:
    hand.pick("save")
    message, is_warning = told(hand)
    assert not is_warning
    assert message.startswith("saved")
    assert not hand.viewer.studio.is_changed
    before = set(rows_of(hand))
    hand.pick("save the rig")
    assert told(hand) == ("saved boxes-rig.toml", False)
    assert set(rows_of(hand)) - before == {"boxes-rig.toml"}
    hand.pick("screenshot")
    hand.pick("screenshot")
    first, second = folder / "autocolor-0001.png", folder / "autocolor-0002.png"
    assert told(hand) == (f"saved {second.resolve()}", False)
    assert first.read_bytes() == second.read_bytes()


def test_a_saved_scene_is_a_recent_file_at_once(hand: Hand, folder: Path) -> None:
    before = set(rows_of(hand, recent=True))
    hand.pick("save")
    assert set(rows_of(hand, recent=True)) - before


def test_a_saved_scene_can_be_opened_again(hand: Hand, folder: Path) -> None:
    hand.viewer.studio.recolor("low", object_color="#123456")
    hand.pick("save")
    opened = []
    for path in folder.iterdir():
        try:
            opened.append(read_scene(path))
        except AutocolorError:
            continue
    assert any(
        each.name == "boxes" and each.surface("low").paint.object_color == (18, 52, 86) for each in opened
    )


@pytest.mark.parametrize("number", [MOST_ROWS, MOST_ROWS + 1, 200])
def test_the_pages_of_a_large_folder_show_all_files(tmp_path: Path, number: int) -> None:
    for each in range(number):
        (tmp_path / f"{each}.obj").touch()
    hand = hand_at(tmp_path, "file")
    seen: list[str] = []
    while len(seen) < number:
        page = list(rows_of(hand))
        assert page
        seen += page
        if len(seen) < number:
            hand.pick("page")
    assert seen == [f"{each}.obj" for each in range(number)]
    if number > MOST_ROWS:
        hand.pick("page", 0.05)
        assert "page" in [row.label for row in hand.viewer.board.screen.widgets()]


def test_rows_stay_in_their_columns_with_names_of_any_length(tmp_path: Path) -> None:
    (tmp_path / ("a very long name of a fender " * 5 + "12.obj")).touch()
    hand = hand_at(tmp_path, "file")
    (row,) = rows_of(hand).values()
    for item in row.items(lit=True):
        assert LEFT.covers(item.area)
    for item in hand.viewer.board.screen.items():
        assert WORK.covers(item.area)


def test_an_empty_folder_says_so(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "file")
    assert rows_of(hand) == rows_of(hand, recent=True) == {}
    assert len(hand.viewer.board.screen.items()) == 6


def test_the_scene_of_a_session_is_not_changed_by_looking(hand: Hand) -> None:
    before = scene_of(hand)
    pick(hand, "deeper")
    pick(hand, "..")
    hand.pick("refresh")
    assert scene_of(hand) is before
    assert before.name == boxes().name


def test_the_up_axis_of_a_mesh_is_chosen_before_it_is_opened(hand: Hand, folder: Path) -> None:
    row = next(each for each in hand.viewer.board.layout.rows if each.label == "mesh up")
    # From z to x and y.
    for _ in range(2):
        hand.click(row.area.right - 8, row.area.top + 8)
    pick(hand, "deeper")
    pick(hand, "triangle.obj")
    # What was up to y is up to z now: z has become -y.
    assert scene_of(hand).mesh.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [0, -1, 0]]
    # Other files give their own.
    hand.viewer.session.open(folder / "wall")
    assert scene_of(hand).name == "wall"


def test_the_scale_of_a_mesh_is_chosen_before_it_is_opened(hand: Hand) -> None:
    hand.choose("mesh scale", "100")
    pick(hand, "deeper")
    pick(hand, "triangle.obj")
    assert scene_of(hand).mesh.coordinates.max() == 100


def test_the_scale_of_the_command_line_can_be_pointed_at(hand: Hand) -> None:
    hand.viewer.session.place_meshes("y", 25.4)
    choice = next(each for each in hand.viewer.board.screen.rows() if each.label == "mesh scale")
    assert isinstance(choice, Choice)
    assert choice.names == ("0.001", "0.01", "0.0254", "0.3048", "1", "10", "25.4", "100", "1000")
    hand.choose("mesh scale", "100")
    assert (hand.viewer.session.mesh_up, hand.viewer.session.mesh_scale) == ("y", 100)
