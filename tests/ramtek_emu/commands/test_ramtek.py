from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from click.shell_completion import BashComplete

from ramtek_emu.command_line import run_command
from ramtek_emu.commands.ramtek import RamtekGroup, ramtek
from tests.ramtek_emu.processes import ROOT, run

NO_SCREEN = b"ramtek: a window must have a screen, and "


@pytest.mark.parametrize(
    ("arguments", "screen"),
    [((), {}), (("serve", "--port", "0", "--window"), {}), ((), {"DISPLAY": ":4711"})],
    ids=["none", "before the address is printed", "one that does not answer"],
)
def test_a_missing_screen_is_reported_in_one_sentence(
    arguments: tuple[str, ...], screen: dict[str, str]
) -> None:
    done = run(*arguments, data=b"", SDL_VIDEODRIVER="", **screen)
    assert (done.returncode, done.stdout) == (69, b"")
    assert done.stderr.startswith(NO_SCREEN)
    assert done.stderr.endswith(b"; run it on a desktop, or ask for a picture file instead\n")
    assert done.stderr.count(b"\n") == 1


REFUSED = (
    ("plai", 2, "Error: there is no command 'plai'"),
    ("-o -", 2, "Error: an output must be the name of a file, not '-'; give it one"),
    ("-o ''", 2, "Error: an output must be the name of a file, not ''; give it one"),
    ("--configuration gmr_9301 -o x.png", 2, "ramtek: a configuration must be"),
    ("play", 2, "Error: Missing argument 'STREAM'."),
    ("play none", 66, "ramtek: a stream must be a file that can be read, not 'none' (no such file"),
    ("play .", 66, "ramtek: a stream must be a file that can be read, not '.' (is a directory); check"),
    (
        "play - --configuration gmr_9300 --start s.png",
        2,
        "Error: a display must be given by --config",
    ),
    (
        "play - -o x.png --loads-per-second 30",
        2,
        "Error: --loads-per-second must not be given with an output",
    ),
    ("play - --loads-per-second 0", 2, "Error: Invalid value for '--loads-per-second'"),
    ("play none -o a.png --snapshot ./a.png", 2, "Error: two outputs must be two files, not a.png and "),
    ("play none -o a.png --record a.png", 2, "Error: two outputs must be two files"),
    ("play none -o a.jpg", 73, "ramtek: "),
    ("play none --snapshot a.jpg", 73, "ramtek: "),
    ("list none", 66, "ramtek: a stream must be a file that can be read, not 'none' (no such file"),
    ("list none --configuration gmr_9301", 2, "ramtek: a configuration must be"),
    ("assemble none -o ''", 2, "Error: an output must be the name of a file"),
    ("assemble none -o /none/at/all", 73, "ramtek: an output must have a folder"),
    ("assemble none -o -", 66, "ramtek: "),
    ("diff - -", 2, "Error: only one of the streams can be stdin, not both; name a file"),
    ("inspect - --who 0,480", 2, "Error: a line must be 0 to 479, not 480; choose a smaller number"),
    ("inspect - --who 640,0", 2, "Error: an element must be 0 to 639, not 640"),
    (
        "inspect - --who 5",
        2,
        "Error: Invalid value for '--who': a pixel must be two numbers with , between them, not '5'",
    ),
    ("inspect - --range 1..2", 2, "Error: a range must have an output; add -o OUT"),
    (
        "inspect - --range 3..2 -o a",
        2,
        "Error: a range must be A..B with 1 <= A <= B, not 3..2; correct it",
    ),
    ("inspect - --range 0..0 -o a", 2, "Error: a range must be A..B with 1 <= A <= B, not 0..0"),
    ("inspect - --range 1..1 --at 1 -o a", 2, "Error: a stream must be asked for --at or --range, not both"),
    ("inspect empty --at 1", 2, "Error: an instruction must be 0 to 0, not 1 (empty)"),
    ("serve", 2, "Error: a display must be served on one of --port, --unix and --stdio; give one of them"),
    ("serve --stdio --port 1", 2, "Error: a display must be served on one of --port"),
    ("serve --port 0 --unix x", 2, "Error: a display must be served on one of --port"),
    ("serve --unix x --host 0.0.0.0", 2, "Error: --host must not be given without --port"),
    ("serve --stdio --idle 9", 2, "Error: --idle must not be given with --stdio"),
    ("serve --stdio --once", 2, "Error: --once must not be given with --stdio"),
    ("serve --port 0 --once --window", 2, "Error: --once must not be given with a window"),
    ("serve --port 70000", 2, "Error: Invalid value for '--port'"),
    ("serve --stdio -o /none/at/all.png", 73, "ramtek: an output must have a folder"),
    ("serve --stdio -o a.jpg", 73, "ramtek: "),
    ("inspect empty -o a.jpg", 73, "ramtek: "),
    ("-o a.jpg", 73, "ramtek: "),
    ("serve --stdio --start empty", 65, "ramtek: a snapshot must be a whole PNG file"),
    ("serve --stdio --joystick -", 2, "Error: stdin must be for words or for the joystick, not both; give"),
    ("serve --stdio --joystick none", 66, "ramtek: a joystick's lines must"),
    ("serve --port 0 --joystick .", 66, "ramtek: a joystick's lines must"),
)
"""Arguments, the exit code, and the start of the sentence on stderr."""


