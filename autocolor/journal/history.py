"""The history of a session: its steps in order, its timeline, the variants, and the files of its scenes.

Every step gives the same scene when it is taken again after the steps before it, so the journal of a session
is the list of its steps.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count, pairwise
from string import ascii_uppercase
from typing import Final, NamedTuple

from autocolor.checks import nearest, shown
from autocolor.errors import UsageError
from autocolor.files.paths import PICTURE_SUFFIX
from autocolor.journal.places import NO_STAMP, FilesOnDisk, OnDisk, Opened, ScenePlace, Source
from autocolor.journal.timeline import Timeline, Way, have_one_look
from autocolor.mapping.intensity import is_held
from autocolor.scene.scene import AUTO, Exposure, Scene

MOST_VARIANTS: Final = 1000
LONGEST_NAME: Final = 100


class Edit(NamedTuple):
    """A step that changed the scene; if it `joins`, it belongs to the gesture of the edit before it."""

    before: Scene
    after: Scene
    joins: bool = False

    @property
    def changes_look(self) -> bool:
        """Whether more than the view differs, so that the edit can be undone."""
        return not have_one_look(self.before, self.after)

    @property
    def changes_view(self) -> bool:
        """Whether the view differs."""
        return self.before.view != self.after.view


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


class Rename(NamedTuple):
    """A variant got another name; undo skips this step."""

    name: str
    to: str


class Saved(NamedTuple):
    """A scene was saved; undo skips this step. `files` are saved to again, and have their stamps.

    If `is_own` is false, the files get a backup before `save_session` overwrites them for the first time.
    """

    scene: Scene
    files: Mapping[str, str]
    is_own: bool = True


class Move(NamedTuple):
    """Some steps were undone or redone at once, or a view was returned to."""

    way: Way
    steps: int = 1


Step = Edit | Open | Show | Keep | Drop | Rename | Saved | Move


class History:
    """The scenes of a session and the steps between them; `start` is the scene with which it began.

    `steps` has every step, also those that were undone. `first_place` is the place of the first scene.
    """

    def __init__(self, start: Scene, place: ScenePlace | None = None) -> None:
        self.start = start
        self.first_place = ScenePlace() if place is None else place
        self.steps: list[Step] = []
        self.variants = Variants()
        self.timeline = Timeline(Opened(start, self.first_place))
        self.before_gesture: Timeline | None = None
        """The timeline before the last edit, or before the gesture of this edit; None after another step."""
        self._branches: set[str] = set()
        """The names of the variants that are ends of undone steps, after which another step was taken."""
        self._saved: dict[ScenePlace, Saved] = {}
        self._files: dict[ScenePlace, tuple[str, ...]] = {}
        self.on_disk = FilesOnDisk()
        """The files that the session read or wrote."""
        self._note_opened(self.timeline.present)

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self.timeline.present.scene

    @property
    def place(self) -> ScenePlace:
        """The place that the current scene belongs to."""
        return self.timeline.present.place

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
        return not self._is_on_disk(self.timeline.present)

    @property
    def left_unsaved(self) -> tuple[str, ...]:
        """The names of scenes with unsaved changes that the session left for other scenes."""
        steps = [*self.timeline.to_undo, self.timeline.present]
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
        """The names of variants whose look no file of the session holds, and that were not opened so.

        Undone steps that became a variant because another step was taken do not count.
        """
        places = [place for place in self._saved if self._main_file(place) is None]
        scenes = [*self.on_disk.scenes, *(self._saved[place].scene for place in places)]
        return tuple(
            name
            for name, variant in self.variants.items()
            if name not in self._branches and not any(have_one_look(scene, variant.scene) for scene in scenes)
        )

    @property
    def to_undo(self) -> tuple[Scene, ...]:
        """The scenes before each step to undo, each in the view of its time; the last step is the last."""
        return tuple(each.scene for each in self.timeline.to_undo)

    @property
    def earlier(self) -> tuple[Scene, ...]:
        """The scenes of `to_undo` that belong to the place of the current scene."""
        return tuple(each.scene for each in self.timeline.to_undo if each.place is self.place)

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
        """The scenes after each step to redo, each in the view of its time; the next step is the last."""
        return tuple(each.scene for each in self.timeline.to_redo)

    def take(self, scene: Scene, same_step: bool = False) -> None:
        """Make a scene the current one; with `same_step`, the edit belongs to the gesture of the last edit.

        All edits of a gesture are one step to undo, and one view to go back from. A gesture that came back to
        its beginning is none.
        """
        before = self.before_gesture if same_step else None
        self._note(Edit(self.scene, scene, joins=before is not None))
        self.before_gesture = before or self.timeline
        self._go(self.before_gesture.edited(scene))

    def open(self, opened: Opened, source: Source) -> None:
        """Make a scene the current one that was opened from a source."""
        self._note_opened(opened)
        self.go(self.timeline.moved_to(opened), Open(opened.scene, source))

    def shown(self, name: str) -> Timeline:
        """The timeline with a variant, in the present view if it has the present place, as the current scene.

        Raises UsageError for an unknown name.
        """
        return self.timeline.moved_to(self.variants[name])

    def move(self, way: Way, steps: int = 1) -> None:
        """Move some steps on a way. Raises IndexError if there are not so many."""
        self.go(self.timeline.moved(way, steps), Move(way, steps))

    def go(self, after: Timeline, step: Open | Show | Move) -> None:
        """Go to the timeline that a step leads to, such as `shown("A")` by Show("A")."""
        self.before_gesture = None
        self._go(after)
        self.steps.append(step)

    def keep(self, name: str) -> None:
        """Make the current scene a variant. Raises UsageError for a name that is in use or not valid."""
        self.variants = self.variants.with_variant(name, self.timeline.present)
        self._branches.discard(name)
        self.steps.append(Keep(name))

    def drop(self, name: str) -> None:
        """Drop a variant. Raises UsageError for an unknown name."""
        self.variants = self.variants.without(name)
        self.steps.append(Drop(name))

    def rename(self, name: str, to: str) -> None:
        """Give a variant another name. Raises UsageError for an unknown name, and as `keep`."""
        self.variants = self.variants.renamed(name, to)
        if name in self._branches:
            self._branches = self._branches - {name} | {to}
        self.steps.append(Rename(name, to))

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

    def forget_files(self) -> None:
        """Save the current scene to new files from now on, not to the file that it was opened from."""
        self._files[self.place] = ()

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

    def _go(self, after: Timeline) -> None:
        """Go to a timeline. If it forgets steps that were undone at once, their end becomes a variant."""
        before, self.timeline = self.timeline, after
        if before.has_jumped and not after.has_jumped:
            end = next(iter(before.to_redo), None)
            if end is not None and not self._has_variant(end) and len(self.variants) < MOST_VARIANTS:
                name = self.variants.free_name()
                self.variants = self.variants.with_variant(name, end)
                self._branches.add(name)

    def _has_variant(self, opened: Opened) -> bool:
        """Whether a variant has the look and the place of a state."""
        return any(
            each.place is opened.place and have_one_look(each.scene, opened.scene)
            for each in self.variants.values()
        )

    def _note(self, edit: Edit) -> None:
        """Note an edit among the steps; an edit that joins an edit extends it, so that a drag is one edit."""
        last = self.steps[-1] if self.steps else None
        if edit.joins and isinstance(last, Edit):
            drag = Edit(last.before, edit.after, last.joins)
            # Where an edit changes back what the last one changed, both are noted.
            kinds = [(each.changes_look, each.changes_view) for each in (last, edit, drag)]
            if kinds[0] == kinds[1] == kinds[2]:
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

    def renamed(self, name: str, to: str) -> Variants:
        """These variants in their order, of which one has another name. Raises UsageError as the others."""
        variant = self[name]
        self.without(name).with_variant(to, variant)
        return Variants({to if each == name else each: self[each] for each in self})

    def without(self, name: str) -> Variants:
        """The other variants. Raises UsageError for an unknown name."""
        self[name]
        return Variants({each: variant for each, variant in self._variants.items() if each != name})

    def free_name(self) -> str:
        """The first of A, B, C ... Z, A2, B2 ... that is not in use."""
        rounds = (str(number) if number > 1 else "" for number in count(1))
        names = (f"{letter}{suffix}" for suffix in rounds for letter in ascii_uppercase)
        return next(name for name in names if name not in self._variants)
