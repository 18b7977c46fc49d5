from __future__ import annotations

import pytest

from autocolor import Scene
from benchmarks import peers
from benchmarks.comparison import comparison_scene
from benchmarks.contestants import contestants
from benchmarks.peers.peer import AbsentError, on_llvmpipe
from benchmarks.targets import Target, between, row, text

SECONDS = {"ours": [1.0, 2.0, 3.0], "theirs": [2.0, 4.0, 6.0]}
RATIO = between("ours", "theirs")
AGAINST_A_PEER = Target("a row", "of a peer's time", 1, RATIO, needs="a peer")


@pytest.fixture(scope="module")
def scene() -> Scene:
    return comparison_scene()


@pytest.mark.parametrize(
    ("target", "verdict"),
    [
        (Target("a row", "x", 0.5, RATIO), "met"),
        (Target("a row", "x", 0.49, RATIO), "MISSED"),
        (Target("a row", "x", 0.5, RATIO, at_least=True), "met"),
        (Target("a row", "x", 0.51, RATIO, at_least=True), "MISSED"),
    ],
)
def test_a_target_is_met_up_to_its_bound(target: Target, verdict: str) -> None:
    measured = row(target, SECONDS, {}, quick=False)
    assert measured["verdict"] == verdict
    assert measured["measured"] == {"low": 0.5, "median": 0.5, "high": 0.5}


def test_a_row_without_its_peer_is_skipped_and_says_why() -> None:
    measured = row(AGAINST_A_PEER, {}, {"a peer": ("skipped", "it is not installed")}, quick=False)
    assert (measured["measured"], measured["verdict"]) == (None, "skipped")
    table = text(
        {"peers": {}, "absent": {"a peer": "it is not installed"}, "targets": [measured], "cases ms": {}}
    )
    assert "a peer: skipped: it is not installed" in table
    assert any(
        line.startswith("a row ") and "skipped: it is not installed" in line for line in table.splitlines()
    )


def test_a_row_against_a_peer_with_another_picture_is_not_comparable() -> None:
    measured = row(AGAINST_A_PEER, SECONDS, {"a peer": ("not comparable", "it has a hole")}, quick=False)
    assert (measured["measured"], measured["verdict"]) == (None, "not comparable")


def test_what_takes_long_is_left_out_of_a_quick_run() -> None:
    target = Target("a row", "x", 1, RATIO, takes_long=True)
    assert row(target, SECONDS, {}, quick=True)["verdict"] == "skipped"
    assert row(target, SECONDS, {}, quick=False)["verdict"] == "met"


def test_what_is_not_built_yet_has_its_bound_and_is_never_met() -> None:
    measured = row(Target("a row", "ms", 33), SECONDS, {}, quick=False)
    assert (measured["measured"], measured["verdict"]) == (None, "skipped")
    assert (measured["bound"], measured["reason"]) == (33, "it is not built yet")


def test_a_peer_that_is_not_installed_is_named_with_what_to_install(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(peers.PEERS, "nobody", ("benchmarks.peers.nobody", "Nobody"))
    present, absent = contestants(scene, ["nobody"])
    assert present == []
    assert absent == {"nobody": "No module named 'benchmarks.peers.nobody'; pip install '.[peers]'"}


def test_a_program_that_is_not_there_is_named(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    _, absent = contestants(scene, ["POV-Ray"])
    assert absent == {"POV-Ray": "there is no program povray; apt-get install povray"}


def test_opengl_on_a_graphics_card_is_not_what_the_targets_are_about() -> None:
    with pytest.raises(AbsentError, match="must render with llvmpipe, not A fast card"):
        on_llvmpipe("A fast card")
