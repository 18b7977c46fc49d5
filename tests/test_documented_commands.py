"""Every command in a code block of README.md and docs ends well, in the order of its document.

In the guides, Python and the tables of scene files are run, too, in the same folder. Listings are saved under
the names in their first lines.
"""

from __future__ import annotations

import doctest
import re
import shutil
from contextlib import chdir
from pathlib import Path

import pytest

from autocolor import read_scene
from docs.generate.blocks import Command, blocks_of, commands_of
from docs.generate.commands import ROOT, here, process
from tests.ramtek_emu.serving import serving
from tests.tables import first

NOT_RUN = {
    "autocolor view coupe": "it opens a window",
    "autocolor view scenes/coupe --normals": "it opens a window",
    "autocolor view scenes/coupe --paints examples/paints.gpl": "it opens a window",
    "autocolor show scenes/coupe --to tcp://127.0.0.1:9300": "it runs until its user leaves",
    "autocolor show scenes/coupe --to tcp://127.0.0.1:9300 &": "it runs until its user leaves",
    "autocolor show scenes/coupe --to tcp://127.0.0.1:9300 --timeout 300": "it runs until its user leaves",
    "ramtek inspect chart.ramtek": "it opens a window",
    "ramtek serve --port 9300 --inspect": "it waits for hosts",
    "ramtek play fade.ramtek --loads-per-second 24": "it opens a window",
    "ramtek serve --unix /tmp/display --window &": "it waits for hosts",
    "ramtek serve --stdio -o lines.png < words > replies &": "test_emulators.py runs it with the simulator",
    "ramtek conformance -- ramtek serve --stdio --configuration {}": "it takes some minutes",
    "ramtek conformance --only princeton-9300 -- ./my_emulator": "it runs a program that the reader has",
    "ramtek serve --port 9300 --window": "it waits for hosts",
    "ramtek serve --port 9300 --joystick stick -o last.png &": "it waits for hosts",
    "ramtek serve --port 9300 --window --record session.ramtek": "it waits for hosts",
}
"""The commands that this test cannot run, each with the reason."""

CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
NODES = "".join(f"{x} {y} {z}\n" for x, y, z in CORNERS)
POLYGONS = "".join(f"3 {a} {b} {c}\n" for a, b, c in FACES)

INPUTS = {
    "looks.csv": "name,surfaces.body.object_color,lights.key.intensity\nracing,#b01020,\nevening,navy,0.5\n",
    "session.ramtek": "\0\7",
    "engine.ply": "ply\nformat ascii 1.0\nelement vertex 4\n"
    + "".join(f"property float {axis}\n" for axis in "xyz")
    + f"element face 4\nproperty list uchar int vertex_indices\nend_header\n{NODES}{POLYGONS}",
    "car.obj": "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) + "g hood\nf 1 2 4\ng floor\nf 1 3 2\n",
    "tour.csv": 'name,time,view.eye,lights.key.intensity\nstart,0,"[-6.9, -5.1, 2.1]",\n'
    'low,3,"[-7.5, 0, 0.9]",0.4\nend,4,"[-6.9, 5.1, 2.1]",\n',
    # Two streams of NOP.
    "yesterday.ramtek": "\0\a",
    "today.ramtek": "\0\a",
}
"""Files that the reader has, by the names that the documents give them."""


DOCUMENTS = {
    path.name: blocks
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
    if (blocks := blocks_of(path.read_text("utf-8")))
}

IN_ORDER = sorted(DOCUMENTS, key=("README.md", "start.md").__contains__, reverse=True)
"""First the documents that a newcomer reads."""

THE_DISPLAY = "tcp://127.0.0.1:9300"
"""The address of the display that the reader has started."""

API = "api.md"
"""The document whose examples are shown one by one on the site: none needs the names of another."""

GUIDES = {API, *(path.name for path in (ROOT / "docs" / "guides").glob("*.md"))}
"""The documents whose Python and scene files are run, too."""


