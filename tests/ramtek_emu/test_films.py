from __future__ import annotations

import math
import os
import re
import weakref
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from ramtek_emu.arrays import Colors
from ramtek_emu.errors import ColorsError, OutputError, OutputExistsError, RamtekError
from ramtek_emu.films import TimedFilm, write_film
from tests.ramtek_emu.film_reader import decoded, durations_of


@st.composite
def films(draw: st.DrawFn) -> list[Colors]:
    """A few small fields. Each differs from the field before in a rectangle, which may be empty."""
    lines, elements = draw(st.integers(1, 9)), draw(st.integers(1, 9))
    field = np.zeros((lines, elements, 3), np.uint8)
    fields = []
    for _ in range(draw(st.integers(1, 5))):
        top, left = draw(st.integers(0, lines)), draw(st.integers(0, elements))
        field = field.copy()
        field[top : draw(st.integers(top, lines)), left : draw(st.integers(left, elements))] = draw(
            st.tuples(*[st.integers(0, 255)] * 3)
        )
        fields.append(field)
    return fields


def noise(count: int, lines: int = 20, elements: int = 30) -> list[Colors]:
    """Fields with a color of its own at nearly each pixel."""
    return list(np.random.default_rng(3).integers(0, 256, (count, lines, elements, 3)).astype(np.uint8))


