"""The targets of `python -m tests.fuzz`: all readers of bytes from outside, and the oracle that judges them.

An input is written to the files of its target in an empty folder, the current one, and read. The result must
hold what its type promises, or the input must be refused by an error of ours in short printable sentences.
Any other exception is a fault. So are warnings, too much time or memory, and files, descriptors, threads and
processes that are left. The table TARGETS is at the foot.
"""

from __future__ import annotations

import base64
import contextlib
import gc
import io
import json
import os
import random
import resource
import shutil
import socket
import struct
import tempfile
import threading
import time
import traceback
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, partial
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from autocolor import (
    Mesh,
    Scene,
    Studio,
    Variant,
    read_journal,
    read_palette,
    read_picture,
    read_rig,
    read_scene,
    read_variants,
    render,
    write_palette,
    write_picture,
    write_rig,
)
from autocolor.batches.outputs import Pattern
from autocolor.batches.table import varied
from autocolor.commands.settings import with_settings
from autocolor.commands.show import session_elsewhere, show_once
from autocolor.commands.sql import lines_of, statements_in
from autocolor.errors import AutocolorError, InputError
from autocolor.files.formats import MESH_FORMATS
from autocolor.files.meshes.foreign import FOREIGN
from autocolor.files.palette_file import PALETTE_FORMATS
from autocolor.files.scene_sources import read_scene_with_report
from autocolor.files.settings import scene_with
from autocolor.files.state import COLORS, FILES, recent_colors, recent_files
from autocolor.files.store.store_file import write_store
from autocolor.files.store.tables import tables_of
from autocolor.images import display_image
from autocolor.journal.autosave import left_sessions
from autocolor.journal.history import History
from autocolor.journal.places import Source
from ramtek_emu import GMR_9300, NCAR_9460, PRINCETON_9300, Configuration, Ramtek9300, TcpPort, UnixPort
from ramtek_emu.errors import RamtekError
from ramtek_emu.host.joystick import actions, opened
from ramtek_emu.host.joystick import lines_of as joystick_lines
from ramtek_emu.host.server import TcpServer, UnixServer
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.snapshot import read_snapshot, snapshot_bytes
from tests.autocolor.files.store.stores import small_scene
from tests.mutations import Seed, seeds

BETWEEN = b"\n-- the next file --\n"
"""What divides the files of an input that has several."""

MOST_SECONDS = 5.0
"""Seconds of the processor."""

FREE_MEMORY = 128 << 20
TIMES_THE_INPUT = 100
"""The bytes of memory for any input, and for each byte of an input. An OBJ polygon in text takes 20 bytes;
its mesh, its normals and the arrays of their computation take some hundred."""

SMALL = Configuration(name="small", elements=64, lines=48, planes=10)
"""The display of most inputs, which takes a hundredth of the time of the usual one."""

PALETTES = ("paints.gpl", "paints.csv", "paints.act")

LONGEST_SENTENCE = 4000
MOST_SENTENCES = 101


class Target(NamedTuple):
    """A reader of bytes: `run` reads an input, and returns a fault of the result, "" if it is sound.

    The pieces of an input are written to files with these `names`. `packed` converts the pieces before, for
    example to an archive of them. Inputs have at most `largest` bytes.
    """

    samples: Callable[[], Iterable[bytes]]
    run: Callable[[bytes], str]
    names: tuple[str, ...] = ()
    packed: Callable[[list[bytes]], list[bytes]] = lambda pieces: pieces
    largest: int = 1 << 16

    def files(self, data: bytes) -> dict[str, bytes]:
        """The contents of the files of an input, by their names."""
        pieces = data.split(BETWEEN)
        return dict(zip(self.names, self.packed(pieces), strict=False)) if self.names else {}


class Fault(NamedTuple):
    """What is wrong: its kind, by which faults with one cause are one, and the whole story."""

    kind: str
    story: str


# The oracle.


