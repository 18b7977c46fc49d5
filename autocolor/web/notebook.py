"""The notebook: widgets that show a studio in the cells of a notebook, and edit it.

    studio --> words and entries, with more samples than those of its display --> browser

The widgets have an image of their own: the scene at four samples a pixel, which the browser draws smoothly,
as in a page. The browser receives words only when words changed, and 3,072 bytes of entries after a
recoloring. What a program sends to the display itself is not in the widgets.

The browser sends edits by the keys of `--set`, which become edits of the studio. It applies an edit of colors
at once to its own copy of the entries. It sends the next edit when the last edit is answered, and unites the
edits of a drag that wait for the answer, so that a drag never lags behind the hand.

| trait | value |
|---|---|
| `picture` | the values of the image (`exported.values_of`), the numbers of steps to `undo` and `redo` |
| `words` | the packed words |
| `entries` | the 1,024 entries, three bytes each |

| message of the browser | effect |
|---|---|
| `{"edit": {key: value, ...}, "same_step": bool}` | an edit; with `same_step` it goes on with a drag |
| `{"undo": steps}`, `{"redo": steps}` | undoes or redoes steps |

The answer to each message is `{"answer": sentence}`. The sentence is empty if the message had its effect.
Otherwise the scene is as it was before.
"""

from __future__ import annotations

import base64
import weakref
from collections.abc import Callable
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any, Final, Protocol

from autocolor.checks import is_whole, shown
from autocolor.errors import AutocolorError, UnavailableError, UsageError
from autocolor.files.settings import scene_with
from autocolor.images import display_image
from autocolor.journal.history import History
from autocolor.logs import logger_of
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import is_held
from autocolor.rendering import Rendering, rendering
from autocolor.scene.scene import Scene
from autocolor.web.exported import legend_values, light_rows, packed_words, values_of
from ramtek_emu import RamtekError

if TYPE_CHECKING:
    from anywidget import AnyWidget

LOGGER: Final = logger_of(__name__)

PACKING: Final = 6
"""The effort of zlib for words in a notebook, 1 to 9.

Measured on the coupe: 33.2 kB in 8 ms. With 9, as in a page, it is 31.4 kB in 72 ms: a drag would stutter.
"""

SMOOTH: Final = 2
MOST_SAMPLES: Final = 2_000_000
"""Assumed: the samples along each side of a pixel. With more samples in all, an edit of a light takes too
long, and there is a sample a pixel.

Measured on the coupe at 640 x 480: a light's intensity takes 35 ms with 4 samples a pixel, 12 ms with 1.
"""

FAILED: Final = "the studio failed, and its scene is as it was; the log of the notebook has the reason"

HELD: Final = "Exposure is held: with less light, the picture is darker."
FOLLOWING: Final = "Exposure follows the light. After studio.hold_exposure(), less light looks darker."


class EditedStudio(Protocol):
    """What widgets use of a `Studio`."""

    @property
    def scene(self) -> Scene:
        """The current scene."""

    @property
    def history(self) -> History:
        """The steps of the session."""

    def edit(self, scene: Scene, same_step: bool = False) -> None:
        """Make a scene the current one."""

    def undo(self, steps: int = 1) -> bool:
        """Undo steps; returns False if there are not so many."""

    def redo(self, steps: int = 1) -> bool:
        """Redo steps; returns False if there are not so many."""

    def _repr_png_(self) -> bytes: ...


