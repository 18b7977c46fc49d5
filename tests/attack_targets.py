"""The attacks `reads`: every reader of bytes from outside gets damaged input.

An input is written to the files of its target in the current folder, and read. The result must hold what its
type promises, or the input must be refused by an error of ours in short printable sentences that name the
file. The table READERS is at the foot.
"""

from __future__ import annotations

import contextlib
import io
import os
import random
import socket
import sqlite3
import struct
import tempfile
import threading
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, partial
from itertools import islice
from pathlib import Path
from typing import Any, Final
from unittest import mock

import numpy as np

import autocolor
from autocolor import Mesh, Scene, Studio, Variant, read_journal, read_scene
from autocolor.batches.outputs import paths_of
from autocolor.commands.settings import with_settings
from autocolor.commands.show import show_once
from autocolor.commands.sql import lines_of, split
from autocolor.errors import AutocolorError, InputError
from autocolor.files.settings import scene_with
from autocolor.files.store.store_file import write_store
from autocolor.files.store.tables import ChangeError, tables_of
from autocolor.images import display_image
from autocolor.journal.autosave import JOURNAL, Autosave
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from ramtek_emu import FAMILY, GMR_9300, NCAR_9460, PRINCETON_9300, Ramtek9300, instructions
from ramtek_emu.errors import RamtekError
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.snapshot import read_snapshot, snapshot_bytes
from tests.attacks import Trial
from tests.mutations import OBJ_TEXT, damaged, scene, seeds
from tests.small import BOXES_STREAM, SMALL

BETWEEN: Final = b"\n-- the next file --\n"
"""What divides the files of an input that has several."""
FREE_MEMORY: Final = 128 << 20
TIMES_THE_INPUT: Final = 100
"""The bytes of memory for any input, and for each byte of an input. An OBJ polygon in text takes 20 bytes;
its mesh, its normals and the arrays of their computation take some hundred."""
LONGEST_SENTENCE: Final = 4000
MOST_SENTENCES: Final = 101


class Reading(Trial):
    """A reader of bytes: `run` reads an input, and returns a fault of the result, "" if it is sound.

    The pieces of an input are written to files with these `names`. `packed` converts the pieces before, for
    example to an archive of them. Inputs have at most `largest` bytes.
    """

    most_seconds = 5.0

    def __init__(
        self,
        samples: Iterable[bytes],
        run: Callable[[bytes], object],
        names: Sequence[str] = (),
        packed: Callable[[list[bytes]], list[bytes]] = list,
        largest: int = 1 << 16,
    ) -> None:
        self.samples, self.run, self.names, self.packed, self.largest = (
            list(samples),
            run,
            names,
            packed,
            largest,
        )

    def input(self, chance: random.Random) -> bytes:
        data = chance.choice(self.samples)
        for _ in range(chance.choice((0, 1, 1, 1, 1, 1, 2, 4))):
            data = damaged(data, chance, self.samples)
        return data[: self.largest]

    def attempt(self, chance: random.Random) -> str:
        return self.fault_of(self.input(chance))

    def write(self, data: bytes) -> dict[str, bytes]:
        """Write the files of an input; returns their contents by their names."""
        files = dict(zip(self.names, self.packed(data.split(BETWEEN)), strict=False)) if self.names else {}
        for name, content in files.items():
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            Path(name).write_bytes(content)
        return files

    def fault_of(self, data: bytes) -> str:
        """What is wrong with how an input is read or refused."""
        self.most_bytes = FREE_MEMORY + TIMES_THE_INPUT * len(data)
        files = self.write(data)
        try:
            fault = str(self.run(data) or "")
        except (AutocolorError, RamtekError) as refusal:
            fault = fault_of_refusal(refusal, files)
        there = {path.as_posix(): path.read_bytes() for path in Path().rglob("*") if path.is_file()}
        expected = {name: content for name, content in files.items() if not name.startswith("..")}
        changed = {name for name in {*there, *expected} if there.get(name) != expected.get(name)}
        return fault or (f"changed files: {changed}" if changed else "")


def fault_of_refusal(refusal: Exception, files: Mapping[str, bytes]) -> str:
    """What is wrong with the sentences of an error."""
    if getattr(refusal, "exit_code", 70) == 70:
        return f"a refusal that says the program is at fault: {type(refusal).__name__}: {refusal}"
    problems = getattr(refusal, "problems", None) or str(refusal).split("\n")
    if not 0 < len(problems) <= MOST_SENTENCES:
        return f"a refusal of too few or too many sentences: {len(problems)}"
    names = (Path.cwd().name, *(Path(name).stem for name in files))
    for sentence in problems:
        if not 0 < len(sentence) <= LONGEST_SENTENCE or not sentence.isprintable():
            return f"a refusal that cannot be read: {sentence[:300]!a}"
        # A damaged scene file may name any other file.
        place = sentence.partition(":")[0].partition(",")[0].encode()
        is_named = any(name in sentence for name in names) or any(place in each for each in files.values())
        if files and isinstance(refusal, InputError) and not is_named:
            return f"a refusal that names no file: {sentence}"
    return ""


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


