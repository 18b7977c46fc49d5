from __future__ import annotations

import logging
import re
import subprocess
import sys

import pytest

from autocolor import render, scene_of
from autocolor.logs import logger_of, timed
from tests.small import cube


def test_when_memory_runs_out_the_innermost_stage_is_noted() -> None:
    logger = logger_of("autocolor.somewhere")
    with pytest.raises(MemoryError) as caught, timed(logger, "read car"), timed(logger, "node normals"):
        raise MemoryError
    assert caught.value.__notes__ == ["node normals"]


def test_what_is_created_and_each_stage_of_a_rendering_are_told(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING, "autocolor"):
        render(scene_of(cube()), (30, 20))
    assert caplog.messages == []
    with caplog.at_level(logging.INFO, "autocolor"):
        render(scene_of(cube()), (30, 20))
    told = [re.sub(r"\(.*\)|\d+\.\d ms$", "...", message) for message in caplog.messages]
    assert told == [
        "created a view from ...",
        "created 4 lights: key, fill, top, rim",
        "created surfaces: surface",
        "node normals: ...",
        "visible surfaces, 30 x 20: ...",
        "illumination: ...",
    ]
    assert {record.name.split(".")[0] for record in caplog.records} == {"autocolor"}


def test_a_stage_is_told_with_its_milliseconds(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("autocolor.logs.perf_counter", iter([1.0, 1.25]).__next__)
    with caplog.at_level(logging.INFO, "autocolor"), timed(logger_of("autocolor.somewhere"), "something"):
        pass
    assert caplog.messages == ["something: 250.0 ms"]


def test_the_library_says_nothing_unless_asked() -> None:
    code = (
        "import logging, autocolor; autocolor.render(autocolor.read_scene('scenes/pyramid'), (30, 20));"
        "print(logging.getLogger('autocolor').handlers)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert (ran.stdout, ran.stderr) == ("[<NullHandler (NOTSET)>]\n", "")
