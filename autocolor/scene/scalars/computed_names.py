"""The names of the scalars that are computed of any mesh; `autocolor.scalars` computes them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from autocolor.checks import nearest, shown
from autocolor.scene.columns.problems import Problem
from autocolor.scene.scalars.mesh_scalars import MeshScalar

COMPUTED: Final = (
    "x",
    "y",
    "z",
    "distance",
    "slope",
    "draft angle",
    "mean curvature",
    "gaussian curvature",
    "largest curvature",
    "smallest curvature",
    "zebra",
)
"""Assumed: a scalar of the mesh hides a computed one of its name, since the file's own numbers are meant."""


def name_problems(name: str, scalars: Iterable[MeshScalar]) -> Iterator[Problem]:
    """What is wrong with the name of the scalar to show, given the scalars of the mesh."""
    known = [*(scalar.name for scalar in scalars), *COMPUTED]
    if name not in known:
        rule = "must be a scalar of the mesh or a computed one"
        yield Problem(("scalar", "name"), f"{rule}, not {shown(name)}{nearest(name, known)}")
