"""The reference of what commands answer: their exit codes and messages, and what a shell completes.

Each command of the document is run in this process, in a folder of its own. A command gets a process of its
own if its subject is a pipe, a signal, a full disk or a missing screen. `python -m docs.generate.commands >
docs/COMMANDS.md` writes the document.
"""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import chdir, contextmanager, redirect_stderr, redirect_stdout
from io import BytesIO, TextIOWrapper
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from unittest.mock import patch

from autocolor.commands.autocolor import autocolor
from ramtek_emu.command_line import run_command
from ramtek_emu.commands.ramtek import ramtek

ROOT = Path(__file__).resolve().parents[2]

HEAD = """# The commands

`autocolor --help` and `ramtek --help` list the commands; `--help` of each has examples. This page is what the
commands themselves answered: `python -m docs.generate.commands > docs/COMMANDS.md` runs every line and
writes it.

Results go to stdout, messages to stderr. `-v` says what `autocolor` reads, creates and computes, and how long
that takes; `-vv` says more. `--debug` shows the traceback of an error. A character that cannot be printed, as
in the name of a file, is shown as an escape, such as `\\x1b`.

Ctrl+C, SIGTERM and SIGHUP end a command at once: each output is whole or as it was before, and the session of
a window can be recovered. A signal that is ignored when the command starts, as with `nohup`, stays ignored.

## Exit codes

A message says what must hold, what was found, and what to do. Of several lines, the table has the last one.

| code | means | for example | says |
|---|---|---|---|
"""

MEANINGS = {
    0: "done",
    1: "done, but with `--strict` something was repaired or left out, or `ramtek diff` found a difference",
    2: "the command line is wrong",
    65: "the input is wrong",
    66: "the input is not there",
    69: "no screen, no display at the address, a package is missing, or the processes of `--jobs` ended",
    70: "a fault of ours; the message says how to report it",
    71: "not enough memory",
    73: "the output exists, or cannot be made where it is",
    74: "writing failed",
    129: "ended by SIGHUP, as when a terminal is closed",
    130: "interrupted with Ctrl+C",
    141: "the reader of stdout left, as `head` does; nothing is said",
    143: "ended by SIGTERM",
}

COMMANDS = (
    (0, "ramtek play lines.ramtek -o lines.png"),
    (1, "autocolor validate torn.obj --strict"),
    (2, "autocolor rendr car"),
    (2, "autocolor render car --set ambient=abc"),
    (2, "autocolor render car --light kye"),
    (2, "autocolor sql car 'DELETE FROM lights'"),
    (65, "autocolor render broken.obj"),
    (66, "autocolor render nothing.obj"),
    (69, "autocolor view car"),
    (69, "autocolor show car --to tcp://127.0.0.1:1"),
    (73, "autocolor render car -o here.png"),
    (74, "autocolor info car > /dev/full"),
    (130, "ramtek play - -o new.png --record new.ramtek"),
    (141, "autocolor info car | true"),
)
"""The exit code of each command, and its line. Ctrl+C is pressed in the one that reads stdin."""

COMPLETION = """
## What a shell completes

Completion is that of click; a line in the start file of the shell turns it on, for each command that is
installed:

| shell | file | line |
|---|---|---|
| bash | `~/.bashrc` | `eval "$(_AUTOCOLOR_COMPLETE=bash_source autocolor)"` |
| zsh | `~/.zshrc` | `eval "$(_AUTOCOLOR_COMPLETE=zsh_source autocolor)"` |
| fish | `~/.config/fish/config.fish` | `_AUTOCOLOR_COMPLETE=fish_source autocolor \\| source` |

For `ramtek` it is `_RAMTEK_COMPLETE`, and `ramtek` at the end. The shell itself completes paths. Names, keys
and values are those of the scene or the picture that stands on the line before them. A scene that is large or
broken completes to nothing. bash splits a word at `=`, so it completes no value after a whole key; zsh and
fish do.

| typed, and Tab | candidates |
|---|---|
"""

LEFT = " | true"
"""The end of a line whose output nobody reads."""

ALONE = (LEFT, " > ", "ramtek ")
"""Parts of lines that are run in a process of their own: `ramtek` leaves it to the end to close its files."""

WITHOUT_SCREEN = "autocolor view car"
"""The line that looks for a screen, in a process of its own."""

LINES = (
    "autocolor re",
    "autocolor render car --light ",
    "autocolor render car --set lights.",
    "autocolor render car --set surfaces.body.two",
    "autocolor view car --set dith",
    "ramtek pl",
)

FILES = {
    "car/car.obj": "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\ng hood\nf 1 2 3 4\ng floor\nf 1 2 5\n",
    "car/scene.toml": '[[mesh]]\nfile = "car.obj"\n\n[parts.hood]\nsurface = "body"\n\n[surfaces.body]\n'
    '\n[surfaces.floor]\n\n[[lights]]\nname = "key"\nposition = [2, -3, 4]\naim = [0, 0, 0]\n'
    '\n[[lights]]\nname = "rim"\nposition = [-2, 3, 4]\n',
    "torn.obj": "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 1 1 2\n",
    "broken.obj": "v 0 0\n",
    "here.png": "",
    "lines.txt": "WVL FORE=255 STRT=10,10\n",
}
MADE = ("ramtek assemble lines.txt -o lines.ramtek",)


