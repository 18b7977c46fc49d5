from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.commands.tutorial import teach
from autocolor.journal.history import History
from tests.autocolor.commands.conftest import Refused, Run


def test_it_is_taught_on_a_display_elsewhere(
    folder: Path, run: Run, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[str, str, Path, float]] = []

    def session(history: History, address: str, place: Path, prepare: object, timeout: float) -> None:
        assert prepare is teach
        asked.append((history.scene.name, address, place, timeout))

    monkeypatch.setattr("autocolor.commands.tutorial.session_elsewhere", session)
    assert run("tutorial", "--to", "tcp://127.0.0.1:9300", "--timeout", "200").code == 0
    assert asked == [("coupe", "tcp://127.0.0.1:9300", folder, 200.0)]
    refused("tutorial --to 127.0.0.1", 2)
