"""The session on the screens: the studio, what is chosen, which screen is shown, and the message.

Every screen edits the scene through `edit`: so a gesture is one step to undo, and its pictures may be coarse
until it ends.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

from autocolor.arrays import Words
from autocolor.errors import InputError
from autocolor.files.palette_file import Palette
from autocolor.journal.autosave import Autosave
from autocolor.mapping.display_image import DisplayImage
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface
from autocolor.scene.view import View
from autocolor.screens.cached import Cached
from autocolor.screens.comparing import Comparing
from autocolor.studio import Studio
from autocolor.widgets.rows import TableNames, World
from autocolor.widgets.widget import Entry
from ramtek_emu import HostPort
from ramtek_emu.errors import escaped

PICTURE: Final = "picture"
MIXING: Final = "mixing"
BLENDING: Final = "blending"
HISTORY: Final = "history"
SPLIT: Final = "split"
EXPLAIN: Final = "explain"
SENT: Final = "sent"
"""The names of screens to which other screens turn. A session begins with the picture, and returns to it."""

MESSAGE_SECONDS: Final = 5.0
"""Assumed: how long a message is shown."""

LEAST_SECONDS: Final = 1.0
"""Assumed: how long a message is shown at least while the pointer moves from thing to thing."""


class Offer(NamedTuple):
    """An action that a message offers: the label of its button, and the action."""

    label: str
    run: Callable[[], object]


class Message(NamedTuple):
    """A message, whether it is a warning, and when it was shown first."""

    text: str
    is_warning: bool
    shown_at: float
    persistent: bool = False
    """Whether it is shown until the next action, or until the menu comes."""
    seconds: float = MESSAGE_SECONDS
    """How long it is shown if it is not persistent."""
    offer: Offer | None = None
    """An action whose button stands beside the message."""


NO_NEWS: Final = Message("", False, 0.0)


class Clipboard(NamedTuple):
    """The clipboard of the user's window. `copy` returns whether it took a text; `paste` returns its text."""

    copy: Callable[[str], bool]
    paste: Callable[[], str]


class Solo(NamedTuple):
    """A light that was switched on alone, and whether each light was on before, by name."""

    name: str
    switches: Mapping[str, bool]


class LastEdit(NamedTuple):
    """The last edit that was shown, and the words that it sent to the display.

    At first this is the opening of the scene; `before` is then the same scene.
    """

    before: Scene
    after: Scene
    words: Words
    """The instructions that changed the entries and the words of the picture, (n,) uint16, read-only.

    At most the words of one page are held: the array that was sent.
    """
    other_words: int
    """The number of further words for the same page: for menus, panels and the legend.

    If the edit did not change the words of the picture, and another screen turned to the picture, they also
    include the picture. The words of edits on screens without the picture are sent when it is shown again:
    then these edits are the last edit.
    """


