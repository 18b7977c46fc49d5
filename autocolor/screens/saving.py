"""Saving the picture with its scene: to a new file the first time, then to the same file."""

from __future__ import annotations

from pathlib import Path

from autocolor.files.file_stem import file_stem, free_path
from autocolor.screens.doing import Doing
from autocolor.screens.session import Session


class Saving:
    """Where a session was saved."""

    def __init__(self, session: Session, doing: Doing) -> None:
        self._session = session
        self._doing = doing
        self.path: Path | None = None
        """The file; None until there is one."""

    def save(self, folder: Path) -> None:
        """Save, to a new file in a folder if there is none yet. Raises WriteError if that fails."""
        studio = self._session.studio
        if self.path is None:
            path = free_path(folder / f"{file_stem(studio.scene.name)}.npz")
            studio.save(path)
            self.path = path
        else:
            studio.save(self.path, overwrite=True)
        self._session.tell(f"saved {self.path.resolve()}")

    def stops(self, otherwise: str) -> bool:
        """Whether to stop because of unsaved changes. They are announced once; the next attempt succeeds."""
        if not self._session.studio.is_changed or self._doing.is_warned:
            return False
        self._doing.is_warned = True
        self._session.warn(f"not saved: Ctrl+S saves, {otherwise}")
        return True
