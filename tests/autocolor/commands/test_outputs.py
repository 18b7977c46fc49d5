from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path

import pytest

from autocolor.commands.outputs import progress, refuse_outputs
from autocolor.errors import OutputError
from tests.tables import refused


def test_names_of_the_right_kind_are_taken(folder: Path) -> None:
    refuse_outputs({"-o": "a.png", "--save": "a.npz", "--layers": "a.exr", "--words": "w.png"}, False)
    refuse_outputs({"-o": "A.PNG", "--save": str(folder / "A.NPZ"), "--indexed": None}, False)


test_what_is_refused_even_with_force = refused(
    partial(refuse_outputs, force=True),
    [
        ({"-o": "-"}, "an output must be a file, not stdout; name a file"),
        ({"-o": "a"}, "-o must be the name of a PNG, not 'a'; end it in .png"),
        ({"--save": "a"}, "--save must be the name of a picture file, not 'a'; end it in .npz"),
        ({"--layers": "a.jpg"}, "--layers must be the name of an OpenEXR file, not 'a.jpg'; end it in .exr"),
        ({"--words": "a"}, "--words must be the name of a PNG, not 'a'; end it in .png"),
        (
            {"-o": "a.png", "--save": "a.npz", "--words": "b.png", "--indexed": "./a.png"},
            "two outputs must be two files, not a.png and ./a.png, which are the same; rename one",
        ),
    ],
)


def test_what_exists_and_a_folder_that_cannot_be_written_are_refused(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "a.png").write_bytes(b"mine")
    with pytest.raises(OutputError):
        refuse_outputs({"-o": "a.png"}, False)
    refuse_outputs({"-o": "a.png"}, True)
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(OutputError, match="must be in a writable folder, not scene; choose another"):
        refuse_outputs({"-o": "scene/a.png"}, False)


def test_a_terminal_gets_a_progress_bar_with_the_time_left(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for is_terminal in (False, True):
        monkeypatch.setattr(sys.stderr, "isatty", lambda: is_terminal)  # noqa: B023
        with progress(2) as bar:
            bar.update(1)
            bar.update(1)
        out, err = capsys.readouterr()
        # The bar ends its line.
        assert (out, "2/2" in err, "\n" in err.partition("2/2")[2]) == ("", is_terminal, is_terminal)
