from __future__ import annotations

import json
from typing import Any

import pytest

from docs.generate.notebook import CODE, MARKDOWN, NOTEBOOK, Cell, cells_of, notebook, outputs_of

LARGEST = 400_000
"""The bytes of a notebook that code hosts still show at once."""


@pytest.fixture(scope="module")
def saved() -> dict[str, Any]:
    return dict(json.loads(NOTEBOOK.read_text("utf-8")))


def without_pixels(notebook: dict[str, Any]) -> dict[str, Any]:
    """A notebook whose pictures are left out: another Pillow compresses them to other bytes."""
    cells = [dict(cell) for cell in notebook["cells"]]
    for cell in cells:
        if cell["cell_type"] == CODE:
            cell["outputs"] = [
                {**output, "data": sorted(output["data"])} if "data" in output else output
                for output in cell["outputs"]
            ]
    return {**notebook, "cells": cells}


def test_the_notebook_is_what_its_script_makes_and_every_number_in_it_is_true(saved: dict[str, Any]) -> None:
    """The script also asserts that what it computes by hand equals what the program gives."""
    made = json.loads(json.dumps(notebook()))
    is_up_to_date = without_pixels(made) == without_pixels(saved)
    assert is_up_to_date, "run: python -m docs.generate.notebook > examples/the_paper.ipynb"


def test_the_notebook_can_be_read_where_it_is_not_run(saved: dict[str, Any]) -> None:
    outputs = [output for cell in saved["cells"] for output in cell.get("outputs", ())]
    assert sum("data" in output for output in outputs) > 8
    assert NOTEBOOK.stat().st_size < LARGEST
    assert len({cell["id"] for cell in saved["cells"]}) == len(saved["cells"])


def test_a_script_is_divided_into_cells_and_texts() -> None:
    text, code = "# %% [markdown]\n# # Title\n#\n# A text.\n\n", "# %%\nx = 1  # %% one\n\n# Of x.\nx\n"
    assert cells_of(f'"""Not a cell."""\n\n{text}{code}') == [
        Cell(MARKDOWN, "# Title\n\nA text."),
        Cell(CODE, "x = 1  # %% one\n\n# Of x.\nx"),
    ]


def test_a_cell_gives_what_it_prints_and_the_picture_of_its_last_line() -> None:
    class Shown:
        def _repr_png_(self) -> bytes:
            return b"png"

    names: dict[str, Any] = {"shown": Shown()}
    printed, picture = outputs_of("x = 1\nprint(x)\nprint(2)\nshown", names)
    assert printed["text"] == ["1\n", "2\n"]
    assert picture["data"] == {"image/png": "cG5n"}
    assert outputs_of("y = x + 1", names) == []
    assert outputs_of("y", names) == []
    assert names["y"] == 2
