"""An explanation as rows of text, a label and what it says, for the terminal and for the display alike.

A row fits into the 80 columns of a terminal, and all rows of a usual scene into a page. Names and long lists
are shortened; `Explanation.to_plain` has everything.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Final, NamedTuple

from autocolor.checks import Vector
from autocolor.explanation.explain import Explanation
from autocolor.explanation.level import LevelExplained
from autocolor.explanation.light import LightExplained
from autocolor.explanation.point import PointExplained
from autocolor.scene.columns import to_plain
from autocolor.scene.kinds import in_digits

LABEL: Final = 13
"""Characters of a label, with the space after it."""

WIDTH: Final = 79
"""Characters of a row."""

PAGE: Final = 34
"""Rows of a page: a display of 480 lines has so many above its message line."""

COLUMNS: Final = (5, 7, 7, 10, 10, 9, 9, 9)
"""The characters of the columns of the table of lights, to the end of the row."""

DIGITS: Final = 5
"""Significant digits of the largest coordinate."""


class TextRow(NamedTuple):
    """A row of the text: a label, which may be empty, and what it says."""

    label: str
    says: str

    def __str__(self) -> str:
        return f"{self.label:{LABEL}}{self.says}".rstrip()


def rows_of_text(explanation: Explanation, most: int = PAGE) -> list[TextRow]:
    """The rows of an explanation, at most `most`: the lights that contribute least are left out."""
    title = TextRow("pixel", f"line {explanation.line}, element {explanation.element} of {explanation.scene}")
    point, level = explanation.point, explanation.level
    if point is None:
        owner = "backdrop" if explanation.word else "background"
        return [
            _fitted(title),
            TextRow("seen", f"nothing: the {owner}"),
            TextRow("word", f"{explanation.word}, the {owner}'s"),
            TextRow("color", color_text(explanation.color)),
        ]
    before = [title, *_point_rows(point)]
    after = [*(_normal_word_rows(explanation) if level is None else _level_rows(explanation, level))]
    lights = _light_rows(explanation, most - len(before) - len(after) - 2)
    return [_fitted(row) for row in (*before, TextRow("", ""), *lights, TextRow("", ""), *after)]


def _point_rows(at: PointExplained) -> Iterable[TextRow]:
    """The rows of the tables, and the point."""
    decimals = _decimals([*(corner.coordinates for corner in at.corners), at.point])
    nodes = ", ".join(str(corner.node) for corner in at.corners)
    columns = ", ".join(
        f"{name.replace('_', ' ')} {_value(value)}" for name, value in to_plain(at.reflectance).items()
    )
    yield TextRow("surface", f"{at.surface}  {at.surface_name}: {columns}")
    yield TextRow("part", f"{at.part}  {at.part_name}")
    yield TextRow("polygon", f"{at.polygon}  nodes {nodes}")
    for corner in at.corners:
        place, normal = _vector(corner.coordinates, decimals), _vector(corner.normal, 4)
        yield TextRow(f"node {corner.node}"[: LABEL - 1], f"{place}  normal {normal}")
    turned = ", turned to the eye" if at.is_turned else ""
    yield TextRow("point P", f"{_vector(at.point, decimals)}  {at.distance:.{DIGITS}g} from the eye")
    yield TextRow("normal N", f"{_vector(at.normal, 4)}  interpolated{turned}")
    yield TextRow("reflected R", f"{_vector(at.reflected_view, 4)}  the view, reflected at N")


def _light_rows(explanation: Explanation, most: int) -> Iterable[TextRow]:
    """A table of the lights, those that contribute most first, with a row of the controls of each."""
    number = _numbers(explanation)
    columns = ("I deg", "E deg", "L deg", "intensity", "controls", "diffuse", "specular", "sum")
    yield TextRow("light", _in_columns(columns))
    rows = [[_light_row(light, number), *_control_rows(light)] for light in explanation.lights]
    shown: list[TextRow] = []
    count = 0
    # Leave room for the header, the ambient light, the sum, and the row about the lights that are left out.
    while count < len(rows) and len(shown) + len(rows[count]) <= most - (3 if count == len(rows) - 1 else 4):
        shown += rows[count]
        count += 1
    yield from shown
    if count < len(rows):
        rest = math.fsum(light.contribution for light in explanation.lights[count:])
        yield TextRow("", f"{f'and {len(rows) - count} more':57}{number(rest):>9}")
    diffuse, specular = (
        math.fsum(getattr(light, name) for light in explanation.lights) for name in ("diffuse", "specular")
    )
    yield TextRow("ambient", f"{number(explanation.ambient):>66}")
    sums = (number(diffuse), number(specular), number(explanation.intensity or 0.0))
    yield TextRow("intensity", _in_columns(("", "", "", "", "", *sums)))


def _light_row(light: LightExplained, number: Callable[[float], str]) -> TextRow:
    angles = [_degrees(cosine) for cosine in (light.cos_incidence, light.cos_eye, light.cos_light)]
    share = f"{light.share:.4f}" if light.controls else ""
    contributions = (number(each) for each in (light.diffuse, light.specular, light.contribution))
    return TextRow(
        f"{light.light} {light.name}"[: LABEL - 1],
        _in_columns((*angles, f"{light.intensity:.4g}", share, *contributions)),
    )


def _in_columns(texts: Sequence[str]) -> str:
    """The texts of a row of the table of lights, at the right of their columns."""
    return "".join(f"{each:>{width}}" for each, width in zip(texts, COLUMNS, strict=True))


def _control_rows(light: LightExplained) -> Sequence[TextRow]:
    """The factors of the controls of a light, if it has any."""
    if not light.controls:
        return ()
    factors = " x ".join(f"{name} {share:.4g}" for name, share in light.controls)
    return (TextRow("", f"   {factors}"),)


def _level_rows(explanation: Explanation, level: LevelExplained) -> Iterable[TextRow]:
    """The level, the word and the color."""
    point, scalar, number = explanation.point, level.scalar, _numbers(explanation)
    owner = "the object" if level.range_of == "object" or point is None else point.surface_name
    held = ", held" if level.is_held else ""
    yield TextRow("range", f"{number(level.minimum)} to {number(level.maximum)} of {owner}{held}")
    bent = f", by the mapping curve {level.mapped_fraction:.4f}"
    is_bent = not math.isclose(level.fraction, level.mapped_fraction, abs_tol=5e-5)
    yield TextRow("fraction", f"{level.fraction:.4f}{bent if is_bent else ''}")
    dithered = f", dithered with {level.threshold:.4f}" if level.threshold != 0.5 else ""
    what = "shade" if scalar else "level"
    last = level.levels - 1
    yield TextRow(
        what, f"{level.level} of 0 to {last}: {level.mapped_fraction:.4f} x {last}, rounded{dithered}"
    )
    if scalar is not None:
        value = "missing" if scalar.value is None else f"{scalar.value:.{DIGITS}g}"
        limits = f"{scalar.minimum:.{DIGITS}g} to {scalar.maximum:.{DIGITS}g}"
        yield TextRow("scalar", f"{scalar.name} {value}, bands from {limits}")
        yield TextRow("band", f"{scalar.band} of 0 to {scalar.bands - 1}, {color_text(scalar.band_color)}")
        yield TextRow(
            "word",
            f"{explanation.word} = first word {level.first_word}"
            f" + band {scalar.band} x {scalar.shades} shades + shade {level.level}",
        )
    else:
        yield TextRow("word", f"{explanation.word} = first word {level.first_word} + level {level.level}")
        labels = ["object color", "light color"]
        if level.ramp_color is not None:
            labels = [f"ramp {number}" for number in (level.ramp_color, level.ramp_color + 1)]
        object_color, light_color = (color_text(color) for color in (level.object_color, level.light_color))
        yield TextRow(labels[0], f"{object_color}  x {1 - level.light_share:.4f}")
        yield TextRow(labels[1], f"{light_color}  x {level.light_share:.4f}")
    if level.ramp_color is None:
        yield TextRow("brightness", f"{level.brightness:.4f} at {what} {level.level}")
    yield TextRow("color", f"{color_text(explanation.color)} in entry {explanation.word}")


def _normal_word_rows(explanation: Explanation) -> Iterable[TextRow]:
    """The rows of a word that stands for a normal."""
    yield TextRow("word", f"{explanation.word}, which stands for normals near N, from all lights far away")
    yield TextRow("color", f"{color_text(explanation.color)} in entry {explanation.word}")


def color_text(color: tuple[int, int, int]) -> str:
    """A color by its components, and as hexadecimal digits."""
    red, green, blue = color
    return f"{in_digits(color)}  red {red:3}  green {green:3}  blue {blue:3}"


def _value(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _fitted(row: TextRow) -> TextRow:
    most = WIDTH - LABEL
    return row if len(row.says) <= most else row._replace(says=f"{row.says[: most - 2]}..")


def _decimals(points: Iterable[Vector]) -> int:
    """The decimals with which the largest coordinate of some points has DIGITS significant digits."""
    largest = max(abs(component) for point in points for component in point)
    return min(max(DIGITS - 1 - math.floor(math.log10(largest or 1.0)), 0), 9)


def _vector(vector: Vector, decimals: int) -> str:
    """The components with fixed decimals, or few digits of large ones, one below another."""
    width = max(decimals + 4, 8)
    # Adding 0 makes 0 of a rounded -0.
    rounded = (round(each, decimals) + 0.0 for each in vector)
    parts = (f"{each:.{decimals}f}" if abs(each) < 1e7 else f"{each:.3e}" for each in rounded)
    return " ".join(f"{part:>{width}}" for part in parts)


def _numbers(explanation: Explanation) -> Callable[[float], str]:
    """The text of an intensity: with 4 decimals, or with 3 digits if the picture is very dark or bright."""
    largest = explanation.intensity or 0.0
    if explanation.level is not None:
        largest = max(largest, explanation.level.maximum)
    fixed = largest == 0 or 0.01 <= largest < 1000
    return lambda value: f"{value:.4f}" if fixed else f"{value:.3g}"


def _degrees(cosine: float | None) -> str:
    """The angle of a cosine in degrees; a dash for a light without a direction."""
    return "-" if cosine is None else f"{math.degrees(math.acos(min(max(cosine, -1.0), 1.0))):.1f}"
