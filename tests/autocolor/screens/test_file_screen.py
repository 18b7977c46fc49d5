from __future__ import annotations

import os
from collections.abc import Mapping
from datetime import datetime
from itertools import chain, combinations
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from autocolor import (
    Light,
    Studio,
    image,
    read_picture,
    read_rig,
    read_scene,
    render,
    save_image,
    write_palette,
    write_picture,
    write_rig,
    write_scene,
)
from autocolor.budget import allowing
from autocolor.files.state import note_file, recent_files
from autocolor.journal.autosave import Autosave
from autocolor.journal.history import History
from autocolor.journal.places import Source, opened
from autocolor.mapping.ranges import SCREENS
from autocolor.screens.file_actions import open_file
from autocolor.screens.file_screen import (
    LEFT,
    LONGEST_DATE,
    MOST_ROWS,
    RECENT_PLACES,
    TICKS_TO_REST,
    FileRow,
    short_date,
)
from autocolor.screens.gallery import MOST_POLYGONS, Tile
from autocolor.screens.session import PICTURE, Clipboard
from autocolor.screens.viewer import Viewer
from autocolor.widgets.items import CHARACTER
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import Choice
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boxes import hand_at, hint_of, told, undo
from tests.autocolor.screens.hand import Hand
from tests.small import LYING, wall, wall_scene


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


def rows_of(hand: Hand) -> dict[str, FileRow]:
    """The rows of the folder's files, by the names that are shown."""
    return {row.shown: row for row in hand.viewer.board.content.widgets if isinstance(row, FileRow)}


def tiles_of(hand: Hand, within: str = "recent") -> dict[str, Tile]:
    """The tiles of recent files, of the examples, or of the file under the pointer, by their names."""
    tiles = [each for each in hand.viewer.board.content.widgets if isinstance(each, Tile)]
    return {each.label: each for each in tiles if each.within == within}


def pick(hand: Hand, name: str, within: str = "") -> None:
    area = (tiles_of(hand, within)[name] if within else rows_of(hand)[name]).area
    hand.click(area.left + 40, area.top + 8)


def test_a_file_is_opened_by_a_click_and_undo_brings_the_scene_back(hand: Hand) -> None:
    before = hand.scene
    pick(hand, "wall")
    assert hand.scene.name == "wall"
    assert told(hand) == ("opened wall; undo goes back", False)
    hand.turn_to("file")
    pick(hand, "wall")
    assert told(hand) == ("opened wall; it is the present scene", False)
    assert hand.viewer.session.screen == PICTURE
    hand.open_menu()
    undo(hand)
    assert hand.scene is before
    hand.pick(" ", 0.8)
    assert hand.scene.name == "wall"


@pytest.mark.parametrize(
    ("name", "becomes", "starts"),
    [
        ("broken.obj", "as it is", "broken.obj"),
        # The user is elsewhere, and sees no folder above the session's.
        ("broken.obj", "gone", "inside/broken.obj: there is no such file or folder"),
        ("broken.obj", "outside/scene.toml", "broken.obj: a file to open must be in the folder inside"),
        ("deeper", "gone", "deeper: a folder must be readable"),
        ("deeper", ".", "deeper: "),
    ],
)
def test_a_row_that_cannot_be_opened_is_refused_in_an_orange_sentence(
    hand: Hand, folder: Path, name: str, becomes: str, starts: str
) -> None:
    before = hand.scene
    if becomes != "as it is":
        (folder / name).rename(folder.parent / "elsewhere")
    if becomes not in ("as it is", "gone"):
        # A link to elsewhere.
        (folder / name).symlink_to(folder.parent / becomes)
    pick(hand, name)
    message, is_warning = told(hand)
    assert is_warning
    assert message.startswith(starts)
    assert message.isprintable()
    assert hand.scene is before
    assert hand.viewer.page == "file"
    assert {"rig.toml", "wall"} <= set(rows_of(hand))
    hand.pick("refresh")
    assert (name in rows_of(hand)) == (becomes == "as it is")


