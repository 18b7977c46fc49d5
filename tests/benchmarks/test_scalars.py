from __future__ import annotations

import pytest

from benchmarks import scalars


def test_every_scalar_stands_beside_a_frame(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scalars, "SCENES", {"few hills": ("polygons", 1_000)})
    measured = scalars.measure(rounds=1)
    lines = {line["case"]: line for line in measured["scenes"]["few hills"]}
    assert list(lines) == [scalars.FRAME, *scalars.SCALARS, scalars.CURVATURES]
    assert lines[scalars.FRAME]["percent"] == 100
    assert all(line["ms"]["median"] > 0 for line in lines.values())
    told = scalars.text(measured).splitlines()
    assert told[0].startswith("few hills")
    assert len(told) == 1 + len(lines)
