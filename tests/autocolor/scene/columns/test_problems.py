from __future__ import annotations

import pickle
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light
from autocolor.scene.columns.problems import REFUSED, Problem, RowError


def test_a_refused_value_breaks_no_rule_again() -> None:
    assert REFUSED != REFUSED
    assert [REFUSED > 0, REFUSED < 0, REFUSED >= 0, REFUSED <= 0] == [False] * 4
    assert REFUSED is not None


def test_problems_say_where_they_are() -> None:
    with pytest.raises(RowError) as caught:
        Light("key", (0, 0, 0), flaps={"z": {"on": 3}})  # type: ignore[arg-type]
    assert [problem.path for problem in caught.value.found] == [("flaps", "z", "on")]
    assert caught.value.row == "light 'key'"


@given(st.lists(st.sampled_from(["begin", "end", 0, 7]), max_size=4))
def test_a_problem_under_another_place_has_the_path_from_there(path: list[Any]) -> None:
    problem = Problem(("z",), "must be so").under(tuple(path))
    assert problem.path == (*path, "z")
    assert problem.sentence.endswith("z must be so")


def test_an_error_can_be_sent_to_another_process() -> None:
    with pytest.raises(RowError) as caught:
        Light("key", (1, 2), intensity=-1)  # type: ignore[arg-type]
    error = caught.value
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.problems, copy.found, copy.row) == (error.problems, error.found, error.row)
