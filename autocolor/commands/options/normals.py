"""`--normals`: words that stand for normals, so that lights move by loads of the table alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from autocolor.commands.options.usage import as_usage

if TYPE_CHECKING:
    from autocolor.scene.scene import Scene

normals_option = click.option(
    "--normals",
    is_flag=True,
    help="Let words stand for normals: lights change entries alone; they and the eye are taken as far away.",
)


def with_normals(scene: Scene, normals: bool) -> Scene:
    """The scene, whose words stand for normals if that is asked for.

    Raises UsageError where a scalar colors its surfaces.
    """
    if not normals:
        return scene
    with as_usage("--normals: "):
        return scene.replace(words="normals")
