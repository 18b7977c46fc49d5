"""Importing all modules of a package, for those that put what they define into a list of their package.

They are found in folders and in zip archives. A tool that makes one program of all must be told to take these
packages whole, as no import names their modules.
"""

from __future__ import annotations

import pkgutil
from importlib import import_module


def import_modules_of(name: str) -> None:
    """Import every module and package directly in the package of that name, in the order of their names."""
    for module in pkgutil.iter_modules(import_module(name).__path__, f"{name}."):
        import_module(module.name)
