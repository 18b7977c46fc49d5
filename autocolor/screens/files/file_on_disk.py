"""The file that the scene is in: what another program changes there is shown as one step to undo.

With edits that are not saved, the user is asked first. A file that is wrong for a while, as half edited ones
are, is told, and the scene stays as it was.
"""

from __future__ import annotations

import time
from typing import Final

from autocolor.errors import InputError
from autocolor.files.store.file_changes import FileChanges
from autocolor.files.store.store_file import STORE_SUFFIXES
from autocolor.studio import Studio

SECONDS_BETWEEN: Final = 0.5
"""Assumed: often enough to see an edit at once, and seldom enough to cost nothing."""


class FileOnDisk:
    """Looks at the file of a studio's scene."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._changes: FileChanges | None = None
        self._looked_at = time.monotonic()
        self._bind()

    def was_changed(self) -> bool:
        """Whether another program changed the file since it was `seen`; it is looked at twice a second."""
        now = time.monotonic()
        if now - self._looked_at < SECONDS_BETWEEN:
            return False
        self._looked_at = now
        self._bind()
        return self._changes is not None and self._changes.have_come()

    def seen(self) -> None:
        """Take the file as it is now for seen, as after it was saved or opened."""
        self._bind()
        if self._changes is not None:
            self._changes.seen()

    def take(self) -> str:
        """Show what the file holds now, or ask whether to; returns what to tell, empty for nothing.

        Raises InputError if it cannot be shown; the scene stays as it was.
        """
        assert self._changes is not None
        name = self._changes.path.name
        # What is written from now on is another change.
        self._changes.seen()
        if self._studio.is_changed:
            return f"{name} was changed elsewhere: Ctrl+R shows that, Ctrl+S saves yours beside"
        try:
            is_other = self._studio.reopen()
        except InputError as error:
            raise InputError(f"not shown: {problem}" for problem in error.problems) from None
        return f"{name} was changed elsewhere; undo goes back" if is_other else ""

    def _bind(self) -> None:
        """Look at the file that the scene is in now."""
        path = self._studio.file
        if path is None:
            self._changes = None
        elif self._changes is None or self._changes.path != path:
            self._changes = FileChanges(path, path.suffix.lower() in STORE_SUFFIXES)
