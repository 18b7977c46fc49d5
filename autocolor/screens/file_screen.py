"""The file screen: scenes, meshes, pictures, rigs and paints to open, recent files, saving and exporting.

A pointer opens what is in the session's folder and below, links resolved; on the machine of the window, also
everything else. Opening is one step to undo, so the scene before is not lost; paints are no step. New files
are saved in the folder that is shown. The screen shows no surface, so the small picture of the picture file
under the pointer borrows the words of all surfaces.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Final

from autocolor.errors import AutocolorError, InputError
from autocolor.files.meshes.repair import UPS
from autocolor.files.opening import FOLDER, Openable, kind_of, openables_of
from autocolor.files.paths import SCENE_FILE
from autocolor.files.picture_file import read_picture
from autocolor.files.rig_file import RIG_SUFFIX, is_rig
from autocolor.files.state import recent_files
from autocolor.images import LARGEST, SMOOTHNESS, SMOOTHNESSES, display_image, size_of
from autocolor.journal.saving import free_name
from autocolor.mapping.palette import thumbnail
from autocolor.mapping.ranges import BACKGROUND
from autocolor.screens.file_actions import (
    check_reach,
    export,
    may_reach,
    open_file,
    save,
    save_image,
    save_rig,
)
from autocolor.screens.screen import Content, Screen, Surroundings
from autocolor.screens.session import PICTURE, Session
from autocolor.sending import configuration_of
from autocolor.widgets.items import (
    CHARACTER,
    CHARACTER_LINES,
    LIGHT_GRAY,
    NIGHT,
    SLATE,
    YELLOW,
    Area,
    Item,
    SmallPicture,
    filled,
    outline,
    text,
)
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import (
    MARGIN,
    ROW_LINES,
    TEXT_DOWN,
    Button,
    Choice,
    Entry,
    Gap,
    Pair,
    Widget,
    page_choice,
    short_name,
)

LEFT: Final = Area(8, WORK.top + 40, 247, 455)
RIGHT: Final = Area(256, WORK.top + 40, 495, 455)
"""The columns of the folder's files and of recent ones."""

MOST_ROWS: Final = LEFT.height // ROW_LINES
CHARACTERS: Final = (LEFT.width - 2 * MARGIN) // CHARACTER
ACROSS: Final = (RIGHT.right - LEFT.left - 2 * MARGIN) // CHARACTER

MESH_SCALES: Final = ("0.001", "0.01", "0.0254", "0.3048", "1", "10", "100", "1000")
"""The factors for the coordinates of mesh files that can be pointed at."""

UP: Final = ".."
RIG: Final = "rig"
PICTURE_KIND: Final = "picture"

RECENT: Final = "recent "
"""The beginning of the keys of recent files."""

FOLDER_LETTERS: Final = 36
"""Letters of the folder in a hint."""

MONTHS: Final = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
LONGEST_DATE: Final = 6
LONGEST_KIND: Final = 7
"""Letters of a date, and of a kind."""

FRAME: Final = 4
THUMBNAIL_LINES: Final = 168
THUMBNAIL_ELEMENTS: Final = 224
THUMBNAIL: Final = Area(
    RIGHT.left + MARGIN - FRAME,
    RIGHT.bottom + 1 - MARGIN - THUMBNAIL_LINES - 2 * FRAME,
    RIGHT.left + MARGIN + THUMBNAIL_ELEMENTS + FRAME - 1,
    RIGHT.bottom - MARGIN,
)
"""The largest size of the small picture of a picture file, and its area with a frame.

Smaller pictures stand at the lower left.
"""

FIRST_BORROWED: Final = BACKGROUND + 1
MOST_COLORS: Final = 500
"""Assumed: the most colors of the small picture; more take longer, and are not seen."""

PART_OF_BUDGET: Final = 0.1
"""Limit: the part of the memory budget to read a picture file for its small picture."""

SIZES: Final = (1, 2, 4)
"""The sizes of exported images, in sizes of the display."""

TICKS_TO_EXPORT: Final = 2


