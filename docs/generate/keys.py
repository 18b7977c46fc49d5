"""The reference of keys and the mouse, from the key tables of the studio and of the display's window.

`python -m docs.generate.keys > docs/KEYS.md` writes it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from autocolor.screens.keys import rows_of_help
from ramtek_emu.inspection.inspector import help_rows
from ramtek_emu.monitor.overlay import KEYS

ROOT = Path(__file__).resolve().parents[2]

HEAD = """# The keys

F1 shows these keys in the window. The page is written from the key tables of the program by
`python -m docs.generate.keys > docs/KEYS.md`.
"""

STUDIO = """The window of `autocolor`, `autocolor view` and `autocolor tutorial`. A display elsewhere sends no
keys: its joystick unit reaches everything through the menu.
"""

DISPLAY = """The window of `ramtek`, `ramtek play` and `ramtek serve --window`, which shows what a host draws.
"""

INSPECTOR = """The window of `ramtek inspect` and of `ramtek serve --inspect`. Space is for a running display.
"""

TABLES: tuple[tuple[str, str, Sequence[tuple[str, str]]], ...] = (
    ("The studio", STUDIO, rows_of_help()),
    ("The display", DISPLAY, KEYS),
    ("The inspector", INSPECTOR, help_rows(is_live=True)),
)


def document() -> str:
    """The whole reference."""
    return "\n".join([HEAD, *(line for table in TABLES for line in lines_of(*table))])


def lines_of(title: str, text: str, rows: Sequence[tuple[str, str]]) -> Iterator[str]:
    """The lines of one table."""
    yield f"## {title}\n"
    yield text
    yield "| keys | action |"
    yield "|---|---|"
    yield from (f"| {keys} | {action} |" for keys, action in rows)
    yield ""


if __name__ == "__main__":
    sys.stdout.write(document())
