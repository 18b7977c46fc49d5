"""SCENE of the commands: its options, reading and editing, created views and lights, exit codes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import click
from click.core import ParameterSource

from autocolor.commands.completion import complete_settings, complete_views
from autocolor.commands.options import Decorator, as_usage, flag, limit_option, option, verbose_option
from autocolor.errors import UsageError
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from autocolor.files.picture_file import SavedPicture
    from autocolor.files.scene_report import SceneReport
    from autocolor.journal.history import History
    from autocolor.lighting.picture import Picture
    from autocolor.scene.creation import SurfaceSource
    from autocolor.scene.scene import Scene

REPAIRED: Final = 1
"""The exit code with --strict of a command that succeeds, if input was skipped or repaired."""


class SceneSource(NamedTuple):
    """What a command line asks of SCENE: the values of `scene_options`, or the defaults of those left out."""

    scene: str | None
    up: str = "z"
    surfaces: SurfaceSource = "materials"
    strict: bool = False
    scale: float = 1.0
    settings: tuple[str, ...] = ()
    normals: bool = False
    paper: bool = False
    stage: str | None = None
    view: str | None = None
    size: tuple[int, int] = (640, 480)
    smooth: int | None = None
    hold_exposure: bool = False
    given: frozenset[str] = frozenset()
    """The names of the values that the user gave."""

    @property
    def path(self) -> str:
        """The path of the scene; "" without one."""
        return self.scene or ""

    @property
    def samples(self) -> int:
        """The smoothness of a picture of the scene."""
        from autocolor.images import default_smooth

        return self.smooth or default_smooth(self.size)

    @property
    def given_sizes(self) -> dict[str, Any]:
        """The size and the smoothness that the user gave, by their names."""
        return {name: getattr(self, name) for name in ("size", "smooth") if name in self.given}

    def rendered(self, scene: Scene) -> Picture:
        """The picture of a scene in the size and the smoothness that are asked for."""
        from autocolor.rendering import render

        return render(scene, self.size, smooth=self.samples)


set_option = option(
    "--set settings",
    "KEY=VALUE",
    "Set a field of the scene, such as lights.key.intensity=2, with the names of scene.toml; the value"
    " none unsets a field; repeatable.",
    str,
    multiple=True,
    shell_complete=complete_settings,
)

READING: Final[tuple[Decorator, ...]] = (
    click.option(
        "--surfaces",
        type=click.Choice(["materials", "parts"]),
        default="materials",
        help="Create a missing surface for each material of the mesh, or for each part.",
    ),
    option(
        "--scale",
        "FACTOR",
        "Factor for the coordinates of a mesh file, such as 0.001 for millimeters.",
        float,
        default=1.0,
    ),
    click.option(
        "--up",
        type=click.Choice(["x", "y", "z"]),
        default="z",
        help="Up axis of a mesh file; a scene file has its own.",
    ),
    flag("--strict", "Exit with code 1 if input was repaired or skipped."),
    limit_option,
    verbose_option,
)
"""The options of all commands that read a scene."""


def _size(_context: click.Context, _parameter: click.Parameter, text: str) -> tuple[int, int]:
    from autocolor.images import size_of

    try:
        return size_of(text)
    except UsageError as error:
        raise click.BadParameter(str(error)) from None


PICTURES: Final[dict[str, Decorator]] = {
    "settings": set_option,
    "normals": flag(
        "--normals",
        "Let words stand for normals: changing a light is then fast. Lights and eye count as far away.",
    ),
    "paper": flag(
        "--paper",
        "Show the scene as in 1983: normals linear in the picture, Phong's model, levels from minimum to"
        " maximum, no smooth edges.",
    ),
    "stage": click.option(
        "--stage",
        type=click.Choice(["none", "floor", "bowl"]),
        help="Stand the object on a floor, or in a bowl, before a backdrop.",
    ),
    "view": option("--view", "NAME", "Render a named view of the scene.", str, shell_complete=complete_views),
    "size": option(
        "--size",
        "WIDTHxHEIGHT",
        "Width and height of the picture, up to 4096x4096, as on the largest display.",
        str,
        default="640x480",
        callback=_size,
    ),
    "smooth": option(
        "--smooth",
        "1-4",
        "Smooth edges: each pixel is the mean light of 1, 4, 9 or 16. 1 is the picture of a display."
        " Default: 2, and 1 for more than 10 million pixels.",
        click.IntRange(1, 4),
    ),
    "hold_exposure": flag(
        "--hold-exposure",
        "Hold the exposure that SCENE has without other options, so that less light is darker.",
    ),
}
"""Further options for SCENE, by the field of SceneSource."""


def scene_options(*names: str, required: bool = True) -> Decorator:
    """A decorator that adds the argument SCENE, the options of READING and some of PICTURES to a command.

    The command gets their values as its argument `source`, a SceneSource. Its `scene` is None if the command
    line has none, which is an error if `required`.
    """
    argument = click.argument("scene", type=click.Path(), required=required)

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def with_source(*arguments: Any, **options: Any) -> Any:
            context = click.get_current_context()
            given = {
                name for name in options if context.get_parameter_source(name) is ParameterSource.COMMANDLINE
            }
            values = {name: options.pop(name) for name in SceneSource._fields if name in options}
            source = SceneSource(**values, given=frozenset(given))
            for name in ("up", "scale"):
                if source.scene is None and name in given:
                    rule = f"--{name} must come with a mesh file as SCENE"
                    raise UsageError(f"{rule}; name a file, or leave --{name} out")
            return command(*arguments, source=source, **options)

        decorated: Callable[..., Any] = with_source
        added: list[Decorator] = [argument, *READING, *(PICTURES[name] for name in names)]
        for add in reversed(added):
            decorated = add(decorated)
        return decorated

    return decorate


def read(source: SceneSource) -> SceneReport:
    """Read a scene, by default the built-in demo; print a line on stderr for each repair."""
    if source.scene is None:
        from autocolor.commands.demo import demo_report

        return demo_report()
    from autocolor.files.opening import read_scene_with_report

    report = read_scene_with_report(source.scene, up=source.up, scale=source.scale, surfaces=source.surfaces)
    tell(*(f"autocolor: {repair}" for repair in report.repairs))
    return report


def tell_up(report: SceneReport, source: SceneSource) -> None:
    """Print a line on stderr if the mesh seems to lie on its side, unless the user gave `--up`."""
    from autocolor.files.opening import hinted_up

    if source.scene is None or "up" in source.given:
        return
    if up := hinted_up(source.scene, report.scene.mesh):
        tell(f"autocolor: {source.scene} seems to lie on its side; try --up {up}, or give --up z")


def ended(report: SceneReport, source: SceneSource) -> int:
    """The exit code of a command that succeeded."""
    return REPAIRED if source.strict and report.repairs else 0


def read_edited(source: SceneSource) -> tuple[Scene, SceneReport]:
    """The scene of a source with all that is asked of it, and the report of what was read."""
    report = read(source)
    tell_up(report, source)
    return edited(report, source), report


def edited(report: SceneReport, source: SceneSource) -> Scene:
    """The scene of a report with all that is asked of it. Exposure is held before settings are made.

    A created view frames the object for the size of the picture. If the edits affect a created view or
    created lights, they are created again: an edit of the view or of `stage` of a part makes the view frame
    the object again, unless it sets the eye, the direction or the target; an edit of `stage` makes lights be
    created again.
    """
    from autocolor.commands.settings import with_settings
    from autocolor.scene.defaults import default_lights, framed
    from autocolor.scene.view import ASPECT

    original = scene = report.scene
    aspect = source.size[0] / source.size[1]
    if report.is_view_created and aspect != ASPECT:
        original = scene = scene.replace(view=framed(scene.view, scene.object_coordinates, aspect))
    if source.paper:
        scene = scene.as_in_1983()
    if source.normals:
        with as_usage("--normals: "):
            scene = scene.replace(words="normals")
    if source.stage is not None:
        scene = with_settings(scene, (f"stage={source.stage}",))
    if source.view is not None:
        scene = scene.with_taken_view(source.view)
    if source.hold_exposure:
        scene = with_held_exposure(scene, source.rendered(scene))
    scene = with_settings(scene, source.settings)
    is_same_object = [part.stage for part in original.parts] == [part.stage for part in scene.parts]
    before, view = original.view, scene.view
    is_placed = (before.eye, before.direction, before.target) != (view.eye, view.direction, view.target)
    if report.is_view_created and not is_placed and not (is_same_object and before == view):
        scene = scene.replace(view=framed(view, scene.object_coordinates, aspect))
    if report.are_lights_created and not is_same_object and scene.lights == original.lights:
        scene = scene.replace(lights=default_lights(scene.object_coordinates, scene.view))
    return scene


def start_of(source: SceneSource) -> tuple[Scene | SavedPicture, int]:
    """The scene, or the picture with its scene, of a command line, and the exit code of its repairs."""
    from autocolor.commands.settings import recolored
    from autocolor.files.opening import is_picture
    from autocolor.files.picture_file import read_picture

    if not is_picture(Path(source.path)):
        scene, report = read_edited(source)
        return scene, ended(report, source)
    for name in ("normals", "stage"):
        if name in source.given:
            raise UsageError(f"--{name} is for a scene, not for a picture file; leave it out")
    saved = read_picture(source.path)
    scene = with_held_exposure(saved.scene, saved.picture) if source.hold_exposure else saved.scene
    return saved._replace(scene=recolored(scene, None, {}, source.settings)), 0


def scene_in(start: Scene | SavedPicture) -> Scene:
    """The scene, or the scene of a picture."""
    return start.scene if isinstance(start, tuple) else start


def with_held_exposure(scene: Scene, picture: Picture) -> Scene:
    """The scene with the exposure that its picture has."""
    from autocolor.images import display_image
    from autocolor.mapping.intensity import held_exposure, stage_surfaces

    mapped = display_image(scene, picture).mapped
    return scene.replace(exposure=held_exposure(mapped, scene.scaling, scene.exposure, stage_surfaces(scene)))


def session_of(source: SceneSource) -> tuple[SceneReport, History]:
    """The report of reading a scene, and a session with it, in which all that is asked of it is a step."""
    from autocolor.journal.history import History
    from autocolor.journal.places import Source, place_of

    place = place_of(Source(source.path, source.up, source.surfaces, source.scale))
    report = read(source)
    history = History(report.scene, replace(place, repairs=report.repairs))
    scene = edited(report, source)
    if scene is not report.scene:
        history.take(scene)
    return report, history
