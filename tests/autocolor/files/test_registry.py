from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from autocolor.files.registry import Registry, format_named, recognized, suffix_rule, suffixes_of


@dataclass(frozen=True)
class Shape:
    """A format, as far as a registry knows it."""

    name: str
    suffixes: tuple[str, ...] = ()
    begins: Callable[[bytes], bool] | None = None


SOLID = Shape("SOLID", (".solid", ".sld"), lambda head: head.startswith(b"solid"))
PLAIN = Shape("PLAIN", (".plain",), lambda head: head.startswith(b"plain"))
ANYTHING = Shape("ANYTHING", (".any",))
ALL = (ANYTHING, PLAIN, SOLID)


def test_formats_are_registered_by_modules_and_sorted_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "rack").mkdir()
    (tmp_path / "rack" / "__init__.py").write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    registry = Registry[Shape]("rack")
    assert registry.formats() == ()
    registry.register(SOLID)
    assert registry.register(PLAIN) is PLAIN
    assert registry.formats() == (PLAIN, SOLID)
    monkeypatch.delitem(sys.modules, "rack")


def test_suffixes_are_each_listed_once() -> None:
    assert suffixes_of((*ALL, Shape("another", (".any",)))) == (".any", ".plain", ".sld", ".solid")


def test_a_format_is_named_by_a_suffix_in_capitals_too() -> None:
    assert format_named(Path("x.SLD"), ALL) is SOLID
    assert format_named(Path("x"), ALL) is None


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
        ("a.solid", b"solid", SOLID),
        ("a.solid", b"", SOLID),
        ("a.solid", b"neither", SOLID),
        ("a.solid", b"plain", PLAIN),
        ("a", b"plain", PLAIN),
        ("a", b"neither", None),
        ("a.any", b"plain", ANYTHING),
        ("a.shape", b"solid", SOLID),
    ],
)
def test_a_file_has_the_format_of_its_suffix_unless_only_another_one_begins_like_it(
    tmp_path: Path, name: str, content: bytes, found: Shape | None
) -> None:
    (tmp_path / name).write_bytes(content)
    assert recognized(tmp_path / name, ALL) is found


def test_what_is_no_file_begins_as_nothing_and_is_never_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for name in ("pipe", "none", ".", "a\0b"):
        assert recognized(tmp_path / name, ALL) is None


@pytest.mark.parametrize(
    ("name", "suffixes", "rule"),
    [
        ("a.shape", (".any",), "end in .any, not in '.shape'"),
        ("a", (".any", ".plain", ".sld"), "end in .any, .plain or .sld, and this one has no ending"),
        ("a.SLDD", (".any", ".sld"), "end in .any or .sld, not in '.SLDD'; did you mean '.sld'?"),
    ],
)
def test_the_rule_for_a_suffix_lists_all_and_the_nearest(
    name: str, suffixes: tuple[str, ...], rule: str
) -> None:
    assert suffix_rule(Path(name), suffixes) == rule
