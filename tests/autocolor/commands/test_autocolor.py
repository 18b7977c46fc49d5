"""The command as it is started: help, errors, pipes, signals and environments; and rules of all commands."""

from __future__ import annotations

import os
import re
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest

from autocolor.commands.autocolor import AutocolorGroup
from tests.autocolor.commands.conftest import SMALL, Refused, Run, is_same
from tests.autocolor.commands.test_view import monitors as monitors
from tests.tables import first

SLOW = ("numpy", "pygame", "pydantic", "PIL")
POSIX = pytest.mark.skipif(os.name != "posix", reason="needs what POSIX says about pipes and signals")

COLOR = "surfaces.side.object_color"
WRITING = {
    "render": "render scene --size 32x24 -o made.png",
    "recolor": "recolor scene.npz side -o made.png",
    "palette": "palette scene.npz side -o made.gpl",
    "sweep": f"sweep scene.npz --vary {COLOR}=red -o made.png",
    "page": "page scene.npz -o made.html",
    "animate": f"animate scene.npz --vary {COLOR}=red,blue --frames 2 -o made.webp",
    "convert": "convert scene made.obj",
}
PRINTING = {
    "info": "info scene",
    "explain": "explain scene 12 16 --size 32x24",
    "validate": "validate scene",
    "tables": "tables scene",
    "sql": "sql scene 'SELECT name FROM lights'",
}
SHOWING = {
    "view": "view scene",
    "show": "show scene --to tcp://127.0.0.1:1",
    "tutorial": "tutorial --to tcp://127.0.0.1:1",
}
LINES = SHOWING | PRINTING | WRITING
"""A line of each command that works, if its display is there."""


# Rules of all commands.


def test_every_command_has_a_line_to_try() -> None:
    assert LINES.keys() == AutocolorGroup.table.keys()


@pytest.mark.parametrize("command", AutocolorGroup.table)
def test_the_help_of_each_command_has_an_example(run: Run, command: str) -> None:
    ran = run(command, "--help")
    assert (ran.code, ran.err) == (0, "")
    assert "Examples:" in ran.out
    assert f"\n    autocolor {command} " in ran.out
    if " SCENE" in ran.out.partition("\n\n")[0]:
        for option in ("--up [x|y|z]", "--scale FACTOR", "--surfaces [materials|parts]", "--strict"):
            assert option in ran.out


@pytest.mark.parametrize("command", AutocolorGroup.table)
def test_an_unknown_option_is_wrong_usage_and_says_how_to_get_help(
    folder: Path, run: Run, command: str
) -> None:
    ran = run(*shlex.split(LINES[command]), "--nothing")
    assert (ran.code, ran.out) == (2, "")
    assert "--nothing" in ran.err
    # The hint names the first option for help; which of the two is first depends on click.
    assert re.search("(-h|--help)' for help.", ran.err)


@pytest.mark.parametrize("command", [each for each in AutocolorGroup.table if each != "tutorial"])
def test_a_file_that_is_not_there_is_missing(refused: Refused, command: str) -> None:
    line = re.sub(r" scene\b(\.npz)?", " none.npz", LINES[command])
    assert refused(line, 66).endswith("none.npz: there is no such file or folder; check the name")


@pytest.mark.parametrize(
    "command", [each for each in LINES if each != "show" and re.search(r" scene\b(?!\.)", LINES[each])]
)
def test_a_repair_is_told_and_counts_under_strict(
    folder: Path, run: Run, monitors: list[Any], command: str
) -> None:
    mesh = folder / "two.obj"
    mesh.write_text(f"{mesh.read_text()}f 1 1 2\n")
    ran = run(*shlex.split(re.sub(r" scene\b", " two.obj", LINES[command])), "--strict")
    assert ran.code == 1
    assert ran.err.startswith("autocolor: two.obj")


@pytest.mark.parametrize("command", WRITING)
def test_a_file_of_that_name_is_kept_without_force(
    saved: Path, run: Run, refused: Refused, command: str
) -> None:
    line = shlex.split(WRITING[command])
    (name,) = (word for word in line if word.startswith("made."))
    Path(name).write_bytes(b"mine")
    assert "with --force" in refused(WRITING[command], 73)
    ran = run(*line, "--force")
    assert ran.code == 0
    assert Path(name).read_bytes() != b"mine"
    assert command == "sweep" or f"wrote {name}" in ran.err


# The group.


def test_the_help_names_every_command(run: Run) -> None:
    for flag in ("--help", "-h"):
        ran = run(flag)
        assert (ran.code, ran.err) == (0, "")
        for command, does in AutocolorGroup.table.items():
            assert re.search(rf"^  {command} +{does}$", ran.out, re.MULTILINE)


