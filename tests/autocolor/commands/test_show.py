from __future__ import annotations

import os
import shutil
import signal
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread
from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from autocolor import Studio, UnavailableError, read_journal, read_scene
from autocolor.commands.demo import demo_folder
from autocolor.commands.show import BUTTONS, attend, folder_of, session_elsewhere
from autocolor.commands.tutorial import teach
from autocolor.journal.autosave import JOURNAL, left_sessions
from autocolor.journal.history import History
from autocolor.screens.file_actions import ask_to_leave
from autocolor.screens.message_line import MessagePart, lines_of_message
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from ramtek_emu.host.server import Server, TcpServer, UnixServer
from tests.autocolor.commands.conftest import Refused, Run
from tests.small import car
from tests.tables import first


class Served:
    """A display that a thread serves until it is stopped."""

    def __init__(self, server: Server, address: str) -> None:
        self.address = address
        self.display = server.display
        self._server = server
        self._ends = Event()
        self._thread = Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        with self._server:
            while not self._ends.is_set():
                self._server.step(0.01)

    def stop(self) -> None:
        """Disconnect the host, and listen no more."""
        self._ends.set()
        self._thread.join(60)


@pytest.fixture
def server() -> Iterator[Served]:
    listening = TcpServer(Ramtek9300())
    served = Served(listening, listening.address)
    yield served
    served.stop()


NOWHERE = "tcp://127.0.0.1:1"


def test_a_picture_is_shown_once_on_a_display_behind_a_port(folder: Path, run: Run, server: Served) -> None:
    ran = run("show", "two.obj", "--set", "ambient=0.3", "--to", server.address, "--once")
    assert ran == (0, "", f"reading two.obj\nshown on {server.address}\n")
    here = Ramtek9300()
    Studio(read_scene("two.obj").replace(ambient=0.3), here)
    assert (server.display.field() == here.field()).all()


