"""`autocolor tables`: print or write the tables of a scene, including those created from defaults."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import SceneSource, ended, read, scene_options

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport


EXAMPLES: Final = """\b
Examples:
  autocolor tables car.obj                  print a scene file for the mesh
  autocolor tables parts/car.obj --write    write it to parts/scene.toml
  autocolor tables car.npz --write          write scene.toml and the mesh of a picture file
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option("--write", is_flag=True, help="Write a scene.toml beside SCENE instead of printing it.")
@click.option("--force", is_flag=True, help="Overwrite an existing scene.toml.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_context
def tables(
    context: click.Context,
    source: SceneSource,
    write: bool,
    force: bool,
    as_json: bool,
) -> None:
    """Print the parts, surfaces, lights and view of SCENE as a scene file, including those created for it."""
    report = read(source)
    if write:
        *meshes, path = written(report, Path(source.path), force)
        tell_written(*map(str, meshes))
        click.echo(f"wrote {path}; render it by naming its folder or itself, not the mesh", err=True)
    elif as_json:
        from autocolor.files.picture_file import plain_scene

        click.echo(json.dumps(plain_scene(report.scene), indent=2))
    else:
        click.echo(text_of(report), nl=False)
    context.exit(ended(report, source))


def text_of(report: SceneReport) -> str:
    """The text of a scene file; without a mesh if the scene is from a picture file."""
    from autocolor.files.scene_toml.scene_text import scene_text

    return scene_text(report.scene, report.mesh_files)


def written(report: SceneReport, source: Path, force: bool) -> list[Path]:
    """Write the scene.toml beside the mesh, and the mesh if it has no file there; returns the files."""
    from autocolor.files.scene_writing import write_scene_with_tables

    folder = source if source.is_dir() else source.parent
    return write_scene_with_tables(folder, report.scene, overwrite=force)
