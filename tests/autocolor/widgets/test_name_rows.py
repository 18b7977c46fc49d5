"""Names of rows of other tables are chosen by pointing: one of them, or a list."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import pytest

from autocolor.scene.columns.column import Column, Row, Tier, fields_of
from autocolor.scene.columns.reference_kinds import Reference, References, Referring, WordOrName
from autocolor.widgets.areas import Area
from autocolor.widgets.name_rows import NAMES_A_PAGE, KnownNames, reference_rows
from autocolor.widgets.widget import Choice, Place, Switch, Widget

AREA = Area(505, 0, 639, 15)
NEXT = Place(600, 8)


@dataclass(frozen=True)
class Rope(Row):
    """A column of each kind of reference."""

    post: Annotated[str, Column(Reference("posts"), Tier.MIX, "Its post.")] = "a"
    hook: Annotated[str | None, Column(Reference("posts"), Tier.MIX, "Its hook.")] = None
    end: Annotated[str | None, Column(WordOrName("posts", "ground"), Tier.MIX, "Its end.")] = None
    only_posts: Annotated[tuple[str, ...] | None, Column(References("posts"), Tier.MIX, "Posts.")] = None


class Menu:
    """The rows of one column, which change its value."""

    def __init__(self, name: str, value: Any = None, posts: Sequence[str] = ("a", "b", "c")) -> None:
        self.field = fields_of(Rope)[name]
        self.value, self.posts = value, posts
        self.pages: dict[str, int] = {}

    def take(self, value: Any) -> None:
        self.value = value

    def _posts(self, table: str) -> Sequence[str]:
        assert table == "posts"
        return self.posts

    @property
    def rows(self) -> list[Widget]:
        kind = self.field.column.kind
        assert isinstance(kind, Referring)
        known = KnownNames(self._posts, self.pages)
        found = reference_rows("its posts", self.field, kind, self.value, self.take, known)
        return [row.at(AREA) for row in found]

    @property
    def ticked(self) -> dict[str, bool]:
        return {row.label: row.is_on for row in self.rows if isinstance(row, Switch)}


def test_one_name_is_chosen_among_those_of_its_table() -> None:
    menu = Menu("post", "a")
    (row,) = menu.rows
    assert isinstance(row, Choice)
    assert list(row.names) == ["a", "b", "c"]
    row.pick(NEXT)
    assert menu.value == "b"


def test_a_name_that_may_be_absent_can_be_none() -> None:
    menu = Menu("hook", "c")
    menu.rows[0].pick(NEXT)
    assert menu.value is None
    assert isinstance(menu.rows[0], Choice)
    assert menu.rows[0].present == "none"


def test_a_word_is_among_the_names() -> None:
    menu = Menu("end", posts=("a", "ground", "none"))
    (row,) = menu.rows
    assert isinstance(row, Choice)
    assert list(row.names) == ["none", "ground", "a"]
    taken = []
    for _ in row.names:
        menu.rows[0].pick(NEXT)
        taken.append(menu.value)
    assert taken == ["ground", "a", None]


def test_a_list_that_is_absent_is_one_box_that_makes_it_without_a_name() -> None:
    menu = Menu("only_posts")
    assert menu.ticked == {"its posts": False}
    menu.rows[0].pick(NEXT)
    assert menu.value == ()
    assert menu.ticked == {"its posts": True, "  a": False, "  b": False, "  c": False}
    menu.rows[0].pick(NEXT)
    assert menu.value is None


def test_names_are_put_into_a_list_and_taken_out_in_the_order_of_their_table() -> None:
    menu = Menu("only_posts", ("b",))
    assert menu.ticked["  b"]
    for row in (3, 1, 2):
        menu.rows[row].pick(NEXT)
    assert menu.value == ("a", "c")
    assert menu.rows[1].help == "Take a from the list: its posts."
    assert menu.rows[2].help == "Take b into the list: its posts."


def test_the_same_name_in_two_lists_is_told_apart() -> None:
    (*_, row) = Menu("only_posts", ()).rows
    assert row.key == "its posts.  c"


def test_many_names_come_in_pages() -> None:
    posts = [f"post {number}" for number in range(2 * NAMES_A_PAGE + 1)]
    menu = Menu("only_posts", ("post 24",), posts)
    seen = []
    for title in ("1 to 12", "13 to 24", "25 to 25"):
        _, page, *boxes = menu.rows
        assert isinstance(page, Choice)
        assert (page.label, page.present) == ("posts", title)
        assert page.help == "Which of the 25 posts are shown below; 1 are in the list."
        assert len(boxes) <= NAMES_A_PAGE
        seen += [box.label.strip() for box in boxes]
        page.pick(NEXT)
    assert seen == posts
    assert menu.value == ("post 24",)
    assert menu.rows[2].label == "  post 0"


@pytest.mark.parametrize("count", [0, 1, 12, 13])
def test_a_page_that_is_no_more_there_gives_way_to_the_last(count: int) -> None:
    menu = Menu("only_posts", (), [f"post {number}" for number in range(count)])
    menu.pages["posts"] = 5
    last = [row.label for row in menu.rows][-1]
    assert last == (f"  post {count - 1}" if count else "its posts")
