"""A scene that was read, with messages about what was repaired and created."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from autocolor.checks import nearest, shown
from autocolor.errors import InputError, MissingInputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scenes.toml_text import KeyPath, key_lines
from autocolor.scene.columns import Problem
from autocolor.scene.creation import scene_of
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import MOST_SURFACES, Surface


@dataclass(frozen=True)
class SceneReport:
    """A scene, with messages about what was repaired or skipped in its files, and about what was created.

    `mesh_files` are the `[[mesh]]` tables with which a scene file can name the same mesh (see `scene_text`).
    `is_view_created` and `are_lights_created` tell whether the source gave none.
    """

    scene: Scene
    repairs: tuple[str, ...] = ()
    created: tuple[str, ...] = ()
    mesh_files: tuple[Mapping[str, Any], ...] = ()
    is_view_created: bool = False
    are_lights_created: bool = False


def scene_report(
    reports: Sequence[MeshReport], *, mesh_files: tuple[Mapping[str, Any], ...] = (), **fields: Any
) -> SceneReport:
    """The report for a scene of the meshes that were read; `fields` are passed to `scene_of`."""
    mesh = Mesh.joined([report.mesh for report in reports])
    material_of_part, materials, conflicts = _joined_materials(reports)
    scene = scene_of(mesh, material_of_part=material_of_part, materials=tuple(materials.values()), **fields)
    surfaces = fields.get("surfaces", ())
    given = set() if isinstance(surfaces, str) else {surface.name for surface in surfaces}
    names = [surface.name for surface in scene.surfaces if surface.name not in given]
    created = []
    if fields.get("view") is None:
        created.append("a view was created that frames the object")
    if fields.get("lights") is None:
        created.append(f"{len(scene.lights)} studio lights were created")
    if len(names) == 1:
        created.append(f"surface {names[0]!r} was created")
    elif names:
        listed = ", ".join(map(repr, names[:12])) + (
            f" and {len(names) - 12} more" if len(names) > 12 else ""
        )
        created.append(f"{len(names)} surfaces were created: {listed}")
    if len(scene.surfaces) == MOST_SURFACES:
        of_last = sum(part.surface == scene.surfaces[-1].name for part in scene.parts)
        if of_last > 1:
            created.append(
                f"{of_last:,} parts share surface {scene.surfaces[-1].name!r}, because a scene has at most"
                f" {MOST_SURFACES}"
            )
    repairs = (*(repair for report in reports for repair in report.repairs), *conflicts)
    return SceneReport(
        scene,
        repairs,
        tuple(created),
        mesh_files,
        fields.get("view") is None,
        fields.get("lights") is None,
    )


def _joined_materials(
    reports: Sequence[MeshReport],
) -> tuple[dict[str, str], dict[str, Surface], tuple[str, ...]]:
    """The materials of parts, the surfaces of materials, and a message for each conflict of several meshes.

    Where two files describe a material of the same name differently, that of the later one is renamed. A part
    that several meshes have is one part, and has the first material that one of them gives it.
    """
    material_of_part: dict[str, str] = {}
    materials: dict[str, Surface] = {}
    conflicts = []
    for report in reports:
        renamed = {}
        for surface in report.materials:
            name, number = surface.name, 1
            while name in materials and materials[name].replace(name=surface.name) != surface:
                number += 1
                name = f"{surface.name} {number}"
            renamed[surface.name] = name
            materials.setdefault(name, surface if name == surface.name else surface.replace(name=name))
        for part, material in report.material_of_part.items():
            name = renamed.get(material, material)
            kept = material_of_part.setdefault(part, name)
            if kept != name:
                conflicts.append(f"part {shown(part)} is in several meshes: it has material {shown(kept)}")
    return material_of_part, materials, tuple(conflicts)


# -------------------- problems
# Collecting the problems of a scene file, each with its line, table and key.

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
