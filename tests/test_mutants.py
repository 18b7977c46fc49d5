from __future__ import annotations

import ast
import tomllib
from pathlib import Path

import pytest

from tests import mutants as module
from tests.mutants import EQUIVALENT, ROOT, chosen_mutants, mutants_of, reason_of, suite_of

SOURCE = '''"""A docstring with 1 < 2."""
def limited(value: int, most: int = 3) -> int:
    """Nothing here + there."""
    if value > most and not value == 7:
        raise ValueError(f"{value + 1} is more than 2")
    logger.info("%d", value + 1)
    self.value += value[:most]
    return min(value, 5)
'''

CHANGES = {
    "3 -> (4)", "3 -> (2)", "7 -> (8)", "7 -> (6)", "5 -> (6)", "5 -> (4)", "min -> max",
    "value > most -> (value >= most)", "value == 7 -> (value != 7)", "not value == 7 -> (value == 7)",
    "value > most and not value == 7 -> (value > most or not value == 7)",
    "if value > most and (not value == 7) always", "if value > most and (not value == 7) never",
    "self.value += value[:most] -> self.value -= value[:most]", "self.value += value[:most] deleted",
    "most -> (most + 1)", "return min(value, 5) -> return None",
}  # fmt: skip


def test_mutants_are_simple_changes_of_code_and_of_no_text(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "ROOT", tmp_path)
    (tmp_path / "limits.py").write_text(SOURCE)
    mutants = mutants_of(tmp_path / "limits.py")
    assert {mutant.change for mutant in mutants} == CHANGES
    for mutant in mutants:
        assert ast.dump(ast.parse(mutant.source(SOURCE.encode()))) != ast.dump(ast.parse(SOURCE))
        assert mutant.line == SOURCE.splitlines()[mutant.number - 1].strip()


def test_the_same_seed_chooses_the_same_mutants_of_different_lines() -> None:
    only = ["ramtek_emu/memory/cursors.py"]
    mutants = chosen_mutants(20, 1, only)
    assert mutants == chosen_mutants(20, 1, only) != chosen_mutants(20, 2, only)
    assert len({mutant.number for mutant in mutants}) == 20


def test_the_tests_of_a_subject_are_its_mirrored_file_and_its_doctests() -> None:
    file = "autocolor/scene/geometry/planes.py"
    assert suite_of(file, "subject", ROOT) == ("tests/autocolor/scene/geometry/test_planes.py", file)
    wing = suite_of(file, "wing", ROOT)
    assert wing[0].startswith("tests/autocolor/scene/geometry/test_")
    assert wing[-2:] == ("autocolor/scene", "tests/test_column_reference.py")


def test_every_equivalent_mutant_is_one_of_the_program_and_has_a_reason() -> None:
    tables = tomllib.loads(EQUIVALENT.read_text())["mutant"]
    reasons = {(table["file"], table["line"], table["change"]): table["reason"] for table in tables}
    files = {table["file"] for table in tables}
    mutants = [mutant for file in files for mutant in mutants_of(ROOT / file)]
    keys = {mutant.key for mutant in mutants} | {(mutant.file, mutant.line, "any") for mutant in mutants}
    assert not reasons.keys() - keys
    assert all(len(reason) > 20 for reason in reasons.values())
    assert sum(bool(reason_of(mutant, reasons)) for mutant in mutants) >= len(tables)
