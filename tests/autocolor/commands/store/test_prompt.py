from __future__ import annotations

import io
import sqlite3
from collections.abc import Iterator
from pathlib import Path

import pytest

from autocolor.commands.store import prompt as module
from autocolor.commands.store.prompt import prompt, split, statements_in
from autocolor.errors import UsageError
from autocolor.files.store.tables import open_tables
from tests.autocolor.files.store.stores import small_store


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


def test_a_statement_ends_with_a_semicolon(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = small_store(tmp_path)
    run = typed(monkeypatch, path, "SELECT", "", "  1;", "SELECT 2; SELECT 3;", "SELECT ';", "';")
    assert run == ["SELECT 1;", "SELECT 2;", "SELECT 3;", "SELECT '; ';"]


def test_ctrl_c_takes_back_what_was_typed_and_errors_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = small_store(tmp_path)
    assert typed(monkeypatch, path, "SELECT", KeyboardInterrupt(), "wrong;", "SELECT 2;") == [
        "wrong;",
        "SELECT 2;",
    ]
    told = capsys.readouterr().err
    assert "taken back; Ctrl+D ends" in told
    assert "autocolor: it is wrong; correct it" in told


def test_words_with_a_dot_show_the_tables_and_leave(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = small_store(tmp_path)
    assert typed(monkeypatch, path, ".tables", ".schema lights", ".schema light", ".what", ".quit") == []
    out, told = capsys.readouterr()
    assert "polygons\n" in out
    assert 'CREATE TABLE "lights" (' in out
    assert "there is no table 'light'; did you mean 'lights'?" in told
    assert told.count(module.GREETING) == 2


def test_the_statements_of_a_file_are_parted_at_their_semicolons() -> None:
    assert list(statements_in(["SELECT 1; SEL", "ECT\n", "2 -- a; b\n", "; SELECT 3"])) == [
        "SELECT 1;",
        " SELECT\n2 -- a; b\n;",
        " SELECT 3",
    ]
    assert split("  \n") == ([], "")


def test_text_without_an_end_is_not_collected_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_LETTERS", 10)
    endless = iter(lambda: "x" * 6, None)
    assert list(statements_in(endless)) == ["x" * 12]


@pytest.mark.parametrize("text", ["SELECT '\udcff';", "SELECT '\0';"])
def test_what_is_not_text_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="must be text in UTF-8 without NUL; save them so"):
        list(statements_in([text]))


def test_bytes_that_are_not_utf_8_are_refused() -> None:
    with pytest.raises(UsageError, match="must be text in UTF-8"):
        list(statements_in(io.TextIOWrapper(io.BytesIO(b"SELECT 1;\nSELECT '\xff';\n"), "utf-8")))


def test_semicolons_in_long_texts_names_and_comments_are_passed_over_at_once() -> None:
    many = ";" * 300_000
    for text in (f"SELECT '{many}';", f'SELECT "{many}";', f"SELECT 1 /*{many}*/;", f"--{many}\nSELECT 1;"):
        assert split(text) == ([text], "")
    assert split(f"SELECT '{many}") == ([], f"SELECT '{many}")


def test_the_name_of_a_stranger_commands_no_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = small_store(tmp_path)
    with sqlite3.connect(path) as connection:
        connection.execute('CREATE TABLE "a\x1b[31m" (b)')
    connection.close()
    lines = iter([".tables", ".schema"])

    def typed(_: str) -> str:
        try:
            return next(lines)
        except StopIteration:
            raise EOFError from None

    monkeypatch.setattr("builtins.input", typed)
    with open_tables(path) as tables:
        prompt(tables, lambda statement: None)
    told = capsys.readouterr().out
    assert "a?[31m" in told
    assert "\x1b" not in told
