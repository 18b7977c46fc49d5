"""`ramtek tty` as people use it: a program, its device, and a display that another process serves."""

from __future__ import annotations

import errno
import os
import platform
import pty
import random
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from docs.generate.blocks import blocks_of
from ramtek_emu import PortError, Ramtek9300, instructions
from ramtek_emu.commands.tty import refuse_systems_without_pidfd, terminal
from ramtek_emu.host.device import MACHINES
from ramtek_emu.host.server import UnixServer
from tests.ramtek_emu.processes import ROOT, environment, run, started, stream
from tests.ramtek_emu.recorded_streams import words
from tests.ramtek_emu.serving import serving_at, until

OLD_PROGRAM = """
import os, sys
device = os.open(sys.argv[1] if len(sys.argv) > 1 else os.environ["RAMTEK_DEVICE"], os.O_RDWR)
os.write(device, bytes.fromhex("030c 4000 0000 0000 4001 0900 0600 5645 4e45 3231 00"))
os.write(device, bytes.fromhex("0017"))
reply = b""
while len(reply) < 4:
    reply += os.read(device, 4 - len(reply))
print(reply.hex())
sys.exit(7)
"""


@pytest.fixture
def display(tmp_path: Path) -> Iterator[UnixServer]:
    with serving_at(tmp_path / "display") as server:
        yield server


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "old.py"
    path.write_text(OLD_PROGRAM)
    return path


def tty(display: UnixServer, *command: object) -> subprocess.CompletedProcess[bytes]:
    done = run("tty", display.address, "--", *command)
    said = done.stderr.decode()
    if said.startswith("ramtek: a system must tell one write") and "resource busy" not in said:
        pytest.skip(said)
    return done


def test_a_program_s_odd_write_is_rounded_down_alone_and_its_reply_comes_back(
    display: UnixServer, program: Path
) -> None:
    for device in ([], ["{}"]):
        done = tty(display, sys.executable, program, *device)
        assert (done.returncode, done.stdout, done.stderr) == (7, b"00000000\n", b"")
    twin = Ramtek9300()
    twin.send(words("0C03 0040 0 0 0140 0009 0006 4556 454E 3132"))
    assert twin.words.any()
    assert (display.display.words == twin.words).all()


MANY_WRITES = """
import os, sys
device = os.open(os.environ["RAMTEK_DEVICE"], os.O_RDWR)
data = open(sys.argv[1], "rb").read()
for size in map(int, open(sys.argv[2])):
    assert os.write(device, data[:size]) == size
    data = data[size:]
"""


def test_quick_writes_of_all_sizes_are_rounded_down_singly(display: UnixServer, tmp_path: Path) -> None:
    draw = random.Random(1983)
    written, expected, sizes = b"", [], []
    for number in range(600):
        length = draw.choice([0, 1, 9, 300, 1023, 1024, 2040, 2047, 5000, 20_000])
        pixel = stream(words(f"0902 0044 {number + 1:X} {number:X} 9 {number:X} 9"))
        image = stream(words(f"0A03 0040 0 64 27F 1DF {2 * length:X}")) + stream(np.full(length, 0x0700))
        write = pixel + image + b"!" * draw.randint(0, 1)
        written += write
        sizes.append(len(write))
        expected.append(number + 1)
    (tmp_path / "data").write_bytes(written)
    (tmp_path / "sizes").write_text("\n".join(map(str, sizes)))
    (tmp_path / "many.py").write_text(MANY_WRITES)
    done = tty(display, sys.executable, tmp_path / "many.py", tmp_path / "data", tmp_path / "sizes")
    assert (done.returncode, done.stderr) == (0, b"")
    assert display.display.words[9, :600].tolist() == expected
    assert display.display.processor.illegal_words == 0


READS_AN_IMAGE = r"""
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int main(void)
{
    static unsigned char instruction[] = {0x01, 0x0B, 0xFE, 0xFF}, reply[65534];
    int device = open(getenv("RAMTEK_DEVICE"), O_RDWR);
    ssize_t got;

    write(device, instruction, 4);
    got = read(device, reply, sizeof reply);
    printf("%zd %d %d\n", got, reply[65532], reply[65533]);
    return 0;
}
"""


