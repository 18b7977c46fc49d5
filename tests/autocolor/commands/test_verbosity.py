from __future__ import annotations

import logging
from pathlib import Path

import pytest

from tests.autocolor.commands.conftest import Run


@pytest.mark.parametrize("arguments", [("-v", "render", "two.obj"), ("render", "two.obj", "--verbose")])
def test_what_is_read_created_and_computed_is_told_on_stderr(
    folder: Path, run: Run, arguments: tuple[str, ...]
) -> None:
    ran = run(*arguments)
    assert (ran.code, ran.out) == (0, "")
    *told, last = ran.err.splitlines()
    assert last == "wrote two.png"
    assert all(line.startswith("autocolor: ") for line in told)
    for each in ("read two.obj: ", "Mesh(nodes 6, polygons 2, parts 2)", "created 4 lights: key", "visible"):
        assert sum(line.startswith(f"autocolor: {each}") for line in told) == 1
    assert "Picture(" not in ran.err


@pytest.mark.parametrize(
    "arguments", [("-vv", "info", "two.obj"), ("info", "-vv", "two.obj"), ("-v", "info", "two.obj", "-v")]
)
def test_given_twice_more_is_told_and_nothing_twice(
    folder: Path, run: Run, arguments: tuple[str, ...]
) -> None:
    ran = run(*arguments)
    assert ran.code == 0
    assert ran.err.count("autocolor: Picture(480 x 640") == 1
    assert ran.err.count("autocolor: read two.obj") == 1


def test_what_is_recolored_is_told(folder: Path, run: Run) -> None:
    run("render", "scene", "--save", "saved.npz", "--size", "30x20")
    told = run("recolor", "saved.npz", "side", "-v", "-o", "side.png").err.splitlines()
    assert [line.partition("(")[0].split(":")[1] for line in told[:-1]] == [
        " read saved.npz",
        " Picture",
        " words and entries sent",
    ]
    assert told[-1] == "wrote side.png"


def test_without_it_nothing_is_told_not_even_after_it_was_given(folder: Path, run: Run) -> None:
    assert run("render", "two.obj", "-v", "-o", "a.png").code == 0
    assert run("render", "two.obj", "-o", "b.png").err == "wrote b.png\n"
    assert run("recolor", "none.npz", "body", "-v").code == 66
    assert run("info", "two.obj").err == ""
    assert [type(handler) for handler in logging.getLogger("autocolor").handlers] == [logging.NullHandler]