def make_inputs(folder: Path) -> None:
    """The scenes and the paints of the project, and the files that the reader has."""
    for scene in (ROOT / "scenes").iterdir():
        if (scene / "scene.toml").exists():
            shutil.copytree(scene, folder / "scenes" / scene.name)
    (folder / "examples").mkdir()
    shutil.copy(ROOT / "examples" / "paints.gpl", folder / "examples")
    for name, text in INPUTS.items():
        (folder / name).write_text(text, "utf-8")


def listed_words(listing: str) -> bytes:
    """The stream of 16-bit words, low byte first, that a listing of `ramtek list` shows."""
    rows = re.findall(r"^[0-9A-F]{5}:((?: [0-9A-F]{4})+)", listing, re.MULTILINE)
    return b"".join(int(word, 16).to_bytes(2, "little") for row in rows for word in row.split())


def ended(line: str, folder: Path) -> tuple[int, str, str]:
    """The exit code, stdout and stderr of a command that is run in a folder."""
    if line.startswith("autocolor "):
        return here(line, folder)
    # `ramtek` closes its files when its process ends.
    with process(line, folder) as started:
        out, err = started.communicate("", timeout=60)
        return started.returncode, out, err


@pytest.mark.parametrize("document", first(2, IN_ORDER))
def test_every_code_block_of_a_document_ends_well(document: str, tmp_path: Path) -> None:
    make_inputs(tmp_path)
    names: dict[str, object] = {}
    with serving() as server:
        for block in DOCUMENTS[document]:
            text = block.text
            if document in GUIDES and block.language in ("python", "pycon"):
                with chdir(tmp_path):
                    run_python(
                        text.replace(THE_DISPLAY, server.address), document, {} if document == API else names
                    )
            elif document in GUIDES and block.language == "toml":
                run_scene_file(text, tmp_path)
            elif document in GUIDES and text.startswith("; "):
                (tmp_path / text[2:].split("\n")[0]).write_text(text, "utf-8")
            else:
                for line, output in commands_of(block):
                    if line not in NOT_RUN:
                        run(Command(line.replace(THE_DISPLAY, server.address), output), tmp_path)


def run(command: Command, folder: Path) -> None:
    """Run a command as the reader does, and compare its output if the document shows it."""
    line, output = command
    if output is not None and line.startswith("ramtek list "):
        (folder / line.split()[2]).write_bytes(listed_words(output))
    code, out, err = ended(line, folder)
    assert code == 0, f"{line} ended with {code}: {err}"
    assert output is None or out == output, line


def run_python(text: str, document: str, names: dict[str, object]) -> None:
    """Run statements with the names of a document. After a prompt, ">>> ", they must give what is below."""
    if not text.startswith(">>> "):
        exec(compile(text, document, "exec"), names)
        return
    examples = doctest.DocTestParser().get_doctest(text, {}, document, None, None)
    examples.globs = names
    report: list[str] = []
    doctest.DocTestRunner().run(examples, out=report.append, clear_globs=False)
    assert not report, "".join(report)


def run_scene_file(text: str, folder: Path) -> None:
    """Read the tables of a scene that a guide shows; a mesh is added if they have none."""
    path = folder / "tables of a guide.toml"
    path.write_text(text if "[[mesh]]" in text else f'{text}\n[[mesh]]\nfile = "engine.ply"\n', "utf-8")
    read_scene(path)


def test_only_commands_of_the_documents_are_not_run() -> None:
    blocks = [block for blocks in DOCUMENTS.values() for block in blocks]
    assert NOT_RUN.keys() <= {command.line for block in blocks for command in commands_of(block)}


def test_commands_are_found_in_code_blocks_alone() -> None:
    text = (
        "`autocolor a`\nautocolor b\n```\npip install x && .venv/bin/autocolor c\nautocolor d \\\n  -e  # f\n"
        'cat | ramtek g\n```\n\n```console\n$ ramtek h "#i"\nj\n\nk\n$ cat l\nm\n$ autocolor n\n```\n'
    )
    assert [command for block in blocks_of(text) for command in commands_of(block)] == [
        ("autocolor c", None),
        ("autocolor d    -e", None),
        ('ramtek h "#i"', "j\n\nk\n"),
        ("autocolor n", ""),
    ]
