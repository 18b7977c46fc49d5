"""A scene as the text of a scene file, with every table written out; reading it back gives the same scene."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from typing import Final

from autocolor.scene.lights import Flap, Light
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface

BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]{1,100}")


def scene_text(scene: Scene, mesh_files: Sequence[Mapping[str, str]]) -> str:
    """The scene as TOML; `mesh_files` are the `[[mesh]]` tables that lead to its mesh (see SceneReport).

    The name of the scene is not written: it is that of the folder or the file that the text is saved to.
    """
    table = {
        "ambient": scene.ambient,
        "scaling": scene.scaling,
        "mapping": scene.mapping,
        "contrast": scene.contrast,
        "background": _color(scene.background),
    }
    if not scene.lights:
        table["lights"] = ()
    view = {key: getattr(scene.view, key) for key in ("eye", "direction", "target", "angle", "field_of_view")}
    blocks = [_table("", table), _table("[view]", view)]
    for row, files in enumerate(mesh_files):
        angle = {} if row else {"crease_angle": scene.mesh.crease_angle}
        blocks.append(_table("[[mesh]]", {**files, **angle}))
    blocks += [_table(f"[parts.{_key(part.name)}]", {"surface": part.surface}) for part in scene.parts]
    blocks += [_table(f"[surfaces.{_key(surface.name)}]", _surface(surface)) for surface in scene.surfaces]
    blocks += [_table("[[lights]]", _light(light)) for light in scene.lights]
    return "\n".join(blocks)


def _surface(surface: Surface) -> dict[str, object]:
    reflectance, paint = surface.reflectance, surface.paint
    return {
        "diffuse": reflectance.diffuse,
        "specular": reflectance.specular,
        "exponent": reflectance.exponent,
        "object_color": _color(paint.object_color),
        "light_color": _color(paint.light_color),
        "blend": paint.blend,
        "light_percentage": paint.light_percentage,
        "two_sided": surface.two_sided,
        "levels": surface.levels,
    }


def _light(light: Light) -> dict[str, object]:
    flaps = {
        f"flaps.{axis}": _flap(flap) for axis in "xyz" if (flap := getattr(light.flaps, axis)) is not None
    }
    return {
        "name": light.name,
        "position": light.position,
        "intensity": light.intensity,
        "on": light.on,
        "direction": light.direction,
        "aim": light.aim,
        "concentration": light.concentration,
        "cone_angle": light.cone_angle,
        **flaps,
    }


def _flap(flap: Flap) -> dict[str, object]:
    """The keys of a flap; a minimum or maximum that is nowhere is left out."""
    ends = {name: end for name in ("minimum", "maximum") if math.isfinite(end := getattr(flap, name))}
    return {**ends, "on": flap.on}


def _table(header: str, keys: Mapping[str, object]) -> str:
    lines = [header] if header else []
    lines += [f"{key} = {_value(value)}" for key, value in keys.items() if value is not None]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if BARE_KEY.fullmatch(name) else _value(name)


def _value(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_value(inner)}' for key, inner in value.items())} }}"
    if isinstance(value, (str, bool)):
        # TOML escapes what JSON escapes, and one more.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)


def _color(color: tuple[int, int, int]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*color)
