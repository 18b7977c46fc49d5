"""What is true after any session, whatever was done in it with the joystick unit on all screens."""

from __future__ import annotations

import runpy
from hashlib import sha256
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from autocolor import Light, Mesh, Scene, Studio, Surface, read_journal, read_scene, scene_of, write_scene
from autocolor.journal.autosave import JOURNAL, Autosave
from autocolor.journal.description import describe_look
from autocolor.journal.history import History, Open
from autocolor.journal.places import Source, place_of
from autocolor.screens.picture.watching import MESSAGE
from autocolor.screens.session import PICTURE
from autocolor.screens.viewer import Viewer
from autocolor.widgets.sheet import Sheet
from ramtek_emu import FAMILY, HostPort, Ramtek9300, Recorder, TcpPort, instructions
from ramtek_emu.host.server import TcpServer
from tests.autocolor.journal.random_steps import summary
from tests.autocolor.random_hand import RandomHand
from tests.ramtek_emu.serving import in_a_thread
from tests.small import car, grid, held, is_true_to_its_file, wall_scene
from tests.tables import first

GESTURES = 40 if settings().max_examples <= 10 else 120
"""More of them in a thorough run."""

MANY = 60


def many_surfaces() -> Scene:
    names = [f"the surface number {number} of many" for number in range(MANY)]
    rows = [
        grid(1, 1, (number % 10, 0, number // 10), (0.8, 0, 0), (0, 0, 0.8), name)
        for number, name in enumerate(names)
    ]
    lights = [Light(f"light {number}", (number, -5, 3), 0.1) for number in range(16)]
    return scene_of(
        Mesh.joined(rows),
        surface_of_part={name: name for name in names},
        surfaces=[Surface(name) for name in names],
        lights=lights,
    )


def followed() -> Scene:
    """The car under lights that follow the eye and each other, one at infinity and one that falls off."""
    rows = [
        Light("lamp", (0.0, 0.0, 0.0), 0.3, follows="eye", falloff="linear", reach=9.0),
        Light("sun", (0.5, -1.0, 1.0), 0.5, direction=(0, 1, -1), at_infinity=True, follows="key"),
        Light("spot", (0.0, -3.0, 2.0), 0.4, aim=(0, 0, 0.5), cone_angle=30, follows="key"),
        Light("last", (0.0, -1.0, 0.0), 0.2, follows="spot"),
    ]
    scene = car()
    return scene.replace(lights=(*rows, *scene.lights))


SCENES = {
    "car": car,
    "followed": followed,
    "one surface": wall_scene,
    "no light": lambda: wall_scene(lights=[]),
    "nothing in sight": lambda: car().with_view(eye=(90, 90, 90), target=(99, 99, 99)),
    "an empty mesh": lambda: scene_of(Mesh(np.zeros((0, 3)), np.zeros((0, 4), int), np.zeros(0, int), ())),
    "many surfaces": many_surfaces,
}


@pytest.fixture(autouse=True)
def _no_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """Messages stand, pictures are never coarse, and files have one age, however slow the machine is."""
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: 0.0)
    monkeypatch.setattr("autocolor.screens.session.MESSAGE_SECONDS", float("inf"))
    monkeypatch.setattr("autocolor.screens.file_screen.short_date", lambda *_: "12:00")


def begun(name: str, folder: Path, port: HostPort) -> Viewer:
    """A viewer with a scene that was read from a folder."""
    source = Source(str(folder / "scene"))
    write_scene(source.path, SCENES[name]())
    history = History(read_scene(source.path), place_of(source))
    return Viewer(history, port, folder / "scene")


def digest_of(display: Ramtek9300) -> str:
    """A digest of all words and entries; pytest would compare millions of bytes for its message."""
    return sha256(b"".join(held(display))).hexdigest()


def digest_of_a_fresh_display(history: History | Scene) -> str:
    display = Ramtek9300()
    Studio(history, display)
    return digest_of(display)


@pytest.mark.parametrize("name", first(2, SCENES))
def test_a_random_session_is_shown_recovered_run_as_a_script_undone_and_redone(
    name: str, tmp_path: Path, state: Path
) -> None:
    display, autosave, sent = Ramtek9300(), Autosave(), BytesIO()
    viewer = begun(name, tmp_path, Recorder(sent, display))
    first = viewer.studio.scene
    hand = RandomHand(viewer, display, seed=len(name))
    for number in range(GESTURES):
        hand.do()
        if number % 3 == 0:
            autosave.update(viewer.studio.history, at_once=True)
            assert is_true_to_its_file(viewer.studio), f"gesture {number}"
        if number % 4 == 0 and not viewer.caption.endswith(MESSAGE):
            # What was sent is what the whole page would be, unless a picture comes in line by line.
            whole = Ramtek9300()
            Sheet(whole).show(viewer.board.page())
            assert digest_of(display) == digest_of(whole), f"on the screen {viewer.page}, gesture {number}"
    hand.let_go()
    viewer.clear()
    studio = viewer.studio
    # An edit without a change is no step.
    states = (*studio.history.to_undo, studio.scene, *reversed(studio.history.to_redo))
    assert all(describe_look(before, after) for before, after in pairwise(states))
    assert viewer.page == PICTURE
    last = digest_of(display)
    assert last == digest_of_a_fresh_display(studio.scene)
    assert is_true_to_its_file(studio)
    assert studio.history.steps
    # A display with the instructions of the 9460 finds no more in these words.
    family = Ramtek9300(FAMILY)
    family.send(np.frombuffer(sent.getvalue(), "<u2"))
    assert digest_of(family) == last
    assert display.processor.illegal_words == 0

    autosave.update(studio.history, at_once=True)
    (path,) = state.glob(f"sessions/*/{JOURNAL}")
    history = read_journal(path).history
    assert summary(history) == summary(studio.history)
    assert digest_of_a_fresh_display(history) == last
    script = tmp_path / "session.py"
    script.write_text(studio.journal(beside=tmp_path / "beside"), "utf-8")
    ran = runpy.run_path(str(script))["studio"]
    # The legend of a scalar stands over the words of the picture.
    assert ran.words.tobytes() == studio.words.tobytes()
    assert digest_of_a_fresh_display(ran.scene) == last
    autosave.end()
    assert list(state.glob("sessions/*")) == []

    # The hand may have left undone steps, which stay undone.
    steps, view = len(studio.history.to_undo), studio.scene.view
    while studio.undo() or studio.view_back():
        pass
    viewer.clear()
    # Where another scene was opened, the ways to views end.
    assert studio.scene.view == first.view or any(isinstance(step, Open) for step in studio.history.steps)
    assert digest_of(display) == digest_of_a_fresh_display(first.replace(view=studio.scene.view))
    for _ in range(steps):
        studio.redo()
    # The present view stayed.
    studio.edit(studio.scene.replace(view=view))
    viewer.clear()
    assert digest_of(display) == last


def test_a_session_over_tcp_gives_the_same_words_and_entries(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = []
    for way in ("in process", "over TCP"):
        folder, display, pages = tmp_path / way, Ramtek9300(), []
        folder.mkdir()
        # Each has colors and files of its own that were used lately.
        monkeypatch.setenv("XDG_STATE_HOME", str(folder / "state"))
        with in_a_thread(TcpServer(display)) as server, TcpPort(server.address) as port:
            elsewhere = port if way == "over TCP" else display
            viewer = begun("car", folder, elsewhere)
            hand = RandomHand(viewer, display, seed=1)
            for _ in range(GESTURES):
                hand.do()
                # Its reply comes after everything before was executed.
                elsewhere.send(instructions.read_entries(0, 2))
                elsewhere.receive(2)
                pages.append((viewer.page, digest_of(display)))
        found.append(pages)
    differing = [number for number, (one, other) in enumerate(zip(*found, strict=True)) if one != other]
    assert differing == []
