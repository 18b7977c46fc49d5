from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from autocolor import (
    HalfSpace,
    InputError,
    Light,
    OutputError,
    Scene,
    Studio,
    read_rig,
    read_scene,
    write_rig,
    write_scene,
)
from autocolor.files.paths import SCENE_FILE
from autocolor.files.state import recent_files
from autocolor.files.store.store_file import write_store
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from autocolor.mapping.display_image import DisplayImage
from autocolor.scene.lights import Links
from autocolor.screens.session import (
    BEFORE,
    LEAST_SECONDS,
    MESSAGE_SECONDS,
    NOW,
    PICTURE,
    SECONDS_BETWEEN,
    Session,
)
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300, RamtekError
from tests.autocolor.files.store.stores import run, small_scene
from tests.autocolor.screens.ball import MIDDLE, ball_scene, hand_before, seen_on
from tests.autocolor.screens.hand import Hand
from tests.autocolor.screens.test_viewer import control, is_true_to
from tests.small import KEY, boxes, wall_scene


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


def test_a_persistent_message_stays_until_the_next_message(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    session.tell("welcome", persistent=True)
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
    assert session.message == r"opened a\nb\x1b[31m \udcff\x00.obj"


def test_a_chosen_surface_or_light_is_always_in_the_scene(session: Session) -> None:
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
    assert session.message.startswith("undone: ")
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
    assert session.message == "light fill alone; again: the lights as before"
    session.same_step = False
    session.all_lights_on()
    assert all(light.on for light in session.scene.lights)
    assert session.message == "all lights on"


def test_a_light_that_is_alone_gives_the_switches_of_all_lights_back(session: Session) -> None:
    def switches() -> list[bool]:
        session.same_step = False
        return [light.on for light in session.scene.lights]

    session.edit(session.scene.with_light("key", on=False).with_new_light("rim", position=(0, 0, 9)))
    before = switches()
    assert (before, session.solo) == ([False, True, True], "")
    session.light_alone("key")
    assert (switches(), session.solo) == ([True, False, False], "key")
    # Alone with another light, and back to the switches before both.
    session.light_alone("rim")
    assert (switches(), session.solo) == ([False, False, True], "rim")
    session.light_alone("rim")
    assert (switches(), session.solo) == (before, "")
    assert session.message == "the lights are switched as before"
    session.undo()
    assert session.solo == "rim"
    session.light_alone("rim")
    assert switches() == before


def test_a_light_is_no_longer_alone_when_another_is_switched_on(session: Session) -> None:
    session.light_alone("key")
    session.change_light("fill", on=True)
    assert session.solo == ""
    session.change_light("key", on=False)
    session.light_alone("key")
    session.light_alone("key")
    assert [light.on for light in session.scene.lights] == [False, True]


def test_the_world_knows_the_names_in_the_tables_as_they_are_now(session: Session) -> None:
    of = session.world.names.of
    for table in ("lights", "surfaces", "parts"):
        assert list(of(table)) == [row.name for row in vars(session.scene)[table]]
    session.edit(session.scene.with_new_light("another", position=(0, 0, 9)))
    assert of("lights")[-1] == "another"


def test_the_world_has_the_bounds_of_the_object(session: Session) -> None:
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


def test_a_rig_loses_links_to_absent_rows_and_says_so(session: Session, tmp_path: Path) -> None:
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
        "autocolor-0001.png",
        "autocolor-0002.png",
        "boxes-rig-2.toml",
        "boxes-rig.toml",
    ]
    assert read_rig(tmp_path / "boxes-rig.toml").lights == (KEY, boxes().light("fill"))
    with Image.open(tmp_path / "autocolor-0001.png") as image:
        assert image.size == (640, 480)


def test_saving_into_an_unwritable_place_is_refused(session: Session) -> None:
    session.folder = session.folder / "gone"
    for save, error in ((session.save_rig, OutputError), (session.save_image, RamtekError)):
        with pytest.raises(error, match="there is no folder"):
            save()


def test_a_pointer_is_from_elsewhere_by_default(session: Session) -> None:
    assert not session.is_at_hand
    assert session.screen == PICTURE


def test_leaving_first_names_the_changes_that_it_would_lose(session: Session, tmp_path: Path) -> None:
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


