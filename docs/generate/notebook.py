"""The notebook of the paper: `python -m docs.generate.notebook > examples/the_paper.ipynb`.

Its script, `examples/the_paper.py`, has a cell from each line `# %%` on, and a text from each line
`# %% [markdown]` on. The metadata of a cell follow `# %%`, as in `jupyter={"outputs_hidden": true}`.
The lines above the first cell are left out. All cells are run, and their texts and pictures are in the
notebook, so that it can be read where it cannot be run; of a widget it has the picture. The Python blocks of
a text run in their turn, with a copy of the names so far, and have no output.
"""

from __future__ import annotations

import ast
import contextlib
import io
import json
import re
import sys
from base64 import b64encode
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple

ROOT: Final = Path(__file__).resolve().parents[2]
SCRIPT: Final = ROOT / "examples" / "the_paper.py"
NOTEBOOK: Final = SCRIPT.with_suffix(".ipynb")

CODE: Final = "code"
MARKDOWN: Final = "markdown"


class Cell(NamedTuple):
    """A cell: "code" or "markdown", its text without a comment sign, and its metadata."""

    kind: str
    text: str
    metadata: Mapping[str, Any] = MappingProxyType({})


def cells_of(script: str) -> list[Cell]:
    """The cells of a script."""
    _, *parts = re.split(r"^# %%(.*)\n", script, flags=re.MULTILINE)
    cells = []
    for mark, text in zip(parts[::2], parts[1::2], strict=True):
        if mark.strip() == f"[{MARKDOWN}]":
            cells.append(Cell(MARKDOWN, re.sub(r"^# ?", "", text, flags=re.MULTILINE).strip()))
        else:
            name, _, value = mark.strip().partition("=")
            cells.append(Cell(CODE, text.strip(), {name: json.loads(value)} if value else {}))
    return cells


def solutions_of(text: str) -> list[str]:
    """The Python blocks of a text."""
    return re.findall(r"^```python\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)


def outputs_of(code: str, names: dict[str, Any]) -> list[dict[str, Any]]:
    """Run a cell with the names of the cells before it; returns its outputs for a notebook."""
    statements = ast.parse(code).body
    last = statements.pop() if isinstance(statements[-1], ast.Expr) else None
    printed = io.StringIO()
    value: Any = None
    with contextlib.redirect_stdout(printed):
        exec(compile(ast.Module(statements, []), SCRIPT.name, "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), SCRIPT.name, "eval"), names)
    outputs: list[dict[str, Any]] = []
    end = statements[-1] if statements else None
    slider = getattr(names[end.name], "widget", None) if isinstance(end, ast.FunctionDef) else None
    if slider is not None:
        # A function with a slider shows its result. Outside of a notebook, ipywidgets prints a description.
        value = slider.result
    elif text := printed.getvalue():
        outputs.append({"output_type": "stream", "name": "stdout", "text": lines_of(text)})
    picture = None
    if hasattr(value, "_repr_png_"):
        picture = b64encode(value._repr_png_()).decode("ascii")
    elif hasattr(value, "_repr_mimebundle_"):
        bundle = value._repr_mimebundle_()
        picture = (bundle[0] if isinstance(bundle, tuple) else bundle).get("image/png")
    if picture is not None:
        outputs.append({"output_type": "display_data", "data": {"image/png": picture}, "metadata": {}})
    return outputs


def notebook_of(cells: list[Cell], outputs: list[list[dict[str, Any]]]) -> dict[str, Any]:
    """The notebook, as its file holds it (nbformat 4.5); `outputs` are those of the code cells."""
    in_turn, rows = iter(enumerate(outputs, start=1)), []
    for number, cell in enumerate(cells, start=1):
        row: dict[str, Any] = {
            "cell_type": cell.kind,
            "id": f"cell-{number}",
            "metadata": dict(cell.metadata),
            "source": lines_of(cell.text),
        }
        if cell.kind == CODE:
            count, made = next(in_turn)
            row |= {"execution_count": count, "outputs": made}
        rows.append(row)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return {"cells": rows, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def lines_of(text: str) -> list[str]:
    """The lines of a text with their ends, as a notebook holds them."""
    return text.splitlines(keepends=True)


def notebook() -> dict[str, Any]:
    """The notebook of the script, after its cells were run."""
    cells, names = cells_of(SCRIPT.read_text("utf-8")), dict[str, Any](__name__="__main__")
    outputs = []
    for cell in cells:
        if cell.kind == CODE:
            outputs.append(outputs_of(cell.text, names))
        else:
            for solution in solutions_of(cell.text):
                outputs_of(solution, dict(names))
    return notebook_of(cells, outputs)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.stdout.write(json.dumps(notebook(), indent=1, ensure_ascii=False) + "\n")
