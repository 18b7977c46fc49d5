"""`autocolor tables`: print or write a complete scene file, with the tables created for the scene."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Final

import click

from autocolor.commands.options import flag, force_option, json_option
from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from ramtek_emu.command_line import tell

EXAMPLES: Final = """\b
Examples:
  autocolor tables car.obj                  print a scene file for the mesh
  autocolor tables parts/car.obj --write    write it to parts/scene.toml
  autocolor tables car.npz --write          write scene.toml and the mesh of a picture file
"""


@click.command(epilog=EXAMPLES)
@scene_options()
@flag("--write", "Write a scene.toml beside SCENE instead of printing it.")
@force_option
@json_option
def tables(source: SceneSource, write: bool, force: bool, as_json: bool) -> int:
    """Print a complete scene file of SCENE, with the parts, surfaces, lights and view created for it."""
    report = read(source)
    if write:
        from autocolor.files.scene_writing import write_scene

        path = Path(source.path)
        folder = path if path.is_dir() else path.parent
        *meshes, scene_file = write_scene(folder, report.scene, overwrite=force, complete=True)
        tell_written(*map(str, meshes))
        tell(f"wrote {scene_file}; to render it, name it or its folder, not the mesh")
    elif as_json:
        from autocolor.files.picture_file import plain_scene

        click.echo(json.dumps(plain_scene(report.scene), indent=2))
    else:
        from autocolor.files.scene_toml.scene_text import scene_text

        # The scene of a picture file has no mesh files.
        click.echo(scene_text(report.scene, report.mesh_files), nl=False)
    return ended(report, source)
