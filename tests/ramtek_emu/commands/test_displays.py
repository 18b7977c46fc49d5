from __future__ import annotations

import re
import signal
import socket
import subprocess
import sys
import threading
from contextlib import ExitStack, suppress
from pathlib import Path

import numpy as np
import pytest
from click.shell_completion import BashComplete
from click.testing import CliRunner

from ramtek_emu import (
    PRINCETON_9300,
    PortError,
    Ramtek9300,
    TcpPort,
    UnixPort,
    WordsError,
    WriteError,
    instructions,
    read_snapshot,
)
from ramtek_emu.command_line import ENDING
from ramtek_emu.commands import displays
from ramtek_emu.commands.displays import running
from ramtek_emu.commands.ramtek import ramtek
from ramtek_emu.writing import Output
from tests.ramtek_emu import processes
from tests.ramtek_emu.processes import environment, field_of, run, stream
from tests.ramtek_emu.recorded_streams import COLOR_MAP, OUTLINE, words
from tests.ramtek_emu.serving import until
from tests.signals import Row, attack, filling, printing, recording, row_of, unread


@pytest.mark.parametrize("command", [[], ["play"], ["list"], ["serve"], ["inspect"], ["diff"]])
def test_the_names_of_configurations_are_completed(command: list[str]) -> None:
    shell = BashComplete(ramtek, {}, "ramtek", "_RAMTEK_COMPLETE")
    found = shell.get_completions([*command, "--configuration"], "p")
    assert [item.value for item in found] == ["PRINCETON_9300"]


def test_a_stream_that_is_read_whole_has_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "long"
    path.write_bytes(bytes(10))
    monkeypatch.setattr(displays, "MOST_READ", 10)
    assert len(displays.read_stream(str(path), PRINCETON_9300)) == 5
    monkeypatch.setattr(displays, "MOST_READ", 9)
    with pytest.raises(WordsError, match="at most 9 bytes here"):
        displays.read_stream(str(path), PRINCETON_9300)


@pytest.mark.parametrize("command", ["play", "list", "assemble", "serve", "inspect", "diff"])
def test_help_has_examples_and_loads_nothing_heavy(command: str) -> None:
    script = (
        "import sys; from ramtek_emu.commands.ramtek import ramtek\n"
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


def test_recordings_hold_whole_instructions(tmp_path: Path) -> None:
    record = tmp_path / "hosts.ramtek"
    with processes.started("serve", "--port", 0, "--record", record) as process:
        assert process.stdout is not None
        address = process.stdout.readline().decode().strip()
        for part in (OUTLINE, words("0A03 0040 0 0"), COLOR_MAP):
            with TcpPort(address) as port:
                port.send(part)
                port.send(words("0B01 0002"))
                if part[0] != 0x0A03:
                    port.receive(1)
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 0
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


@pytest.mark.parametrize("other", ["--snapshot", "--record"])
def test_two_outputs_of_one_name_are_refused_before_anything_is_done(tmp_path: Path, other: str) -> None:
    arguments = ["play", str(tmp_path / "none"), "-o", str(tmp_path / "a.png"), other, f"{tmp_path}/./a.png"]
    played = CliRunner().invoke(ramtek, arguments)
    assert played.exit_code == 2
    assert "two outputs must be two files, not" in played.output
    assert list(tmp_path.iterdir()) == []


ATTACKS = (
    (row_of("serve --stdio -o", filling), signal.SIGTERM, r"[0-9],[0-9]{3} words of the host arrived and"),
    (row_of("serve --stdio -o", unread), signal.SIGHUP, ""),
    (row_of("serve --unix", filling), signal.SIGHUP, r"[0-9],[0-9]{3} words of the host arrived and"),
    (row_of("serve --port", filling), signal.SIGINT, r"[0-9],[0-9]{3} words of the host arrived and"),
    (row_of("play", recording), signal.SIGHUP, ""),
    (row_of("list", printing), signal.SIGTERM, ""),
)


@pytest.mark.parametrize(("row", "number", "said"), ATTACKS)
def test_a_signal_ends_a_command_in_order_at_any_moment(
    row: Row, number: signal.Signals, said: str, tmp_path: Path
) -> None:
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


@pytest.mark.parametrize(("command", "code"), [("play -", 143), ("serve --stdio", 0), ("serve --port 0", 0)])
def test_a_signal_ends_a_command_within_a_long_instruction(command: str, code: int, tmp_path: Path) -> None:
    drawn = instructions.erase((0, 479, 639, 479), 7)
    # Lines to and fro, from the top of the picture to its bottom.
    path = np.stack((np.tile([0, 639, 639, 0], 240), np.repeat(np.arange(480), 2)), axis=1)
    long = instructions.write_vectors(path[:-2], 5)
    process = subprocess.Popen(
        [
            sys.executable,
            "-c",
            STOPPED_WITHIN,
            *command.split(),
            "-o",
            "o.png",
            "--snapshot",
            "s.png",
            "--record",
            "r",
        ],
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


@pytest.mark.parametrize("command", [["play", "drawing"], ["serve", "--once", "--unix", "display"]])
def test_a_recording_that_fails_is_reported_once_and_the_display_goes_on_without_it(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drawing").write_bytes(stream(OUTLINE))

    def fail(output: Output, _: bytes) -> None:
        raise WriteError(f"{output.path.name} is full")

    ports: list[UnixPort] = []

    def is_reached() -> bool:
        # The socket's file is there before the server listens.
        with suppress(PortError):
            ports.append(UnixPort("display"))
        return bool(ports)

    def draw() -> None:
        until(is_reached)
        with ports[0] as port:
            for part in np.array_split(OUTLINE, 3):
                port.send(part)

    monkeypatch.setattr(Output, "write", fail)
    monkeypatch.setattr(
        "ramtek_emu.snapshot.write_atomically", lambda path, data, **_: Path(path).write_bytes(data)
    )
    host = threading.Thread(target=draw)
    if command[0] == "serve":
        host.start()
    done = CliRunner().invoke(ramtek, [*command, "--record", "r.ramtek", "--snapshot", "s.png"])
    assert done.exit_code == 74
    assert done.stderr.splitlines() == [
        "ramtek: r.ramtek is full",
        "the display goes on without its recording",
        "wrote s.png",
    ]
    if command[0] == "serve":
        host.join()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drawing", "s.png"]
    twin = Ramtek9300()
    twin.send(OUTLINE)
    assert np.array_equal(read_snapshot("s.png").words, twin.words)
