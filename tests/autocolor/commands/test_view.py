from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.files.state import recent_files
from tests.autocolor.commands.conftest import Run

pygame = pytest.importorskip("pygame")


@pytest.fixture
def monitors(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The monitors that a command opens; each is driven by `script` instead of by a user."""
    from ramtek_emu.monitor import window

    opened: list[Any] = []

    class Driven(window.Monitor):
        script: Callable[[Any], object] = staticmethod(lambda monitor: None)

        def run(self) -> None:
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
    assert not monitor.fit
    assert monitor.display.words.any()


def test_options_of_the_window_reach_it(folder: Path, run: Run, monitors: list[Any]) -> None:
    assert run("view", "two.obj", "--up", "y", "--full-screen", "--fit").code == 0
    assert monitors[1].full_screen
    assert monitors[1].fit


def test_a_scene_that_is_viewed_is_among_the_recent_files(
    folder: Path, run: Run, monitors: list[Any]
) -> None:
    assert run("view", "two.obj", "--up", "y").code == 0
    assert run("view", "scene").code == 0
    assert recent_files()[:2] == (folder / "scene", folder / "two.obj")


def test_what_is_set_is_shown(folder: Path, run: Run, monitors: list[Any]) -> None:
    assert run("view", "scene", "--set", "background=#102030", "--set", "parts.side.stage=true").code == 0
    entries = monitors[1].display.entries
    assert entries[0].tolist() == [16, 32, 48]
    ran = run("view", "scene", "--set", "backgruond=red")
    assert (ran.code, ran.err) == (
        2,
        "autocolor: --set backgruond: there is no field 'backgruond'; did you mean 'background'?\n",
    )


@pytest.mark.parametrize("line", [("view", "scene", "--paints", "few.csv"), ("--paints", "few.csv")])
def test_paints_are_brought_along(folder: Path, run: Run, monitors: list[Any], line: tuple[str, ...]) -> None:
    (folder / "few.csv").write_text("name,color\nSignal red,#a52019\n")
    assert run(*line).code == 0
    assert monitors[1].caption.endswith("a paint of few.csv: take them in color mixing")


@pytest.mark.parametrize(
    ("line", "code", "message"),
    [
        (
            ("view", "scene", "--paints", "no.gpl"),
            66,
            "no.gpl: there is no such file or folder; check",
        ),
        (("--paints", "two.obj"), 65, "two.obj: a palette must end in .act, .csv or .gpl, not in '.obj';"),
        (
            ("view", "--sessions", "--paints", "few.csv"),
            2,
            "--paints is for a scene or a session that is shown;",
        ),
        (("--paints", "few.csv", "view", "scene"), 2, "--paints before a command is for the demo; write it"),
    ],
)
def test_paints_that_cannot_be_shown_are_refused_before_anything_is_read(
    folder: Path, run: Run, monitors: list[Any], line: tuple[str, ...], code: int, message: str
) -> None:
    ran = run(*line)
    assert (ran.code, ran.out) == (code, "")
    assert ran.err.startswith(f"autocolor: {message}")
    assert len(monitors) == 1


def test_repairs_count_under_strict(folder: Path, run: Run, monitors: list[Any]) -> None:
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\n")
    assert run("view", "two.obj").code == 0
    assert run("view", "two.obj", "--strict").code == 1


def test_keys_drops_and_closing_reach_the_viewer(folder: Path, run: Run, monitors: list[Any]) -> None:
    from ramtek_emu.monitor.window import Key

    captions = []

    def note(monitor: Any) -> None:
        monitor.on_tick()
        captions.append(monitor.caption)

    def script(monitor: Any) -> None:
        assert monitor.on_key(Key("c", "c"))
        assert not monitor.on_key(Key("q", "q"))
        note(monitor)
        captions.append(str(monitor.on_close()))
        note(monitor)
        monitor.on_drop(folder / "none.obj")
        monitor.on_drop(folder / "none.obj")
        note(monitor)
        monitor.tell("saved somewhere")
        note(monitor)

    monitors[0].script = staticmethod(script)
    assert run("view", "scene").code == 0
    assert captions[0].startswith("autocolor - scene* - [front.low] - object color #")
    assert captions[1] == "False"
    assert captions[2].endswith("not saved: Ctrl+S saves, close again to discard the changes")
    assert captions[3].endswith("none.obj: there is no such file or folder; check the name")
    assert captions[4].endswith("saved somewhere")


def test_the_mouse_reaches_the_viewer(
    folder: Path, run: Run, monitors: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    from ramtek_emu.monitor.window import Pointer

    # However slow the machine is, no picture of the drag is coarse.
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: 0.0)
    fields = []

    def script(monitor: Any) -> None:
        for pointer in (
            Pointer(300, 200, True, "press", 1),
            Pointer(340, 200, True, "move"),
            Pointer(340, 200, False, "release", 1),
            Pointer(340, 200, False, "wheel up", steps=2),
        ):
            monitor.on_pointer(pointer)
            monitor.on_tick()
            fields.append(monitor.display.field().tobytes())

    monitors[0].script = staticmethod(script)
    assert run("view", "scene").code == 0
    assert len(set(fields)) == 3
    assert fields[1] == fields[2]


def test_leaving_by_the_menu_closes_the_window(monkeypatch: pytest.MonkeyPatch) -> None:
    from autocolor.commands.view import connected
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import Ramtek9300
    from ramtek_emu.monitor.window import Monitor
    from tests.small import car

    display = Ramtek9300()
    viewer = Viewer(car(), display)
    monitor = connected(Monitor(display), viewer)
    closed: list[bool] = []
    monkeypatch.setattr(monitor, "close", lambda: closed.append(True))
    assert monitor.on_tick is not None
    monitor.on_tick()
    assert closed == []
    viewer.session.leave()
    monitor.on_tick()
    assert closed == [True]


def test_the_clipboard_of_the_window_is_that_of_the_viewer(monkeypatch: pytest.MonkeyPatch) -> None:
    from autocolor.commands.view import connected
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import Ramtek9300
    from ramtek_emu.monitor.window import Monitor
    from tests.small import car

    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    display = Ramtek9300()
    viewer = Viewer(car(), display)
    monitor = connected(Monitor(display), viewer)
    monitor.open()
    try:
        viewer.session.turn_to("mixing")
        viewer.on_key("c", control=True)
        assert viewer.message == f"copied {monitor.paste()}"
        assert monitor.copy("teal")
        viewer.on_key("v", control=True)
        assert viewer.message == "object: #008080"
    finally:
        monitor.close()


def test_the_window_is_recorded_beside_the_screenshots_of_the_viewer(tmp_path: Path) -> None:
    from autocolor.commands.view import connected
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import Ramtek9300
    from ramtek_emu.monitor.window import Key, Monitor
    from tests.small import car

    display = Ramtek9300()
    viewer = Viewer(car(), display, tmp_path)
    monitor = connected(Monitor(display), viewer)
    viewer.session.tell("")
    for _ in range(2):
        monitor.handle_key(Key("f3"))
    assert viewer.message.startswith("saved ")
    monitor.handle_key(Key("f12"))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["autocolor-0001.apng", "autocolor-0001.png"]


def test_modifiers_and_released_keys_reach_the_viewer(folder: Path, run: Run, monitors: list[Any]) -> None:
    from ramtek_emu.monitor.window import Key, Pointer

    fields = []

    def field(monitor: Any) -> bytes:
        monitor.tell("")
        monitor.on_tick()
        return bytes(monitor.display.field().tobytes())

    def script(monitor: Any) -> None:
        for held in ({}, {"shift": True}, {"control": True}):
            monitor.on_pointer(Pointer(300, 200, True, "press", 1, 1, **held))
            monitor.on_pointer(Pointer(340, 240, True, "move", 0, 1, **held))
            monitor.on_pointer(Pointer(340, 240, False, "release", 1, 1, **held))
            fields.append(field(monitor))
            monitor.on_key(Key("z", "", control=True))
        monitor.on_key(Key("y", "", control=True))
        monitor.on_key(Key("b", "b"))
        compared = field(monitor)
        monitor.on_release("b")
        assert field(monitor) == fields[-1] != compared

    monitors[0].script = staticmethod(script)
    assert run("view", "scene").code == 0
    assert len(set(fields)) == 3


def test_a_bare_command_shows_the_demo(folder: Path, run: Run, monitors: list[Any]) -> None:
    assert run() == (0, "", "")
    assert monitors[1].caption.startswith("autocolor - coupe - ")


def test_the_demo_is_saved_to_new_files_and_a_scene_that_was_named_to_its_own(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    from autocolor.commands import view

    shown: list[Any] = []
    monkeypatch.setattr(view, "show", lambda history, *_, **__: shown.append(history.first_place))
    assert run().code == run("view", "scene").code == run("view", "two.obj").code == 0
    assert [place.stamp is None for place in shown] == [True, False, True]
    assert [Path(place.source.path).name for place in shown[1:]] == ["scene", "two.obj"]


def test_bad_input_opens_no_window(folder: Path, run: Run, monitors: list[Any]) -> None:
    assert run("view", "none.obj").code == 66
    assert len(monitors) == 1


@pytest.mark.parametrize("arguments", [(), ("view", "scene")])
def test_without_a_screen_render_is_named(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    if os.name == "nt":
        pytest.skip("Windows always has a screen")
    # The scene is not rendered first.
    monkeypatch.setattr("autocolor.screens.viewer.Viewer", None)
    ran = run(*arguments)
    assert (ran.code, ran.out) == (69, "")
    assert ran.err.count("\n") == 1
    assert "; `autocolor render` writes the demo to coupe.png, and `autocolor render SCENE" in ran.err


@pytest.mark.skipif(os.name != "posix", reason="needs an X display that can be missing")
def test_a_screen_that_does_not_answer_is_no_screen(process: Run, folder: Path) -> None:
    ran = process("view", "scene", environment={"DISPLAY": ":4711", "XDG_RUNTIME_DIR": str(folder)})
    assert (ran.code, ran.out) == (69, "")
    assert ran.err.count("\n") == 1
    assert "autocolor render SCENE -o PNG" in ran.err


# The window in which the user waits.


class Waited:
    """What a window showed while the user waited; `on_step` is called at each step with the monitor."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        from ramtek_emu.monitor import window

        self.captions: list[str] = []
        self.fields: list[bytes] = []
        self.on_step: Callable[[Any], object] = lambda monitor: None
        waited = self

        class Stepped(window.Monitor):
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

            def run(self) -> None:
                waited.captions.append(f"run: {self.caption}, open: {self.is_open}")

        monkeypatch.setattr(window, "Monitor", Stepped)
        monkeypatch.setattr(window, "open_screen", lambda: None)
        monkeypatch.setattr("autocolor.commands.view.FIRST_SIGN_SECONDS", 0.0)


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Reading a scene waits for this event."""
    import autocolor.files.scene_sources as module

    event, read = threading.Event(), module.read_scene_with_report

    def slowly(*arguments: Any, **options: Any) -> Any:
        assert event.wait(60)
        return read(*arguments, **options)

    monkeypatch.setattr(module, "read_scene_with_report", slowly)
    return event


def test_while_a_scene_is_read_and_rendered_the_window_says_so(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    waited = Waited(monkeypatch)
    waited.on_step = lambda monitor: slow.set()
    assert run("view", "scene") == (0, "", "")
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


def test_an_error_that_is_found_while_the_user_waits_closes_the_window(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    waited = Waited(monkeypatch)
    monitors: list[Any] = []

    def note(monitor: Any) -> None:
        monitors.append(monitor)
        slow.set()

    waited.on_step = note
    (folder / "two.obj").write_text("v 0 0\n")
    ran = run("view", "two.obj")
    assert (ran.code, ran.out) == (65, "")
    assert ran.err.startswith("autocolor: two.obj, line 1")
    assert ran.err.count("\n") == 1
    assert not monitors[0].is_open


def test_a_signal_ends_the_command_while_a_scene_is_read(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    def interrupt(monitor: Any) -> None:
        raise KeyboardInterrupt

    Waited(monkeypatch).on_step = interrupt
    assert run("view", "scene") == (130, "", "autocolor: interrupted\n")
    slow.set()


def test_without_a_screen_an_error_of_the_scene_comes_first(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch, slow: threading.Event
) -> None:
    from ramtek_emu import NoScreenError
    from ramtek_emu.monitor import window

    Waited(monkeypatch)

    def refuse(_: Any) -> None:
        slow.set()
        raise NoScreenError("a window must have a screen, and there is none")

    monkeypatch.setattr(window.Monitor, "open", refuse)
    assert run("view", "none.obj").code == 66
