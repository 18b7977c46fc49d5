from __future__ import annotations

from autocolor.screens.viewer import BINDINGS, WINDOW_KEYS
from docs.generate.keys import ROOT, document
from ramtek_emu.inspection.inspector import help_rows
from ramtek_emu.monitor.overlay import KEYS


def test_the_document_is_up_to_date() -> None:
    is_up_to_date = (ROOT / "docs" / "KEYS.md").read_text("utf-8") == document()
    assert is_up_to_date, "run: python -m docs.generate.keys > docs/KEYS.md"


def test_every_key_has_a_row_of_its_own_window() -> None:
    studio, display, inspector = document().split("\n## ")[1:]
    for binding in BINDINGS:
        assert f"\n| {binding} | {binding.does} |\n" in studio
    for part, rows in ((studio, WINDOW_KEYS), (display, KEYS), (inspector, help_rows(is_live=True))):
        for keys, action in rows:
            assert f"\n| {keys} | {action} |\n" in part


def test_no_cell_breaks_its_table() -> None:
    rows = [line for line in document().splitlines() if line.startswith("|")]
    assert all(line.count("|") == 3 for line in rows)
