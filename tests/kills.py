"""The attacks `kills`: programs are killed while they save, and the old or the new must be there.

A child process saves over what an earlier save wrote, and is killed: at a random moment of the duration that
was measured first, before a random step, which is a system call that changes names or syncs, or at a random
byte of a file. Then our readers must read the old or the new, whole, and the next save must succeed. A folder
of tables is also read while a child saves to it without end.
"""

from __future__ import annotations

import hashlib
import os
import random
import resource
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any, Final, NamedTuple
from unittest import mock

import numpy as np

from autocolor import Scene, read_journal, read_scene, render, write_scene
from autocolor.errors import AutocolorError, InputError
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.csv_tables import write_csv_tables
from autocolor.files.meshes.npy_tables import write_npy_tables
from autocolor.files.meshes.obj import write_obj
from autocolor.files.picture_file import read_picture, write_picture
from autocolor.journal.autosave import JOURNAL, Autosave, left_sessions
from autocolor.journal.history import History
from autocolor.journal.places import ScenePlace, Source, checksum_of, place_of
from autocolor.journal.saving import save_session
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar
from ramtek_emu import Ramtek9300, read_snapshot, write_snapshot, writing
from ramtek_emu.instructions import write_image
from tests.attacks import Trial
from tests.small import grid, wall_scene

STEPS: Final = ("open", "mkdir", "rename", "replace", "link", "unlink", "rmdir", "fsync")
"""The functions of `os` that are steps."""


class Killed(BaseException):
    """In a test, the moment at which a program is killed: nothing more reaches the disk."""


def killed() -> None:
    """Raise Killed."""
    raise Killed


@contextmanager
def steps(at: int, stop: Callable[[], None]) -> Iterator[list[str]]:
    """Call `stop` before each step from number `at` on; the list is of the steps before."""
    seen: list[str] = []

    def counted(name: str) -> Callable[..., Any]:
        function = getattr(os, name)

        def step(*arguments: Any, **keywords: Any) -> Any:
            if len(seen) >= at:
                stop()
            seen.append(name)
            return function(*arguments, **keywords)

        return step

    with ExitStack() as stack:
        for name in STEPS:
            stack.enter_context(mock.patch.object(os, name, counted(name)))
        yield seen


def scene_number(number: int) -> Scene:
    """A small scene that differs from that of every other number, also in how many tables it has."""
    # Two parts in one plane have a table of planes.
    decal = grid(1, 1, (-1, 0, -1), (2, 0, 0), (0, 0, 2), "decal")
    mesh = Mesh.joined([grid(3, 2 + number, (-3, 0, -3), (6, 0, 0), (0, 0, 6)), decal])
    values = np.arange(len(mesh.coordinates), dtype=np.float64) * (number + 1)
    scalars = [MeshScalar(f"scalar {each}", values + each) for each in range(number % 3)]
    scene = wall_scene(mesh.with_scalars(*scalars), ambient=0.1 + number % 90 / 100)
    return scene.with_surface(scene.surfaces[0].name, object_color=(number, 2, 3)).with_light(
        scene.lights[0].name, intensity=0.1 + number / 10
    )


class Kind(NamedTuple):
    """A way to save scene `number` to a folder, and to read a checksum of what is there."""

    save: Callable[[Path, int], object]
    read: Callable[[Path], object]


def mesh_sum(mesh: Mesh) -> str:
    """A checksum of everything of a mesh that tables may have, normals and planes included."""
    digest = hashlib.sha256(repr((mesh.part_names, mesh.crease_angle)).encode())
    tables = [mesh.coordinates, mesh.node_numbers, mesh.part_numbers, mesh.normals.vectors]
    for table in (*tables, mesh.normals.numbers, *(each.values for each in mesh.scalars)):
        digest.update(np.ascontiguousarray(table).tobytes())
    planes = mesh.shared_planes
    for table in () if planes is None else (planes.normals, planes.plane_of_polygon, planes.turned):
        digest.update(np.ascontiguousarray(table).tobytes())
    return digest.hexdigest()


