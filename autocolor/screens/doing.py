"""Doing what keys and gestures ask for: an error becomes a message, and one movement one step to undo."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from autocolor.errors import AutocolorError
from autocolor.scene.columns.column import Tier
from autocolor.scene.scene import cost_of_edit
from autocolor.screens.session import Session
from ramtek_emu import PortError, RamtekError, ReplyError

REST_SECONDS: Final = 0.1
"""Assumed: the time without a change after which a movement rests that has not ended by a release: while a
key is held down, and after a step of the wheel."""


class Doing:
    """What makes the edits of a session, and when the last one was made."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._source: object = None
        """The key or the movement of the pointer by which the last edit was made, if any."""
        self._edited_at = 0.0
        self.costs = Tier.NOTHING
        """What the edit cost that was done last, if it was one."""
        self.is_warned = False
        """Whether unsaved changes were announced by what was done last."""

    def was_by(self, source: object) -> bool:
        """Whether the last edit was made by a key or a movement."""
        return self._source == source

    @property
    def kind(self) -> object:
        """The first part of what the last edit was made by; None if there is nothing."""
        return self._source[0] if isinstance(self._source, tuple) else None

    @property
    def has_rested(self) -> bool:
        """Whether the last edit was made a while ago."""
        return time.monotonic() - self._edited_at > REST_SECONDS

    def warns_of_changes(self, otherwise: str) -> bool:
        """Whether to stop because of unsaved changes. They are announced once; the next attempt succeeds."""
        unsaved = self._session.unsaved("Ctrl+S saves")
        if not unsaved or self.is_warned:
            return False
        self.is_warned = True
        self._session.warn(f"{unsaved}, {otherwise}")
        return True

    def do(self, source: object, run: Callable[[], object], continues: bool, moving: bool) -> bool:
        """Do what a key or a gesture asks for.

        If it continues what made the last edit, both are one step to undo. Returns False if `run` does, as
        there is nothing to do.
        """
        session, warned = self._session, self.is_warned
        news, before = session.news, session.scene
        session.tell("")
        session.same_step = continues and self._source == source
        session.moving = moving
        self.costs = Tier.NOTHING
        try:
            if run() is False:
                session.news = news
                return False
        except (PortError, ReplyError):
            # Without the display and its replies, there is nothing to show a message on.
            raise
        except (AutocolorError, RamtekError) as error:
            session.warn(error)
        # A warning applies to the next key only.
        self.is_warned = self.is_warned and not warned
        costs = None
        if session.scene is not before:
            session.comparing.end()
            costs = cost_of_edit(before, session.scene)
        if costs is not None:
            self._source, self._edited_at, self.costs = source, time.monotonic(), costs
        elif not continues:
            self._source = None
        return True
