"""The file screen: scenes, meshes, pictures and rigs to open, recent files, and saving.

A pointer opens what is in the session's folder and below, and on the machine of the window also what was
opened before. Opening is one step to undo, so nothing is lost by it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from autocolor.errors import InputError, reason_of
from autocolor.files.paths import SCENE_FILE
from autocolor.files.recent import recent_files
from autocolor.files.scene_sources import opened_suffixes
from autocolor.screens.screen import Screen
from autocolor.screens.session import Session
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, LIGHT_GRAY, SLATE, YELLOW
from autocolor.widgets.items import Item, filled, fitted, text
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import ROW_LINES, Button, Gap, Widget

LEFT: Final = Area(8, 40, 247, 455)
RIGHT: Final = Area(256, 40, 495, 455)
"""The columns of the folder's files and of recent ones."""

MOST_ROWS: Final = LEFT.height // ROW_LINES
CHARACTERS: Final = 32
MOST_ENTRIES: Final = 1000
"""Assumed: files of a folder that are looked at."""


class FileScreen(Screen):
    """Files to open, and what to save."""

    name = "file"
    title = "file"
    help = "Click a file to open it; undo goes back to the scene before"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._root = session.folder.resolve()
        self._folder = self._root
        self._entries: list[Path] = []
        self._recent: list[Path] = []
        self._page = 0

    def enter(self) -> None:
        self._list()

    def _list(self) -> None:
        self._entries, self._page = entries_of(self._folder), 0
        self._recent = [path for path in recent_files() if self._may_open(path)]

    def _may_open(self, path: Path) -> bool:
        """Whether the pointer of this session may open a file."""
        return self.session.is_at_hand or path.resolve().is_relative_to(self._root)

    def items(self) -> Sequence[Item]:
        folder = str(self._folder) if self.session.is_at_hand else self._folder.name or "/"
        shown = folder if len(folder) <= 66 else f"..{folder[-64:]}"
        found = [
            text("OPEN", LEFT.left + 8, 6, YELLOW),
            text("RECENT", RIGHT.left + 8, 6, YELLOW),
            text(shown, LEFT.left + 8, 22, LIGHT_GRAY),
            filled(Area(251, 40, 251, 455), SLATE),
        ]
        if not self._entries:
            found.append(text("no scene, mesh or picture here", LEFT.left + 8, LEFT.top + 3, GRAY))
        return found

    def widgets(self) -> Sequence[Widget]:
        rows: list[Widget] = []
        if self._folder != self._root or self.session.is_at_hand:
            rows.append(
                Button("..", "The folder above.", run=partial(self._go_to, self._folder.parent), value="up")
            )
        most = MOST_ROWS - len(rows) - 1
        pages = max(1, -(-len(self._entries) // most))
        self._page %= pages
        for path in self._entries[self._page * most : (self._page + 1) * most]:
            rows.append(self._row(path))
        if pages > 1:
            shown = f"{self._page + 1} of {pages}"
            rows.append(Button("more files", "The other files of this folder.", run=self._turn, value=shown))
        recent = [self._row(path, "recent ") for path in self._recent]
        return [*_placed(rows, LEFT), *_placed(recent, RIGHT)]

    def _row(self, path: Path, key: str = "") -> Widget:
        kind = kind_of(path)
        if kind == "folder":
            return FileRow(f"{key}{path}", f"Look into {path}", run=partial(self._go_to, path), path=path)
        return FileRow(f"{key}{path}", f"Open {path}", run=partial(self._open, path), path=path)

    def _turn(self) -> None:
        self._page += 1

    def _go_to(self, folder: Path) -> None:
        self._folder = folder
        self._list()

    def _open(self, path: Path) -> None:
        self.session.open(path)
        self._recent = [each for each in recent_files() if self._may_open(each)]

    def rows(self) -> Sequence[Widget]:
        session = self.session
        changed = "changed" if session.studio.is_changed else ""
        return [
            Button("save", "Save the scene and the picture; Ctrl+S.", run=self._save, value=changed),
            Button("save the rig", "Save the lights, to put them on another scene.", run=self._save_rig),
            Button("screenshot", "Save the picture as it is shown.", run=self._screenshot),
            Gap("list gap"),
            Pair(
                "refresh",
                "Read the folder again, or go to the one where files are saved.",
                run=self._list,
                other="home",
                run_other=partial(self._go_to, self._root),
            ),
        ]

    def _save(self) -> None:
        self.session.save()
        self._list()

    def _save_rig(self) -> None:
        self.session.save_rig()
        self._list()

    def _screenshot(self) -> None:
        self.session.save_image()


def entries_of(folder: Path) -> list[Path]:
    """What can be opened in a folder, and its folders: those with a scene first, then by name."""
    try:
        paths = []
        for number, path in enumerate(folder.iterdir()):
            if number >= MOST_ENTRIES:
                break
            if not path.name.startswith(".") and kind_of(path):
                paths.append(path)
    except OSError as error:
        raise InputError(
            f"{folder}: a folder must be one that can be read ({reason_of(error)}); choose another"
        ) from None
    order = ("scene", "mesh", "picture", "rig or scene", "folder")
    return sorted(paths, key=lambda path: (order.index(kind_of(path)), path.name.lower()))


def kind_of(path: Path) -> str:
    """What opening a path gives: "scene", "mesh", "picture", "rig or scene", "folder"; empty for nothing."""
    try:
        if path.is_dir():
            return "scene" if (path / SCENE_FILE).is_file() else "folder"
    except OSError:
        return ""
    suffix = path.suffix.lower()
    if suffix not in opened_suffixes():
        return ""
    if path.name == SCENE_FILE:
        return "scene"
    return {".toml": "rig or scene", ".npz": "picture"}.get(suffix, "mesh")


def _placed(rows: Sequence[Widget], area: Area) -> list[Widget]:
    """Rows one below the other, as far as they fit."""
    found = []
    for number, row in enumerate(rows[:MOST_ROWS]):
        top = area.top + ROW_LINES * number
        found.append(row.at(Area(area.left, top, area.right, top + ROW_LINES - 1)))
    return found


@dataclass(frozen=True)
class FileRow(Button):
    """A file, with its kind at the right."""

    path: Path = Path()

    def items(self, lit: bool) -> list[Item]:
        kind = kind_of(self.path)
        return self.row(lit, fitted(self.path.name, CHARACTERS - len(kind)), kind)
