"""The studio: an editing session that connects one scene to one display.

Like the host computer of the paper, a studio only sends RAMTEK instructions through a host port, and never
accesses the display's memories. Each edit makes a new scene. The studio compares it with the previous scene,
computes what differs, and sends it.

| the edit changes | the studio sends |
|---|---|
| mesh, stage, view, parts, lights, ambient, D, S, reflection model, two_sided | all words |
| mapping, scaling, exposure, dither, numbers of levels | all words, the entries that differ |
| the name of the scalar, what it is computed with | all words |
| limits, bands and shades of the scalar, the surfaces with its colors | all words, the entries that differ |
| object color, light color, blend, light percentage | the entries of one range, no words |
| color scale, the colors below, above and of missing values | the entries of the colored surfaces, no words |
| contrast, background, the colors of the backdrop | the entries that differ, no words |
| the legend switched on or off | all words |

While words stand for normals (`normals`), an edit of a light, ambient, D, S, a reflection model, mapping,
scaling or exposure sends the entries that differ and no words. Such an edit computes no light plane: the
picture is rendered when a program asks for it.

The legend of a scalar is sent after the words, and again whenever it changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import fspath
from os.path import abspath
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal, NoReturn, Unpack

from autocolor.arrays import Bytes, Words
from autocolor.budget import allowing, validated_limit
from autocolor.checks import Suggesting
from autocolor.errors import AutocolorError, UsageError, warn_of_edit
from autocolor.explanation.explain import Explanation, explain
from autocolor.files.stamps import stamp_of
from autocolor.images import display_image, save_image
from autocolor.journal.history import History, Move, Show, is_picture
from autocolor.journal.places import NO_STAMP, Source, opened, resolved
from autocolor.journal.timeline import have_one_look
from autocolor.lighting.picking import highlight_of, highlight_placed
from autocolor.lighting.picture import Picture
from autocolor.mapping.display_image import DisplayImage, words_by_line
from autocolor.mapping.intensity import held_exposure, stage_surfaces
from autocolor.mapping.ranges import LevelRange
from autocolor.rendering import Rendering, block_for, blocks_of, rendering, sees_the_same
from autocolor.scene.changes import LightChanges, PaintChanges, ScalarChanges, SurfaceChanges, ViewChanges
from autocolor.scene.columns import Tier
from autocolor.scene.scene import LEVELS, NORMALS, Scene, cost_of_edit, unseen_recoloring
from autocolor.sending import configuration_of, send_image, shown_colors
from autocolor.threads import alone, for_one_thread
from autocolor.visibility.visible_points import Seen, Sight, seen_at
from autocolor.web.notebook import Widgets
from ramtek_emu import HostPort, Ramtek9300

if TYPE_CHECKING:
    from os import PathLike

    from anywidget import AnyWidget

    from autocolor.journal.history import Variants
    from autocolor.journal.saving import SavedFiles
    from autocolor.journal.timeline import Timeline, Way
    from autocolor.scene.changes import SceneChanges
    from autocolor.scene.creation import SurfaceSource


@for_one_thread
class Studio(Suggesting):
    """A scene shown on a display, which can be edited step by step, with undo and redo.

    `display` is a host port: a `Ramtek9300`, which is also made if none is given, a `TcpPort` to one, or a
    `Recorder`. It is reset and sent the whole picture; each edit then sends only what changed. An edit that
    raises an error changes nothing. While a thread is in a method of the studio, any method raises UsageError
    in another thread.
    """

    def __init__(
        self,
        scene: Scene | History,
        display: HostPort | None = None,
        *,
        limit: float | None = None,
        sends: bool = True,
    ) -> None:
        """Show a scene, or go on with a session, such as the history of a journal.

        `limit` is a factor for the memory budget of this studio: of its pictures, and of files that it opens.
        With `sends=False` nothing is sent: the program sends the picture itself, and draws over it.
        """
        self._limit = validated_limit(limit)
        self._history = scene if isinstance(scene, History) else History(scene)
        scene = self._history.scene
        self._display = Ramtek9300() if display is None else display
        configuration = configuration_of(self._display)
        self._size = configuration.shown_lines, configuration.shown_elements
        self._widgets = Widgets(self, *self._size)
        begun = perf_counter()
        self._rendering = self._rendered(scene, *self._size)
        self._shown = display_image(scene, self._rendering.picture)
        self._pace = 1, perf_counter() - begun
        """The block of the last picture that was computed whole, and the seconds that took."""
        self.sends = sends
        if sends:
            self.send_everything()

    @property
    def display(self) -> HostPort:
        """The display that shows the scene."""
        return self._display

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self._shown.scene

    @property
    def history(self) -> History:
        """The steps of the session, with the scenes to undo and to redo."""
        return self._history

    @property
    def picture(self) -> Picture:
        """The current picture; while `is_coarse`, it has a half or a quarter of the lines and elements."""
        if not self._shown.has_light_in_words:
            self._render_lights()
        return self._shown.picture

    @property
    def level_ranges(self) -> Mapping[str, LevelRange]:
        """The level range of each surface in use, by name."""
        return self._shown.ranges

    @property
    def words(self) -> Words:
        """The words of the current picture, (lines, elements) uint16, read-only."""
        return self._shown.words

    @property
    def entries(self) -> Bytes:
        """The entries of the lookup table, (1024, 3) uint8, read-only."""
        return self._shown.entries

    @property
    def display_image(self) -> DisplayImage:
        """The image on the display: the words, the entries, and their meaning."""
        return self._shown

    def image_of(self, scene: Scene) -> DisplayImage:
        """The image of another scene for the display; the current scene stays, and nothing is sent.

        Everything that both scenes share is neither computed nor stored again: if they differ in colors only,
        `words` is the same array. Raises InputError if the scene cannot be rendered.
        """
        picture = self._rendered(scene, *self._size, self._rendering).picture
        return display_image(scene, picture, self._shown)

    @property
    def sight(self) -> Sight:
        """The visible points of the scene at the pixels of the display, for the methods below."""
        return Sight(self.scene, self._rendering.points, self._shown.block)

    def seen_at(self, line: int, element: int) -> Seen | None:
        """The point, normal and surface that a pixel of the display shows; None on the background."""
        return seen_at(self.sight, line, element)

    def explain(self, line: int, element: int) -> Explanation:
        """Why a pixel of the display looks as it does: every number from the nodes to the color.

        A coarse picture is refined first. `to_plain` makes dictionaries of the explanation. Raises UsageError
        if there is no such line or element.
        """
        self.refine()
        return explain(self.sight, self._shown, line, element)

    def highlight_of(self, light: str, surface: str | None = None) -> tuple[int, int] | None:
        """The line and element of a light's highlight, on one surface or on all; None without a highlight.

        This is the pixel with the largest cos(E). The light may follow the eye or another light, or be at
        infinity. Raises UsageError for an unknown light or surface.

            studio.place_highlight("key", 200, 320)
            studio.highlight_of("key", studio.seen_at(200, 320).surface)   # (200, 320)
        """
        return highlight_of(self.sight, light, surface)

    def place_highlight(self, light: str, line: int, element: int) -> None:
        """Move a light so that the middle of its highlight, cos(E) = 1, is at the point that a pixel shows.

        The light keeps its distance from the point, and follows the same thing. Its aim or direction, if it
        has one, leads to the point. This is one step to undo; for drags, use `edit` with `highlight_placed`.
        Raises UsageError for an unknown light, a pixel outside of the display, the background, and a point
        where the surface turns away from the eye.
        """
        self.edit(highlight_placed(self.scene, self.seen_at(line, element), light))

    def recolor(self, surface: str, /, *colors: NoReturn, **changes: Unpack[PaintChanges]) -> None:
        """Change the colors of a surface; this sends entries, but no words.

        `changes` are fields of its Paint: object_color and light_color ("#rrggbb", a name, or three whole
        numbers), blend, light_percentage; or a ramp. A ramp replaces the two colors and their blend, and any
        of these replaces a ramp; the others then have their defaults. An EditWarning says if the surface has
        these colors already, or no polygons.

            studio.recolor("body", ramp=["#200", "#f60", "#fff"])
        """
        scene = self.scene.with_paint(surface, *colors, **changes)
        warn_of_edit(unseen_recoloring(self.scene, scene, surface))
        if scene is not self.scene:
            self._show_scene(scene, lambda: self._history.take(scene), Tier.ENTRIES)

    def surface(self, name: str, /, **changes: Unpack[SurfaceChanges]) -> None:
        """Change fields of a surface, including those of its reflectance and its paint."""
        self.edit(self.scene.with_surface(name, **changes))

    def light(self, name: str, /, **changes: Unpack[LightChanges]) -> None:
        """Change fields of a light."""
        self.edit(self.scene.with_light(name, **changes))

    def add_light(self, name: str, /, **fields: Unpack[LightChanges]) -> None:
        """Add a light after the others; it must have a position. Only its light planes are computed."""
        self.edit(self.scene.with_new_light(name, **fields))

    def remove_light(self, name: str) -> None:
        """Remove a light; only the sum of the other lights is computed."""
        self.edit(self.scene.without_light(name))

    def view(self, /, **changes: Unpack[ViewChanges]) -> None:
        """Change fields of the view; everything is recomputed."""
        self.edit(self.scene.with_view(**changes))

    def save_view(self, name: str | None = None) -> str:
        """Save the view under a name, to come back to by `take_view`; returns the name.

        A named view of this name is replaced. Without a name it is a new one, like "view 1". Nothing is sent.
        """
        scene = self.scene.with_saved_view(name)
        self.edit(scene)
        return scene.views[-1].name if name is None else name

    def take_view(self, name: str) -> None:
        """Make a named view the view. Raises UsageError for an unknown name."""
        self.edit(self.scene.with_taken_view(name))

    def remove_view(self, name: str) -> None:
        """Remove a named view; the view stays. Raises UsageError for an unknown name."""
        self.edit(self.scene.without_named_view(name))

    def scalar(self, *none: None, **changes: Unpack[ScalarChanges]) -> None:
        """Change fields of the scalar that colors the surfaces; after `scalar(None)` they have their paint.

        The first time, give a name: a scalar of the mesh, or a computed scalar. Another color scale sends
        entries, but no words; limits, bands and shades render nothing.
        """
        if not none:
            self.edit(self.scene.with_scalar(**changes))
            return
        if none != (None,) or changes:
            raise UsageError(
                "scalar takes fields of a Scalar, or None alone; write it as in scalar(name='z', bands=8)"
            )
        self.edit(self.scene.without_scalar())

    def normals(self, on: bool = True) -> None:
        """Let words stand for normals, so that edits of lights send only entries; or for levels again.

        All points with one normal then have one intensity: lights and the eye count as far away. Raises
        InputError if a scalar colors surfaces.
        """
        self.edit(self.scene.replace(words=NORMALS if on else LEVELS))

    def stage(
        self,
        stage: Literal["none", "floor", "bowl"],
        backdrop: str | Sequence[str | Sequence[int]] | None = None,
    ) -> None:
        """Stand the object on a floor or in a bowl, before a `backdrop` of two colors, or of grays.

        If only the colors change, entries are sent, but no words. The surface "stage" can be recolored.

            studio.stage("bowl", ["#223", "#889"])
        """
        self.edit(self.scene.replace(stage=stage, backdrop=backdrop))

    def hold_exposure(self, ranges: Mapping[str, Sequence[float]] | None = None) -> None:
        """Hold the intensity ranges of the current picture, so that less light looks darker from now on.

        Other `ranges` can be given: a minimum and a maximum by the name of the surface.
        """
        if ranges is not None:
            self.edit(self.scene.replace(exposure=ranges))
            return
        self.refine()
        exposure = held_exposure(
            self._shown.mapped, self.scene.scaling, self.scene.exposure, stage_surfaces(self.scene)
        )
        self.edit(self.scene.replace(exposure=exposure))

    def release_exposure(self) -> None:
        """Return to the exposure before all ranges were held; if there is none, ranges follow the picture.

        If only ranges of some surfaces are held, all ranges follow the picture again.
        """
        self.edit(self.scene.replace(exposure=self._history.released_exposure))

    def edit(self, scene: Scene, same_step: bool = False, moving: bool = False) -> None:
        """Make a scene the current one; nothing happens if it equals the current one.

        With `same_step`, this edit and the previous one are undone together, like the many edits of a drag.
        With `moving`, a picture that would take too long for a movement (see `block_for`) is computed at a
        half or a quarter of its lines and elements; call `refine` when the movement rests.
        """
        costs = cost_of_edit(self.scene, scene)
        if costs is not None:
            self._show_scene(scene, lambda: self._history.take(scene, same_step), costs, moving)

    @property
    def is_coarse(self) -> bool:
        """Whether the picture was computed coarsely during a movement, and not yet refined."""
        return self._shown.block > 1

    def refine(self) -> None:
        """Compute a coarse picture again at all lines and elements, and send it; the scene stays."""
        if self.is_coarse:
            self._show(self.scene, Tier.FRAME)
            self._widgets.refresh()

    def undo(self, steps: int = 1) -> bool:
        """Undo the last step, or some steps at once; returns False if there are not so many.

        The present view stays. Edits of the view alone are no steps: see `view_back`.
        """
        return self._move("undo", steps)

    def redo(self, steps: int = 1) -> bool:
        """Redo the next undone step, or some steps at once; returns False if there are not so many."""
        return self._move("redo", steps)

    def view_back(self) -> bool:
        """Return to the view before; returns False if there is none since the scene was opened."""
        return self._move("view_back")

    def view_forward(self) -> bool:
        """Return to the view that `view_back` left; returns False if there is none."""
        return self._move("view_forward")

    def go_on(self, history: History) -> None:
        """Go on with another session, such as the history of a journal; this session stays as it is."""
        self._show_scene(history.scene, lambda: setattr(self, "_history", history))

    def take_back(self) -> None:
        """Take the last edit and its gesture back, as if they had not been made."""
        before = self._history.before_gesture
        if before is not None:
            self.edit(before.present.scene, same_step=True)

    @property
    def is_changed(self) -> bool:
        """Whether the scene differs from the scene in the file that `save_session` would write again.

        A scene without a file is compared with the scene that was opened or marked as saved last.
        `history.left_unsaved` names the other scenes of the session with unsaved changes.
        """
        return self._history.is_changed

    @property
    def variants(self) -> Variants:
        """The variants by name, each a scene and its place."""
        return self._history.variants

    def keep_variant(self, name: str | None = None) -> str:
        """Make the current scene a variant; returns its name, a free letter if None is given.

        Undo and redo leave the variants alone. Raises UsageError if the name is in use.
        """
        name = self.variants.free_name() if name is None else name
        self._history.keep(name)
        return name

    def show_variant(self, name: str) -> None:
        """Make a variant the current scene, by one step to undo, in the present view.

        A variant of another scene that was opened has its own view. Nothing happens if they are equal.
        """
        after = self._history.shown(name)
        if not after.present.scene.equals(self.scene):
            self._go(after, Show(name))

    def rename_variant(self, name: str, to: str) -> None:
        """Give a variant another name. Raises UsageError for an unknown name, and if `to` is in use."""
        self._history.rename(name, to)

    def drop_variant(self, name: str) -> None:
        """Drop a variant. Raises UsageError for an unknown name."""
        self._history.drop(name)

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
        """Read a scene (see `read_scene`) and make it the current one, by one step to undo.

        If it is the file of the current scene and still has its look, there is no step: the view alone
        becomes that of the file. Undo also brings back the files to which `save_session` saves. The script of
        a session gives the `tables` that the scene had, because the file may have been saved over since, and
        the `checksum` of the scene. Raises InputError if the scene has another checksum.
        """
        source = Source(fspath(path), up, surfaces, scale)
        before = self._history.place.source
        is_same_file = before is not None and resolved(before) == resolved(source)
        known = self.scene if is_same_file else None, self._history.on_disk.scene_of(source)
        with allowing(self._limit):
            scene = opened(source, tables, checksum, known)
        if is_same_file and have_one_look(scene.scene, self.scene):
            self.edit(self.scene.replace(view=scene.scene.view))
            return
        self._show_scene(scene.scene, lambda: self._history.open(scene, source))

    @property
    def file(self) -> Path | None:
        """The scene file or the store that `save_session` writes again; None for a scene in no such file."""
        return next((Path(path) for path in self._history.files if not is_picture(path)), None)

    def reopen(self) -> bool:
        """Read the scene's file again, by one step to undo; returns False if the scene is still the same.

        A file that another program changed may be saved to again after this. Raises UsageError if there is no
        such file, InputError if it cannot be read.
        """
        path, source = self.file, self._history.place.source
        if path is None:
            raise UsageError("the scene must be in a file to be read again, and it is in none; save it")
        source = Source(str(path), surfaces="materials" if source is None else source.surfaces)
        with allowing(self._limit):
            again = opened(source, known=(self.scene, self._history.on_disk.scene_of(source)))
        if again.scene.equals(self.scene):
            if again.place.stamp is not None and self._history.on_disk.was_changed(str(path)):
                self._history.mark_saved({str(path): again.place.stamp}, is_own=False)
            return False
        self._show_scene(again.scene, lambda: self._history.open(again, source))
        return True

    def save(self, path: str | PathLike[str], overwrite: bool = False) -> None:
        """Write the picture with its scene to a picture file; `save_session` writes it again.

        A scene that has no scene file or store is then saved. Raises OutputError if another program changed
        the file since the studio read or wrote it.
        """
        from autocolor.files.picture_file import write_picture
        from autocolor.files.writing import no_guard

        self.refine()
        guard = self._history.on_disk.guard if overwrite else no_guard
        write_picture(path, self.scene, self.picture, overwrite=overwrite, guard=guard)
        self._mark_written(path)

    def save_scene(self, path: str | PathLike[str], overwrite: bool = False) -> None:
        """Write the scene to a scene file or a store (see `write_scene`); `save_session` writes it again.

        Raises OutputError if another program changed the file since the studio read or wrote it: `reopen`
        shows the change, and permits to save.
        """
        from autocolor.files.scene_writing import write_scene

        guard = self._history.on_disk.guard
        *_, file = write_scene(path, self.scene, overwrite=overwrite, guard=guard)
        self._mark_written(file)

    def save_session(self, folder: str | PathLike[str] = ".", name: str | None = None) -> SavedFiles:
        """Save the scene and the picture to their files, or to new files in the folder; returns the files.

        With a `name`, both files are new: `NAME/scene.toml` and `NAME.npz`. The scene takes the name, as one
        step to undo, and is saved to these files from then on. No file of another program is lost (see
        `journal.saving`). Raises UsageError for an invalid name, OutputError if a file has the name.
        """
        from autocolor.journal.saving import new_files, save_session

        self.refine()
        before = self.scene
        if name is not None:
            new_files(Path(folder), name)
            self.edit(before.replace(name=name))
        try:
            return save_session(self._history, self.picture, Path(folder), name)
        except AutocolorError:
            # A scene that was not saved keeps its former name.
            if self.scene is not before:
                self.undo()
            raise

    def save_image(
        self, path: str | PathLike[str], *, smooth: int | None = None, overwrite: bool = False
    ) -> None:
        """Write the scene to a PNG file for people, as large as the display, with the legend of a scalar.

        Each pixel is the mean of `smooth` x `smooth` pixels, by default of 2 x 2. With 1, it is the image on
        the display. Raises the errors of `autocolor.save_image`.
        """
        with allowing(self._limit):
            save_image(path, self.scene, size=self._size[::-1], smooth=smooth, overwrite=overwrite)

    def mark_saved(self, files: Mapping[str, str] | None = None) -> None:
        """Mark the current scene as saved to files, by their paths and stamps (see `files.stamps`).

        Without `files`, the scene's present file counts as written by the calling program.
        """
        if files is not None or not self._history.files:
            self._history.mark_saved(files or {})
        else:
            self._mark_written(self._history.files[0])

    def _mark_written(self, path: str | PathLike[str]) -> None:
        """Mark the scene as saved to a file, which gets a backup before `save_session` overwrites it."""
        self._history.mark_saved({abspath(path): stamp_of(Path(path)) or NO_STAMP}, is_own=False)

    def journal(
        self,
        path: str | PathLike[str] | None = None,
        *,
        up: str = "z",
        scale: float = 1.0,
        surfaces: SurfaceSource = "materials",
        beside: str | PathLike[str] | None = None,
    ) -> str:
        """The session as a Python script, one line a step, which gives the same scenes when it is run.

        `path` is the file that the first scene was read from; `up`, `scale` and `surfaces` are the keywords
        with which it was read. They are not needed for a session that was recovered or opened by a command. A
        mesh that an edit changed is saved in a folder in `beside`; without `beside`, InputError is raised.
        """
        from autocolor.journal.journal import MeshesBeside
        from autocolor.journal.script import script_of

        source = (
            self._history.first_place.source if path is None else Source(fspath(path), up, surfaces, scale)
        )
        if source is None:
            raise UsageError("a journal must name what its first scene was read from; give its path")
        return script_of(self._history, source, MeshesBeside(None if beside is None else Path(beside)))

    def watch(self) -> Iterator[tuple[int, Words]]:
        """The numbers and words of the lines from the top, computed line by line (see `words_by_line`).

        Together they are the `words` at the time of the call. A coarse picture is refined and sent before;
        nothing else is sent.

            for line, words in studio.watch():
                display.send(instructions.write_image(words, top=line))
        """
        self.refine()
        return words_by_line(self._shown)

    def send_everything(self) -> None:
        """Reset the display and send all entries and all words."""
        send_image(self._display, self._shown)
        self._widgets.refresh()

    def view_window(self, *, full_screen: bool = False, fit: bool = False) -> None:
        """Edit the scene in an interactive window until the user closes it; F1 there lists the keys.

        The steps of the user are steps of the studio, and the display then shows the scene. With `fit`, the
        picture fills the window, and its pixels may become uneven. Raises UnavailableError without a screen.
        """
        from autocolor.commands.window import show_steps

        try:
            with allowing(self._limit):
                show_steps(self._history, full_screen, fit, outlives_window=True)
        finally:
            self._show_scene(self._history.scene, lambda: None)

    def widget(self) -> AnyWidget:
        """A widget for a notebook, which shows the studio and edits it: an `anywidget.AnyWidget`.

        It shows the scene with smooth edges, by words and entries, whatever the display is. What is done in
        the widget is an edit of the studio, which `undo` undoes, and every edit shows in all widgets of the
        studio. `close` ends a widget. Raises UnavailableError without the package anywidget (extra
        `notebook`).
        """
        return self._widgets.new()

    def _move(self, way: Way, steps: int = 1) -> bool:
        """Move some steps on a way of the timeline; returns False if there are not so many."""
        try:
            after = self._history.timeline.moved(way, steps)
        except IndexError:
            return False
        self._go(after, Move(way, steps))
        return True

    def _go(self, after: Timeline, step: Show | Move) -> None:
        """Show the scene of the timeline that a step leads to, and take the step."""
        self._show_scene(after.present.scene, lambda: self._history.go(after, step))

    def _show_scene(
        self, scene: Scene, note: Callable[[], object], costs: Tier | None = None, moving: bool = False
    ) -> None:
        """Show a scene, then note the step in the history, and refresh the widgets."""
        self._show(scene, costs or cost_of_edit(self.scene, scene) or Tier.NOTHING, moving)
        note()
        self._widgets.refresh()

    def _show(self, scene: Scene, costs: Tier, moving: bool = False) -> None:
        """Compute and send the difference to another scene. An error leaves the session unchanged."""
        before, rendered, block = self._shown, self._rendering, self._shown.block
        begun = perf_counter()
        if costs >= Tier.MIX or scene.words != before.scene.words:
            if not moving:
                block = 1
            elif costs == Tier.FRAME:
                block = block_for(blocks_of(*self._size), *self._pace)
            # Otherwise the visible points stay, and are used again.
            if not (block == before.block and _differs_in_light_alone(before, rendered.scene, scene)):
                lines, elements = (size // block for size in self._size)
                rendered = self._rendered(scene, lines, elements, rendered)
        now = display_image(scene, rendered.picture, before, block)
        if self.sends:
            send_image(self._display, now, before)
        self._rendering, self._shown = rendered, now
        if costs == Tier.FRAME:
            self._pace = block, perf_counter() - begun

    def _rendered(
        self, scene: Scene, lines: int, elements: int, before: Rendering | None = None
    ) -> Rendering:
        """The rendering of a scene within the budget of this studio."""
        with allowing(self._limit):
            return rendering(scene, lines, elements, before)

    @alone
    def _render_lights(self) -> None:
        """Render the edits of lights since words stand for normals; nothing is sent."""
        shown = self._shown
        lines, elements = (size // shown.block for size in self._size)
        rendered = self._rendered(self.scene, lines, elements, self._rendering)
        if rendered.picture is not shown.picture:
            self._shown = display_image(self.scene, rendered.picture, shown, shown.block)
        self._rendering = rendered

    def _repr_png_(self) -> bytes:
        from ramtek_emu.png import png_bytes

        return png_bytes(shown_colors(self._shown))

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "a studio cannot be pickled or copied, because it is connected to a display; pickle its scene,"
            " and make a Studio of that"
        )

    def __repr__(self) -> str:
        undo, redo = len(self._history.to_undo), len(self._history.to_redo)
        return f"Studio({self.scene.name!r}, to undo {undo}, to redo {redo})"


def _differs_in_light_alone(before: DisplayImage, rendered: Scene, scene: Scene) -> bool:
    """Whether words stand for normals in the image and the scene, and both have the same visible points."""
    return not before.has_light_in_words and scene.words == NORMALS and sees_the_same(rendered, scene)
