from __future__ import annotations

import csv
import io
import json
import pickle
import time
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Palette, UsageError, Variant, grid, read_variants, write_palette
from autocolor.batches.table import (
    LARGEST_TABLE,
    MOST_VARIANTS,
    Result,
    products,
    results_bytes,
    text_of,
    variants_of,
    varied,
)
from autocolor.files.paths import file_stem
from tests.tables import call, refused

VALUES = st.one_of(
    st.integers(-9, 9),
    st.floats(-9, 9),
    st.booleans(),
    st.none(),
    st.text(max_size=5),
    st.lists(st.integers(0, 9), max_size=3),
)
TABLES = st.lists(st.dictionaries(st.sampled_from("abcd"), VALUES, max_size=4), max_size=12)


def settings_of(variants: tuple[Variant, ...]) -> list[dict[str, object]]:
    return [dict(variant.settings) for variant in variants]


@given(TABLES)
def test_variants_keep_their_settings_and_get_names_that_are_files_and_unique(
    rows: list[dict[str, object]],
) -> None:
    variants = variants_of(rows)
    assert settings_of(variants) == rows
    names = [variant.name for variant in variants]
    assert len({name.casefold() for name in names}) == len(names)
    assert all(file_stem(name) == name for name in names)


def test_a_name_is_of_the_values_that_vary_and_numbers_tell_equal_names_apart() -> None:
    rows: list[dict[str, object]] = [
        {"a": "#ff0000", "b": 1},
        {"a": "navy", "b": 1},
        {"a": "Navy", "b": 1.0},
        {"b": 1},
        {"name": "own", "a": "x/y"},
        {"a": "x/y"},
    ]
    names = [variant.name for variant in variants_of(rows)]
    assert names == ["ff0000-1", "navy-1", "Navy-1-2", "1", "own", "x_y"]


def test_a_variant_is_read_only_and_survives_pickling() -> None:
    variant = Variant("a", {"ambient": 1}, 2)
    assert pickle.loads(pickle.dumps(variant)) == variant == Variant("a", {"ambient": 1}, 2.0)
    assert isinstance(variant.settings, MappingProxyType)
    # The text of an array would leave out digits.
    array = np.array([1.123456789012, 2.0])
    plain = Variant("a", {"view.eye": array, "ambient": np.float32(0.5)}, np.int64(2))  # type: ignore[arg-type]
    assert plain == Variant("a", {"view.eye": [1.123456789012, 2.0], "ambient": 0.5}, 2.0)


@given(
    st.dictionaries(st.sampled_from("abc"), st.lists(st.integers(0, 9), min_size=1, max_size=4), min_size=1)
)
def test_a_grid_is_every_combination_in_the_order_of_its_lists(axes: dict[str, list[int]]) -> None:
    expected: list[dict[str, int]] = [{}]
    for key, values in axes.items():
        expected = [{**row, key: value} for row in expected for value in values]
    assert settings_of(grid(axes)) == expected


def test_tables_are_multiplied_with_their_names_and_times() -> None:
    looks = variants_of([{"name": "dark", "ambient": 0, "time": 3}, {"name": "light", "ambient": 1}])
    made = products([looks, varied("scaling=object"), varied("contrast=floor,stretch")])
    names = ["dark-floor", "dark-stretch", "light-floor", "light-stretch"]
    assert [variant.name for variant in made] == names
    assert [variant.time for variant in made] == [3, 3, None, None]
    assert made[0].settings == {"ambient": 0, "scaling": "object", "contrast": "floor"}


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a=red,blue,#1f3f8f", ["red", "blue", "#1f3f8f"]),
        ("a = 1 , 2 ", ["1", "2"]),
        ("a=[1, 2],[3, 4]", ["[1, 2]", "[3, 4]"]),
        ("a=rgb(1, 2, 3),{x = 1, y = [2, 3]}", ["rgb(1, 2, 3)", "{x = 1, y = [2, 3]}"]),
        ("a=\"x, y\",'z, ]',w", ['"x, y"', "'z, ]'", "w"]),
        ("a=0.5:2:4", [0.5, 1.0, 1.5, 2.0]),
        ("a=3:-1:3", [3.0, 1.0, -1.0]),
        ("a=0:0.3:4", [0.0, 0.1, 0.2, 0.3]),
        ("a=none", ["none"]),
        ("a=b=c,d", ["b=c", "d"]),
    ],
)
def test_a_list_of_values_is_split_at_commas_outside_of_brackets_and_quotes(
    text: str, values: list[object]
) -> None:
    assert settings_of(varied(text)) == [{"a": value} for value in values]


