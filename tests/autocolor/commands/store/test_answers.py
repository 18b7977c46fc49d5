from __future__ import annotations

import json
from itertools import count

from autocolor.commands.store.answers import lines_of
from autocolor.files.store.statements import Answer, Value


def lines(form: str, columns: tuple[str, ...], *rows: tuple[Value, ...]) -> list[str]:
    return list(lines_of(Answer(columns, iter(rows)), form))


def test_numbers_stand_to_the_right_and_text_to_the_left() -> None:
    assert lines("table", ("name", "n"), ("a", 1), ("body", 100), ("b", None)) == [
        "name     n",
        "----  ----",
        "a        1",
        "body   100",
        "b     NULL",
    ]


def test_an_answer_without_rows_has_its_columns_and_one_without_columns_nothing() -> None:
    assert lines("table", ("name",)) == ["name", "----"]
    assert lines("table", ()) == []
    assert lines("csv", ("name",)) == ["name"]
    assert lines("json", ("name",)) == ["[]"]


def test_text_of_a_stranger_commands_no_terminal() -> None:
    assert lines("table", ("\x1b[2J",), ("\x1b]0;x\x07\n",))[2] == "?]0;x??"


def test_csv_and_json_hold_any_value() -> None:
    rows = [('a,"b"\n', 0.1), (None, float("inf")), (b"\x01", 2)]
    assert "\n".join(lines("csv", ("x", "y"), *rows)) == 'x,y\n"a,""b""\n",0.1\n,inf\n01,2'
    assert json.loads("".join(lines("json", ("x", "y"), *rows))) == [
        {"x": 'a,"b"\n', "y": 0.1},
        {"x": None, "y": "inf"},
        {"x": "01", "y": 2},
    ]


def test_rows_without_an_end_are_printed_as_they_come() -> None:
    for form in ("table", "csv", "json"):
        endless = lines_of(Answer(("n",), ((number,) for number in count())), form)
        assert len([next(endless) for _ in range(2000)]) == 2000
