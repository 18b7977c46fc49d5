from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import MissingInputError
from autocolor.commands import demo


def test_a_demo_that_is_not_there_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(demo, "PLACES", (tmp_path,))
    with pytest.raises(MissingInputError, match="install autocolor again"):
        autocolor.demo()
