"""Collecting the problems of a scene file, each with its line, table and key."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from autocolor.checks import nearest
from autocolor.errors import InputError, MissingInputError
from autocolor.files.scenes.toml_text import KeyPath, key_lines
from autocolor.scene.columns.problems import Problem

MOST_PROBLEMS: Final = 100

LONGEST_SENTENCE: Final = 400


class SceneProblems:
    """Collects the problems of one scene file and raises them in line order."""

    def __init__(self, place: str, data: bytes, document: dict[str, Any]) -> None:
        self.place = place
        self.data = data
        self.document = document
        self.lines: dict[KeyPath, int] | None = None
        self.found: list[tuple[int, str]] = []
        self.count = 0
        self.all_missing = True

    def note(self, path: KeyPath, text: str, names: tuple[str, Iterable[str]] | None = None) -> None:
        """Add a problem of the value at a path.

        With `names`, a wrong name and the valid ones, the message suggests the closest valid name.
        """
        self.note_all([Problem(path, text + (nearest(*names) if names else ""))])

    def note_all(self, problems: Iterable[Problem], path: KeyPath = ()) -> None:
        """Add problems of the table at a path."""
        for problem in problems:
            self.all_missing = False
            self._note(problem.under(path))

    def _note(self, problem: Problem) -> None:
        self.count += 1
        if self.full:
            return
        where, depth = self._table_of(problem.path)
        if len(problem.path) == depth == 1 and problem.text.startswith("must "):
            where, depth = "", 0
        sentence = problem._replace(path=problem.path[depth:]).sentence
        if len(sentence) > LONGEST_SENTENCE:
            sentence = sentence[:LONGEST_SENTENCE] + "..."
        line = self._line(problem.path)
        at = f", line {line}" if line else ""
        self.found.append((line or 0, f"{self.place}{at}, {where}{sentence}"))

    @property
    def full(self) -> bool:
        """Whether the report has reached its largest number of problems."""
        return len(self.found) >= MOST_PROBLEMS

    def note_file(self, path: KeyPath, error: InputError) -> None:
        """Add the problems of a mesh file, which state their own places; `path` is the key that names it."""
        if isinstance(error, MissingInputError):
            for sentence in error.problems:
                self._note(Problem(path, sentence, names_key=True))
            return
        self.all_missing = False
        self.count += len(error.problems)
        line = self._line(path) or 0
        self.found.extend((line, problem) for problem in error.problems[: MOST_PROBLEMS - len(self.found)])

    def raise_any(self) -> None:
        """Raise InputError with all problems, if any; MissingInputError if they are missing files only."""
        if not self.found:
            return
        sentences = [sentence for _, sentence in sorted(self.found, key=lambda found: found[0])]
        if self.full:
            sentences.append(f"{self.place}: there may be more problems; correct these first")
        raise MissingInputError(sentences) if self.all_missing else InputError(sentences)

    def _line(self, path: KeyPath) -> int | None:
        if self.lines is None:
            self.lines = key_lines(self.data)
        return next(
            (self.lines[path[:end]] for end in range(len(path), 0, -1) if path[:end] in self.lines), None
        )

    def _table_of(self, path: KeyPath) -> tuple[str, int]:
        """The table that a path is in, as in "lights[1] 'key': ", and how many parts of the path name it.

        Rows are counted from 1.
        """
        if len(path) > 1 and path[0] in ("lights", "mesh") and isinstance(path[1], int):
            rows = self.document.get(str(path[0]))
            row = rows[path[1]] if isinstance(rows, list) else None
            name = row.get("name") if isinstance(row, dict) else None
            return f"{path[0]}[{path[1] + 1}]{f' {name[:60]!r}' if isinstance(name, str) else ''}: ", 2
        if len(path) > 1 and path[0] in ("surfaces", "parts"):
            return f"[{path[0]}.{str(path[1])[:60]}]: ", 2
        return ("[view]: ", 1) if path[:1] == ("view",) else ("", 0)
