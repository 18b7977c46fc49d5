"""The documents that are made from the program are up to date, and leave nothing out."""

from __future__ import annotations

import json
import os
import pkgutil
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import autocolor
from autocolor import errors
from autocolor.files.store.schema import DEFINITIONS, ROW_TABLES
from autocolor.scene.columns import Row, fields_of, keys_of
from autocolor.screens.keys import BINDINGS, WINDOW_KEYS
from docs.generate import changes, columns, commands, fidelity, keys, store
from docs.generate.notebook import CODE, MARKDOWN, NOTEBOOK, Cell, cells_of, notebook, outputs_of
from ramtek_emu.inspection.inspector import help_rows
from ramtek_emu.monitor.overlay import KEYS

ROOT = Path(__file__).parents[1]
LINUX = pytest.mark.skipif(
    not sys.platform.startswith("linux") or not os.path.exists("/dev/full"), reason="needs Linux"
)
DOCUMENTS = {
    "docs/COLUMNS.md": columns.document,
    "docs/COMMANDS.md": commands.document,
    "docs/FIDELITY.md": fidelity.document,
    "docs/KEYS.md": keys.document,
    "docs/STORE.md": store.document,
    "autocolor/scene/changes.py": changes.source,
}


@pytest.mark.parametrize(
    ("path", "document"),
    [
        pytest.param(*row, marks=[LINUX, pytest.mark.thorough]) if "COMMANDS" in row[0] else row
        for row in DOCUMENTS.items()
    ],
)
def test_a_document_is_up_to_date(path: str, document: Callable[[], str]) -> None:
    module = document.__module__
    into = "" if path.endswith(".py") else f" > {path}"
    assert (ROOT / path).read_text("utf-8") == document(), f"run: python -m {module}{into}"


@pytest.mark.parametrize(("title", "text", "cls"), columns.TABLES)
def test_every_key_of_a_table_has_a_line_with_its_help(title: str, text: str, cls: type[Row]) -> None:
    lines = "\n".join(columns.lines_of(title, text, cls))
    for key, (column, _) in keys_of(cls).items():
        assert (f"| `{key}` | {column.help}" in lines) == (key not in columns.LEFT_OUT.get(cls, ()))


def test_the_page_of_python_gives_every_keyword_of_a_row_with_its_help() -> None:
    griffe = pytest.importorskip("griffe", reason="griffe comes with autocolor[docs]")
    from docs.generate.keywords import Keywords

    package = griffe.load("autocolor", extensions=griffe.load_extensions(Keywords))
    names = re.findall(r"^::: autocolor\.(\w+)$", (ROOT / "docs" / "api.md").read_text("utf-8"), re.MULTILINE)
    classes = [each for name in names if isinstance(each := getattr(autocolor, name), type)]
    rows = [cls for cls in classes if issubclass(cls, Row)]
    assert len(rows) > 10
    for cls in rows:
        page = package[f"{cls.__module__.removeprefix('autocolor.')}.{cls.__name__}"]
        for name, column in fields_of(cls).items():
            assert f"| `{name}` | {column.help}" in page.docstring.value
            assert name in page.parameters


def test_every_exit_code_of_an_error_has_a_meaning_and_nearly_all_a_command() -> None:
    codes = {value.exit_code for value in vars(errors).values() if hasattr(value, "exit_code")}
    assert codes <= commands.MEANINGS.keys()
    assert {code for code, _ in commands.COMMANDS} >= codes - {70, 71}


@LINUX
def test_a_command_whose_reader_left_or_whose_disk_is_full_is_run_as_such() -> None:
    with commands.folder() as place:
        assert commands.ran(f"autocolor info car{commands.LEFT}", place) == (141, "")
        assert commands.ran("autocolor info car > /dev/full", place).code == 74


def test_every_key_has_a_row_of_its_own_window() -> None:
    studio, display, inspector = keys.document().split("\n## ")[1:]
    rows = [(studio, str(binding), binding.does) for binding in BINDINGS]
    for part, table in ((studio, WINDOW_KEYS), (display, KEYS), (inspector, help_rows(is_live=True))):
        rows += [(part, str(pressed), action) for pressed, action in table]
    for part, pressed, action in rows:
        assert f"\n| {pressed} | {action} |\n" in part


