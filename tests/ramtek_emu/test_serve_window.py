"""The window on a display that a program elsewhere draws on, on a real screen, Xvfb's."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from ramtek_emu import Ramtek9300, TcpPort, instructions
from ramtek_emu.host.host_session import HostSession
from ramtek_emu.host.pipe import PolledPipe
from ramtek_emu.host.server import Server
from ramtek_emu.monitor.window import Monitor
from tests.ramtek_emu.recorded_streams import BARS, OUTLINE
from tests.ramtek_emu.test_window import screen as screen
from tests.ramtek_emu.test_window import shown

pygame = pytest.importorskip("pygame")
ROOT = Path(__file__).parents[2]


@pytest.fixture
def on_screen(screen: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of a screen that windows open on."""
    monkeypatch.setenv("DISPLAY", screen)
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/tmp")
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    return screen


def test_the_window_shows_what_a_remote_host_draws_as_it_draws(on_screen: str) -> None:
    with Server(Ramtek9300()) as server:
        monitor = Monitor(server.display, on_tick=lambda: server.serve_for(0.01))
        monitor.open()
        with TcpPort(server.address) as host:
            host.send(instructions.load_entries(0, [[n % 256, n // 4, 0] for n in range(1024)]))
            counts = []
            for part in np.split(BARS, 8):
                host.send(part)
                for _ in range(20):
                    monitor.step(2)
                counts.append(monitor.refreshed)
                multiple = len(shown()) // 480
                assert (shown()[::multiple, ::multiple] == server.display.field()).all()
            assert len(set(counts)) == 8
        assert server.display.words.max() == 319
        monitor.close()


def test_a_window_closes_at_once_while_a_host_is_still_sending(on_screen: str) -> None:
    slow = np.tile(np.concatenate((instructions.write_image(np.full((480, 640), 5)), OUTLINE)), 200)
    with Server(Ramtek9300()) as server:
        monitor = Monitor(server.display, on_tick=lambda: server.serve_for(0.01))
        monitor.open()
        program = (
            "import sys, socket; s = socket.create_connection(('127.0.0.1', int(sys.argv[1])))\n"
            "d = sys.stdin.buffer.read()\n"
            "try: s.sendall(d)\nexcept OSError: pass"
        )
        host = subprocess.Popen([sys.executable, "-c", program, str(server.port)], stdin=subprocess.PIPE)
        assert host.stdin is not None
        host.stdin.write(slow.astype("<u2").tobytes())
        host.stdin.close()
        while not server.display.words.any():
            monitor.step(5)
        for _ in range(5):
            monitor.step(5)
        assert server.busy
        pygame.event.post(pygame.event.Event(pygame.QUIT))
        begin = time.monotonic()
        while monitor.is_open:
            monitor.step(5)
        server.close()
        assert time.monotonic() - begin < 0.25
        host.wait(10)


def test_a_pipe_is_shown_in_slices_of_time_and_its_replies_come(on_screen: str) -> None:
    stream = np.concatenate((OUTLINE, next(instructions.read_image(100, 100, 3, 1))[0]))
    replies: list[bytes] = []
    left = [b"", stream.astype("<u2").tobytes()]
    display = Ramtek9300()
    pipe = PolledPipe(HostSession(display), lambda _: left.pop(), replies.append)
    monitor = Monitor(display, on_tick=lambda: pipe.serve_for(0.01))
    monitor.open()
    end = time.monotonic() + 5
    while not (pipe.ended and replies) and time.monotonic() < end:
        monitor.step(5)
    assert b"".join(replies) == display.words[100, 100:103].astype("<u2").tobytes()
    monitor.close()


@pytest.mark.parametrize(
    "arguments", [["play", "-"], ["serve", "--stdio", "--window", "--snapshot", "s.png"]]
)
def test_a_command_with_a_window_stays_until_it_is_told(
    on_screen: str, tmp_path: Path, arguments: list[str]
) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "ramtek_emu", *arguments],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdin is not None
    process.stdin.write(OUTLINE.astype("<u2").tobytes())
    process.stdin.flush()
    time.sleep(1.2)
    assert process.poll() is None
    # The window's manager would send this as a request to close it.
    process.send_signal(signal.SIGINT)
    begin = time.monotonic()
    _, said = process.communicate(timeout=10)
    assert time.monotonic() - begin < 2
    assert process.returncode == 0
    assert b"Traceback" not in said


def test_the_server_s_window_is_a_command(on_screen: str, tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "ramtek_emu", "serve", "--port", "0", "--window"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout is not None
    with TcpPort(process.stdout.readline().decode().strip()) as host:
        host.send(instructions.write_image(np.full((4, 4), 9), 3, 3))
        stream, count = next(instructions.read_image(3, 3, 4, 4))
        host.send(stream)
        assert (host.receive(count) == 9).all()
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=10)
    assert process.returncode == 0