class Arena:
    """The current folder, the folder for temporary files and the state folder of the inputs."""

    def __init__(self, root: Path) -> None:
        self.here, self.temporary, self.state = root / "here", root / "temporary", root / "state"
        for folder in (self.here, self.temporary, self.state):
            folder.mkdir()
        self._surroundings = os.environ.get("XDG_STATE_HOME"), tempfile.tempdir, os.getcwd()
        os.chdir(self.here)
        os.environ["XDG_STATE_HOME"], tempfile.tempdir = str(self.state), str(self.temporary)

    def close(self) -> None:
        """Let the program have its own folders again."""
        home, tempfile.tempdir, folder = self._surroundings
        os.chdir(folder)
        os.environ.pop("XDG_STATE_HOME", None) if home is None else os.environ.update(XDG_STATE_HOME=home)

    def fault_of(self, target: Target, data: bytes) -> Fault | None:
        """What goes wrong with an input; None if nothing does."""
        files = self.files_of(target, data)
        left = counts_of_what_may_be_left()
        Path("/proc/self/clear_refs").write_text("5")
        memory, began = peak_of_memory(), time.process_time()
        fault = self._outcome(target, data, files)
        seconds, taken = time.process_time() - began, peak_of_memory() - memory
        most = FREE_MEMORY + TIMES_THE_INPUT * len(data)
        if fault is None and seconds > MOST_SECONDS:
            fault = Fault("too slow", f"it took {seconds:.1f} s of the processor")
        if fault is None and taken > most:
            fault = Fault("too much memory", f"it took {taken >> 20:,} MiB, more than {most >> 20:,} MiB")
        return fault or self._fault_of_the_place(files, left)

    def files_of(self, target: Target, data: bytes) -> dict[str, bytes]:
        """Write the files of an input, which are the only ones then; returns their contents by name."""
        files = target.files(data)
        for folder in (self.here, self.temporary, self.state):
            empty(folder)
        for name, content in files.items():
            path = self.here / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        return files

    def _outcome(self, target: Target, data: bytes, files: Mapping[str, bytes]) -> Fault | None:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                fault, place = target.run(data), ""
        except (AutocolorError, RamtekError) as refusal:
            fault = self._fault_of_refusal(refusal, files)
            place = f" ({innermost(refusal)})"
        except BaseException as error:
            place, fault = innermost(error), traceback.format_exc(limit=-12)
            return Fault(f"{type(error).__name__} {place}", fault)
        return Fault(fault.partition(":")[0] + place, fault) if fault else None

    def _fault_of_refusal(self, refusal: Exception, files: Mapping[str, bytes]) -> str:
        if getattr(refusal, "exit_code", 70) == 70:
            return f"a refusal that says the program is at fault: {type(refusal).__name__}: {refusal}"
        problems = getattr(refusal, "problems", None) or str(refusal).split("\n")
        if not 0 < len(problems) <= MOST_SENTENCES:
            return f"a refusal of too few or too many sentences: {len(problems)}"
        for sentence in problems:
            if not 0 < len(sentence) <= LONGEST_SENTENCE or not sentence.isprintable():
                return f"a refusal that cannot be read: {sentence[:300]!a}"
            place = sentence.partition(":")[0].partition(",")[0].encode()
            names = (self.here.name, *(Path(name).stem for name in files))
            is_named = any(name in sentence for name in names)
            # A damaged scene file may name any other file.
            is_named = is_named or any(place in content for content in files.values())
            if files and isinstance(refusal, InputError) and not is_named:
                return f"a refusal that names no file: {sentence}"
        return ""

    def _fault_of_the_place(self, files: Mapping[str, bytes], left: Mapping[str, int]) -> Fault | None:
        contents = {
            path.relative_to(self.here).as_posix(): path.read_bytes()
            for path in self.here.rglob("*")
            if path.is_file()
        }
        expected = {name: data for name, data in files.items() if not name.startswith("..")}
        changed = sorted(name for name in {*contents, *expected} if contents.get(name) != expected.get(name))
        if changed:
            return Fault("changed files", f"the files {changed} were changed, made or removed")
        if names := os.listdir(self.temporary):
            return Fault("temporary files", f"the temporary files {names} were left")
        if counts_of_what_may_be_left() != left:
            # What a circle of objects keeps open is closed when it is collected.
            gc.collect()
        now = counts_of_what_may_be_left()
        more = [noun for noun in left if now[noun] > left[noun]]
        return Fault(f"left: {more}", f"there were {left}, and there are {now}") if more else None


def empty(folder: Path) -> None:
    """Remove all that a folder has; it is made if it does not exist."""
    folder.mkdir(exist_ok=True)
    for entry in os.scandir(folder):
        shutil.rmtree(entry.path) if entry.is_dir(follow_symlinks=False) else os.unlink(entry.path)


def counts_of_what_may_be_left() -> dict[str, int]:
    """How many descriptors, threads and processes there are."""
    try:
        children = 1 + (os.waitpid(-1, os.WNOHANG)[0] > 0)
    except ChildProcessError:
        children = 0
    return {
        "descriptors": len(os.listdir("/proc/self/fd")),
        "threads": threading.active_count(),
        "processes": children,
    }