class Ran(NamedTuple):
    """How a command ended, and what it said last."""

    code: int
    said: str


@contextmanager
def folder() -> Iterator[Path]:
    """A folder with the files that the commands of the document name."""
    with TemporaryDirectory() as name:
        for path, text in FILES.items():
            (Path(name) / path).parent.mkdir(exist_ok=True)
            (Path(name) / path).write_text(text, encoding="utf-8")
        for line in MADE:
            assert ran(line, Path(name)).code == 0, line
        yield Path(name)


def process(line: str, place: Path) -> subprocess.Popen[str]:
    """The process of a line, in a folder and without a screen."""
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "PYTHONWARNINGS")
    environment = {key: value for key, value in os.environ.items() if key not in hidden}
    environment |= {"PYTHONPATH": str(ROOT), "COLUMNS": "1000", "LC_ALL": "C.UTF-8"}
    words, _, target = line.removesuffix(LEFT).partition(" > ")
    program, *arguments = shlex.split(words)
    module = {"autocolor": "autocolor", "ramtek": "ramtek_emu"}[program]
    with open(target or os.devnull, "wb") as file:
        started = subprocess.Popen(
            [sys.executable, "-m", module, *arguments],
            cwd=place,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=file if target else subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )
    if line.endswith(LEFT):
        # It has not begun to write: it takes longer than this to start.
        assert started.stdout is not None
        started.stdout.close()
        started.stdout = None
    return started


def ran(line: str, place: Path) -> Ran:
    """How a line ended. A line that reads stdin is interrupted once it has begun to record."""
    if not needs_process(line):
        code, out, err = here(line, place)
        return Ran(code, last_line(out, err))
    with process(line, place) as started:
        return _ended(line, place, started)


def needs_process(line: str) -> bool:
    """Whether a line is run in a process of its own."""
    return line == WITHOUT_SCREEN or any(part in line for part in ALONE)


def here(line: str, place: Path, **given: str) -> tuple[int, str, str]:
    """The exit code, stdout and stderr of a line that is run in this process."""
    program = line.split()[0]
    out, err = (TextIOWrapper(BytesIO(), "utf-8", write_through=True) for _ in range(2))
    with (
        chdir(place),
        patch.dict(os.environ, {"COLUMNS": "1000", **given}),
        patch("sys.argv", shlex.split(line)),
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        try:
            run_command({"autocolor": autocolor, "ramtek": ramtek}[program], program)
        except SystemExit as left:
            code = left.code
    assert isinstance(code, int)
    out.seek(0)
    err.seek(0)
    return code, out.read(), err.read()


def last_line(out: str | None, err: str) -> str:
    """The last line of a command's messages, or of its result if there are no messages."""
    lines = [text for text in (err or out or "").splitlines() if text]
    return lines[-1] if lines else ""


def _ended(line: str, place: Path, started: subprocess.Popen[str]) -> Ran:
    if " - " in line:
        # Its file appears when everything is loaded and it waits for stdin.
        before = time.monotonic()
        while not any(path.name.startswith((".new", "new")) for path in place.iterdir()):
            assert time.monotonic() - before < 30, f"{line} records nothing"
            time.sleep(0.01)
        time.sleep(0.3)
        started.send_signal(signal.SIGINT)
        assert started.stderr is not None
        code, out, err = started.wait(30), "", started.stderr.read()
    else:
        out, err = started.communicate("", timeout=60)
        code = started.returncode
    return Ran(code, last_line(out, err))


def completed(line: str, place: Path) -> list[str]:
    """The candidates that bash gets for a line whose last word is incomplete."""
    words = line.split(" ")
    name = f"_{words[0].upper()}"
    asked = {f"{name}_COMPLETE": "bash_complete", "COMP_CWORD": str(len(words) - 1)}
    code, out, err = here(words[0], place, COMP_WORDS="\n".join(words), **asked)
    assert (code, err) == (0, ""), err
    return [text.partition(",")[2] for text in out.splitlines() if text]


def document() -> str:
    """The whole reference."""
    parts = [HEAD]
    lines = [line for _, line in COMMANDS]
    with folder() as place, ThreadPoolExecutor(4) as pool:
        waiting = {line: pool.submit(ran, line, place) for line in lines if needs_process(line)}
        answers = [waiting[line].result() if line in waiting else ran(line, place) for line in lines]
        candidates = [completed(line, place) for line in LINES]
    for code, meaning in MEANINGS.items():
        rows = [
            (line, answer) for (each, line), answer in zip(COMMANDS, answers, strict=True) if each == code
        ]
        for line, answer in rows or [("", Ran(code, ""))]:
            assert answer.code == code, f"{line} ended with {answer.code}, not {code}: {answer.said}"
            parts.append(f"| {code} | {meaning} | {in_code(line)} | {in_code(answer.said)} |\n")
    parts.append(COMPLETION)
    for line, found in zip(LINES, candidates, strict=True):
        typed = f"`{line.rstrip()}`" + (" and a space" if line.endswith(" ") else "")
        parts.append(f"| {typed} | {', '.join(map(in_code, found)) or 'none'} |\n")
    return "".join(parts)


def in_code(text: str) -> str:
    """The text as code in a cell of a table; nothing for an empty one."""
    if not text:
        return ""
    return (f"`` {text} ``" if "`" in text else f"`{text}`").replace("|", "\\|")


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.stdout.write(document())
