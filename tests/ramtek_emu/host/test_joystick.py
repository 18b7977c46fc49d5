from __future__ import annotations

import os
import random
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from ramtek_emu import MissingInputError, Ramtek9300
from ramtek_emu.host.joystick import JoystickLines, actions
from tests.ramtek_emu.serving import until


def done(display: Ramtek9300, line: str) -> None:
    for action in actions(line, display.joystick, display.reset):
        action()


def test_a_line_moves_presses_and_switches_in_order() -> None:
    display = Ramtek9300()
    done(display, "cursor 100 200 enter  # here")
    assert display.joystick.position == (100, 200)
    assert display.cursors[0].enter
    assert not display.joystick.track
    done(display, "track on by -30 +5")
    assert display.joystick.position == (70, 205)
    assert display.joystick.track
    done(display, "cursor 9999 -4 track off")
    assert display.joystick.position == (639, 0)
    assert not display.joystick.track
    done(display, "")
    done(display, "reset")
    assert not display.cursors[0].enter


@pytest.mark.parametrize(
    "line",
    ["walk", "cursor 1", "cursor 1 x", "cursor 1 2 3", "by 1e3 4", "track", "track up", "enter!",
     "cursor 1 12345678901", "cursor \u0663 4", "enter cursor 5 6 leave"],
)  # fmt: skip
def test_a_line_that_holds_anything_else_does_nothing_and_is_answered(line: str) -> None:
    display = Ramtek9300()
    with pytest.raises(ValueError, match="a joystick line must hold") as refusal:
        done(display, line)
    assert str(refusal.value) == (
        "a joystick line must hold cursor X Y, by X Y, enter, track on, track off or reset, "
        f"not {line!r}; write it so"
    )
    assert display.joystick.position == (0, 0)
    assert not display.cursors[0].enter


def obey_until(lines: JoystickLines, display: Ramtek9300, condition: Callable[[], bool]) -> None:
    def is_met() -> bool:
        lines.obey(display.joystick, display.reset)
        return condition()

    until(is_met)


def test_lines_of_a_fifo_are_obeyed_and_bad_lines_answered_with_their_number(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "stick")
    display = Ramtek9300()
    answers: list[str] = []
    lines = JoystickLines(str(tmp_path / "stick"), answers.append)
    for part in ("cursor 3 4\nup\n", "by 1 1\n"):
        (tmp_path / "stick").write_text(part)
    obey_until(lines, display, lambda: display.joystick.position == (4, 5))
    assert len(answers) == 1
    assert answers[0].startswith("joystick, line 2: a joystick line must hold")


@pytest.mark.parametrize(
    ("name", "sentence"),
    [(name, "a joystick's lines must come from a file or a FIFO") for name in ("none", ".", "a\0b")]
    + [("-", "not '-'")],
)
def test_lines_without_a_file_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, sentence: str
) -> None:
    monkeypatch.setattr(sys, "stdin", None)
    path = name if name == "-" else str(tmp_path / name)
    with pytest.raises(MissingInputError, match=sentence):
        JoystickLines(path, print)


def test_bytes_that_are_no_lines_are_read_in_bounded_memory(tmp_path: Path) -> None:
    path = tmp_path / "noise"
    noise = random.Random(1978).randbytes(200_000)
    path.write_bytes(noise + b"\n" + b"9" * 1_000_000 + b"\ncursor 5 6")
    display = Ramtek9300()
    answers: list[str] = []
    lines = JoystickLines(str(path), answers.append)
    obey_until(lines, display, lambda: display.joystick.position == (5, 6))
    assert all(len(answer) < 600 for answer in answers)