class FileScreen(Screen):
    """Files to open, and buttons that save."""

    name = "file"
    title = "file"
    word = "file"
    help = "Click a file to open it; undo goes back to the scene before"
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._files: list[Openable] = []
        self._recent: list[Openable] = []
        self._notes: dict[Path, tuple[bool, str]] = {}
        """Whether each file that was shown is a rig, and the date of its last change."""
        self._page = 0
        self._thumbnail: tuple[Path, str, SmallPicture | None] | None = None
        """The picture file that was read last, its caption, and its small picture, if it could be read."""
        self._size = self._own_size = size_of_display(session)
        self._smooth = SMOOTHNESS
        self._ticks_to_export = 0
        """How many ticks remain until the image is exported; 0 if none is to be exported."""

    def enter(self) -> None:
        self._look_up_recent()
        try:
            self._list(self.session.folder)
        except InputError as error:
            self.session.warn(error)

    def leave(self) -> None:
        if self._ticks_to_export:
            self._export()

    def _look_up_recent(self) -> None:
        recent = [Openable(path, kind_of(path)) for path in recent_files() if may_reach(self.session, path)]
        self._recent = [each for each in recent if each.kind]

    def _list(self, folder: Path) -> None:
        """Show a folder as it is now. Raises InputError if it cannot be read."""
        self._files = [each for each in openables_of(folder) if may_reach(self.session, each.path)]
        self.session.folder = folder
        self._page, self._notes, self._thumbnail = 0, {}, None

    def _shown_path(self, path: Path) -> str:
        """A path as text. Users of another machine do not see the folders above the session's."""
        root = self.session.root
        if self.session.is_at_hand:
            return str(path)
        below = path.relative_to(root) if path.is_relative_to(root) else path.name
        return str(Path(root.name or "/", below))

    # Items and widgets.

    def build(self, around: Surroundings) -> Content:
        pointed = self._picture_of(around.lit)
        shown = self._thumbnail_of(pointed)
        return Content(
            items=self._items(shown),
            loads=[] if shown is None else [(FIRST_BORROWED, shown[1].colors)],
            rows=self._rows,
            widgets=self._widgets(),
            idle=partial(self._idle, pointed),
        )

    def _items(self, shown: tuple[str, SmallPicture] | None) -> Sequence[Item]:
        down, left = LEFT.top + TEXT_DOWN, LEFT.left + MARGIN
        folder = short_name(self._shown_path(self.session.folder), ACROSS)
        items = [
            text("OPEN", left, WORK.top + TEXT_DOWN, YELLOW),
            text("RECENT", RIGHT.left + MARGIN, WORK.top + TEXT_DOWN, YELLOW),
            text(folder, left, WORK.top + ROW_LINES + TEXT_DOWN, LIGHT_GRAY),
            filled(Area(251, LEFT.top, 251, LEFT.bottom), SLATE),
        ]
        if not self._files:
            items.append(
                text("no scene, mesh or picture", left, down + ROW_LINES * self._has_way_up, LIGHT_GRAY)
            )
        if not self._recent:
            items.append(text("nothing was opened yet", RIGHT.left + MARGIN, down, LIGHT_GRAY))
        if shown is not None:
            caption, small = shown
            lines, elements = small.full.shape[:2]
            left, top = THUMBNAIL.left + FRAME, THUMBNAIL.bottom + 1 - FRAME - lines
            around = Area(left - FRAME, top - FRAME, left + elements + FRAME - 1, THUMBNAIL.bottom)
            items += [
                text(caption, left, around.top - CHARACTER_LINES - FRAME, LIGHT_GRAY),
                outline(around, SLATE),
                small.item(FIRST_BORROWED, left, top),
            ]
        return items

    def _thumbnail_of(self, pointed: Path | None) -> tuple[str, SmallPicture] | None:
        """The caption and the small picture of the picture file under the pointer, if it was read."""
        if self._thumbnail is None:
            return None
        path, caption, small = self._thumbnail
        return None if small is None or path != pointed else (caption, small)

    def _picture_of(self, lit: str) -> Path | None:
        """The picture file of a row, by the key of the row."""
        pointed = lit.removeprefix(RECENT)
        pictures = (path for path, kind in (*self._files, *self._recent) if kind == PICTURE_KIND)
        return next((path for path in pictures if str(path) == pointed), None)

    def _idle(self, path: Path | None) -> bool:
        """Export an image, or read the picture file under the pointer."""
        if self._ticks_to_export:
            # A window shows the message after the first tick.
            self._ticks_to_export -= 1
            if not self._ticks_to_export:
                self._export()
                return True
            return False
        if path is None or (self._thumbnail is not None and self._thumbnail[0] == path):
            return False
        self._thumbnail = path, *self._read_thumbnail(path)
        return self._thumbnail[2] is not None

    def _read_thumbnail(self, path: Path) -> tuple[str, SmallPicture | None]:
        """The caption and the small picture of a picture file; no picture if the file cannot be read."""
        try:
            self._check(path)
            scene, picture = read_picture(path, limit=PART_OF_BUDGET)
            shown = display_image(scene, picture)
        except AutocolorError:
            return "", None
        shrunk = max(picture.lines / THUMBNAIL_LINES, picture.elements / THUMBNAIL_ELEMENTS, 1)
        lines, elements = (max(1, round(size / shrunk)) for size in (picture.lines, picture.elements))
        size = written_size(picture.size)
        caption = f"{short_name(path.name, CHARACTERS - len(size) - 2)}  {size}"
        return caption, SmallPicture(thumbnail(shown, lines, elements), MOST_COLORS)

    @property
    def _has_way_up(self) -> bool:
        folder = self.session.folder
        return folder.parent != folder and may_reach(self.session, folder.parent)

    def _widgets(self) -> Sequence[Widget]:
        rows: list[Widget] = []
        if self._has_way_up:
            above = Openable(self.session.folder.parent, FOLDER)
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
        recent = [self._row(each, key=RECENT) for each in self._recent]
        return [*_placed(rows, LEFT), *_placed(recent, RIGHT)]

    def _row(self, openable: Openable, shown: str = "", key: str = "") -> Widget:
        path, kind = openable
        if kind == FOLDER:
            help, run = f"Look into {self._shown_path(path)}", partial(self._go_to, path)
        else:
            help, run = f"Open {self._shown_path(path)}", partial(self._open, path)
        if path not in self._notes:
            may_be_rig = path.suffix.lower() == RIG_SUFFIX and path.name != SCENE_FILE
            self._notes[path] = may_be_rig and is_rig(path), date_of(path, kind)
        rig, date = self._notes[path]
        shown = shown or short_path(path, bool(key))
        return FileRow(f"{key}{path}", help, run=run, value=RIG if rig else kind, shown=shown, date=date)

    def _rows(self) -> Sequence[Widget]:
        session = self.session
        changed = "changed" if session.studio.is_changed else ""
        scale = f"{session.mesh_scale:g}"
        scales = tuple(sorted({*MESH_SCALES, scale}, key=float))
        folder = short_name(self._shown_path(session.folder), FOLDER_LETTERS)
        files = " and ".join(short_path(Path(name), True) for name in session.studio.history.files)
        saves = f"Save to {files}; new files go to" if files else "Save the scene and the picture in"
        size = written_size(self._size)
        sizes = [(times * self._own_size[0], times * self._own_size[1]) for times in SIZES]
        sizes = sorted({self._size, *(each for each in sizes if max(each) <= LARGEST)})
        return [
            Button(
                "save",
                f"{saves} {folder}",
                run=partial(self._save, partial(save, session)),
                value=changed,
            ),
            Entry(
                "save as",
                f"Save under another name in {folder}; from then on, save writes these files.",
                value=free_name(session.scene.name, session.folder),
                take=lambda name: self._save(lambda: save(session, name.strip())),
                is_proposed=True,
            ),
            Button(
                "save the rig",
                f"Save all lights in {folder}, to put them on another scene.",
                run=partial(self._save, partial(save_rig, session)),
            ),
            Button(
                "screenshot",
                f"Save the picture as a numbered image in {folder}, without menus.",
                run=partial(self._save, partial(save_image, session)),
            ),
            Gap("export gap"),
            Button(
                "export",
                f"Save the picture at this size and smoothness as an image in {folder}.",
                run=self._begin_export,
            ),
            Choice(
                "size",
                "The width and height of an exported image: of the display, or two or four times as much.",
                names=[written_size(each) for each in sizes],
                present=size,
                choose=self._choose_size,
            ),
            Entry(
                "other size",
                f"Another width and height of an exported image, up to {LARGEST}, as in 1920x1080.",
                take=self._choose_size,
            ),
            Choice(
                "smoothness",
                "From 2 on, edges are smooth: each pixel is the mean of 4, 9 or 16, which takes longer.",
                names=[str(each) for each in SMOOTHNESSES],
                present=str(self._smooth),
                choose=self._choose_smoothness,
            ),
            Gap("list gap"),
            Pair(
                "refresh",
                "Read the folder again, or go to the folder where files are saved.",
                run=lambda: self._list(session.folder),
                other="home",
                run_other=partial(self._go_to, session.root),
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
        before = self.session.screen
        open_file(self.session, path)
        if self.session.screen == before:
            # Paints turn to the screen that shows them.
            self.session.turn_to(PICTURE)

    def _check(self, path: Path) -> None:
        check_reach(self.session, path, "a file to open")

    def _save(self, save: Callable[[], object]) -> None:
        save()
        self._look_up_recent()
        self._list(self.session.folder)

    def _choose_size(self, text: str) -> None:
        self._size = size_of(text.strip())

    def _choose_smoothness(self, name: str) -> None:
        self._smooth = int(name)

    def _begin_export(self) -> None:
        self._ticks_to_export = TICKS_TO_EXPORT
        size = written_size(self._size)
        self.session.tell(f"exporting {size}, smoothness {self._smooth} ...", persistent=True)

    def _export(self) -> None:
        """Export the image; a message says its name, or why there is none."""
        self._ticks_to_export = 0
        try:
            export(self.session, self._size, self._smooth)
        except AutocolorError as error:
            self.session.warn(error)


def size_of_display(session: Session) -> tuple[int, int]:
    """The elements and lines that the display shows."""
    sizes = configuration_of(session.display)
    return sizes.shown_elements, sizes.shown_lines


def written_size(size: tuple[int, int]) -> str:
    """A width and a height as text, as in "640x480"."""
    return "{}x{}".format(*size)


def short_path(path: Path, with_folder: bool) -> str:
    """The name of a file. Every scene file has the same name: `with_folder` shows its folder, too."""
    return f"{path.parent.name}/{path.name}" if with_folder and path.name == SCENE_FILE else path.name


def date_of(path: Path, kind: str) -> str:
    """The date of the last change of a file, or of the scene file in a scene's folder; empty for folders."""
    if kind == FOLDER:
        return ""
    file = path / SCENE_FILE if path.is_dir() else path
    try:
        return short_date(file.stat().st_mtime, time.time())
    except (OSError, OverflowError, ValueError):
        return ""


def short_date(seconds: float, now: float) -> str:
    """A local time in at most six characters: the hour today, the day this year, else the year.

    Both times are in seconds since 1970. Raises OSError, OverflowError or ValueError for a year that the
    system cannot compute.

    >>> short_date(86_400 * 400, now=86_400 * 20_000)
    '1971'
    """
    then, today = datetime.fromtimestamp(seconds), datetime.fromtimestamp(now)
    if then.date() == today.date():
        return f"{then:%H:%M}"
    return f"{then.day} {MONTHS[then.month - 1]}" if then.year == today.year else str(then.year)


def _placed(rows: Sequence[Widget], area: Area) -> list[Widget]:
    """The rows with their areas, from the top; rows that do not fit are left out."""
    placed = []
    for number, row in enumerate(rows[:MOST_ROWS]):
        top = area.top + ROW_LINES * number
        placed.append(row.at(Area(area.left, top, area.right, top + ROW_LINES - 1)))
    return placed


@dataclass(frozen=True)
class FileRow(Button):
    """A file, with its kind at the right, and before it the date, unless the name needs the room."""

    shown: str = ""
    date: str = ""

    def items(self, lit: bool) -> list[Item]:
        items = self.row(lit, short_name(self.shown, CHARACTERS - len(self.value) - 1), self.value)
        left, top, right, _ = self.area
        end = right + 1 - MARGIN - CHARACTER * (LONGEST_KIND + 1)
        start = end - CHARACTER * len(self.date)
        if self.date and left + MARGIN + CHARACTER * (len(self.shown) + 1) <= end - CHARACTER * LONGEST_DATE:
            items.append(text(self.date, start, top + TEXT_DOWN, LIGHT_GRAY, SLATE if lit else NIGHT))
        return items
