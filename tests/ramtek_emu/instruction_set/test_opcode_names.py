from __future__ import annotations

import re

from ramtek_emu.instruction_set.opcode_names import UNIMPLEMENTED
from ramtek_emu.instruction_set.table import FORMATS, SUBSTANTIATED


def test_no_instruction_that_is_done_is_known_by_its_name_only() -> None:
    assert not {opcode for opcode, _, _ in UNIMPLEMENTED} & {format.opcode for format in SUBSTANTIATED}
    assert not {name for _, name, _ in UNIMPLEMENTED} & {format.name for format in SUBSTANTIATED}


def test_a_name_that_stands_for_a_range_ends_in_its_opcode() -> None:
    numbered = [
        (opcode, name)
        for opcode, name, _ in UNIMPLEMENTED
        if re.fullmatch(r"(DL|MX|CX|DT|ARC|LF|RA)[0-9A-F]{2}", name)
    ]
    assert len(numbered) == 9 + 12 + 5 + 8 + 3 + 7 + 5
    assert all(name.endswith(f"{opcode:02X}") for opcode, name in numbered)


def test_each_name_is_a_row_of_the_table_that_does_nothing() -> None:
    rows = {(format.opcode, format.name, format.meaning) for format in FORMATS if format.unimplemented}
    assert rows == set(UNIMPLEMENTED)
