"""A sheet of pictures: each bare mesh as a new user sees it, beside PyVista's picture of it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

import numpy as np

import autocolor
from autocolor import Mesh, Scene, View
from autocolor.arrays import Bytes
from benchmarks.form.sight import subjects
from benchmarks.peers import ENVIRONMENT

WIDTH, HEIGHT, CAPTION, GAP = 320, 240, 18, 6
COLUMNS: Final = 3
PAPER, INK = (255, 255, 255), (34, 34, 34)

TRIAL: Final = "import pyvista; pyvista.Plotter(off_screen=True).screenshot(return_img=True)"


def write_sheet(path: Path, paths: Sequence[Path] = ()) -> str:
    """Write the pictures of all subjects as PNG; what is to be said of it, or nothing."""
    from PIL import Image, ImageDraw

    note = absence()
    across = (1 if note else 2) * WIDTH
    every = list(subjects(paths))
    rows = -(-len(every) // COLUMNS)
    size = (COLUMNS * (across + GAP) + GAP, rows * (HEIGHT + CAPTION + GAP) + GAP)
    sheet = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(sheet)
    for number, subject in enumerate(every):
        left = GAP + number % COLUMNS * (across + GAP)
        top = GAP + number // COLUMNS * (HEIGHT + CAPTION + GAP)
        sheet.paste(Image.fromarray(our_picture(subject.scene)), (left, top))
        if not note:
            sheet.paste(Image.fromarray(pyvista_picture(subject.scene)), (left + WIDTH, top))
        draw.text((left + 2, top + HEIGHT + 2), subject.name, fill=INK)
    path.parent.mkdir(parents=True, exist_ok=True)
    sheet.save(path)
    return f"; only ours: {note}" if note else ""


def our_picture(scene: Scene) -> Bytes:
    """Our picture of a scene."""
    return autocolor.image(scene, size=(WIDTH, HEIGHT), smooth=1)


def absence() -> str:
    """Why PyVista can't draw; nothing if it can."""
    if find_spec("pyvista") is None:
        return "pyvista is not installed; pip install '.[peers]'"
    for variable, value in ENVIRONMENT.items():
        os.environ.setdefault(variable, value)
    # Where VTK finds no OpenGL, it ends the process that asked for it.
    trial = subprocess.run([sys.executable, "-c", TRIAL], capture_output=True, text=True, check=False)
    return "" if trial.returncode == 0 else "VTK finds no OpenGL; install Mesa's EGL, libegl1"


def pyvista_picture(scene: Scene) -> Bytes:
    """PyVista's picture of a scene's mesh from the same eye, with all else as PyVista has it."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=(WIDTH, HEIGHT))
    plotter.add_mesh(_poly_data(scene.mesh))
    place_camera(plotter.camera, scene.view)
    plotter.reset_camera_clipping_range()
    picture: Bytes = np.array(plotter.screenshot(return_img=True))[..., :3]
    plotter.close()
    return picture


def place_camera(camera: Any, view: View) -> None:
    """Give a camera of PyVista's the eye, the target, the upward direction and the angle of a view."""
    camera.position = view.eye
    camera.focal_point = tuple((np.array(view.eye) + view.axes[2]).tolist())
    camera.up = tuple((-view.axes[1]).tolist())
    camera.view_angle = view.field_of_view


def _poly_data(mesh: Mesh) -> Any:
    """The mesh as PyVista takes it."""
    import pyvista

    faces = [(3, *nodes[:3]) if nodes[2] == nodes[3] else (4, *nodes) for nodes in mesh.node_numbers.tolist()]
    return pyvista.PolyData(np.array(mesh.coordinates), np.concatenate(faces))