def test_paints_are_brought_to_a_display_elsewhere(
    folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    messages = []

    def session(history: History, address: str, folder: Path, **given: Callable[[Viewer], object]) -> None:
        viewer = Viewer(history, Ramtek9300(), folder)
        given["prepare"](viewer)
        messages.append(viewer.message)

    monkeypatch.setattr("autocolor.commands.show.session_elsewhere", session)
    (folder / "few.csv").write_text("color\nred\nnavy\n")
    assert run("show", "scene", "--paints", "few.csv", "--to", "tcp://127.0.0.1:1").code == 0
    assert messages == ["2 paints of few.csv: take them in color mixing"]


@pytest.mark.skipif(os.name == "nt", reason="Windows ends programs without a signal")
def test_a_session_that_is_ended_by_a_signal_is_recovered(
    folder: Path, state: Path, run: Run, server: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The joystick turns the object by TRACK, before and after the session is recovered."""
    poll, joystick = Viewer.poll, server.display.joystick
    for arguments in (("scene", "--set", "ambient=0.3"), ("--recover", "again")):
        acts: Iterator[Callable[[], object]] = iter(
            [
                lambda: joystick.move_to(300, 200),
                lambda: setattr(joystick, "track", True),
                lambda: joystick.move_to(340, 210),
                lambda: setattr(joystick, "track", False),
                lambda: None,
                lambda: signal.raise_signal(signal.SIGTERM),
            ]
        )

        def polled(viewer: Viewer, acts: Iterator[Callable[[], object]] = acts) -> None:
            poll(viewer)
            next(acts)()

        monkeypatch.setattr(Viewer, "poll", polled)
        assert run("show", *arguments, "--to", server.address).code == 128 + signal.SIGTERM
        if arguments[0] == "scene":
            # This process still has the lock of the first session.
            (ended,) = (state / "sessions").iterdir()
            (state / "sessions" / "again").mkdir()
            shutil.copy(ended / JOURNAL, state / "sessions" / "again")
    history = read_journal(state / "sessions" / "again" / JOURNAL).history
    assert (len(history.to_undo), len(history.timeline.views_back)) == (1, 2)
    assert history.scene.ambient == 0.3


def test_files_are_in_the_folder_of_the_scene_and_never_in_that_of_the_demo(folder: Path) -> None:
    assert folder_of("scene") == folder / "scene"
    assert folder_of("scene/scene.toml") == folder / "scene"
    assert folder_of(str(demo_folder())) == folder


def test_it_ends_when_it_is_left_and_the_picture_stays(
    server: Served, tmp_path: Path, capsys: pytest.CaptureFixture[str], state: Path
) -> None:
    seen: list[Viewer] = []
    first: list[MessagePart] = []

    def leave(viewer: Viewer) -> None:
        seen.append(viewer)
        first.extend(viewer.board.messages)
        ask_to_leave(viewer.session)

    session_elsewhere(History(car()), server.address, tmp_path, None, leave)
    assert capsys.readouterr().err.startswith(f"shown on {server.address}; pick `leave` in the menu there")
    # The first message, which is shown whole, names the buttons.
    assert lines_of_message(first[0], 89)[-1].text.endswith(BUTTONS[-28:])
    assert seen[0].folder == tmp_path
    assert (server.display.words == seen[0].studio.words).all()
    assert not any(cursor.is_visible for cursor in server.display.cursors.all)
    assert left_sessions() == []


def test_a_display_that_goes_away_leaves_the_session_to_be_recovered(
    server: Served, tmp_path: Path, state: Path
) -> None:
    def lose(viewer: Viewer) -> None:
        viewer.session.edit(viewer.studio.scene.with_view(angle=30))
        server.stop()

    with pytest.raises(UnavailableError) as told:
        session_elsewhere(History(car()), server.address, tmp_path, None, lose)
    assert str(told.value).startswith(f"a display must stay at {server.address}, and it left (")
    assert str(told.value).endswith("; `autocolor show --recover --to ADDRESS` continues the session")
    (path,) = state.glob(f"sessions/*/{JOURNAL}")
    assert read_journal(path).history.scene.view.angle == 30


def test_the_unit_is_polled_at_least_sixty_times_a_second_and_the_program_sleeps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now, slept, polls = 100.0, 0.0, 0

    def sleep(seconds: float) -> None:
        nonlocal now, slept
        now, slept = now + seconds, slept + seconds

    def update() -> None:
        nonlocal now, polls
        polls += 1
        now += 0.25 if polls == 1 else 0.004
        viewer.session.leaves = now >= 101.25

    viewer = Mock()
    viewer.session.leaves = False
    # `show` is a command in its module, which has the same name.
    clock = SimpleNamespace(monotonic=lambda: now, sleep=sleep)
    monkeypatch.setattr(sys.modules["autocolor.commands.show"], "time", clock)
    attend(viewer, update)
    # The first poll, which took a quarter of a second, is not made up for.
    assert 60 <= polls == viewer.poll.call_count < 110
    assert slept > 0.5


def test_a_unix_socket_is_addressed_by_its_path(tmp_path: Path) -> None:
    path = tmp_path / "display"
    served = Served(UnixServer(Ramtek9300(), path), str(path))
    seen: list[Viewer] = []

    def leave(viewer: Viewer) -> None:
        seen.append(viewer)
        ask_to_leave(viewer.session)

    session_elsewhere(History(car()), served.address, tmp_path, None, leave)
    served.stop()
    assert (served.display.words == seen[0].studio.words).all()


Serve = Callable[[socket.socket], object]


def replying(reply: Callable[[bytes], bytes], greeting: bytes = b"") -> Serve:
    """What another server does: it sends a greeting, and a reply to all that it receives."""

    def serve(host: socket.socket) -> None:
        host.sendall(greeting)
        while data := host.recv(1 << 16):
            host.sendall(reply(data))

    return serve


BANNER = b"SSH-2.0-OpenSSH_9.6\r\n"
NO_ANSWER = "must answer within 0.3 seconds, and"
ANOTHER = "and another server does; check the address, or start `ramtek serve` there"


@pytest.mark.parametrize("options", first(1, ["", "--once"]))
@pytest.mark.parametrize(
    ("serve", "seconds", "sentence"),
    [
        (replying(lambda _: b"", BANNER), 0.3, NO_ANSWER),
        (replying(lambda data: data), 60.0, ANOTHER),
        (replying(lambda _: bytes(range(256)) * 256), 60.0, ANOTHER),
    ],
    ids=["banner", "echo", "garbage"],
)
def test_a_server_that_is_no_display_is_refused(
    serve: Serve, seconds: float, sentence: str, options: str, refused: Refused
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:

        def accept() -> None:
            host, _ = listening.accept()
            with host, suppress(OSError):
                serve(host)

        thread = Thread(target=accept)
        thread.start()
        address = f"tcp://127.0.0.1:{listening.getsockname()[1]}"
        assert sentence in refused(f"show scene --to {address} --timeout {seconds} {options}", 69)
        thread.join(60)


def test_it_is_taught_on_a_display_elsewhere(
    folder: Path, run: Run, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[str, str, Path, float]] = []

    def session(history: History, address: str, place: Path, prepare: object, timeout: float) -> None:
        assert prepare is teach
        asked.append((history.scene.name, address, place, timeout))

    monkeypatch.setattr("autocolor.commands.tutorial.session_elsewhere", session)
    assert run("tutorial", "--to", "tcp://127.0.0.1:9300", "--timeout", "200").code == 0
    assert asked == [("coupe", "tcp://127.0.0.1:9300", folder, 200.0)]
    refused("tutorial --to 127.0.0.1", 2)