def test_a_mesh_that_lies_is_hinted_and_set_up_by_a_row_as_one_step(hand: Hand, folder: Path) -> None:
    before = hand.scene
    (folder / "spire.obj").write_text(LYING)
    hand.pick("refresh")
    pick(hand, "spire.obj")
    lying = hand.scene
    assert told(hand) == ("opened spire.obj; lies on its side? the menu turns it; undo goes back", False)
    hand.open_menu()
    hand.pick("on its side? turn")
    assert told(hand) == ("read again with y up; undo goes back", False)
    assert np.ptp(hand.scene.mesh.coordinates, axis=0).tolist() == [4, 4, 5]
    assert "on its side? turn" not in hand.labels
    undo(hand)
    assert hand.scene is lying
    assert "on its side? turn" in hand.labels
    undo(hand)
    assert hand.scene is before
    # A mesh that is read with an axis is not hinted.
    hand.viewer.session.mesh_up = "y"
    hand.viewer.on_drop(folder / "spire.obj")
    assert told(hand) == ("opened spire.obj; undo goes back", False)


def test_a_rig_is_put_on_the_scene_and_fitted(hand: Hand, folder: Path) -> None:
    before = hand.scene
    pick(hand, "rig.toml")
    assert hand.scene.equals(before.with_rig(read_rig(folder / "rig.toml")))
    assert told(hand) == ("the lights of rig.toml, fitted to boxes; undo goes back", False)
    assert hand.viewer.studio.history.to_undo[-1] is before


def test_paints_are_opened_for_color_mixing_and_are_no_step(hand: Hand, folder: Path) -> None:
    before, recent = hand.scene, recent_files()
    write_palette(folder / "ral.gpl", ["red", "navy"])
    hand.pick("refresh")
    assert rows_of(hand)["ral.gpl"].value == "paints"
    pick(hand, "ral.gpl")
    assert hand.viewer.page == "mixing"
    assert told(hand) == ("2 paints of ral.gpl: take them in color mixing", False)
    assert hand.scene is before
    # Nothing is written unasked.
    assert recent_files() == recent


def test_a_session_in_a_folder_that_is_gone_still_shows_its_screen(tmp_path: Path) -> None:
    (tmp_path / "gone").mkdir()
    hand = hand_at(tmp_path / "gone", "variants")
    (tmp_path / "gone").rmdir()
    hand.turn_to("picture")
    hand.turn_to("file")
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
    hand.turn_to("picture")
    hand.turn_to("file")
    kinds = {name: row.value for name, row in rows_of(hand).items()}
    assert list(kinds) == ["broken.obj", "file link.obj", "rig.toml", "wall", "deeper"]
    assert list(kinds.values()) == ["mesh", "mesh", "rig", "scene", "folder"]
    assert list(tiles_of(hand)) == ["wall"]
    # No path of the machine is shown.
    pick(hand, "deeper")
    shown = [row.help for row in rows_of(hand).values()]
    assert shown == ["Look into inside", "Open inside/deeper/triangle.obj"]
    pick(hand, "..")
    pick(hand, "deeper")
    hand.pick("refresh", 0.75)
    assert "wall" in rows_of(hand)


def test_the_user_of_the_machine_goes_up_and_opens_recent_files(folder: Path) -> None:
    note_file(folder.parent / "outside")
    note_file(folder / "gone")
    hand = hand_at(folder, "variants")
    hand.viewer.session.is_at_hand = True
    hand.turn_to("picture")
    hand.turn_to("file")
    assert list(tiles_of(hand)) == ["outside"]
    pick(hand, "..")
    assert {"inside", "outside"} <= set(rows_of(hand))
    hand.pick("save the rig")
    assert (folder.parent / "boxes-rig.toml").exists()
    pick(hand, "outside", "recent")
    assert hand.scene.name == "outside"