def peak_of_memory() -> int:
    """The most bytes of memory that this process has taken since its peak was cleared."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def innermost(error: BaseException) -> str:
    """The innermost function of ours that an exception passed."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [each for each in frames if "/autocolor/" in each.filename or "/ramtek_emu/" in each.filename]
    last = (ours or frames)[-1]
    return f"in {Path(last.filename).name}, {last.name}"


# Meshes and scenes.


def fault_of_mesh(mesh: Mesh) -> str:
    """What is wrong with the tables of a mesh that was handed on; empty if nothing is."""
    nodes, polygons = len(mesh.coordinates), len(mesh.node_numbers)
    if not np.isfinite(mesh.coordinates).all():
        return "a coordinate that is not finite"
    if polygons and not (mesh.node_numbers.min() >= 0 and mesh.node_numbers.max() < nodes):
        return "a node number that is not in the node table"
    if polygons and not (mesh.part_numbers.min() >= 0 and mesh.part_numbers.max() < len(mesh.part_names)):
        return "a part number that is not in the part table"
    for scalar in mesh.scalars:
        if np.isinf(scalar.values).any() or len(scalar.values) not in (nodes, polygons):
            return f"a scalar with an infinite value, or too many or few: {scalar.name!r}"
    if polygons and not np.isfinite(mesh.normals.vectors).all():
        return "a normal that is not finite"
    return ""


def fault_of_scene(scene: Scene) -> str:
    """What is wrong with a scene, or with its picture on a small display."""
    studio = Studio(scene, Ramtek9300(SMALL))
    if not np.isfinite(studio.picture.relative).all() or studio.picture.relative.min(initial=0) < 0:
        return "an intensity that is negative or not finite"
    if studio.words.max(initial=0) > SMALL.largest_word:
        return "a word that no display has"
    return fault_of_mesh(scene.mesh)


def fault_of_scene_at(path: str) -> str:
    """What is wrong with the scene that is read from a path."""
    return fault_of_scene(read_scene_with_report(path).scene)


@cache
def seeds_by_kind() -> Mapping[str, list[Seed]]:
    """The samples of files by the first word of their names, which is the name of a format."""
    kinds: dict[str, list[Seed]] = {}
    for seed in seeds():
        kinds.setdefault(seed.name.split()[0], []).append(seed)
    return kinds


def file_target(kind: str, names: tuple[str, ...], is_folder: bool = False) -> Target:
    """The target of a format of files whose samples are seeds. The first file is read, or its folder."""

    def samples() -> Iterator[bytes]:
        for seed in seeds_by_kind()[kind]:
            several = [seed.files.get(name, b"") for name in names]
            yield BETWEEN.join(several) if any(several) else seed.files[seed.read]

    return Target(samples, lambda _: fault_of_scene_at("" if is_folder else names[0]), names)


