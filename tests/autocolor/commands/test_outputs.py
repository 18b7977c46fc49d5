from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path

import pytest

from autocolor.commands.outputs import progress, refuse_outputs
from autocolor.errors import OutputError, UsageError
from tests.tables import refused

free = partial(refuse_outputs, force=False)
forced = partial(refuse_outputs, force=True)


def test_new_names_of_the_right_kind_are_taken(folder: Path) -> None:
    free(None, None)
    free("a.png", "a.npz", others={"--layers": "a.exr", "--words": "w.png", "--indexed": "i.png"})
    free("A.PNG", str(folder / "A.NPZ"), others={"--layers": "A.EXR", "--words": None})
    free("scene/without", None)


test_what_is_refused_even_with_force = refused(
    lambda given: refuse_outputs(given[0], given[1], True, given[2]),
    [
        (("", None, {}), "an output must have a name, not an empty name; name a file"),
        (("-", None, {}), "an output must be a file, not stdout; name a file"),
        (("a.jpg", None, {}), "-o must be the name of a PNG, not 'a.jpg'; end it in .png"),
        ((None, "a", {}), "--save must be the name of a picture file, not 'a'; end it in .npz"),
        (
            (None, None, {"--layers": "a.jpg"}),
            "--layers must be the name of an OpenEXR file, not 'a.jpg'; end it in .exr",
        ),
        ((None, None, {"--words": "a"}), "--words must be the name of a PNG, not 'a'; end it in .png"),
        (
            ("no/a.png", None, {}),
            "an output must be in an existing folder, not no; create it or choose another",
        ),
        (
            ("/dev/null/a.png", None, {}),
            "an output must be in an existing folder, not /dev/null; create it or choose another",
        ),
        (
            ("a.png", "a.npz", {"--words": "b.png", "--indexed": "./a.png"}),
            "two outputs must be two files, not a.png and ./a.png, which are the same; rename one",
        ),
    ],
)


def test_two_names_of_one_file_are_one_file(folder: Path) -> None:
    (folder / "a.png").symlink_to("a.npz")
    with pytest.raises(UsageError, match=r"not a\.png and a\.npz, which are the same"):
        forced("a.png", "a.npz")


def test_what_exists_is_refused_unless_forced(folder: Path) -> None:
    (folder / "a.png").write_bytes(b"mine")
    (folder / "link.npz").symlink_to("nowhere")
    for output, save in (("a.png", None), (None, "link.npz")):
        with pytest.raises(OutputError):
            free(output, save)
        forced(output, save)


def test_a_folder_that_cannot_be_written_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(OutputError) as caught:
        free("scene/a.png", None)
    assert str(caught.value) == "an output must be in a writable folder, not scene; choose another"


def test_a_terminal_gets_a_progress_bar_with_the_time_left(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with progress(2) as step:
        step()
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress(2) as step:
        step()
        step()
        print("message", file=sys.stderr)
    # The bar has ended its line before the message.
    *_, bar, message, end = capsys.readouterr().err.split("\n")
    assert "2/2" in bar
    assert (message.removeprefix("\x1b[?25h"), end) == ("message", "")
