from __future__ import annotations

import json
import signal
from collections.abc import Iterator
from itertools import count
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from autocolor import read_scene, write_scene
from autocolor.commands import sql as module
from autocolor.commands.sql import lines_of, prompt, split, sql
from autocolor.errors import AutocolorError, UsageError
from autocolor.files.store.tables import Value, open_tables
from tests.autocolor.commands.conftest import Run
from tests.autocolor.files.store.stores import run as run_on_store
from tests.autocolor.files.store.stores import small_scene, small_store, tables_of

LIGHTS = "SELECT name, intensity FROM lights"


def asked(*arguments: object, stdin: str = "") -> Result:
    return CliRunner().invoke(sql, [str(each) for each in arguments], input=stdin)


def refusal(*arguments: object, stdin: str = "") -> AutocolorError:
    error = asked(*arguments, stdin=stdin).exception
    assert isinstance(error, AutocolorError)
    return error


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a scene file that has a comment."""
    path = tmp_path / "small"
    write_scene(path, small_scene().replace(mesh=small_scene().mesh.with_scalars()))
    file = path / "scene.toml"
    file.write_text(f"# mine\n{file.read_text()}")
    return path


def test_rows_are_a_table_csv_or_json(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    assert asked(path, LIGHTS).stdout.splitlines() == [
        "name  intensity",
        "----  ---------",
        "key         1.0",
        "rim         1.0",
    ]
    assert asked(path, LIGHTS, "--csv").stdout == "name,intensity\nkey,1.0\nrim,1.0\n"
    rows = [{"name": "key", "intensity": 1.0}, {"name": "rim", "intensity": 1.0}]
    assert json.loads(asked(path, LIGHTS, "--json").stdout) == rows


def test_a_folder_and_a_picture_file_are_asked_as_a_store_is(folder: Path, tmp_path: Path) -> None:
    from autocolor import render, write_picture

    picture = tmp_path / "small.npz"
    scene = read_scene(folder)
    write_picture(picture, scene, render(scene, (16, 12)))
    for source in (folder, folder / "scene.toml", picture, small_store(tmp_path)):
        assert asked(source, "SELECT count(*) AS n FROM nodes", "--csv").stdout == "n\n5\n"


def test_a_change_is_saved_to_the_store_or_to_the_scene_file_whose_comments_stay(
    folder: Path, tmp_path: Path
) -> None:
    for source in (small_store(tmp_path), folder):
        result = asked(source, "DELETE FROM lights WHERE name = 'rim'", "--write")
        assert (result.exit_code, result.stdout) == (0, "")
        assert result.stderr.startswith("changed 1 row\n")
        assert [light.name for light in read_scene(source).lights] == ["key"]
        assert asked(source, LIGHTS, "--write").stdout.endswith("key         1.0\n")
    assert (folder / "scene.toml").read_text().startswith("# mine\n")


DELETE = "DELETE FROM lights"
NOT_TO = "--write must save to a store or to a scene's folder, not to"


@pytest.mark.parametrize(
    ("path", "statement", "sentence"),
    [
        ("a.obj", DELETE, f"{NOT_TO} a.obj; make a scene of it with `autocolor tables --write`"),
        ("small.sqlite", "UPDATE lights SET follows = name", "nothing was changed"),
    ],
)
def test_what_is_refused_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: str, statement: str, sentence: str
) -> None:
    before = tables_of(small_store(tmp_path))
    monkeypatch.chdir(tmp_path)
    error = refusal(path, statement, "--write")
    assert (error.exit_code, str(error)[: len(sentence)]) == (2, sentence)
    assert refusal("small.sqlite", statement).exit_code == 2
    assert tables_of(tmp_path / "small.sqlite") == before


def test_statements_come_from_stdin_one_after_the_other(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    text = "UPDATE lights\nSET intensity = 3; SELECT max(intensity) AS m FROM lights;\nSELECT ';' AS s"
    result = asked(path, "--write", "--csv", stdin=text)
    assert result.stdout == "m\n3.0\ns\n;\n"
    assert refusal(path, stdin="SELECT 1;\nSELECT * FROM lihgts;\n").exit_code == 2


def lines(form: str | None, columns: tuple[str, ...], *rows: tuple[Value, ...]) -> list[str]:
    return list(lines_of(columns, iter(rows), form))


def test_numbers_stand_to_the_right_and_cells_are_short_and_printable() -> None:
    rows: list[tuple[Value, ...]] = [("a", 1, 1), ("body", 100, "x"), ("b", None, 2.5)]
    assert lines(None, ("name", "n", "mixed"), *rows) == [
        "name  n     mixed",
        "----  ----  -----",
        "a        1      1",
        "body   100  x",
        "b     NULL    2.5",
    ]
    # The text of a stranger commands no terminal.
    odd: dict[Value, str] = {
        "\x1b]0;x\x07\n": r"\x1b]0;x\x07\n",
        bytes(1234): "1,234 bytes",
        "x" * 61: "x" * 57 + "...",
    }
    assert lines(None, ("\x1b[2J",), *((value,) for value in odd))[2:] == list(odd.values())


def test_csv_and_json_hold_any_value_and_rows_without_an_end() -> None:
    rows = [('a,"b"\n', 0.1), (None, float("inf")), (b"\x01", 2)]
    assert "\n".join(lines("csv", ("x", "y"), *rows)) == 'x,y\n"a,""b""\n",0.1\n,inf\n01,2'
    assert json.loads("".join(lines("json", ("x", "y"), *rows)))[1:] == [
        {"x": None, "y": "inf"},
        {"x": "01", "y": 2},
    ]
    for form, empty in ((None, ["name", "----"]), ("csv", ["name"]), ("json", ["[]"])):
        assert lines(form, ("name",)) == empty
        endless = lines_of(("n",), ((number,) for number in count()), form)
        assert len([next(endless) for _ in range(2000)]) == 2000


def typed(monkeypatch: pytest.MonkeyPatch, path: Path, *lines: object) -> list[str]:
    """The statements that are run when these lines are typed; an exception is what a key raises."""
    left: Iterator[object] = iter([*lines, EOFError()])
    run: list[str] = []

    def answer(_: str) -> str:
        line = next(left)
        if isinstance(line, BaseException):
            raise line
        return str(line)

    def note(statement: str) -> None:
        run.append(" ".join(statement.split()))
        if "wrong" in statement:
            raise UsageError("it is wrong; correct it")

    monkeypatch.setattr("builtins.input", answer)
    with open_tables(path) as tables:
        prompt(tables, note)
    assert next(left, None) is None or lines[-1] == ".quit"
    return run


def test_a_statement_ends_with_a_semicolon_ctrl_c_takes_it_back_and_errors_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = ("SELECT", "", "  1;", "SELECT 2; SELECT ';", "';", "SELECT", KeyboardInterrupt(), "wrong;")
    run = typed(monkeypatch, small_store(tmp_path), *lines)
    assert run == ["SELECT 1;", "SELECT 2;", "SELECT '; ';", "wrong;"]
    told = capsys.readouterr().err
    assert "canceled; Ctrl+D ends" in told
    assert "autocolor: it is wrong; correct it" in told


def test_at_the_prompt_ctrl_c_cancels_each_time_and_sigterm_ends(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbers = iter([signal.SIGINT, signal.SIGINT, signal.SIGTERM])

    def interrupted(_: str) -> str:
        signal.raise_signal(next(numbers))
        return ""

    monkeypatch.setattr("builtins.input", interrupted)
    monkeypatch.setattr("sys.stdin.isatty", lambda: True)
    ran = run("sql", str(small_store(tmp_path)))
    assert ran.code == 143
    assert ran.err.splitlines()[1:] == ["canceled; Ctrl+D ends"] * 2 + ["autocolor: ended by SIGTERM"]


def test_words_with_a_dot_show_the_tables_and_leave(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = small_store(tmp_path)
    run_on_store(path, 'CREATE TABLE "a\x1b[31m" (b)')
    words = (".tables", ".schema lights", ".schema", ".schema light", ".what", "", ".quit")
    assert typed(monkeypatch, path, *words) == []
    out, told = capsys.readouterr()
    assert "polygons\n" in out
    assert out.count('CREATE TABLE "lights" (') == 2
    assert out.count("CREATE TABLE polygons (") == 1
    # The name of a stranger commands no terminal.
    assert r"a\x1b[31m" in out
    assert "\x1b" not in out
    assert "there is no table 'light'; did you mean 'lights'?" in told
    assert told.count(module.GREETING) == 2


def test_statements_are_parted_at_their_semicolons() -> None:
    text = "SELECT 1; SELECT\n2 -- a; b\n; SELECT 3"
    assert split(text) == ["SELECT 1;", " SELECT\n2 -- a; b\n;", " SELECT 3"]
    assert split("  \n") == [""]
    # Semicolons in long texts, names and comments are passed over at once.
    many = ";" * 300_000
    for text in (f"SELECT '{many}';", f'SELECT "{many}";', f"SELECT 1 /*{many}*/;", f"--{many}\nSELECT 1;"):
        assert split(text) == [text, ""]
    assert split(f"SELECT '{many}") == [f"SELECT '{many}"]


def test_statements_that_are_not_text_are_refused(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    error = CliRunner().invoke(sql, [str(path)], input=b"SELECT 1;\nSELECT '\xff';\n").exception
    assert str(error) == "statements must be text in UTF-8; save them in this encoding"
    assert [refusal(path, f"SELECT '{odd}'").exit_code for odd in ("\udcff", "\0")] == [2, 2]
