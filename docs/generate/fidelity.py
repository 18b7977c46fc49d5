"""The fidelity ledger: every line of the sources that says where a formula or a number comes from.

`Paper:` Warn's paper; `Hardware:` a source about the RAMTEK by its key; `Assumed:` our choice where sources
are silent; `Departs:` where the program knowingly differs. `python -m docs.generate.fidelity >
docs/FIDELITY.md` writes the document.
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("autocolor", "ramtek_emu")
KINDS = {
    "Paper": "What follows the paper",
    "Hardware": "What follows a source about the hardware",
    "Assumed": "What is our choice, where the sources are silent",
    "Departs": "Where the program knowingly differs",
}
MARK = re.compile(rf"(?P<bracket>\()?\b(?P<kind>{'|'.join(KINDS)}):\s+")


class Line(NamedTuple):
    """One statement: its kind, the module and the definition that it stands in, and its text."""

    kind: str
    module: str
    definition: str
    text: str


@cache
def lines_of_packages() -> list[Line]:
    """All lines of both packages, module by module in the order of their sources."""
    return [
        line
        for package in PACKAGES
        for path in sorted((ROOT / package).rglob("*.py"))
        for line in lines_of_source(path.read_text("utf-8"), module_of(path))
    ]


def module_of(path: Path) -> str:
    """The dotted name of a file under the root."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def lines_of_source(source: str, module: str) -> Iterator[Line]:
    """The lines in the texts and comments of a module."""
    for definition, text in (*texts(ast.parse(source), ""), *comments(source)):
        for kind, statement in statements(text):
            yield Line(kind, module, definition, statement)


def texts(node: ast.AST, definition: str) -> Iterator[tuple[str, str]]:
    """Each text that stands alone, with the definition or the constant that it describes."""
    described = definition
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.FunctionDef, ast.ClassDef)):
            yield from texts(child, f"{definition}.{child.name}".lstrip("."))
        elif isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
            if isinstance(child.value.value, str):
                yield described, child.value.value
        else:
            described = definition
            target = child.targets[0] if isinstance(child, ast.Assign) else getattr(child, "target", None)
            if isinstance(child, (ast.Assign, ast.AnnAssign)) and isinstance(target, ast.Name):
                described = f"{definition}.{target.id}".lstrip(".")


def comments(source: str) -> Iterator[tuple[str, str]]:
    """Each run of comment lines as one text."""
    run: list[str] = []
    last = 0
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type != tokenize.COMMENT:
            continue
        if token.start[0] != last + 1 and run:
            yield "", " ".join(run)
            run = []
        run.append(token.string.lstrip("# "))
        last = token.start[0]
    if run:
        yield "", " ".join(run)


def statements(text: str) -> Iterator[tuple[str, str]]:
    """The kind and the words of each statement: to the next one, the end of its paragraph or its bracket."""
    for paragraph in re.split(r"\n\s*\n", text):
        marks = list(MARK.finditer(paragraph))
        ends = [*[mark.start() for mark in marks[1:]], len(paragraph)][: len(marks)]
        for mark, end in zip(marks, ends, strict=True):
            words = " ".join(paragraph[mark.end() : end].split())
            if mark["bracket"]:
                words = words[: closing(words)]
            yield mark["kind"], words.rstrip(" .;,(") + "."


def closing(words: str) -> int:
    """Where the bracket closes that was open before the words."""
    depth = 1
    for place, letter in enumerate(words):
        depth += (letter == "(") - (letter == ")")
        if depth == 0:
            return place
    return len(words)


def document() -> str:
    """The ledger as a document."""
    lines = lines_of_packages()
    parts = [
        "# Fidelity\n\nWhere every formula, number and rule comes from, collected from the sources by"
        ' `python -m docs.generate.fidelity > docs/FIDELITY.md`. The paper is D. R. Warn, "Lighting Controls'
        ' for Synthetic Images", SIGGRAPH 1983; the keys of the hardware sources stand in `ramtek_emu`.\n'
    ]
    for kind in ("Departs", "Assumed", "Paper", "Hardware"):
        parts.append(
            f"\n## {kind}: {KINDS[kind][0].lower()}{KINDS[kind][1:]}\n\n| where | what |\n|---|---|\n"
        )
        for line in lines:
            if line.kind == kind:
                where = f"{line.module}: {line.definition}" if line.definition else line.module
                text = line.text.replace("|", "\\|")
                parts.append(f"| `{where}` | {text} |\n")
    return "".join(parts)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.stdout.write(document())
