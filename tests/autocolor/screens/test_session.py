from __future__ import annotations

import time
from pathlib import Path

import pytest
from PIL import Image

from autocolor import InputError, Light, OutputError, Studio, read_rig, write_rig, write_scene
from autocolor.files.state.recent import recent_files
from autocolor.scene.lights.links import Links
from autocolor.screens.session import MESSAGE_SECONDS, PICTURE, Session
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import wall_scene
from tests.autocolor.screens.boxes import KEY, boxes


@pytest.fixture
def session(tmp_path: Path) -> Session:
    display = Ramtek9300()
    return Session(Studio(boxes(), display), display, tmp_path)


def test_a_message_stands_for_some_seconds(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    session.tell("saved")
    assert (session.message, session.has_news) == ("saved", True)
    now += MESSAGE_SECONDS
    assert (session.message, session.has_news) == ("saved", False)
    session.tell("")
    assert not session.has_news


def test_a_message_that_stands_does_so_until_the_next_one(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    session.tell("welcome", stands=True)
    now += 100 * MESSAGE_SECONDS
    assert (session.message, session.has_news) == ("welcome", True)
    session.tell("saved")
    now += MESSAGE_SECONDS
    assert not session.has_news


@pytest.mark.parametrize(
    ("error", "shown"),
    [
        ("one", "one"),
        (InputError("one; two"), "one; two"),
        (InputError(["one", "two", "three"]), "one (and 2 more)"),
        (InputError([]), ""),
    ],
)
def test_an_error_is_one_sentence(session: Session, error: object, shown: str) -> None:
    session.warn(error)
    assert (session.message, session.news.is_warning) == (shown, True)


def test_a_message_is_one_line_that_can_be_printed(session: Session) -> None:
    session.tell("opened a\nb\x1b[31m \udcff\0.obj")
    assert session.message == "opened a?b?[31m ??.obj"


def test_what_is_chosen_is_always_there(session: Session) -> None:
    session.choose_light("fill")
    session.choose_surface("high")
    session.choose_surface("nowhere")
    assert (session.light_name, session.surface_name) == ("fill", "high")
    session.edit(session.scene.without_light("fill"))
    assert session.chosen_light is session.scene.light("key")
    session.edit(session.scene.without_light("key"))
    assert session.light_name == ""
    assert session.scene.lights == ()
    session.edit(wall_scene(lights=[]))
    assert session.chosen_surface is session.scene.surface("wall")


def test_a_word_of_the_display_tells_its_surface(session: Session) -> None:
    studio = session.studio
    for name, levels in studio.level_ranges.items():
        assert session.surface_of(levels.first) == session.surface_of(levels.last) == name
    assert session.surface_of(0) == session.surface_of(1023) == ""
    assert session.word_at(300, 240) == studio.words[240, 300]


def test_edits_of_the_same_step_are_undone_together(session: Session) -> None:
    before = session.scene
    session.change_light("key", intensity=2.0)
    assert session.same_step
    session.change_surface("low", diffuse=0.1)
    session.paint(object_color="#123456")
    session.undo()
    assert session.scene is before
    assert session.message == "undone"
    session.redo()
    assert session.scene.light("key").intensity == 2
    session.redo()
    assert session.message == "nothing to redo"


def test_an_edit_that_changes_nothing_begins_no_step(session: Session) -> None:
    session.edit(session.scene)
    assert not session.same_step


def test_one_light_alone_and_all(session: Session) -> None:
    session.light_alone("fill")
    assert [light.on for light in session.scene.lights] == [False, True]
    assert session.message == "light fill alone"
    session.same_step = False
    session.all_lights_on()
    assert all(light.on for light in session.scene.lights)
    assert session.message == "all lights on"


def test_the_world_knows_the_names_in_the_tables_as_they_are_now(session: Session) -> None:
    of = session.world.names.of
    for table in ("lights", "surfaces", "parts"):
        assert list(of(table)) == [row.name for row in vars(session.scene)[table]]
    session.edit(session.scene.with_new_light("another", position=(0, 0, 9)))
    assert of("lights")[-1] == "another"


def test_the_world_is_that_of_the_object(session: Session) -> None:
    assert session.world.low == (0, 0, 0)
    assert session.world.high == (1, 1, 1)
    assert session.world is session.world
    session.edit(wall_scene())
    assert session.world.low == (-1, 0, -1)


def test_a_scene_is_opened_and_is_recent(session: Session, tmp_path: Path) -> None:
    write_scene(tmp_path / "wall", wall_scene(name="wall"))
    before = session.scene
    session.open(tmp_path / "wall")
    assert session.scene.name == "wall"
    assert recent_files() == (tmp_path / "wall",)
    session.undo()
    assert session.scene is before


def test_a_rig_in_a_scene_file_of_any_other_name_is_put_on_the_scene(
    session: Session, tmp_path: Path
) -> None:
    lamp = Light("lamp", (0, -2, 0), aim=(0, 0, 0))
    write_rig(tmp_path / "lamps.TOML".lower(), wall_scene(lights=[lamp]))
    session.open(tmp_path / "lamps.toml")
    assert [light.name for light in session.scene.lights] == ["lamp"]
    assert session.scene.name == "boxes"
    assert recent_files() == ()


def test_a_rig_whose_lights_are_linked_to_what_is_not_there_is_put_on_the_scene_and_says_so(
    session: Session, tmp_path: Path
) -> None:
    lamp = Light("lamp", (0, -2, 1), links=Links(only_surfaces=("wall",)))
    write_rig(tmp_path / "lamps.toml", wall_scene(lights=[lamp]))
    session.open(tmp_path / "lamps.toml")
    assert session.scene.light("lamp").links == Links()
    assert session.message == (
        "the lights of lamps.toml, fitted to boxes, without links to what it lacks; undo goes back"
    )


def test_a_rig_that_is_broken_is_refused(session: Session, tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text("minimum = [0, 0, 0]\nmaximum = [1, 1]\n")
    before = session.scene
    with pytest.raises(InputError, match="maximum"):
        session.open(tmp_path / "rig.toml")
    assert session.scene is before


def test_saving_tells_the_names_and_notes_the_scene(session: Session, tmp_path: Path) -> None:
    session.edit(session.scene.with_light("key", intensity=2.0))
    session.save()
    assert session.message.startswith("saved")
    assert not session.studio.is_changed
    (recent,) = recent_files()
    assert recent.is_relative_to(tmp_path)


def test_rigs_and_images_get_free_names(session: Session, tmp_path: Path) -> None:
    for _ in range(2):
        session.save_rig()
        session.save_image()
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "boxes-2.png",
        "boxes-rig-2.toml",
        "boxes-rig.toml",
        "boxes.png",
    ]
    assert read_rig(tmp_path / "boxes-rig.toml").lights == (KEY, boxes().light("fill"))
    with Image.open(tmp_path / "boxes.png") as image:
        assert image.size == (640, 480)


def test_what_cannot_be_saved_is_refused(session: Session) -> None:
    session.folder = session.folder / "gone"
    for save in (session.save_rig, session.save_image):
        with pytest.raises(OutputError):
            save()


def test_a_pointer_is_from_elsewhere_unless_told(session: Session) -> None:
    assert not session.is_at_hand
    assert session.screen == PICTURE


def test_leaving_tells_first_what_it_would_lose(session: Session, tmp_path: Path) -> None:
    def asked() -> str:
        session.leave()
        assert not session.leaves
        return session.message.removesuffix(", or leave once more to discard the changes")

    session.edit(session.scene.replace(ambient=0.6))
    assert asked() == "not saved: save it"
    session.studio.keep_variant("dusk")
    session.undo()
    assert asked() == "variant dusk is not saved: come back to it and save it"
    session.studio.show_variant("dusk")
    session.save()
    assert session.unsaved == ""
    session.edit(session.scene.replace(ambient=0.8))
    write_scene(tmp_path / "other", boxes().replace(name="other"))
    session.open(tmp_path / "other")
    assert asked().endswith(" is not saved: undo goes back to it")
    session.leave()
    assert session.leaves
