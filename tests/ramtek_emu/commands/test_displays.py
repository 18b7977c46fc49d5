from __future__ import annotations

import re
import signal
import socket
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from ramtek_emu import PRINCETON_9300, Ramtek9300, TcpPort, WriteError, instructions, read_snapshot
from ramtek_emu.command_line import ENDING
from ramtek_emu.commands.displays import running
from ramtek_emu.commands.ramtek import ramtek
from ramtek_emu.writing import Output
from tests.ramtek_emu.processes import address_of, ended, environment, field_of, run, started, stream
from tests.ramtek_emu.recorded_streams import COLOR_MAP, OUTLINE, words
from tests.signals import Row, attack, filling, printing, recording, row_of, unread
from tests.tables import first


def test_recordings_hold_whole_instructions(tmp_path: Path) -> None:
    record = tmp_path / "hosts.ramtek"
    read = words("0B01 0002")
    with started("serve", "--port", 0, "--record", record) as process:
        address = address_of(process)
        for part in (OUTLINE, words("0A03 0040 0 0"), COLOR_MAP):
            with TcpPort(address) as port:
                port.send(part)
                port.send(read)
                if part[0] != 0x0A03:
                    port.receive(1)
        ended(process, signal.SIGTERM)
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


UNEXECUTED = r"[0-9],[0-9]{3} words of the host arrived and"
ATTACKS = (
    (row_of("serve --stdio -o", unread), signal.SIGHUP, ""),
    (row_of("serve --port", filling), signal.SIGINT, UNEXECUTED),
    (row_of("serve --stdio -o", filling), signal.SIGTERM, UNEXECUTED),
    (row_of("serve --unix", filling), signal.SIGHUP, UNEXECUTED),
    (row_of("play", recording), signal.SIGHUP, ""),
    (row_of("list", printing), signal.SIGTERM, ""),
)


@pytest.mark.parametrize("attacked", first(2, ATTACKS), ids=range(len(ATTACKS)))
def test_a_signal_ends_a_command_in_order_at_any_moment(
    attacked: tuple[Row, signal.Signals, str], tmp_path: Path
) -> None:
    row, number, said = attacked
    assert re.search(said, attack(row, number, tmp_path)[1])


OUTPUTS = ("o.png", "s.png", "r.ramtek")


STOPPED_WITHIN = """
import sys, time
from ramtek_emu.__main__ import main
from ramtek_emu.commands.displays import Run
from ramtek_emu.host import server
from ramtek_emu.memory.frame_buffer import FrameBuffer

# Pause after every slice, however fast the machine is.
server.SLICE_SECONDS = 0
signals = []
receive, write_points = Run.receive, FrameBuffer.write_points

def receive_and_note(run, number, frame):
    signals.append(number)
    receive(run, number, frame)

def write_points_and_wait(self, *arguments):
    write_points(self, *arguments)
    if self.written >= 100_000 and not signals:
        print("within", file=sys.stderr, flush=True)
        while not signals:
            time.sleep(0.001)

Run.receive, FrameBuffer.write_points = receive_and_note, write_points_and_wait
main()
"""
"""A program that runs a command, and waits for a signal when 100,000 words are written."""


@pytest.mark.parametrize(
    ("command", "code"),
    [("play -", 143), ("serve --port 0", 0), pytest.param("serve --stdio", 0, marks=pytest.mark.thorough)],
)
def test_a_signal_ends_a_command_within_a_long_instruction(command: str, code: int, tmp_path: Path) -> None:
    drawn = instructions.erase((0, 479, 639, 479), 7)
    # Lines to and fro, from the top of the picture to its bottom.
    path = np.stack((np.tile([0, 639, 639, 0], 240), np.repeat(np.arange(480), 2)), axis=1)
    long = instructions.write_vectors(path[:-2], 5)
    outputs = ["-o", "o.png", "--snapshot", "s.png", "--record", "r"]
    process = subprocess.Popen(
        [sys.executable, "-c", STOPPED_WITHIN, *command.split(), *outputs],
        cwd=tmp_path,
        env=environment(),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    data = stream(np.concatenate((drawn, long)))
    with ExitStack() as stack:
        stack.callback(process.kill)
        if "--port" in command:
            host = stack.enter_context(
                socket.create_connection(("127.0.0.1", int(process.stdout.readline().rpartition(b":")[2])))
            )
            host.sendall(data)
        else:
            process.stdin.write(data)
            process.stdin.flush()
        assert process.stderr.readline() == b"within\n"
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=60)
    assert process.returncode == code
    assert f"{len(long):,} words of the host arrived and were not executed".encode() in said
    assert (tmp_path / "r").read_bytes() == stream(drawn)
    half_drawn = read_snapshot(tmp_path / "s.png")
    assert (half_drawn.words[:150] == 5).all()
    assert not half_drawn.words[-100:-1].any()
    assert (half_drawn.words[479] == 7).all()
    assert half_drawn.words[half_drawn.processor.parameters.start[::-1]] == 5
    assert (field_of(tmp_path / "o.png") == half_drawn.field()).all()


def test_signals_lose_no_output_also_while_the_outputs_are_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    handlers = [signal.getsignal(number) for number in ENDING]
    display = Ramtek9300()
    save = display.save_png

    def interrupted(path: str, overwrite: bool) -> None:
        for number in ENDING:
            signal.raise_signal(number)
        save(path, overwrite)

    monkeypatch.setattr(display, "save_png", interrupted)
    with running(display, *OUTPUTS) as run:
        assert not run.ends
        for number in ENDING:
            signal.raise_signal(number)
        assert run.signal == ENDING[0]
        assert not run.wait(0)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(OUTPUTS)
    assert [signal.getsignal(number) for number in ENDING] == handlers


def test_a_signal_that_was_ignored_before_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with running(Ramtek9300()) as run:
            signal.raise_signal(signal.SIGHUP)
            assert not run.ends
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_recording_that_fails_is_reported_once_and_the_display_goes_on_without_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("drawing").write_bytes(stream(np.tile(OUTLINE, 50)))

    def fail(output: Output, _: bytes) -> None:
        raise WriteError(f"{output.path.name} is full")

    monkeypatch.setattr(Output, "write", fail)
    monkeypatch.setattr(
        "ramtek_emu.snapshot.write_atomically", lambda path, data, **_: Path(path).write_bytes(data)
    )
    done = CliRunner().invoke(ramtek, ["play", "drawing", "--record", "r.ramtek", "--snapshot", "s.png"])
    assert done.exit_code == 74
    assert done.stderr.splitlines() == [
        "ramtek: r.ramtek is full",
        "the display goes on without its recording",
        "wrote s.png",
    ]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drawing", "s.png"]
    twin = Ramtek9300()
    twin.send(OUTLINE)
    assert np.array_equal(read_snapshot("s.png").words, twin.words)
