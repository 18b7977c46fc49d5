"""Kill programs while they save, at random moments and at every step, and require the old or the new.

    python -m tests.kills --count 500
    python -m tests.kills --count 100 --kind "npy tables" --seed 7

A child process saves over what an earlier save wrote, and is killed: every other time at a random moment of
the duration that was measured first, otherwise before a random step, which is a system call that changes
names or syncs. Then our readers must read the old or the new, whole, and the next save must succeed and leave
no temporary file. A folder of tables is also read while a child saves to it without end. The exit code is 1
if anything else was read.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random
import shutil
import signal
import sqlite3
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any, Final, NamedTuple
from unittest import mock

import numpy as np

from autocolor import Scene, read_journal, read_scene, render, scene_of, write_scene
from autocolor.errors import AutocolorError, InputError
from autocolor.files.conversion import write_obj
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.csv_tables import write_csv_tables
from autocolor.files.meshes.npy_tables import write_npy_tables
from autocolor.files.picture_file import read_picture, write_picture
from autocolor.files.reading import COMMITTED
from autocolor.files.rig_file import read_rig, write_rig
from autocolor.journal.autosave import Autosave, journal_in, left_sessions
from autocolor.journal.history import History
from autocolor.journal.places import ScenePlace, Source, checksum_of, place_of
from autocolor.journal.saving import save_session
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar
from ramtek_emu import Ramtek9300, read_snapshot, write_snapshot, writing
from ramtek_emu.instructions import write_image
from ramtek_emu.png import save_png
from tests.autocolor.decals import decal_on_ground

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
    mesh, view = decal_on_ground(number)
    values = np.arange(len(mesh.coordinates), dtype=np.float64) * (number + 1)
    scalars = [MeshScalar(f"scalar {each}", values + each) for each in range(number % 3)]
    return scene_of(mesh.with_scalars(*scalars), view=view, ambient=0.1 + number % 90 / 100)


def colored(number: int) -> Scene:
    """Scene `number` with its own surface and its own light."""
    scene = scene_number(number)
    name = scene.surfaces[0].name
    return scene.with_surface(name, object_color=(number, 2, 3)).with_light(
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


def read_saved_store(folder: Path) -> object:
    """The checksum of the scene in a store. If a change was killed, SQLite first rolls it back."""
    path = folder / "s.sqlite"
    try:
        return checksum_of(read_scene(path))
    except InputError:
        with closing(sqlite3.connect(path)) as connection:
            connection.execute("SELECT count(*) FROM sqlite_schema")
        return checksum_of(read_scene(path))


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
        history = read_journal(journal_in(left[0])).history
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
    return checksum_of(read_journal(journal_in(left)).history.scene)


def save_in_studio(folder: Path, number: int) -> None:
    """Save a session that changed a scene, as Ctrl+S does."""
    if not (folder / "s").exists():
        write_scene(folder / "s", scene_number(0))
    source = Source(str(folder / "s"))
    history = History(read_scene(source.path), place_of(source))
    history.take(history.scene.replace(ambient=number / 1000), False)
    save_session(history, render(history.scene, 24, 32), folder)


def read_session(folder: Path) -> object:
    """The checksum of the scene that was saved. The pictures beside it must be whole."""
    for path in folder.glob("*.npz"):
        read_picture(path)
    return checksum_of(read_scene(folder / "s"))


def save_picture(path: Path, number: int) -> None:
    """Save a small picture of scene `number`."""
    scene = scene_number(number)
    write_picture(path, scene, render(scene, 24, 32), overwrite=True)


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
        read_saved_store,
    ),
    "OBJ and library": Kind(
        lambda folder, number: write_obj(folder / "s.obj", colored(number), True),
        lambda folder: checksum_of(read_scene(folder / "s.obj")),
    ),
    "picture": Kind(
        lambda folder, number: save_picture(folder / "p.npz", number),
        lambda folder: checksum_of(read_picture(folder / "p.npz").scene),
    ),
    "PNG": Kind(
        lambda folder, number: save_png(np.full((9, 9, 3), number, np.uint8), folder / "p.png"),
        lambda folder: (folder / "p.png").read_bytes(),
    ),
    "rig": Kind(
        lambda folder, number: write_rig(folder / "r.toml", colored(number), overwrite=True),
        lambda folder: repr(read_rig(folder / "r.toml")),
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


def child(save: Callable[[], object], at: int = 1 << 30) -> int:
    """The process of a child that saves, and kills itself before step number `at`."""
    process = os.fork()
    if process:
        return process
    code = 255
    try:
        # The child is a new program as to the folders that it swept.
        writing._SWEPT.clear()
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


class Prepared(NamedTuple):
    """The folder with a saved scene, its checksum, the seconds of saving over another, and the steps."""

    folder: Path
    read: object
    seconds: float
    steps: int


def prepared(kind: Kind, number: int, folder: Path) -> Prepared:
    """Save scene `number` over another, without a kill."""
    folder.mkdir()
    steps_of(child(lambda: kind.save(folder, len(NUMBERS))))
    begun = time.monotonic()
    count = steps_of(child(lambda: kind.save(folder, number)))
    assert count is not None
    return Prepared(folder, kind.read(folder), time.monotonic() - begun, count)


def attacked(kind: Kind, count: int, dice: random.Random, place: Path) -> Counter[str]:
    """Kill saving `count` times; the counts of what was there afterwards."""
    ready = [prepared(kind, number, place / str(number)) for number in NUMBERS]
    counts = Counter[str]()
    number = 0
    while counts["kills"] < count:
        number += 1
        old, new, last = dice.sample(NUMBERS, 3)
        folder = place / "work"
        shutil.copytree(ready[old].folder, folder, symlinks=True)
        # SQLite makes its steps itself.
        if number % 2 and ready[new].steps > 2:
            process = child(partial(kind.save, folder, new), dice.randrange(ready[new].steps))
        else:
            process = child(partial(kind.save, folder, new))
            time.sleep(dice.uniform(0, ready[new].seconds))
            os.kill(process, signal.SIGKILL)
        counts["kills" if steps_of(process) is None else "late"] += 1
        counts[state(kind, folder, {"old": ready[old].read, "new": ready[new].read})] += 1
        try:
            steps_of(child(partial(kind.save, folder, last)))
            if kind.read(folder) != ready[last].read:
                counts["next save lost"] += 1
        except (RuntimeError, AutocolorError):
            counts["next save lost"] += 1
        counts["left over"] += len(list(folder.rglob("*.part"))) + len(list(folder.rglob(COMMITTED)))
        shutil.rmtree(folder)
    return counts


def state(kind: Kind, folder: Path, reads: Mapping[str, object]) -> str:
    """Which of the saves is in a folder: a key of `reads`, or "neither"."""
    try:
        there = kind.read(folder)
    except (AutocolorError, AssertionError, ValueError, OSError) as error:
        print(f"{folder}: {type(error).__name__}: {error}", file=sys.stderr)
        return "neither"
    return next((name for name, read in reads.items() if read == there), "neither")


def read_beside(kind: Kind, count: int, place: Path) -> Counter[str]:
    """Read a folder while a child saves to it without end; the counts of what was read."""
    ready = [prepared(kind, number, place / f"beside {number}") for number in NUMBERS]
    folder = ready[0].folder

    def save_without_end() -> None:
        for number in cycle(NUMBERS):
            kind.save(folder, number)

    process = child(save_without_end)
    counts = Counter[str]()
    try:
        for _ in range(count):
            try:
                there = mesh_sum(read_scene(folder / "t").mesh)
            except InputError as error:
                print(error, file=sys.stderr)
                counts["refused" if "tables must stay" in str(error) else "neither"] += 1
                continue
            number = next((number for number in NUMBERS if ready[number].read == there), None)
            counts["neither" if number is None else "new" if number else "old"] += 1
    finally:
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
    return counts


COLUMNS: Final = ("kills", "late", "old", "new", "neither", "refused", "next save lost", "left over")


def main() -> int:
    """Print the table; returns 1 if anything was lost."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--count", type=int, default=500, help="kills, over all kinds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=KINDS, action="append", help="only this kind")
    parser.add_argument("--reads", type=int, default=500, help="reads beside a program that saves")
    options = parser.parse_args()
    dice = random.Random(options.seed)
    kinds = options.kind or list(KINDS)
    print("| kind |", " | ".join((*COLUMNS, "seconds")), "|")
    print("|---|" + "---|" * (len(COLUMNS) + 1))
    is_lost = False
    for number, name in enumerate(kinds):
        share = options.count // len(kinds) + (number < options.count % len(kinds))
        attacks = {name: partial(attacked, KINDS[name], share, dice)}
        if name.endswith("tables"):
            attacks[f"{name}, read beside"] = partial(read_beside, KINDS[name], options.reads)
        for row, attack in attacks.items():
            begun = time.monotonic()
            with tempfile.TemporaryDirectory(prefix="kills-") as place:
                counts = attack(Path(place))
            cells = [f"{counts[column]:,}" for column in COLUMNS]
            print(f"| {row} |", " | ".join(cells), f"| {time.monotonic() - begun:.0f} |", flush=True)
            is_lost |= any(counts[column] for column in ("neither", "next save lost", "left over"))
    return int(is_lost)


if __name__ == "__main__":
    sys.exit(main())
