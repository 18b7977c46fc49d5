"""Formats of mesh files: a registry that each format enters where it is defined.

A format is a module, or a folder, beside this one that calls `register`; nothing else names it. It is chosen
by the end of a file's name, or by how the file begins where that says nothing.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.reading import read_head
from autocolor.files.repair.polygons import MeshReport

MeshReader = Callable[..., MeshReport]
"""Reads the mesh of the files of a format, each an argument; keywords are `up`, the file's up axis, and
`crease_angle`, None for the usual one. Raises InputError."""


@dataclass(frozen=True)
class MeshFormat:
    """One format.

    `keys` are those of a `[[mesh]]` that name its files; `suffixes` are how the first of these may end, in
    small letters. `in_folder` are the names of files that make a folder a mesh. `begins` tells by a file's
    first bytes whether it may be one.
    """

    name: str
    read: MeshReader
    suffixes: tuple[str, ...] = ()
    keys: tuple[str, ...] = ("file",)
    in_folder: tuple[str, ...] = ()
    begins: Callable[[bytes], bool] | None = None


_REGISTERED: Final[list[MeshFormat]] = []


def register(mesh_format: MeshFormat) -> MeshFormat:
    """Enter a format."""
    _REGISTERED.append(mesh_format)
    return mesh_format


@cache
def mesh_formats() -> tuple[MeshFormat, ...]:
    """Every format, in the order of their names."""
    package = import_module(__name__.rpartition(".")[0])
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        import_module(module.name)
    return tuple(sorted(_REGISTERED, key=lambda each: each.name))


def mesh_suffixes() -> tuple[str, ...]:
    """How the names of mesh files end."""
    return tuple(suffix for each in mesh_formats() if each.keys == ("file",) for suffix in each.suffixes)


def format_of(path: Path) -> MeshFormat | None:
    """The format of a single file, by its name, else by how it begins; None for no known one."""
    single = [each for each in mesh_formats() if each.keys == ("file",)]
    suffix = path.suffix.lower()
    named = next((each for each in single if suffix in each.suffixes), None)
    if named is not None or not any(each.begins for each in single):
        return named
    head = read_head(path)
    return next((each for each in single if each.begins is not None and each.begins(head)), None)


def format_of_folder(folder: Path) -> MeshFormat | None:
    """The format of which a folder is a mesh; None for none."""
    return next(
        (
            each
            for each in mesh_formats()
            if each.in_folder and all((folder / name).exists() for name in each.in_folder)
        ),
        None,
    )


def read_mesh(files: Mapping[str, Path], *, up: str = "z", crease_angle: float | None = None) -> MeshReport:
    """The mesh of the files that the keys of a `[[mesh]]` name, and what was repaired. Raises InputError."""
    if tuple(files) == ("file",):
        found = format_of(files["file"])
    else:
        found = next((each for each in mesh_formats() if each.keys == tuple(files)), None)
    if found is None:
        path = next(iter(files.values()))
        raise InputError(
            f"{path.name}: a mesh file must end in {' or '.join(mesh_suffixes())}, not in {path.suffix!r};"
            " export it as one of these"
        )
    return found.read(*files.values(), up=up, crease_angle=crease_angle)
