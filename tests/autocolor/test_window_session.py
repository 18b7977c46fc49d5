"""Sessions in the real window of `autocolor view`, on a virtual screen, with real keys.

Beside it a viewer without a window gets the same keys; the window must show the field of its display, every
display pixel a block of 2 x 2.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from autocolor import read_picture, read_scene
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.virtual_screen import VirtualScreen, virtual_screen

ROOT = Path(__file__).parents[2]
PATIENCE = 60.0
MESH = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 0 1 1\ng front\nf 1 2 3 4\ng side\nf 1 4 6 5\n"


@pytest.fixture(scope="module")
def screen(tmp_path_factory: pytest.TempPathFactory) -> Iterator[VirtualScreen]:
    """A screen on which the window shows its field twice as large."""
    if shutil.which("xdotool") is None:
        pytest.skip("xdotool is not installed; no key can be pressed for real")
    with virtual_screen(tmp_path_factory.mktemp("screen"), "1400x1100") as screen:
        yield screen


class Session:
    """The command with its window, and a viewer that gets the same keys."""

    def __init__(self, screen: VirtualScreen, folder: Path) -> None:
        self.screen = screen
        self.folder = folder
        (folder / "box.obj").write_text(MESH)
        self.environment = {**os.environ, "DISPLAY": screen.name, "PYTHONPATH": str(ROOT)}
        self.environment["XDG_RUNTIME_DIR"] = str(folder)
        self.environment.pop("SDL_VIDEODRIVER", None)
        self.process = subprocess.Popen(
            [sys.executable, "-m", "autocolor", "view", "box.obj", "--surfaces", "parts"],
            cwd=folder,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.display = Ramtek9300()
        self.viewer = Viewer(
            read_scene(folder / "box.obj", surfaces="parts"), self.display, folder / "elsewhere"
        )

    def tool(self, *arguments: str) -> str:
        return subprocess.run(
            ["xdotool", *arguments], env=self.environment, check=False, capture_output=True, text=True
        ).stdout

    def press(self, key: str, name: str = "", control: bool = False) -> None:
        """Press a key for real; the viewer gets it too when its name is given."""
        self.tool("key", key)
        if name:
            self.viewer.on_key(name, control, typed=name if len(name) == 1 else "")
            self.viewer.on_tick()
        else:
            # The viewer's first message would stay until its next action.
            self.viewer.tell("")

    def window(self) -> str:
        return self.tool("search", "--class", ".").split("\n")[0]

    def caption(self) -> str:
        return self.tool("getwindowname", self.window()).strip()

    def shown(self) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
        """The pixels of the window, (height, width, 3); none while another window comes and goes."""
        left, top, width, height = self.place()
        return self.screen.pixels()[top : top + height, left : left + width]

    def place(self) -> tuple[int, ...]:
        """The window's left, top, width and height; zeros if it is gone."""
        geometry = self.tool("getwindowgeometry", "--shell", self.window())
        values = dict(line.split("=") for line in geometry.split() if "=" in line)
        return tuple(int(values.get(key, 0)) for key in ("X", "Y", "WIDTH", "HEIGHT"))

    def shows_the_field(self) -> bool:
        left, top, width, _ = self.place()
        if not width:
            return False
        self.follow(left, top)
        return np.array_equal(self.shown(), self.field())

    def field(self) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
        """The field of the viewer's display, each pixel a block of 2 x 2."""
        return self.display.field().repeat(2, axis=0).repeat(2, axis=1)

    def follow(self, left: int, top: int) -> None:
        """Move the viewer's pointer to the mouse, and let a message go when its time has passed.

        The field begins `left` and `top` pixels from the edges of the screen.
        """
        place = dict(line.split("=") for line in self.tool("getmouselocation", "--shell").split())
        element = (int(place.get("X", 0)) - left) // 2
        line = (int(place.get("Y", 0)) - top) // 2
        self.display.joystick.move_to(element, line)
        self.viewer.on_tick()

    def wait_for(self, happened: Callable[[], object]) -> None:
        end = time.monotonic() + PATIENCE
        while not happened():
            assert self.process.poll() is None, self.process.communicate()
            assert time.monotonic() < end, f"not within {PATIENCE} s; the window is called {self.caption()!r}"
            # A look takes several processes, and may be at the whole screen.
            time.sleep(0.1)

    def wait_for_the_field(self) -> None:
        self.wait_for(self.shows_the_field)

    def wait_for_caption(self, part: str) -> None:
        self.wait_for(lambda: part in self.caption())

    def screenshot(self) -> bytes:
        """A screenshot of the viewer of the test; it shows no message then."""
        folder = self.viewer.session.folder
        folder.mkdir()
        self.viewer.tell("")
        self.viewer.save_screen()
        self.viewer.tell("")
        return (folder / "autocolor-0001.png").read_bytes()

    def hold_right(self) -> None:
        """Hold the key that turns the object until it is repeated, and release it."""
        self.tool("keydown", "Right")
        self.wait_for(lambda: not self.shows_the_field())
        pressed = self.shown().copy()
        self.wait_for(lambda: not np.array_equal(self.shown(), pressed))
        self.tool("keyup", "Right")

    def end(self) -> tuple[int, str, str]:
        out, err = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, out, err