def fault_at(path: str) -> str:
    """What is wrong with the scene that is read from a path."""
    return fault_of_scene(read_scene(path))


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


def file_target(kind: str, packed: bool = False) -> Reading:
    """The reader of a format of files whose samples are seeds. The first file is read, or the folder."""
    group = [seed for seed in seeds() if seed.name.split()[0] == kind]
    read = group[0].read
    names = list(dict.fromkeys((*[read] * bool(read), *(name for seed in group for name in seed.files))))
    samples = (
        seed.files[seed.read] if read else BETWEEN.join(seed.files.get(name, b"") for name in names)
        for seed in group
    )
    if packed:
        return Reading(archives(samples), lambda _: fault_at(read), names, zipped)
    return Reading(samples, lambda _: fault_at(read), names)


def written(name: str, write: Callable[[Path], object]) -> bytes:
    """What a function writes to a file of this name."""
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def picture_samples() -> Iterator[bytes]:
    """Picture files of a small picture, without a scalar and with it."""
    for each in (scene(), scene().with_scalar(name="stress")):
        write = partial(autocolor.write_picture, scene=each, picture=autocolor.render(each, (8, 6)))
        yield written("small.npz", write)


def fault_of_picture(_: bytes) -> str:
    scene, picture = autocolor.read_picture("small.npz")
    if display_image(scene, picture).words.max(initial=0) > GMR_9300.largest_word:
        return "a word that no display has"
    return fault_of_scene(scene)


def write_small_store(path: Path) -> None:
    """Write a store with small pages, so that it is small itself."""
    write_store(path, scene())
    with contextlib.closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("PRAGMA page_size = 512")
        connection.execute("VACUUM")


VARIANTS: Final = {
    "csv": b'name,time,view.eye,ambient\nfirst,0,"[1, 2, 3]",0.1\n,2.5,,none\n',
    "json": b'[{"name": "a", "surfaces.low.object_color": [1, 2, 3], "scalar": null}, {"ambient": 1}]',
}
PALETTES: Final = ("gpl", "csv")


def palette_reader(suffix: str) -> Reading:
    """The reader of a format of palettes."""
    name = f"paints.{suffix}"
    names = ["signal red", 'a "b", c']
    write = partial(autocolor.write_palette, palette=["#b01020", "#1e5ac8"], names=names)
    return Reading([written(name, write)], lambda _: autocolor.read_palette(name) and "", [name])


def variants_reader(suffix: str) -> Reading:
    """The reader of a table of variants."""
    name = f"looks.{suffix}"
    return Reading([VARIANTS[suffix]], lambda _: fault_of_variants(autocolor.read_variants(name)), [name])


def fault_of_variants(variants: Sequence[Variant]) -> str:
    if any(map(os.path.dirname, paths_of("{number}-{name}.png", scene(), variants))):
        return "a name that leads to another folder"
    for variant in variants[:5]:
        with contextlib.suppress(AutocolorError):
            if fault := fault_of_scene(scene_with(scene(), variant.settings)):
                return fault
    return ""


# Sessions, settings and statements.


def journal_samples() -> Iterator[bytes]:
    """A session with steps of all kinds, and the file of its mesh."""
    with tempfile.TemporaryDirectory() as name, mock.patch.dict(os.environ, XDG_STATE_HOME=name):
        path = Path(name) / "car.obj"
        path.write_bytes(OBJ_TEXT)
        studio = Studio(History(read_scene(path), place_of(Source(str(path)))), Ramtek9300(SMALL))
        studio.recolor("red", object_color="#b01020")
        studio.keep_variant("A")
        studio.add_light("lamp", position=(1, 2, 3))
        studio.view(angle=20)
        studio.undo()
        studio.redo()
        studio.show_variant("A")
        studio.scalar(name="z")
        studio.drop_variant("A")
        studio.mark_saved({"/car/scene.toml": "9f"})
        autosave = Autosave()
        autosave.update(studio.history, at_once=True)
        (journal,) = Path(name).rglob(JOURNAL)
        yield journal.read_bytes().replace(bytes(path), b"car.obj") + BETWEEN + OBJ_TEXT
        autosave.end()