def read_tables(suffix: str, folder: Path) -> str:
    """The checksum of the tables in a folder, read as a folder and by the names of two files."""
    by_folder = mesh_sum(read_scene(folder / "t").mesh)
    files = {key: folder / "t" / f"{key}.{suffix}" for key in ("nodes", "polygons")}
    assert mesh_sum(read_mesh(files).mesh) == by_folder
    return by_folder


def save_recording(path: Path, number: int) -> None:
    """Record some words, as `ramtek serve --record` does."""
    with writing.Output(path, overwrite=True) as output:
        for _ in range(20):
            output.write(bytes([number % 256]) * 1000)
        output.keep()


def save_step(folder: Path, number: int) -> None:
    """Go on with the session that is left, if any: write its journal anew, and append a line to it."""
    os.environ["XDG_STATE_HOME"] = str(folder)
    left = left_sessions()[:1]
    if left:
        history = read_journal(left[0] / JOURNAL).history
    else:
        write_scene(folder / "scene", scene_number(0))
        source = Source(str(folder / "scene"))
        history = History(read_scene(source.path), ScenePlace(source))
    autosave = Autosave(*left)
    history.take(history.scene.replace(ambient=number / 1000), False)
    autosave.update(history, at_once=True)
    history.keep(f"variant {number}")
    autosave.update(history, at_once=True)


def read_steps(folder: Path) -> object:
    """The checksum of the scene that the journal recovers."""
    os.environ["XDG_STATE_HOME"] = str(folder)
    (left,) = left_sessions()
    return checksum_of(read_journal(left / JOURNAL).history.scene)


def save_in_studio(folder: Path, number: int) -> None:
    """Save a session that changed a scene, as Ctrl+S does."""
    if not (folder / "s").exists():
        write_scene(folder / "s", scene_number(0))
    source = Source(str(folder / "s"))
    history = History(read_scene(source.path), place_of(source))
    history.take(history.scene.replace(ambient=number / 1000), False)
    save_session(history, render(history.scene, (32, 24)), folder)


def read_session(folder: Path) -> object:
    """The checksum of the scene that was saved. The pictures beside it must be whole."""
    for path in folder.glob("*.npz"):
        read_picture(path)
    return checksum_of(read_scene(folder / "s"))


def save_picture(path: Path, number: int) -> None:
    """Save a small picture of scene `number`."""
    scene = scene_number(number)
    write_picture(path, scene, render(scene, (32, 24)), overwrite=True)


def save_snapshot(path: Path, number: int) -> None:
    """Save a display whose words differ from those of every other number."""
    display = Ramtek9300()
    display.send(write_image(np.full((4, 5), number + 1)))
    write_snapshot(display, path, overwrite=True)


KINDS: Final = {
    "CSV tables": Kind(
        lambda folder, number: write_csv_tables(folder / "t", scene_number(number).mesh, overwrite=True),
        partial(read_tables, "csv"),
    ),
    "npy tables": Kind(
        lambda folder, number: write_npy_tables(folder / "t", scene_number(number).mesh, overwrite=True),
        partial(read_tables, "npy"),
    ),
    "scene folder": Kind(
        lambda folder, number: write_scene(folder / "s", scene_number(number), overwrite=True),
        lambda folder: checksum_of(read_scene(folder / "s")),
    ),
    "store": Kind(
        lambda folder, number: write_scene(folder / "s.sqlite", scene_number(number), overwrite=True),
        lambda folder: checksum_of(read_scene(folder / "s.sqlite")),
    ),
    "OBJ and library": Kind(
        lambda folder, number: write_obj(folder / "s.obj", scene_number(number), True),
        lambda folder: checksum_of(read_scene(folder / "s.obj")),
    ),
    "picture": Kind(
        lambda folder, number: save_picture(folder / "p.npz", number),
        lambda folder: checksum_of(read_picture(folder / "p.npz").scene),
    ),
    "snapshot": Kind(
        lambda folder, number: save_snapshot(folder / "s.png", number),
        lambda folder: read_snapshot(folder / "s.png").words.tobytes(),
    ),
    "recording": Kind(
        lambda folder, number: save_recording(folder / "r.ramtek", number),
        lambda folder: (folder / "r.ramtek").read_bytes(),
    ),
    "journal": Kind(save_step, read_steps),
    "session": Kind(save_in_studio, read_session),
}
"""The ways to save. Each saves over what it saved before."""

