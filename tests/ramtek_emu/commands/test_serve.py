"""`ramtek serve` in real processes, with pipes and sockets."""

from __future__ import annotations

import os
import signal
import socket
import stat
import threading
from contextlib import suppress
from pathlib import Path

import numpy as np
import pygame
import pytest

from ramtek_emu import Ramtek9300, TcpPort, UnixPort, instructions, read_snapshot
from ramtek_emu.commands.displays import running, show
from ramtek_emu.host.server import TcpServer
from ramtek_emu.monitor.window import Monitor
from tests.ramtek_emu.displays import shown
from tests.ramtek_emu.processes import PipedHost, address_of, ended, field_of, run, started, stream
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.serving import until


def fill_polygon(host: PipedHost | TcpPort) -> None:
    """Outline a triangle, read every line, and write between its first and its last word that is not 0."""
    host.send(instructions.write_vectors([[20, 10], [60, 45], [5, 40], [20, 10]], 9))
    for line in range(50):
        host.send(words(f"0B03 0040 0 {line:X} 4F {line:X} A0"))
        row = np.flatnonzero(host.receive(80))
        if len(row):
            host.send(words(f"0902 0044 0005 {row[0]:X} {line:X} {row[-1]:X} {line:X}"))


def test_a_polygon_filler_works_on_a_pipe_and_over_tcp(tmp_path: Path) -> None:
    expected = Ramtek9300()
    fill_polygon(expected)  # type: ignore[arg-type]
    assert np.count_nonzero(expected.words == 5) > 500
    with started("serve", "--stdio", "--snapshot", tmp_path / "pipe.png") as process:
        host = PipedHost(process)
        fill_polygon(host)
        host.into.close()
        assert host.out.read() == b""
        assert process.wait(60) == 0
    with started("serve", "--port", "0", "--once", "--snapshot", tmp_path / "tcp.png") as process:
        with TcpPort(address_of(process)) as port:
            fill_polygon(port)
        assert process.wait(60) == 0
    for name in ("pipe.png", "tcp.png"):
        assert (read_snapshot(tmp_path / name).words == expected.words).all()


def test_a_reply_comes_before_the_next_word_is_sent_and_dribbled_bytes_are_words(tmp_path: Path) -> None:
    with started("serve", "--stdio", "-o", tmp_path / "dribbled.png") as process:
        host = PipedHost(process)
        for byte in stream(OUTLINE):
            host.into.write(bytes((byte,)))
        for column in (100, 101):
            host.send(words(f"0B03 0040 {column:X} 64 {column:X} 64 2"))
            assert host.receive(1).tolist() in ([128], [256])
        host.into.write(b"\x07")
        host.into.close()
        assert process.wait(60) == 0
        assert process.stderr is not None
        assert b"within a word: its last byte was dropped" in process.stderr.read()
    twin = Ramtek9300()
    twin.send(OUTLINE)
    assert (field_of(tmp_path / "dribbled.png") == twin.field()).all()


def test_only_replies_are_on_stdout_and_the_rest_is_said_on_stderr() -> None:
    sent = stream(words("A3FF 1100 1200 0B03 0040 0 0 0 0 2 0A01 0008"))
    answered = run("serve", "--stdio", "--configuration", "family", data=sent)
    assert (answered.returncode, answered.stdout) == (0, b"\0\0")
    assert answered.stderr.decode().splitlines() == [
        "words that begin no instruction, skipped: 1",
        "instructions known by name only, without effect: 2",
        "the stream ends within an instruction: its 2 words were dropped",
    ]


def test_a_host_that_takes_no_replies_still_gets_its_picture(tmp_path: Path) -> None:
    with started("serve", "--stdio", "--snapshot", tmp_path / "late.png") as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdout.close()
        process.stdin.write(stream(np.concatenate((words("0B03 0040 0 0 9 9 64"), OUTLINE))))
        process.stdin.close()
        assert process.wait(60) == 0
    assert read_snapshot(tmp_path / "late.png").words.any()


