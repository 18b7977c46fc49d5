from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from autocolor import errors
from docs.generate.commands import COMMANDS, LEFT, LINES, MEANINGS, ROOT, document, folder, in_code, ran

LINUX = pytest.mark.skipif(
    not sys.platform.startswith("linux") or not os.path.exists("/dev/full"),
    reason="needs Linux",
)


@LINUX
def test_the_document_is_up_to_date() -> None:
    is_up_to_date = (ROOT / "docs" / "COMMANDS.md").read_text("utf-8") == document()
    assert is_up_to_date, "run: python -m docs.generate.commands > docs/COMMANDS.md"


def test_every_exit_code_of_an_error_has_a_meaning_and_nearly_all_a_command() -> None:
    found = {value.exit_code for value in vars(errors).values() if hasattr(value, "exit_code")}
    assert found <= MEANINGS.keys()
    assert {code for code, _ in COMMANDS} >= found - {70, 71}
    assert all(
        line.split()[0] in ("autocolor", "ramtek") for line in (*LINES, *(line for _, line in COMMANDS))
    )


@LINUX
def test_a_command_whose_reader_left_or_whose_disk_is_full_is_run_as_such() -> None:
    with folder() as place:
        assert ran(f"autocolor info car{LEFT}", place) == (141, "")
        assert ran("autocolor info car > /dev/full", place).code == 74
        assert ran("autocolor info car", place).code == 0
        assert Path(place, "car.npz").exists()


@pytest.mark.parametrize(
    ("text", "cell"), [("", ""), ("a | b", "`a \\| b`"), ("say `help`", "`` say `help` ``")]
)
def test_a_cell_of_a_table_shows_a_text_as_it_is(text: str, cell: str) -> None:
    assert in_code(text) == cell
