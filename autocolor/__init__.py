"""GMR AUTOCOLOR: light a scene, look at it on a RAMTEK 9300, and recolor it without computing it again.

Paper: D. R. Warn, "Lighting Controls for Synthetic Images", SIGGRAPH 1983.

    studio = autocolor.Studio(autocolor.read_scene("scenes/coupe"))
    studio.recolor("body", object_color="#1f3f8f", blend=0.3)
    studio.save_image("coupe.png")
"""

from __future__ import annotations

# Nothing is imported at once: a command can handle Ctrl+C only afterwards.
TYPE_CHECKING: Final = False
if TYPE_CHECKING:
    from typing import Final

    from autocolor.batches.films import animate as animate
    from autocolor.batches.frames import frames as frames
    from autocolor.batches.making import VariantWarning as VariantWarning
    from autocolor.batches.making import batch as batch
    from autocolor.batches.making import batch_results as batch_results
    from autocolor.batches.table import Variant as Variant
    from autocolor.batches.table import grid as grid
    from autocolor.batches.table import read_variants as read_variants
    from autocolor.commands.demo import demo as demo
    from autocolor.commands.window import view as view
    from autocolor.errors import AutocolorError as AutocolorError
    from autocolor.errors import EditWarning as EditWarning
    from autocolor.errors import InputError as InputError
    from autocolor.errors import MissingInputError as MissingInputError
    from autocolor.errors import OutputError as OutputError
    from autocolor.errors import UnavailableError as UnavailableError
    from autocolor.errors import UsageError as UsageError
    from autocolor.errors import WriteError as WriteError
    from autocolor.files.opening import read_scene as read_scene
    from autocolor.files.palette_file import Palette as Palette
    from autocolor.files.palette_file import read_palette as read_palette
    from autocolor.files.palette_file import write_palette as write_palette
    from autocolor.files.picture_file import read_picture as read_picture
    from autocolor.files.picture_file import write_picture as write_picture
    from autocolor.files.rig_file import read_rig as read_rig
    from autocolor.files.rig_file import write_rig as write_rig
    from autocolor.files.scene_writing import write_scene as write_scene
    from autocolor.files.store.tables import open_tables as open_tables
    from autocolor.images import image as image
    from autocolor.images import save_image as save_image
    from autocolor.images import save_words as save_words
    from autocolor.images import send_picture as send_picture
    from autocolor.journal.journal import read_journal as read_journal
    from autocolor.layers import save_layers as save_layers
    from autocolor.lighting.picture import Picture as Picture
    from autocolor.mapping.ranges import LevelRange as LevelRange
    from autocolor.rendering import render as render
    from autocolor.scene.creation import scene_of as scene_of
    from autocolor.scene.lights import Flap as Flap
    from autocolor.scene.lights import Flaps as Flaps
    from autocolor.scene.lights import HalfSpace as HalfSpace
    from autocolor.scene.lights import Light as Light
    from autocolor.scene.mesh import Mesh as Mesh
    from autocolor.scene.reflection_models import BlinnPhong as BlinnPhong
    from autocolor.scene.reflection_models import CookTorrance as CookTorrance
    from autocolor.scene.reflection_models import Phong as Phong
    from autocolor.scene.rigs import Rig as Rig
    from autocolor.scene.scalar import MeshScalar as MeshScalar
    from autocolor.scene.scalar import Scalar as Scalar
    from autocolor.scene.scene import Scene as Scene
    from autocolor.scene.surfaces import Paint as Paint
    from autocolor.scene.surfaces import Part as Part
    from autocolor.scene.surfaces import Reflectance as Reflectance
    from autocolor.scene.surfaces import Surface as Surface
    from autocolor.scene.view import NamedView as NamedView
    from autocolor.scene.view import View as View
    from autocolor.studio import Studio as Studio
    from autocolor.web.page import save_page as save_page

    __version__: str

_HOME: Final = {
    "AutocolorError": "errors",
    "BlinnPhong": "scene.reflection_models",
    "CookTorrance": "scene.reflection_models",
    "EditWarning": "errors",
    "Flap": "scene.lights",
    "Flaps": "scene.lights",
    "HalfSpace": "scene.lights",
    "InputError": "errors",
    "LevelRange": "mapping.ranges",
    "Light": "scene.lights",
    "Mesh": "scene.mesh",
    "MeshScalar": "scene.scalar",
    "MissingInputError": "errors",
    "NamedView": "scene.view",
    "OutputError": "errors",
    "Paint": "scene.surfaces",
    "Palette": "files.palette_file",
    "Part": "scene.surfaces",
    "Phong": "scene.reflection_models",
    "Picture": "lighting.picture",
    "Reflectance": "scene.surfaces",
    "Rig": "scene.rigs",
    "Scalar": "scene.scalar",
    "Scene": "scene.scene",
    "Studio": "studio",
    "Surface": "scene.surfaces",
    "UnavailableError": "errors",
    "UsageError": "errors",
    "Variant": "batches.table",
    "VariantWarning": "batches.making",
    "View": "scene.view",
    "WriteError": "errors",
    "animate": "batches.films",
    "batch": "batches.making",
    "batch_results": "batches.making",
    "demo": "commands.demo",
    "frames": "batches.frames",
    "grid": "batches.table",
    "image": "images",
    "open_tables": "files.store.tables",
    "read_journal": "journal.journal",
    "read_palette": "files.palette_file",
    "read_picture": "files.picture_file",
    "read_rig": "files.rig_file",
    "read_scene": "files.opening",
    "read_variants": "batches.table",
    "render": "rendering",
    "save_image": "images",
    "save_layers": "layers",
    "save_page": "web.page",
    "save_words": "images",
    "scene_of": "scene.creation",
    "send_picture": "images",
    "view": "commands.window",
    "write_palette": "files.palette_file",
    "write_picture": "files.picture_file",
    "write_rig": "files.rig_file",
    "write_scene": "files.scene_writing",
}

__all__ = list(_HOME)


_NOT_INSTALLED: Final = "0+unknown"
"""The version of a checkout that was never installed."""


def __getattr__(name: str) -> object:
    """A public name, from the module that defines it, or the version; found when it is first asked for."""
    if name not in _HOME and name != "__version__":
        from autocolor.checks import missing_attribute

        raise missing_attribute(f"module {__name__!r}", name, __all__)
    from importlib import import_module

    value = _version() if name == "__version__" else getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, "__version__", *(name for name in globals() if name.startswith("__"))})


def _version() -> str:
    """The version of the installed distribution."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("autocolor")
    except PackageNotFoundError:
        return _NOT_INSTALLED
