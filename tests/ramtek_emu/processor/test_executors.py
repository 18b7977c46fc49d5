from __future__ import annotations

from ramtek_emu.instruction_set.table import FORMATS
from ramtek_emu.processor.executors import SUBJECTS
from ramtek_emu.processor.processor import EXECUTORS


def test_every_row_of_the_table_has_its_function() -> None:
    assert {format.name for format in FORMATS} <= set(EXECUTORS)


def test_each_executor_stands_in_one_of_the_modules_of_subjects() -> None:
    modules = {module.__name__ for module in SUBJECTS}
    assert {executor.__module__ for executor in EXECUTORS.values()} == modules


def test_every_executor_says_what_it_does() -> None:
    for name, executor in EXECUTORS.items():
        assert executor.__doc__, f"{name} must say what it does"
