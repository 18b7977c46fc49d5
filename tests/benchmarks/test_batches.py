from __future__ import annotations

from benchmarks import batches


def test_the_costs_of_a_recoloring_are_the_encoder_the_writing_and_the_others() -> None:
    measured = batches.measure(quick=True)
    assert list(measured["levels"]) == [1, 4]
    assert all(each > 0 for costs in measured["levels"].values() for each in costs.values())
    assert len(batches.text(measured).splitlines()) == 3


def test_the_light_moves_of_a_batch_are_compared_with_relighting() -> None:
    assert batches.light_moves(6).median > 0
