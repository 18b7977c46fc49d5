"""The peers, each in a file of its own; one that is not installed or finds no OpenGL is named as absent."""

from __future__ import annotations

import os
from importlib import import_module

from autocolor import Scene
from benchmarks.peers.peer import THREADS, AbsentError, Peer

PEERS = {
    "VTK": ("benchmarks.peers.vtk_peer", "VtkPeer"),
    "OpenGL": ("benchmarks.peers.opengl_peer", "OpenGlPeer"),
    "matplotlib": ("benchmarks.peers.matplotlib_peer", "MatplotlibPeer"),
    "POV-Ray": ("benchmarks.peers.povray_peer", "PovRayPeer"),
}
"""The module and the class of each peer by its name."""

ENVIRONMENT = {
    # Mesa is to render on the processor, with so many threads, where there is more to choose from.
    "LIBGL_ALWAYS_SOFTWARE": "1",
    "GALLIUM_DRIVER": "llvmpipe",
    "LP_NUM_THREADS": str(THREADS),
    # No X server is asked for a window.
    "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow",
}


def opened(name: str, scene: Scene) -> Peer:
    """The peer of a name with a scene in it; AbsentError with the reason where it can't take part."""
    for variable, value in ENVIRONMENT.items():
        os.environ.setdefault(variable, value)
    module, peer = PEERS[name]
    try:
        made: Peer = getattr(import_module(module), peer)(scene)
    except ImportError as error:
        raise AbsentError(f"{error}; pip install '.[peers]'") from None
    return made
