from __future__ import annotations

from autocolor.files.store.schema import DEFINITIONS, ROW_TABLES
from docs.generate.store import ROOT, document, lines_of


def test_the_document_is_up_to_date() -> None:
    is_up_to_date = (ROOT / "docs" / "STORE.md").read_text("utf-8") == document()
    assert is_up_to_date, "run: python -m docs.generate.store > docs/STORE.md"


def test_every_table_and_every_column_is_described() -> None:
    text = document()
    for name in DEFINITIONS:
        assert f"### `{name}`" in text or f'CREATE TABLE "{name}"' in text
    for table in ROW_TABLES.values():
        lines = "".join(lines_of(table))
        for column in table.columns:
            assert column.component or f"| `{column.name}`" in lines
