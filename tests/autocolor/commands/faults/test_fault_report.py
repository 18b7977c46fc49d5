from __future__ import annotations

import json

import numpy as np
import pytest

from autocolor import Mesh
from autocolor.commands.faults.fault_report import fault_lines, fault_values
from autocolor.scene.geometry.faults.mesh_faults import mesh_faults

SHEET = Mesh(np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 1], [9, 9, 9.0]]), np.array([[0, 1, 2, 3]]))


def test_a_line_has_the_number_of_the_kind_how_many_and_rows_from_one() -> None:
    border, loop, unused, warped = fault_lines(mesh_faults(SHEET))
    assert border.startswith(" 1 border 4: edges of one polygon alone, ")
    assert border.endswith(" (nodes 1-2, 4-1, 2-3, 3-4)")
    assert loop == "     a closed loop of 4 edges, 8.472 long, around (1, 1, 0.5), at node 1"
    assert unused == " 3 unused 1: nodes that no polygon uses (5)"
    assert warped == " 4 warped 1: quads that are not flat (1)"


def test_many_rows_are_cut_in_a_line_and_whole_in_json() -> None:
    mesh = Mesh(np.vstack([SHEET.coordinates, np.full((20, 3), 5.0)]), SHEET.node_numbers)
    faults = mesh_faults(mesh)
    assert list(fault_lines(faults))[2] == " 3 unused 21: nodes that no polygon uses (5, 6, 7, 8, 9, ...)"
    values = json.loads(json.dumps(fault_values(faults)))
    assert values[1] == {
        "kind": "unused", "number": 3, "of": "node", "count": 21, "rows": list(range(5, 26)), "polygons": []
    }  # fmt: skip
    assert values[0]["loops"][0]["closed"] is True
    assert values[0]["polygons"] == [1]


@pytest.mark.parametrize(("sheets", "told"), [(6, "and 1 shorter one"), (7, "and 2 shorter ones")])
def test_loops_that_are_not_told_are_counted(sheets: int, told: str) -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    apart = np.arange(sheets)[:, None, None] * np.array([3.0, 0, 0])
    corners = np.arange(4 * sheets).reshape(sheets, 4)
    lines = list(fault_lines(mesh_faults(Mesh((square + apart).reshape(-1, 3), corners))))
    assert lines[6].strip() == told