def test_every_table_of_a_store_and_every_column_is_described() -> None:
    text = store.document()
    for name in DEFINITIONS:
        assert f"### `{name}`" in text or f"CREATE TABLE {name} (" in text
    for table in ROW_TABLES.values():
        lines = "".join(store.lines_of(table))
        for column in table.columns:
            assert column.path[-1] in (1, 2) or f"| `{column.name}`" in lines


def test_the_modules_and_tests_of_the_paper_are_there() -> None:
    source = (ROOT / "tests" / "test_paper.py").read_text("utf-8")
    for _, modules, test in fidelity.THE_PAPER:
        assert f"def {test}(" in source
        for module in modules:
            assert (ROOT / f"{fidelity.full_name(module).replace('.', '/')}.py").is_file(), module
    guide = (ROOT / "docs" / "guides" / "paper.md").read_text("utf-8")
    for name in re.findall(r"`(autocolor(?:\.\w+)+)`", guide):
        pkgutil.resolve_name(name)


def test_where_the_program_differs_from_the_paper_is_in_the_ledger() -> None:
    departures = [line.text for line in fidelity.lines_of_packages() if line.kind == "Departs"]
    for departure in ("the paper prints the test as cos(L) <= cos(A)", "linear in the picture"):
        assert any(departure in text for text in departures)


def test_a_mark_is_found_in_texts_constants_brackets_and_comments() -> None:
    source = '''"""Module. Paper: Figure 1. Assumed: nothing
more (at all).

Plain.
"""

NEAR = 1
"""Assumed: near."""


class Box:
    """A box (Hardware: LIN, f(x)) of words."""

    def open(self) -> None:
        # Departs: it opens
        # twice.
        pass
'''
    assert [tuple(line) for line in fidelity.lines_of_source(source, "m")] == [
        ("Paper", "m", "", "Figure 1."),
        ("Assumed", "m", "", "nothing more (at all)."),
        ("Assumed", "m", "NEAR", "near."),
        ("Hardware", "m", "Box", "LIN, f(x)."),
        ("Departs", "m", "", "it opens twice."),
    ]


def without_pixels(notebook: dict[str, Any]) -> dict[str, Any]:
    """A notebook without its pictures: another Pillow compresses them to other bytes."""
    for cell in notebook["cells"]:
        for output in cell.get("outputs", ()):
            if "data" in output:
                output["data"] = sorted(output["data"])
    return notebook


@pytest.mark.needs("anywidget")
def test_the_notebook_is_up_to_date_and_every_number_in_it_is_true() -> None:
    """The script also asserts that its numbers by hand equal those of the program."""
    made = without_pixels(json.loads(json.dumps(notebook())))
    saved = without_pixels(json.loads(NOTEBOOK.read_text("utf-8")))
    is_up_to_date = made == saved
    assert is_up_to_date, "run: python -m docs.generate.notebook > examples/the_paper.ipynb"
    # Code hosts show larger notebooks only on request.
    assert NOTEBOOK.stat().st_size < 400_000


def test_a_script_is_divided_into_cells_and_texts_and_shows_the_picture_of_a_last_line() -> None:
    text, code = (
        "# %% [markdown]\n# # Title\n#\n# A text.\n\n",
        '# %% a={"b": 1}\nx = 1  # %% one\n\n# Of x.\nx\n',
    )
    assert cells_of(f'"""Not a cell."""\n\n{text}{code}') == [
        Cell(MARKDOWN, "# Title\n\nA text."),
        Cell(CODE, "x = 1  # %% one\n\n# Of x.\nx", {"a": {"b": 1}}),
    ]

    class Shown:
        def _repr_png_(self) -> bytes:
            return b"png"

    names: dict[str, Any] = {"shown": Shown()}
    printed, picture = outputs_of("x = 1\nprint(x)\nprint(2)\nshown", names)
    assert (printed["text"], picture["data"]) == (["1\n", "2\n"], {"image/png": "cG5n"})
    assert outputs_of("y = x + 1", names) == []
    assert names["y"] == 2
