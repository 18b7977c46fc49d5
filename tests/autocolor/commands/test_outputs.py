from __future__ import annotations

import os
from pathlib import Path

import pytest

from autocolor.commands.outputs import refuse_outputs
from autocolor.errors import OutputError, UsageError


def test_new_names_of_the_right_kind_are_taken(folder: Path) -> None:
    refuse_outputs(None, None, force=False)
    refuse_outputs("a.png", "a.npz", force=False)
    refuse_outputs("A.PNG", str(folder / "A.NPZ"), force=False)
    refuse_outputs("scene/without", None, force=False)


@pytest.mark.parametrize(
    ("output", "sentence"),
    [
        ("", "an output must have a name, not an empty name; name a file"),
        ("-", "an output must be a file, not stdout; name a file"),
        ("a.jpg", "-o must be the name of a PNG, not 'a.jpg'; end it in .png"),
    ],
)
def test_a_name_that_says_something_else_is_wrong_usage(folder: Path, output: str, sentence: str) -> None:
    with pytest.raises(UsageError) as caught:
        refuse_outputs(output, None, force=True)
    assert str(caught.value) == sentence


def test_a_picture_file_must_be_one_that_is_known_again(folder: Path) -> None:
    for name in ("a", "a.png", "two.obj"):
        with pytest.raises(UsageError, match="must be the name of a picture file"):
            refuse_outputs(None, name, force=True)


@pytest.mark.parametrize(
    ("option", "sentence"),
    [
        ("--layers", "--layers must be the name of an OpenEXR file, not 'a.jpg'; end it in .exr"),
        ("--words", "--words must be the name of a PNG, not 'a.jpg'; end it in .png"),
        ("--indexed", "--indexed must be the name of a PNG, not 'a.jpg'; end it in .png"),
    ],
)
def test_other_outputs_have_the_suffixes_of_their_kinds(folder: Path, option: str, sentence: str) -> None:
    refuse_outputs(None, None, force=False, others={option: f"a.{sentence[-3:]}"})
    with pytest.raises(UsageError) as caught:
        refuse_outputs(None, None, force=False, others={option: "a.jpg"})
    assert str(caught.value) == sentence


def test_no_two_of_all_outputs_are_the_same_file(folder: Path) -> None:
    with pytest.raises(UsageError, match=r"not a\.png and \./a\.png, which are the same"):
        refuse_outputs("a.png", "a.npz", force=True, others={"--words": "b.png", "--indexed": "./a.png"})


@pytest.mark.parametrize(
    ("output", "sentence"),
    [
        ("scene", "an output must be a file, not the folder scene; add a file name"),
        ("/dev/null", "an output must be a file, not the device /dev/null; choose another name"),
        (
            "no/a.png",
            "an output must be in an existing folder, not no; create it or choose another",
        ),
        (
            "two.obj/a.png",
            "an output must be in an existing folder, not two.obj; create it or choose another",
        ),
    ],
)
def test_what_has_no_place_is_refused_even_with_force(folder: Path, output: str, sentence: str) -> None:
    with pytest.raises(OutputError) as caught:
        refuse_outputs(output, None, force=True)
    assert str(caught.value) == sentence


def test_a_name_that_is_too_long_is_refused(folder: Path) -> None:
    with pytest.raises(OutputError, match="choose another name"):
        refuse_outputs("x" * 300 + ".png", None, force=False)


def test_what_exists_is_refused_unless_forced(folder: Path) -> None:
    (folder / "a.png").write_bytes(b"mine")
    (folder / "link.npz").symlink_to("nowhere")
    for output, save in (("a.png", None), (None, "link.npz")):
        with pytest.raises(OutputError, match="overwrite it"):
            refuse_outputs(output, save, force=False)
        refuse_outputs(output, save, force=True)


def test_a_folder_that_cannot_be_written_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(
        OutputError, match="an output must be in a writable folder, not scene; choose another"
    ):
        refuse_outputs("scene/a.png", None, force=False)


def test_two_outputs_of_one_name_are_refused(folder: Path) -> None:
    (folder / "a.png").symlink_to("a.npz")
    with pytest.raises(UsageError) as caught:
        refuse_outputs("a.png", "a.npz", force=True)
    assert str(caught.value) == (
        "two outputs must be two files, not a.png and a.npz, which are the same; rename one"
    )
