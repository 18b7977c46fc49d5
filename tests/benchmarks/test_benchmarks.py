"""Every benchmark that needs no other renderer runs, and says what it measured."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from benchmarks import __main__ as benchmarks

SLOW = {
    "targets", "scaling", "start", "steps", "movement", "events", "reading", "mapped_tables", "form",
    "inspection", "normals", "display", "ports", "scalars",
}  # fmt: skip
SMALLER = {"benchmarks.mapped_tables.FEW": (400, 4000), "benchmarks.reading.QUICK_POLYGONS": 500}
ROWS = [
    pytest.param(name, marks=pytest.mark.thorough if name in SLOW else ())
    for name in (*benchmarks.PARTS, *benchmarks.PROGRAMS)
    # It measures in a browser.
    if name != "page"
]


@pytest.mark.parametrize("name", ROWS)
def test_each_benchmark_runs_in_its_quick_form(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments = ["benchmarks", name, "--quick", "--rounds", "1", "--into", str(tmp_path)]
    monkeypatch.setattr(sys, "argv", arguments)
    for constant, value in SMALLER.items():
        monkeypatch.setattr(constant, value)
    with pytest.raises(SystemExit) as ended:
        benchmarks.main()
    # A busy machine may miss a target.
    assert ended.value.code in (0, 1)
    assert len((tmp_path / f"{name}.txt").read_text().splitlines()) > 2
    if name in benchmarks.PARTS:
        assert set(json.loads((tmp_path / f"{name}.json").read_text())) > {"machine"}