def zip_pieces(data: bytes) -> bytes:
    """The members of an archive as pieces, each with its name in a line before it."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return BETWEEN.join(name.encode() + b"\n" + archive.read(name) for name in archive.namelist())


def zipped(pieces: list[bytes]) -> list[bytes]:
    """An archive with right checksums of the members, or the input itself if it is an archive."""
    if pieces[0].startswith(b"PK"):
        return [BETWEEN.join(pieces)]
    buffer = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w") as archive:
        warnings.simplefilter("ignore")
        for piece in pieces:
            name, _, content = piece.partition(b"\n")
            archive.writestr(zipfile.ZipInfo(name.decode("latin-1")[:200]), content)
    return [buffer.getvalue()]


def archives(wholes: Iterable[bytes]) -> Iterator[bytes]:
    """Archives as they are, and as their members."""
    for whole in wholes:
        yield whole
        yield zip_pieces(whole)


def written(name: str, write: Callable[[Path], object]) -> bytes:
    """What a function writes to a file of this name."""
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def picture_samples() -> Iterator[bytes]:
    """Picture files of a small picture, without a scalar and with it."""
    for scene in (small_scene(), small_scene().with_scalar(name="stress")):
        picture = render(scene, 6, 8)
        yield written("small.npz", partial(write_picture, scene=scene, picture=picture))


def fault_of_picture(_: bytes) -> str:
    picture, scene = read_picture("small.npz")
    if display_image(scene, picture).words.max(initial=0) > GMR_9300.largest_word:
        return "a word that no display has"
    return fault_of_scene(scene)


def store_samples() -> Iterator[bytes]:
    """A store with small pages, so that it is small itself."""
    import sqlite3

    def write(path: Path) -> None:
        write_store(path, small_scene())
        with contextlib.closing(sqlite3.connect(path, isolation_level=None)) as connection:
            connection.execute("PRAGMA page_size = 512")
            connection.execute("VACUUM")

    yield written("small.sqlite", write)


FOREIGN_SUFFIXES = [suffix for each in FOREIGN for suffix in each.suffixes]


def foreign_samples() -> Iterator[bytes]:
    """A cube in each format that a library reads, after a line with its suffix."""
    from tests.autocolor.files.meshes.test_foreign import CELLS, MESHIO, TRIMESH, by_meshio, by_trimesh

    for suffix in (*TRIMESH, *MESHIO):
        with tempfile.TemporaryDirectory() as folder:
            if suffix in TRIMESH:
                path = by_trimesh(Path(folder), suffix)
            else:
                kind = "hexahedron" if suffix in ("su2", "msh") else "quad"
                path = by_meshio(Path(folder), suffix, [(kind, np.array(CELLS[kind]))])
            data = path.read_bytes()
            if suffix == "gltf":
                described = json.loads(data)
                for each in described["buffers"]:
                    content = (path.parent / each["uri"]).read_bytes()
                    each["uri"] = f"data:application/octet-stream;base64,{base64.b64encode(content).decode()}"
                data = json.dumps(described).encode()
            yield f".{suffix.rpartition('.')[2]}\n".encode() + data


def foreign_file(pieces: list[bytes]) -> list[bytes]:
    return [BETWEEN.join(pieces).partition(b"\n")[2]]


def fault_of_foreign(data: bytes) -> str:
    first = data.partition(b"\n")[0].decode("latin-1")
    suffix = first if first in FOREIGN_SUFFIXES else FOREIGN_SUFFIXES[len(data) % len(FOREIGN_SUFFIXES)]
    # The name of a UGRID file tells the kind of its numbers.
    name = f"foreign{'.b8' if suffix == '.ugrid' else ''}{suffix}"
    os.rename("foreign", name)
    try:
        return fault_of_scene_at(name)
    finally:
        os.rename(name, "foreign")


def rig_samples() -> Iterator[bytes]:
    yield written("rig.toml", lambda path: write_rig(path, small_scene()))


def fault_of_rig(_: bytes) -> str:
    return fault_of_scene(small_scene().with_rig(read_rig("rig.toml")))


def palette_samples() -> Iterator[bytes]:
    """The files of a format of palettes for which the others are empty; see `fault_of_palette`."""
    colors, names = ["#b01020", "#1e5ac8"], ["signal red", 'a "b", c']
    for number, name in enumerate(PALETTES):
        pieces = [b""] * len(PALETTES)
        names = [] if name.endswith(".act") else names
        pieces[number] = written(name, partial(write_palette, palette=colors, names=names))
        yield BETWEEN.join(pieces)


def fault_of_palette(_: bytes) -> str:
    name = max(PALETTES, key=lambda name: os.path.getsize(name) if os.path.exists(name) else -1)
    palette = read_palette(name)
    for each in PALETTE_FORMATS[:2]:
        if each.read(each.written(palette, Path("again")), "again") != palette:
            return f"a palette that is another one as a {each.name}"
    return ""


# Tables and lists of variants.

TABLES = ("looks.csv", "looks.json")


def table_samples() -> Iterator[bytes]:
    """A table in CSV without one in JSON, and a table in JSON without one in CSV."""
    yield b'name,time,view.eye,ambient\nfirst,0,"[1, 2, 3]",0.1\n,2.5,,none\n' + BETWEEN
    yield (
        BETWEEN + b'[{"name": "a", "surfaces.body.object_color": [1, 2, 3], "scalar": null}, {"ambient": 1}]'
    )


def vary_samples() -> Iterator[bytes]:
    yield b"surfaces.body.object_color=red,#1f3f8f,rgb(1, 2, 3)"
    yield b"lights.key.intensity=0.5:2:4"
    yield b"view.eye=[1, 2, 3],[4, 5, 6]"
    yield b"lights.key.only_parts='hood, roof',\"hood\",none"


def fault_of_table(_: bytes) -> str:
    name = max(TABLES, key=lambda name: os.path.getsize(name) if os.path.exists(name) else -1)
    return fault_of_variants(read_variants(name))


def fault_of_variants(variants: Sequence[Variant]) -> str:
    pattern = Pattern("{number}-{name}.png", small_scene())
    if any(os.path.dirname(pattern.path(1, variant)) for variant in variants):
        return "a name that leads to another folder"
    for variant in variants[:5]:
        with contextlib.suppress(AutocolorError):
            if fault := fault_of_scene(scene_with(small_scene(), variant.settings)):
                return fault
    return ""


# Sessions, settings and statements.

STATE = tuple(f"../state/autocolor/{name}" for name in (COLORS, FILES, "sessions/1-1/session.jsonl"))


def state_samples() -> Iterator[bytes]:
    lists = (b'["#b01020", "#00ff00", "#0000ff"]', b'["/a/b", "/c\\u0000", 7, "d", "/\\ud800"]')
    yield BETWEEN.join((*lists, b'{"step": "begin", "version": 1}\n'))


def fault_of_state(_: bytes) -> str:
    recent_colors(), recent_files(), left_sessions()
    return ""


def journal_samples() -> Iterator[bytes]:
    """A session with steps of all kinds, and the file of its mesh."""
    from tests.mutations import OBJ_TEXT

    with tempfile.TemporaryDirectory() as name, contextlib.chdir(name):
        Path("car.obj").write_bytes(OBJ_TEXT)
        studio = Studio(read_scene("car.obj"), Ramtek9300())
        studio.open("car.obj")
        for edit in (
            lambda: studio.recolor("hood", object_color="#b01020"),
            lambda: studio.light("key", intensity=2.5),
            lambda: studio.keep_variant("A"),
            lambda: studio.add_light("rim", position=(1, 2, 3)),
            lambda: studio.view(angle=20),
            studio.undo,
            studio.redo,
            lambda: studio.show_variant("A"),
            lambda: studio.scalar(name="z"),
            lambda: studio.scalar(None),
            lambda: studio.drop_variant("A"),
            lambda: studio.mark_saved({"/car/scene.toml": "9f"}),
        ):
            with contextlib.suppress(AutocolorError):
                edit()
        from tests.autocolor.journal.random_steps import journal_of

        data = journal_of(studio.history, Path("journal"), Source("car.obj")).read_bytes()
        lines = data.replace(os.path.abspath("car.obj").encode(), b"car.obj")
    yield lines + BETWEEN + OBJ_TEXT


def fault_of_journal(_: bytes) -> str:
    return fault_of_scene(read_journal("session.jsonl").history.scene)


def settings_samples() -> Iterator[bytes]:
    yield b"lights.key.intensity=2"
    yield b"lights.key.only_parts=hood, roof\0lights.rim.position=[1, 2, 3]\0lights.rim.on=false"
    yield b"view.angle=10\0view.target=none\0view.eye=[1,2,3]\0scalar=none"
    yield b"surfaces.body.object_color=#b01020\0surfaces.glass.ramp=#200,#f60,#fff\0surfaces.body.levels=20"
    yield b"scalar.name=stress\0scalar.bands=4\0scalar.limits=[0, 5]\0ambient=0.1\0mapping=[[0,0],[1,1]]"
    yield b"lights.key.flaps.z.minimum=-0.5\0parts.hood.surface=glass"
    yield b"lights.key.half_spaces.door={point=[0,0,1], direction=[0,0,1]}\0lights.rim.half_spaces=none"
    yield b"lights.'key'.follows=eye\0background=\"red\"\0exposure=auto\0lights.key.aim= [1e0, 0x2,3.0]"


def fault_of_settings(data: bytes) -> str:
    return fault_of_scene(with_settings(small_scene(), tuple(os.fsdecode(data).split("\0"))))


def sql_samples() -> Iterator[bytes]:
    yield b"SELECT name, intensity FROM lights;"
    yield b"UPDATE lights SET intensity = 2 WHERE name = 'key'; SELECT * FROM lights"
    yield b"SELECT part, count(*) AS n FROM polygons GROUP BY part HAVING n > 1 ORDER BY 1 LIMIT 3;"
    yield b"INSERT INTO lights (name, position_x, position_y, position_z) VALUES ('a;b', 1, 2, 3.5e0) --x\n"
    yield b"DELETE FROM polygons WHERE polygon = 1; UPDATE nodes SET x = x + 1 RETURNING node"
    yield b"SELECT x'00ff', 1e999, NULL; SELECT * FROM lights AS a JOIN lights AS b USING (name)"
    yield b"WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c WHERE n < 50) SELECT * FROM c;"
    yield b"EXPLAIN SELECT printf('%s', group_concat(name, '\xc3\xa9')) FROM parts; PRAGMA table_info(nodes)"


def fault_of_sql(data: bytes) -> str:
    with tables_of(small_scene()) as tables:
        tables.seconds = 0.5
        for number, statement in enumerate(statements_in(io.TextIOWrapper(io.BytesIO(data), "utf-8"))):
            if tables.would_change(statement):
                tables.change(statement)
            elif any(
                not line.isprintable()
                for line in islice(lines_of(tables.answer(statement), ("table", "json")[number % 2]), 200)
                if number % 2 == 0
            ):
                return "a table with a line that cannot be printed"
        return fault_of_scene(tables.scene())


# The display.

CONFIGURATIONS = (SMALL, GMR_9300, PRINCETON_9300, NCAR_9460, *(SMALL,) * 12)


def stream_samples() -> Iterator[bytes]:
    """Pieces of the streams of some programs, after a byte that chooses the display."""
    from tests.ramtek_emu.test_hostile import sessions

    for number, words in enumerate(sessions()):
        data = words.astype("<u2").tobytes()
        for place in range(0, min(len(data), 6000), 1500):
            yield bytes([number]) + data[place : place + 2000]


def words_of(data: bytes) -> np.ndarray[Any, np.dtype[np.uint16]]:
    return np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16)


def state_of(display: Ramtek9300) -> tuple[object, ...]:
    """All that a host or a user can learn of a display."""
    processor = display.processor
    replies = display.receive(processor.waiting).tobytes()
    return (
        display.words.tobytes(), display.entries.tobytes(), display.field().tobytes(), replies,
        display.status, display.decoder.pending_words, processor.illegal_words, processor.unimplemented,
    )  # fmt: skip


def cut(data: bytes, seed: int = 0) -> Iterator[bytes]:
    """The data in pieces, cut anywhere."""
    chance = random.Random(zlib.crc32(data) + seed)
    place = 0
    while place < len(data):
        size = chance.choice((1, 2, 3, 7, 40, 1000))
        yield data[place : place + size]
        place += size


def fault_of_stream(data: bytes) -> str:
    configuration = CONFIGURATIONS[(data[0] if data else 0) % len(CONFIGURATIONS)]
    words = words_of(data[1:])
    whole, pieces = Ramtek9300(configuration), Ramtek9300(configuration)
    whole.send(words)
    for piece in cut(words.tobytes()):
        # A piece of 2n or 2n + 1 bytes is n + 1 words: the words are cut anywhere, not the bytes.
        taken, words = words[: 1 + len(piece) // 2], words[1 + len(piece) // 2 :]
        pieces.send(taken)
    pieces.send(words)
    if whole.words.max(initial=0) > configuration.largest_word:
        return "a word that the display cannot have"
    return "" if state_of(whole) == state_of(pieces) else "another state for other cuts"


def fault_of_lister(data: bytes) -> str:
    configuration = CONFIGURATIONS[(data[0] if data else 0) % len(CONFIGURATIONS)]
    lines = [line for item in items(cut(data[1:]), configuration) for line in item.lines()]
    if not all(line.isprintable() for line in lines):
        return "a listing with a line that cannot be printed"
    return "" if b"".join(assemble(lines)) == data[1:] else "a listing that gives another stream"


def listing_samples() -> Iterator[bytes]:
    for sample in stream_samples():
        lines = [line for item in items([sample[1:300]]) for line in item.lines()]
        yield "\n".join(lines).encode("latin-1")
    yield b"SET FORE=1 BK\nERS BACK=2 WIN=100,331..200,411 ; a box\nWVL STRT=10,501\n  to 100,451  200,300\n"
    yield b'WT STRT=1,2 5 bytes\n text "HELLO"\nWI WIN=0,0..7,7\n words 0010*640 1234\nraw 0A03\nbyte 7F\n'


def fault_of_assembler(data: bytes) -> str:
    stream = b"".join(assemble(io.TextIOWrapper(io.BytesIO(data), "latin-1")))
    if len(stream) > 300 * len(data) + 1000:
        return "a stream that is far longer than its listing"
    return ""


def joystick_samples() -> Iterator[bytes]:
    yield b"cursor 100 200 enter\nby -3 +4\n\ntrack on # down\ntrack off\nreset enter reset\nenter 1\n"
    yield b"cursor 1000000 -5\ncursor 1 2 3\nby 1e3 4\n" + b"enter " * 900


def fault_of_joystick(_: bytes) -> str:
    display = Ramtek9300(SMALL)
    number = opened("lines.txt")
    try:
        for line in joystick_lines(number):
            try:
                for action in actions(line, display.joystick, display.reset):
                    action()
            except ValueError as refusal:
                if not str(refusal).isprintable():
                    return f"an answer that cannot be read: {str(refusal)!r}"
    finally:
        os.close(number)
    return "" if display.field().shape == (48, 64, 3) else "a field of another size"


def png_pieces(data: bytes) -> bytes:
    """The chunks of a PNG file as pieces, each without its length and its checksum."""
    pieces, place = [], 8
    while place < len(data):
        (length,) = struct.unpack_from(">I", data, place)
        pieces.append(data[place + 4 : place + 8 + length])
        place += 12 + length
    return BETWEEN.join(pieces)


def png(pieces: list[bytes]) -> list[bytes]:
    """A PNG file of chunks with right checksums, or the input itself if it begins as such a file."""
    begin = b"\x89PNG\r\n\x1a\n"
    if pieces[0].startswith(begin[:4]):
        return [BETWEEN.join(pieces)]
    lengths = (struct.pack(">I", max(0, len(piece) - 4)) for piece in pieces)
    sums = (struct.pack(">I", zlib.crc32(piece)) for piece in pieces)
    return [begin + b"".join(b"".join(parts) for parts in zip(lengths, pieces, sums, strict=True))]


def snapshot_samples() -> Iterator[bytes]:
    for configuration in CONFIGURATIONS[:2]:
        display = Ramtek9300(configuration)
        display.send(words_of(next(iter(stream_samples()))[1:]))
        yield snapshot_bytes(display)
        yield png_pieces(snapshot_bytes(display))


def fault_of_snapshot(_: bytes) -> str:
    display = read_snapshot("small.png")
    display.field()
    display.send(words_of(next(iter(stream_samples()))[1:]))
    return "" if display.words.max() <= display.configuration.largest_word else "a word that cannot be"


# Hosts and displays that misbehave.

MARK = b"<mark>"
"""Where a host asks for a hard reset."""


def host_samples() -> Iterator[bytes]:
    for number, sample in enumerate(stream_samples()):
        yield bytes([number % 2]) + sample[1:400] + MARK + sample[401:600] + b"\1"


def drained(host: socket.socket) -> bool:
    """Whether replies were waiting, which are read and dropped."""
    with contextlib.suppress(BlockingIOError):
        return bool(host.recv(1 << 16))
    return False


def fault_of_server(data: bytes) -> str:
    """A server and a display without one must be the same after the same words and resets."""
    is_unix = bool(data[:1] and data[0] & 1)
    expected = Ramtek9300(SMALL)
    server: TcpServer | UnixServer
    server = UnixServer(Ramtek9300(SMALL), "socket") if is_unix else TcpServer(Ramtek9300(SMALL))
    with server, contextlib.ExitStack() as stack:
        port = (UnixPort("socket") if isinstance(server, UnixServer) else TcpPort(server.address)).wire
        host = stack.enter_context(port.socket)

        def serve() -> None:
            while server.step(0.0) | drained(host):
                pass

        for number, segment in enumerate(data[1:].split(MARK)):
            if number:
                port.send_mark()
                serve()
                expected.reset()
            odd = b""
            for piece in cut(segment, number):
                while not port.send(piece):
                    serve()
                # A write at a Unix socket is rounded down to whole words; over TCP, words are cut anywhere.
                whole = piece if is_unix else odd + piece
                odd = whole[len(whole) & ~1 :]
                expected.send(words_of(whole))
                expected.receive(expected.processor.waiting)
                serve()
        serve()
        for display in (server.display, expected):
            display.receive(display.processor.waiting)
        if state_of(server.display) != state_of(expected):
            return f"another state {'at a Unix socket' if is_unix else 'over TCP'} than without a server"
        host.shutdown(socket.SHUT_WR)
        end = time.monotonic() + 10
        while not server.served and time.monotonic() < end:
            server.step(0.01)
            drained(host)
        return "" if server.served else "a host that left is still served"


def reply_samples() -> Iterator[bytes]:
    yield bytes(range(64))
    yield b"\2\0" + MARK + b"\1\2\3\4" + MARK
    yield b"\3SSH-2.0-OpenSSH_9.2\r\n"
    yield bytes(400)


def fault_of_port(data: bytes) -> str:
    """A port to what is no display: it sends any bytes and marks, and ends."""
    chance = random.Random(zlib.crc32(data))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=0.05)
        display, _ = listener.accept()
        with display, port.wire.socket:
            for number, segment in enumerate(data.split(MARK)[:8]):
                if number:
                    display.send(b"\0", socket.MSG_OOB)
                display.sendall(segment)
            if chance.random() < 0.7:
                display.shutdown(socket.SHUT_WR)
            for _ in range(4):
                act = chance.randrange(4)
                if act == 0:
                    port.send(words_of(data))
                elif act == 1:
                    port.reset()
                else:
                    port.receive(chance.randrange(40))
            port.close()
    return ""


def show_samples() -> Iterator[bytes]:
    for sample in reply_samples():
        yield from (bytes([number]) + sample for number in range(4))
    yield b"\1" + struct.pack("<40H", *(word for place in range(20) for word in (600, 200 + place | 0x3000)))


@cache
def shown_scene() -> Scene:
    return small_scene()


def fault_of_show(data: bytes) -> str:
    """What `show` does at a server that is no display: it must end, and not say that the picture is shown."""
    is_session, stays = (bool(data[:1]) and bool(data[0] & bit) for bit in (1, 2))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"

        def reply() -> None:
            display, _ = listener.accept()
            with display, contextlib.suppress(OSError):
                display.settimeout(10)
                display.sendall(data[1:])
                if not stays:
                    display.shutdown(socket.SHUT_WR)
                while display.recv(1 << 16):
                    pass

        server = threading.Thread(target=reply)
        server.start()
        try:
            with contextlib.redirect_stderr(io.StringIO()):
                if is_session:
                    session_elsewhere(History(shown_scene()), address, Path(), timeout=0.3)
                else:
                    show_once(shown_scene(), address, 0.3)
                    return "a picture that is said to be shown by what is no display"
        except (AutocolorError, RamtekError) as error:
            if error.exit_code != 69:
                return f"an error that does not blame the display: {error}"
        finally:
            server.join()
            close_locks()
    return ""


def close_locks() -> None:
    """Close the locks of sessions, which last as long as the process that was cut off from its display."""
    for number in os.listdir("/proc/self/fd"):
        with contextlib.suppress(OSError):
            if "/sessions/" in os.readlink(f"/proc/self/fd/{number}"):
                os.close(int(number))


# The table.

NAMES_OF = {
    "CSV": ("nodes.csv", "polygons.csv"),
    "Movie.BYU": ("plate.g",),
    "npy": (
        "nodes.npy", "polygons.npy", "parts.npy", "normals.npy", "normal_numbers.npy", "scalars/1.npy",
        "scalars/2.npy", "tables.json",
    ),
    "OBJ": ("car.obj", "car.mtl"),
    "OFF": ("plate.off",),
    "PLY": ("plate.ply",),
    "STL": ("plate.stl",),
    "VTK": ("plate.vtk",),
    "VTP": ("plate.vtp",),
}  # fmt: skip
"""The files of the mesh formats of which samples are damaged as they are."""


def table_target() -> Target:
    target = file_target("tables", ("small.tables",))
    return target._replace(samples=lambda: archives(target.samples()), packed=zipped)


TARGETS: dict[str, Target] = {
    **{
        kind.lower().removeprefix("movie."): file_target(kind, names, kind in ("CSV", "npy"))
        for kind, names in NAMES_OF.items()
    },
    "tables": table_target(),
    "foreign": Target(foreign_samples, fault_of_foreign, ("foreign",), foreign_file),
    "scene": file_target("scene", ("scene.toml", "car.obj", "car.mtl", "mesh.tables"), is_folder=True),
    "picture": Target(lambda: archives(picture_samples()), fault_of_picture, ("small.npz",), zipped),
    "rig": Target(rig_samples, fault_of_rig, ("rig.toml",)),
    "palette": Target(palette_samples, fault_of_palette, PALETTES),
    "table": Target(table_samples, fault_of_table, TABLES),
    "vary": Target(vary_samples, lambda data: fault_of_variants(varied(os.fsdecode(data))), largest=300),
    "store": Target(
        store_samples, lambda _: fault_of_scene_at("small.sqlite"), ("small.sqlite",), largest=1 << 17
    ),
    "state": Target(state_samples, fault_of_state, STATE),
    "journal": Target(journal_samples, fault_of_journal, ("session.jsonl", "car.obj")),
    "set": Target(settings_samples, fault_of_settings, largest=300),
    "sql": Target(sql_samples, fault_of_sql, largest=4096),
    "stream": Target(stream_samples, fault_of_stream, largest=4096),
    "lister": Target(stream_samples, fault_of_lister, largest=2048),
    "assembler": Target(listing_samples, fault_of_assembler),
    "joystick": Target(joystick_samples, fault_of_joystick, ("lines.txt",)),
    "snapshot": Target(snapshot_samples, fault_of_snapshot, ("small.png",), png),
    "server": Target(host_samples, fault_of_server, largest=4096),
    "port": Target(reply_samples, fault_of_port, largest=4096),
    "show": Target(show_samples, fault_of_show, largest=1024),
}
"""What is attacked, by the name that `python -m tests.fuzz` takes."""


def formats_without_targets() -> list[str]:
    """The names of mesh formats that no target reads a sample of, so that nobody forgets one."""
    ours = {*NAMES_OF, "tables"}
    first_lines = {sample.partition(b"\n")[0].decode("latin-1") for sample in foreign_samples()}
    return [
        each.name for each in MESH_FORMATS if each.name not in ours and not first_lines & set(each.suffixes)
    ]
