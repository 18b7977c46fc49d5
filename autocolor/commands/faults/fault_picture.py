"""A scene whose mesh is colored by its faults: one color for each kind, light gray where there is none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from autocolor.checks import Color
from autocolor.scene.geometry.faults.mesh_faults import FAULT, KINDS, Fault, fault_scalar
from autocolor.scene.scalars.scalar import Scalar
from autocolor.scene.scene import AUTO, Scene
from autocolor.scene.surfaces import Reflectance, Surface

COLORS: Final[tuple[Color, ...]] = (
    (86, 180, 233),
    (120, 120, 220),
    (90, 90, 90),
    (250, 220, 90),
    (240, 170, 60),
    (230, 110, 30),
    (0, 170, 110),
    (200, 110, 190),
    (150, 40, 160),
    (220, 20, 40),
)
"""The color of each kind of faults, in the order of their numbers; graver ones are redder and darker."""

WITHOUT_FAULT: Final[Color] = (200, 200, 200)

SURFACE: Final = "mesh"
"""The one surface that all parts have in such a picture, so that there are levels for all kinds."""

MATTE: Final = Reflectance(0.8, 0.0)


def fault_scene(scene: Scene, faults: Sequence[Fault]) -> Scene:
    """The scene with the faults of its mesh as a scalar that colors it; its lights and view stay."""
    mesh = scene.mesh
    others = [scalar for scalar in mesh.scalars if scalar.name != FAULT]
    count = len(KINDS)
    return scene.replace(
        mesh=mesh.with_scalars(*others, fault_scalar(mesh, faults)),
        parts=tuple(part.replace(surface=SURFACE, stage=False) for part in scene.parts),
        surfaces=(Surface(SURFACE, MATTE),),
        exposure=AUTO,
        scalar=Scalar(
            name=FAULT,
            limits=(-0.5, count + 0.5),
            scale=(WITHOUT_FAULT, *COLORS),
            bands=count + 1,
        ),
    )
