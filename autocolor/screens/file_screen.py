"""The file screen: files to open, recent files and examples with small pictures; saving and exporting.

A pointer opens the examples, and what is in the session's folder and below, links resolved; on the machine of
the window, also everything else. Opening is one step to undo, so the scene before is not lost; paints are no
step. New files are saved in the folder that is shown. A file of the folder has a larger picture while the
pointer is on it, in place of the examples.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import ClassVar, Final, NamedTuple

from autocolor.errors import AutocolorError, InputError
from autocolor.files.meshes.repair import UPS
from autocolor.files.opening import FOLDER, RIG, kind_of, openables_of
from autocolor.files.paths import SCENE_FILE, example_scenes, file_stem, free_path
from autocolor.files.state import recent_files
from autocolor.images import LARGEST, SMOOTHNESS, SMOOTHNESSES, size_of
from autocolor.images import save_image as save_image_of
from autocolor.journal.autosave import left_sessions, written_at
from autocolor.journal.saving import free_name
from autocolor.rendering import SIZE
from autocolor.scene.scene import Scene
from autocolor.screens.file_actions import (
    check_reach,
    may_reach,
    open_file,
    recover,
    save,
    save_image,
    save_rig,
    shown_folder,
)
from autocolor.screens.gallery import (
    FRAME,
    LINES,
    NAME_LINES,
    TILE_ELEMENTS,
    TILE_LINES,
    Gallery,
    Small,
    Tile,
    small_picture_of_file,
)
from autocolor.screens.screen import Content, Screen, Surroundings
from autocolor.screens.session import PICTURE, Session
from autocolor.widgets.items import CHARACTER, LIGHT_GRAY, NIGHT, SLATE, YELLOW, Area, Item, fitted, text
from autocolor.widgets.menu import WORK, laid_out, paged
from autocolor.widgets.widget import MARGIN, ROW_LINES, TEXT_DOWN, Button, Choice, Entry, Gap, Pair, Widget

LEFT: Final = Area(7, WORK.top + 40, 247, WORK.bottom - 8)
"""The column of the folder's files."""

MOST_ROWS: Final = LEFT.height // ROW_LINES
CHARACTERS: Final = (LEFT.width - 1 - 2 * MARGIN) // CHARACTER

RIGHT: Final = 256
EXAMPLES_DOWN: Final = 224
"""Lines from the heading of the recent files to the heading of the examples."""

RECENT_PLACES: Final = tuple(
    Area(left, top, left + TILE_ELEMENTS - 1, top + TILE_LINES - 1)
    for top in (WORK.top + ROW_LINES, WORK.top + ROW_LINES + TILE_LINES)
    for left in (RIGHT, RIGHT + TILE_ELEMENTS + 4)
)
EXAMPLE_PLACES: Final = tuple(
    each._replace(top=each.top + EXAMPLES_DOWN, bottom=each.bottom + EXAMPLES_DOWN) for each in RECENT_PLACES
)
"""The places of the tiles below their two headings. Without recent files, the examples take their places."""

TURNING: Final = Area(RECENT_PLACES[1].left, WORK.top, RECENT_PLACES[1].right, WORK.top + ROW_LINES - 1)
"""The place of the row that turns to other recent files, beside their heading."""

TIMES: Final = 2
PREVIEW: Final = Area(
    RIGHT,
    WORK.top + EXAMPLES_DOWN,
    EXAMPLE_PLACES[-1].right,
    WORK.top + EXAMPLES_DOWN + TIMES * LINES + 2 * MARGIN + NAME_LINES,
)
"""The place of the larger picture, which is so many times as large as the picture on a tile."""

MESH_SCALES: Final = ("0.001", "0.01", "0.0254", "0.3048", "1", "10", "100", "1000")
"""The factors for the coordinates of mesh files that can be pointed at."""

RECENT: Final = "recent"
EXAMPLE: Final = "example"
WITHOUT_PICTURE: Final = (FOLDER, RIG, "paints")
"""The kinds of files without a small picture."""

FOLDER_LETTERS: Final = 36
"""Letters of the folder in a hint."""

LONGEST_DATE: Final = 6
LONGEST_KIND: Final = 7
"""Letters of a date, and of a kind."""

SIZES: Final = (SIZE, (1920, 1080), (3840, 2160))
"""The sizes of exported images that can be pointed at."""

TICKS_TO_REST: Final = 6
"""Assumed: so many ticks after the pointer came to a row, it rests there: a tenth of a second."""


