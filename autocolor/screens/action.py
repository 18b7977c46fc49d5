"""The last action of a session: the key or movement that made its edit, and when."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from autocolor.errors import AutocolorError
from autocolor.scene.columns import Tier
from autocolor.scene.scene import cost_of_edit
from autocolor.screens.file_actions import unsaved_changes
from autocolor.screens.session import Session
from ramtek_emu import PortError, RamtekError, ReplyError

REST_SECONDS: Final = 0.1
"""Assumed: the time after which a movement without a release rests: by a key held down, or by the wheel."""

WHEEL: Final = "wheel"
DRAG: Final = "drag"
"""The kinds of sources of edits by the pointer. The wheel has steps, but no beginning and no end."""

EditSource = tuple[object, object]
"""A key or a movement of the pointer that made an edit: its kind, and which of them it was."""

NO_SOURCE: Final[EditSource] = None, None
"""The source of actions that begin nothing that could be continued."""


class Action:
    """The last action of a session: the key or movement that made its edit, and when.

    An error of an action becomes a message, and one movement one step to undo.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self.source = NO_SOURCE
        """The key or the movement of the pointer that made the last edit, if any."""
        self._edited_at = 0.0
        self.costs = Tier.NOTHING
        """The cost of the edit; NOTHING if the action was no edit."""
        self.is_warned = False
        """Whether the action announced unsaved changes."""

    @property
    def has_rested(self) -> bool:
        """Whether the last edit was made a while ago."""
        return time.monotonic() - self._edited_at > REST_SECONDS

    def warns_of_changes(self, otherwise: str) -> bool:
        """Whether unsaved changes forbid an attempt. They are announced once; the next attempt succeeds."""
        unsaved = unsaved_changes(self._session)
        if not unsaved or self.is_warned:
            return False
        self.is_warned = True
        self._session.warn(f"{unsaved}, {otherwise}")
        return True

    def do(self, source: EditSource, run: Callable[[], object], continues: bool, moving: bool) -> bool:
        """Run the action of a key or a gesture; returns False if `run` does, which then did nothing.

        With `continues`, edits of the same source are one step to undo.
        """
        session, warned = self._session, self.is_warned
        news, before = session.news, session.scene
        session.tell("")
        session.same_step = continues and self.source == source
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
            self.source, self._edited_at, self.costs = source, time.monotonic(), costs
        elif not continues:
            self.source = NO_SOURCE
        return True
