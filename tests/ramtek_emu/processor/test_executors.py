from __future__ import annotations

from ramtek_emu.instruction_set.table import FORMATS
from ramtek_emu.processor.processor import EXECUTORS


def test_every_row_of_the_table_has_its_function() -> None:
    assert {format.name for format in FORMATS} <= set(EXECUTORS)
