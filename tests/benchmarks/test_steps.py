from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import rendering
from benchmarks import steps
from benchmarks.points import Session

PYRAMID = Path(__file__).parents[2] / "scenes" / "pyramid"


@pytest.fixture
def session() -> Session:
    return Session(autocolor.read_scene(PYRAMID), 12)


def test_every_step_of_the_table_is_a_function() -> None:
    assert all(callable(function) for function in steps.functions().values())


def test_every_step_stands_below_one_that_is_there() -> None:
    names = {steps.FRAME, *(step.function for step in steps.STEPS)}
    assert {step.parent for step in steps.STEPS} <= names


def test_a_step_that_is_gone_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        steps, "STEPS", (steps.Step("autocolor.lighting.picture", "decomposed", steps.FRAME),)
    )
    with pytest.raises(SystemExit) as left:
        steps.functions()
    assert str(left.value) == (
        "benchmarks/steps.py: autocolor.lighting.picture must have the step decomposed, and has not; name in"
        " STEPS the function that does its work now"
    )


def test_a_step_that_no_frame_calls_is_named(monkeypatch: pytest.MonkeyPatch, session: Session) -> None:
    idle = steps.Step("autocolor.checks", "nearest", steps.FRAME)
    monkeypatch.setattr(steps, "STEPS", (*steps.STEPS, idle))
    watch = steps.Watch()
    with steps.wrapped(watch):
        frame = watch.timed_frame(session.frame)
    with pytest.raises(SystemExit) as left:
        list(steps.lines(watch, [frame]))
    assert str(left.value) == (
        "benchmarks/steps.py: a frame must call autocolor.checks.nearest, and does not; name in STEPS the"
        " function that does its work now"
    )


def test_a_step_below_the_wrong_one_is_named(monkeypatch: pytest.MonkeyPatch, session: Session) -> None:
    moved = [
        step._replace(parent=steps.FRAME) if step.function == "illuminate" else step for step in steps.STEPS
    ]
    monkeypatch.setattr(steps, "STEPS", tuple(moved))
    watch = steps.Watch()
    with steps.wrapped(watch), pytest.raises(SystemExit) as left:
        watch.timed_frame(session.frame)
    assert str(left.value) == (
        "benchmarks/steps.py: whole frame must call illuminate, and rendering does; correct its parent in"
        " STEPS, or leave out a step of several parents"
    )


def test_the_lines_below_a_line_add_up_to_it(session: Session) -> None:
    watch = steps.Watch()
    with steps.wrapped(watch):
        frame = watch.timed_frame(session.frame)
    lines = list(steps.lines(watch, [frame]))
    parents = [row for row, line in enumerate(lines[:-1]) if lines[row + 1]["depth"] > line["depth"]]
    assert lines[0]["step"] == steps.FRAME
    assert lines[0]["percent"] == 100
    assert len(parents) > 1
    for row in parents:
        below = []
        for line in lines[row + 1 :]:
            if line["depth"] <= lines[row]["depth"]:
                break
            if line["depth"] == lines[row]["depth"] + 1:
                below.append(line["ms"]["median"])
        assert all(spent >= 0 for spent in below)
        assert sum(below) == pytest.approx(lines[row]["ms"]["median"])


def test_after_a_measurement_the_package_is_as_before(session: Session) -> None:
    before = dict(vars(rendering)), dict(rendering.ALGORITHMS)
    with steps.wrapped(steps.Watch()):
        assert rendering.rendering is not before[0]["rendering"]
    assert (vars(rendering), rendering.ALGORITHMS) == before
