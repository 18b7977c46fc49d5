"""The row that chooses a surface, in the menus of all screens that are about one."""

from __future__ import annotations

from collections.abc import Callable

from autocolor.screens.session import Session
from autocolor.widgets.widget import Choice


def surface_row(session: Session, told: str, choose: Callable[[str], object] | None = None) -> Choice:
    """A row with the surfaces in use; `choose` is the session's own unless another is given."""
    return Choice(
        "surface",
        told,
        names=tuple(session.studio.level_ranges),
        present=session.surface_name,
        choose=session.choose_surface if choose is None else choose,
    )
