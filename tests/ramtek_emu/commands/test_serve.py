"""`ramtek serve` in real processes, with pipes and sockets."""

from __future__ import annotations

import os
import signal
import socket
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from ramtek_emu import Ramtek9300, TcpPort, UnixPort, instructions, read_snapshot
from ramtek_emu.commands.displays import running, show
from ramtek_emu.host.server import TcpServer
from ramtek_emu.monitor.window import Monitor
from tests.ramtek_emu.displays import shown
from tests.ramtek_emu.processes import ROOT, PipedHost, environment, field_of, run, started, stream
from tests.ramtek_emu.recorded_streams import BARS, OUTLINE, words
from tests.ramtek_emu.serving import until

pygame = pytest.importorskip("pygame")


def fill_polygon(host: PipedHost | TcpPort, left: int, top: int, width: int, height: int) -> None:
    """Fill an outline: read every line, write between its first and its last word that is not 0."""
    for line in range(top, top + height):
        host.send(words(f"0B03 0040 {left:X} {line:X} {left + width - 1:X} {line:X} {2 * width:X}"))
        row = np.flatnonzero(host.receive(width))
        if len(row):
            host.send(words(f"0902 0044 0005 {left + row[0]:X} {line:X} {left + row[-1]:X} {line:X}"))


TRIANGLE = instructions.write_vectors([[20, 10], [60, 45], [5, 40], [20, 10]], 9)


def test_a_polygon_filler_works_on_a_pipe_and_over_tcp(tmp_path: Path) -> None:
    twin = Ramtek9300()
    twin.send(TRIANGLE)
    expected = twin.words.copy()
    for line in expected:
        row = np.flatnonzero(line)
        if len(row):
            line[row[0] : row[-1] + 1] = 5
    assert np.count_nonzero(expected) > 500
    with started("serve", "--stdio", "--snapshot", tmp_path / "pipe.png") as process:
        host = PipedHost(process)
        host.send(TRIANGLE)
        fill_polygon(host, 0, 0, 80, 50)
        host.into.close()
        assert host.out.read() == b""
        assert process.wait(60) == 0
    assert (read_snapshot(tmp_path / "pipe.png").words == expected).all()
    with started("serve", "--port", "0", "--once", "--snapshot", tmp_path / "tcp.png") as process:
        assert process.stdout is not None
        with TcpPort(process.stdout.readline().decode().strip()) as port:
            port.send(TRIANGLE)
            fill_polygon(port, 0, 0, 80, 50)
        assert process.wait(60) == 0
    assert (read_snapshot(tmp_path / "tcp.png").words == expected).all()


def test_a_program_that_changes_the_table_it_read_works_on_a_pipe(tmp_path: Path) -> None:
    with started("serve", "--stdio", "-o", tmp_path / "table.png") as process:
        host = PipedHost(process)
        host.send(instructions.load_entries(0, [[10, 20, 30], [40, 50, 60]]))
        host.send(instructions.read_entries(0, 4))
        table = host.receive(4)
        host.send(np.concatenate((words("0300 0000 0008"), table[[2, 3, 0, 1]])))
        host.into.close()
        assert process.wait(60) == 0
    assert field_of(tmp_path / "table.png")[0, 0].tolist() == [40, 50, 60]


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
    answered = run("serve", "--stdio", data=stream(words("A3FF 0B03 0040 0 0 0 0 2 0A01 0008")))
    assert answered.returncode == 0
    assert answered.stdout == b"\0\0"
    assert answered.stderr.decode().splitlines() == [
        "1 word begins no instruction: skipped",
        "the stream ends within an instruction: its 2 words were dropped",
    ]
    named = run("serve", "--stdio", data=stream(words("1100 1200 0500")))
    assert named.stderr == b"2 instructions are known by name only: without effect\n"
    nothing = run("serve", "--stdio")
    assert (nothing.returncode, nothing.stdout, nothing.stderr) == (0, b"", b"")


def test_a_host_that_takes_no_replies_still_gets_its_picture(tmp_path: Path) -> None:
    with started("serve", "--stdio", "--snapshot", tmp_path / "late.png") as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdout.close()
        process.stdin.write(stream(np.concatenate((words("0B03 0040 0 0 9 9 64"), OUTLINE))))
        process.stdin.close()
        assert process.wait(60) == 0
    assert read_snapshot(tmp_path / "late.png").words.any()