def test_help_comes_without_loading_anything_slow(process: Run) -> None:
    program = f"""
import sys, autocolor.__main__ as m
for command in {["", *AutocolorGroup.table]!r}:
    sys.argv[1:] = [command, "--help"] if command else ["--help"]
    try:
        m.main()
    except SystemExit as left:
        assert left.code == 0
    print(command, [name for name in {SLOW!r} if name in sys.modules], file=sys.stderr)
"""
    ran = process(command=[sys.executable, "-c", program])
    assert ran.code == 0
    assert ran.out.count("Usage: autocolor") == len(AutocolorGroup.table) + 1
    assert [line for line in ran.err.splitlines() if not line.endswith(" []")] == []


# What only a process of its own shows.

AT_AN_IMPORT = """
import signal, sys
module = sys.argv.pop(1)
class Interrupts:
    def find_spec(self, name, path=None, target=None):
        if name == module:
            sys.meta_path.remove(self)
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Interrupts())
from {package}.__main__ import main
main()
"""


@POSIX
@pytest.mark.parametrize(
    ("package", "module", "code"),
    [
        ("autocolor", "click", -2),
        ("autocolor", "numpy", 130),
        pytest.param("autocolor", "autocolor.commands.autocolor", -2, marks=pytest.mark.thorough),
        pytest.param("ramtek_emu", "click", -2, marks=pytest.mark.thorough),
    ],
)
def test_an_interrupt_while_the_command_starts_shows_no_traceback(
    process: Run, package: str, module: str, code: int
) -> None:
    arguments = ["play", "-"] if package == "ramtek_emu" else ["render", "two.obj"]
    ran = process(command=[sys.executable, "-c", AT_AN_IMPORT.format(package=package), module, *arguments])
    assert (ran.code, ran.out) == (code, "")
    assert ran.err == ("autocolor: interrupted\n" if code == 130 else "")


@POSIX
@pytest.mark.parametrize("closed", first(1, ["<&- >&- 2>&-", ">&-", "2>&-"]))
def test_a_closed_stdout_or_stderr_keeps_no_picture_from_being_written(
    process: Run, run: Run, folder: Path, closed: str
) -> None:
    line = f'exec "$0" -m autocolor render two.obj --size 32x24 -o 1.png {closed}'
    assert process(command=["sh", "-c", line, sys.executable]).code == 0
    assert run("render", "two.obj", "--size", "32x24", "-o", "2.png").code == 0
    assert is_same("1.png", "2.png")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
def test_a_stdout_that_is_full_is_told(process: Run) -> None:
    with open("/dev/full", "wb") as full:
        ran = process("info", "two.obj", stdout=full)
        assert ran.code == 74
        assert ran.err == (
            "autocolor: stdout must take what is written, not fail (no space left on device); make room\n"
        )
        assert process("info", "none.obj", stderr=full).code == 66


EACH = """
import os, sys, autocolor.__main__ as m
for line in {lines!r}:
    sys.argv[1:] = map(os.fsdecode, line)
    try:
        m.main()
    except SystemExit as left:
        print("code", left.code, file=sys.stderr)
"""


def codes(process: Run, *lines: tuple[str, ...], **environment: str) -> list[int]:
    """The exit codes of lines that are run one after the other in a process of this environment."""
    program = EACH.format(lines=[list(map(os.fsencode, line)) for line in lines])
    ran = process(command=[sys.executable, "-c", program], environment=environment)
    return [int(line.removeprefix("code ")) for line in ran.err.splitlines() if line.startswith("code ")]


@POSIX
def test_without_a_utf_8_locale_and_a_home_foreign_names_work(process: Run, folder: Path) -> None:
    bare = {"LC_ALL": "C", "LANG": "C", "PYTHONIOENCODING": "ascii"}
    bare |= {"PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    bare |= dict.fromkeys(("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"), "/nonexistent")
    no_text = os.fsdecode(b"\xff\xfe.obj")
    for name in ("é ж.obj", no_text):
        (folder / name).write_bytes((folder / "two.obj").read_bytes())
    lines = (
        ("info", "é ж.obj"),
        ("info", "é ж.obj", "--json"),
        ("render", "é ж.obj", *SMALL),
        ("info", "ж.obj"),
        ("render", "two.obj", "--set", "ж=1"),
        ("info", no_text),
        ("render", no_text, *SMALL, "--save", "x.npz"),
        ("render", no_text, *SMALL),
    )
    assert codes(process, *lines, **bare) == [0, 0, 0, 66, 2, 0, 0, 0]
    assert (folder / "é ж.png").is_file()
    assert (folder / os.fsdecode(b"\xff\xfe.png")).is_file()


def test_the_command_multiplies_in_one_thread_unless_it_is_asked_for_more(process: Run) -> None:
    program = (
        "import os, sys; sys.argv[1:] = ['--version']\n"
        "from autocolor.__main__ import main\n"
        "try: main()\n"
        "except SystemExit: print(os.environ['OPENBLAS_NUM_THREADS'], 'numpy' in sys.modules)"
    )
    for count, environment in (("1", {}), ("3", {"OPENBLAS_NUM_THREADS": "3"})):
        ran = process(command=[sys.executable, "-c", program], environment=environment)
        assert ran.out.splitlines()[-1] == f"{count} False"
