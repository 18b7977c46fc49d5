from __future__ import annotations

import re
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from ramtek_emu import PRINCETON_9300, Ramtek9300, TcpPort, WriteError, instructions, read_snapshot
from ramtek_emu.command_line import ENDING
from ramtek_emu.commands.displays import Run, running
from ramtek_emu.commands.ramtek import ramtek
from ramtek_emu.writing import Output
from tests.ramtek_emu.processes import PipedHost, address_of, ended, field_of, run, started, stream
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


UNEXECUTED = "the display ended before it had executed all words of the host"
ATTACKS = (
    (row_of("serve --stdio -o", unread), signal.SIGHUP, ""),
    (row_of("serve --port", filling), signal.SIGINT, ""),
    (row_of("serve --stdio -o", filling), signal.SIGTERM, UNEXECUTED),
    (row_of("serve --unix", filling), signal.SIGHUP, ""),
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


def test_a_signal_ends_a_command_within_a_long_instruction(tmp_path: Path) -> None:
    drawn = np.concatenate((instructions.erase((0, 479, 639, 479), 7), words("0B03 0040 0 0 0 0 2")))
    # Lines to and fro, many times on each line of the picture, from its top to its bottom.
    path = np.stack((np.tile([0, 639], 16 * 480), np.repeat(np.arange(480), 32)), axis=1)
    long = instructions.write_vectors(path[:-32], 5)
    names = [tmp_path / name for name in OUTPUTS]
    outputs = ("-o", names[0], "--snapshot", names[1], "--record", names[2])
    with started("serve", "--stdio", *outputs) as process:
        host = PipedHost(process)
        host.send(np.concatenate((drawn, long)))
        assert host.receive(1) == 0
        said = ended(process, signal.SIGTERM)
    assert UNEXECUTED in said
    assert names[2].read_bytes() == stream(drawn)
    half_drawn = read_snapshot(names[1])
    lines = (half_drawn.words == 5).all(axis=1).tolist()
    assert lines == sorted(lines, reverse=True)
    assert not half_drawn.words[lines.count(True) + 1 : -1].any()
    assert (half_drawn.words[479] == 7).all()
    assert (field_of(names[0]) == half_drawn.field()).all()


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
        "words were drawn, and nothing is lit: --table gray shows them (F2 in a window)",
        "wrote s.png",
    ]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drawing", "s.png"]
    twin = Ramtek9300()
    twin.send(OUTLINE)
    assert np.array_equal(read_snapshot("s.png").words, twin.words)


def test_a_hint_comes_once_when_words_are_dark_or_an_instruction_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    display = Ramtek9300()
    with running(display) as run:
        assert run.hint(display) == ""
        display.send(OUTLINE)
        display.send(words("5065 3A00"))
        hints = run.hint(display)
        assert hints.split("; ", 1)[0].endswith("--table gray shows them (F2 in a window)")
        assert hints.endswith("a 9300 does not take FILL, but the display FAMILY does")
    assert capsys.readouterr().err.splitlines() == hints.split("; ", 1)


def test_a_hint_waits_until_a_host_rests() -> None:
    run, display = Run(), Ramtek9300()
    assert run.hint_at_rest(display, 5.0) == ""
    for seconds in (10.0, 10.9):
        # The host sends words, and none for up to 0.9 seconds.
        display.send(OUTLINE)
        assert run.hint_at_rest(display, seconds) == run.hint_at_rest(display, seconds + 0.9) == ""
    assert "nothing is lit" in run.hint_at_rest(display, 11.9)
    assert run.hint_at_rest(display, 99.0) == ""


def test_the_inspector_hints_at_the_end_of_a_dark_stream_and_with_its_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, hints = tmp_path / "outline.ramtek", []
    path.write_bytes(stream(OUTLINE))

    def look(monitor: Any, run: Run, _: object, may_hint: Callable[[], bool]) -> None:
        replay = monitor.source.session.replay
        for number in (0, len(replay.stream) - 1, len(replay.stream)):
            replay.go_to(number)
            given = [may_hint() and run.hint_at_rest(monitor.display, seconds) for seconds in (1.0, 3.0)]
            hints.append(given[1])

    monkeypatch.setattr("ramtek_emu.commands.inspect.show", look)
    CliRunner().invoke(ramtek, ["inspect", str(path)], catch_exceptions=False)
    assert hints[:2] == [False, False]
    drawn = CliRunner().invoke(ramtek, ["inspect", str(path), "-o", str(tmp_path / "a.png")])
    assert drawn.stderr.splitlines()[0] == hints[2] != ""


@pytest.mark.parametrize("command", ["play", "inspect"])
def test_a_table_of_grays_shows_a_stream(command: str, tmp_path: Path) -> None:
    path, output = tmp_path / "outline.ramtek", tmp_path / "a.png"
    path.write_bytes(stream(OUTLINE))
    shown = CliRunner().invoke(ramtek, [command, str(path), "--table", "gray", "-o", str(output)])
    assert shown.stderr == f"wrote {output}\n"
    display = Ramtek9300()
    display.send(OUTLINE)
    assert ((field_of(output)[..., 0] >= 64) == (display.words > 0)).all()