@pytest.mark.parametrize("number", [MOST_ROWS, MOST_ROWS + 1])
def test_the_pages_of_a_large_folder_show_all_files(tmp_path: Path, number: int) -> None:
    for each in range(number):
        (tmp_path / f"{each}.obj").touch()
        note_file(tmp_path / f"{each}.obj")
    hand = hand_at(tmp_path, "file")
    recent = list(tiles_of(hand))
    hand.click(RECENT_PLACES[1].right - 8, WORK.top + 8)
    assert [*recent, *tiles_of(hand)] == [f"{each}.obj" for each in range(number - 1, number - 9, -1)]
    pages = [list(rows_of(hand))]
    if number > MOST_ROWS:
        hand.pick("page", 0.8)
        pages.append(list(rows_of(hand)))
    assert [*chain(*pages)] == [f"{each}.obj" for each in range(number)]


def test_the_up_axis_and_the_scale_of_a_mesh_are_chosen_before_it_is_opened(hand: Hand, folder: Path) -> None:
    # From z to x and y.
    for _ in range(2):
        hand.pick("mesh up", 0.9)
    hand.choose("mesh scale", "100")
    pick(hand, "deeper")
    pick(hand, "triangle.obj")
    # What was up to y is up to z now: z has become -y.
    assert hand.scene.mesh.coordinates.tolist() == [[0, 0, 0], [100, 0, 0], [0, -100, 0]]
    # Other files give their own.
    open_file(hand.viewer.session, folder / "wall")
    assert hand.scene.name == "wall"


# Saving in the folder that is shown.


def test_new_files_go_to_the_folder_that_is_shown(hand: Hand, folder: Path) -> None:
    pick(hand, "deeper")
    hand.pick("save")
    assert told(hand) == (f"saved {Path('deeper/boxes/scene.toml')} and {Path('deeper/boxes.npz')}", False)
    assert "*" not in hand.viewer.caption
    assert list(tiles_of(hand)) == ["boxes"]
    for label, message in (
        ("save the rig", "saved boxes-rig.toml"),
        ("screenshot", f"saved {Path('inside/deeper/autocolor-0001.png')}"),
        ("export", "exporting boxes, 640x480, smoothness 2 ..."),
    ):
        hand.pick(label)
        assert told(hand) == (message, False)
    settle(hand)
    assert {"boxes", "boxes-rig.toml"} <= set(rows_of(hand))
    assert (folder / "deeper" / "boxes.png").exists()
    assert hint_of(hand, "save").startswith(
        "Save to boxes/scene.toml and deeper/boxes.npz; new files go to inside/deeper"
    )
    # From now on the scene has its own files, whichever folder is shown.
    hand.pick("refresh", 0.75)
    hand.viewer.studio.recolor("low", object_color="#123456")
    hand.pick("save")
    assert told(hand)[0].startswith("saved deeper")
    assert sorted(path.name for path in folder.iterdir()) == ["broken.obj", "deeper", "rig.toml", "wall"]


def test_a_shown_folder_that_became_a_link_out_is_not_saved_to(hand: Hand, folder: Path) -> None:
    pick(hand, "deeper")
    (folder / "deeper").rename(folder / "old")
    (folder / "deeper").symlink_to(folder.parent)
    before = sorted(folder.parent.rglob("*"))
    for label in ("save", "save the rig", "screenshot", "export"):
        hand.pick(label)
        settle(hand)
        assert told(hand) == (
            "deeper: a folder to save in must be in the folder inside, and not a link to elsewhere;"
            " choose another",
            True,
        )
    assert sorted(folder.parent.rglob("*")) == before


# Save as.


def spell(hand: Hand, label: str, *keys: str) -> None:
    """Type a text by picking letters."""
    for each in (label, *keys, "OK"):
        hand.pick(each)


