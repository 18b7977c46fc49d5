from __future__ import annotations

import numpy as np

from autocolor.files.meshes.ply.columns import Lists, Rows


def test_rows_know_their_columns_and_where_they_stand_in_the_file() -> None:
    lists = Lists(np.array([1, 2, 3]), np.array([2, 1]))
    rows = Rows(2, {"of_it": lists}, lambda row: f"line {row + 5}")
    assert rows.columns["of_it"] is lists
    assert rows.place_of(1) == "line 6"
