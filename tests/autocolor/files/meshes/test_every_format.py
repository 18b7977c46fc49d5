"""Rules that hold for the mesh files of all formats, tried with a sample of each."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.formats import FILE_FORMATS, MESH_FORMATS, Format, read_mesh, recognized
from autocolor.files.meshes.repair import Placement
from autocolor.files.opening import OUTPUTS
from autocolor.scene.mesh import Mesh
from tests.autocolor.files.refusals import is_read_or_refused, refusal
from tests.mutations import BY_HAND, Seed, written_seed

OURS = [each for each in MESH_FORMATS if not isinstance(each.read, partial)]
"""The formats that no library reads in a process of its own."""

SEEDS = [each for each in BY_HAND if each.read]
TEXTS = [each for each in SEEDS if each.files[each.read].isascii()]
BEGINNING = [each for each in OURS if each.keys == ("file",) and each.begins is not None]


@functools.cache
def sample_of(mesh_format: Format) -> Seed:
    """A sample of a format, by hand or as the program writes it."""
    by_hand = (each for each in SEEDS if each.read.endswith(mesh_format.suffixes))
    return next(by_hand, None) or next(
        written_seed(each) for each in OUTPUTS if each.name == mesh_format.name
    )


def written(folder: Path, seed: Seed) -> Mapping[str, Path]:
    """The files of a sample by their keys, written to a folder."""
    for name, data in seed.files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    if len(seed.files) == 1 or seed.read:
        return {"file": folder / (seed.read or next(iter(seed.files)))}
    return {Path(name).stem: folder / name for name in seed.files if name.startswith(("nodes", "polygons"))}


def is_same(mesh: Mesh, other: Mesh) -> bool:
    names = ("coordinates", "node_numbers", "part_numbers", "part_names")
    return all(np.array_equal(getattr(mesh, name), getattr(other, name)) for name in names)


@pytest.mark.parametrize("mesh_format", OURS, ids=lambda each: each.name)
def test_the_up_axis_becomes_z_and_the_scale_is_multiplied(tmp_path: Path, mesh_format: Format) -> None:
    files = written(tmp_path, sample_of(mesh_format))
    x, y, z = read_mesh(files).mesh.coordinates.T
    for up, axes in (("z", (x, y, z)), ("y", (x, -z, y)), ("x", (y, z, x))):
        placed = read_mesh(files, Placement(up, 0.5)).mesh.coordinates
        assert placed.tolist() == (np.stack(axes, axis=1) * 0.5).tolist()


@pytest.mark.parametrize("mesh_format", FILE_FORMATS, ids=lambda each: each.name)
def test_a_folder_or_a_missing_file_is_refused(tmp_path: Path, mesh_format: Format) -> None:
    path = tmp_path / f"car{mesh_format.suffixes[0]}"
    assert refusal(read_mesh, {"file": path}) == f"{path}: there is no such file or folder; check the name"
    path.mkdir()
    assert f"{path}: it must be a regular file, not a folder" in refusal(read_mesh, {"file": path})


@pytest.mark.parametrize("mesh_format", BEGINNING, ids=lambda each: each.name)
def test_a_file_of_another_name_is_known_by_how_it_begins(tmp_path: Path, mesh_format: Format) -> None:
    path = written(tmp_path, sample_of(mesh_format))["file"]
    mesh = read_mesh({"file": path}).mesh
    again = path.rename(path.with_suffix(".model"))
    assert recognized(again, FILE_FORMATS) is mesh_format
    assert is_same(read_mesh({"file": again}).mesh, mesh)


@pytest.mark.parametrize("seed", TEXTS, ids=lambda each: each.name)
def test_lines_end_in_any_way_and_a_mark_of_utf_8_may_stand_before_them(tmp_path: Path, seed: Seed) -> None:
    files = written(tmp_path, seed)
    report = read_mesh(files)
    for ending in (b"\n", b"\r\n", b"\r"):
        files["file"].write_bytes(b"\xef\xbb\xbf" + seed.files[seed.read].replace(b"\n", ending))
        again = read_mesh(files)
        assert is_same(again.mesh, report.mesh)
        assert again.repairs == report.repairs


THINGS = {
    ".g": "a Movie.BYU",
    ".obj": "an OBJ",
    ".off": "an OFF",
    ".ply": "an ascii PLY",
    ".stl": "an ascii STL",
}


@pytest.mark.parametrize(
    "seed", [each for each in TEXTS if each.read.endswith((*THINGS,))], ids=lambda each: each.name
)
def test_text_must_be_utf_8(tmp_path: Path, seed: Seed) -> None:
    path = written(tmp_path, seed)["file"]
    data = seed.files[seed.read]
    path.write_bytes(data.decode().encode("utf-16"))
    thing = THINGS[path.suffix].replace("an ascii PLY", "a PLY")
    assert refusal(read_mesh, {"file": path}) == (
        f"{path.name}: {thing} file must be text in UTF-8, not UTF-16; save it as UTF-8"
    )
    path.write_bytes(data.strip(b"\n") + b"\n\0")
    assert refusal(read_mesh, {"file": path}) == (
        f"{path.name}: {THINGS[path.suffix]} file must be text, not hold a NUL byte"
        f" (line {len(data.splitlines()) + 1}); save it as UTF-8 text"
    )


@pytest.mark.parametrize(
    "seed",
    SEEDS,
    ids=lambda each: each.name,
)
def test_a_file_cut_anywhere_is_refused_or_told(tmp_path: Path, seed: Seed) -> None:
    files = written(tmp_path, seed)
    data = seed.files[seed.read]
    # OBJ files may end after any table; in text, the last line may lose the end of a number.
    whole = data.rstrip().rfind(b"\n") if data.isascii() else len(data)
    for length in range(0, whole, 5):
        files["file"].write_bytes(data[:length])
        try:
            told = read_mesh(files).repairs
        except InputError as error:
            told = error.problems
        assert seed.read.endswith(".obj") or told[0].startswith("plate."), length


@pytest.mark.parametrize("seed", SEEDS, ids=lambda each: each.name)
@given(
    share=st.floats(0, 1),
    data=st.binary(max_size=60)
    | st.text("solidenfacrumvtxpg 01239.-+/#\\\n\r\t", max_size=99).map(str.encode),
)
def test_any_bytes_at_any_place_are_read_or_refused(
    seed: Seed, share: float, data: bytes, tmp_path_factory: pytest.TempPathFactory
) -> None:
    whole = seed.files[seed.read]
    path = tmp_path_factory.getbasetemp() / seed.read
    assert is_read_or_refused(path, whole[: int(share * len(whole))] + data)
    assert is_read_or_refused(path, data)
