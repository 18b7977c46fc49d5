from __future__ import annotations

from benchmarks import normals


def test_the_difference_is_measured_for_each_exponent_and_paint() -> None:
    measured = normals.measure(quick=True)
    assert measured["directions"] == 2
    rows = measured["rows"]
    assert [(row["exponent"], row["paint"]) for row in rows] == [
        (exponent, paint) for exponent in normals.EXPONENTS for paint in normals.PAINTS
    ]
    assert all(0 < row["mean"] < 4 and row["mean"] < row["largest"] < 200 for row in rows)
    assert len(normals.text(measured).splitlines()) == 1 + len(rows)
