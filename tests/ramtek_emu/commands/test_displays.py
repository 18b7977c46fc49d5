from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.shell_completion import BashComplete
from click.testing import CliRunner

from ramtek_emu import PRINCETON_9300, Ramtek9300, TcpPort, read_snapshot
from ramtek_emu.commands.ramtek import ramtek
from tests.ramtek_emu.processes import environment, run, started, stream
from tests.ramtek_emu.recorded_streams import COLOR_MAP, OUTLINE, words


@pytest.mark.parametrize("command", [[], ["play"], ["list"], ["serve"]])
def test_the_names_of_configurations_are_completed(command: list[str]) -> None:
    shell = BashComplete(ramtek, {}, "ramtek", "_RAMTEK_COMPLETE")
    found = shell.get_completions([*command, "--configuration"], "p")
    assert [item.value for item in found] == ["PRINCETON_9300"]


@pytest.mark.parametrize("command", ["play", "list", "assemble", "serve"])
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
    with started("serve", "--port", 0, "--record", record) as process:
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