def test_the_library_of_the_docs_makes_every_read_of_a_program_whole(
    display: UnixServer, tmp_path: Path
) -> None:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("a C compiler is not installed")
    (library,) = [
        block.text for block in blocks_of((ROOT / "docs" / "RAMTEK.md").read_text()) if block.language == "c"
    ]
    (tmp_path / "whole_reads.c").write_text(library)
    (tmp_path / "old.c").write_text(READS_AN_IMAGE)
    for command in ("-shared -fPIC -o whole_reads.so whole_reads.c -ldl", "-o old old.c"):
        subprocess.run([compiler, *command.split()], cwd=tmp_path, check=True, capture_output=True)
    display.display.send(instructions.write_image(np.full((480, 640), 0x155)))
    preload = f"LD_PRELOAD={tmp_path / 'whole_reads.so'}"
    done = tty(display, "env", preload, tmp_path / "old")
    assert (done.returncode, done.stdout, done.stderr) == (0, b"65534 85 1\n", b"")
    # The library leaves all other files alone.
    done = tty(display, "env", preload, "sh", "-c", "printf 'one\\ntwo' | { read line; echo $line; }")
    assert (done.returncode, done.stdout, done.stderr) == (0, b"one\n", b"")


LINE_BUFFERED = """
import os, re
device = os.open(os.environ["RAMTEK_DEVICE"], os.O_RDWR)
words = bytes.fromhex(%r)
for line in re.findall(rb"[^\\n]*\\n|[^\\n]+", words):
    os.write(device, line)
"""


def test_a_stream_joins_the_lines_that_stdio_makes_of_words(display: UnixServer) -> None:
    drawing = stream(words("0902 0044 10A 5 A 5 A 0902 0044 7 A 6 A 6"))
    program = [sys.executable, "-c", LINE_BUFFERED % drawing.hex()]
    done = run("tty", "--stream", display.address, "--", *program)
    assert (done.returncode, done.stderr) == (0, b"")
    assert (display.display.words[10, 5], display.display.words[6, 10]) == (0x10A, 7)


IN_A_SANDBOX = """
import ctypes, os, platform, sys
from ramtek_emu.host.device import *
number = MACHINES[platform.machine()].seccomp
ends, allows = (RETURN, 0, 0, 0x80000000), (RETURN, 0, 0, 0x7FFF0000)
steps = ((LOAD, 0, 0, 0), (JUMP_IF_EQUAL, 0, 1, number), ends, allows)
data = ctypes.create_string_buffer(b"".join(INSTRUCTION.pack(*step) for step in steps))
program = ctypes.create_string_buffer(PROGRAM.pack(len(steps), ctypes.addressof(data)))
library = ctypes.CDLL(None)
assert library.prctl(38, *map(ctypes.c_ulong, (1, 0, 0, 0))) == 0
assert library.prctl(22, ctypes.c_ulong(2), program) == 0
os.execv(sys.executable, [sys.executable, "-m", "ramtek_emu", *sys.argv[1:]])
"""


def test_a_sandbox_that_kills_for_asking_for_notices_runs_nothing(display: UnixServer) -> None:
    if platform.machine() not in MACHINES:
        pytest.skip("needs a machine with notices")
    for options, code, said in (
        ([], 69, REFUSAL.format("asking for it is forbidden")),
        (["--stream"], 5, ""),
    ):
        arguments = ["tty", *options, display.address, "--", "sh", "-c", "exit 5"]
        done = subprocess.run(
            [sys.executable, "-c", IN_A_SANDBOX, *arguments],
            env=environment(),
            capture_output=True,
            timeout=60,
            check=False,
        )
        assert (done.returncode, done.stderr.decode()) == (code, said)


def test_a_system_that_cannot_wait_for_a_program_is_refused_before_it_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refused(process: int) -> int:
        raise OSError(errno.ENOSYS, "Function not implemented")

    monkeypatch.setattr(os, "pidfd_open", refused, raising=False)
    with pytest.raises(PortError, match=r"must be made on Linux 5.3 or later, not on .*; pipe the program"):
        refuse_systems_without_pidfd()


def test_a_system_without_pseudoterminals_left_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused() -> tuple[int, int]:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(pty, "openpty", refused)
    with pytest.raises(PortError, match="a pseudoterminal, and the system gives none"), terminal():
        pass


def test_the_shell_redirects_a_program_to_the_device(display: UnixServer) -> None:
    script = r'printf "\002\011\104\000\007\000\005\000\005\000\005\000\005\000!" > "$RAMTEK_DEVICE"; exit 3'
    assert tty(display, "sh", "-c", script).returncode == 3
    assert display.display.words[5, 5] == 7


def test_a_link_to_the_device_exists_while_the_program_runs(
    display: UnixServer, program: Path, tmp_path: Path
) -> None:
    link = tmp_path / "ramtek"
    done = run("tty", "--link", link, display.address, "--", sys.executable, program, link)
    assert done.returncode == 7
    assert not link.exists()
    link.write_text("mine")
    refused = run("tty", "--link", link, display.address, "--", sys.executable, program, link)
    assert refused.returncode == 73
    assert refused.stderr.decode() == (
        f"ramtek: a link must be a new name, not {link}, which exists; choose another\n"
    )
    assert link.read_text() == "mine"


