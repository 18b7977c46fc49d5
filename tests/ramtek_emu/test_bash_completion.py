from __future__ import annotations

import shutil
import subprocess

import click
import pytest

from ramtek_emu.bash_completion import WholeWords, joined, kept

COLORS = ["color=red", "color=dark red", "size=1"]


@click.command()
@click.option(
    "--set", shell_complete=lambda context, parameter, word: [c for c in COLORS if c.startswith(word)]
)
@click.option("--to", type=click.Path())
@click.argument("name", shell_complete=lambda context, parameter, word: [context.params["set"]])
def paint(set: str, to: str, name: str) -> None:
    """Do nothing."""


def told(monkeypatch: pytest.MonkeyPatch, *words: str) -> list[str]:
    """What bash is told for the words that it made of a line, the last of them incomplete."""
    monkeypatch.setenv("COMP_WORDS", "\n".join(words))
    monkeypatch.setenv("COMP_CWORD", str(len(words) - 1))
    return WholeWords(paint, {}, "paint", "_PAINT_COMPLETE").complete().splitlines()


def test_values_are_completed_after_an_equals_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, "paint", "--set", "color", "=") == ["plain,red", "plain,dark\\ red"]
    assert told(monkeypatch, "paint", "--set", "color", "=", "r") == ["plain,red"]
    assert told(monkeypatch, "paint", "--set", "=", "color", "=", "da") == ["plain,dark\\ red"]
    assert told(monkeypatch, "paint", "--set", "=", "si") == ["plain,size=1"]


def test_a_bash_that_leaves_words_whole_is_told_whole_candidates(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, "paint", "--set", "color=d") == ["plain,color=dark\\ red"]


def test_an_argument_after_an_equals_sign_is_the_next_one(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, "paint", "--set", "size", "=", "1", "") == ["plain,size=1"]


def test_files_are_left_to_bash(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, "paint", "--to", "x\\ y") == ["file,x y"]


def test_words_are_joined_around_equals_signs_alone() -> None:
    assert joined(["a", "=", "b", "c"]) == ["a=b", "c"]
    assert joined(["a", "==", "b"]) == ["a==b"]
    assert joined(["=", "b"]) == ["=b"]
    assert (kept("a=b=c"), kept("--a=b=c"), kept("--a")) == ("a=b=", "b=", "")


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_bash_takes_the_candidates_without_their_quotes_for_words() -> None:
    script = WholeWords(paint, {}, "paint", "_PAINT_COMPLETE").source()
    stub = r"env() { printf 'plain,dark\\ red\nplain,*\n'; }" + "\n"
    shown = "_paint_completion paint; printf '<%s>' \"${COMPREPLY[@]}\""
    ran = subprocess.run(
        ["bash", "--norc", "-c", f"{script}{stub}COMP_WORDS=(paint); COMP_CWORD=1; {shown}"],
        check=True,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (ran.stdout, ran.stderr) == ("<dark\\ red><*>", "")
