"""The file screen: scenes, meshes, pictures and rigs to open, recent files, and saving.

A pointer opens what is in the session's folder and below, links resolved; on the machine of the window, also
everything else. Opening is one step to undo, so the scene before is not lost.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from autocolor.errors import InputError, UsageError
from autocolor.files.meshes.repair import UPS
from autocolor.files.paths import SCENE_FILE
from autocolor.files.rig_file import RIG_SUFFIX, is_rig
from autocolor.files.scene_files import FOLDER, Openable, kind_of, openables_of, stays_within
from autocolor.files.state import recent_files
from autocolor.screens.screen import Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.widgets.items import CHARACTER, GRAY, LIGHT_GRAY, SLATE, YELLOW, Area, Item, filled, text
from autocolor.widgets.widget import (
    MARGIN,
    ROW_LINES,
    TEXT_DOWN,
    Button,
    Choice,
    Gap,
    Pair,
    Widget,
    page_choice,
    short_name,
)

LEFT: Final = Area(8, 40, 247, 455)
RIGHT: Final = Area(256, 40, 495, 455)
"""The columns of the folder's files and of recent ones."""

MOST_ROWS: Final = LEFT.height // ROW_LINES
CHARACTERS: Final = (LEFT.width - 2 * MARGIN) // CHARACTER
ACROSS: Final = (RIGHT.right - LEFT.left - 2 * MARGIN) // CHARACTER

MESH_SCALES: Final = ("0.001", "0.01", "0.0254", "0.3048", "1", "10", "100", "1000")
"""The factors for the coordinates of mesh files that can be pointed at."""

UP: Final = ".."
RIG: Final = "rig"