def mark(number: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
    return words(f"0902 0044 {number + 1:X} {number:X} 9 {number:X} 9")


def test_a_server_prints_its_port_serves_hosts_in_turn_and_ends_at_a_signal(tmp_path: Path) -> None:
    picture, configuration = tmp_path / "end.png", ("--configuration", "jpl-9460")
    with started("serve", "--port", 0, "--snapshot", picture, *configuration) as process:
        address = address_of(process)
        assert address.startswith("tcp://127.0.0.1:")
        for number in range(0, 40, 2):
            with TcpPort(address) as port:
                port.send(mark(number))
                port.send(words(f"0B03 0040 0 9 {number:X} 9 {2 * number + 2:X}"))
                assert port.receive(number + 1).tolist() == list(range(1, number + 2))
            with socket.create_connection(("127.0.0.1", int(address.rpartition(":")[2]))) as host:
                host.sendall(stream(mark(number + 1)))
        TcpPort(address).close()
        assert ended(process, signal.SIGTERM).endswith(f"them (F2 in a window)\nwrote {picture}\n")
    end = read_snapshot(picture)
    assert end.configuration.name == "JPL_9460"
    assert end.words[9, :40].tolist() == list(range(1, 41))


def test_a_server_at_a_unix_socket_rounds_each_write_down_and_removes_its_socket(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with started("serve", "--unix", path, "--snapshot", tmp_path / "end.png") as process:
        assert address_of(process) == str(path)
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        for number in range(20):
            with UnixPort(path) as port:
                port.write(stream(mark(number)) + b"!")
        assert run("serve", "--unix", path).returncode == 73
        ended(process, signal.SIGTERM)
    assert not path.exists()
    assert read_snapshot(tmp_path / "end.png").words[9, :20].tolist() == list(range(1, 21))


def test_lines_on_stdin_move_the_joystick_of_a_server() -> None:
    with started("serve", "--port", 0, "--joystick", "-") as process:
        assert process.stdin is not None
        assert process.stderr is not None
        with TcpPort(address_of(process)) as port:
            port.send(words("1600 0005 0406 0902 0044 7 0 0 0 0 1700"))
            assert port.receive(2).tolist() == [5, 0x406]
            process.stdin.write(b"cursor 100 200 enter\nwalk 3\n")
            assert process.stderr.readline().startswith(b"joystick, line 2:")
            port.send(words("1700"))
            assert port.receive(2).tolist() == [100, 200 | 1 << 10 | 1 << 13]
            process.stdin.write(b"reset\n?\n")
            assert process.stderr.readline().startswith(b"joystick, line 4:")
            port.send(words("0B03 0040 0 0 0 0 2 1700"))
            assert port.receive(3).tolist() == [0, 100, 200]
        process.stdin.close()
        ended(process, signal.SIGTERM)


def test_a_fifo_moves_the_joystick_of_a_display_on_a_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "stick")
    with started("serve", "--stdio", "--joystick", tmp_path / "stick") as process:
        host = PipedHost(process)
        host.send(words("1600 0005 0406 1700"))
        assert host.receive(2).tolist() == [5, 0x406]
        for number in (1, 2):
            # A writer closes the FIFO, which stays open for the next writer.
            (tmp_path / "stick").write_text(f"cursor {number} 9 enter\n?\n")
            assert process.stderr is not None
            assert f"line {2 * number}:".encode() in process.stderr.readline()
            host.send(words("1700"))
            assert host.receive(2).tolist() == [number, 0x2409]
        host.into.close()
        assert process.wait(60) == 0


def test_a_host_address_other_than_loopback_is_served_with_a_warning() -> None:
    with started("serve", "--port", 0, "--host", "0.0.0.0") as process:
        port = int(address_of(process).rpartition(":")[2])
        socket.create_connection(("127.0.0.1", port), 5).close()
        assert "whoever reaches tcp://0.0.0.0" in ended(process, signal.SIGINT)


def test_the_window_shows_what_a_remote_host_draws_and_closes_while_it_is_sending(on_screen: str) -> None:
    with TcpServer(Ramtek9300()) as server:
        monitor = Monitor(server.display, on_tick=lambda: server.serve_for(0.01))
        monitor.open()
        host = socket.create_connection(("127.0.0.1", server.port))
        for number, color in ((1, (9, 200, 30)), (2, (70, 8, 90))):
            host.sendall(stream(load := instructions.load_entries(0, [color])))
            until(lambda: monitor.step(2) and server.display.words_received >= number * len(load))  # noqa: B023
            monitor.step()
            assert (shown() == color).all()
        images = stream(np.tile(instructions.write_image(np.full((480, 640), 5)), 50))
        sending = threading.Thread(target=send_all, args=(host, images))
        sending.start()
        until(lambda: monitor.step(2) and server.display.words.any())
        assert server.busy
        pygame.event.post(pygame.event.Event(pygame.QUIT))
        assert not monitor.step(5)
        assert not monitor.is_open
        assert server.display.words_received < len(images) // 2
    sending.join(60)
    assert not sending.is_alive()


def send_all(host: socket.socket, data: bytes) -> None:
    with host, suppress(OSError):
        host.sendall(data)


def test_a_host_that_polls_the_joystick_of_a_window_does_not_wait_for_its_ticks(
    on_screen: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    waits: set[int] = set()
    step = Monitor.step

    def observed(monitor: Monitor, wait: int = 0) -> bool:
        if server.busy:
            waits.add(wait)
        return step(monitor, wait)

    monkeypatch.setattr(Monitor, "step", observed)

    def poll(address: str) -> None:
        with TcpPort(address) as host:
            for _ in range(100):
                host.send(instructions.read_cursor(0))
                assert len(host.receive(2)) == 2

    with TcpServer(Ramtek9300()) as server:
        host = threading.Thread(target=poll, args=(server.address,))
        host.start()

        def tick() -> None:
            server.serve_for(0.01, wait=0.005)
            if server.served:
                os.kill(os.getpid(), signal.SIGTERM)

        with running(server.display) as run:
            show(Monitor(server.display, on_tick=tick), run, lambda: server.busy)
        host.join(60)
    assert waits == {0}


@pytest.mark.parametrize(
    "arguments",
    [
        ["play", "-", "--record", "r"],
        ["serve", "--stdio", "--window", "--record", "r"],
        ["serve", "--stdio", "--inspect", "--record", "r", "--snapshot", "s.png"],
        ["serve", "--port", "0", "--window", "--record", "r"],
        ["serve", "--port", "0", "--inspect", "--record", "r"],
    ],
)
def test_a_command_with_a_window_runs_until_a_signal(
    on_screen: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    read, count = next(instructions.read_image(90, 90, 120, 120))
    with started(*arguments, DISPLAY=on_screen) as process:
        if "--port" in arguments:
            with TcpPort(address_of(process)) as host:
                host.send(OUTLINE)
                host.send(read)
                assert host.receive(count).any()
        else:
            assert process.stdin is not None
            process.stdin.write(stream(OUTLINE))
            # The file of the recording is opened when the display ends in order at a signal.
            until(lambda: any(tmp_path.iterdir()))
        assert process.poll() is None
        # The window's manager would send this as a request to close it.
        assert "Traceback" not in ended(process, signal.SIGINT)
    recorded = (tmp_path / "r").read_bytes()
    if "--port" in arguments:
        assert recorded == stream(np.concatenate((OUTLINE, read)))


def test_a_signal_during_service_closes_the_window_afterwards(on_screen: str) -> None:
    display = Ramtek9300()
    served = 0

    def tick() -> None:
        nonlocal served
        os.kill(os.getpid(), signal.SIGTERM)
        served += 1

    with running(display) as run:
        show(Monitor(display, on_tick=tick), run)
    assert served == 1
