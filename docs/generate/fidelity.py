"""The fidelity ledger: the paper, where the program differs, and the sources of the instructions.

Marks in docstrings and comments say where a formula or a number comes from. `Paper:` Warn's paper;
`Hardware:` a source about the RAMTEK by its key; `Assumed:` our choice where sources are silent; `Departs:`
where the program knowingly differs; `Limit:` a bound that no source asks for, such as the largest file that
is read. `python -m docs.generate.fidelity > docs/FIDELITY.md` writes the document, with the departures.
`python -m docs.generate.fidelity --assumed` lists the statements of a mark with their lines in the code.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ramtek_emu.instruction_set.table import OPERANDS_1, OPERANDS_2, SUBSTANTIATED

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("autocolor", "ramtek_emu")
KINDS = ("Paper", "Hardware", "Assumed", "Departs", "Limit")
TEXT = re.compile(r'"""(?P<text>.*?)"""|(?P<comment>(?:^ *#[^\n]*\n)+)', re.DOTALL | re.MULTILINE)
"""A docstring, or a run of comment lines."""

MARK = re.compile(rf"\b({'|'.join(KINDS)}):\s")
SENTENCE = re.compile(r"(?<=\.)(?<!\b[A-Z]\.) ")
"""The space after a sentence. A period after an initial ends no sentence."""

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


HEAD = """# Fidelity

Where the paper is built and tested, and where the program knowingly differs from it. The paper is D. R. Warn,
"Lighting Controls for Synthetic Images", SIGGRAPH 1983.

Where the paper and the sources about the hardware are silent, a note `Assumed:` in the code has our choice
and its reason. This command lists the notes with their lines:

```
python -m docs.generate.fidelity --assumed
```

`--paper` and `--hardware` list what follows the paper and the sources about the hardware, and `--limit` our
own bounds on files, sizes and times.

## The paper, section by section

The tests are in `tests/test_paper.py`, in the order of the paper.

| section or figure | module | test |
|---|---|---|
"""


class Statement(NamedTuple):
    """What follows a mark: its kind, the file and the line of the mark, and its text."""

    kind: str
    path: str
    line: int
    text: str


def statements() -> Iterator[Statement]:
    """All statements of both packages, file by file."""
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            yield from statements_of(path.read_text("utf-8"), path.relative_to(ROOT).as_posix())


def statements_of(source: str, path: str) -> Iterator[Statement]:
    """The statements of a source. Each ends before the next, or with its paragraph."""
    for found in TEXT.finditer(source):
        text = found["text"] or re.sub(r"^( *)#", r"\1 ", found[0], flags=re.MULTILINE)
        start = found.start("text") if found["text"] else found.start()
        marks = list(MARK.finditer(text))
        for mark, end in zip(marks, [*(mark.start() for mark in marks[1:]), None], strict=False):
            paragraph = re.split(r"\n\s*\n", text[mark.end() : end])[0]
            line = source.count("\n", 0, start + mark.start()) + 1
            yield Statement(mark[1], path, line, " ".join(paragraph.split()))


def full_name(module: str) -> str:
    """The dotted name of a module of `THE_PAPER`, which leaves `autocolor` out."""
    return module if module.startswith("ramtek_emu.") else f"autocolor.{module}"


def document() -> str:
    """The ledger as a document."""
    parts = [HEAD]
    for place, modules, test in THE_PAPER:
        listed = ", ".join(f"`{full_name(module)}`" for module in modules)
        parts.append(f"| {place} | {listed} | `{test}` |\n")
    parts.append("\n## Where the program differs\n\n| where | what differs |\n|---|---|\n")
    for statement in statements():
        if statement.kind == "Departs":
            parts.append(f"| `{statement.path}` | {first_sentence(statement.text)} |\n")
    return "".join(parts) + instructions_and_operands()


def first_sentence(text: str) -> str:
    """The first sentence of a statement, with a capital."""
    sentence = SENTENCE.split(text)[0]
    return sentence[0].upper() + sentence[1:]


def instructions_and_operands() -> str:
    """The formats of the display's instructions and operands, with their sources."""
    parts = [
        "\n## Instructions and operands\n\nThe opcodes of the display, the words that follow, and the"
        " [sources](SOURCES.md) of each format. NCAR ramtek.h has the numbers and the names of other opcodes;"
        " `ramtek_emu/instruction_set/table.py` lists them.\n\n| opcode | instruction | words that follow |"
        " source |\n|---|---|---|---|\n",
        *(
            f"| {row.opcode:02X} | {row.name}: {row.meaning} | {words} | {row.source} |\n"
            for row in SUBSTANTIATED
            for words in ("by flags" if row.fixed is None else ", ".join(row.fixed) or "none",)
        ),
        "\n| flag word, bit | operand | words | source |\n|---|---|---|---|\n",
    ]
    for word, operands in enumerate((OPERANDS_1, OPERANDS_2), 1):
        for bit, row in enumerate(operands):
            named = f"{row.mnemonic}: {row.name.replace('_', ' ')}"
            parts.append(f"| {word}, {bit} | {named} | {row.words} | {row.source} |\n")
    return "".join(parts)


def listing(kind: str) -> str:
    """The statements of a kind, a line each."""
    found = [statement for statement in statements() if statement.kind == kind]
    return "".join(f"{path}:{line}: {text}\n" for _, path, line, text in found)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    option = "".join(sys.argv[1:]).removeprefix("--").capitalize()
    if option and option not in KINDS:
        sys.exit(f"an option must be one of {', '.join(f'--{kind.lower()}' for kind in KINDS)}; choose one")
    sys.stdout.write(listing(option) if option else document())
