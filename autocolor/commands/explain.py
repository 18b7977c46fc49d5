"""`autocolor explain`: explain a pixel of a scene, from the nodes to the color."""

from __future__ import annotations

import json
from typing import Final

import click

from autocolor.commands.scenes import SceneSource, ended, read_edited, scene_options
from ramtek_emu.command_line import tell

EXAMPLES: Final = """\b
Examples:
  autocolor explain scenes/coupe 240 320
  autocolor explain scenes/coupe 240 320 --json
  autocolor explain car.obj 480 640 --size 1280x960 --set ambient=0.2
"""


@click.command(epilog=EXAMPLES)
@scene_options("settings", "stage", "size")
@click.argument("line", type=int)
@click.argument("element", type=int)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, with all lights.")
def explain(source: SceneSource, line: int, element: int, as_json: bool) -> int:
    """Explain why the pixel at LINE and ELEMENT of SCENE looks as it does.

    You see the rows of the tables, the point and its normal, each light by the equation of the paper, the
    level, the word and the color. Lines are counted from the top and elements from the left, from 0; rows of
    tables are counted from 1.
    """
    from autocolor.explanation.explain import explain as explained
    from autocolor.explanation.text import rows_of_text
    from autocolor.images import display_image
    from autocolor.rendering import rendering
    from autocolor.visibility.visible_points import Sight

    elements, lines = source.size
    scene, report = read_edited(source)
    rendered = rendering(scene, lines, elements)
    image = display_image(scene, rendered.picture)
    explanation = explained(Sight(scene, rendered.points), image, line, element)
    if as_json:
        click.echo(json.dumps(explanation.to_plain(), indent=2))
    else:
        tell(*map(str, rows_of_text(explanation)), err=False)
    return ended(report, source)
