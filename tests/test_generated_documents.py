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
from autocolor.scene.columns import Row, fields_of, keys_of
from autocolor.screens.keys import BINDINGS, WINDOW_KEYS
from docs.generate import changes, columns, commands, fidelity, keys, store
from docs.generate.notebook import CODE, MARKDOWN, NOTEBOOK, Cell, cells_of, notebook, outputs_of
from docs.generate.site import EXAMPLES
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
    lines = [line for line in columns.lines_of(title, text, cls) if line.startswith("**")]
    left_out = columns.LEFT_OUT.get(cls, ())
    shown = [(key, column) for key, (column, _) in keys_of(cls).items() if key not in left_out]
    for line, (key, column) in zip(lines, shown, strict=True):
        assert line.startswith(f"**`{key}`**")
        assert column.help in line


def test_the_page_of_a_name_gives_every_keyword_of_a_row_with_its_help_and_the_example() -> None:
    griffe = pytest.importorskip("griffe", reason="griffe comes with autocolor[docs]")
    from docs.generate.keywords import Keywords

    package = griffe.load("autocolor", extensions=griffe.load_extensions(Keywords))
    classes = [each for name in autocolor.__all__ if isinstance(each := getattr(autocolor, name), type)]
    rows = [cls for cls in classes if issubclass(cls, Row)]
    assert len(rows) > 10
    for cls in rows:
        page = package[f"{cls.__module__.removeprefix('autocolor.')}.{cls.__name__}"]
        assert EXAMPLES[f"autocolor.{cls.__name__}"] in page.docstring.value
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


def test_the_modules_and_tests_of_the_paper_are_there() -> None:
    source = (ROOT / "tests" / "test_paper.py").read_text("utf-8")
    for _, modules, test in fidelity.THE_PAPER:
        assert f"def {test}(" in source
        for module in modules:
            assert (ROOT / f"{fidelity.full_name(module).replace('.', '/')}.py").is_file(), module
    guide = (ROOT / "docs" / "guides" / "paper.md").read_text("utf-8")
    for name in re.findall(r"`(autocolor(?:\.\w+)+)`", guide):
        pkgutil.resolve_name(name)


def test_a_statement_ends_with_its_paragraph_or_at_the_next_mark() -> None:
    source = '''"""Module. Paper: Figure 1. Assumed: nothing
more (at all).

Plain.
"""

NEAR = 1
"""Assumed: near."""


class Box:
    def open(self) -> None:
        # Departs: it opens
        # twice, says J. Blinn. Then it closes.
        pass
'''
    assert [tuple(statement) for statement in fidelity.statements_of(source, "m.py")] == [
        ("Paper", "m.py", 1, "Figure 1."),
        ("Assumed", "m.py", 1, "nothing more (at all)."),
        ("Assumed", "m.py", 8, "near."),
        ("Departs", "m.py", 13, "it opens twice, says J. Blinn. Then it closes."),
    ]
    assert fidelity.first_sentence("it opens twice, says J. Blinn. Then it closes.") == (
        "It opens twice, says J. Blinn."
    )


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