@pytest.mark.parametrize(("arguments", "code", "sentence"), REFUSED)
def test_a_command_that_cannot_be_done_is_refused(
    arguments: str,
    code: int,
    sentence: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("empty").touch()
    monkeypatch.setattr(sys, "argv", ["ramtek", *shlex.split(arguments)])
    with pytest.raises(SystemExit) as left:
        run_command(ramtek, "ramtek")
    out, err = capsys.readouterr()
    assert (left.value.code, out) == (code, "")
    assert err.splitlines()[-1].startswith(sentence)
    assert os.listdir() == ["empty"]


BROKEN = {
    "missing": "raise ModuleNotFoundError(\"No module named 'pygame'\", name='pygame')",
    "half installed": "import pygame.base",
}


@pytest.mark.parametrize(
    ("kind", "arguments"),
    [("missing", ""), ("half installed", "serve --port 0 --window"), ("missing", "play -")],
)
def test_a_missing_or_broken_pygame_is_reported_with_the_package_to_install(
    tmp_path: Path, kind: str, arguments: str
) -> None:
    (tmp_path / "pygame.py").write_text(BROKEN[kind], "utf-8")
    path = f"{tmp_path}{os.pathsep}{ROOT}"
    done = run(*arguments.split(), PYTHONPATH=path)
    assert (done.returncode, done.stdout) == (69, b"")
    said = done.stderr.decode()
    assert said.startswith("ramtek: a window must have pygame, and it cannot be loaded (")
    name = "pygame" if sys.version_info < (3, 14) else "pygame-ce"
    assert said.endswith(f"); install it with `pip install {name}`, or ask for a picture file instead\n")
    assert said.count("\n") == 1
    if (kind, arguments) == ("missing", ""):
        picture = tmp_path / "pattern.png"
        assert run("-o", picture, PYTHONPATH=path).returncode == 0
        assert picture.stat().st_size > 1000


@pytest.mark.skipif(os.name != "posix", reason="pipes end otherwise there")
@pytest.mark.parametrize("arguments", ["list words", "assemble listing -o -", "serve --port 0 --once", "-h"])
def test_a_reader_that_leaves_ends_every_command_in_silence(tmp_path: Path, arguments: str) -> None:
    (tmp_path / "words").write_bytes(bytes(1000))
    (tmp_path / "listing").write_text("raw 0700\n", "ascii")
    read_end, write_end = os.pipe()
    os.close(read_end)
    left = subprocess.run(
        [sys.executable, "-m", "ramtek_emu", *arguments.split()],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        stdout=write_end,
        stderr=subprocess.PIPE,
        timeout=60,
        check=False,
    )
    os.close(write_end)
    assert (left.returncode, left.stderr) == (141, b"")


def test_help_has_examples_and_loads_nothing_heavy() -> None:
    script = (
        "import sys; from ramtek_emu.commands.ramtek import ramtek\n"
        "for command in sys.argv[1:]:\n"
        "    try: ramtek([*command.split(), '--help'])\n"
        "    except SystemExit: pass\n"
        "print(*sorted({'numpy', 'pygame', 'PIL'} & set(sys.modules)), file=sys.stderr)"
    )
    shown = subprocess.run(
        [sys.executable, "-c", script, "", *RamtekGroup.table], capture_output=True, text=True, check=True
    )
    assert shown.stdout.count("Examples:") == 1 + len(RamtekGroup.table)
    for command in RamtekGroup.table:
        assert f"  ramtek {command} " in shown.stdout
    assert shown.stderr.strip() == ""


@pytest.mark.parametrize("command", [[], ["play"], ["list"], ["serve"], ["inspect"], ["diff"]])
def test_the_names_of_configurations_are_completed(command: list[str]) -> None:
    shell = BashComplete(ramtek, {}, "ramtek", "_RAMTEK_COMPLETE")

    def names(text: str) -> list[str]:
        found = shell.get_completions([*command, "--configuration"], text)
        return [item.value for item in found]

    assert names("NCAR_") == ["ncar-9460", "ncar-9460-monochrome"]
    assert names("princeton-9300-m") == ["princeton-9300-monochrome"]
