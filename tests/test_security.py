"""docs/SECURITY.md: each promise names tests that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PROMISES = [
    line
    for line in (ROOT / "docs" / "SECURITY.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| **")
]
FILES = [*(ROOT / "tests").rglob("test_*.py")]


@pytest.mark.parametrize("promise", PROMISES, ids=lambda line: line[4:40])
def test_each_promise_names_tests_that_exist(promise: str) -> None:
    named = re.findall(r"`(test_\w+\.py)(?:::(test_\w+))?`", promise.split("|")[2])
    assert named
    for file, name in named:
        texts = [path.read_text(encoding="utf-8") for path in FILES if path.name == file]
        assert any(f"\ndef {name}" in text for text in texts), (file, name)