class FileScreen(Screen):
    """Files to open, and buttons that save."""

    name = "file"
    title = "file"
    help = "Click a file to open it; undo goes back to the scene before"
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._root = session.folder.resolve()
        self._folder = self._root
        self._files: list[Openable] = []
        self._recent: list[Openable] = []
        self._rigs: dict[Path, bool] = {}
        """Whether the scene files that were shown are rigs."""
        self._page = 0

    def enter(self) -> None:
        self._look_up_recent()
        try:
            self._list(self._folder)
        except InputError as error:
            self.session.warn(error)

    def _look_up_recent(self) -> None:
        recent = [Openable(path, kind_of(path)) for path in recent_files() if self._may_open(path)]
        self._recent = [each for each in recent if each.kind]

    def _list(self, folder: Path) -> None:
        """Show a folder as it is now. Raises InputError if it cannot be read."""
        self._files = [each for each in openables_of(folder) if self._may_open(each.path)]
        self._folder, self._page, self._rigs = folder, 0, {}

    def _may_open(self, path: Path) -> bool:
        """Whether the pointer of this session may open a file or a folder."""
        return self.session.is_at_hand or stays_within(path, self._root)

    def _shown_path(self, path: Path) -> str:
        """A path as text. Users of another machine do not see the folders above the session's."""
        if self.session.is_at_hand:
            return str(path)
        below = path.relative_to(self._root) if path.is_relative_to(self._root) else path.name
        return str(Path(self._root.name or "/", below))

    # Items and widgets.

    def items(self) -> Sequence[Item]:
        down, left = LEFT.top + TEXT_DOWN, LEFT.left + MARGIN
        items = [
            text("OPEN", left, TEXT_DOWN, YELLOW),
            text("RECENT", RIGHT.left + MARGIN, TEXT_DOWN, YELLOW),
            text(short_name(self._shown_path(self._folder), ACROSS), left, ROW_LINES + TEXT_DOWN, LIGHT_GRAY),
            filled(Area(251, LEFT.top, 251, LEFT.bottom), SLATE),
        ]
        if not self._files:
            items.append(text("no scene, mesh or picture", left, down + ROW_LINES * self._has_way_up, GRAY))
        if not self._recent:
            items.append(text("nothing was opened yet", RIGHT.left + MARGIN, down, GRAY))
        return items

    @property
    def _has_way_up(self) -> bool:
        above = self._folder.parent
        return above != self._folder and self._may_open(above)

    def widgets(self) -> Sequence[Widget]:
        rows: list[Widget] = []
        if self._has_way_up:
            above = Openable(self._folder.parent, FOLDER)
            rows.append(self._row(above, UP))
        room = MOST_ROWS - len(rows)
        if len(self._files) > room:
            room -= 1
        pages = [self._files[first : first + room] for first in range(0, len(self._files), room)]
        page = min(self._page, len(pages) - 1)
        rows += [self._row(each) for each in pages[page]] if pages else []
        if len(pages) > 1:
            help = "A click turns to the next page of files; at the left end, to the page before."
            rows.append(page_choice(help, page, len(pages), partial(setattr, self, "_page")))
        recent = [self._row(each, key="recent ") for each in self._recent]
        return [*_placed(rows, LEFT), *_placed(recent, RIGHT)]

    def _row(self, openable: Openable, shown: str = "", key: str = "") -> Widget:
        path, kind = openable
        if kind == FOLDER:
            help, run = f"Look into {self._shown_path(path)}", partial(self._go_to, path)
        else:
            help, run = f"Open {self._shown_path(path)}", partial(self._open, path)
        if path.suffix.lower() == RIG_SUFFIX and path.name != SCENE_FILE:
            if path not in self._rigs:
                self._rigs[path] = is_rig(path)
            kind = RIG if self._rigs[path] else kind
        if not shown:
            # Every scene file has this name: show its folder, too.
            shown = f"{path.parent.name}/{path.name}" if key and path.name == SCENE_FILE else path.name
        return FileRow(f"{key}{path}", help, run=run, value=kind, shown=shown)

    def rows(self) -> Sequence[Widget]:
        session = self.session
        changed = "changed" if session.studio.is_changed else ""
        scale = f"{session.mesh_scale:g}"
        scales = tuple(sorted({*MESH_SCALES, scale}, key=float))
        return [
            Button(
                "save",
                "Save the scene and the picture.",
                run=partial(self._save, session.save),
                value=changed,
            ),
            Button(
                "save the rig",
                "Save all lights, to put them on another scene.",
                run=partial(self._save, session.save_rig),
            ),
            Button(
                "screenshot",
                "Save the picture as a numbered image, without menus.",
                run=partial(self._save, session.save_image),
            ),
            Gap("list gap"),
            Pair(
                "refresh",
                "Read the folder again, or go to the folder where files are saved.",
                run=lambda: self._list(self._folder),
                other="home",
                run_other=partial(self._go_to, self._root),
            ),
            Choice(
                "mesh up",
                "The up axis of the mesh files that you open; other files have their own.",
                names=UPS,
                present=session.mesh_up,
                choose=partial(setattr, session, "mesh_up"),
            ),
            Choice(
                "mesh scale",
                "A factor for the mesh files that you open: 0.001 from millimeters, 0.0254 from inches.",
                names=scales,
                present=scale,
                choose=lambda name: setattr(session, "mesh_scale", float(name)),
            ),
        ]

    # The actions of the rows.

    def _go_to(self, folder: Path) -> None:
        self._check(folder)
        self._list(folder)

    def _open(self, path: Path) -> None:
        self._check(path)
        self.session.open(path)
        self.session.turn_to(PICTURE)

    def _check(self, path: Path) -> None:
        """Raise UsageError if the pointer of this session may not open a path."""
        if not self._may_open(path):
            raise UsageError(
                f"{path.name}: a file to open must be in the folder {self._root.name}, and not a link to"
                " elsewhere; choose another"
            )

    def _save(self, save: Callable[[], object]) -> None:
        save()
        self._look_up_recent()
        self._list(self._folder)


def _placed(rows: Sequence[Widget], area: Area) -> list[Widget]:
    """The rows with their areas, from the top; rows that do not fit are left out."""
    placed = []
    for number, row in enumerate(rows[:MOST_ROWS]):
        top = area.top + ROW_LINES * number
        placed.append(row.at(Area(area.left, top, area.right, top + ROW_LINES - 1)))
    return placed


@dataclass(frozen=True)
class FileRow(Button):
    """A file, with its kind at the right."""

    shown: str = ""

    def items(self, lit: bool) -> list[Item]:
        return self.row(lit, short_name(self.shown, CHARACTERS - len(self.value) - 1), self.value)