def test_a_scene_is_saved_under_a_name_of_picked_letters(hand: Hand, folder: Path) -> None:
    spell(hand, "save as", *"red-1")
    assert told(hand) == (f"saved {Path('red-1/scene.toml')} and red-1.npz", False)
    assert {"red-1", "red-1.npz"} <= set(rows_of(hand))
    assert hand.viewer.caption.startswith("autocolor - red-1 - ")
    hand.viewer.studio.recolor("low", object_color="#123456")
    hand.pick("save")
    assert read_scene(folder / "red-1").surfaces["low"].paint.object_color == (18, 52, 86)
    assert "boxes" not in rows_of(hand)
    # A free name is proposed, and taken by OK.
    spell(hand, "save as")
    assert hand.scene.name == "red-1-2"
    assert (folder / "red-1-2" / "scene.toml").exists()


def test_a_pasted_name_saves_nothing_before_return(hand: Hand, folder: Path) -> None:
    before = set(folder.iterdir())
    hand.viewer.session.clipboard = Clipboard(lambda _: True, lambda: "red car")
    hand.move(*hand.widget("save as").area[:2])
    hand.viewer.on_key("v", control=True)
    # Nor does a pick elsewhere.
    hand.pick("mesh up")
    assert hand.hint != "save as: red car_"
    assert set(folder.iterdir()) == before
    hand.move(*hand.widget("save as").area[:2])
    hand.viewer.on_key("v", control=True)
    hand.viewer.on_key("return")
    assert (folder / "red car" / "scene.toml").exists()


# Export.


def settle(hand: Hand) -> None:
    """Let everything happen that waits until nothing moves."""
    for _ in range(TICKS_TO_REST + 12):
        hand.viewer.on_tick()


def row_of(hand: Hand, label: str) -> Choice:
    row = next(each for each in hand.viewer.board.layout.rows if each.label == label)
    assert isinstance(row, Choice)
    return row


def test_an_image_is_exported_at_a_size_and_smoothness_and_never_over_a_file(
    hand: Hand, folder: Path
) -> None:
    assert row_of(hand, "size").names == ["640x480", "1920x1080", "3840x2160"]
    spell(hand, "other size", *"5x")
    assert told(hand)[1]
    assert row_of(hand, "size").present == "640x480"
    hand.pick("cancel")
    with allowing(0.001):
        hand.pick("export")
        settle(hand)
    assert told(hand)[1]
    assert not (folder / "boxes.png").exists()
    spell(hand, "other size", *"60x40")
    row_of(hand, "smoothness").choose("3")
    hand.pick("export")
    assert told(hand) == ("exporting boxes, 60x40, smoothness 3 ...", False)
    assert not (folder / "boxes.png").exists()
    settle(hand)
    assert told(hand) == ("saved boxes.png: 60x40, smoothness 3", False)
    save_image(folder / "expected.png", hand.scene, size=(60, 40), smooth=3)
    # The screen may be left at once.
    hand.pick("export")
    hand.turn_to("picture")
    for name in ("boxes.png", "boxes-2.png"):
        assert (folder / name).read_bytes() == (folder / "expected.png").read_bytes()


def test_every_camera_and_every_variant_is_exported(hand: Hand, folder: Path) -> None:
    studio = hand.viewer.studio
    row_of(hand, "size").choose("60x40")
    for label in ("every camera", "every variant"):
        hand.pick(label)
        assert told(hand)[1]
    for name, angle in (("front", 30), ("near/far", 20)):
        studio.view(field_of_view=angle)
        studio.save_view(name)
    studio.keep_variant("A")
    studio.recolor("low", object_color="#123456")
    hand.pick("every camera")
    assert told(hand) == ("exporting boxes-front, 60x40, smoothness 2, then 1 more ...", False)
    settle(hand)
    assert told(hand)[0] == "saved boxes-far.png, the last of 2: 60x40, smoothness 2"
    hand.pick("every variant")
    settle(hand)
    scenes = {
        "front": hand.scene.with_taken_view("front"),
        "far": hand.scene,
        "A": studio.variants["A"].scene,
    }
    for name, scene in scenes.items():
        exported = np.asarray(Image.open(folder / f"boxes-{name}.png"))
        assert np.array_equal(exported, image(scene, size=(60, 40)))


# Dates.


