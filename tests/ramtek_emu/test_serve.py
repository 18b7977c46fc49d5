"""The commands that run streams, as other programs see them: real processes, pipes and sockets."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from ramtek_emu import GMR_9300, PRINCETON_9300, Ramtek9300, TcpPort, instructions, read_snapshot
from ramtek_emu.host.host_session import HostSession
from ramtek_emu.host.pipe import serve_pipe
from tests.ramtek_emu.recorded_streams import COLOR_MAP, OUTLINE, RECORDED, words

ROOT = Path(__file__).parents[2]


def environment() -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return {**kept, "PYTHONPATH": str(ROOT)}


def run(*arguments: object, data: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "ramtek_emu", *map(str, arguments)],
        env=environment(),
        input=data,
        capture_output=True,
        timeout=60,
        check=False,
    )


@contextmanager
def started(*arguments: object) -> Iterator[subprocess.Popen[bytes]]:
    """A command with pipes at its three ends."""
    process = subprocess.Popen(
        [sys.executable, "-m", "ramtek_emu", *map(str, arguments)],
        env=environment(),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        bufsize=0,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()


def stream(numbers: object) -> bytes:
    return np.asarray(numbers, "<u2").tobytes()


def field_of(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    with Image.open(path) as picture:
        return np.asarray(picture)


class PipedHost:
    """A host program at a display on a pipe."""

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        self.into, self.out = process.stdin, process.stdout

    def send(self, numbers: object) -> None:
        self.into.write(stream(numbers))

    def receive(self, count: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
        data = b""
        while len(data) < 2 * count:
            piece = self.out.read(2 * count - len(data))
            assert piece, "the display left"
            data += piece
        return np.frombuffer(data, "<u2")


def fill_polygon(host: PipedHost | TcpPort, left: int, top: int, width: int, height: int) -> None:
    """Fill what is outlined: read each line, write between its first and last word that is not 0."""
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
        assert process.wait(10) == 0
    assert (read_snapshot(tmp_path / "pipe.png").words == expected).all()
    with started("serve", "--port", "0", "--once", "--snapshot", tmp_path / "tcp.png") as process:
        assert process.stdout is not None
        with TcpPort(process.stdout.readline().decode().strip()) as port:
            port.send(TRIANGLE)
            fill_polygon(port, 0, 0, 80, 50)
        assert process.wait(10) == 0
    assert (read_snapshot(tmp_path / "tcp.png").words == expected).all()


def test_a_program_that_changes_the_table_it_read_works_on_a_pipe(tmp_path: Path) -> None:
    with started("serve", "--stdio", "-o", tmp_path / "table.png") as process:
        host = PipedHost(process)
        host.send(instructions.load_entries(0, [[10, 20, 30], [40, 50, 60]]))
        host.send(instructions.read_entries(0, 4))
        table = host.receive(4)
        host.send(np.concatenate((words("0300 0000 0008"), table[[2, 3, 0, 1]])))
        host.into.close()
        assert process.wait(10) == 0
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
        assert process.wait(10) == 0
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
        assert process.wait(10) == 0
    assert read_snapshot(tmp_path / "late.png").words.any()


def test_the_shell_s_pipes_put_any_program_on_the_display(tmp_path: Path) -> None:
    program = "import sys; sys.stdout.buffer.write(bytes.fromhex('020802000500'))"
    command = f'{sys.executable} -c "{program}" | {sys.executable} -m ramtek_emu serve --stdio -o out.png'
    done = subprocess.run(
        command, shell=True, cwd=tmp_path, env=environment(), capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out.png").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_program_that_never_ends_is_interrupted_and_its_picture_is_there(
    tmp_path: Path, number: signal.Signals
) -> None:
    with started("serve", "--stdio", "--snapshot", tmp_path / "s.png") as process:
        host = PipedHost(process)
        host.send(OUTLINE)
        host.send(words("0B03 0040 64 64 64 64 2 0A01"))
        assert host.receive(1).tolist() == [128]
        process.send_signal(number)
        assert process.wait(10) == 0
    assert read_snapshot(tmp_path / "s.png").words.any()


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
        command, shell=True, cwd=tmp_path, env=environment(), capture_output=True, check=False, timeout=20
    )
    assert done.returncode == 0, done.stderr
    assert read_snapshot(tmp_path / "s.png").words[[3, 4], [3, 4]].tolist() == [7, 8]


def test_a_server_prints_its_port_serves_one_host_after_the_other_and_ends_when_told(tmp_path: Path) -> None:
    with started("serve", "--port", 0, "-o", tmp_path / "end.png", "--configuration", "jpl-9460") as process:
        assert process.stdout is not None
        assert process.stderr is not None
        address = process.stdout.readline().decode().strip()
        assert address.startswith("tcp://127.0.0.1:")
        for number in range(3):
            with TcpPort(address) as port:
                port.send(words(f"0902 0044 {number + 1:X} {number:X} 0 {number:X} 0 0B03 0040 0 0 2 0 6"))
                assert port.receive(3).tolist()[: number + 1] == list(range(1, number + 2))
            time.sleep(0.1)
        process.send_signal(signal.SIGTERM)
        begin = time.monotonic()
        assert process.wait(10) == 0
        assert time.monotonic() - begin < 5
        assert f"wrote {tmp_path / 'end.png'}" in process.stderr.read().decode()


def test_a_host_address_other_than_loopback_is_served_with_a_warning() -> None:
    with started("serve", "--port", 0, "--host", "0.0.0.0") as process:
        assert process.stdout is not None
        assert process.stderr is not None
        port = int(process.stdout.readline().decode().strip().rpartition(":")[2])
        socket.create_connection(("127.0.0.1", port), 5).close()
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 0
        assert b"whoever reaches tcp://0.0.0.0" in process.stderr.read()


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["serve"], 2),
        (["serve", "--stdio", "--port", "1"], 2),
        (["serve", "--port", "70000"], 2),
        (["serve", "--stdio", "--configuration", "gmr_9301"], 2),
        (["serve", "--stdio", "-o", "/none/at/all.png"], 73),
        (["serve", "--stdio", "-o", "-"], 2),
        (["play"], 2),
        (["play", "none.ramtek"], 66),
        (["play", "."], 66),
        (["list", "none.ramtek"], 66),
        (["assemble", "none.txt", "-o", "/none/at/all"], 73),
        (["plai"], 2),
    ],
)
def test_what_cannot_be_done_is_refused_in_words(arguments: list[str], code: int) -> None:
    refused = run(*arguments)
    assert refused.returncode == code
    assert refused.stdout == b""
    assert refused.stderr
    assert b"Traceback" not in refused.stderr


@pytest.mark.parametrize("command", ["play", "list", "assemble", "serve"])
def test_help_has_examples_and_loads_nothing_heavy(command: str) -> None:
    script = (
        "import sys; from ramtek_emu.commands import ramtek\n"
        f"try: ramtek(['{command}', '--help'])\n"
        "except SystemExit: pass\n"
        "print(*sorted({'numpy', 'pygame', 'PIL'} & set(sys.modules)), file=sys.stderr)"
    )
    shown = subprocess.run(
        [sys.executable, "-c", script], env=environment(), capture_output=True, text=True, check=True
    )
    assert "Examples:" in shown.stdout
    assert f"ramtek {command}" in shown.stdout
    assert shown.stderr.strip() == ""


def test_a_played_stream_gives_its_picture_its_recording_and_its_snapshot(tmp_path: Path) -> None:
    path, picture, record = tmp_path / "a.ramtek", tmp_path / "a.png", tmp_path / "b.ramtek"
    path.write_bytes(stream(np.concatenate((COLOR_MAP, OUTLINE))) + b"!")
    arguments = ("play", path, "-o", picture, "--record", record, "--snapshot", tmp_path / "s.png")
    played = run(*arguments, "--configuration", "Princeton-9300")
    assert played.returncode == 0, played.stderr
    display = read_snapshot(tmp_path / "s.png")
    assert display.configuration.name == "PRINCETON_9300"
    assert display.words.any()
    assert (field_of(picture) == display.field()).all()
    assert record.read_bytes() == path.read_bytes()[:-1]
    again = run(*arguments)
    assert again.returncode == 73
    assert b"which exists; choose another name or add --force" in again.stderr
    assert run("play", "-", "-o", picture, "--force", data=record.read_bytes()).returncode == 0
    windowless = run("play", path)
    assert windowless.returncode == 69


def test_what_hosts_sent_is_recorded_in_whole_instructions(tmp_path: Path) -> None:
    record = tmp_path / "hosts.ramtek"
    with started("serve", "--port", 0, "--record", record) as process:
        assert process.stdout is not None
        address = process.stdout.readline().decode().strip()
        for part in (OUTLINE, words("0A03 0040 0 0"), COLOR_MAP):
            with TcpPort(address) as port:
                port.send(part)
                port.send(words("0B01 0002"))
                if part[0] != 0x0A03:
                    port.receive(1)
            time.sleep(0.3)
        process.send_signal(signal.SIGTERM)
        assert process.wait(10) == 0
    read = words("0B01 0002")
    assert record.read_bytes() == stream(np.concatenate((OUTLINE, read, COLOR_MAP, read)))


def test_a_display_goes_on_from_a_snapshot(tmp_path: Path) -> None:
    first, second = tmp_path / "first.png", tmp_path / "second.png"
    halves = np.split(OUTLINE, [11])
    arguments = ("--configuration", "PRINCETON_9300", "--snapshot", first)
    assert run("play", "-", *arguments, data=stream(halves[0])).returncode == 0
    served = run("serve", "--stdio", "--start", first, "--snapshot", second, data=stream(halves[1]))
    assert served.returncode == 0
    twin = Ramtek9300(PRINCETON_9300)
    twin.send(OUTLINE)
    assert (read_snapshot(second).words == twin.words).all()
    assert run("play", "-", "--start", first, *arguments, "--force").returncode == 2
    (tmp_path / "none.png").write_bytes(b"no picture")
    refused = run("play", "-", "--start", tmp_path / "none.png", "-o", tmp_path / "o.png")
    assert refused.returncode == 65
    assert refused.stderr == (
        b"ramtek: a snapshot must begin as a PNG file does, not as something else; "
        b"take a new one with --snapshot\n"
    )


def test_a_configuration_that_is_not_known_is_told_the_nearest() -> None:
    refused = run("play", "-", "-o", "x.png", "--configuration", "gmr")
    assert refused.returncode == 2
    assert b"must be one of GMR_9300, " in refused.stderr
    assert b"not 'gmr'; did you mean GMR_9300?" in refused.stderr


def pop_of(pieces: list[bytes]) -> Callable[[int], bytes]:
    """A reader that gives the last of the pieces, whatever is asked."""
    return lambda _: pieces.pop()


def test_a_thousand_mutated_streams_are_played_and_leave_a_display_that_works() -> None:
    draw = random.Random(1983)
    display = Ramtek9300()
    real = [stream(each[:600]) for each in RECORDED] + [stream(instructions.write_text("mutated", 9, 9))]
    session = HostSession(display)
    for _ in range(1000):
        data = bytearray(draw.choice(real))
        for _ in range(draw.randint(1, 12)):
            place = draw.randrange(len(data))
            change = draw.randrange(3)
            if change == 0:
                data[place] = draw.randrange(256)
            elif change == 1:
                del data[place : place + draw.randint(1, 4)]
            else:
                data[place:place] = draw.randbytes(draw.randint(1, 4))
            data = data or bytearray(b"\0")
        pieces = [b"", bytes(data[50:]), bytes(data[:50])]
        serve_pipe(session, pop_of(pieces), None)
        assert display.processor.waiting == 0
    assert int(display.words.max()) <= GMR_9300.largest_word
    session.leave()
    twin = Ramtek9300()
    for one in (display, twin):
        one.send(instructions.reset())
        one.send(OUTLINE)
    assert (display.words == twin.words).all()
