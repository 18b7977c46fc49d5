from __future__ import annotations

import logging
from pathlib import Path

import pytest

from tests.autocolor.commands.conftest import SMALL, Run


@pytest.mark.parametrize("arguments", [("-v", "render", "two.obj"), ("render", "two.obj", "--verbose")])
def test_what_is_read_created_and_computed_is_told_on_stderr(
    folder: Path, run: Run, arguments: tuple[str, ...]
) -> None:
    ran = run(*arguments, *SMALL)
    assert (ran.code, ran.out) == (0, "")
    *told, last = ran.err.splitlines()
    assert last == "wrote two.png"
    assert all(line.startswith("autocolor: ") for line in told)
    for each in ("read two.obj: ", "Mesh(nodes 6, polygons 2, parts 2)", "created 4 lights: key", "visible"):
        assert sum(line.startswith(f"autocolor: {each}") for line in told) == 1
    assert "Picture(" not in ran.err


@pytest.mark.parametrize("line", ["-vv info two.obj", "info -vv two.obj", "-v info two.obj -v"])
def test_given_twice_more_is_told_and_nothing_twice(folder: Path, run: Run, line: str) -> None:
    ran = run(*line.split())
    assert ran.code == 0
    assert ran.err.count("autocolor: Picture(640 x 480") == 1
    assert ran.err.count("autocolor: read two.obj") == 1


def test_without_it_nothing_is_told_not_even_after_it_was_given(folder: Path, run: Run) -> None:
    assert run("render", "two.obj", "-v", *SMALL, "-o", "a.png").code == 0
    assert run("render", "two.obj", *SMALL, "-o", "b.png").err == "wrote b.png\n"
    assert run("recolor", "none.npz", "body", "-v").code == 66
    assert run("info", "two.obj").err == ""
    assert [type(handler) for handler in logging.getLogger("autocolor").handlers] == [logging.NullHandler]