@pytest.mark.parametrize(
    ("then", "shown"),
    [
        (datetime(2026, 11, 24, 14, 5), "14:05"),
        (datetime(2026, 11, 24), "00:00"),
        (datetime(2026, 11, 23, 23, 59), "23 Nov"),
        (datetime(2026, 1, 1), "1 Jan"),
        (datetime(2025, 12, 31, 23, 59), "2025"),
        (datetime(2027, 1, 1), "2027"),
    ],
)
def test_a_date_is_short(then: datetime, shown: str) -> None:
    now = datetime(2026, 11, 24, 18, 30).timestamp()
    assert short_date(then.timestamp(), now) == shown
    assert len(shown) <= LONGEST_DATE


def test_rows_show_when_a_file_was_changed(hand: Hand, folder: Path) -> None:
    for name in ("rig.toml", "wall/scene.toml"):
        os.utime(folder / name, (0, datetime(2001, 6, 1).timestamp()))
    hand.pick("refresh")
    assert [rows_of(hand)[name].date for name in ("rig.toml", "wall", "deeper")] == ["2001", "2001", ""]


@pytest.mark.parametrize("letters", range(16, 20))
def test_a_long_name_is_whole_and_has_no_date_where_there_is_no_room(letters: int) -> None:
    row = FileRow("row", value="picture", shown="x" * letters, date="24 Nov").at(LEFT)
    ground, name, note = row.items(lit=False)
    assert not name.area.overlaps(note.area)
    assert ground.area.covers(name.area)
    assert ground.area.covers(note.area)
    assert note.area.width == CHARACTER * len("24 Nov picture" if letters <= 17 else "picture")


# Small pictures.


def point_at(hand: Hand, name: str) -> Mapping[str, Tile]:
    """Rest on a row; returns the tile of its larger picture, if there is one."""
    area = rows_of(hand)[name].area
    hand.move(area.left + 40, area.top + 8)
    settle(hand)
    return tiles_of(hand, "preview")


def test_recent_files_and_examples_have_small_pictures_in_borrowed_entries(folder: Path) -> None:
    for name in ("broken.obj", "wall/scene.toml", "wall"):
        note_file(folder / name)
    hand = hand_at(folder, "file")
    assert list(tiles_of(hand, "example")) == ["coupe", "bracket", "row", "pyramid"]
    assert list(tiles_of(hand)) == ["wall", "broken.obj"]
    settle(hand)
    tiles = [*tiles_of(hand).values(), *tiles_of(hand, "example").values()]
    assert [bool(tile.picture) for tile in tiles] == [True, False, True, True, True, True]
    assert all(WORK.covers(tile.area) for tile in tiles)
    assert not any(one.area.overlaps(other.area) for one, other in combinations(tiles, 2))
    ((first, colors),) = hand.viewer.board.content.loads
    assert 0 < first < first + len(colors) <= SCREENS.first


def test_the_file_under_the_pointer_has_a_larger_picture_in_place_of_the_examples(folder: Path) -> None:
    scene = wall_scene(name="wall")
    write_picture(folder / "wall.npz", scene, render(scene, (96, 48)))
    note_file(folder / "wall")
    hand = hand_at(folder, "file")
    tile = point_at(hand, "wall.npz")["wall.npz"]
    assert tile.picture is not None
    assert tile.frame.inset(1).covers(tile.picture.area)
    assert not tiles_of(hand, "example")
    left, top, right, bottom = tile.picture.area
    shown = hand.display.field()[top : bottom + 1, left : right + 1].astype(int)
    assert np.abs(shown - image(*read_picture(folder / "wall.npz"))).mean() < 3
    assert not point_at(hand, "deeper")
    assert tiles_of(hand, "example")


SIDE = round(MOST_POLYGONS**0.5) + 1

