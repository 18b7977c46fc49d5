"""The scripts of `examples` do what they say, in as few lines as they say."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest
from PIL import Image

from autocolor import read_palette

ROOT = Path(__file__).parents[1]
CONFIGURATOR = ROOT / "examples" / "configurator.py"


def test_the_configurator_makes_its_looks_their_sheet_and_a_turntable(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("scenes", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(CONFIGURATOR))
    assert capsys.readouterr().out == "72 looks, 0 failed\n"
    names = {path.name for path in (tmp_path / "looks").iterdir()}
    paints = read_palette(ROOT / "examples" / "paints.gpl").names
    assert len(set(paints)) == 24
    assert names == {f"{paint} {light}.png" for paint in paints for light in ("studio", "evening", "spot")}
    with Image.open("looks.png") as sheet, Image.open("turntable.webp") as film:
        assert sheet.width > 9 * 160
        assert (film.size, film.n_frames) == ((320, 240), 24)  # type: ignore[attr-defined]


def test_the_configurator_has_fifteen_lines() -> None:
    _, code = CONFIGURATOR.read_text("utf-8").split("from __future__ import annotations\n")
    assert len([line for line in code.splitlines() if line.strip()]) == 15
