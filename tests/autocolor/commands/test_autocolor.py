"""The command as it is started: help, errors, pipes, signals and environments."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from autocolor.commands.autocolor import AutocolorGroup, autocolor
from tests.autocolor.commands.conftest import ROOT, Run

SLOW = ("numpy", "pygame", "pydantic", "PIL")
POSIX = pytest.mark.skipif(os.name != "posix", reason="needs what POSIX says about pipes and signals")


@pytest.mark.parametrize("command", AutocolorGroup.table)
def test_the_help_of_each_command_has_an_example(command: str) -> None:
    shown = CliRunner().invoke(autocolor, [command, "--help"], terminal_width=100)
    assert shown.exit_code == 0
    assert "Examples:" in shown.output
    assert f"\n    autocolor {command} " in shown.output
    assert max(map(len, shown.output.splitlines())) <= 100


def test_the_help_names_every_command(run: Run) -> None:
    for flag in ("--help", "-h"):
        ran = run(flag)
        assert ran.code == 0
        assert ran.err == ""
        for command, does in AutocolorGroup.table.items():
            assert command in ran.out
            assert does in ran.out


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


@POSIX
def test_a_shell_can_complete_commands_and_options(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_AUTOCOLOR_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", "autocolor re")
    monkeypatch.setenv("COMP_CWORD", "1")
    assert run().out.split() == ["plain,render", "plain,recolor"]


def test_the_version_is_told_even_where_nothing_is_installed(run: Run) -> None:
    ran = run("--version")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.strip()


def test_a_wrong_command_is_told_the_nearest_right_one(run: Run) -> None:
    ran = run("rendr", "two.obj")
    assert ran.code == 2
    assert "there is no command 'rendr'; did you mean 'render'?" in ran.err


@pytest.mark.parametrize(
    "arguments", [("info",), ("info", "two.obj", "more"), ("info", "--jsn", "two.obj"), ("--nothing",)]
)
def test_wrong_usage_says_how_to_get_help(folder: Path, run: Run, arguments: tuple[str, ...]) -> None:
    ran = run(*arguments)
    assert (ran.code, ran.out) == (2, "")
    # The hint names the first option for help; which of the two is first depends on click.
    assert re.search("(-h|--help)' for help.", ran.err)


@pytest.mark.parametrize(
    "arguments", [("--debug", "info", "no.obj"), ("info", "--debug", "no.obj"), ("info", "no.obj", "--debug")]
)
def test_debug_anywhere_gives_the_traceback_and_the_same_exit_code(
    folder: Path, run: Run, arguments: tuple[str, ...]
) -> None:
    ran = run(*arguments)
    assert ran.code == 66
    assert "Traceback" in ran.err
    assert ran.err.endswith("\nautocolor: no.obj: there is no such file or folder; check the name\n")


def test_a_fault_of_ours_is_said_to_be_one(folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    from autocolor.commands import info

    def broken(*_: object) -> None:
        raise ZeroDivisionError("of ours")

    monkeypatch.setattr(info, "read", broken)
    expected = (
        "autocolor: a fault of this program, not of yours: ZeroDivisionError: of ours;"
        " add --debug for the traceback and report it\n"
    )
    assert run("info", "two.obj") == (70, "", expected)
    assert "Traceback" in run("info", "two.obj", "--debug").err


def test_an_interrupt_ends_with_130(folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    from autocolor.commands import info

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(info, "read", interrupted)
    assert run("info", "two.obj") == (130, "", "autocolor: interrupted\n")


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
        ("autocolor", "autocolor.commands.autocolor", -2),
        ("autocolor", "click", -2),
        ("autocolor", "ramtek_emu.command_line", -2),
        ("autocolor", "autocolor.commands.render", 130),
        ("autocolor", "numpy", 130),
        ("ramtek_emu", "click", -2),
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
def test_a_real_interrupt_ends_with_130_and_leaves_nothing(process: Run, folder: Path) -> None:
    program = (
        "import os, signal, sys, autocolor.files.writing as writing, autocolor.__main__ as m\n"
        "sync = os.fsync\n"
        "os.fsync = lambda number: os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.argv[1:] = ['render', 'two.obj']\n"
        "m.main()\n"
    )
    before = sorted(os.listdir(folder))
    ran = process(command=[sys.executable, "-c", program])
    assert (ran.code, ran.err) == (130, "autocolor: interrupted\n")
    assert sorted(os.listdir(folder)) == before


@POSIX
def test_a_reader_that_goes_away_ends_the_command_in_silence(process: Run, folder: Path) -> None:
    read_end, write_end = os.pipe()
    os.close(read_end)
    ran = process("info", "two.obj", stdout=write_end)
    os.close(write_end)
    assert (ran.code, ran.err) == (141, "")


@POSIX
@pytest.mark.parametrize("arguments", ["info two.obj", "validate scene --json", "--help", "info --help"])
def test_a_closed_stdout_is_told(process: Run, arguments: str) -> None:
    ran = process(command=["sh", "-c", f'exec "$0" -m autocolor {arguments} >&-', sys.executable])
    assert ran.code == 74
    assert ran.err == "autocolor: stdout must stay open until all is written, not be closed; read it all\n"


@POSIX
def test_a_closed_stdout_or_stderr_keeps_no_picture_from_being_written(process: Run, folder: Path) -> None:
    for number, closed in enumerate((">&-", "2>&-", "<&- >&- 2>&-")):
        line = f'exec "$0" -m autocolor render two.obj -o {number}.png {closed}'
        assert process(command=["sh", "-c", line, sys.executable]).code == 0
    assert (folder / "0.png").read_bytes() == (folder / "2.png").read_bytes()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
def test_a_stdout_that_is_full_is_told(process: Run) -> None:
    with open("/dev/full", "wb") as full:
        ran = process("info", "two.obj", stdout=full)
        assert ran.code == 74
        assert ran.err == (
            "autocolor: stdout must take what is written, not fail (no space left on device); make room\n"
        )
        assert process("info", "none.obj", stderr=full).code == 66


def test_without_a_utf_8_locale_foreign_names_work(process: Run, folder: Path) -> None:
    ascii_only = {
        "LC_ALL": "C",
        "LANG": "C",
        "PYTHONIOENCODING": "ascii",
        "PYTHONUTF8": "0",
        "PYTHONCOERCECLOCALE": "0",
    }
    (folder / "é ж.obj").write_bytes((folder / "two.obj").read_bytes())
    for arguments in (("info", "é ж.obj"), ("validate", "é ж.obj"), ("render", "é ж.obj")):
        ran = process(*arguments, environment=ascii_only)
        assert ran.code == 0, ran.err
    assert (folder / "é ж.png").is_file()
    ran = process("info", "é ж.obj", "--json", environment=ascii_only)
    json.loads(ran.out)
    assert process("info", "ж.obj", environment=ascii_only).code == 66
    assert process("render", "two.obj", "--set", "ж=1", environment=ascii_only).code == 2


@POSIX
def test_a_file_name_that_is_no_text_works(process: Run, folder: Path) -> None:
    name = os.fsdecode(b"\xff\xfe.obj")
    try:
        (folder / name).write_bytes((folder / "two.obj").read_bytes())
    except OSError:
        pytest.skip("this file system takes text alone")
    for arguments in (("info", name), ("render", name, "--save", "x.npz"), ("render", name)):
        ran = process(*arguments)
        assert ran.code == 0, ran.err
    assert (folder / os.fsdecode(b"\xff\xfe.png")).is_file()
    assert process("info", "x.npz").code == 0


def test_nothing_is_needed_of_a_home(process: Run, folder: Path) -> None:
    home = {"HOME": "/nonexistent", "XDG_CACHE_HOME": "/nonexistent", "XDG_CONFIG_HOME": "/nonexistent"}
    assert process("render", "two.obj", environment=home).code == 0
    assert (folder / "two.png").is_file()


def test_the_command_multiplies_in_one_thread_unless_it_is_asked_for_more() -> None:
    program = (
        "import os, sys; sys.argv[1:] = ['--version']\n"
        "from autocolor.__main__ import main\n"
        "try: main()\n"
        "except SystemExit: print(os.environ['OPENBLAS_NUM_THREADS'], 'numpy' in sys.modules)"
    )
    for asked in ("", "3"):
        environment = {key: value for key, value in os.environ.items() if key != "OPENBLAS_NUM_THREADS"}
        environment |= {"OPENBLAS_NUM_THREADS": asked} if asked else {}
        ran = subprocess.run(
            [sys.executable, "-c", program],
            env={**environment, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            check=True,
        )
        assert ran.stdout.splitlines()[-1] == f"{asked or '1'} False"
