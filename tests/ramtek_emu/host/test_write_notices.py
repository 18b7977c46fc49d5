from __future__ import annotations

import os
import platform
import select
import socket
import subprocess
import sys

import pytest

from ramtek_emu.host.write_notices import INSTRUCTION, MACHINES, WriteNotices, filter_of
from tests.ramtek_emu.processes import environment

ALLOWED, TOLD = 0x7FFF0000, 0x7FC00000


def verdict(steps: list[tuple[int, int, int, int]], number: int, architecture: int) -> int:
    """What a filter returns for a call, interpreted step by step."""
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
def test_the_filter_tells_of_writes_and_lets_everything_else_pass(machine: str) -> None:
    data = filter_of(MACHINES[machine])
    steps = list(INSTRUCTION.iter_unpack(data))
    for each in MACHINES[machine].architectures:
        for number in range(500):
            expected = TOLD if number in (each.write, each.writev) else ALLOWED
            assert verdict(steps, number, each.audit) == expected
        assert verdict(steps, each.write, 0x12345678) == ALLOWED


PROGRAM = """
import os, socket, sys
from ramtek_emu.host.write_notices import ask_for_notices
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
            assert select.select([notices], [], [], 10)[0]
            with pytest.raises(BlockingIOError):
                os.read(read_end, 10)
            identity = notices.next()
            assert identity is not None
            notices.allow(identity)
            os.set_blocking(read_end, True)
            assert os.read(read_end, 10) == written
            os.set_blocking(read_end, False)
        assert program.wait(10) == 7
    # An answer that comes too late does nothing.
    assert identity is not None
    notices.allow(identity)
    notices.close()
    ours.close()
    for number in (read_end, write_end):
        os.close(number)


def test_a_python_of_32_bits_on_a_machine_of_64_asks_for_nothing() -> None:
    program = (
        "import struct\n"
        "from ramtek_emu.host import write_notices\n"
        "write_notices.PROGRAM = struct.Struct('=HxxI')\n"
        "try:\n    write_notices.ask_for_notices()\n"
        "except OSError:\n    raise SystemExit(3)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], env=environment(), timeout=60, check=False)
    assert done.returncode == 3
