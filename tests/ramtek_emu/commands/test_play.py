from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from PIL import Image

from ramtek_emu import (
    MissingInputError,
    RamtekError,
    WriteError,
    instructions,
    read_snapshot,
)
from ramtek_emu.commands.displays import Run
from ramtek_emu.commands.ramtek import ramtek
from ramtek_emu.writing import Output
from tests.ramtek_emu.film_reader import decoded, durations_of
from tests.ramtek_emu.processes import field_of, run, started, stream
from tests.ramtek_emu.recorded_streams import COLOR_MAP, OUTLINE
from tests.ramtek_emu.serving import until


def test_a_played_stream_gives_its_picture_its_recording_and_its_snapshot(tmp_path: Path) -> None:
    path, picture, record = tmp_path / "a.ramtek", tmp_path / "a.png", tmp_path / "b.ramtek"
    path.write_bytes(stream(np.concatenate((COLOR_MAP, OUTLINE))) + b"!")
    arguments = ("play", path, "-o", picture, "--record", record, "--snapshot", tmp_path / "s.png")
    played = run(*arguments, "--configuration", "Princeton-9300")
    assert played.returncode == 0, played.stderr
    display = read_snapshot(tmp_path / "s.png")
    assert display.configuration.name == "PRINCETON_9300"
    assert display.words.any()
    assert (field_of(picture) == display.field()).all()
    assert record.read_bytes() == path.read_bytes()[:-1]
    assert run(*arguments).returncode == 73
    assert run("play", "-", "-o", picture, "--force", data=record.read_bytes()).returncode == 0
    assert run("play", path, "--loads-per-second", "30").returncode == 69


FRAMES = np.concatenate([instructions.load_entries(0, [(20 * number, 0, 0)]) for number in range(1, 6)])
"""Five loads of the entry that an empty display shows everywhere."""


def reds(path: Path | str) -> list[int]:
    """The red of the first pixel of each field of a film."""
    return [int(field[0, 0, 0]) for field in decoded(path)]


def play(*arguments: object) -> Result:
    return CliRunner().invoke(ramtek, ["play", *map(str, arguments)])