@dataclass(eq=False, repr=False)
class Session:
    """The state that the screens share.

    New files are saved to `folder`, which the file screen shows. It begins as `root`.
    """

    studio: Studio
    display: HostPort
    root: Path
    folder: Path = field(init=False)
    comparing: Comparing = field(init=False)
    """Another state that is shown in place of the present one."""
    screen: str = PICTURE
    """The name of the screen that is shown; setting it turns to another screen."""
    compared_from: str = PICTURE
    """The screen to return to when comparing by a key ends."""
    news: Message = NO_NEWS
    """The last message."""

    # The user.
    has_keyboard: bool = False
    """Whether the user has a keyboard."""
    clipboard: Clipboard | None = None
    """The clipboard; None on a display elsewhere."""
    is_at_hand: bool = False
    """Whether the user sits at this machine; a pointer from elsewhere stays within `root`."""
    outlives_window: bool = False
    """Whether the steps remain in a studio when the user leaves, who then loses nothing."""
    leaves: bool = False
    """Whether the user asked to leave the program."""
    refused_to_leave: Scene | None = None
    """The scene that the user was last warned about when leaving would have discarded its changes."""
    naming: Entry | None = None
    """A name to ask for, after the action that sets it; see `naming`."""
    keys: Sequence[tuple[str, str]] = ()
    """Each key and what it does, for the help page."""

    # The gesture.
    same_step: bool = False
    """Whether the next edit is undone together with the one before."""
    moving: bool = False
    """Whether the next edit is part of a movement, whose pictures may be coarse."""
    edits: tuple[DisplayImage, Scene] | None = None
    """The image before the last edits, and the scene that they made; see `effects`."""
    last_edit: LastEdit | None = None
    """The last edit, once a page has shown the scene."""

    # The picture.
    watches: bool = False
    """Whether the user asked to see the picture come in line by line."""
    explains: bool = False
    """Whether the next click in the picture explains its pixel."""
    pixel: tuple[int, int] = (0, 0)
    """The line and the element of the pixel that is explained."""
    side_view: tuple[View, str] | None = None
    """The view from a named side that was taken last, and the name of the side."""

    # The chosen things.
    surface: int = 0
    """The number of the chosen surface among the surfaces in use; see `surface_name`."""
    light: str = ""
    """The name of the light that was chosen last; see `light_name`."""
    part_name: str = ""
    """The name of the part that was pointed at last; empty at first."""
    before_solo: Solo | None = None
    """The light that was last switched on alone, and the switches before."""
    own_colors: dict[str, str] = field(default_factory=dict)
    """By the name of a surface: its object color before a key gave it another."""

    # Files.
    autosave: Autosave | None = None
    """The journal of the session in the state folder; None if nobody keeps it."""
    mesh_up: str = "z"
    mesh_scale: float = 1.0
    """The up axis and the scale of mesh files that are opened; other files give their own."""
    seeming_up: Cached[str] = field(default_factory=Cached)
    """The axis that seems to be up in the mesh file that was opened."""
    paints: Palette | None = None
    """The paints that the user brought as a palette file, to take colors from."""
    paints_name: str = ""
    """The name of that file."""

    def __post_init__(self) -> None:
        self.root = self.folder = self.root.resolve()
        self.comparing = Comparing(self.studio)
        self._names = TableNames(lambda table: tuple([row.name for row in vars(self.scene)[table]]), {})
        self._world: Cached[World] = Cached()

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self.studio.scene

    @property
    def world(self) -> World:
        """The bounds of the object, from which bars get their range, and the names of the tables."""
        scene = self.scene
        mesh = scene.staged.mesh

        def world() -> World:
            low, high = (tuple(corner.tolist()) for corner in mesh.bounds)
            return World(*scene.object_bounds, self._names, (low, high))

        return self._world.of(world, mesh, scene.parts)

    def turn_to(self, screen: str) -> None:
        """Turn to a screen by its name."""
        if screen != self.screen:
            self.comparing.end()
        self.screen = screen

    # The message.

    @property
    def message(self) -> str:
        """The text of the last message."""
        return self.news.text

    @property
    def has_news(self) -> bool:
        """Whether there is a message whose time has not passed. While states are compared, no time passes."""
        is_recent = time.monotonic() - self.news.shown_at < self.news.seconds
        return bool(self.news.text) and (is_recent or self.news.persistent or self.comparing.is_on)

    @property
    def news_may_go(self) -> bool:
        """Whether a hint may take the place of the message: it need not stay, and offers nothing."""
        news = self.news
        return self.has_news and not (news.is_warning or news.persistent or news.offer)

    def tell(
        self, message: str, is_warning: bool = False, persistent: bool = False, offer: Offer | None = None
    ) -> None:
        """Show a message for some seconds; with `persistent`, until the next action.

        An empty message takes the last message away. Letters that cannot be printed, as in names of files,
        are escaped.
        """
        now = time.monotonic()
        self.news = Message(escaped(self.shown(message)), is_warning, now, persistent, offer=offer)

    def shown(self, text: object) -> str:
        """A text with paths. Users of another machine do not see the folders above `root`."""
        return str(text) if self.is_at_hand else str(text).replace(str(self.root), self.root.name or "/")

    def warn(self, message: object) -> None:
        """Show an error in one line; of several problems, the first and the number of the others."""
        more = ""
        if isinstance(message, InputError) and len(message.problems) > 1:
            first, *others = message.problems
            message, more = first, f" (and {len(others)} more)"
        self.tell(str(message).replace("\n", "; ") + more, is_warning=True)

    # The chosen surface and light.

    @property
    def surface_name(self) -> str:
        """The name of the chosen surface; empty if the scene has none in use."""
        names = list(self.studio.level_ranges)
        return names[self.surface % len(names)] if names else ""

    @property
    def chosen_surface(self) -> Surface | None:
        """The chosen surface; None if the scene has none in use."""
        return self.scene.surfaces[self.surface_name] if self.surface_name else None

    def choose_surface(self, name: str) -> None:
        """Choose a surface in use by its name; another name changes nothing."""
        names = list(self.studio.level_ranges)
        if name in names:
            self.surface = names.index(name)

    @property
    def light_name(self) -> str:
        """The name of the chosen light; empty if the scene has none."""
        names = [light.name for light in self.scene.lights]
        return self.light if self.light in names else next(iter(names), "")

    @property
    def chosen_light(self) -> Light | None:
        """The chosen light; None if the scene has none."""
        return self.scene.lights[self.light_name] if self.light_name else None

    def choose_light(self, name: str) -> None:
        """Choose a light by its name."""
        self.light = name

    # Edits.

    def edit(self, scene: Scene) -> None:
        """Make a scene the current scene. All edits of a gesture are undone as one step."""
        before = self.studio.display_image
        self.studio.edit(scene, same_step=self.same_step, moving=self.moving)
        if self.studio.scene is not before.scene:
            first = self.edits[0] if self.edits is not None and self.same_step else before
            self.edits = first, self.studio.scene
            # Further edits of the same gesture belong to its step; an edit without a change makes no step.
            self.same_step = True
