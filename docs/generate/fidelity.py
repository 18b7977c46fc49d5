"""The fidelity ledger: every line of the sources that says where a formula or a number comes from.

`Paper:` Warn's paper; `Hardware:` a source about the RAMTEK by its key; `Assumed:` our choice where sources
are silent; `Departs:` where the program knowingly differs; `Limit:` a bound that no source asks for, such as
the largest file that is read. `python -m docs.generate.fidelity > docs/FIDELITY.md` writes the document.
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("autocolor", "ramtek_emu")
KINDS = {
    "Paper": "What follows the paper",
    "Hardware": "What follows a source about the hardware",
    "Assumed": "What is our choice, where the sources are silent",
    "Departs": "Where the program knowingly differs",
    "Limit": "Bounds of our own on files, sizes and times",
}
MARK = re.compile(rf"(?P<bracket>\()?\b(?P<kind>{'|'.join(KINDS)}):\s+")

THE_PAPER = (
    (
        "Introduction: mesh, parts, tables",
        ("scene.mesh", "scene.surfaces", "scene.creation", "files.store.tables"),
        "test_the_shape_is_a_mesh_of_polygons_with_three_or_four_sides",
    ),
    (
        "Introduction: hidden surfaces",
        ("visibility.visible_surfaces", "visibility.watkins"),
        "test_the_hidden_surface_algorithm_sees_what_a_ray_through_each_pixel_meets_first",
    ),
    (
        "Introduction: color coded scalars",
        ("scalars.computed", "mapping.bands"),
        "test_scalars_such_as_curvature_are_shown_as_colors",
    ),
    (
        "The Lighting Model: Figures 1 and 2",
        ("lighting.light", "lighting.rays"),
        "test_each_light_gives_its_intensity_times_d_cos_i_plus_s_cos_n_e",
    ),
    (
        "The Lighting Model: node normals",
        ("scene.geometry.normals", "visibility.visible_points"),
        "test_normals_are_interpolated_between_the_nodes",
    ),
    (
        "The Lighting Model: unscaled intensities, surface numbers, extremes",
        ("lighting.picture",),
        "test_intensities_are_unscaled_floats_without_an_upper_limit",
    ),
    (
        "The Lighting Model: rescaling",
        ("mapping.intensity", "scene.curves"),
        "test_intensities_are_rescaled_by_the_range_of_each_surface_or_of_the_object",
    ),
    (
        "Light Direction and Concentration: Figure 3",
        ("lighting.light", "scene.lights"),
        "test_a_directed_light_is_multiplied_by_cos_c_l",
    ),
    (
        "Light Direction and Concentration: Figure 4",
        ("lighting.light",),
        "test_aiming_takes_the_bright_spot_off_the_plane",
    ),
    (
        "Light Direction and Concentration: Figure 5",
        ("screens.light_and_view.light_and_view_screen", "screens.light_and_view.orthographic_views"),
        "test_a_light_is_moved_in_two_views_without_typing_coordinates",
    ),
    (
        "Light Direction and Concentration: Figures 6 to 8",
        ("lighting.illumination",),
        "test_each_light_can_be_shown_alone_and_the_picture_is_their_sum",
    ),
    (
        "Light Direction and Concentration: reference 2, normals in the table",
        ("mapping.normal_words",),
        "test_words_may_stand_for_normals_so_that_a_light_moves_by_entries_alone",
    ),
    (
        "Light Flaps and Cones: flaps, Figure 9",
        ("lighting.controls",),
        "test_flaps_leave_light_between_a_minimum_and_a_maximum_of_a_coordinate",
    ),
    (
        "Light Flaps and Cones: cones, Figure 10",
        ("lighting.light",),
        "test_a_cone_lights_what_is_within_its_angle_and_its_rim_is_sharp",
    ),
    (
        "Light Source Color Blending: the frame buffer and the lookup table",
        ("ramtek_emu.memory.frame_buffer", "ramtek_emu.memory.lookup_table"),
        "test_the_display_has_words_of_ten_bits_and_one_table_of_1024_entries_of_24_bits",
    ),
    (
        "Light Source Color Blending: Figure 11, a range a surface",
        ("mapping.ranges", "studio"),
        "test_recoloring_replaces_one_range_of_entries_and_computes_no_picture",
    ),
    (
        "Light Source Color Blending: Figures 12 and 15, blending",
        ("mapping.colors",),
        "test_above_the_blend_intensity_the_color_goes_in_equal_steps_to_the_light_color",
    ),
    (
        "Light Source Color Blending: Figure 13, color mixing",
        ("screens.surface.mixing_screen",),
        "test_a_color_is_mixed_by_bars_and_then_the_picture_is_sent_again",
    ),
    (
        "Light Source Color Blending: Figure 14, light blending",
        ("screens.surface.blending_screen",),
        "test_the_blend_is_picked_on_a_bar_beside_the_picture_and_shows_at_once",
    ),
)
"""A section or figure of the paper, the modules that are its subject, and the first of its tests."""


class Line(NamedTuple):
    """One statement: its kind, the module and the definition that it stands in, and its text."""

    kind: str
    module: str
    definition: str
    text: str


@cache
def lines_of_packages() -> list[Line]:
    """All lines of both packages, module by module in the order of their sources."""
    return [
        line
        for package in PACKAGES
        for path in sorted((ROOT / package).rglob("*.py"))
        for line in lines_of_source(path.read_text("utf-8"), module_of(path))
    ]


def module_of(path: Path) -> str:
    """The dotted name of a file under the root."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def lines_of_source(source: str, module: str) -> Iterator[Line]:
    """The lines in the texts and comments of a module."""
    for definition, text in (*texts(ast.parse(source), ""), *comments(source)):
        for kind, statement in statements(text):
            yield Line(kind, module, definition, statement)


