"""`autocolor tables`: the tables of a scene, those that were created for it among them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.scenes import ended, read, scene_options

if TYPE_CHECKING:
    from autocolor.files.scenes.scene_report import SceneReport

EXAMPLES: Final = """\b
Examples:
  autocolor tables car.obj                  the tables as a scene file, on stdout
  autocolor tables parts/car.obj --write    as parts/scene.toml, to be edited
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option("--write", is_flag=True, help="Write them to the scene.toml beside the mesh.")
@click.option("--force", is_flag=True, help="Overwrite the scene.toml if there is one.")
@click.option("--json", "as_json", is_flag=True, help="Answer in JSON.")
@click.pass_context
def tables(
    context: click.Context, scene: str, write: bool, force: bool, as_json: bool, up: str, strict: bool
) -> None:
    """Show the parts, surfaces, lights and view of SCENE, created where they were not given."""
    report = read(scene, up)
    if write:
        path = written(report, Path(scene), force)
        click.echo(f"wrote {path}", err=True)
    elif as_json:
        from autocolor.files.scenes.plain_scene import plain_scene

        click.echo(json.dumps(plain_scene(report.scene), indent=2))
    else:
        click.echo(text_of(report), nl=False)
    context.exit(ended(report, strict))


def text_of(report: SceneReport) -> str:
    """The scene as a scene file; for a picture file, whose mesh is in it, without the mesh."""
    from autocolor.files.scenes.scene_text import scene_text

    return scene_text(report.scene, report.mesh_files)


def written(report: SceneReport, source: Path, force: bool) -> Path:
    """Write the scene file beside the mesh; UsageError for a picture file, which has no mesh beside it."""
    from autocolor.errors import UsageError
    from autocolor.files.writing import write_atomically

    if not report.mesh_files:
        raise UsageError(
            f"--write must have mesh files to stand beside, not a picture file such as {source}; name a mesh"
        )
    folder = source if source.is_dir() else source.parent
    write_atomically(folder / "scene.toml", text_of(report).encode("utf-8"), overwrite=force)
    return folder / "scene.toml"