SETTINGS: Final = (
    b"lights.key.intensity=2",
    b"lights.key.only_parts=low, high\0lights.fill.position=[1, 2, 3]\0lights.fill.on=false",
    b"view.angle=10\0view.field_of_view=30\0view.eye=[1,2,3]\0scalar=none",
    b"surfaces.low.object_color=#b01020\0surfaces.high.ramp=#200,#f60,#fff\0surfaces.low.levels=20",
    b"scalar.name=stress\0scalar.bands=4\0scalar.limits=[0, 5]\0ambient=0.1\0mapping=[[0,0],[1,1]]",
    b"lights.key.flaps.z.minimum=-0.5\0parts.low.surface=high",
    b"lights.key.half_spaces.door={point=[0,0,1], direction=[0,0,1]}\0lights.fill.half_spaces=none",
    b"lights.'key'.follows=eye\0background=\"red\"\0exposure=auto\0lights.key.aim= [1e0, 0x2,3.0]",
)
STATEMENTS: Final = (
    b"SELECT name, intensity FROM lights;",
    b"UPDATE lights SET intensity = 2 WHERE name = 'key'; SELECT * FROM lights",
    b"SELECT part, count(*) AS n FROM polygons GROUP BY part HAVING n > 1 ORDER BY 1 LIMIT 3;",
    b"INSERT INTO lights (name, position_x, position_y, position_z) VALUES ('a;b', 1, 2, 3.5e0) --x\n",
    b"DELETE FROM polygons WHERE polygon = 1; UPDATE nodes SET x = x + 1 RETURNING node",
    b"SELECT x'00ff', 1e999, NULL; SELECT * FROM lights AS a JOIN lights AS b USING (name)",
    b"WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c WHERE n < 50) SELECT * FROM c;",
    b"EXPLAIN SELECT printf('%s', group_concat(name, '\xc3\xa9')) FROM parts; PRAGMA table_info(nodes)",
)


def fault_of_sql(data: bytes) -> str:
    with tables_of(scene()) as tables:
        tables.seconds = 0.5
        for number, statement in enumerate(filter(None, split(data.decode(errors="replace")))):
            try:
                lines = list(islice(lines_of(*tables.answer(statement), (None, "json")[number % 2]), 200))
            except ChangeError:
                tables.change(statement)
                continue
            if number % 2 == 0 and not all(line.isprintable() for line in lines):
                return "a table with a line that cannot be printed"
        return fault_of_scene(tables.scene())


# The display.

CONFIGURATIONS: Final = (SMALL, FAMILY, PRINCETON_9300, NCAR_9460, *(SMALL,) * 12)
"""The displays of streams, mostly the small one, which takes a hundredth of the time of the others."""
NEWER: Final = (
    *(0x2701, 0x080E, 0x0041, 0x0006, 0xFF, 0, 512, 639, 1023, 0, 512, 639, 1023, 0, 512, 0x4EFF),
    *(0x0E0F, 0x8002, 0x0008, 7, 10, 532, 0xFF00, 0x1000, 8, 100, 532, 100, 602),
    *(0x6D0B, 2, 9, 6, 300, 800, 50, 0x3A0D, 1, 0xFF, 2, 0, 0x2600, 0x0101),
    *(0x1300, 0x6901, 4, 9, 9, 0x1400, 0x3501, 8, 1, 2, 30, 40, 0x3801, 4, 7, 8),
    *(0x3901, 6, 9, 9, 3, 0x2B00, 0x2402, 0xFFFF, 0x2500, 0x2C00, 3, 4),
)
"""Instructions of later displays, in words."""


@cache
def stream_samples() -> tuple[bytes, ...]:
    """Streams, each after a byte that chooses the display."""
    drawn = Ramtek9300(SMALL)
    Studio(scene(), drawn)
    image = (
        instructions.write_image(drawn.words[4:14, 4:20]),
        instructions.load_entries(0, drawn.entries[:60]),
    )
    drawing = (
        instructions.zoom(2), instructions.write_circles([(20, 10, 6)], 9), instructions.fill(6, 6, 3),
        instructions.write_vectors([[20, 10], [30, 15], [5, 20]], 9), instructions.write_cursor(0, 5, 6),
        instructions.write_segments([[1, 2, 12, 9], [3, 3, 8, 20]], 7), instructions.read_cursor(0),
        instructions.write_text("What is this?", 1, 1), next(instructions.read_image(0, 0, 9, 5))[0],
        instructions.read_entries(4, 9), instructions.load_entries(8, [[1, 2, 3]], short=True),
    )  # fmt: skip
    streams = (*BOXES_STREAM, *image), (instructions.reset(), *drawing), (np.array(NEWER, np.uint16),)
    return tuple(
        bytes([number]) + np.concatenate(words).astype("<u2").tobytes()
        for number, words in enumerate(streams)
    )


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
    whole = data[1 : (len(data) - 1) | 1]
    return "" if b"".join(assemble(lines)) == whole else "a listing that gives another stream"


