from __future__ import annotations

import math
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import BlinnPhong, Flap, Flaps, InputError, Light, Paint, Surface
from autocolor.checks import Color
from autocolor.files.store import schema as module
from autocolor.files.store.schema import (
    RowTable,
    SqlValue,
    columns_of,
    plain_row,
    row_values,
)
from autocolor.files.store.store_file import read_store
from autocolor.scene.columns import Row, Tier, column_of, from_plain, keys_of
from autocolor.scene.kinds import Whole, boolean, color, coordinates, number, one_of, text, vector
from autocolor.scene.reflection_models import MODELS
from autocolor.scene.row_kinds import OneRowOf, Reference, References, nested, table_row
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part
from autocolor.scene.view import NamedView, View
from autocolor.testing import lights, surfaces, vectors
from tests.autocolor.files.store.stores import small_store


def test_a_table_of_too_many_rows_is_refused_before_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST_ROWS", 1)
    with pytest.raises(InputError, match="the rows of parts must be at most 1, not more; leave rows out"):
        read_store(small_store(tmp_path))


FREE = Tier.NOTHING


@table_row
class Inner(Row):
    low: float = number(default=-math.inf, endless=-math.inf, tier=FREE, help="")
    shut: bool = boolean(default=False, tier=FREE, help="")


@table_row
class MadeUp(Row):
    """A row class with a column of each kind, which nothing else knows of."""

    name: str = text(tier=FREE, help="")
    order: int = column_of(Whole(1, 5), tier=FREE, help="")
    group: str = one_of(("a", "it's"), default="it's", tier=FREE, help="")
    place: tuple[float, float, float] = coordinates(default=(1.0, 2.0, 3.0), tier=FREE, help="")
    way: tuple[float, float, float] | None = vector(default=None, tier=FREE, help="")
    tint: Color | None = color(default=None, tier=FREE, help="")
    model: Row = column_of(OneRowOf(MODELS), default=BlinnPhong(), tier=FREE, help="")
    near: object = column_of(Reference("lights", "here"), default="here", tier=FREE, help="")
    all: tuple[str, ...] | None = column_of(References("lights"), default=None, tier=FREE, help="")
    inner: Inner | None = nested(Inner, default=None, tier=FREE, help="")
    paint: Paint = nested(Paint, default=Paint(), inline=True, tier=FREE, help="")


texts = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), min_size=1, max_size=9)
made_up = st.builds(
    MadeUp,
    texts,
    st.integers(1, 5),
    st.sampled_from(["a", "it's"]),
    vectors(),
    st.none() | vectors().filter(any),
    st.none() | st.just((1, 2, 3)),
    st.sampled_from([model() for model in MODELS.values()]),
    texts | st.just('["a"]'),
    st.none() | st.lists(texts, max_size=3),
    st.none() | st.builds(Inner, st.just(-math.inf) | st.floats(-5, 5), st.booleans()),
)


def values_of(row: Row) -> dict[str, SqlValue]:
    """The values of a row by the names of the columns of its class."""
    columns = columns_of(type(row))
    return dict(zip([column.name for column in columns], row_values(columns, row), strict=True))


def through_a_table(row_class: type[Row], values: dict[str, SqlValue]) -> dict[str, SqlValue]:
    """All values of a row as a table gives them back that was made for its class."""
    with closing(sqlite3.connect(":memory:")) as connection:
        connection.execute("CREATE TABLE surfaces (name TEXT UNIQUE)")
        connection.execute(RowTable("rows", row_class).definition)
        names, marks = ", ".join(f'"{name}"' for name in values), ", ".join("?" * len(values))
        connection.execute(f"INSERT INTO rows ({names}) VALUES ({marks})", tuple(values.values()))
        connection.row_factory = sqlite3.Row
        return dict(connection.execute("SELECT * FROM rows").fetchone())


@given(made_up | lights() | surfaces("body"))
def test_a_row_of_any_class_comes_back_from_its_table(row: Row) -> None:
    back = through_a_table(type(row), values_of(row))
    assert from_plain(type(row), plain_row(columns_of(type(row)), back)) == row


@pytest.mark.parametrize("cls", [Scene, View, NamedView, Scalar, Light, Surface, Part, Flap, Flaps, MadeUp])
def test_every_key_of_a_class_has_its_columns(cls: type[Row]) -> None:
    held_elsewhere = {"mesh", "parts", "surfaces", "lights", "views"} if cls is Scene else set()
    found = {column.path[0] for column in columns_of(cls)}
    assert found == keys_of(cls).keys() - held_elsewhere


def test_a_table_fills_in_the_defaults_of_the_row() -> None:
    back = through_a_table(MadeUp, {"name": "new", "order": 2})
    assert from_plain(MadeUp, plain_row(columns_of(MadeUp), back)) == MadeUp("new", 2)


def test_a_row_in_a_row_that_is_absent_has_no_infinite_limits() -> None:
    values = values_of(MadeUp("plain", 1))
    assert plain_row(columns_of(MadeUp), values).get("inner") is None
    shut = values_of(MadeUp("shut", 1, inner=Inner(shut=True)))
    assert (shut["inner_low"], shut["inner_shut"]) == (None, 1)
    assert plain_row(columns_of(MadeUp), shut)["inner"] == {"low": -math.inf, "shut": True}