class File(NamedTuple):
    """A file, its kind (see `Openable`), and when it changed last, in seconds since 1970; 0 if unknown."""

    path: Path
    kind: str
    changed: float

    @classmethod
    def of(cls, path: Path, kind: str) -> File:
        """A file as it is now. The folder of a scene changes with its scene file."""
        changed = 0.0
        with suppress(OSError):
            changed = (path / SCENE_FILE if path.is_dir() else path).stat().st_mtime
        return cls(path, kind, changed)


class FileScreen(Screen):
    """Files to open, and buttons that save."""

    name = "file"
    title = "file"
    word = "file"
    help = "Click a file to open it; undo goes back to the scene before"
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._files: list[File] = []
        self._recent: list[File] = []
        self._examples = [File.of(folder, "scene") for folder in example_scenes().values()]
        self._left: Sequence[str] = ()
        """The date of the last session that was not closed; empty without such a session."""
        self._pages = {"": 0, RECENT: 0}
        self._gallery = Gallery()
        self._size, self._smooth = SIZE, SMOOTHNESS
        self._exports: Iterator[bool] = iter(())
        """The steps that export the remaining images."""
        self._lit, self._rested = "", 0
        """The row under the pointer, and for how many ticks the pointer has been on it."""

    def enter(self) -> None:
        self._look_up()
        try:
            self._list(self.session.folder)
        except InputError as error:
            self.session.warn(error)

    def leave(self) -> None:
        for _ in self._exports:
            pass
        self._gallery.keep([self._key(each, 1) for each in (*self._recent, *self._examples)])

    def _look_up(self) -> None:
        """Look up the recent files, and the sessions that were not closed."""
        # A scene is opened by its folder, and saved by its scene file.
        recent = [path.parent if path.name == SCENE_FILE else path for path in recent_files()]
        reached = [path for path in dict.fromkeys(recent) if may_reach(self.session, path)]
        self._recent = [File.of(path, kind) for path in reached if (kind := kind_of(path))]
        session = self.session
        # The files of another session may be anywhere.
        may_recover = session.autosave is not None and session.is_at_hand and not session.outlives_window
        self._left = [short_date(written_at(each)) for each in left_sessions()[:1] if may_recover]

    def _list(self, folder: Path) -> None:
        """Show a folder as it is now. Raises InputError if it cannot be read."""
        openables = [each for each in openables_of(folder) if may_reach(self.session, each.path)]
        self._files = [File.of(*each) for each in openables]
        self.session.folder = folder
        self._pages[""] = 0

    # Lists and small pictures.

    def build(self, around: Surroundings) -> Content:
        recent, turning = self._paged(self._recent, RECENT, len(RECENT_PLACES))
        wanted = [(each, 1) for each in (*recent, *self._examples)]
        upper = [self._tile(*each, RECENT) for each in zip(recent, RECENT_PLACES, strict=False)]
        places = EXAMPLE_PLACES if recent else RECENT_PLACES
        lower = [self._tile(*each, EXAMPLE) for each in zip(self._examples, places, strict=False)]
        if not recent:
            upper, lower = lower, []
        pointed = next((each for each in self._files if str(each.path) == around.lit), None)
        if pointed is not None and pointed.kind not in WITHOUT_PICTURE:
            wanted.append((pointed, TIMES))
            preview = self._tile(pointed, PREVIEW, "preview", TIMES)
            if preview.picture or preview.note:
                lower = [preview]
        return Content(
            items=self._items(),
            loads=self._gallery.loads,
            rows=self._rows,
            widgets=[*self._list_of_files(), *[each.at(TURNING) for each in turning], *upper, *lower],
            idle=partial(self._idle, wanted, around.lit),
        )

    def _items(self) -> list[Item]:
        left, right, top = LEFT.left + 1 + MARGIN, RIGHT + FRAME, WORK.top + TEXT_DOWN
        folder = fitted(self.session.shown(self.session.folder), CHARACTERS)
        items = [
            text("OPEN", left, top, YELLOW),
            text(folder, left, top + ROW_LINES, LIGHT_GRAY),
            text("EXAMPLES", right, top + (EXAMPLES_DOWN if self._recent else 0), YELLOW),
        ]
        if self._recent:
            items.append(text("RECENT", right, top, YELLOW))
        if not self._files:
            items.append(text("no scene, mesh or picture", left, LEFT.top + ROW_LINES, LIGHT_GRAY))
        return items

    def _list_of_files(self) -> Sequence[Widget]:
        folder, above = self.session.folder, self.session.folder.parent
        has_way_up = above != folder and may_reach(self.session, above)
        rows = [self._row(File(above, FOLDER, 0), "..")] if has_way_up else []
        room = MOST_ROWS - len(rows)
        files, turning = self._paged(self._files, "", room - (len(self._files) > room))
        return laid_out([*rows, *[self._row(each, each.path.name) for each in files], *turning], LEFT)

    def _paged(self, files: Sequence[File], name: str, size: int) -> tuple[Sequence[File], list[Widget]]:
        """The files of the present page of a list, and the row that turns to others, if there are any."""
        help = "A click turns to the next page of files; at the left end, to the page before."
        turn = partial(self._pages.__setitem__, name)
        return paged(files, size, self._pages[name], help, turn, within=name)

    def _row(self, file: File, shown: str) -> Widget:
        path, kind, changed = file
        verb, run = ("Look into", self._go_to) if kind == FOLDER else ("Open", self._open)
        help, date = f"{verb} {self.session.shown(path)}", short_date(changed) if changed else ""
        return FileRow(str(path), help, run=partial(run, path), value=kind, shown=shown, date=date)

    def _tile(self, file: File, area: Area, within: str, times: int = 1) -> Tile:
        path, as_example = file.path, within == EXAMPLE
        help = f"Open the example {path.name}" if as_example else f"Open {self.session.shown(path)}"
        run = partial(self._open, path, as_example)
        tile = Tile(path.name, help, within=within, run=run).at(area)
        return self._gallery.framed(self._key(file, times), tile)

    def _key(self, file: File, times: int) -> Hashable:
        """The key of a small picture: another one is made if the file, or the way to read a mesh, changes."""
        return file, times, self.session.mesh_up

    def _small_picture(self, file: File, times: int) -> Small:
        check_reach(self.session, file.path, "a file to open")
        return small_picture_of_file(file.path, file.kind, self.session.mesh_up, times)

    def _idle(self, wanted: Sequence[tuple[File, int]], lit: str) -> bool:
        """Go on exporting, or make a small picture once the pointer rests."""
        self._rested = self._rested + 1 if lit == self._lit else 0
        self._lit = lit
        if next(self._exports, False):
            return True
        pictures = {self._key(*each): partial(self._small_picture, *each) for each in wanted}
        return self._rested >= TICKS_TO_REST and self._gallery.advance(pictures)

    # The menu.

    def _rows(self) -> Sequence[Widget]:
        session, scene, history = self.session, self.session.scene, self.session.studio.history
        changed = "changed" if history.is_changed else ""
        scale = f"{session.mesh_scale:g}"
        folder = fitted(session.shown(session.folder), FOLDER_LETTERS)
        # Every scene file has the same name.
        files = " and ".join("/".join(Path(name).parts[-2:]) for name in history.files)
        saves = f"Save to {files}; new files go to" if files else "Save the scene and the picture in"
        recovering = "Go on with the session that was not closed. Unsaved changes are left to be recovered."
        return [
            Button("save", f"{saves} {folder}", run=partial(self._save, save), value=changed),
            Entry(
                "save as",
                f"Save under another name in {folder}; from then on, save writes these files.",
                value=free_name(scene.name, session.folder),
                take=lambda name: self._save(partial(save, name=name.strip())),
                is_proposed=True,
            ),
            Button(
                "save the rig",
                f"Save all lights in {folder}, to put them on another scene.",
                run=partial(self._save, save_rig),
            ),
            Button(
                "screenshot",
                f"Save the picture as a numbered image in {folder}, without menus.",
                run=partial(self._save, save_image),
            ),
            Gap("export gap"),
            Button(
                "export",
                f"Save the picture at this size and smoothness as an image in {folder}.",
                run=lambda: self._begin_export({"": scene}),
            ),
            Button(
                "every camera",
                f"Save an image from each camera in {folder}.",
                "" if scene.views else "no camera is saved yet; light and view saves one",
                run=lambda: self._begin_export(
                    {each.name: scene.with_taken_view(each.name) for each in scene.views}
                ),
            ),
            Button(
                "every variant",
                f"Save an image of each variant in {folder}.",
                "" if history.variants else "no variant is kept yet",
                run=lambda: self._begin_export(
                    {name: history.shown(name).present.scene for name in history.variants}
                ),
            ),
            Choice(
                "size",
                "The width and height of exported images.",
                names=[written_size(each) for each in sorted({*SIZES, self._size})],
                present=written_size(self._size),
                choose=self._choose_size,
            ),
            Entry(
                "other size",
                f"Another width and height of exported images, up to {LARGEST}, as in 1280x960.",
                take=self._choose_size,
            ),
            Choice(
                "smoothness",
                "From 2 on, edges are smooth: each pixel is the mean of 4, 9 or 16, which takes longer.",
                names=[str(each) for each in SMOOTHNESSES],
                present=str(self._smooth),
                choose=lambda name: setattr(self, "_smooth", int(name)),
            ),
            Gap("list gap"),
            *[
                Button("recover", recovering, run=partial(recover, session), value=date)
                for date in self._left
            ],
            Pair(
                "refresh",
                "Read the folder again, or go to the folder where files are saved.",
                run=self._refresh,
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
                names=sorted({*MESH_SCALES, scale}, key=float),
                present=scale,
                choose=lambda name: setattr(session, "mesh_scale", float(name)),
            ),
        ]

    # The actions of the rows.

    def _refresh(self) -> None:
        self._gallery.keep()
        self._list(self.session.folder)

    def _go_to(self, folder: Path) -> None:
        check_reach(self.session, folder, "a file to open")
        self._list(folder)

    def _open(self, path: Path, as_example: bool = False) -> None:
        check_reach(self.session, path, "a file to open")
        before = self.session.screen
        open_file(self.session, path, as_example)
        if self.session.screen == before:
            # Paints turn to the screen that shows them.
            self.session.turn_to(PICTURE)

    def _save(self, save: Callable[[Session], object]) -> None:
        save(self.session)
        self._look_up()
        self._list(self.session.folder)

    def _choose_size(self, text: str) -> None:
        self._size = size_of(text.strip())

    def _begin_export(self, scenes: Mapping[str, Scene]) -> None:
        """Begin to export images of scenes; the first message is shown at once."""
        self._exports = self._export(scenes)
        next(self._exports)

    def _export(self, scenes: Mapping[str, Scene]) -> Iterator[bool]:
        """Export images, named after the present scene and their own names. Messages say what is done."""
        session, size, smooth, count = self.session, self._size, self._smooth, len(scenes)
        stem, how = file_stem(session.scene.name), f"{written_size(size)}, smoothness {smooth}"
        for number, (own, scene) in enumerate(scenes.items(), start=1):
            name = f"{stem}-{file_stem(own)}" if own else stem
            more = f", then {count - number} more" if number < count else ""
            session.tell(f"exporting {name}, {how}{more} ...", persistent=True)
            # A window shows the message after the first tick.
            yield True
            yield True
            try:
                path = free_path(shown_folder(session) / f"{name}.png")
                save_image_of(path, scene, size=size, smooth=smooth)
            except AutocolorError as error:
                session.warn(error)
                break
            of = f", the last of {count}" if count > 1 else ""
            session.tell(f"saved {path.name}{of}: {how}")
        yield True


