from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

import autocolor
from autocolor import Studio, UsageError, read_scene
from autocolor.commands import view
from autocolor.commands.window import connected
from autocolor.files import opening
from autocolor.files.state import recent_files
from autocolor.screens.session import Clipboard
from ramtek_emu import NoScreenError, Ramtek9300
from ramtek_emu.monitor import window
from ramtek_emu.monitor.window import Key, Monitor, Pointer
from tests import small
from tests.autocolor.commands.conftest import Refused, Run
from tests.small import car


@pytest.fixture
def monitors(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The monitors that a command opens; each is driven by `script` instead of by a user."""
    opened: list[Any] = []

    class Driven(Monitor):
        script: Callable[[Any], object] = staticmethod(lambda monitor: None)

        def run(self, _: object = None) -> None:
            opened.append(self)
            type(self).script(self)

    monkeypatch.setattr(window, "Monitor", Driven)
    monkeypatch.setattr(window, "open_screen", lambda: None)
    opened.append(Driven)
    return opened


def test_a_scene_is_shown_until_the_window_is_closed(folder: Path, run: Run, monitors: list[Any]) -> None:
    assert run("view", "scene") == (0, "", "")
    monitor = monitors[1]
    assert monitor.caption == "autocolor - scene - [front.low] - F1: help; Tab or the right edge: the menu"
    assert not monitor.full_screen
    assert not monitor.glass.fit
    assert monitor.display.words.any()


def test_what_is_set_and_options_of_the_window_reach_it(folder: Path, run: Run, monitors: list[Any]) -> None:
    def script(monitor: Any) -> None:
        assert monitor.display.entries[0].tolist() == [16, 32, 48]
        monitor.on_drop(folder / "two.obj")

    monitors[0].script = staticmethod(script)
    settings = ("--set", "background=#102030", "--set", "parts.side.stage=true")
    assert run("view", "two.obj", "--up", "y", "--full-screen", "--fit", *settings).code == 0
    assert (monitors[1].full_screen, monitors[1].glass.fit) == (True, True)
    # The mesh that was dropped stands as the first one.
    scene = monitors[1].on_drop.__self__.studio.scene
    assert scene.mesh.coordinates[2].tolist() == [1, -1, 0]
    # What is viewed is among the recent files, the last first.
    monitors[0].script = staticmethod(lambda monitor: None)
    assert run("view", "scene").code == 0
    assert recent_files()[:2] == (folder / "scene", folder / "two.obj")


@pytest.mark.parametrize("line", [("view", "scene", "--paints", "few.csv"), ("--paints", "few.csv")])
def test_paints_are_brought_along(folder: Path, run: Run, monitors: list[Any], line: tuple[str, ...]) -> None:
    (folder / "few.csv").write_text("name,color\nSignal red,#a52019\n")
    assert run(*line).code == 0
    assert monitors[1].caption.endswith("a paint of few.csv: take them in color mixing")


def test_the_input_of_the_window_reaches_the_viewer_and_its_caption_the_window() -> None:
    viewer, update = Mock(caption="one"), Mock()
    viewer.session.leaves = False
    monitor: Any = connected(Monitor(Ramtek9300()), viewer, update)
    monitor.on_key(Key("c", "C", shift=True))
    viewer.on_key.assert_called_once_with("c", False, True, "C", False, False)
    monitor.on_pointer(Pointer(300, 200, "press", 1, 2, control=True))
    viewer.on_pointer.assert_called_once_with(300, 200, "press", 1, 2, False, True)
    assert (monitor.caption, monitor.screenshots) == ("one", viewer.folder)
    assert viewer.session.clipboard == Clipboard(monitor.glass.copy, monitor.glass.paste)
    for name in ("on_release", "on_drop", "on_close"):
        assert getattr(monitor, name) is getattr(viewer, name)
    assert monitor.on_message is viewer.tell
    monitor.close = Mock()
    viewer.caption = "two"
    for leaves in (False, True):
        viewer.session.leaves = leaves
        monitor.on_tick()
        assert (monitor.caption, update.call_count, monitor.close.called) == ("two", 1 + leaves, leaves)
    viewer.on_tick.assert_called_with(monitor.is_at_rest)


def test_the_demo_is_saved_to_new_files_and_a_scene_that_was_named_to_its_own(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[Any] = []
    monkeypatch.setattr(view, "show", lambda history, *_, **__: shown.append(history.first_place))
    assert run().code == run("view", "scene").code == run("view", "two.obj").code == 0
    assert [place.stamp is None for place in shown] == [True, False, True]
    assert [Path(place.source.path).name for place in shown[1:]] == ["scene", "two.obj"]


@pytest.mark.skipif(os.name == "nt", reason="Windows always has a screen")
@pytest.mark.parametrize("line", ["", "view scene"])
def test_without_a_screen_render_is_named(
    refused: Refused, monkeypatch: pytest.MonkeyPatch, line: str
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    # The scene is not rendered first.
    monkeypatch.setattr("autocolor.screens.viewer.Viewer", None)
    assert refused(line, 69).endswith(
        "; `autocolor render` writes the demo to coupe.png, and `autocolor render SCENE -o PNG` renders any"
        " scene"
    )


# From Python.


def shows_its_scene(studio: Studio) -> bool:
    """Whether the display of a studio shows what it would show to a new studio of the scene."""
    displays: list[Any] = [studio.display, Studio(studio.scene).display]
    return small.held(displays[0]) == small.held(displays[1])


def test_the_steps_in_the_window_of_a_studio_are_its_steps(monitors: list[Any]) -> None:
    studio = Studio(car())
    studio.light("key", intensity=0.5)
    before = studio.scene

    def script(monitor: Any) -> None:
        assert monitor.display.words[:4].tobytes() == studio.words[:4].tobytes()
        monitor.on_key(Key("c", "c"))
        monitor.on_key(Key("z", "", control=True))
        monitor.on_key(Key("1", "1"))
        monitor.on_tick()
        # The studio has the steps, so that nothing is lost.
        assert monitor.on_close()

    monitors[0].script = staticmethod(script)
    studio.view_window(fit=True)
    assert (monitors[1].full_screen, monitors[1].glass.fit) == (False, True)
    assert studio.scene.equals(before.with_light("key", on=False))
    assert shows_its_scene(studio)
    assert studio.undo(2)
    assert studio.scene.lights["key"].intensity == 1
    assert shows_its_scene(studio)


def test_an_error_in_the_window_of_a_studio_leaves_its_steps_on_the_display(monitors: list[Any]) -> None:
    studio = Studio(car())

    def script(monitor: Any) -> None:
        monitor.on_key(Key("1", "1"))
        raise KeyboardInterrupt

    monitors[0].script = staticmethod(script)
    with pytest.raises(KeyboardInterrupt):
        studio.view_window()
    assert not studio.scene.lights["key"].on
    assert shows_its_scene(studio)


def test_a_scene_a_file_and_a_studio_are_viewed(folder: Path, monitors: list[Any]) -> None:
    studio = Studio(car())
    for scene in (car(), "scene", folder / "two.obj", studio):
        autocolor.view(scene, full_screen=True)
    names = ["scene", "scene", "two", "scene"]
    assert [monitor.caption.split(" - ")[1] for monitor in monitors[1:]] == names
    assert all(monitor.full_screen for monitor in monitors[1:])
    monitors[0].script = staticmethod(lambda monitor: monitor.on_key(Key("1", "1")) and monitor.on_close())
    autocolor.view(studio)
    assert studio.history.steps
    with pytest.raises(UsageError, match="a scene must be a Scene, not None"):
        autocolor.view(None)  # type: ignore[arg-type]


def test_a_viewed_scene_is_saved_to_its_file_and_the_user_is_asked_first(
    folder: Path, monitors: list[Any]
) -> None:
    def script(monitor: Any) -> None:
        monitor.on_key(Key("1", "1"))
        assert not monitor.on_close()
        monitor.on_key(Key("s", "", control=True))
        assert monitor.on_close()

    monitors[0].script = staticmethod(script)
    autocolor.view("scene")
    assert not read_scene("scene").lights[0].on


# The window in which the user waits.


class Waited:
    """What a window showed while the user waited; `on_step` is called at each step with the monitor."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.captions: list[str] = []
        self.fields: list[bytes] = []
        self.on_step: Callable[[Any], object] = lambda monitor: None
        waited = self

        class Stepped(Monitor):
            opened = False

            @property
            def is_open(self) -> bool:
                return self.opened

            def open(self) -> None:
                self.opened = True

            def close(self) -> None:
                self.opened = False

            def step(self, wait: int = 0) -> bool:
                if waited.captions[-1:] != [self.caption]:
                    waited.captions.append(self.caption)
                    waited.fields.append(self.display.field().tobytes())
                waited.on_step(self)
                return self.is_open

            def run(self, _: object = None) -> None:
                waited.captions.append(f"run: {self.caption}, open: {self.is_open}")

        monkeypatch.setattr(window, "Monitor", Stepped)
        monkeypatch.setattr(window, "open_screen", lambda: None)
        monkeypatch.setattr("autocolor.commands.window.FIRST_SIGN_SECONDS", 0.0)


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Reading a scene waits for this event."""
    event, read = threading.Event(), opening.read_scene_with_report

    def slowly(*arguments: Any, **options: Any) -> Any:
        assert event.wait(60)
        return read(*arguments, **options)

    monkeypatch.setattr(opening, "read_scene_with_report", slowly)
    return event


def test_while_a_scene_is_read_and_rendered_the_window_says_so(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    waited = Waited(monkeypatch)
    waited.on_step = lambda monitor: slow.set()
    assert run("view", "./scene") == (0, "", "")
    assert waited.captions[0] == "autocolor - reading scene ..."
    assert waited.captions[-1].startswith("run: autocolor - scene - [front.low] - ")
    assert waited.captions[-1].endswith(", open: True")
    (elements, lines), field = (640, 480), np.frombuffer(waited.fields[0], np.uint8)
    at = np.argwhere(field.reshape(lines, elements, 3).any(axis=2))
    assert set(field) == {0, 255}
    assert (at.max(axis=0) + at.min(axis=0)).tolist() == pytest.approx([lines, elements], abs=14)


def test_closing_the_window_ends_the_command_while_a_scene_is_read(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    waited = Waited(monkeypatch)
    waited.on_step = lambda monitor: monitor.close()
    assert run("view", "scene") == (0, "", "")
    assert waited.captions == ["autocolor - reading scene ..."]
    slow.set()


def test_closing_the_window_before_the_first_picture_ends_view(monkeypatch: pytest.MonkeyPatch) -> None:
    waited, closed = Waited(monkeypatch), threading.Event()

    def close(monitor: Any) -> None:
        monitor.close()
        closed.set()

    waited.on_step = close
    monkeypatch.setattr("autocolor.commands.window.viewer_of", lambda _: closed.wait(60))
    autocolor.view(car())
    assert waited.captions == ["autocolor - rendering scene ..."]


def test_an_error_that_is_found_while_the_user_waits_closes_the_window(
    folder: Path, refused: Refused, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    waited = Waited(monkeypatch)
    monitors: list[Any] = []

    def note(monitor: Any) -> None:
        monitors.append(monitor)
        slow.set()

    waited.on_step = note
    (folder / "two.obj").write_text("v 0 0\n")
    refused("view two.obj", 65)
    assert not monitors[0].is_open


def test_without_a_screen_an_error_of_the_scene_comes_first(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    Waited(monkeypatch)

    def refuse(_: Any) -> None:
        slow.set()
        raise NoScreenError("a window must have a screen, and there is none")

    monkeypatch.setattr(window.Monitor, "open", refuse)
    assert run("view", "none.obj").code == 66
