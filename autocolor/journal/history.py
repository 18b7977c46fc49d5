"""The history of a session: its steps in order, the scenes to undo and to redo, and the variants.

Every step gives the same scene when it is taken again after the steps before it, so the journal of a session
is the list of its steps.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count, pairwise
from string import ascii_uppercase
from typing import Final, Literal, NamedTuple

from autocolor.checks import nearest, shown
from autocolor.errors import UsageError
from autocolor.files.paths import PICTURE_SUFFIX
from autocolor.journal.places import NO_STAMP, FilesOnDisk, OnDisk, Opened, ScenePlace, Source
from autocolor.mapping.intensity import is_held
from autocolor.scene.scene import AUTO, Exposure, Scene

MOST_VARIANTS: Final = 1000
LONGEST_NAME: Final = 100


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
    """A step that made a variant the current scene."""

    name: str


class Keep(NamedTuple):
    """The current scene became a variant; undo skips this step."""

    name: str


class Drop(NamedTuple):
    """A variant was dropped; undo skips this step."""

    name: str


class Saved(NamedTuple):
    """A scene was saved; undo skips this step. `files` are saved to again, and have their stamps.

    If `is_own` is false, the files get a backup before `save_session` overwrites them for the first time.
    """

    scene: Scene
    files: Mapping[str, str]
    is_own: bool = True


Step = Edit | Open | Show | Keep | Drop | Saved | Literal["undo", "redo"]


class History:
    """The scenes of a session and the steps between them; `start` is the scene with which it began.

    `steps` has every step, also those that were undone. `first_place` is the place of the first scene.
    """

    def __init__(self, start: Scene, place: ScenePlace | None = None) -> None:
        self.start = start
        self.first_place = ScenePlace() if place is None else place
        self.steps: list[Step] = []
        self.variants = Variants()
        self._present = Opened(start, self.first_place)
        self._undo_stack: list[Opened] = []
        self._redo_stack: list[Opened] = []
        self._saved: dict[ScenePlace, Saved] = {}
        self._files: dict[ScenePlace, tuple[str, ...]] = {}
        self.on_disk = FilesOnDisk()
        """The files that the session read or wrote."""
        self._note_opened(self._present)

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self._present.scene

    @property
    def place(self) -> ScenePlace:
        """The place that the current scene belongs to."""
        return self._present.place

    @property
    def saved(self) -> Saved:
        """The scene of the current place that was opened or saved last, and the files it was saved to."""
        return self._saved[self.place]

    @property
    def files(self) -> tuple[str, ...]:
        """The files to save the current scene to again: at most one scene file or store, and one picture."""
        return self._files[self.place]

    @property
    def is_changed(self) -> bool:
        """Whether the current scene differs from the scene in the file that it is saved to again.

        This is its scene file or store, else its picture file. A scene without a file is compared with the
        scene that was opened or marked as saved last.
        """
        return not self._is_on_disk(self._present)

    @property
    def left_unsaved(self) -> tuple[str, ...]:
        """The names of scenes with unsaved changes that the session left for other scenes."""
        steps = [*self._undo_stack, self._present]
        left = {before.place: before for before, after in pairwise(steps) if before.place is not after.place}
        # Where a file was opened again, only changes of the scene before were left unsaved.
        last_of_files = {self._main_file(each.place) or each.place: each.place for each in steps}.values()
        return tuple(
            each.scene.name
            for place, each in left.items()
            if place is not self.place
            and not self._is_on_disk(each)
            and (place in last_of_files or not self._saved[place].scene.equals(each.scene))
        )

    @property
    def unsaved_variants(self) -> tuple[str, ...]:
        """The names of variants that no file of the session holds, and that were not opened as they are."""
        places = [place for place in self._saved if self._main_file(place) is None]
        scenes = [*self.on_disk.scenes, *(self._saved[place].scene for place in places)]
        return tuple(
            name
            for name, variant in self.variants.items()
            if not any(scene.equals(variant.scene) for scene in scenes)
        )

    @property
    def to_undo(self) -> tuple[Scene, ...]:
        """The scenes before each step that can be undone, the last step last."""
        return tuple(each.scene for each in self._undo_stack)

    @property
    def earlier(self) -> tuple[Scene, ...]:
        """The scenes of `to_undo` that belong to the place of the current scene."""
        return tuple(each.scene for each in self._undo_stack if each.place is self.place)

    @property
    def following_exposure(self) -> str:
        """The exposure by which all ranges last followed the picture: "auto" or a percentage."""
        exposures = (scene.exposure for scene in reversed(self.earlier))
        return next((exposure for exposure in exposures if isinstance(exposure, str)), AUTO)

    @property
    def released_exposure(self) -> Exposure:
        """The exposure before all ranges were held; if there is none, ranges follow the picture.

        If only ranges of some surfaces are held, all ranges follow the picture again.
        """
        exposure, names = self.scene.exposure, {surface.name for surface in self.scene.surfaces}
        if not is_held(exposure):
            return exposure if isinstance(exposure, str) else self.following_exposure
        befores = [
            before
            for before in (AUTO, *(scene.exposure for scene in self.earlier))
            if not is_held(before) and (isinstance(before, str) or dict(before).keys() <= names)
        ]
        return befores[-1]

    @property
    def to_redo(self) -> tuple[Scene, ...]:
        """The scenes after each step that can be redone, the next step last."""
        return tuple(each.scene for each in self._redo_stack)

    def take(self, scene: Scene, same_step: bool = False) -> None:
        """Make a scene the current one; with `same_step`, this edit and the previous one are one step."""
        joins = same_step and bool(self._undo_stack) and not self._redo_stack
        self._note(Edit(self.scene, scene, joins))
        present = Opened(scene, self.place)
        if joins:
            self._present = present
        else:
            self._go_to(present)

    def open(self, opened: Opened, source: Source) -> None:
        """Make a scene the current one that was opened from a source."""
        self._note_opened(opened)
        self._go_to(opened)
        self.steps.append(Open(opened.scene, source))

    def show(self, name: str) -> None:
        """Make a variant the current scene, with its place. Raises UsageError for an unknown name."""
        self._go_to(self.variants[name])
        self.steps.append(Show(name))

    def keep(self, name: str) -> None:
        """Make the current scene a variant. Raises UsageError for a name that is in use or not valid."""
        self.variants = self.variants.with_variant(name, self._present)
        self.steps.append(Keep(name))

    def drop(self, name: str) -> None:
        """Drop a variant. Raises UsageError for an unknown name."""
        self.variants = self.variants.without(name)
        self.steps.append(Drop(name))

    def mark_saved(self, files: Mapping[str, str], is_own: bool = True) -> None:
        """Mark the current scene as saved to files, which have these stamps; it is saved to them again.

        Without files, the scene alone is marked. `is_own` is whether `save_session` wrote the files.
        """
        saved = Saved(self.scene, dict(files), is_own)
        for path, stamp in files.items():
            self.on_disk.note(path, OnDisk(self.scene, stamp, is_own))
        # A new scene file takes the place of the one before, and a new picture that of the picture before.
        slots = {is_picture(path): path for path in (*self.files, *files)}
        self._files[self.place] = tuple(slots[kind] for kind in sorted(slots))
        self._saved[self.place] = saved
        self.steps.append(saved)

    def undo(self) -> None:
        """Return to the scene before the last step. Raises IndexError if there is none."""
        before = self._undo_stack.pop()
        self._redo_stack.append(self._present)
        self._present = before
        self.steps.append("undo")

    def redo(self) -> None:
        """Return to the scene after the next undone step. Raises IndexError if there is none."""
        after = self._redo_stack.pop()
        self._undo_stack.append(self._present)
        self._present = after
        self.steps.append("redo")

    def _note_opened(self, opened: Opened) -> None:
        """Note the scene of a place that was opened, and its file."""
        place = opened.place
        self._saved[place] = Saved(opened.scene, {})
        self._files[place] = () if place.file is None else (place.file,)
        if place.file is not None and place.stamp is not None:
            before = self.on_disk[place.file]
            is_own = before is not None and before.is_own and before.stamp == place.stamp
            is_outdated = place.stamp == NO_STAMP
            self.on_disk.note(place.file, OnDisk(opened.scene, place.stamp, is_own, is_outdated))

    def _main_file(self, place: ScenePlace) -> str | None:
        """The scene file or store of a place, else its picture file; None without files."""
        return next(iter(self._files[place]), None)

    def _is_on_disk(self, opened: Opened) -> bool:
        """Whether the file of its place holds a scene; without a file, whether it was marked as saved."""
        path = self._main_file(opened.place)
        file = None if path is None else self.on_disk[path]
        if file is None:
            return self._saved[opened.place].scene.equals(opened.scene)
        return not file.is_outdated and file.scene.equals(opened.scene)

    def _go_to(self, opened: Opened) -> None:
        """Make a scene the current one by a step to undo."""
        self._undo_stack.append(self._present)
        self._redo_stack.clear()
        self._present = opened

    def _note(self, edit: Edit) -> None:
        """Note an edit among the steps; an edit that joins an edit extends it, so that a drag is one edit."""
        last = self.steps[-1] if self.steps else None
        if edit.joins and isinstance(last, Edit):
            drag = Edit(last.before, edit.after, last.joins)
            # A drag that returns to its beginning is still a step to undo, so its way back is another edit.
            if last.joins or not drag.before.equals(drag.after):
                self.steps[-1] = drag
                return
        self.steps.append(edit)


def is_picture(path: str) -> bool:
    """Whether a file is a picture file."""
    return path.lower().endswith(PICTURE_SUFFIX)


class Variants(Mapping[str, Opened]):
    """The variants of a session by name, in the order in which they were made; an immutable value."""

    def __init__(self, variants: Mapping[str, Opened] | None = None) -> None:
        self._variants = dict(variants or {})

    def __getitem__(self, name: str) -> Opened:
        """The variant of a name. Raises UsageError, with the closest name, if there is none."""
        if name not in self._variants:
            raise UsageError(f"there is no variant {shown(name)}{nearest(str(name), self._variants)}")
        return self._variants[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._variants)

    def __len__(self) -> int:
        return len(self._variants)

    def __contains__(self, name: object) -> bool:
        return name in self._variants

    def with_variant(self, name: str, opened: Opened) -> Variants:
        """These variants and a new one. Raises UsageError for a name that is in use, empty or too long."""
        if not isinstance(name, str) or not 0 < len(name) <= LONGEST_NAME:
            raise UsageError(
                f"a variant must have a name of 1 to {LONGEST_NAME} characters, not {shown(name)};"
                " choose another"
            )
        if name in self._variants:
            raise UsageError(
                f"a variant must have a name of its own, and {shown(name)} is in use; choose another, or drop"
                " that one"
            )
        if len(self._variants) >= MOST_VARIANTS:
            raise UsageError(f"there must be at most {MOST_VARIANTS} variants; drop one")
        return Variants({**self._variants, name: opened})

    def without(self, name: str) -> Variants:
        """The other variants. Raises UsageError for an unknown name."""
        self[name]
        return Variants({each: variant for each, variant in self._variants.items() if each != name})

    def free_name(self) -> str:
        """The first of A, B, C ... Z, A2, B2 ... that is not in use."""
        rounds = (str(number) if number > 1 else "" for number in count(1))
        names = (f"{letter}{suffix}" for suffix in rounds for letter in ascii_uppercase)
        return next(name for name in names if name not in self._variants)