NOTES = {
    "wide.npz": ((6, 224), "700x20"),
    "tall.npz": ((168, 42), "100x400"),
    "small.npz": ((48, 96), "96x48"),
    "scene": ((168, 224), "1 polygons"),
    "mesh.obj": ((168, 224), "1 polygons"),
    "large": (None, "too large"),
    "damaged.npz": (None, "no picture"),
    "broken.obj": (None, "no picture"),
    "foreign.3mf": (None, "no picture"),
    "gone.obj": (None, "no picture"),
}
"""The lines and elements of the larger pictures of files, and the notes on them."""


def test_a_file_has_a_small_picture_or_says_why_not(tmp_path: Path) -> None:
    for name, (size, note) in NOTES.items():
        path, scene = tmp_path / name, wall_scene()
        if path.suffix == ".npz" and size:
            width, height = map(int, note.split("x"))
            write_picture(path, scene, render(scene, (width, height)))
        elif not path.suffix:
            write_scene(path, wall_scene(wall(SIDE, SIDE)) if name == "large" else scene)
        else:
            path.write_text("v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n" if size else "damaged")
    hand = hand_at(tmp_path, "file")
    (tmp_path / "gone.obj").unlink()
    shown = {}
    for name in NOTES:
        tile = point_at(hand, name)[name]
        area = tile.picture and tile.picture.area
        shown[name] = area and (area.height, area.width), tile.note
    assert shown == NOTES


def test_a_mesh_is_shown_as_it_will_be_opened_and_read_again_on_demand(hand: Hand, folder: Path) -> None:
    pick(hand, "deeper")
    name = "triangle.obj"
    before = point_at(hand, name)[name].picture
    hand.viewer.session.mesh_up = "y"
    assert point_at(hand, name)[name].picture != before
    hand.viewer.session.mesh_up = "z"
    (folder / "deeper" / name).write_text("damaged")
    assert point_at(hand, name)[name].picture == before
    hand.pick("refresh")
    assert point_at(hand, name)[name].picture is None


def test_an_example_is_opened_from_elsewhere_and_saved_to_new_files(hand: Hand, folder: Path) -> None:
    assert not hand.viewer.session.is_at_hand
    before = recent_files()
    pick(hand, "pyramid", "example")
    assert (hand.scene.name, told(hand)) == ("pyramid", ("opened pyramid; undo goes back", False))
    assert recent_files() == before
    hand.turn_to("file")
    hand.pick("save")
    assert hand.viewer.studio.file == folder / "pyramid" / "scene.toml"


def test_a_missing_library_of_materials_is_told(hand: Hand, folder: Path) -> None:
    mesh = "mtllib car.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl body\nf 1 2 3\nf 1 2 2\n"
    (folder / "deeper" / "car.obj").write_text(mesh)
    pick(hand, "deeper")
    pick(hand, "car.obj")
    problem = "no library defines material 'body'; default colors are used"
    repair = f"{problem}; copy 'car.mtl' to the folder of car.obj (and 1 more)"
    assert told(hand) == (f"{repair}; undo goes back", True)
    opened_first = History(*opened(Source(str(folder / "deeper" / "car.obj"))))
    assert Viewer(opened_first, Ramtek9300()).message.endswith(repair)


def test_a_session_that_was_not_closed_is_recovered_and_gone_back_from(hand: Hand, folder: Path) -> None:
    session, studio = hand.viewer.session, hand.viewer.studio
    session.autosave = Autosave()
    other, left = Studio(wall_scene(name="wall"), Ramtek9300()), Autosave()
    other.recolor("wall", object_color="red")
    left.update(other.history)
    left.leave()
    # The files of another session may be outside of the folder.
    hand.turn_to("picture")
    hand.turn_to("file")
    assert "recover" not in hand.labels
    session.is_at_hand = True
    studio.recolor("low", object_color="red")
    for name in ("wall", "boxes"):
        hand.turn_to("picture")
        hand.turn_to("file")
        hand.pick("recover")
        assert (session.screen, hand.scene.name, len(studio.history.to_undo)) == (PICTURE, name, 1)
        assert told(hand) == (f"{name} with all its steps; recover again goes back", False)
        hand.viewer.clear()
        assert hand.shows(hand.scene)
