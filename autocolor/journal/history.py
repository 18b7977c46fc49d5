"""The history of a session: its scenes to undo and to redo, and every step that was taken, in order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count, pairwise
from string import ascii_uppercase
from typing import Final, Literal, NamedTuple

from autocolor.checks import nearest, shown
from autocolor.errors import UsageError
from autocolor.journal.places import Place, Source
from autocolor.scene.scene import Scene

# -------------------- variants
# Variants: scenes that were kept under names, to come back to and to compare.

MOST_VARIANTS: Final = 1000
LONGEST_NAME: Final = 100


class Opened(NamedTuple):
    """A scene with the place that it belongs to."""

    scene: Scene
    place: Place


class Variants(Mapping[str, Opened]):
    """Kept scenes by name, in the order in which they were kept; an immutable value."""

    def __init__(self, kept: Mapping[str, Opened] | None = None) -> None:
        self._kept = dict(kept or {})

    def __getitem__(self, name: str) -> Opened:
        """The scene of a name. Raises UsageError, with the closest name, if there is none."""
        if name not in self._kept:
            raise UsageError(f"there is no variant {shown(name)}{nearest(str(name), self._kept)}")
        return self._kept[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._kept)

    def __len__(self) -> int:
        return len(self._kept)

    def __contains__(self, name: object) -> bool:
        return name in self._kept

    def with_kept(self, name: str, opened: Opened) -> Variants:
        """These and another one. Raises UsageError for a name that is in use, empty or too long."""
        if not isinstance(name, str) or not 0 < len(name) <= LONGEST_NAME:
            raise UsageError(
                f"a variant must have a name of 1 to {LONGEST_NAME} characters, not {shown(name)};"
                " choose another"
            )
        if name in self._kept:
            raise UsageError(
                f"a variant must have a name of its own, and {shown(name)} is in use; choose another, or drop"
                " that one"
            )
        if len(self._kept) >= MOST_VARIANTS:
            raise UsageError(f"there must be at most {MOST_VARIANTS} variants; drop one")
        return Variants({**self._kept, name: opened})

    def without(self, name: str) -> Variants:
        """These without one. Raises UsageError if there is none of that name."""
        self[name]
        return Variants({each: kept for each, kept in self._kept.items() if each != name})

    def free_name(self) -> str:
        """The first of A, B, C ... Z, A2, B2 ... that is not in use."""
        names = (f"{letter}{number or ''}" for number in _numbers() for letter in ascii_uppercase)
        return next(name for name in names if name not in self._kept)


def _numbers() -> Iterator[int]:
    """0 for the first letters, then 2, 3, 4 and so on."""
    yield 0
    yield from count(2)


class Edit(NamedTuple):
    """A step that changed the scene; if it `joins`, it is undone together with the step before it."""

    before: Scene
    after: Scene
    joins: bool = False


class Open(NamedTuple):
    """A step that opened a scene."""

    scene: Scene
    source: Source


class Show(NamedTuple):
    """A step that came back to a variant."""

    name: str


class Keep(NamedTuple):
    """The scene was kept as a variant; this is nothing to undo."""

    name: str


class Drop(NamedTuple):
    """A variant was dropped; this is nothing to undo."""

    name: str


class Saved(NamedTuple):
    """A scene was saved; this is nothing to undo. `files` are those to save to again, with their stamps."""

    scene: Scene
    files: Mapping[str, str]


Step = Edit | Open | Show | Keep | Drop | Saved | Literal["undo", "redo"]


class History:
    """The scenes of a session and the steps between them; `start` is the scene with which it began.

    `steps` are all that were taken, those that were undone included: taken again one after the other, they
    give the same history. `first_place` is what the first scene was opened from.
    """

    def __init__(self, start: Scene, place: Place | None = None) -> None:
        self.start = start
        self.first_place = Place() if place is None else place
        self.steps: list[Step] = []
        self.variants = Variants()
        self._now = Opened(start, self.first_place)
        self._done: list[Opened] = []
        self._undone: list[Opened] = []
        self._saved = {self.first_place: Saved(start, {})}

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self._now.scene

    @property
    def place(self) -> Place:
        """What the current scene, before its edits, was opened from."""
        return self._now.place

    @property
    def saved(self) -> Saved:
        """The scene of the current place that was opened or saved last, and the files it is saved to."""
        return self._saved[self.place]

    @property
    def is_changed(self) -> bool:
        """Whether the current scene differs from the one of its place that was opened or saved last."""
        return not self.saved.scene.equals(self.scene)

    @property
    def left_unsaved(self) -> tuple[str, ...]:
        """The names of scenes with changes that were not saved when others were opened after them."""
        left = [one for one, other in pairwise([*self._done, self._now]) if one.place is not other.place]
        last = {each.place: each.scene for each in left if each.place is not self.place}
        return tuple(
            scene.name for place, scene in last.items() if not self._saved[place].scene.equals(scene)
        )

    @property
    def unsaved_variants(self) -> tuple[str, ...]:
        """The names of variants that are none of the scenes that were opened or saved last."""
        saved = [each.scene for each in self._saved.values()]
        return tuple(
            name
            for name, kept in self.variants.items()
            if not any(scene.equals(kept.scene) for scene in saved)
        )

    @property
    def to_undo(self) -> tuple[Scene, ...]:
        """The scenes before each step that can be undone, the last one last."""
        return tuple(each.scene for each in self._done)

    @property
    def to_redo(self) -> tuple[Scene, ...]:
        """The scenes after each step that can be redone, the next one last."""
        return tuple(each.scene for each in self._undone)

    def take(self, scene: Scene, same_step: bool = False) -> None:
        """Make a scene the current one; with `same_step`, this edit and the previous one are one step."""
        joins = same_step and bool(self._done) and not self._undone
        if not joins:
            self._done.append(self._now)
        self._undone.clear()
        self._note(Edit(self.scene, scene, joins))
        self._now = Opened(scene, self.place)

    def open(self, opened: Opened, source: Source) -> None:
        """Make a scene the current one that was opened from another place, that of the source."""
        self._saved[opened.place] = Saved(opened.scene, {})
        self._come_to(opened, Open(opened.scene, source))

    def show(self, name: str) -> None:
        """Come back to a variant, and to its place. Raises UsageError if there is none of that name."""
        self._come_to(self.variants[name], Show(name))

    def keep(self, name: str) -> None:
        """Keep the current scene as a variant. Raises UsageError for a name that it cannot have."""
        self.variants = self.variants.with_kept(name, self._now)
        self.steps.append(Keep(name))

    def drop(self, name: str) -> None:
        """Drop a variant. Raises UsageError if there is none of that name."""
        self.variants = self.variants.without(name)
        self.steps.append(Drop(name))

    def mark_saved(self, files: Mapping[str, str] | None = None) -> None:
        """Mark the current scene as saved; `files` are those to save to again, those from before if None."""
        saved = Saved(self.scene, dict(self.saved.files if files is None else files))
        self._saved[self.place] = saved
        self.steps.append(saved)

    def undo(self) -> None:
        """Return to the scene before the last step. Raises IndexError if there is none."""
        before = self._done.pop()
        self._undone.append(self._now)
        self._now = before
        self.steps.append("undo")

    def redo(self) -> None:
        """Return to the scene after the next undone step. Raises IndexError if there is none."""
        after = self._undone.pop()
        self._done.append(self._now)
        self._now = after
        self.steps.append("redo")

    def _come_to(self, opened: Opened, step: Step) -> None:
        self._done.append(self._now)
        self._undone.clear()
        self._now = opened
        self.steps.append(step)

    def _note(self, edit: Edit) -> None:
        """Note an edit among the steps; the many edits of a drag are one."""
        last = self.steps[-1] if self.steps else None
        if edit.joins and isinstance(last, Edit):
            whole = Edit(last.before, edit.after, last.joins)
            if not whole.before.equals(whole.after):
                self.steps[-1] = whole
                return
            if last.joins:
                self.steps.pop()
                return
            # A drag that came back to where it began is still a step to undo: its two ways are noted.
        self.steps.append(edit)
