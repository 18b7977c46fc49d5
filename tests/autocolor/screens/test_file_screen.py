from __future__ import annotations

import os
from datetime import datetime
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from autocolor import (
    Light,
    image,
    read_picture,
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
from autocolor.mapping.ranges import SCREENS
from autocolor.screens.file_actions import open_file
from autocolor.screens.file_screen import (
    FRAME,
    LEFT,
    LONGEST_DATE,
    MOST_ROWS,
    RIGHT,
    THUMBNAIL,
    TICKS_TO_EXPORT,
    FileRow,
    date_of,
    short_date,
)
from autocolor.screens.session import PICTURE, Clipboard
from autocolor.widgets.items import Area
from autocolor.widgets.widget import Choice
from tests.autocolor.screens.boxes import hand_at, hint_of, told, undo
from tests.autocolor.screens.hand import Hand
from tests.small import LYING, wall_scene
from tests.tables import first


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


def rows_of(hand: Hand, recent: bool = False) -> dict[str, FileRow]:
    """The rows of files, by the names that are shown."""
    column = RIGHT if recent else LEFT
    rows = hand.viewer.board.content.widgets
    return {row.shown: row for row in rows if isinstance(row, FileRow) and column.covers(row.area)}


def pick(hand: Hand, name: str, recent: bool = False) -> None:
    area = rows_of(hand, recent)[name].area
    hand.click(area.left + 40, area.top + 8)


def test_a_file_is_opened_by_a_click_and_undo_brings_the_scene_back(hand: Hand) -> None:
    before = hand.scene
    pick(hand, "wall")
    assert hand.scene.name == "wall"
    assert told(hand) == ("opened wall; undo goes back", False)
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


def test_a_rig_is_put_on_the_scene_and_fitted(hand: Hand) -> None:
    before = hand.scene
    pick(hand, "rig.toml")
    (lamp,) = hand.scene.lights
    assert hand.scene.mesh is before.mesh
    # The wall is 2 x 0 x 2 around the origin, the cube 1 x 1 x 1 around its middle.
    scale = (3 / 8) ** 0.5
    assert lamp.position == pytest.approx((0.5, 0.5 - 2 * scale, 0.5))
    assert lamp.aim == pytest.approx((0.5, 0.5, 0.5))
    assert told(hand) == ("the lights of rig.toml, fitted to boxes; undo goes back", False)
    hand.open_menu()
    undo(hand)
    assert hand.scene is before


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
    assert list(rows_of(hand, recent=True)) == ["wall/scene.toml"]
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
    assert list(rows_of(hand, recent=True)) == ["outside"]
    pick(hand, "..")
    assert {"inside", "outside"} <= set(rows_of(hand))
    hand.pick("save the rig")
    assert (folder.parent / "boxes-rig.toml").exists()
    pick(hand, "outside", recent=True)
    assert hand.scene.name == "outside"


@pytest.mark.parametrize("number", [MOST_ROWS, MOST_ROWS + 1])
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
        assert "page" in [row.label for row in hand.viewer.board.content.widgets]


def test_the_up_axis_and_the_scale_of_a_mesh_are_chosen_before_it_is_opened(hand: Hand, folder: Path) -> None:
    row = next(each for each in hand.viewer.board.layout.rows if each.label == "mesh up")
    # From z to x and y.
    for _ in range(2):
        hand.click(row.area.right - 8, row.area.top + 8)
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
    assert rows_of(hand, recent=True)
    for label, message in (
        ("save the rig", "saved boxes-rig.toml"),
        ("screenshot", f"saved {Path('inside/deeper/autocolor-0001.png')}"),
        ("export", "exporting 640x480, smoothness 2 ..."),
    ):
        hand.pick(label)
        assert told(hand) == (message, False)
    settle(hand)
    assert {"boxes", "boxes-rig.toml"} <= set(rows_of(hand))
    assert sorted(path.name for path in (folder / "deeper").iterdir()) == [
        "autocolor-0001.png",
        "boxes",
        "boxes-rig.toml",
        "boxes.npz",
        "boxes.png",
        "triangle.obj",
    ]
    assert sorted(path.name for path in folder.iterdir()) == ["broken.obj", "deeper", "rig.toml", "wall"]
    assert hint_of(hand, "save").startswith(
        "Save to boxes/scene.toml and boxes.npz; new files go to inside/deeper"
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


def save_as(hand: Hand, *keys: str) -> None:
    """Type a name for the scene by picking letters."""
    hand.pick("save as")
    for key in (*keys, "OK"):
        hand.pick(key)


def test_a_scene_is_saved_under_a_name_of_picked_letters(hand: Hand, folder: Path) -> None:
    save_as(hand, *"red-1")
    assert told(hand) == (f"saved {Path('red-1/scene.toml')} and red-1.npz", False)
    assert {"red-1", "red-1.npz"} <= set(rows_of(hand))
    assert hand.viewer.caption.startswith("autocolor - red-1 - ")
    hand.viewer.studio.recolor("low", object_color="#123456")
    hand.pick("save")
    assert read_scene(folder / "red-1").surfaces["low"].paint.object_color == (18, 52, 86)
    assert "boxes" not in rows_of(hand)
    # A free name is proposed, and taken by OK.
    save_as(hand)
    assert hand.scene.name == "red-1-2"
    assert (folder / "red-1-2" / "scene.toml").exists()


def test_a_pasted_name_saves_nothing_before_return(hand: Hand, folder: Path) -> None:
    before = set(folder.iterdir())
    hand.viewer.session.clipboard = Clipboard(lambda _: True, lambda: "red car")
    hand.move(*hand.widget("save as").area[:2])
    hand.viewer.on_key("v", control=True)
    assert hand.hint == "save as: red car_"
    assert set(folder.iterdir()) == before
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
    for _ in range(TICKS_TO_EXPORT + 1):
        hand.viewer.on_tick()


def row_of(hand: Hand, label: str) -> Choice:
    row = next(each for each in hand.viewer.board.layout.rows if each.label == label)
    assert isinstance(row, Choice)
    return row


def test_an_image_is_exported_as_a_display_shows_it_and_never_over_a_file(hand: Hand, folder: Path) -> None:
    row_of(hand, "smoothness").choose("1")
    hand.pick("export")
    assert told(hand) == ("exporting 640x480, smoothness 1 ...", False)
    assert not (folder / "boxes.png").exists()
    settle(hand)
    assert told(hand) == ("saved boxes.png: 640x480, smoothness 1", False)
    scene = hand.scene
    assert (np.asarray(Image.open(folder / "boxes.png")) == image(scene, smooth=1)).all()
    before = (folder / "boxes.png").read_bytes()
    # The screen may be left at once.
    hand.pick("export")
    hand.turn_to("picture")
    assert (folder / "boxes-2.png").exists()
    assert (folder / "boxes.png").read_bytes() == before


def test_an_image_is_exported_at_another_size_and_smoothness(hand: Hand, folder: Path) -> None:
    hand.pick("other size")
    for key in ("5", "x", "OK"):
        hand.pick(key)
    assert told(hand)[1]
    assert row_of(hand, "size").present == "640x480"
    hand.pick("cancel")
    with allowing(0.001):
        hand.pick("export")
        settle(hand)
    assert told(hand)[1]
    assert not (folder / "boxes.png").exists()
    hand.pick("other size")
    for key in (*"60x40", "OK"):
        hand.pick(key)
    assert row_of(hand, "size").present == "60x40"
    assert row_of(hand, "size").names == ["60x40", "640x480", "1280x960", "2560x1920"]
    row_of(hand, "smoothness").choose("3")
    hand.pick("export")
    settle(hand)
    assert told(hand) == ("saved boxes.png: 60x40, smoothness 3", False)
    scene = hand.scene
    save_image(folder / "expected.png", scene, size=(60, 40), smooth=3)
    assert (folder / "boxes.png").read_bytes() == (folder / "expected.png").read_bytes()


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
    for name in ("broken.obj", "rig.toml", "wall/scene.toml"):
        os.utime(folder / name, (0, datetime(2001, 6, 1).timestamp()))
    hand.pick("refresh")
    rows = rows_of(hand)
    assert {name: row.date for name, row in rows.items()} == {
        "broken.obj": "2001",
        "rig.toml": "2001",
        "wall": "2001",
        "deeper": "",
    }
    assert dates_in(rows["wall"]) == 1
    assert dates_in(rows["deeper"]) == 0
    assert date_of(folder / "gone.obj", "mesh") == ""


def dates_in(row: FileRow) -> int:
    """How many texts a row has beside its name and its kind."""
    return len(row.items(lit=False)) - 3


# Small pictures.


def point_at(hand: Hand, name: str, recent: bool = False) -> None:
    area = rows_of(hand, recent)[name].area
    hand.move(area.left + 40, area.top + 8)


def small_picture(hand: Hand) -> Area | None:
    """The area of the small picture; None without borrowed entries."""
    content = hand.viewer.board.content
    return content.items[-1].area if content.loads else None


@pytest.mark.parametrize("recent", first(1, [True, False]))
def test_the_picture_of_the_file_under_the_pointer_is_shown_in_borrowed_entries(
    folder: Path, recent: bool
) -> None:
    scene = wall_scene(name="wall")
    write_picture(folder / "wall.npz", scene, render(scene, (96, 48)))
    (folder / "damaged.npz").write_bytes((folder / "wall.npz").read_bytes()[:2000])
    note_file(folder / "wall.npz")
    hand = hand_at(folder, "file")
    point_at(hand, "wall.npz", recent)
    assert small_picture(hand) is None
    settle(hand)
    area = small_picture(hand)
    assert area is not None
    assert (area.width, area.height) == (96, 48)
    assert THUMBNAIL.covers(area)
    saved = read_picture(folder / "wall.npz")
    shown = hand.display.field()[area.top : area.bottom + 1, area.left : area.right + 1]
    errors = np.abs(shown.astype(int) - image(saved.scene, saved.picture).astype(int))
    assert errors.max() <= 2
    # On another row the entries are those of the scene again.
    for name in ("wall", "damaged.npz"):
        point_at(hand, name)
        settle(hand)
        assert small_picture(hand) is None
    assert np.array_equal(hand.display.entries, hand.viewer.studio.entries)
    # What could not be read is not read at every tick, but once the folder is read again.
    (folder / "damaged.npz").write_bytes((folder / "wall.npz").read_bytes())
    settle(hand)
    assert small_picture(hand) is None
    hand.pick("refresh")
    point_at(hand, "damaged.npz")
    settle(hand)
    assert small_picture(hand) is not None


@pytest.mark.parametrize(("lines", "elements"), [(400, 100), (20, 700)])
def test_a_small_picture_of_any_shape_is_in_its_place(folder: Path, lines: int, elements: int) -> None:
    scene = wall_scene(name="wall")
    write_picture(folder / "wall.npz", scene, render(scene, (elements, lines)))
    hand = hand_at(folder, "file")
    point_at(hand, "wall.npz")
    settle(hand)
    ((first, colors),) = hand.viewer.board.content.loads
    assert first > 0
    assert first + len(colors) <= SCREENS.first
    area = small_picture(hand)
    assert area is not None
    assert THUMBNAIL.inset(FRAME).covers(area)
    assert area.width / area.height == pytest.approx(elements / lines, rel=0.2)


@pytest.mark.parametrize("letters", range(16, 20))
def test_a_long_name_is_whole_and_has_no_date_where_there_is_no_room(letters: int) -> None:
    row = FileRow("row", value="picture", shown="x" * letters, date="24 Nov").at(
        LEFT._replace(bottom=LEFT.top + 15)
    )
    ground, *texts = row.items(lit=False)
    assert not any(one.area.overlaps(other.area) for one, other in combinations(texts, 2))
    assert all(ground.area.covers(each.area) for each in texts)
    assert dates_in(row) == (letters <= 17)
