"""The report of a scene file: every problem, each with its line, its table and its key."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any, Final, TypeVar

from pydantic import BaseModel, ValidationError

from autocolor.checks import nearest
from autocolor.errors import InputError, MissingInputError
from autocolor.files.scenes.toml_text import KeyPath, key_lines

MOST_PROBLEMS: Final = 100

LONGEST_SENTENCE: Final = 400

Model = TypeVar("Model", bound=BaseModel)


class SceneProblems:
    """The problems found in one scene file, in the order of its lines."""

    def __init__(self, place: str, data: bytes, document: dict[str, Any]) -> None:
        self.place = place
        self.data = data
        self.document = document
        self.lines: dict[KeyPath, int] | None = None
        self.found: list[tuple[int, str]] = []
        self.count = 0
        self.all_missing = True

    def note(self, path: KeyPath, sentence: str, names: tuple[str, Iterable[str]] | None = None) -> None:
        """Note a problem of the table or key at the path; `names` is a wrong name and the right ones."""
        self.all_missing = False
        self._note(path, sentence, names)

    def _note(self, path: KeyPath, sentence: str, names: tuple[str, Iterable[str]] | None = None) -> None:
        self.count += 1
        if self.full:
            return
        if names:
            sentence += nearest(*names)
        if len(sentence) > LONGEST_SENTENCE:
            sentence = sentence[:LONGEST_SENTENCE] + "..."
        line = self._line(path)
        at = f", line {line}" if line else ""
        self.found.append((line or 0, f"{self.place}{at}, {self._where(path)}{sentence}"))

    @property
    def full(self) -> bool:
        """Whether there are as many problems as a report has."""
        return len(self.found) >= MOST_PROBLEMS

    def note_all(self, path: KeyPath, error: InputError, prefix: str = "") -> None:
        """Note what a value's own checks say; a sentence that starts with a key is placed at that key."""
        for problem in error.problems:
            problem = problem.removeprefix(prefix)
            self.note((*path, problem.split(" ", 1)[0].rstrip(":")), problem)

    def note_file(self, path: KeyPath, error: InputError) -> None:
        """Note what the reader of a mesh file says; its sentences have their own places."""
        if isinstance(error, MissingInputError):
            for problem in error.problems:
                self._note(path, problem)
            return
        self.all_missing = False
        self.count += len(error.problems)
        line = self._line(path) or 0
        self.found.extend((line, problem) for problem in error.problems[: MOST_PROBLEMS - len(self.found)])

    def raise_any(self) -> None:
        """Raise one error with everything that was noted: MissingInputError if only files are missing."""
        if not self.found:
            return
        sentences = [sentence for _, sentence in sorted(self.found, key=lambda found: found[0])]
        if self.full:
            sentences.append(f"{self.place}: there may be more problems; correct these first")
        raise MissingInputError(sentences) if self.all_missing else InputError(sentences)

    def checked(self, path: KeyPath, model: type[Model], table: object) -> tuple[dict[str, Any], set[str]]:
        """The keys of the table that fit the model, and the names of known keys that do not."""
        if not isinstance(table, dict):
            self.note(path, f"it must be a table, not {shown_toml(table)}; write keys and values")
            return {}, set(model.model_fields)
        known = {key: value for key, value in table.items() if key in model.model_fields}
        for key in [key for key in table if key not in known]:
            self.note((*path, key), f"there is no key {shown_toml(key)}", (key, tuple(model.model_fields)))
        wrong: set[str] = set()
        try:
            model.model_validate(known)
        except ValidationError as error:
            for entry in error.errors(include_url=False, include_context=False):
                key = str(entry["loc"][0])
                if key in wrong:
                    continue
                wrong.add(key)
                rule = model.model_fields[key].description
                if entry["type"] == "missing":
                    self.note(path, f"{key} {rule}, not missing; add it")
                else:
                    self.note((*path, key), f"{key} {rule}, not {shown_toml(known[key])}")
        return {key: value for key, value in known.items() if key not in wrong}, wrong

    def _line(self, path: KeyPath) -> int | None:
        if self.lines is None:
            self.lines = key_lines(self.data)
        return next(
            (self.lines[path[:end]] for end in range(len(path), 0, -1) if path[:end] in self.lines), None
        )

    def _where(self, path: KeyPath) -> str:
        """The table of a path: "[surfaces.body]: ", "lights[1] 'key': " counted from 1, or nothing."""
        if len(path) > 1 and path[0] in ("lights", "mesh") and isinstance(path[1], int):
            rows = self.document.get(str(path[0]))
            row = rows[path[1]] if isinstance(rows, list) else None
            name = row.get("name") if isinstance(row, dict) else None
            return f"{path[0]}[{path[1] + 1}]{f' {name[:60]!r}' if isinstance(name, str) else ''}: "
        if len(path) > 1 and path[0] in ("surfaces", "parts"):
            return f"[{path[0]}.{str(path[1])[:60]}]: "
        return "[view]: " if path[:1] == ("view",) and len(path) > 1 else ""


def shown_toml(value: object) -> str:
    """The value as it would stand in the file, cut where it is long."""
    text = json.dumps(value, default=str, ensure_ascii=False)
    return text if len(text) <= 60 else text[:60] + "..."
