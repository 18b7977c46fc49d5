"""Where meshes were read from, so that a scene that is written can name the same files.

What was read from where is kept beside the meshes, which know nothing of files, and forgotten with them.
Whoever names a file again must compare what it holds: it may have been changed since.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from weakref import WeakKeyDictionary

from autocolor.scene.mesh import Mesh


@dataclass(frozen=True)
class MeshSource:
    """The `[[mesh]]` tables that a mesh was read with, and the absolute folder that their files are in.

    `scene_file` is the scene file that has these tables, None if the mesh was read without one.
    """

    folder: Path
    entries: tuple[Mapping[str, Any], ...]
    scene_file: Path | None = None


_SOURCES: Final[WeakKeyDictionary[Mesh, MeshSource]] = WeakKeyDictionary()


def keep_source(mesh: Mesh, source: MeshSource) -> None:
    """Keep where a mesh was read from."""
    _SOURCES[mesh] = source


def source_of(mesh: Mesh) -> MeshSource | None:
    """Where a mesh was read from; None if it was made in memory or is that of a picture file."""
    return _SOURCES.get(mesh)