NUMBERS: Final = range(4)
"""The scenes that are saved."""


def child(save: Callable[[], object], at: int = 1 << 30, most_bytes: int = -1) -> int:
    """The process of a child that saves, and is killed before step number `at` or when a file is too long."""
    process = os.fork()
    if process:
        return process
    code = 255
    try:
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))
        with steps(at, lambda: os.kill(os.getpid(), signal.SIGKILL)) as seen:
            save()
        code = min(len(seen), 254)
    except BaseException as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
    finally:
        os._exit(code)


def steps_of(process: int) -> int | None:
    """The steps of a child that ended; None if it was killed. Raises RuntimeError if saving failed."""
    code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    if code == 255:
        raise RuntimeError("a save failed")
    return None if code < 0 else code


class Killing(Trial):
    """Saves of one kind, over an earlier save, that are killed."""

    def __init__(self, kind: Kind) -> None:
        self.kind = kind
        self.seconds, self.steps = [0.0] * len(NUMBERS), [0] * len(NUMBERS)
        self.reads: list[object] = []

    @contextmanager
    def begun(self, folder: Path) -> Iterator[None]:
        """Save each scene over another without a kill, and measure it."""
        self.saved = folder
        for number in NUMBERS:
            place = folder / str(number)
            place.mkdir()
            steps_of(child(partial(self.kind.save, place, len(NUMBERS))))
            begun = time.monotonic()
            self.steps[number] = steps_of(child(partial(self.kind.save, place, number))) or 0
            self.seconds[number] = time.monotonic() - begun
            self.reads.append(self.kind.read(place))
        yield

    def attempt(self, chance: random.Random) -> str:
        old, new, last = chance.sample(NUMBERS, 3)
        here = Path.cwd()
        shutil.copytree(self.saved / str(old), here, symlinks=True, dirs_exist_ok=True)
        way = chance.randrange(3)
        if way == 0:
            process = child(partial(self.kind.save, here, new), chance.randrange(self.steps[new] + 1))
        elif way == 1:
            sizes = [path.stat().st_size for path in (self.saved / str(new)).rglob("*") if path.is_file()]
            process = child(partial(self.kind.save, here, new), most_bytes=chance.randrange(max(sizes)))
        else:
            process = child(partial(self.kind.save, here, new))
            time.sleep(chance.uniform(0, self.seconds[new]))
            os.kill(process, signal.SIGKILL)
        steps_of(process)
        try:
            there = self.kind.read(here)
        except (AutocolorError, AssertionError, ValueError, OSError) as error:
            return f"neither the old nor the new: {type(error).__name__}: {error}"
        if there not in (self.reads[old], self.reads[new]):
            return f"neither the old nor the new: {there!r}"
        steps_of(child(partial(self.kind.save, here, last)))
        is_lost = self.kind.read(here) != self.reads[last]
        return "the next save is lost: another save is read" if is_lost else ""


class Beside(Killing):
    """A folder of tables that is read while a child saves to it without end."""

    @contextmanager
    def begun(self, folder: Path) -> Iterator[None]:
        with super().begun(folder):
            process = child(lambda: [self.kind.save(folder / "0", number) for number in cycle(NUMBERS)])
            yield
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)

    def attempt(self, chance: random.Random) -> str:
        try:
            is_whole = mesh_sum(read_scene(self.saved / "0" / "t").mesh) in self.reads
        except InputError as error:
            return "" if "tables must stay" in str(error) else f"a refusal beside a save: {error}"
        return "" if is_whole else "tables of two saves are mixed"


def trials() -> dict[str, Callable[[], Trial]]:
    """The attacks by their names."""
    killings = {name: partial(Killing, kind) for name, kind in KINDS.items()}
    return {**killings, "beside a save": partial(Beside, KINDS["npy tables"])}