@given(fields=films())
def test_a_film_is_decoded_to_the_same_fields(
    fields: list[Colors], tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("films") / "film.webp"
    write_film(path, iter(fields), fields_per_second=24)
    assert np.array_equal(decoded(path), fields)


def test_a_film_lasts_as_long_as_its_rate_says_and_begins_again_unless_it_is_shown_once(
    tmp_path: Path,
) -> None:
    for rate, loop in ((0.5, True), (29.97, False), (50, True)):
        path = tmp_path / f"{rate}.webp"
        write_film(path, noise(7, 2, 3), fields_per_second=rate, loop=loop)
        ends = np.cumsum(durations_of(path))
        assert np.abs(ends - np.arange(1, 8) * 1000 / rate).max() <= 0.5 + 1e-6
        with Image.open(path) as film:
            assert film.info["loop"] == (0 if loop else 1)


def test_a_field_takes_the_bytes_of_what_differs_from_the_field_before(tmp_path: Path) -> None:
    (first,) = noise(1)
    second = first.copy()
    second[7, 9] ^= 1
    for name, fields in (("one.webp", [first]), ("three.webp", [first, second, second])):
        write_film(tmp_path / name, fields, fields_per_second=24)
    assert (tmp_path / "three.webp").stat().st_size - (tmp_path / "one.webp").stat().st_size < 200


def test_fields_are_taken_one_by_one(tmp_path: Path) -> None:
    references: list[weakref.ref[Colors]] = []
    most = 0

    def made() -> Iterator[Colors]:
        nonlocal most
        for field in noise(60):
            copy = np.copy(field)
            references.append(weakref.ref(copy))
            most = max(most, sum(reference() is not None for reference in references))
            yield copy

    write_film(tmp_path / "film.webp", made(), fields_per_second=24)
    assert 1 <= most <= 4


PATTERN = "numbered pictures must have a number in their name, as in frame-{number:04}.png, not "
REFUSED: list[tuple[str, dict[str, Any], type[RamtekError], str]] = [
    ("film.gif", {}, OutputError, "must end in .webp, or in .png with a number, not in '.gif'"),
    ("film.webp", {"fields_per_second": math.nan}, ColorsError, "0.1 to 100 fields per second, not nan"),
    ("there.webp", {}, OutputExistsError, "an output must be a new file, not"),
    ("film.png", {}, OutputError, PATTERN),
    ("{name}-{number}.png", {}, OutputError, PATTERN),
    ("{number.png", {}, OutputError, PATTERN),
    ("{number[0]}.png", {}, OutputError, PATTERN),
    ("none/{number}.png", {}, OutputError, "there is no folder"),
    ("there-{number:02}.png", {}, OutputExistsError, "there-01.png, which exists"),
]


@pytest.mark.parametrize(("name", "options", "error", "sentence"), REFUSED)
def test_a_film_that_cannot_be_written_takes_no_field_and_leaves_no_file(
    name: str, options: dict[str, Any], error: type[RamtekError], sentence: str, tmp_path: Path
) -> None:
    old = ["there-01.png", "there.webp"]
    for path in old:
        (tmp_path / path).write_bytes(b"old")
    fields = iter(noise(2))
    with pytest.raises(error) as refusal:
        write_film(tmp_path / name, fields, **{"fields_per_second": 24, **options})
    assert sentence in str(refusal.value)
    assert len(list(fields)) == 2
    assert sorted(os.listdir(tmp_path)) == old
    assert all((tmp_path / path).read_bytes() == b"old" for path in old)


@pytest.mark.parametrize("count", [0, 4])
def test_a_film_has_at_least_one_field_and_at_most_the_limit(
    count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ramtek_emu.films.MOST_FIELDS", 3)
    write_film(tmp_path / "three.webp", noise(3), fields_per_second=24)
    assert len(decoded(tmp_path / "three.webp")) == 3
    with pytest.raises(ColorsError, match=r"a film must have at (least one field, not none|most 3 fields)"):
        write_film(tmp_path / "film.webp", noise(count), fields_per_second=24)
    assert os.listdir(tmp_path) == ["three.webp"]


def test_numbered_pictures_are_the_fields(tmp_path: Path) -> None:
    fields = noise(11)
    pattern = tmp_path / "a-{number:03}.png"
    write_film(pattern, iter(fields), fields_per_second=24)
    names = [f"a-{number:03}.png" for number in range(1, 12)]
    assert sorted(os.listdir(tmp_path)) == names
    for name, field in zip(names, fields, strict=True):
        assert np.array_equal(decoded(tmp_path / name), [field])
    write_film(pattern, fields[5:7], fields_per_second=24, overwrite=True)
    assert np.array_equal(decoded(tmp_path / names[1]), [fields[6]])


def test_a_webp_ends_at_its_largest_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ramtek_emu.films.LARGEST_RIFF", 5000)
    with pytest.raises(OutputError, match="a WebP must have at most 4 GB, not more"):
        write_film(tmp_path / "film.webp", noise(20), fields_per_second=10)
    assert os.listdir(tmp_path) == []


@given(
    fields=films(),
    seconds=st.lists(st.floats(0.001, 300), min_size=5, max_size=5),
    start=st.floats(-10_000, 10_000),
)
def test_a_timed_film_shows_each_field_for_its_time(
    fields: list[Colors], seconds: list[float], start: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    times = [start, *(start + np.cumsum(seconds[: len(fields)]))]
    film = TimedFilm(fields[0], start)
    for field, at in zip(fields[1:], times[1:-1], strict=True):
        film.show(field, at)
    count, data = film.fields, film.end(times[-1])
    path = tmp_path_factory.mktemp("films") / "film.webp"
    path.write_bytes(data)
    changes = [n for n, f in enumerate(fields) if n == 0 or not np.array_equal(f, fields[n - 1])]
    assert count == len(changes)
    assert np.array_equal(decoded(path), [fields[number] for number in changes])
    spans = np.diff([*(times[number] for number in changes), times[-1]]) * 1000
    # Times are rounded to milliseconds.
    assert np.all(np.abs(durations_of(path) - spans) <= 2)


def test_no_duration_of_a_timed_film_is_too_long_for_the_format(tmp_path: Path) -> None:
    first, second = noise(2, 2, 3)
    film = TimedFilm(first, 0)
    film.show(second, 1e6)
    (tmp_path / "film.webp").write_bytes(film.end(1e6 + 60))
    assert durations_of(tmp_path / "film.webp") == [16_777_215, 60_000]


@pytest.mark.parametrize("limit", ["FIELDS", "BYTES"])
def test_a_timed_film_is_full_at_its_limits(limit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"ramtek_emu.films.MOST_{limit}", {"FIELDS": 3, "BYTES": 3500}[limit])
    first, *fields = noise(4)
    film = TimedFilm(first, 0.0)
    full = []
    for number, field in enumerate(fields, 1):
        film.show(field, number)
        full.append(film.is_full)
    # The data of a field are 1,800 bytes and more, and those of the field that is shown are not encoded yet.
    assert full == [False, True, True]


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ([np.zeros((2, 3, 3), np.uint8), np.zeros((3, 2, 3), np.uint8)], "2 of shape (3, 2, 3), uint8"),
        ([np.zeros((2, 3, 3))], "1 of shape (2, 3, 3), float64"),
        ([np.zeros((2, 3, 4), np.uint8)], "1 of shape (2, 3, 4)"),
        ([np.zeros((2, 3), np.uint8)], "1 of shape (2, 3)"),
        ([np.zeros((0, 3, 3), np.uint8)], "1 of shape (0, 3, 3)"),
    ],
)
def test_fields_that_are_not_alike_make_no_film(fields: list[Any], sentence: str, tmp_path: Path) -> None:
    with pytest.raises(ColorsError, match=re.escape(f"not field {sentence}")):
        write_film(tmp_path / "film.webp", fields, fields_per_second=24)
    assert os.listdir(tmp_path) == []
