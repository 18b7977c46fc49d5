"""The studio: an editing session that connects one scene to one display.

Like the host computer of the paper, it only sends RAMTEK instructions through a host port, and never accesses
the display's memories directly. Each edit makes a new scene; comparing it with the previous scene tells what
must be recomputed and sent.

| changed | sent to the display |
|---|---|
| mesh, view, parts, lights, ambient, D, S, reflection model, two_sided | all words |
| mapping, scaling, exposure, dither, numbers of levels | all words, the entries that differ |
| the name of the scalar, what it is computed with | all words |
| limits, bands and shades of the scalar, the surfaces that it colors | all words, the entries that differ |
| object color, light color, blend, light percentage | the entries of one range, no words |
| color scale, the colors below, above and of missing values | the entries of the colored surfaces, no words |
| contrast, background | the entries that differ, no words |
| the legend switched on or off | all words |

Where words stand for normals (`normals`), a light, ambient, D, S and a reflection model send the entries that
differ, no words, and so do mapping, scaling and exposure. No light plane is computed for that: the picture is
rendered when it is asked for.

The legend of a scalar is drawn over the words, after them and again whenever it changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from time import perf_counter
from typing import NoReturn, Unpack

from autocolor.arrays import Bytes, Words
from autocolor.checks import nearest
from autocolor.errors import UsageError
from autocolor.images import display_image
from autocolor.journal.history import History
from autocolor.journal.studio_session import StudioSession
from autocolor.lighting.picking import highlight_of, highlight_placed
from autocolor.lighting.picture import Picture
from autocolor.mapping.display_image import DisplayImage, words_by_line
from autocolor.mapping.intensity import held_exposure
from autocolor.mapping.ranges import LevelRange
from autocolor.rendering import block_for, blocks_of, rendering, sees_the_same
from autocolor.scene.changes import LightChanges, PaintChanges, ScalarChanges, SurfaceChanges, ViewChanges
from autocolor.scene.columns import Tier, fields_of
from autocolor.scene.scene import AUTO, LEVELS, NORMALS, Scene, cost_of_edit
from autocolor.scene.surfaces import Paint
from autocolor.sending import configuration_of, send_image, shown_colors
from autocolor.visibility.visible_points import Seen, Sight, seen_at
from ramtek_emu import HostPort


class Studio(StudioSession):
    """A scene shown on a display, which can be edited step by step, with undo and redo.

    `display` is a host port: a `Ramtek9300`, a `TcpPort` to one, or a `Recorder`. It is reset and sent the
    whole picture; each edit then sends only what changed. An edit that raises an error changes nothing.
    """

    def __init__(self, scene: Scene | History, display: HostPort) -> None:
        """Show a scene, or go on with the history of a session, such as that of a journal."""
        self._history = scene if isinstance(scene, History) else History(scene)
        scene = self._history.scene
        configuration = configuration_of(display)
        self._display = display
        self._size = configuration.shown_lines, configuration.shown_elements
        begun = perf_counter()
        self._rendering = rendering(scene, *self._size)
        self._shown = display_image(scene, self._rendering.picture)
        self._pace = 1, perf_counter() - begun
        """The block of the last picture that was computed from scratch, and the seconds it took."""
        self.sends = True
        """Whether edits are sent to the display; programs that draw over the picture send it themselves."""
        self.send_everything()

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self._shown.scene

    @property
    def picture(self) -> Picture:
        """The current picture; of a half or a quarter of the lines and elements while `is_coarse`."""
        if not self._shown.has_light_in_words:
            self._light_picture()
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
    def image(self) -> DisplayImage:
        """What is shown: the words, the entries, and what they mean."""
        return self._shown

    def image_of(self, scene: Scene) -> DisplayImage:
        """What another scene would look like on the display; the present one stays, and nothing is sent.

        What both have in common is neither computed nor stored again: if they differ in colors only, `words`
        is the same array. Raises InputError if the scene cannot be rendered.
        """
        picture = rendering(scene, *self._size, self._rendering).picture
        return display_image(scene, picture, self._shown)

    @property
    def sight(self) -> Sight:
        """What the pixels of the display see of the scene, for `lighting.rims` and the methods below."""
        return Sight(self.scene, self._rendering.points, self._shown.block)

    def seen_at(self, line: int, element: int) -> Seen | None:
        """What is seen at a pixel of the display; None on the background."""
        return seen_at(self.sight, line, element)

    def highlight_of(self, light: str, surface: str | None = None) -> tuple[int, int] | None:
        """The line and element where a light's highlight is, on one surface or on all; None if nowhere.

        This is the pixel with the largest cos(E), wherever the light is: also for one that follows the eye or
        another light, or is at infinity. Raises UsageError for an unknown light or surface.

            studio.place_highlight("key", 200, 320)
            studio.highlight_of("key", studio.seen_at(200, 320).surface)   # (200, 320)
        """
        return highlight_of(self.sight, light, surface)

    def place_highlight(self, light: str, line: int, element: int) -> None:
        """Move a light so that the middle of its highlight, cos(E) = 1, is at what is seen at a pixel.

        The light keeps its distance from that point. One with an aim is aimed at the point, the direction of
        one that has a direction leads there, and a point source stays one; what the light follows stays, too.
        One step to undo; for drags, `edit` with `highlight_placed`. Raises UsageError for an unknown light, a
        pixel that is not there, the background, and where the surface turns away from the eye.
        """
        self.edit(highlight_placed(self.scene, self.seen_at(line, element), light))

    def recolor(self, surface: str, /, **changes: Unpack[PaintChanges]) -> None:
        """Change the colors of a surface; this sends entries, but no words.

        `changes` are fields of its Paint: object_color and light_color ("#rrggbb", a name, or three whole
        numbers), blend, light_percentage.
        """
        known = fields_of(Paint)
        for name in changes:
            if name not in known:
                raise UsageError(f"recolor takes fields of a Paint, not {name!r}{nearest(name, known)}")
        scene = self.scene.with_paint(surface, **changes)
        if scene is not self.scene:
            self._take(scene, Tier.ENTRIES)

    def surface(self, name: str, /, **changes: Unpack[SurfaceChanges]) -> None:
        """Change fields of a surface, including those of its reflectance and its paint."""
        self.edit(self.scene.with_surface(name, **changes))

    def light(self, name: str, /, **changes: Unpack[LightChanges]) -> None:
        """Change fields of a light."""
        self.edit(self.scene.with_light(name, **changes))

    def add_light(self, name: str, /, **fields: Unpack[LightChanges]) -> None:
        """Add a light after the others; it must have a position. Its planes alone are computed."""
        self.edit(self.scene.with_new_light(name, **fields))

    def remove_light(self, name: str) -> None:
        """Remove a light; nothing but the sum of the others is computed."""
        self.edit(self.scene.without_light(name))

    def view(self, /, **changes: Unpack[ViewChanges]) -> None:
        """Change fields of the view; everything is recomputed."""
        self.edit(self.scene.with_view(**changes))

    def scalar(self, *none: None, **changes: Unpack[ScalarChanges]) -> None:
        """Change fields of the scalar that colors the surfaces; `scalar(None)` gives them their own colors.

        The first time it must be given a name: one of the mesh's, or a computed one. Another color scale
        sends entries, but no words; limits, bands and shades render nothing.
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
        """Let words stand for normals, so that lights change entries alone; or for levels again.

        Lights and the eye are then taken as far away, and what depends on the place of a point is left out:
        see `mapping.normals.far_light`. Raises InputError where a scalar colors surfaces.
        """
        self.edit(self.scene.replace(words=NORMALS if on else LEVELS))

    def hold_exposure(self, ranges: Mapping[str, Sequence[float]] | None = None) -> None:
        """Keep the intensity ranges of the current picture, so that less light looks darker from now on.

        If `ranges` are given, as by a journal, these are kept: a minimum and a maximum by the surface's name.
        """
        if ranges is None:
            self.refine()
            held = held_exposure(self._shown.mapped, self.scene.scaling, self.scene.exposure)
            self.edit(self.scene.replace(exposure=held))
        else:
            self.edit(self.scene.replace(exposure=ranges))

    def release_exposure(self) -> None:
        """Let the intensity ranges follow the picture again."""
        self.edit(self.scene.replace(exposure=AUTO))

    def edit(self, scene: Scene, same_step: bool = False, moving: bool = False) -> None:
        """Make a scene the current one; nothing happens if it equals the current one.

        With `same_step`, this edit and the previous one are undone together, as for the many edits of a drag.
        With `moving`, a picture that would take too long for a movement (see `pacing`) is computed at a half
        or a quarter of its lines and elements; call `refine` when the movement rests.
        """
        costs = cost_of_edit(self.scene, scene)
        if costs is not None:
            self._take(scene, costs, same_step, moving)

    @property
    def is_coarse(self) -> bool:
        """Whether the picture was computed coarsely during a movement, and not yet refined."""
        return self._shown.block > 1

    def refine(self) -> None:
        """Compute a coarse picture again at all lines and elements, and send it; the scene stays."""
        if self.is_coarse:
            self._show(self.scene, Tier.FRAME)

    def undo(self) -> bool:
        """Undo the last step; returns False if there is none."""
        return self._step(self._history.to_undo, self._history.undo)

    def redo(self) -> bool:
        """Redo the last undone step; returns False if there is none."""
        return self._step(self._history.to_redo, self._history.redo)

    def watch(self) -> Iterator[tuple[int, Words]]:
        """The lines of the picture from the top, each computed when it is asked for (see `words_by_line`).

        All lines together are the `words` of that moment. Nothing is sent but a refined picture.

            for line, words in studio.watch():
                display.send(instructions.write_image(words, top=line))
        """
        self.refine()
        return words_by_line(self._shown)

    def send_everything(self) -> None:
        """Reset the display and send all entries and all words."""
        send_image(self._display, self._shown)

    def _take(self, scene: Scene, costs: Tier, same_step: bool = False, moving: bool = False) -> None:
        """Make a scene the current one by an edit of a cost, and note the step."""
        self._show(scene, costs, moving)
        self._history.take(scene, same_step)

    def _step(self, scenes: Sequence[Scene], move: Callable[[], None]) -> bool:
        if not scenes:
            return False
        self._show_scene(scenes[-1])
        move()
        return True

    def _show_scene(self, scene: Scene) -> None:
        self._show(scene, cost_of_edit(self.scene, scene) or Tier.NOTHING)

    def _show(self, scene: Scene, costs: Tier, moving: bool = False) -> None:
        """Recompute and send what an edit changed. If that raises an error, the session is unchanged."""
        before, rendered, block = self._shown, self._rendering, self._shown.block
        begun = perf_counter()
        if costs >= Tier.MIX or scene.words != before.scene.words:
            if not moving:
                block = 1
            elif costs == Tier.FRAME:
                block = block_for(blocks_of(*self._size), *self._pace)
            # Else what is visible stays: what was computed for it is used again.
            if not (block == before.block and _differs_in_light_alone(before, rendered.scene, scene)):
                lines, elements = (size // block for size in self._size)
                rendered = rendering(scene, lines, elements, rendered)
        now = display_image(scene, rendered.picture, before, block)
        if self.sends:
            send_image(self._display, now, before)
        self._rendering, self._shown = rendered, now
        if costs == Tier.FRAME:
            self._pace = block, perf_counter() - begun

    def _light_picture(self) -> None:
        """Render what edits of lights left out while words stand for normals; nothing is sent."""
        shown = self._shown
        lines, elements = (size // shown.block for size in self._size)
        rendered = rendering(self.scene, lines, elements, self._rendering)
        if rendered.picture is not shown.picture:
            self._shown = display_image(self.scene, rendered.picture, shown, shown.block)
        self._rendering = rendered

    def _repr_png_(self) -> bytes:
        from ramtek_emu.png import png_bytes

        return png_bytes(shown_colors(self._shown))

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "a studio cannot be pickled or copied, because it is connected to a display; pickle its scene,"
            " and make a Studio of that and a display"
        )

    def __repr__(self) -> str:
        undo, redo = len(self._history.to_undo), len(self._history.to_redo)
        return f"Studio({self.scene.name!r}, to undo {undo}, to redo {redo})"


def _differs_in_light_alone(before: DisplayImage, rendered: Scene, scene: Scene) -> bool:
    """Whether words stand for normals in an image and still do in a scene that sees what was rendered."""
    return not before.has_light_in_words and scene.words == NORMALS and sees_the_same(rendered, scene)