def test_a_palette_gives_its_colors_and_their_names_beside_other_values(tmp_path: Path) -> None:
    path = tmp_path / "paints, old.gpl"
    write_palette(path, ["#102030", "#ff0000", "#00ff00"], names=["Deep/Sea", "Red", ""])
    variants = varied(f"a=red,@'{path}',\"@x\",@'{path}'")
    colors = ["#102030", "#ff0000", "#00ff00"]
    assert settings_of(variants) == [{"a": value} for value in ("red", *colors, '"@x"', *colors)]
    names = ["red-3", "Deep/Sea", "Red", "00ff00", "@x", "Deep/Sea-2", "Red-2", "00ff00-2"]
    assert [variant.name for variant in variants] == names


def written(folder: Path, name: str, data: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    return path


def test_a_palette_is_an_axis_with_the_names_of_its_colors_and_a_list_in_settings() -> None:
    palette = Palette(["red", "lime", "navy"], ["Deep/Sea", "", "deep/sea"])
    variants = grid({"a": palette, "b": [1]})
    assert [variant.name for variant in variants] == ["Deep/Sea", "00ff00", "deep/sea-2"]
    colors = ["#ff0000", "#00ff00", "#000080"]
    assert settings_of(variants) == [{"a": color, "b": 1} for color in colors]
    assert Variant("ramp", {"a": palette}).settings == {"a": colors}


def test_a_csv_table_has_texts_and_an_empty_cell_sets_nothing(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        "looks.csv",
        "\ufeffname;time;view.eye;ambient;on;;\r\na;0;[1, 2.5];0,5;TRUE;;\r\n;;;;;;\r\n;2,5;;none;\r\n",
    )
    assert read_variants(path) == (
        Variant("a", {"view.eye": "[1, 2.5]", "ambient": "0.5", "on": "TRUE"}, 0),
        Variant("none", {"ambient": "none"}, 2.5),
    )


def test_a_key_of_its_own_in_each_row_takes_linear_time(tmp_path: Path) -> None:
    def seconds(count: int) -> float:
        path = written(tmp_path, f"{count}.json", json.dumps([{f"k{row}": row} for row in range(count)]))
        begin = time.process_time()
        variants = read_variants(path)
        assert [variant.name for variant in variants[:3]] == ["0", "1", "2"]
        return time.process_time() - begin

    # Eight times as many rows took 64 times as long.
    assert seconds(16_000) < 30 * seconds(2000)


def test_a_json_table_has_plain_values(tmp_path: Path) -> None:
    rows = [{"name": "a", "view.eye": [1, 2, 3], "scalar": None, "time": 1}, {"ambient": 0.5}]
    path = written(tmp_path, "looks.json", json.dumps(rows))
    assert read_variants(str(path)) == (
        Variant("a", {"view.eye": [1, 2, 3], "scalar": None}, 1),
        Variant("0.5", {"ambient": 0.5}),
    )


TIME = "the time of a variant must be a number from -1e+09 to 1e+09, not"
JSON = "t.json: a table must be valid JSON"

REFUSED_FILES = [
    ("t.csv", "a,b\n", "t.csv: a table must have at least one variant, not none; add a row"),
    ("t.csv", "name,a\nx,1\nX,2\n", "t.csv, row 3: a name must be unique, not 'X' as in row 2; rename"),
    ("t.csv", "time,a\n\nsoon,1\n", f"t.csv, row 3: {TIME} 'soon'; correct it"),
    ("t.csv", "time,a\n1e999,1\n", f"t.csv, row 2: {TIME} inf"),
    ("t.csv", b"\xff\xfea\0", "t.csv: a table of variants must be text in UTF-8, not UTF-16"),
    (
        "t.csv",
        "a\n" + "1\n" * (MOST_VARIANTS + 1),
        "t.csv, row 100002: a table must have at most 100,000 var",
    ),
    ("t.json", "{}", "t.json: a table in JSON must be a list of objects, not {}"),
    ("t.json", "[1]", "t.json, row 1: a variant must be a table of values by key, not 1; write it as in"),
    ("t.json", '[{"name": 3}]', "t.json, row 1: a variant must have a name of at least one character, not 3"),
    ("t.json", '[{"time": true}]', f"t.json, row 1: {TIME} true"),
    ("t.json", f'[{{"time": {"9" * 400}}}]', f"t.json, row 1: {TIME} 999"),
    ("t.json", "[NaN]", f"{JSON} (the number NaN"),
    ("t.json", b'["\xff"]', JSON),
    (
        "t.txt",
        "a\n1\n",
        "a table of variants must be a file that ends in .csv or .json, not t.txt; rename it",
    ),
    ("t.csv", bytes(LARGEST_TABLE + 1), "t.csv: a file must have at most 16,777,216 bytes"),
]


@pytest.mark.parametrize(("name", "data", "sentence"), REFUSED_FILES, ids=lambda value: value[:40])
def test_a_bad_table_is_refused_with_its_place(
    tmp_path: Path, name: str, data: str | bytes, sentence: str
) -> None:
    with pytest.raises((InputError, UsageError)) as caught:
        read_variants(written(tmp_path, name, data))
    assert str(caught.value).startswith(sentence)
    assert isinstance(caught.value, UsageError) == (name == "t.txt")


LIST = "variants must be a list of tables or of Variants, not"
WRITTEN = "write them after the scene, as in [{'ambient': 0.1}, {'ambient': 0.2}]"
GRID = "a grid must have 1 to 100,000 variants, not"
VARY = "--vary must be KEY=A,B,C or KEY=START:STOP:COUNT, not"
ENDS = (
    "--vary a: evenly spaced numbers must be START:STOP:COUNT, finite and with a whole COUNT from 2 to"
    " 100,000, not"
)
FORM = "; write it as in surfaces.body.object_color=red,navy"
WRONG: Any = {"a": 1}

test_wrong_variants_are_refused = refused(
    call,
    [
        (lambda: variants_of(WRONG), f"{LIST} {{'a': 1}}; {WRITTEN}"),
        (
            lambda: variants_of([{}, {1: 2}]),  # type: ignore[dict-item]
            "row 2: the settings of a variant must be values by key, not {1: 2}; write them as in"
            " {'ambient': 0.2}",
        ),
        (
            lambda: variants_of({} for _ in iter(int, 1)),
            "row 100001: a table must have at most 100,000 variants, not more; split it",
        ),
        (lambda: grid({"a": []}), f"{GRID} 0; give a value for each key"),
        (lambda: grid({key: range(100) for key in "abc"}), f"{GRID} 1,000,000; give fewer values"),
        (
            lambda: grid({"a": "red"}),
            "a: an axis must be a list of values or a Palette, not 'red'; write it as a list",
        ),
        (
            lambda: grid(["a"]),  # type: ignore[arg-type]
            "a grid must be lists of values by key, not ['a']; write it as in {'ambient': [0.1, 0.2]}",
        ),
        (lambda: products([]), f"{GRID} 0; give a value for each key"),
        (
            lambda: products([varied("a=1,2"), varied("a=3")]),
            "a key must be in one table or list, not 'a' in two; leave one out",
        ),
        *((lambda text=text: varied(text), f"{VARY} {text!r}{FORM}") for text in ("a", "=1", "name=a,b")),
        (
            lambda: varied("a=1,,2"),
            "--vary a: there must be a value before and after each comma, not '1,,2'; leave a comma out, or"
            " write none for a field without a value",
        ),
        *(
            (lambda text=text: varied(f"a={text}"), f"{ENDS} {text!r}; correct it")
            for text in ("0:1:1", "0:1e999:3", "0:2:0.5")
        ),
    ],
)


@given(TABLES, st.lists(st.text(max_size=8), max_size=12))
def test_the_table_of_results_has_a_row_for_each_with_every_key(
    rows: list[dict[str, object]], problems: list[str]
) -> None:
    results = [
        Result(variant.name, variant.settings, None, problem=problem)
        for variant, problem in zip(variants_of(rows), problems, strict=False)
    ]
    header, *cells = csv.reader(io.StringIO(results_bytes(results).decode(), newline=""))
    read: list[dict[str, Any]] = [dict(zip(header, row, strict=True)) for row in cells]
    keys = {key for result in results for key in result.settings}
    assert set(header) == {"name", "path", "seconds", "problem", *keys}
    assert [row["problem"] for row in read] == [result.problem for result in results]
    for row, result in zip(read, results, strict=True):
        for key in keys:
            value = result.settings.get(key, "")
            assert row[key] == (json.dumps(value) if isinstance(value, list) else text_of(value))


def test_evenly_spaced_numbers_may_be_as_far_apart_as_numbers_are() -> None:
    values = [variant.settings["a"] for variant in varied("a=-1e308:1e308:5")]
    assert values == [-1e308, -5e307, 0, 5e307, 1e308]