def texts(node: ast.AST, definition: str) -> Iterator[tuple[str, str]]:
    """Each text that stands alone, with the definition or the constant that it describes."""
    described = definition
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.FunctionDef, ast.ClassDef)):
            yield from texts(child, f"{definition}.{child.name}".lstrip("."))
        elif isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
            if isinstance(child.value.value, str):
                yield described, child.value.value
        else:
            described = definition
            target = child.targets[0] if isinstance(child, ast.Assign) else getattr(child, "target", None)
            if isinstance(child, (ast.Assign, ast.AnnAssign)) and isinstance(target, ast.Name):
                described = f"{definition}.{target.id}".lstrip(".")


def comments(source: str) -> Iterator[tuple[str, str]]:
    """Each run of comment lines as one text."""
    run: list[str] = []
    last = 0
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type != tokenize.COMMENT:
            continue
        if token.start[0] != last + 1 and run:
            yield "", " ".join(run)
            run = []
        run.append(token.string.lstrip("# "))
        last = token.start[0]
    if run:
        yield "", " ".join(run)


def statements(text: str) -> Iterator[tuple[str, str]]:
    """The kind and the words of each statement: to the next one, the end of its paragraph or its bracket."""
    for paragraph in re.split(r"\n\s*\n", text):
        marks = list(MARK.finditer(paragraph))
        ends = [*[mark.start() for mark in marks[1:]], len(paragraph)][: len(marks)]
        for mark, end in zip(marks, ends, strict=True):
            words = " ".join(paragraph[mark.end() : end].split())
            if mark["bracket"]:
                words = words[: closing(words)]
            yield mark["kind"], words.rstrip(" .;,(") + "."


def closing(words: str) -> int:
    """Where the bracket closes that was open before the words."""
    depth = 1
    for place, letter in enumerate(words):
        depth += (letter == "(") - (letter == ")")
        if depth == 0:
            return place
    return len(words)


def full_name(module: str) -> str:
    """The dotted name of a module of `THE_PAPER`, which leaves `autocolor` out."""
    return module if module.startswith("ramtek_emu.") else f"autocolor.{module}"


def document() -> str:
    """The ledger as a document."""
    lines = lines_of_packages()
    parts = [
        "# Fidelity\n\nWhere every formula, number and rule comes from, collected from the sources by"
        ' `python -m docs.generate.fidelity > docs/FIDELITY.md`. The paper is D. R. Warn, "Lighting Controls'
        ' for Synthetic Images", SIGGRAPH 1983; [SOURCES.md](SOURCES.md) lists the sources about the'
        " hardware by their keys.\n",
        "\n## The paper: where each section and figure is built and tested\n\nThe tests are those of"
        " `tests/test_paper.py`, which goes through the paper in its order.\n\n| section or figure | module |"
        " test |\n|---|---|---|\n",
    ]
    for place, modules, test in THE_PAPER:
        listed = ", ".join(f"`{full_name(module)}`" for module in modules)
        parts.append(f"| {place} | {listed} | `{test}` |\n")
    for kind in ("Departs", "Assumed", "Paper", "Hardware", "Limit"):
        parts.append(
            f"\n## {kind}: {KINDS[kind][0].lower()}{KINDS[kind][1:]}\n\n| where | what |\n|---|---|\n"
        )
        for line in lines:
            if line.kind == kind:
                where = f"{line.module}: {line.definition}" if line.definition else line.module
                text = line.text.replace("|", "\\|")
                parts.append(f"| `{where}` | {text} |\n")
    return "".join(parts) + instructions_and_operands()


def instructions_and_operands() -> str:
    """The sources of every row of the instruction table, as a section of the ledger."""
    from ramtek_emu.instruction_set.table import OPERANDS_1, OPERANDS_2, SUBSTANTIATED, UNIMPLEMENTED

    parts = [
        "\n## Instructions and operands: where each format comes from\n\nThe rows of"
        " `ramtek_emu.instruction_set.table`.\n\n| opcode | instruction | words that follow | source |\n"
        "|---|---|---|---|\n",
        *(
            f"| {row.opcode:02X} | {row.name}: {row.meaning} | {words} | {row.source} |\n"
            for row in SUBSTANTIATED
            for words in ("named by flags" if row.fixed is None else ", ".join(row.fixed) or "none",)
        ),
        f"\nNCAR ramtek.h alone has the numbers and the names of {len(UNIMPLEMENTED)} other opcodes: ",
        ", ".join(
            f"{row.opcode:02X} {row.name}" for row in sorted(UNIMPLEMENTED, key=lambda row: row.opcode)
        ),
        ".\n\n| flag word, bit | operand | words | source |\n|---|---|---|---|\n",
    ]
    for word, operands in enumerate((OPERANDS_1, OPERANDS_2), 1):
        for bit, row in enumerate(operands):
            named = f"{row.mnemonic}: {row.name.replace('_', ' ')}"
            parts.append(f"| {word}, {bit} | {named} | {row.words} | {row.source} |\n")
    return "".join(parts)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.stdout.write(document())