class Widgets:
    """The widgets of a studio with a display of so many lines and elements."""

    def __init__(self, studio: EditedStudio, lines: int, elements: int) -> None:
        # A strong reference would be a circle, and a studio that is dropped would stay in memory.
        self._studio: EditedStudio = weakref.proxy(studio)
        self._smooth = SMOOTH if SMOOTH**2 * lines * elements <= MOST_SAMPLES else 1
        self._samples = self._smooth * lines, self._smooth * elements
        self._widgets: list[AnyWidget] = []
        self._rendering: Rendering | None = None
        self._image: DisplayImage | None = None
        """The image that the widgets show."""
        self._traits: dict[str, object] = {}
        """The values of the traits of all widgets."""
        self._dragged: Scene | None = None
        """The scene after the last edit of a drag in a widget; a later edit of the drag joins its step."""

    def new(self) -> AnyWidget:
        """Another widget of the studio. Raises UnavailableError without the package anywidget."""
        made = widget_class()
        self._update_traits()
        widget = made(self._studio._repr_png_, **self._traits)
        widget.on_msg(self._answer)
        widget.observe(lambda _: self._remove_closed(), "comm")
        self._widgets.append(widget)
        return widget

    def refresh(self) -> None:
        """Send the browser what changed since the last call: after every step of the studio."""
        if not self._widgets:
            return
        self._update_traits()
        for widget in tuple(self._widgets):
            try:
                # Traits that are equal to those before are not sent; the others are sent in one message.
                with widget.hold_sync():
                    for name, value in self._traits.items():
                        setattr(widget, name, value)
            except Exception:
                # The studio has taken its step: a notebook that is gone must not make it fail.
                LOGGER.exception("a widget could not be refreshed, and is left out from now on")
                self._widgets.remove(widget)
        self._remove_closed()

    def _update_traits(self) -> None:
        """Make the traits that show the present scene of the studio."""
        scene, history, before = self._studio.scene, self._studio.history, self._image
        self._rendering = rendering(scene, *self._samples, self._rendering)
        self._image = image = display_image(scene, self._rendering.picture, before)
        self._traits["picture"] = {
            **values_of(image),
            "smooth": self._smooth,
            "legend": legend_values(image, self._smooth),
            "lights": light_values(scene),
            "undo": len(history.to_undo),
            "redo": len(history.to_redo),
        }
        if before is None or image.words is not before.words:
            self._traits["words"] = packed_words(image.words, PACKING)
        self._traits["entries"] = image.entries.tobytes()

    def _remove_closed(self) -> None:
        """Forget closed widgets, and their image after the last."""
        self._widgets = [widget for widget in self._widgets if widget.comm is not None]
        if not self._widgets:
            self._rendering = self._image = None

    def _answer(self, widget: AnyWidget, message: object, _: object) -> None:
        """Do what a message of the browser says, and answer."""
        sentence = FAILED
        try:
            self._do(message)
            sentence = ""
        except (AutocolorError, RamtekError) as error:
            sentence = str(error)
        finally:
            widget.send({"answer": sentence})

    def _do(self, message: object) -> None:
        """Do what a message of the browser says. Raises an error if that cannot be done."""
        studio, history = self._studio, self._studio.history
        match message:
            case {"edit": dict() as values, **others} if all(isinstance(key, str) for key in values):
                self._edit(scene_with(studio.scene, values), others.get("same_step") is True)
            case {"undo": steps}:
                studio.undo(checked_steps(steps, len(history.to_undo), "undo"))
            case {"redo": steps}:
                studio.redo(checked_steps(steps, len(history.to_redo), "redo"))
            case _:
                raise UsageError(
                    f"a message of a widget must be an edit, undo or redo, not {shown(message)}; make the"
                    " widget again"
                )

    def _edit(self, scene: Scene, same_step: bool) -> None:
        before = self._studio.scene
        self._studio.edit(scene, same_step and before is self._dragged)
        if self._studio.scene is not before:
            self._dragged = self._studio.scene
        elif not same_step:
            self._dragged = None


def light_values(scene: Scene) -> dict[str, Any] | None:
    """The switches and strengths of the lights, without planes, because the studio computes light."""
    held = HELD if is_held(scene.exposure) else FOLLOWING
    return {"held": held, "rows": light_rows(scene)} if scene.lights else None


def checked_steps(steps: Any, most: int, what: str) -> int:
    """The number of steps to undo or redo. Raises UsageError if there are not so many."""
    if not is_whole(steps, 1, most):
        there = f"there is 1 step to {what}" if most == 1 else f"there are {most} steps to {what}"
        raise UsageError(f"{there}, not {shown(steps)}")
    return int(steps)


@cache
def widget_class() -> Callable[..., Any]:
    """The class of the widgets, made of `autocolor.js` and `autocolor.css`.

    Raises UnavailableError without the package anywidget.
    """
    try:
        import anywidget
        import traitlets
    except ImportError as cause:
        raise UnavailableError(
            "to make a widget, the package anywidget must be installed; run: pip install anywidget"
        ) from cause

    class StudioWidget(anywidget.AnyWidget):  # type: ignore[misc]
        """A studio in the cell of a notebook."""

        _esm = (files("autocolor.web") / "autocolor.js").read_text("utf-8")
        _css = (files("autocolor.web") / "autocolor.css").read_text("utf-8")
        picture = traitlets.Dict().tag(sync=True)
        words = traitlets.Bytes().tag(sync=True)
        entries = traitlets.Bytes().tag(sync=True)

        def __init__(self, png_of_studio: Callable[[], bytes], **values: object) -> None:
            self._png_of_studio = png_of_studio
            super().__init__(**values)

        def _repr_mimebundle_(self, **options: object) -> Any:
            # A saved notebook shows the picture where no kernel runs.
            bundle = super()._repr_mimebundle_(**options)
            if bundle:
                bundle[0]["image/png"] = base64.b64encode(self._png_of_studio()).decode("ascii")
            return bundle

    return StudioWidget