@pytest.fixture
def session(screen: VirtualScreen, tmp_path: Path) -> Iterator[Session]:
    session = Session(screen, tmp_path)
    try:
        session.wait_for_the_field()
        yield session
    finally:
        session.process.kill()
        session.process.communicate()


def test_the_window_shows_the_field_after_every_key(session: Session, tmp_path: Path) -> None:
    for key in ("F1", "F4", "F1", "Escape", "F4", "Escape"):
        session.press(key, key.lower())
        session.wait_for_the_field()
    assert np.array_equal(session.display.words, session.viewer.studio.words)
    for key, name in (("Left", "left"), ("Up", "up"), ("plus", "+"), ("c", "c"), ("bracketleft", "[")):
        session.press(key, name)
        session.wait_for_the_field()
    for _ in range(2):
        session.press("ctrl+z", "z", control=True)
        session.wait_for_the_field()
    session.press("ctrl+y", "y", control=True)
    session.wait_for_the_field()
    assert session.caption() == "autocolor - box* - [front] - redone: front: object color #9ebeef"

    session.press("F12")
    session.wait_for_caption("saved")
    screenshot = tmp_path / "autocolor-0001.png"
    assert session.caption() == f"autocolor - box* - [front] - saved {screenshot}"
    assert session.screenshot() == screenshot.read_bytes()

    session.press("ctrl+s")
    session.wait_for_caption("box.npz")
    assert session.caption() == "autocolor - box - [front] - saved box/scene.toml and box.npz"
    assert read_picture(tmp_path / "box.npz").scene.view == session.viewer.studio.scene.view
    session.press("ctrl+q")
    assert session.end() == (0, "", "")


@pytest.mark.thorough
def test_the_state_before_is_shown_while_its_key_is_held_and_unsaved_work_is_left_by_asking_twice(
    session: Session,
) -> None:
    session.press("c", "c")
    session.wait_for_the_field()
    session.tool("keydown", "b")
    session.viewer.on_key("b", typed="b")
    assert session.viewer.session.comparing.is_on
    session.wait_for_the_field()
    # Longer than a key takes to be repeated, and to be released between two repetitions.
    time.sleep(1.0)
    session.wait_for_the_field()
    assert "shown: the state before the last step; now: front: object color" in session.caption()
    session.tool("keyup", "b")
    session.viewer.on_release("b")
    session.wait_for_the_field()
    assert session.caption().endswith("shown: the present state")
    session.press("ctrl+q")
    session.wait_for_caption("close again")
    assert session.process.poll() is None
    session.press("ctrl+q")
    assert session.end() == (0, "", "")


@pytest.mark.thorough
def test_a_key_held_down_is_one_view_to_go_back_from_and_after_it_is_released_nothing_goes_on(
    session: Session,
) -> None:
    session.hold_right()
    # Over the object, highlights are marked.
    session.tool("mousemove", "2", "2")
    session.press("alt+Left")
    session.wait_for_the_field()
    session.wait_for(lambda: session.caption() == "autocolor - box - [front]")
    session.hold_right()

    def rests() -> bool:
        before = session.shown().copy()
        time.sleep(0.5)
        return np.array_equal(session.shown(), before)

    session.wait_for(rests)
    # The picture is fine: it is that of the same view in another window.
    session.press("ctrl+s")
    session.wait_for_caption("box.npz")
    view = read_picture(session.folder / "box.npz").scene.view
    session.viewer.studio.edit(session.viewer.studio.scene.replace(view=view))
    session.viewer.tell("")
    session.wait_for_the_field()


@pytest.mark.thorough
def test_a_picture_that_comes_in_line_by_line_is_whole_after_a_key_or_a_while(session: Session) -> None:
    for key in ("Escape", ""):
        session.press("w")
        session.wait_for(lambda: "line by line" in session.caption() and not session.shows_the_field())
        if key:
            session.press(key)
        # The caption tells the end: the last lines of this picture show nothing that could be missed.
        session.wait_for(lambda: "line by line" not in session.caption())
        session.wait_for_the_field()
    session.process.send_signal(signal.SIGINT)
    assert session.end() == (130, "", "autocolor: interrupted\n")


def test_a_drag_turns_the_object_and_is_one_view_to_go_back_from(session: Session) -> None:
    session.tool(
        "mousemove", "700", "500", "mousedown", "1", "mousemove", "760", "520", "mousemove", "790", "480"
    )
    session.wait_for(lambda: not session.shows_the_field())
    session.tool("mouseup", "1")
    session.wait_for_caption("autocolor - box*")
    # Over the object, highlights are marked.
    session.tool("mousemove", "2", "2")
    session.press("alt+Left")
    session.wait_for_the_field()
    session.wait_for(lambda: session.caption() == "autocolor - box - [front]")
