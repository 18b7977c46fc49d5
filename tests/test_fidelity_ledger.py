from __future__ import annotations

import pkgutil
import re

import pytest

from docs.generate.fidelity import (
    KINDS,
    ROOT,
    THE_PAPER,
    document,
    full_name,
    lines_of_packages,
    lines_of_source,
)

BEARING_FORMULAS = {
    "autocolor.lighting.controls",
    "autocolor.lighting.shading",
    "autocolor.lighting.picture",
    "autocolor.mapping.colors",
    "autocolor.mapping.intensity",
    "autocolor.mapping.ranges",
    "autocolor.mapping.normal_words",
    "autocolor.scene.defaults",
    "autocolor.scene.geometry.normals",
    "autocolor.scene.lights",
    "autocolor.scene.following",
    "autocolor.scene.reflection_models",
    "autocolor.scene.scene",
    "autocolor.scene.surfaces",
    "autocolor.scene.view",
    "autocolor.visibility.camera",
    "autocolor.visibility.visible_surfaces",
    "autocolor.visibility.watkins",
    "ramtek_emu.configuration",
    "ramtek_emu.drawing.curves",
    "ramtek_emu.drawing.vectors",
    "ramtek_emu.host.port",
    "ramtek_emu.instruction_set.decoder",
    "ramtek_emu.memory.character_rom",
    "ramtek_emu.memory.frame_buffer",
    "ramtek_emu.memory.lookup_table",
    "ramtek_emu.memory.parameters",
    "ramtek_emu.processor.processor",
    "ramtek_emu.timing",
    "ramtek_emu.video.scan_out",
}
"""The modules with formulas or rules."""


def test_modules_with_formulas_or_rules_say_where_they_come_from() -> None:
    assert BEARING_FORMULAS - {line.module for line in lines_of_packages()} == set()


def test_the_modules_and_tests_of_the_paper_are_there() -> None:
    source = (ROOT / "tests" / "test_paper.py").read_text("utf-8")
    for _, modules, test in THE_PAPER:
        assert f"def {test}(" in source
        for module in modules:
            assert (ROOT / f"{full_name(module).replace('.', '/')}.py").is_file(), module


def test_the_document_is_up_to_date() -> None:
    is_up_to_date = (ROOT / "docs" / "FIDELITY.md").read_text("utf-8") == document()
    assert is_up_to_date, "run: python -m docs.generate.fidelity > docs/FIDELITY.md"


def test_every_line_says_something() -> None:
    for line in lines_of_packages():
        assert line.kind in KINDS
        assert len(line.text) > 3, line


@pytest.mark.parametrize(
    "departure", ["the paper prints the test as cos(L) <= cos(A)", "linear in the picture"]
)
def test_where_the_program_differs_from_the_paper_is_in_the_ledger(departure: str) -> None:
    assert any(departure in line.text for line in lines_of_packages() if line.kind == "Departs")


def test_a_line_is_found_in_texts_constants_brackets_and_comments() -> None:
    source = '''"""Module. Paper: Figure 1. Assumed: nothing
more (at all).

Plain.
"""

NEAR = 1
"""Assumed: near."""


class Box:
    """A box (Hardware: LIN, f(x)) of words."""

    def open(self) -> None:
        # Departs: it opens
        # twice.
        pass
'''
    assert [tuple(line) for line in lines_of_source(source, "m")] == [
        ("Paper", "m", "", "Figure 1."),
        ("Assumed", "m", "", "nothing more (at all)."),
        ("Assumed", "m", "NEAR", "near."),
        ("Hardware", "m", "Box", "LIN, f(x)."),
        ("Departs", "m", "", "it opens twice."),
    ]


def test_the_guide_to_the_paper_names_modules_and_functions_of_the_program() -> None:
    text = (ROOT / "docs" / "guides" / "paper.md").read_text("utf-8")
    names = re.findall(r"`(autocolor(?:\.\w+)+)`", text)
    assert len(names) > 15
    for name in names:
        pkgutil.resolve_name(name)
