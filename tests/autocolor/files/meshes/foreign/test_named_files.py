from __future__ import annotations

import io
import json
import struct
import zipfile
from pathlib import Path
from typing import Any

import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.foreign.named_files import size_of_3mf, size_of_file, size_of_gltf


def write(folder: Path, data: bytes, name: str = "a.gltf") -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


def gltf(folder: Path, **described: Any) -> Path:
    return write(folder, json.dumps(described).encode())


def refusal(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        (size_of_3mf if path.suffix == ".3mf" else size_of_gltf)(path)
    return str(caught.value)


def test_buffers_in_the_folder_are_counted_and_data_in_the_file_are_not(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a b.bin").write_bytes(bytes(1000))
    path = gltf(
        tmp_path,
        buffers=[{"uri": "sub/a%20b.bin"}, {"uri": "data:;base64,AAAA"}, {}],
        images=[{"uri": "missing.png"}, {"bufferView": 0}],
    )
    assert size_of_gltf(path) == path.stat().st_size + 1000


@pytest.mark.parametrize(
    ("uri", "sentence"),
    [
        (
            "http://example.org/a.bin",
            "must be the name of a file, not the address 'http://example.org/a.bin'; fetch it and name"
            " the file",
        ),
        (
            "file:///etc/passwd",
            "must be the name of a file, not the address 'file:///etc/passwd'; fetch it and name the file",
        ),
        ("../a.bin", "must be the name of a file in the scene's folder, not '../a.bin'; copy the file there"),
        (
            "%2e%2e/a.bin",
            "must be the name of a file in the scene's folder, not '../a.bin'; copy the file there",
        ),
        (
            "/etc/passwd",
            "must be the name of a file in the scene's folder, not '/etc/passwd'; copy the file there",
        ),
        ("a%00.bin", "must be the name of a file, not 'a\\x00.bin'; correct it"),
        (7, "must be the name of a file, not ''; correct it"),
    ],
)
@pytest.mark.parametrize("what", ["buffers", "images"])
def test_no_address_is_fetched_and_no_file_out_of_the_folder_read(
    tmp_path: Path, what: str, uri: object, sentence: str
) -> None:
    assert refusal(gltf(tmp_path, **{what: [{"uri": uri}]})) == f"a.gltf: {what} 0: it {sentence}"


def test_a_buffer_that_is_missing_or_too_large_is_refused(tmp_path: Path) -> None:
    path = gltf(tmp_path, buffers=[{}, {"uri": "a.bin"}])
    assert refusal(path) == "a.gltf: buffers 1: there is no file 'a.bin' in its folder; copy it there"
    with open(tmp_path / "a.bin", "wb") as file:
        file.truncate(1 << 28)
    assert refusal(path).startswith(
        "a.gltf: it and its buffers must have at most 268,435,456 bytes, not 268,435,"
    )


@pytest.mark.parametrize(
    "data", [b"", b"[]", b"{", b'{"a": NaN}', b"[" * 100_000, b"\xff", b"{" + b'"a":[],' * 2_000_000]
)
def test_what_is_no_json_is_refused(tmp_path: Path, data: bytes) -> None:
    assert refusal(write(tmp_path, data)).startswith(
        "a.gltf: a glTF file must describe its scene in JSON, not "
    )
    assert refusal(write(tmp_path, b"{\n a")).endswith(", not as at line 2, column 2; write it again")
    assert refusal(write(tmp_path, b'{"buffers": {}}')) == "a.gltf: buffers must be a list; correct the file"


def test_a_binary_file_has_its_json_first(tmp_path: Path) -> None:
    text = b'{"images": [{"uri": "https://x"}]}'
    head = struct.pack("<4sII I4s", b"glTF", 2, 20 + len(text), len(text), b"JSON")
    assert "the address 'https://x'" in refusal(write(tmp_path, head + text, "a.glb"))
    for data in (head[:19], head, head.replace(b"JSON", b"BIN\0") + text, b"glTF" + bytes(40)):
        assert refusal(write(tmp_path, data, "a.glb")) == (
            "a.glb: a binary glTF file must have version 2, its own length and a chunk of JSON first; the"
            " file is"
            " cut short or damaged"
        )


def test_what_an_archive_holds_is_known_before_it_is_read(tmp_path: Path) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", b"<model/>" * 1000)
    assert size_of_3mf(write(tmp_path, packed.getvalue(), "a.3mf")) == 8000
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", bytes(10_000_000))
    size = len(packed.getvalue())
    assert refusal(write(tmp_path, packed.getvalue(), "a.3mf")) == (
        f"a.3mf: a 3MF file of its size must hold at most 10,000 files and {200 * size:,} bytes, not 1 and"
        " 10,000,000; simplify it"
    )
    assert refusal(write(tmp_path, b"PK", "a.3mf")).startswith(
        "a.3mf: a 3MF file must be a whole ZIP archive, not"
    )


def test_another_file_has_its_own_size(tmp_path: Path) -> None:
    assert size_of_file(write(tmp_path, b"12345")) == 5
