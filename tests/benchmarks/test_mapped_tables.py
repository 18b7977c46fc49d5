from __future__ import annotations

from mmap import MAP_ANONYMOUS, MAP_PRIVATE, mmap
from pathlib import Path

import pytest

from autocolor.files.formats import read_mesh
from benchmarks import mapped_tables
from benchmarks.hills import hills
from benchmarks.memory import STATUS


@pytest.mark.parametrize("side", [1, 5, 70])
def test_the_tables_are_the_hills_that_other_measurements_render(tmp_path: Path, side: int) -> None:
    mapped_tables.make(tmp_path / "hills", side)
    folder = tmp_path / "hills"
    mesh = read_mesh({"nodes": folder / "nodes.npy", "polygons": folder / "polygons.npy"}).mesh
    expected = hills(side)
    assert mesh.node_numbers.tolist() == expected.node_numbers.tolist()
    assert mesh.coordinates == pytest.approx(expected.coordinates, abs=1e-12)


@pytest.mark.skipif(not STATUS.exists(), reason="only Linux tells of anonymous memory")
def test_memory_that_was_given_back_still_counts_as_the_peak() -> None:
    with mapped_tables.watched() as peak:
        # Memory of the system's own: what numpy takes may be there from arrays before.
        with mmap(-1, 40_000_000, flags=MAP_PRIVATE | MAP_ANONYMOUS) as taken:
            for _ in range(20):
                taken.seek(0)
                taken.write(bytes([1]) * len(taken))
        assert peak() > 20


def test_a_target_is_told_from_the_two_meshes_that_were_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = [{"render": {"frame s": {"median": seconds}, "MB": 10 * seconds}} for seconds in (0.5, 2.0)]
    monkeypatch.setattr(mapped_tables, "measured_once", lambda: {"steps": steps})
    assert mapped_tables.mapped_times().median == 4
    assert mapped_tables.mapped_memory().median == 20