def listing_samples() -> Iterator[bytes]:
    for sample in stream_samples():
        lines = [line for item in items([sample[1:300]]) for line in item.lines()]
        yield "\n".join(lines).encode("latin-1")
    yield b"SET FORE=1 BK\nERS BACK=2 WIN=100,331..200,411 ; a box\nWVL STRT=10,501\n  to 100,451  200,300\n"
    yield b'WT STRT=1,2 5 bytes\n text "HELLO"\nWI WIN=0,0..7,7\n words 0010*640 1234\nraw 0A03\n'


def fault_of_assembler(data: bytes) -> str:
    stream = b"".join(assemble(io.TextIOWrapper(io.BytesIO(data), "utf-8-sig", "replace")))
    return "" if len(stream) <= 300 * len(data) + 1000 else "a stream that is far longer than its listing"


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
        display.send(words_of(stream_samples()[0][1:]))
        yield snapshot_bytes(display)
        yield png_pieces(snapshot_bytes(display))


def fault_of_snapshot(_: bytes) -> str:
    display = read_snapshot("small.png")
    display.field()
    display.send(words_of(stream_samples()[0][1:]))
    return "" if display.words.max() <= display.configuration.largest_word else "a word that cannot be"


REPLIES: Final = (
    bytes(range(64)), b"\2\0\1\2\3\4", b"\3SSH-2.0-OpenSSH_9.2\r\n", bytes(400),
    b"\1" + struct.pack("<40H", *(word for place in range(20) for word in (600, 200 + place | 0x3000))),
)  # fmt: skip


def fault_of_show(data: bytes) -> str:
    """What `show` does at a server that is no display: it must end, and not say that the picture is shown."""
    stays = bool(data[:1]) and bool(data[0] & 2)
    with socket.create_server(("127.0.0.1", 0)) as listener:

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
                show_once(scene(), f"tcp://127.0.0.1:{listener.getsockname()[1]}", 0.3)
            return "a picture that is said to be shown by what is no display"
        except (AutocolorError, RamtekError) as error:
            return "" if error.exit_code == 69 else f"an error that does not blame the display: {error}"
        finally:
            server.join()


# The table.

MESHES: Final = ("CSV", "Movie.BYU", "npy", "OBJ", "OFF", "PLY", "STL", "scene")
READERS: Final[dict[str, Callable[[], Reading]]] = {
    **{kind.lower().removeprefix("movie."): partial(file_target, kind) for kind in MESHES},
    "tables": lambda: file_target("tables", packed=True),
    "picture": lambda: Reading(archives(picture_samples()), fault_of_picture, ["small.npz"], zipped),
    "rig": lambda: Reading(
        [written("rig.toml", lambda path: autocolor.write_rig(path, scene()))],
        lambda _: fault_of_scene(scene().with_rig(autocolor.read_rig("rig.toml"))),
        ["rig.toml"],
    ),
    **{f"palette {suffix}": partial(palette_reader, suffix) for suffix in PALETTES},
    **{f"variants {suffix}": partial(variants_reader, suffix) for suffix in VARIANTS},
    "store": lambda: Reading(
        [written("small.sqlite", write_small_store)], lambda _: fault_at("small.sqlite"), ["small.sqlite"]
    ),
    "journal": lambda: Reading(
        journal_samples(),
        lambda _: fault_of_scene(read_journal("session.jsonl").history.scene),
        ["session.jsonl", "car.obj"],
    ),
    "set": lambda: Reading(
        SETTINGS,
        lambda data: fault_of_scene(with_settings(scene(), tuple(os.fsdecode(data).split("\0")))),
        largest=300,
    ),
    "sql": lambda: Reading(STATEMENTS, fault_of_sql, largest=4096),
    "stream": lambda: Reading(stream_samples(), fault_of_stream, largest=4096),
    "lister": lambda: Reading(stream_samples(), fault_of_lister, largest=2048),
    "assembler": lambda: Reading(listing_samples(), fault_of_assembler),
    "snapshot": lambda: Reading(snapshot_samples(), fault_of_snapshot, ["small.png"], png),
    "show": lambda: Reading(REPLIES, fault_of_show, largest=1024),
}
"""What is attacked, by its name."""


def trials() -> Mapping[str, Callable[[], Trial]]:
    """The attacks by their names."""
    return READERS
