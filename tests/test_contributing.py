"""What `CONTRIBUTING.md` quotes of the source is what is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.test_architecture import WINGS

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
SOURCES = [
    (ROOT / path).read_text("utf-8")
    for path in (
        "autocolor/lighting/controls.py",
        "autocolor/scene/lights.py",
        "tests/autocolor/lighting/test_controls.py",
    )
]

SECTION = TEXT[TEXT.index("### A light control") : TEXT.index("### A mapping curve")]
QUOTES = re.findall(r"^```python\n(.*?)^```$", SECTION, re.DOTALL | re.MULTILINE)


def test_the_light_control_is_quoted() -> None:
    assert len(QUOTES) == 4


@pytest.mark.parametrize("quote", QUOTES)
def test_the_light_control_is_quoted_as_it_is_in_the_source(quote: str) -> None:
    assert any(quote in source for source in SOURCES)


@pytest.mark.parametrize("package", WINGS)
def test_all_wings_of_a_package_are_told_in_their_order(package: str) -> None:
    table = TEXT[TEXT.index(f"| `{package}` | |") :].split("\n\n")[0]
    told = re.findall(r"`(\w+)`", "".join(row.split("|")[1] for row in table.splitlines()))
    assert (*told, "__main__") == (package, *WINGS[package])
