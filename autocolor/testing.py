"""Strategies and checks for property tests of scenes, words and entries, with hypothesis.

Each strategy is a function, named by a plural noun. The scenes are small: at most 18 nodes, 8 polygons and 3
lights, and the surfaces "body" and "glass". Coordinates are short binary fractions, so that polygons often
meet: in the same place, in the same plane, in the eye's plane, at a pixel's center. The checks raise an
AssertionError that says what moved, and where.

Strategies without arguments are cached, because hypothesis validates every new strategy.

They need hypothesis, which the extra `testing` installs. docs/TESTING.md has complete tests.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color, Vector, listed, shown
from autocolor.errors import UsageError
from autocolor.images import display_image
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.mapping.ranges import SCREENS, LevelRange
from autocolor.rendering import render
from autocolor.scene.columns import Tier
from autocolor.scene.curves import CURVES
from autocolor.scene.kinds import in_digits
from autocolor.scene.lights import Flap, Flaps, HalfSpace, Light, Links
from autocolor.scene.mesh import Mesh
from autocolor.scene.reflection_models import (
    MODELS,
    BlinnPhong,
    CookTorrance,
    Phong,
    ReflectionModel,
    SpecularGrowth,
)
from autocolor.scene.scalar import MeshScalar, Scalar
from autocolor.scene.scene import INTERPOLATIONS, Scene, costs_at_least
from autocolor.scene.surfaces import Paint, Part, Reflectance, Surface
from autocolor.scene.view import NamedView, View
from autocolor.studio import Studio
from ramtek_emu import Ramtek9300

try:
    from hypothesis import strategies as st
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "autocolor.testing needs the package hypothesis; run: pip install hypothesis",
        name=error.name,
    ) from error


@cache
def coordinates() -> st.SearchStrategy[float]:
    """Numbers from -2 to 2 in sixteenths, so that points often meet."""
    return st.integers(-32, 32).map(lambda number: number / 16)


def numbers(least: float, most: float) -> st.SearchStrategy[float]:
    """Numbers from `least` to `most`, in 1,048,576 equal steps, so that no number is tiny but not 0."""
    return st.integers(0, 1 << 20).map(lambda step: least + (most - least) * step / (1 << 20))


def vectors(component: st.SearchStrategy[float] | None = None) -> st.SearchStrategy[Vector]:
    """Points, or directions that may be zero; by default of `coordinates`."""
    component = coordinates() if component is None else component
    return st.tuples(component, component, component)


@cache
def directions() -> st.SearchStrategy[Vector]:
    """Vectors of `coordinates`, of any length but zero."""
    return vectors().filter(any)


@cache
def colors() -> st.SearchStrategy[Color]:
    """Red, green and blue, each 0 to 255."""
    return st.tuples(*[st.integers(0, 255)] * 3)


@st.composite
def meshes(draw: st.DrawFn, parts: int = 2, least_polygons: int = 1) -> Mesh:
    """Meshes of at most 18 nodes and 8 polygons, whose parts are "part 0", "part 1" and so on.

    The polygons have three or four corners. They are warped, cross themselves and each other, have no area,
    or are repeated, as in files that people bring.
    """
    coordinates = draw(st.lists(vectors(), min_size=3, max_size=9))
    node = st.integers(0, len(coordinates) - 1)
    if draw(st.booleans()):
        # A mesh of a file that repeats its nodes.
        coordinates = coordinates + coordinates
        node = st.integers(0, len(coordinates) - 1)
    quads = st.tuples(node, node, node, node)
    triangles = st.tuples(node, node, node).map(lambda three: (*three, three[2]))
    polygons = draw(st.lists(quads | triangles, min_size=least_polygons, max_size=8))
    part_numbers = draw(st.lists(st.integers(0, parts - 1), min_size=len(polygons), max_size=len(polygons)))
    return Mesh(
        np.array(coordinates),
        np.array(polygons, np.intp).reshape(-1, 4),
        np.array(part_numbers, np.intp),
        tuple(f"part {number}" for number in range(parts)),
        crease_angle=draw(st.sampled_from([0.0, 40.0, 90.0, 180.0])),
    )


@st.composite
def views(draw: st.DrawFn) -> View:
    """Views from within, before and behind the polygons of `meshes`."""
    eye = draw(vectors())
    return View(
        eye,
        direction=draw(directions()),
        angle=draw(st.sampled_from([0.0, 30.0, 90.0, -45.0])),
        field_of_view=draw(st.sampled_from([20.0, 60.0, 120.0])),
    )


@st.composite
def outside_views(draw: st.DrawFn) -> View:
    """Views from outside that show all polygons of `meshes`."""
    eye = draw(directions())
    far = 6.0 / float(np.linalg.norm(eye))
    return View((eye[0] * far, eye[1] * far, eye[2] * far), target=(0.0, 0.0, 0.0), field_of_view=40.0)


@cache
def named_views() -> st.SearchStrategy[tuple[NamedView, ...]]:
    """At most two named views."""
    names = st.sampled_from(["hood", "view 1", 'a "b".c'])
    rows = st.builds(NamedView, names, views() | outside_views())
    return st.lists(rows, max_size=2, unique_by=lambda row: row.name).map(tuple)


@cache
def edge_widths() -> st.SearchStrategy[float]:
    """0 for a sharp edge, or 0.01 to 2, which begins and ends among the polygons of `meshes`."""
    return st.just(0.0) | numbers(0.01, 2)


@st.composite
def flaps(draw: st.DrawFn) -> Flaps:
    """Flaps along any of the axes, from -1.5 to 1.5, some of them soft or switched off."""

    def one() -> Flap | None:
        if draw(st.booleans()):
            return None
        ends = sorted((draw(numbers(-1.5, 1.5)), draw(numbers(-1.5, 1.5))))
        return Flap(ends[0], ends[1], draw(st.booleans()), draw(edge_widths()))

    return Flaps(one(), one(), one())


@cache
def half_spaces() -> st.SearchStrategy[tuple[HalfSpace, ...]]:
    """At most three half-spaces in any direction, some of them soft, carried or switched off."""
    rows = st.builds(
        HalfSpace,
        st.sampled_from(["left", "right", "door 3"]),
        vectors(),
        directions(),
        edge_widths(),
        st.booleans(),
        st.booleans(),
    )
    return st.lists(rows, max_size=3, unique_by=lambda each: each.name).map(tuple)


@st.composite
def lights(draw: st.DrawFn, /, name: str = "light", **given: Any) -> Light:
    """Lights with any of the controls, of intensity 0 to 3, at most 3 from the origin on each axis.

    `given` are fields of a Light that are not drawn, as in `lights("key", on=True)`.
    """
    position = given.pop("position", None) or draw(vectors(numbers(-3, 3)))
    fields: dict[str, Any] = {"intensity": draw(numbers(0, 3)), "on": draw(st.booleans())}
    if draw(st.booleans()):
        fields["direction"] = draw(directions())
        fields["concentration"] = draw(st.sampled_from([0.0, 1.0, 2.5, 10.0, 40.0]))
        fields["cone_angle"] = draw(st.none() | numbers(1, 180))
        if fields["cone_angle"] is not None:
            fields["inner_angle"] = draw(st.none() | numbers(0, fields["cone_angle"]))
    if draw(st.booleans()):
        fields["flaps"] = draw(flaps())
    fields["at_infinity"] = "direction" in fields and draw(st.booleans())
    if not fields["at_infinity"]:
        fields["falloff"] = draw(st.sampled_from(["none", "none", "linear", "quadratic"]))
        fields["reach"] = draw(numbers(0.5, 9)) if fields["falloff"] != "none" else None
    if draw(st.booleans()):
        fields["half_spaces"] = draw(half_spaces())
    return Light(name, position, **{**fields, **given})


@st.composite
def angle_curves(draw: st.DrawFn) -> tuple[tuple[float, float], ...]:
    """Curves of two to six points (angle in degrees, share of 0 to 1), which need not rise."""
    inner = draw(st.lists(st.integers(1, 89), max_size=4, unique=True))
    angles = [0.0, *sorted(map(float, inner)), 90.0]
    return tuple((angle, draw(numbers(0, 1) if angle else numbers(0.001, 1))) for angle in angles)


@cache
def growths() -> st.SearchStrategy[SpecularGrowth]:
    """Any growth of the specular reflection with the angle: none, by its base, an index or a curve."""
    return (
        st.just(SpecularGrowth())
        | st.builds(SpecularGrowth, base_reflectance=st.sampled_from([0.001, 0.04, 1.0]) | numbers(0.001, 1))
        | st.builds(SpecularGrowth, refractive_index=st.sampled_from([1.07, 1.5, 10.0]) | numbers(1.07, 10))
        | st.builds(SpecularGrowth, fresnel_curve=angle_curves())
    )


def some_of(names: list[str]) -> st.SearchStrategy[tuple[str, ...]]:
    """Tuples of different names of the list; a tuple may be empty."""
    return st.lists(st.sampled_from(names), unique=True).map(tuple)


@st.composite
def links(draw: st.DrawFn, surfaces: list[str], parts: list[str]) -> Links:
    """Links to any of these surfaces and parts; half of the lights have none."""
    fields: dict[str, Any] = {}
    if draw(st.booleans()):
        for what, names in (("surfaces", surfaces), ("parts", parts)):
            which = draw(st.sampled_from(["", "only", "except"]))
            if which:
                fields[f"{which}_{what}"] = draw(some_of(names))
    return Links(**fields)


@cache
def reflection_models() -> st.SearchStrategy[ReflectionModel]:
    """Phong's and Blinn's models with exponents 0 to 50, Cook and Torrance's, and each model's default."""
    exponents = st.sampled_from([0.0, 1.0, 5.0, 20.0, 50.0])
    return (
        st.builds(Phong, exponents, growths())
        | st.builds(BlinnPhong, exponents, growths())
        | st.builds(CookTorrance, st.sampled_from([0.1, 0.3, 1.0]), st.sampled_from([0.04, 0.5, 1.0]))
        | st.sampled_from([model() for model in MODELS.values()])
    )


@cache
def reflectances() -> st.SearchStrategy[Reflectance]:
    """Diffuse and specular coefficients, each 0 to 2, with any reflection model."""
    return st.builds(Reflectance, numbers(0, 2), numbers(0, 2), reflection_models())


@cache
def paints() -> st.SearchStrategy[Paint]:
    """Two colors that blend, as in `blended_paints`, or a ramp of `ramps`."""
    return blended_paints() | st.builds(Paint, ramp=ramps())


@cache
def ramps() -> st.SearchStrategy[tuple[Color, ...]]:
    """Ramps of two to nine colors."""
    return st.lists(colors(), min_size=2, max_size=9).map(tuple)


@cache
def blended_paints() -> st.SearchStrategy[Paint]:
    """Any two colors, with a blend of 0 to 1 and a light percentage of 0 to 100."""
    blends = st.sampled_from([0.0, 0.25, 0.6, 1.0]) | numbers(0, 1)
    return st.builds(Paint, colors(), colors(), blends, numbers(0, 100))


def surfaces(name: str) -> st.SearchStrategy[Surface]:
    """Surfaces of this name with any reflectance and paint, some of which ask for 2 to 300 levels."""
    return st.builds(
        Surface,
        st.just(name),
        reflectances(),
        paints(),
        st.booleans(),
        st.none() | st.integers(2, 300),
    )


@st.composite
def level_ranges(draw: st.DrawFn) -> dict[str, LevelRange]:
    """At most twelve level ranges by name, of "surface 0" and so on, within the words 1 to 1007.

    They follow one another with or without words between them, and have at least two levels each.
    """
    first, ranges = 1, {}
    for number in range(draw(st.integers(1, 12))):
        first += draw(st.sampled_from([0, 0, 0, 7]))
        levels = draw(st.sampled_from([2, 3, 16]) | st.integers(2, 1007))
        if first + levels > SCREENS.first:
            break
        ranges[f"surface {number}"] = LevelRange(first, levels)
        first += levels
    return ranges or {"surface 0": LevelRange(1, 1007)}


MAPPINGS: Final[list[Any]] = [*CURVES, ((0, 0.1), (0.4, 0.8), (1, 1))]
"""Every mapping curve by name, and a curve of points."""


@cache
def exposures() -> st.SearchStrategy[Any]:
    """An exposure that follows the picture, or held ranges of "body", "glass" or "object"."""
    held = st.tuples(numbers(0, 2), numbers(0.01, 3)).map(lambda pair: (pair[0], pair[0] + pair[1]))
    return st.sampled_from(["auto", "99.5 %", "60 %"]) | st.dictionaries(
        st.sampled_from(["body", "glass", "object"]), held, min_size=1
    )


@st.composite
def mesh_scalars(draw: st.DrawFn, mesh: Mesh) -> tuple[MeshScalar, ...]:
    """Two scalars of a mesh: "stress" of its nodes and "load case 2" of its polygons.

    Their values are whole numbers from -8 to 8; some are missing.
    """
    value = st.integers(-8, 8).map(float) | st.just(float("nan"))

    def of(name: str, kind: str, count: int) -> MeshScalar:
        return MeshScalar(name, np.array(draw(st.lists(value, min_size=count, max_size=count)), float), kind)

    nodes, polygons = len(mesh.coordinates), len(mesh.node_numbers)
    return of("stress", "node", nodes), of("load case 2", "polygon", polygons)


@cache
def limits() -> st.SearchStrategy[tuple[float, float]]:
    """A lower limit of -8 to 0 and an upper limit of 1 to 8, for the values of `mesh_scalars`."""
    return st.tuples(st.integers(-8, 0).map(float), st.integers(1, 8).map(float))


@cache
def scales() -> st.SearchStrategy[Any]:
    """Names of color scales, and lists of two or three colors."""
    lists = st.lists(colors(), min_size=2, max_size=3).map(tuple)
    return st.sampled_from(["viridis", "zebra", "coolwarm_r"]) | lists


@cache
def scalars() -> st.SearchStrategy[Scalar]:
    """Rows of a scalar of `mesh_scalars` or of the computed scalar "z", with any limits, bands and colors."""
    return st.builds(
        Scalar,
        st.sampled_from(["stress", "load case 2", "z"]),
        limits=st.none() | limits(),
        scale=scales(),
        bands=st.integers(2, 20),
        shades=st.none() | st.integers(1, 12),
        below=st.none() | colors(),
        above=st.none() | colors(),
        missing=colors(),
        legend=st.booleans(),
        legend_place=st.none() | st.tuples(st.floats(0, 1), st.floats(0, 1)),
        surfaces=st.none() | st.sampled_from([("body",), ("glass", "body"), ()]),
        direction=directions(),
        stripes=st.sampled_from([1.0, 12.0]),
    )


def scene_columns() -> dict[str, st.SearchStrategy[Any]]:
    """Strategies for the columns of a scene that are no rows, by name; see `scenes` for its surfaces."""
    return {
        "ambient": numbers(0, 1),
        "scaling": st.sampled_from(["surface", "object"]),
        "mapping": st.sampled_from(MAPPINGS),
        "contrast": st.sampled_from(["stretch", "floor"]),
        "exposure": exposures(),
        "dither": st.sampled_from(["off", "ordered"]),
        "division": st.sampled_from(["covered", "equal"]),
        "interpolation": st.sampled_from(INTERPOLATIONS),
        "background": colors(),
        "stage": st.just("none"),
        "backdrop": st.none(),
        "front": st.sampled_from([None, "x", "-x", "y", "-y"]),
    }


@st.composite
def scenes(draw: st.DrawFn, /, **given: Any) -> Scene:
    """Scenes with a value in every column, small enough to be rendered hundreds of times.

    Their surfaces are "body" and "glass", their parts "part 0" and "part 1", and their lights none, "key", or
    "key", "fill" and "rim". Hypothesis needs minutes to simplify a failing scene, which has hundreds of
    numbers. `given` are fields of a Scene that are not drawn, as in `scenes(lights=(), scalar=None)`.
    """
    if "mesh" not in given:
        bare = draw(meshes())
        given["mesh"] = bare.with_scalars(*draw(mesh_scalars(bare)))
    mesh: Mesh = given["mesh"]
    names, parts = ["body", "glass"], list(mesh.part_names)
    if "parts" not in given:
        given["parts"] = tuple(
            Part(name, draw(st.sampled_from(names)), draw(st.booleans())) for name in parts
        )
    if "surfaces" not in given:
        given["surfaces"] = tuple(draw(surfaces(name)) for name in names)
    if "lights" not in given:
        given["lights"] = tuple(
            draw(lights(name, links=draw(links(names, parts))))
            for name in draw(st.sampled_from([(), ("key",), ("key", "fill", "rim")]))
        )
    strategies = {
        "view": views() | outside_views(),
        **scene_columns(),
        "views": named_views(),
        "scalar": st.none() | scalars(),
    }
    fields = {name: draw(strategy) for name, strategy in strategies.items() if name not in given}
    return Scene(**fields, **given)


@dataclass(frozen=True)
class Recoloring:
    """Changes of a surface's paint, to call with a scene or with a studio.

    >>> Recoloring("body", {"blend": 0.25})
    Recoloring(surface='body', changes={'blend': 0.25})
    """

    surface: str
    changes: Mapping[str, Any]

    def __call__(self, subject: Scene | Studio) -> Scene | Studio:
        """The recolored scene, or the studio after it recolored its scene."""
        if isinstance(subject, Scene):
            return subject.with_paint(self.surface, **self.changes)
        subject.recolor(self.surface, **self.changes)
        return subject


def recolorings(surfaces: Sequence[str] = ("body", "glass")) -> st.SearchStrategy[Recoloring]:
    """Recolorings of one of these surfaces: of its ramp alone, or of colors, blend and light percentage.

    A recoloring may change nothing. Call it with a scene or a studio, or use its `surface` and `changes`.
    """
    blending = {
        "object_color": colors(),
        "light_color": colors(),
        "blend": numbers(0, 1),
        "light_percentage": numbers(0, 100),
    }
    # With optional keys, hypothesis sometimes leaves keys that a failure does not need.
    are_changed = st.fixed_dictionaries({name: st.booleans() for name in blending})
    changes = st.tuples(st.fixed_dictionaries(blending), are_changed).map(
        lambda both: {name: value for name, value in both[0].items() if both[1][name]}
    ) | st.fixed_dictionaries({"ramp": st.none() | ramps()})
    return st.builds(Recoloring, st.sampled_from(surfaces), changes)


SIZE: Final = (32, 24)
"""The width and height of the pictures that the checks render of scenes."""

Subject = TypeVar("Subject", Scene, Studio)


def check_recoloring_moves_no_word(
    subject: Subject, edit: Callable[[Subject], object], *, picture: Picture | None = None
) -> None:
    """Raise AssertionError if an edit of colors moves a word.

    `subject` is a scene or a studio, and `edit` is a `Recoloring` or a function of yours, which returns the
    edited scene or edits the studio. The scene is rendered before and after the edit, 32 x 24
    pixels, and mapped to words anew. A `picture` of the scene is used instead if you give one; an edit that
    needs another picture then fails. A studio keeps the edit. Its display must hold the same words after it,
    and if it is a `Ramtek9300`, no word may even have been written.

        @given(scenes(), paints())
        def test_my_palette_moves_no_word(scene, paint):
            check_recoloring_moves_no_word(scene, lambda scene: my_palette(scene, paint))

        @given(recolorings())
        def test_recoloring_in_a_session_writes_no_word(recoloring):
            check_recoloring_moves_no_word(Studio(my_scene()), recoloring)
    """
    __tracebackhide__ = True  # pytest then points to the test.
    before, after = _states(subject, edit, picture)
    moved = np.argwhere(before.words != after.words)
    if len(moved):
        line, element = moved[0].tolist()
        raise AssertionError(
            f"a recoloring must move no word, but {len(moved)} of {before.words.size} words moved, the first"
            f" at line {line}, element {element}: {before.words[line, element]} became"
            f" {after.words[line, element]}"
        )
    if before.written != after.written:
        raise AssertionError(
            f"a recoloring must move no word, but {after.written - before.written} words were written again"
        )


def check_entries_outside_range_stay(
    subject: Subject,
    edit: Callable[[Subject], object],
    surfaces: str | Iterable[str],
    *,
    picture: Picture | None = None,
) -> None:
    """Raise AssertionError if an edit of some surfaces changes an entry outside of their level ranges.

    `surfaces` are the names of the surfaces that the edit may recolor; their ranges must stay, too. The entry
    of the background and the entries of the screens are outside of every range. A surface of no part has no
    range. For `subject`, `edit` and `picture` see `check_recoloring_moves_no_word`. Raises UsageError for an
    unknown surface.

        @given(scenes(), recolorings())
        def test_recoloring_stays_within_the_range(scene, recoloring):
            check_entries_outside_range_stay(scene, recoloring, recoloring.surface)
    """
    __tracebackhide__ = True  # pytest then points to the test.
    names = [surfaces] if isinstance(surfaces, str) else list(surfaces)
    scene = subject if isinstance(subject, Scene) else subject.scene
    for name in names:
        scene.surfaces[name]
    before, after = _states(subject, edit, picture)
    is_inside = np.zeros(len(before.entries), np.bool_)
    spans = []
    for name in names:
        levels = before.ranges.get(name)
        spans.append(f"{name!r} ({_span(levels)})")
        if levels != after.ranges.get(name):
            raise AssertionError(
                f"the range of {spans[-1]} must stay, but it became {_span(after.ranges.get(name))}"
            )
        if levels is not None:
            is_inside[levels.first : levels.last + 1] = True
    changed = np.flatnonzero((before.entries != after.entries).any(axis=1) & ~is_inside)
    if len(changed):
        first = int(changed[0])
        raise AssertionError(
            f"the entries outside the range of {listed(spans or ['no surface'])} must stay, but"
            f" {len(changed)} changed, the first is entry {first}:"
            f" {in_digits(before.entries[first])} became {in_digits(after.entries[first])}"
        )


def _span(levels: LevelRange | None) -> str:
    """The words of a range, as in 1 to 504."""
    return "no words" if levels is None else f"{levels.first} to {levels.last}"


class _State(NamedTuple):
    """The words and entries of a scene or a display, and the words that the display was sent so far."""

    words: Words
    entries: Bytes
    ranges: Mapping[str, LevelRange]
    written: int = 0


def _states(
    subject: Scene | Studio, edit: Callable[[Any], object], picture: Picture | None
) -> tuple[_State, _State]:
    """The states before and after an edit."""
    if isinstance(subject, Studio):
        if picture is not None:
            raise UsageError("a picture must come with its scene; leave it out, a studio has its own picture")
        before = _state_of_studio(subject)
        edit(subject)
        return before, _state_of_studio(subject)
    edited = edit(subject)
    if not isinstance(edited, Scene):
        raise UsageError(f"an edit of a scene must return the edited Scene, not {shown(edited)}")
    if picture is None:
        return _state_of_scene(subject), _state_of_scene(edited)
    check_surfaces(subject, picture)
    if costs_at_least(subject, edited, Tier.MIX):
        raise AssertionError("a recoloring must need no other picture, but the edited scene does")
    return _state_of_scene(subject, picture), _state_of_scene(edited, picture)


def _state_of_scene(scene: Scene, picture: Picture | None = None) -> _State:
    image = display_image(scene, render(scene, SIZE) if picture is None else picture)
    return _State(image.words, image.entries, image.ranges)


def _state_of_studio(studio: Studio) -> _State:
    """The state of the studio's display; of the studio itself if the display is elsewhere."""
    display = studio._display
    if isinstance(display, Ramtek9300):
        written = display.frame_buffer.written
        return _State(display.words.copy(), display.entries, studio.level_ranges, written)
    return _State(studio.words, studio.entries, studio.level_ranges)
