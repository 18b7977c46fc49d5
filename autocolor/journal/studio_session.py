"""The session of a studio: what it opened, kept and saved, and the journal of its steps."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from os import fspath
from pathlib import Path
from typing import TYPE_CHECKING

from autocolor.errors import UsageError
from autocolor.journal.history import History
from autocolor.lighting.picture import Picture
from autocolor.scene.changes import SceneChanges
from autocolor.scene.scene import Scene

if TYPE_CHECKING:
    from os import PathLike

    from autocolor.journal.history import Variants
    from autocolor.journal.saving import SavedFiles
    from autocolor.scene.creation import SurfaceSource


class StudioSession(ABC):
    """The part of a studio that knows files and names; the studio itself shows scenes.

    Whatever changes a session is a step of its history, and a line of its journal.
    """

    _history: History

    @property
    def history(self) -> History:
        """The steps of the session, of which `journal` makes a script."""
        return self._history

    @property
    @abstractmethod
    def picture(self) -> Picture:
        """The current picture."""

    @abstractmethod
    def refine(self) -> None:
        """Compute a coarse picture again at all lines and elements."""

    @abstractmethod
    def _show_scene(self, scene: Scene) -> None:
        """Show a scene that is not yet in the history."""

    @property
    def is_changed(self) -> bool:
        """Whether the scene differs from the one that was opened or saved last.

        `history.left_unsaved` names scenes with such changes from which the session went on to others.
        """
        return self._history.is_changed

    @property
    def variants(self) -> Variants:
        """The scenes that were kept, by name."""
        return self._history.variants

    def open(
        self,
        path: str | PathLike[str],
        *,
        up: str = "z",
        scale: float = 1.0,
        surfaces: SurfaceSource = "materials",
        tables: SceneChanges | None = None,
        checksum: str | None = None,
    ) -> None:
        """Read a scene (see `read_scene`) and make it the current one; undone, the one before is back.

        That is also so for the files to which `save_session` saves. A journal gives the `tables` that the
        scene had, as they may have been saved over since, and the `checksum` of the scene: InputError is
        raised if it is another one.
        """
        from autocolor.journal.opening import opened
        from autocolor.journal.places import Source

        source = Source(fspath(path), up, surfaces, scale)
        scene = opened(source, tables, checksum)
        self._show_scene(scene.scene)
        self._history.open(scene, source)

    @property
    def file(self) -> Path | None:
        """The scene file or the store that the scene is saved to; None if there is none yet."""
        from autocolor.journal.places import PICTURE_SUFFIX, file_of

        saved = [Path(path) for path in self._history.saved.files]
        place = self._history.place
        if not saved and place.source is not None and place.stamp is not None:
            saved = [path for path in (file_of(place.source),) if path is not None]
        return next((path for path in saved if path.suffix.lower() != PICTURE_SUFFIX), None)

    def reopen(self) -> bool:
        """Read the scene's file again, by one step to undo; False if it holds the present scene.

        Raises UsageError if there is no such file, InputError if it cannot be read.
        """
        from autocolor.journal.opening import opened_again
        from autocolor.journal.places import Source

        path, source = self.file, self._history.place.source
        if path is None:
            raise UsageError("the scene must be in a file to be read again, and it is in none; save it")
        source = Source(str(path), surfaces="materials" if source is None else source.surfaces)
        found = opened_again(source, self._history.scene)
        if found.scene.equals(self._history.scene):
            return False
        self._show_scene(found.scene)
        self._history.open(found, source)
        return True

    def keep_variant(self, name: str | None = None) -> str:
        """Keep the current scene under a name, a free letter if None; returns the name.

        Undo and redo leave the variants alone. Raises UsageError if the name is in use.
        """
        name = self.variants.free_name() if name is None else name
        self._history.keep(name)
        return name

    def show_variant(self, name: str) -> None:
        """Come back to a variant by one step to undo; nothing happens if it equals the current scene."""
        scene = self.variants[name].scene
        if not scene.equals(self._history.scene):
            self._show_scene(scene)
            self._history.show(name)

    def drop_variant(self, name: str) -> None:
        """Keep a variant no longer. Raises UsageError if there is none of that name."""
        self._history.drop(name)

    def mark_saved(self, files: Mapping[str, str] | None = None) -> None:
        """Mark the current scene as saved.

        `files` are those to which `save_session` saves again, with the SHA-256 of their bytes.
        """
        self._history.mark_saved(files)

    def save(self, path: str | PathLike[str], overwrite: bool = False) -> None:
        """Write the picture with its scene to a picture file, and mark the scene as saved."""
        from autocolor.files.picture_file import write_picture

        self.refine()
        write_picture(path, self.picture, self._history.scene, overwrite=overwrite)
        self.mark_saved()

    def save_scene(self, path: str | PathLike[str], overwrite: bool = False) -> None:
        """Write the scene to a scene file (see `write_scene`), and mark it as saved."""
        from autocolor.files.scene_writing import write_scene

        write_scene(path, self._history.scene, overwrite=overwrite)
        self.mark_saved()

    def save_session(self, folder: str | PathLike[str] = ".") -> SavedFiles:
        """Save scene and picture under names that are found and returned (see `journal.saving`).

        Files that are new are made in the folder. Nothing that was there is lost.
        """
        from autocolor.journal.saving import save_session

        self.refine()
        return save_session(self._history, self.picture, Path(folder))

    def journal(
        self,
        path: str | PathLike[str] | None = None,
        *,
        up: str = "z",
        scale: float = 1.0,
        surfaces: SurfaceSource = "materials",
        beside: str | PathLike[str] | None = None,
    ) -> str:
        """The session as a Python script, one line a step, which `read_journal` reads without running it.

        `path` is what the scene of the first step was read from, and `up`, `scale` and `surfaces` are how; a
        session that was recovered knows it. A mesh that was changed by an edit is saved to a folder of its
        own in the folder `beside`; without that, InputError is raised for one.
        """
        from autocolor.journal.places import Source
        from autocolor.journal.script import MeshesBeside, journal_text

        source = (
            self._history.first_place.source if path is None else Source(fspath(path), up, surfaces, scale)
        )
        if source is None:
            raise UsageError("a journal must name what its first scene was read from; give its path")
        return journal_text(self._history, source, MeshesBeside(None if beside is None else Path(beside)))
