from __future__ import annotations

import os
import platform
import pty
import select
import socket
import subprocess
import sys
import threading
import tty
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest

from ramtek_emu import PortError, Ramtek9300, UnixPort
from ramtek_emu.host.device import FULL, INSTRUCTION, MACHINES, DeviceRelay, WriteNotices, filter_of
from ramtek_emu.host.server import UnixServer
from tests.ramtek_emu.processes import environment
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.serving import serving_at, until


class Device:
    """A terminal that a relay without notices connects with a display; `file` is the program's side."""

    def __init__(self, server: UnixServer) -> None:
        self.ours, self.file = pty.openpty()
        tty.setraw(self.file)
        self.ended, self._end = os.pipe()
        self.error: PortError | None = None
        self._port = UnixPort(server.address)
        self._relay = DeviceRelay(self._port, self.ours, None)
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        try:
            self._relay.relay(self.ended)
            self._relay.finish()
            self._port.close()
        except PortError as error:
            self.error = error
        finally:
            self._port.wire.socket.close()

    def end(self) -> None:
        """Signal to the relay that the program has ended, and wait until everything is drawn."""
        os.close(self._end)
        self.join()

    def join(self) -> None:
        self._thread.join(60)
        assert not self._thread.is_alive()
        for number in (self.ours, self.file, self.ended):
            os.close(number)


@contextmanager
def on_a_display(path: Path) -> Iterator[tuple[UnixServer, Device]]:
    with serving_at(path) as server:
        yield server, Device(server)


def read(number: int, count: int) -> bytes:
    data = b""
    while len(data) < count:
        data += os.read(number, count - len(data))
    return data


def test_words_and_replies_go_both_ways_and_the_rest_is_drawn_at_the_end(
    tmp_path: Path,
) -> None:
    picture = np.arange(480 * 640) % 1024
    with on_a_display(tmp_path / "display") as (server, device):
        head = words("0A03 0040 0 0 27F 62 F780").astype("<u2").tobytes()
        sent = head + picture[: 0xF780 // 2].astype("<u2").tobytes()
        while sent:
            sent = sent[os.write(device.file, sent) :]
        os.write(device.file, words("0B03 0040 0 0 27F 62 F780").astype("<u2").tobytes())
        answer = np.frombuffer(read(device.file, 0xF780), "<u2")
        assert (answer == picture[: len(answer)]).all()
        os.write(device.file, np.tile(OUTLINE, 20).astype("<u2").tobytes() + b"!")
        device.end()
        assert device.error is None
        twin = Ramtek9300()
        twin.send(words("0A03 0040 0 0 27F 62 F780"))
        twin.send(picture[: 0xF780 // 2].astype(np.uint16))
        twin.send(OUTLINE)
        assert (server.display.words == twin.words).all()
        assert server.display.decoder.pending_words == 0


def test_a_display_that_leaves_ends_the_relay_with_an_error(tmp_path: Path) -> None:
    with on_a_display(tmp_path / "display") as (server, device):
        os.write(device.file, words("0902 0044 7 5 5 5 5 0B03 0040 5 5 5 5 2").astype("<u2").tobytes())
        assert read(device.file, 2) == b"\x07\0"
    device.join()
    assert str(device.error) == (
        f"a display must stay at {server.address} while a program uses it, and it left; "
        "start the program again later"
    )


def test_a_program_that_reads_no_replies_is_stopped_and_fills_no_memory(tmp_path: Path) -> None:
    with on_a_display(tmp_path / "display") as (_, device):
        os.set_blocking(device.file, False)
        asked = np.tile(words("0B03 0040 0 0 27F 1F A000"), 100)
        left = memoryview(np.append(asked, np.full(1 << 20, 0x0700)).astype("<u2").tobytes())

        def is_stopped() -> bool:
            """Whether the relay has stopped reading in both directions; the program writes until then."""
            nonlocal left
            with suppress(BlockingIOError):
                left = left[os.write(device.file, left) :]
            return min(len(device._relay._written), len(device._relay._replies)) >= FULL

        until(is_stopped)
        assert len(left) > 0
        assert max(len(device._relay._written), len(device._relay._replies)) < 4 * FULL
        device.end()


ALLOWED, NOTIFIED = 0x7FFF0000, 0x7FC00000


def verdict(steps: list[tuple[int, int, int, int]], number: int, architecture: int) -> int:
    """The result of a filter for a call, interpreted step by step."""
    place, loaded = 0, 0
    while True:
        code, if_equal, otherwise, value = steps[place]
        if code == 0x06:
            return value
        if code == 0x20:
            loaded = {0: number, 4: architecture}[value]
            place += 1
        else:
            assert code == 0x15
            place += 1 + (if_equal if loaded == value else otherwise)


@pytest.mark.parametrize("machine", MACHINES)
def test_the_filter_gives_notice_of_writes_and_lets_everything_else_pass(machine: str) -> None:
    data = filter_of(MACHINES[machine])
    steps = list(INSTRUCTION.iter_unpack(data))
    for architecture in MACHINES[machine].architectures:
        for number in range(500):
            expected = NOTIFIED if number in (architecture.write, architecture.writev) else ALLOWED
            assert verdict(steps, number, architecture.audit) == expected
        assert verdict(steps, architecture.write, 0x12345678) == ALLOWED


PROGRAM = """
import os, socket, sys
from ramtek_emu.host.device import ask_for_notices
parent = socket.socket(fileno=int(sys.argv[1]))
try:
    socket.send_fds(parent, [b"+"], [ask_for_notices()])
except OSError as cause:
    parent.send(str(cause).encode())
    sys.exit()
os.write(int(sys.argv[2]), b"one")
os.writev(int(sys.argv[2]), [b"t", b"wo"])
os._exit(7)
"""


def test_a_write_begins_only_when_it_is_allowed() -> None:
    if platform.system() != "Linux":
        pytest.skip("needs Linux")
    ours, theirs = socket.socketpair()
    read_end, write_end = os.pipe()
    os.set_blocking(read_end, False)
    arguments = [sys.executable, "-c", PROGRAM, str(theirs.fileno()), str(write_end)]
    with subprocess.Popen(arguments, pass_fds=[theirs.fileno(), write_end], env=environment()) as program:
        theirs.close()
        said, numbers, _, _ = socket.recv_fds(ours, 100, 1)
        if not numbers:
            pytest.skip(f"this system gives no notices: {said.decode()}")
        notices = WriteNotices(numbers[0])
        identity: int | None = None
        for written in (b"one", b"two"):
            assert select.select([notices], [], [], 60)[0]
            with pytest.raises(BlockingIOError):
                os.read(read_end, 10)
            identity = notices.next()
            assert identity is not None
            notices.allow(identity)
            os.set_blocking(read_end, True)
            assert os.read(read_end, 10) == written
            os.set_blocking(read_end, False)
        assert program.wait(60) == 7
    # A late answer does nothing.
    assert identity is not None
    notices.allow(identity)
    notices.close()
    ours.close()
    for number in (read_end, write_end):
        os.close(number)


def test_a_python_of_32_bits_on_a_machine_of_64_asks_for_nothing() -> None:
    program = (
        "import struct\n"
        "from ramtek_emu.host import device\n"
        "device.PROGRAM = struct.Struct('=HxxI')\n"
        "try:\n    device.ask_for_notices()\n"
        "except OSError:\n    raise SystemExit(3)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], env=environment(), timeout=60, check=False)
    assert done.returncode == 3
