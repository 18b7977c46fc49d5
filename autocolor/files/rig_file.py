"""Rig files: the lights of a scene as a small TOML file, to put on another scene.

    minimum = [-2.3, -0.9, 0.0]        # the smallest and the largest coordinates of the object
    maximum = [2.3, 0.9, 1.3]

    [[lights]]                         # as in a scene file
    name = "key"
    position = [4.0, -6.0, 5.0]

Paper: "Introduction": tables with the lighting parameters can be supplied as input.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from autocolor.files.reading import read_bytes
from autocolor.files.scene_toml.scene_text import sparse_row
from autocolor.files.scene_toml.toml_edit import edited_toml
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT, SceneProblems, parsed_toml
from autocolor.files.writing import check_suffix, write_atomically
from autocolor.scene.columns import RowError, from_plain
from autocolor.scene.rigs import Rig
from autocolor.scene.scene import Scene, check_scene

RIG_SUFFIX: Final = ".toml"


def write_rig(path: str | os.PathLike[str], scene: Scene | Rig, *, overwrite: bool = False) -> None:
    """Write the lights of a scene, with the bounds of its object, to a rig file (.toml), atomically.

    `read_rig` gives back the same rig. Raises UsageError for a path with another suffix; InputError for a
    name of a light that UTF-8 cannot hold; OutputError if the file exists and `overwrite` is false, or if it
    cannot be created; WriteError if writing fails.
    """
    check_suffix(path, RIG_SUFFIX, "a rig")
    if not isinstance(scene, Rig):
        check_scene(scene)
    rig = scene if isinstance(scene, Rig) else scene.rig
    lights = [sparse_row(light) for light in rig.lights]
    data = edited_toml(b"", {"minimum": rig.minimum, "maximum": rig.maximum, "lights": lights}) or b""
    write_atomically(path, data, overwrite=overwrite)


def read_rig(path: str | os.PathLike[str]) -> Rig:
    """The rig of a rig file; `scene.with_rig(rig)` puts its lights on a scene.

    Raises InputError with every problem and its line, MissingInputError if there is no such file.
    """
    path = Path(path)
    data = read_bytes(path, LARGEST_TEXT)
    document = parsed_toml(data, path.name, "a rig file")
    problems = SceneProblems(path.name, data, document)
    try:
        return from_plain(Rig, document)
    except RowError as error:
        problems.note_all(error.row_problems)
        problems.raise_any()
        raise