def written_size(size: tuple[int, int]) -> str:
    """A width and a height as text, as in "640x480"."""
    return "{}x{}".format(*size)


def short_date(seconds: float, now: float | None = None) -> str:
    """A local time in at most six characters: the hour today, the day this year, else the year.

    Both times are in seconds since 1970. Empty for a year that the system cannot compute.

    >>> short_date(86_400 * 400, now=86_400 * 20_000)
    '1971'
    """
    try:
        then, today = datetime.fromtimestamp(seconds), datetime.fromtimestamp(now or time.time())
    except (OSError, OverflowError, ValueError):
        return ""
    if then.date() == today.date():
        return f"{then:%H:%M}"
    return f"{then.day} {then:%b}" if then.year == today.year else str(then.year)


@dataclass(frozen=True)
class FileRow(Button):
    """A file, with its kind at the right, and before it the date, unless the name needs the room."""

    row_lines: ClassVar[int] = ROW_LINES
    shown: str = ""
    date: str = ""

    def items(self, lit: bool) -> list[Item]:
        _, top, right, _ = self.area
        room = CHARACTERS - LONGEST_KIND - LONGEST_DATE - 2
        note = f"{self.date} {self.value:>{LONGEST_KIND}}" if len(self.shown) <= room else self.value
        name = fitted(self.shown, CHARACTERS - len(self.value) - 1)
        start = right + 1 - MARGIN - CHARACTER * len(note)
        ground = SLATE if lit else NIGHT
        return [*self.row(lit, name), text(note, start, top + TEXT_DOWN, LIGHT_GRAY, ground)]