@pytest.fixture
def frames(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The file of five loads, in the current folder."""
    monkeypatch.chdir(tmp_path)
    Path("frames.ramtek").write_bytes(stream(FRAMES))
    return "frames.ramtek"


@pytest.mark.parametrize(
    ("name", "options", "expected"),
    [
        ("a.webp", [], [20, 40, 60, 80, 100]),
        ("a.webp", ["--every", 1], [20, 40, 60, 80, 100]),
        ("a.webp", ["--every", 2], [40, 80, 100]),
        ("a.webp", ["--every", 9], [100]),
    ],
)
def test_a_film_has_a_frame_after_each_load_or_after_some_instructions(
    frames: str, name: str, options: list[object], expected: list[int]
) -> None:
    played = play(frames, "--film", name, *options, "-o", "a.png")
    assert played.exit_code == 0
    assert played.stderr.splitlines() == [f"wrote {name}", "wrote a.png"]
    assert reds(name) == expected
    assert np.array_equal(decoded(name)[-1], field_of(Path("a.png")))


def test_a_film_goes_on_from_a_snapshot_and_is_written_with_all_other_outputs(frames: str) -> None:
    assert play(frames, "--configuration", "PRINCETON_9300", "--snapshot", "a.png").exit_code == 0
    Path("nop.ramtek").write_bytes(stream([0x0700]))
    options = ("--start", "a.png", "--film", "b.webp", "--fps", 5, "--once")
    assert play("nop.ramtek", *options, "--record", "b.ramtek", "--snapshot", "b.png").exit_code == 0
    assert np.array_equal(decoded("b.webp")[0], read_snapshot("b.png").field())
    assert Path("b.ramtek").read_bytes() == Path("nop.ramtek").read_bytes()
    assert durations_of(Path("b.webp")) == [200]
    with Image.open("b.webp") as film:
        assert film.info["loop"] == 1


REFUSED: list[tuple[list[object], int, str]] = [
    (["--film", "a.gif"], 73, "a film must end in"),
    (["--film", "frames.webp"], 73, "which exists"),
    (["--film", "a.webp", "--fps", 101], 2, "101.0 is not in the range 0.1<=x<=100"),
    (["--film", "a.webp", "--every", 0], 2, "'--every': 0 is not in the range"),
    (["--film", "a.webp", "--loads-per-second", 9], 2, "--loads-per-second must not be given with an output"),
    (["--film", "a.webp", "--record", "a.webp"], 2, "two outputs must be two files"),
    (["--film", "a-{number}.png", "-o", "a-1.png"], 2, "two outputs must be two files"),
    (["-o", "a.png", "--every", 3], 2, "--every must not be given without --film, where it has no effect"),
    (["--once"], 2, "--once must not be given without --film, where it has no effect"),
]


@pytest.mark.parametrize(("options", "code", "sentence"), REFUSED)
def test_a_wrong_film_is_refused_before_the_stream_is_read(
    frames: str, options: list[object], code: int, sentence: str
) -> None:
    Path("frames.webp").write_bytes(b"old")
    refused = play("none.ramtek", *options)
    error = refused.exception
    assert (error.exit_code if isinstance(error, RamtekError) else refused.exit_code) == code
    assert sentence in refused.stderr + str(error)
    assert sorted(path.name for path in Path().iterdir()) == ["frames.ramtek", "frames.webp"]


@pytest.mark.parametrize("name", ["a.webp", "{number}.png"])
def test_a_film_that_fails_is_reported_and_the_stream_goes_on(
    frames: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(output: Output, _: bytes) -> None:
        raise WriteError(f"{output.path.name} is full")

    monkeypatch.setattr(Output, "write", fail)
    monkeypatch.setattr(
        "ramtek_emu.display.write_atomically", lambda path, data, **_: Path(path).write_bytes(data)
    )
    played = play(frames, "--film", name, "-o", "end.png")
    assert played.exit_code == 74
    assert played.stderr.splitlines() == [
        f"ramtek: {name.replace('{number}', '1')} is full",
        "wrote end.png",
    ]
    assert field_of(Path("end.png"))[0, 0, 0] == 100
    assert sorted(path.name for path in Path().iterdir()) == ["end.png", "frames.ramtek"]


def test_of_a_stream_that_cannot_be_read_to_its_end_the_beginning_is_shown_and_written(
    frames: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pieces = [stream(FRAMES)]

    def read(_: int, __: int) -> bytes:
        if pieces:
            return pieces.pop()
        raise OSError("broken")

    def show(monitor: Any, run: Run) -> None:
        def has_failed() -> bool:
            monitor.on_tick()
            return run.exit_code != 0 and monitor.display.words_received == len(FRAMES)

        until(has_failed)

    monkeypatch.setattr("ramtek_emu.commands.play.os.read", read)
    monkeypatch.setattr("ramtek_emu.commands.play.show", show)
    failed = play(frames, "--record", "a.ramtek")
    assert failed.exit_code == MissingInputError.exit_code
    assert "ramtek: a stream must be readable to its end" in failed.stderr
    assert Path("a.ramtek").read_bytes() == stream(FRAMES)
    pieces.append(stream(FRAMES))
    assert play(frames, "--film", "a.webp", "-o", "b.png").exit_code == MissingInputError.exit_code
    assert (reds("a.webp")[-1], field_of(Path("b.png"))[0, 0, 0]) == (100, 100)


def test_an_interrupted_film_has_the_frames_so_far(tmp_path: Path) -> None:
    arguments = ("--film", tmp_path / "{number}.png", "--every", 2, "-o", tmp_path / "end.png")
    with started("play", "-", *arguments) as process:
        assert process.stdin is not None
        process.stdin.write(stream(FRAMES) + b"\0\3\0\0!")
        until((tmp_path / "2.png").exists)
        process.send_signal(signal.SIGINT)
        assert process.wait(60) in (-signal.SIGINT, 128 + signal.SIGINT)
        assert process.stderr is not None
        messages = process.stderr.read()
    assert b"{number}.png\n" in messages
    # The signal came first: the end of the stream is not known.
    assert b"the stream ends" not in messages
    numbers = sorted(int(path.stem) for path in tmp_path.glob("[0-9]*.png"))
    assert numbers in ([1, 2], [1, 2, 3])
    assert np.array_equal(field_of(tmp_path / f"{numbers[-1]}.png"), field_of(tmp_path / "end.png"))
