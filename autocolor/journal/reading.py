"""Reading a journal: the session that its lines give, without running it.

Each line is one statement. Only the calls that `script` writes are known, and their arguments must be plain
values; anything else is refused, with its line.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, NamedTuple

from autocolor.checks import listed
from autocolor.errors import AutocolorError, InputError, MissingInputError
from autocolor.files.reading import read_bytes
from autocolor.files.scene_sources import read_scene
from autocolor.journal.history import History
from autocolor.journal.lines import Called, called, plain_value, refuse, value_of
from autocolor.journal.opening import check_sum, place_again
from autocolor.journal.places import Source, place_of
from autocolor.journal.script import HEADER, STUDIO
from autocolor.journal.steps import SOURCE_OPTIONS, Steps, source_in
from autocolor.scene.scene import Scene

LARGEST_JOURNAL: Final = 64 << 20
"""Assumed: bytes; some hundred thousand steps."""

MOST_STEPS: Final = 1_000_000
LONGEST_PROBLEM: Final = 400

MADE_BY: Final = ("read_scene", "replace", "a checksum")
"""The lines between the header and the studio."""


class Session(NamedTuple):
    """What a journal tells: the history of a session, and what its first scene was read from."""

    history: History
    source: Source


def read_journal(path: str | os.PathLike[str]) -> Session:
    """The session of a journal, which is not run: `Studio(read_journal(path).history, display)` goes on.

    The mesh with which it began is read again. Raises InputError if a line is no known call with plain
    values, if a step is refused, or if the mesh is not the same as then; MissingInputError if a file is
    missing.
    """
    name = Path(path).name
    data = read_bytes(Path(path), LARGEST_JOURNAL)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{name}: a journal must be text in UTF-8; choose another file") from None
    return session_of(text, name)


def session_of(text: str, name: str = "journal") -> Session:
    """The session of the text of a journal; see `read_journal`. `name` is what messages call it."""
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.startswith("#")]
    if len(lines) > MOST_STEPS:
        raise InputError(f"{name}: a journal must have at most {MOST_STEPS:,} lines, not {len(lines):,}")
    given = [line for _, line in lines]
    if tuple(given[: len(HEADER)]) != HEADER or STUDIO not in given:
        raise InputError(f"{name}: a journal must begin as autocolor writes it; choose another file")
    begun = given.index(STUDIO)
    if begun != len(HEADER) + len(MADE_BY):
        raise InputError(f"{name}: a journal must make its scene by {listed(MADE_BY)}; choose another file")
    (first, made), (second, replaced), (third, checksum) = lines[len(HEADER) : begun]
    with _in_line(name, first):
        source = _source(called(value_of(made, "scene"), made), made)
        place = place_of(source)
        read = read_scene(source.path, up=source.up, scale=source.scale, surfaces=source.surfaces)
    with _in_line(name, second):
        start = _with_tables(read, replaced)
    with _in_line(name, third):
        check_sum(start, plain_value(value_of(checksum, "checksum"), checksum), source)
    history = History(start, place_again(place, start, read))
    steps = Steps(history)
    for number, line in lines[begun + 1 :]:
        with _in_line(name, number):
            steps.take(line)
    return Session(history, source)


@contextmanager
def _in_line(name: str, number: int) -> Iterator[None]:
    """Raise errors as InputError with the number of the line."""
    try:
        yield
    except AutocolorError as error:
        kind = MissingInputError if isinstance(error, MissingInputError) else InputError
        problem = str(error).replace("\n", "; ")
        raise kind(f"{name}, line {number}: {problem[:LONGEST_PROBLEM]}") from None


def _source(call: Called, line: str) -> Source:
    """What the first scene is read from."""
    options = {key: plain_value(value, line) for key, value in call.keywords.items()}
    if call.name != "autocolor.read_scene" or not options.keys() <= SOURCE_OPTIONS:
        refuse(line)
    return source_in(call.arguments, options, line)


def _with_tables(scene: Scene, line: str) -> Scene:
    """The first scene of a session: its tables, with the mesh of the scene that was read."""
    call = called(value_of(line, "scene"), line)
    if call.name != "scene.replace" or call.arguments:
        refuse(line)
    return scene.replace(**{key: plain_value(value, line) for key, value in call.keywords.items()})