PLACE = 335, 205
"""An element and line of the ball to which the highlight is put."""


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    """A hand that has dragged the highlight."""
    hand = hand_before(ball_scene(), tmp_path)
    hand.drag(hand.handle("highlight of key"), PLACE)
    return hand


def alone(scene: Scene) -> tuple[bytes, bytes]:
    """The words and the entries of a scene by itself."""
    display = Ramtek9300()
    Studio(scene, display)
    return display.words.tobytes(), display.entries.tobytes()


def shown(hand: Hand) -> tuple[bytes, bytes]:
    """The words and the entries of the picture, without a menu and a message over it."""
    hand.move(*MIDDLE)
    hand.viewer.tell("")
    return seen_on(hand)


def press(hand: Hand) -> None:
    hand.viewer.on_key("b", typed="b")


def release(hand: Hand) -> None:
    hand.viewer.on_release("b")


def switch(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("compare")


def test_the_state_before_is_shown_while_the_key_is_held(hand: Hand) -> None:
    now = shown(hand)
    for _ in range(2):
        press(hand)
        hand.viewer.on_key("b", typed="b", repeated=True)
        assert hand.viewer.message.startswith(f"shown: {BEFORE}; now: ")
        assert shown(hand) == alone(ball_scene())
        assert hand.viewer.studio.scene is not hand.viewer.studio.history.to_undo[-1]
        release(hand)
        assert hand.viewer.message == f"shown: {NOW}"
        assert shown(hand) == now
    assert now == alone(hand.viewer.studio.scene)


@pytest.mark.parametrize("by_key", [True, False])
def test_after_undo_the_pointer_names_the_surface_below_it_again(
    hand: Hand, by_key: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand.open_menu()
    hand.viewer.on_key("tab")
    hand.move(320, 240)
    if by_key:
        hand.viewer.on_key("z", control=True)
    else:
        hand.pick(" ", 0.1)
    board, now = hand.viewer.board, time.monotonic()
    assert board.messages[0].text.startswith("undone: key: position")
    hand.move(325, 245)
    monkeypatch.setattr("time.monotonic", lambda: now + LEAST_SECONDS)
    hand.viewer.on_tick()
    studio = hand.viewer.studio
    level = studio.words[245, 325] - studio.level_ranges["paint"].first
    assert board.messages[0].text.startswith(f"ball - paint, level {level} of ")


def test_a_comparison_says_how_the_present_state_differs(hand: Hand) -> None:
    press(hand)
    assert hand.viewer.message == f"shown: {BEFORE}; now: key: position, aim"
    release(hand)
    hand.viewer.studio.keep_variant("A")
    hand.open_menu()
    hand.pick("variants")
    hand.pick("compare")
    assert hand.viewer.message == "shown: variant A; now the same"


def test_each_pick_of_the_row_shows_the_other_state(hand: Hand) -> None:
    now = shown(hand)
    switch(hand)
    assert hand.viewer.message.startswith(f"shown: {BEFORE}; now: ")
    assert shown(hand) == alone(ball_scene())
    switch(hand)
    assert hand.viewer.message == f"shown: {NOW}"
    assert shown(hand) == now


def test_a_pick_in_the_picture_shows_the_present_state_and_does_nothing_else(hand: Hand) -> None:
    now, surface = shown(hand), hand.viewer.session.surface_name
    switch(hand)
    hand.click(320, 430)
    assert hand.viewer.message == f"shown: {NOW}"
    assert shown(hand) == now
    assert hand.viewer.session.surface_name == surface
    hand.click(320, 430)
    assert hand.viewer.session.surface_name != surface


def undo(hand: Hand) -> None:
    hand.open_menu()
    hand.pick(" ", 0.1)


def undo_and_redo(hand: Hand) -> None:
    undo(hand)
    hand.pick(" ", 0.9)


def switch_a_light(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("fill", 0.95)


def go_to_the_mapping_and_back(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("mapping")
    hand.pick("< picture")


def recolor(hand: Hand) -> None:
    hand.viewer.on_key("c", typed="c")


def watch(hand: Hand) -> None:
    hand.viewer.on_key("w", typed="w")
    hand.viewer.on_key("escape")


ENDINGS: dict[str, Callable[[Hand], None]] = {
    "a drag over the picture": lambda hand: hand.drag((60, 60), (90, 60)),
    "a drag where the highlight is": lambda hand: hand.drag(PLACE, (300, 200)),
    "a switch": switch_a_light,
    "an undo": undo,
    "an undo with a redo": undo_and_redo,
    "a key": recolor,
    "another screen": go_to_the_mapping_and_back,
    "watching": watch,
}


@pytest.mark.parametrize("name", ENDINGS)
def test_whatever_is_done_meanwhile_is_done_with_the_present_state(hand: Hand, name: str) -> None:
    switch(hand)
    ENDINGS[name](hand)
    assert not hand.viewer.session.comparing.is_on
    assert shown(hand) == alone(hand.viewer.studio.scene)


def test_handles_and_marks_of_the_present_light_are_not_there_meanwhile(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("lights")
    assert hand.viewer.board.screen.handles()
    press(hand)
    assert not hand.viewer.board.screen.handles()
    assert not hand.viewer.board.screen.items()


def test_where_colors_alone_differ_no_word_does(hand: Hand) -> None:
    hand.viewer.on_key("c", typed="c")
    press(hand)
    image = hand.viewer.session.comparing.image
    assert image is not None
    assert image.words is hand.viewer.studio.words
    assert (image.entries != hand.viewer.studio.entries).any()


def test_the_image_of_another_state_is_computed_once(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    computed: list[Scene] = []
    image_of = Studio.image_of

    def counted(studio: Studio, scene: Scene) -> DisplayImage:
        computed.append(scene)
        return image_of(studio, scene)

    monkeypatch.setattr(Studio, "image_of", counted)
    for _ in range(3):
        press(hand)
        release(hand)
    assert len(computed) == 1
    hand.viewer.on_key("c", typed="c")
    press(hand)
    assert computed == list(hand.viewer.studio.history.to_undo)


def test_without_a_step_there_is_nothing_to_compare_with(tmp_path: Path) -> None:
    hand = hand_before(ball_scene(), tmp_path)
    switch(hand)
    assert hand.viewer.message == "compare: there is no step to undo"
    press(hand)
    assert hand.viewer.message == (
        "to compare, there must be a step to undo or a kept variant; edit something first"
    )
    assert not hand.viewer.session.comparing.is_on


def test_over_a_screen_without_the_picture_the_picture_comes(hand: Hand) -> None:
    hand.viewer.on_key("f1")
    press(hand)
    assert hand.viewer.page == "picture"
    assert shown(hand) == alone(ball_scene())


def test_the_message_stands_as_long_as_the_other_state_does(hand: Hand) -> None:
    press(hand)
    session = hand.viewer.session
    session.news = session.news._replace(shown_at=session.news.shown_at - 60)
    assert session.has_news
    session.comparing.end()
    assert not session.has_news


# Kept variants.


def go_to_kept(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("variants")


@pytest.fixture
def kept(hand: Hand) -> Hand:
    """A hand that has kept a variant, and then made two steps."""
    go_to_kept(hand)
    hand.pick("keep")
    hand.pick("< picture")
    hand.drag((60, 60), (90, 60))
    switch_a_light(hand)
    return hand


def test_a_variant_is_compared_until_comparing_ends(kept: Hand) -> None:
    hand, now = kept, shown(kept)
    variant = hand.viewer.studio.variants["A"].scene
    go_to_kept(hand)
    hand.pick("compare")
    assert hand.viewer.page == "picture"
    assert hand.viewer.message.startswith("shown: variant A; now: ")
    assert shown(hand) == alone(variant)
    switch(hand)
    assert shown(hand) == now
    press(hand)
    assert shown(hand) == alone(variant)
    release(hand)
    go_to_kept(hand)
    hand.pick("compare", 0.9)
    assert hand.viewer.message == f"compared from now on: {BEFORE}"
    hand.pick("< picture")
    press(hand)
    assert shown(hand) == alone(hand.viewer.studio.history.to_undo[-1])


def test_a_variant_that_was_dropped_is_compared_no_longer(kept: Hand) -> None:
    hand = kept
    go_to_kept(hand)
    hand.pick("compare")
    go_to_kept(hand)
    hand.pick("drop")
    hand.pick("< picture")
    press(hand)
    assert hand.viewer.message.startswith(f"shown: {BEFORE}; now: ")


BRIGHTER = "UPDATE lights SET intensity = 3 WHERE name = 'key'"


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "small.sqlite"
    write_store(path, small_scene())
    return path


def viewer_of(path: Path) -> Viewer:
    """A viewer of the scene of a file, as `autocolor view` shows it."""
    place = place_of(Source(str(path)))
    return Viewer(History(read_scene(path), place), Ramtek9300(), folder=path.parent)


def tick(viewer: Viewer) -> None:
    """Let the window come to its next look at the file."""
    viewer.session.disk._looked_at -= SECONDS_BETWEEN
    viewer.on_tick()


def test_a_change_of_another_program_is_shown_as_one_step_to_undo(store: Path) -> None:
    viewer = viewer_of(store)
    before = viewer.studio.scene
    tick(viewer)
    assert viewer.message.startswith("F1")
    run(store, BRIGHTER, "UPDATE scene SET background = '#102030'")
    viewer.on_tick()
    assert viewer.studio.scene is before
    tick(viewer)
    assert viewer.studio.scene.light("key").intensity == 3
    assert viewer.message == "small.sqlite was changed elsewhere; undo goes back"
    assert is_true_to(viewer, read_scene(store))
    assert not viewer.studio.is_changed
    control(viewer, "z")
    assert viewer.studio.scene is before
    tick(viewer)
    assert viewer.studio.scene is before


def test_a_change_of_another_program_lets_go_of_a_picked_handle(tmp_path: Path) -> None:
    write_scene(tmp_path / "ball", ball_scene())
    hand = Hand(viewer_of(tmp_path / "ball"))
    hand.click(*hand.handle("highlight of key"))
    assert hand.viewer.board.held
    tick(hand.viewer)
    assert hand.viewer.board.held
    file = tmp_path / "ball" / SCENE_FILE
    file.write_text(file.read_text().replace('"key"', '"main"'))
    tick(hand.viewer)
    assert "changed elsewhere" in hand.viewer.message
    hand.click(*MIDDLE)
    assert hand.viewer.message.startswith("ball - paint, ")


def test_a_change_of_lights_reuses_the_visible_points_of_the_mesh(store: Path) -> None:
    viewer = viewer_of(store)
    mesh = viewer.studio.scene.mesh
    run(store, BRIGHTER)
    tick(viewer)
    assert viewer.studio.scene.mesh is mesh
    run(store, "UPDATE nodes SET z = 0.5 WHERE node = 5")
    tick(viewer)
    assert viewer.studio.scene.mesh.coordinates[4, 2] == 0.5


def test_with_unsaved_edits_the_user_is_asked(store: Path) -> None:
    viewer = viewer_of(store)
    viewer.studio.light("rim", intensity=0.25)
    mine = viewer.studio.scene
    run(store, BRIGHTER)
    tick(viewer)
    assert viewer.studio.scene is mine
    assert (
        viewer.message == "small.sqlite was changed elsewhere: Ctrl+R shows that, Ctrl+S saves yours beside"
    )
    control(viewer, "r")
    assert viewer.studio.scene.light("key").intensity == 3
    assert viewer.message == "read again; undo goes back"
    control(viewer, "z")
    assert viewer.studio.scene is mine


def test_undone_to_before_a_reload_the_scene_is_not_the_saved_one_and_closing_asks(tmp_path: Path) -> None:
    write_scene(tmp_path / "small", small_scene())
    viewer = viewer_of(tmp_path / "small")
    viewer.studio.recolor("body", blend=0.1)
    control(viewer, "r")
    for blend in (0.2, 0.3):
        viewer.studio.recolor("body", blend=blend)
    control(viewer, "s")
    assert "*" not in viewer.caption
    for _ in range(4):
        control(viewer, "z")
    assert viewer.caption.startswith("autocolor - small* - ")
    assert not viewer.on_close()
    control(viewer, "s")
    assert viewer.on_close()


def test_edits_that_are_saved_instead_leave_the_change_of_the_other_program(store: Path) -> None:
    viewer = viewer_of(store)
    viewer.studio.light("rim", intensity=0.25)
    run(store, BRIGHTER)
    tick(viewer)
    control(viewer, "s")
    assert "small.sqlite was changed since, and is left alone" in viewer.message
    assert read_scene(store).light("key").intensity == 3
    assert read_scene(store.parent / "small").light("rim").intensity == 0.25


def test_ctrl_s_saves_to_the_store_and_that_is_no_change_of_another(store: Path) -> None:
    viewer = viewer_of(store)
    run(store, "CREATE TABLE notes (text)")
    tick(viewer)
    viewer = viewer_of(store)
    viewer.studio.light("rim", intensity=0.25)
    control(viewer, "s")
    assert viewer.message.startswith("saved small.sqlite and small.npz")
    assert read_scene(store).light("rim").intensity == 0.25
    assert run(store, "SELECT count(*) FROM notes") == [(0,)]
    scene = viewer.studio.scene
    tick(viewer)
    assert viewer.studio.scene is scene
    assert viewer.message.startswith("saved")
    run(store, BRIGHTER)
    tick(viewer)
    assert viewer.studio.scene.light("key").intensity == 3


def test_an_error_in_the_store_shows_a_message_and_the_scene_stays(store: Path) -> None:
    viewer = viewer_of(store)
    before = viewer.studio.scene
    run(store, "UPDATE polygons SET node3 = 40 WHERE polygon = 2")
    tick(viewer)
    assert viewer.studio.scene is before
    assert viewer.message.startswith(
        "not shown: small.sqlite: polygons, row 2: node 40 is not in the node table"
    )
    message = viewer.session.news
    tick(viewer)
    assert viewer.session.news is message
    run(store, "UPDATE polygons SET node3 = 3 WHERE polygon = 2")
    tick(viewer)
    assert viewer.studio.scene.mesh.node_numbers[1].tolist() == [0, 1, 2, 2]


def test_a_scene_file_is_looked_at_as_well(tmp_path: Path) -> None:
    folder = tmp_path / "small"
    write_scene(folder, small_scene().replace(mesh=small_scene().mesh.with_scalars()))
    viewer = viewer_of(folder)
    file = folder / "scene.toml"
    file.write_text(file.read_text() + '\n[[lights]]\nname = "third"\nposition = [1, 2, 3]\n')
    tick(viewer)
    assert [light.name for light in viewer.studio.scene.lights] == ["key", "rim", "third"]
    correct = file.read_text()
    file.write_text("[[mesh]\n")
    tick(viewer)
    assert viewer.message.startswith("not shown: scene.toml")
    assert len(viewer.studio.scene.lights) == 3
    file.write_text(correct)
    tick(viewer)
    assert viewer.message == "scene.toml holds this scene again"


def test_a_file_that_only_looks_changed_is_no_step(store: Path) -> None:
    viewer = viewer_of(store)
    run(store, "CREATE TABLE notes (text)")
    before, news = viewer.studio.scene, viewer.session.news
    tick(viewer)
    assert viewer.studio.scene is before
    assert viewer.session.news is news
    assert viewer.studio.undo() is False


def test_a_scene_in_no_file_has_nothing_to_read_again(tmp_path: Path) -> None:
    viewer = Viewer(small_scene(), Ramtek9300(), folder=tmp_path)
    tick(viewer)
    control(viewer, "r")
    assert viewer.message == "the scene must be in a file to be read again, and it is in none; save it"


def test_a_look_takes_no_time(store: Path) -> None:
    viewer = viewer_of(store)
    disk = viewer.session.disk
    seconds = []
    for _ in range(20):
        disk._looked_at -= SECONDS_BETWEEN
        begun = time.process_time()
        disk.was_changed()
        seconds.append(time.process_time() - begun)
    assert np.median(seconds) < 0.002


# An edit of a light that changes nothing that is seen.

AUTOMATIC = "no change: automatic exposure maps the brightest to the highest level; "
ALONE = boxes().only_lights("key").replace(ambient=0)
UNSEEN: dict[str, tuple[Scene, Callable[[Scene], Scene], str]] = {
    "brighter": (ALONE, lambda scene: scene.with_light("key", intensity=2), f"{AUTOMATIC}E holds all"),
    "off": (ALONE, lambda scene: scene.with_light("fill", intensity=2), "no change: light fill is off"),
    "without intensity": (
        boxes().with_light("fill", intensity=0),
        lambda scene: scene.with_light("fill", position=(0, -5, 0)),
        "no change: light fill has the intensity 0",
    ),
    "behind": (
        boxes().with_light("fill", position=(0.5, 9, 0.5)),
        lambda scene: scene.with_light("fill", on=False),
        "no change: light fill shines on nothing that is seen",
    ),
    "two off": (
        ALONE.only_lights(),
        lambda scene: scene.replace(lights=[light.replace(intensity=3) for light in scene.lights]),
        "no change: every edited light is off",
    ),
    "as bright": (
        ALONE.replace(exposure={"object": (0, 1000)}),
        lambda scene: scene.with_light("key", intensity=1.000001),
        "no change: no point that is seen gets another level",
    ),
    "brighter, with words for normals": (
        ball_scene().only_lights("fill").replace(ambient=0, words="normals"),
        lambda scene: scene.with_light("fill", intensity=2),
        f"{AUTOMATIC}E holds all",
    ),
    "added": (
        boxes(),
        lambda scene: scene.with_new_light("far", position=(0.5, 9, 0.5)),
        "no change: light far shines on nothing that is seen",
    ),
}


@pytest.mark.parametrize("case", UNSEEN)
def test_an_edit_of_a_light_that_changes_nothing_says_why(tmp_path: Path, case: str) -> None:
    scene, edit, message = UNSEEN[case]
    viewer = Viewer(scene, Ramtek9300(), tmp_path)
    viewer.session.has_keyboard = True
    viewer.session.edit(edit(viewer.studio.scene))
    viewer.on_tick()
    assert (viewer.message, viewer.session.news.is_warning) == (message, True)
    viewer.tell("")
    viewer.on_tick()
    assert viewer.message == ""


SEEN: dict[str, Callable[[Scene], Scene]] = {
    "a light moved": lambda scene: scene.with_light("key", position=(-2, -3, 4)),
    "a light removed": lambda scene: scene.without_light("fill"),
    "no light": lambda scene: scene.with_surface("low", blend=0.123),
    "a light and the view": lambda scene: scene.with_light("fill", intensity=2).with_saved_view(),
    "the name": lambda scene: scene.replace(name="other"),
    "a light renamed": lambda scene: scene.with_light("key", name="main"),
    "a light follows": lambda scene: scene.with_light_following("key", "eye"),
    "a light copied that is off": lambda scene: scene.with_copied_light("fill"),
    "a half-space carried": lambda scene: scene.with_light("fill", half_spaces={"cut": {"carried": True}}),
}


@pytest.mark.parametrize("case", SEEN)
def test_other_edits_do_not_say_that_nothing_changed(tmp_path: Path, case: str) -> None:
    plane = HalfSpace("cut", point=(0, 0, -9), direction=(0, 0, 1))
    scene = ALONE.with_light("fill", half_spaces=[plane])
    viewer = Viewer(scene, Ramtek9300(), tmp_path)
    viewer.session.edit(SEEN[case](viewer.studio.scene))
    viewer.tell("edited")
    viewer.on_tick()
    assert viewer.message == "edited"


def test_with_the_exposure_held_the_same_edit_has_an_effect(tmp_path: Path) -> None:
    hand = hand_before(ALONE, tmp_path)
    hand.open_menu()
    hand.pick("lights")
    hand.pull("intensity", 0.2, 0.4)
    assert hand.viewer.message == f"{AUTOMATIC}hold the exposure in the menu of lights"
    hand.pick("exposure")
    hand.pull("intensity", 0.2, 0.3)
    assert not hand.viewer.message.startswith("no change")


def test_the_whole_drag_is_compared_when_it_ends(tmp_path: Path) -> None:
    viewer = Viewer(ALONE, Ramtek9300(), tmp_path)
    session = viewer.session
    viewer.board.is_pinned = True
    session.turn_to("lights")
    viewer.tell("")
    (row,) = (row for row in viewer.board.widgets() if row.label == "intensity")
    places = [(row.area.left + share, row.area.top + 8) for share in (20, 40, 60)]
    viewer.on_pointer(*places[0], "press", 1)
    for place in places[1:]:
        viewer.on_pointer(*place, "move", 1)
        viewer.on_tick(is_at_rest=False)
        assert not viewer.message.startswith("no change")
    viewer.on_pointer(*places[-1], "release", 1)
    viewer.on_tick()
    assert viewer.message == f"{AUTOMATIC}E holds all"
    assert len(viewer.studio.history.to_undo) == 1
    viewer.on_key("z", control=True)
    viewer.on_tick()
    assert viewer.message.startswith("undone: key: intensity")