def test_the_shell_s_pipes_put_any_program_on_the_display(tmp_path: Path) -> None:
    program = "import sys; sys.stdout.buffer.write(bytes.fromhex('020802000500'))"
    command = f'{sys.executable} -c "{program}" | {sys.executable} -m ramtek_emu serve --stdio -o out.png'
    done = subprocess.run(
        command, shell=True, cwd=tmp_path, env=environment(), capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out.png").exists()


def test_two_pipes_put_a_program_that_reads_back_on_the_display(tmp_path: Path) -> None:
    program = (
        "import os\n"
        "def send(*words): os.write(1, b''.join(word.to_bytes(2, 'little') for word in words))\n"
        "send(0x0902, 0x0044, 7, 3, 3, 3, 3)\n"
        "send(0x0B03, 0x0040, 3, 3, 3, 3, 2)\n"
        "word = int.from_bytes(os.read(0, 2), 'little')\n"
        "send(0x0902, 0x0044, word + 1, 4, 4, 4, 4)\n"
    )
    (tmp_path / "host.py").write_text(program)
    python = sys.executable
    command = (
        "mkfifo replies; "
        f"{python} host.py < replies | {python} -m ramtek_emu serve --stdio --snapshot s.png > replies"
    )
    done = subprocess.run(
        command, shell=True, cwd=tmp_path, env=environment(), capture_output=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert read_snapshot(tmp_path / "s.png").words[[3, 4], [3, 4]].tolist() == [7, 8]


def test_a_server_prints_its_port_serves_hosts_in_turn_and_ends_at_a_signal(tmp_path: Path) -> None:
    with started("serve", "--port", 0, "-o", tmp_path / "end.png", "--configuration", "jpl-9460") as process:
        assert process.stdout is not None
        assert process.stderr is not None
        address = process.stdout.readline().decode().strip()
        assert address.startswith("tcp://127.0.0.1:")
        for number in range(3):
            with TcpPort(address) as port:
                port.send(words(f"0902 0044 {number + 1:X} {number:X} 0 {number:X} 0 0B03 0040 0 0 2 0 6"))
                assert port.receive(3).tolist()[: number + 1] == list(range(1, number + 2))
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 0
        assert f"wrote {tmp_path / 'end.png'}" in process.stderr.read().decode()


def mark(number: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
    return words(f"0902 0044 {number + 1:X} {number:X} 9 {number:X} 9")


def test_two_hundred_hosts_in_a_row_all_draw_on_a_server_process(tmp_path: Path) -> None:
    with started("serve", "--port", 0, "--snapshot", tmp_path / "end.png") as process:
        assert process.stdout is not None
        address = process.stdout.readline().decode().strip()
        for number in range(0, 400, 2):
            with TcpPort(address) as port:
                port.send(mark(number))
            with socket.create_connection(("127.0.0.1", int(address.rpartition(":")[2]))) as host:
                host.sendall(stream(mark(number + 1)))
        TcpPort(address).close()
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 0
    assert read_snapshot(tmp_path / "end.png").words[9, :400].tolist() == list(range(1, 401))


def test_a_server_at_a_unix_socket_rounds_each_write_down_and_removes_its_socket(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with started("serve", "--unix", path, "--snapshot", tmp_path / "end.png") as process:
        assert process.stdout is not None
        assert process.stdout.readline().decode().strip() == str(path)
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        for number in range(200):
            with UnixPort(path) as port:
                port.write(stream(mark(number)) + b"!")
        again = run("serve", "--unix", path)
        assert again.returncode == 73
        assert again.stderr.decode() == (
            "ramtek: a server's socket must be a new file or the socket of a server that is gone, "
            f"not {path}, which belongs to a server that runs; choose another path\n"
        )
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 0
    assert not path.exists()
    assert read_snapshot(tmp_path / "end.png").words[9, :200].tolist() == list(range(1, 201))


def test_lines_on_stdin_move_the_joystick_of_a_server() -> None:
    with started("serve", "--port", 0, "--joystick", "-") as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        with TcpPort(process.stdout.readline().decode().strip()) as port:
            port.send(words("1600 0005 0406 0902 0044 7 0 0 0 0 1700"))
            assert port.receive(2).tolist() == [5, 0x406]
            process.stdin.write(b"cursor 100 200 enter\nwalk 3\n")
            assert process.stderr.readline() == (
                b"joystick, line 2: a joystick line must hold cursor X Y, by X Y, enter, track on, "
                b"track off or reset, not 'walk 3'; write it so\n"
            )
            port.send(words("1700"))
            assert port.receive(2).tolist() == [100, 200 | 1 << 10 | 1 << 13]
            process.stdin.write(b"reset\n?\n")
            assert process.stderr.readline().startswith(b"joystick, line 4:")
            port.send(words("0B03 0040 0 0 0 0 2 1700"))
            assert port.receive(3).tolist() == [0, 100, 200]
        process.stdin.close()
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 0


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
        host.send(words("0B03 0040 0 0 9F 9F C800"))
        host.into.close()
        assert len(host.out.read()) == 0xC800
        assert process.wait(60) == 0


def test_a_host_address_other_than_loopback_is_served_with_a_warning() -> None:
    with started("serve", "--port", 0, "--host", "0.0.0.0") as process:
        assert process.stdout is not None
        assert process.stderr is not None
        port = int(process.stdout.readline().decode().strip().rpartition(":")[2])
        socket.create_connection(("127.0.0.1", port), 5).close()
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0
        assert b"whoever reaches tcp://0.0.0.0" in process.stderr.read()


def test_the_window_shows_the_drawing_of_a_remote_host_at_once(on_screen: str) -> None:
    with TcpServer(Ramtek9300()) as server:
        monitor = Monitor(server.display, on_tick=lambda: server.serve_for(0.01))
        monitor.open()
        host = TcpPort(server.address)
        host.send(instructions.load_entries(0, [[n % 256, n // 4, 0] for n in range(1024)]))
        counts = []
        sent = 3 + 2 * 1024
        for part in np.split(BARS, 8):
            host.send(part)
            sent += len(part)
            while server.display.words_received < sent:
                monitor.step(2)
            monitor.step()
            counts.append(monitor.refreshed)
            multiple = len(shown()) // 480
            assert (shown()[::multiple, ::multiple] == server.display.field()).all()
        assert len(set(counts)) == 8
        # Closing waits for the server, which this thread steps.
        closing = threading.Thread(target=host.close)
        closing.start()
        while closing.is_alive():
            monitor.step(2)
        assert server.display.words.max() == 319
        monitor.close()


def test_a_host_that_polls_the_joystick_of_a_window_does_not_wait_for_its_ticks(
    on_screen: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    polls = 100
    waits: set[int] = set()
    step = Monitor.step

    def observed(monitor: Monitor, wait: int = 0) -> bool:
        if server.busy:
            waits.add(wait)
        return step(monitor, wait)

    monkeypatch.setattr(Monitor, "step", observed)

    def poll(address: str) -> None:
        with TcpPort(address) as host:
            for _ in range(polls):
                host.send(instructions.read_cursor(0))
                assert len(host.receive(2)) == 2

    with TcpServer(Ramtek9300()) as server:
        host = threading.Thread(target=poll, args=(server.address,))
        host.start()

        def serve_for(seconds: float) -> None:
            server.serve_for(seconds, wait=0.005)
            if server.served:
                os.kill(os.getpid(), signal.SIGTERM)

        with running(server.display) as run:
            show(server.display, run, serve_for, lambda: server.busy)
        host.join(60)
    assert waits == {0}


def test_a_window_closes_at_once_while_a_host_is_still_sending(on_screen: str) -> None:
    slow = np.tile(np.concatenate((instructions.write_image(np.full((480, 640), 5)), OUTLINE)), 200)
    with TcpServer(Ramtek9300()) as server:
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
        begin = time.thread_time()
        monitor.step(5)
        assert not monitor.is_open
        server.close()
        assert time.thread_time() - begin < 0.25
        host.wait(60)


@pytest.mark.parametrize(
    "arguments",
    [
        ["play", "-", "--record", "r"],
        ["serve", "--stdio", "--window", "--record", "r", "--snapshot", "s.png"],
        ["serve", "--stdio", "--inspect", "--record", "r", "--snapshot", "s.png"],
    ],
)
def test_a_command_with_a_window_runs_until_a_signal(
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
    # The file of the recording is opened when the display ends in order at a signal.
    until(lambda: any(tmp_path.iterdir()))
    assert process.poll() is None
    # The window's manager would send this as a request to close it.
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 0
    assert b"Traceback" not in said


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_during_service_closes_the_window_afterwards(number: signal.Signals, on_screen: str) -> None:
    display = Ramtek9300()
    served = 0

    def serve_for(seconds: float) -> None:
        nonlocal served
        os.kill(os.getpid(), number)
        served += 1

    with running(display) as run:
        show(display, run, serve_for)
    assert served == 1


@pytest.mark.parametrize("view", ["--window", "--inspect"])
def test_the_server_s_window_is_a_command(on_screen: str, tmp_path: Path, view: str) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "ramtek_emu", "serve", "--port", "0", view, "--record", "words"],
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
    process.communicate(timeout=60)
    assert process.returncode == 0
    assert (tmp_path / "words").stat().st_size > 2 * len(stream)