def test_the_link_of_a_killed_tty_is_replaced_and_that_of_a_running_tty_is_not(
    display: UnixServer, tmp_path: Path
) -> None:
    link = tmp_path / "ramtek"
    waiting = ("tty", "--stream", "--link", link, display.address, "--", "sh", "-c", "echo ready; read _")
    with started(*waiting) as killed:
        assert killed.stdout is not None
        assert killed.stdout.readline() == b"ready\n"
        refused = run(*waiting)
        assert refused.returncode == 73
        assert b"a link must be a new name" in refused.stderr
        killed.kill()
        killed.wait()
    assert run(*waiting).returncode == 1
    assert not link.is_symlink()
    # Another program has this terminal, and may have linked it.
    ours, theirs = os.openpty()
    link.symlink_to(os.ttyname(theirs))
    assert run(*waiting).returncode == 73
    assert link.is_symlink()
    os.close(ours)
    os.close(theirs)


def test_a_program_that_a_signal_ends_gives_its_number(display: UnixServer) -> None:
    assert tty(display, "sh", "-c", "kill -9 $$").returncode == 137


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129), (signal.SIGINT, 42)]
)
def test_signals_are_the_program_s(display: UnixServer, number: signal.Signals, code: int) -> None:
    script = "trap 'exit 42' INT; echo ready; while :; do sleep 0.05; done"
    with started("tty", display.address, "--", "sh", "-c", script) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        if number == signal.SIGINT:
            # As a terminal does: all processes of the group get it.
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            for child in children:
                os.kill(int(child), number)
        process.send_signal(number)
        assert process.wait(60) == code


def test_a_file_that_is_no_program_is_refused(display: UnixServer, tmp_path: Path) -> None:
    (tmp_path / "broken").write_bytes(b"\0\1\2")
    (tmp_path / "broken").chmod(0o755)
    broken = tty(display, tmp_path / "broken")
    assert broken.returncode == 66
    assert b"exec format error" in broken.stderr


def test_a_display_that_leaves_hangs_up_the_program(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display") as server:
        script = "echo ready; exec sleep 60"
        process = subprocess.Popen(
            [sys.executable, "-m", "ramtek_emu", "tty", server.address, "--", "sh", "-c", script],
            env=environment(),
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
    _, said = process.communicate(timeout=60)
    assert process.returncode == 69
    assert b"while a program uses it, and it left" in said


def test_without_notices_a_program_is_run_only_as_a_stream(display: UnixServer, tmp_path: Path) -> None:
    # The kernel gives notices of a process to only one other process: the inner relay gets none.
    with serving_at(tmp_path / "outer") as outer:
        for options in ([], ["--stream"]):
            inner = [sys.executable, "-m", "ramtek_emu", "tty", *options, display.address, "--"]
            done = tty(outer, *inner, sys.executable, "-c", IN_TWO_WRITES)
            if options:
                assert (done.returncode, done.stderr) == (0, b"")
                assert display.display.words[5, 5] == 7
            else:
                assert done.returncode == 69
                assert done.stderr.decode() == REFUSAL.format("device or resource busy")
                assert display.display.words_received == 0


REFUSAL = (
    "ramtek: a system must tell one write of a program from the next, and this one does not ({}); "
    "give --stream if the program's writes are one stream of bytes\n"
)
IN_TWO_WRITES = """
import os
device = os.open(os.environ["RAMTEK_DEVICE"], os.O_RDWR)
for data in ("0209 4400 0700 0500 05", "00 0500 0500"):
    os.write(device, bytes.fromhex(data))
"""


def test_the_documented_socat_recipe_ends_when_the_program_closes_its_device(
    program: Path, tmp_path: Path
) -> None:
    if shutil.which("socat") is None:
        pytest.skip("socat is not installed")
    recipe = next(line for line in GUIDE.splitlines() if line.startswith("socat PTY"))
    device = tmp_path / "ramtek"
    assert "/tmp/ramtek" in recipe
    display = f"{sys.executable} -m ramtek_emu serve"
    command = recipe.partition("&")[0].replace("/tmp/ramtek", str(device)).replace("ramtek serve", display)
    with subprocess.Popen(command, shell=True, cwd=tmp_path, env=environment()) as relay:
        until(device.exists)
        number = os.open(device, os.O_RDWR)
        os.write(number, stream(words("0902 0044 7 5 5 5 5 0B03 0040 5 5 5 5 2")))
        assert os.read(number, 2) == b"\x07\0"
        os.close(number)
        assert relay.wait(60) == 0
    assert (tmp_path / "drawing.png").exists()


GUIDE = (ROOT / "docs" / "RAMTEK.md").read_text("utf-8")
