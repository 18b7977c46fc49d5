from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.meshes.obj.statements import SKIPPED, UNUSED, Statements


def read(text: str | bytes) -> tuple[Statements, list[int]]:
    """What the statements of a file leave behind, and the part number of each `f` in it."""
    statements = Statements("car")
    part_numbers = []
    for line in (text if isinstance(text, bytes) else text.encode()).split(b"\n"):
        if not statements.read(line):
            part_numbers.append(statements.part_number)
    return statements, part_numbers


def names_of(text: str | bytes) -> tuple[str, ...]:
    return tuple(part.name for part in read(text)[0].parts())


@pytest.mark.parametrize(
    ("statements", "names"),
    [
        ("{f}", ("car",)),
        ("g hood\n{f}g roof\n{f}g hood\n{f}", ("hood", "roof")),
        ("o body\n{f}g roof\n{f}", ("body", "roof")),
        ("g hood left\n{f}", ("hood",)),
        ("o my car\n{f}", ("my car",)),
        ("usemtl red\n{f}usemtl blue paint\n{f}", ("red", "blue paint")),
        ("g hood\nusemtl red\n{f}usemtl blue\n{f}", ("hood", "hood blue")),
        ("g hood\n{f}usemtl red\n{f}g roof\n{f}g hood\n{f}", ("hood", "hood red", "roof")),
        ("usemtl red\n{f}g hood\n{f}g\n{f}usemtl\n{f}", ("red", "hood", "car")),
        ("g empty\ng hood\n{f}", ("hood",)),
        ("g\n{f}", ("car",)),
        ("g h\u00e4ube\n{f}", ("h\u00e4ube",)),
    ],
)
def test_groups_objects_and_materials_name_the_parts(statements: str, names: tuple[str, ...]) -> None:
    assert names_of(statements.format(f="f 1 2 3 4\n")) == names


def test_names_that_are_not_utf_8_are_latin_1_and_can_be_shown() -> None:
    assert names_of(b"g h\xe4ube\nf 1 2 3\ng \x1b[31m\nf 1 2 3\n") == ("h\u00e4ube", "?[31m")


def test_points_lines_and_unknown_statements_are_skipped_and_counted() -> None:
    statements, _ = read("p 1\nl 1 2\nl 2 3\nwhat 3\nelse 4\ncurv 1 2\nf 1 2 3 4\n")
    assert statements.sentences == (
        "skipped points: 1",
        "skipped lines: 2",
        "skipped unknown statements (the first is 'what'): 2",
        "skipped statements of curves and curved surfaces: 1",
    )


def test_a_file_of_rubbish_is_one_short_sentence() -> None:
    statements, part_numbers = read("".join(f"rubbish{line}{'x' * 1000} 1\n" for line in range(1000)))
    (sentence,) = statements.sentences
    assert sentence.startswith("skipped unknown statements (the first is 'rubbish0xxx")
    assert sentence.endswith("...): 1,000")
    assert len(sentence) < 120
    assert part_numbers == []


def test_a_part_that_is_named_again_keeps_its_number() -> None:
    _, part_numbers = read("f\ng a\nf\ng b\nf\nf\ng a\nf\ng\nf\n")
    assert part_numbers == [0, 1, 2, 2, 1, 0]


def test_a_name_without_polygons_has_no_number() -> None:
    assert names_of("g a\ng b\nf 1\ng c\n") == ("b",)


@pytest.mark.parametrize("keyword", ["g", "o", "usemtl"])
def test_an_endless_name_is_cut(keyword: str) -> None:
    assert names_of(f"{keyword} {'x' * 100_000}\nf\n") == ("x" * 200,)


@pytest.mark.parametrize("line", [b"", b"   ", b"# g a", b"#", *(word + b" 1 2" for word in sorted(UNUSED))])
def test_comments_and_unused_statements_leave_nothing_behind(line: bytes) -> None:
    statements = Statements("car")
    assert statements.read(line)
    assert statements.part_number == 0
    assert statements.parts() == (("car", None),)
    assert statements.sentences == ()


@pytest.mark.parametrize("line", [b"v 1 2 3", b"f 1 2 3", b" v", b"\tf"])
def test_nodes_and_polygons_are_left_to_the_reader(line: bytes) -> None:
    assert not Statements("car").read(line)


statements_lines = st.sampled_from(
    [
        b"g",
        b"g a b",
        b"o c d",
        b"o",
        b"usemtl e",
        b"usemtl",
        b"mtllib h",
        b"p 1",
        b"l 1",
        b"odd",
        b"v 1",
        b"f 1",
        b"s off",
    ]
)


@given(
    st.lists(statements_lines | st.binary(max_size=12).filter(lambda line: b"\n" not in line), max_size=30)
)
def test_every_line_is_one_of_four_things(lines: list[bytes]) -> None:
    statements = Statements("car")
    left = sum(not statements.read(line) for line in lines)
    keywords = [words[0] for line in lines if (words := line.split()) and not words[0].startswith(b"#")]
    names = {b"g", b"o", b"usemtl", b"mtllib"}
    assert left == sum(keyword in (b"v", b"f") for keyword in keywords)
    skipped = [word for word in keywords if word not in {b"v", b"f", *names, *UNUSED}]
    assert sum(statements.skipped.values()) == len(skipped)
    known = {SKIPPED[word] for word in skipped if word in SKIPPED}
    assert len(statements.sentences) == len(known) + any(word not in SKIPPED for word in skipped)
    assert all(sentence.isprintable() for sentence in statements.sentences)


def test_a_group_of_several_materials_is_a_part_for_each_of_them() -> None:
    statements, part_numbers = read(
        "usemtl red\ng hood\nf\nusemtl chrome\nf\ng door\nf\nusemtl red\nf\ng hood\nf\nusemtl\nf\n"
    )
    assert part_numbers == [0, 1, 2, 3, 0, 4]
    assert statements.parts() == (
        ("hood", "red"),
        ("hood chrome", "chrome"),
        ("door", "chrome"),
        ("door red", "red"),
        ("hood 2", None),
    )


def test_a_name_that_was_added_gives_way_to_those_that_stand_in_the_file() -> None:
    assert names_of("g hood\nusemtl red\nf\nusemtl chrome\nf\ng hood chrome\no hood chrome\nf\n") == (
        "hood",
        "hood chrome 2",
        "hood chrome",
    )


def test_the_libraries_are_the_arguments_of_their_statements_in_order() -> None:
    statements, _ = read("mtllib car.mtl\nmtllib\n mtllib  my car.mtl more.mtl \nmtllib car.mtl\n")
    assert [library.strip() for library in statements.libraries] == [
        b"car.mtl",
        b"my car.mtl more.mtl",
        b"car.mtl",
    ]


SOME_NAMES = ["a", "b", "a b", "a b 2", "a 2", "car", "car 2", ""]


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["g", "o", "usemtl"]),
            st.sampled_from(SOME_NAMES) | st.text("ab 2", max_size=4),
            st.booleans(),
        ),
        max_size=20,
    )
)
def test_the_names_of_parts_always_differ_and_each_part_has_one_material(
    statements: list[tuple[str, str, bool]],
) -> None:
    text = "".join(f"{keyword} {name}\n" + "f\n" * is_used for keyword, name, is_used in statements)
    left, part_numbers = read(text)
    parts = left.parts()
    assert len({part.name for part in parts}) == len(parts) == len({*part_numbers})
    assert all(part.name for part in parts)
    # The slow twin: the group and the material at each polygon.
    group: str | None = None
    material: str | None = None
    expected = []
    for keyword, name, is_used in statements:
        words = name.split()
        if keyword == "usemtl":
            material = name.strip() or None
        elif keyword == "g":
            group = words[0] if words else None
        else:
            group = name.strip() or None
        expected += [(group, material)] * is_used
    by_pair = dict(zip(expected, part_numbers, strict=True))
    assert [by_pair[pair] for pair in expected] == part_numbers
    assert len(by_pair) == len(parts)
    for (group, material), number in by_pair.items():
        assert parts[number].material == material
        assert parts[number].name.startswith(group or material or "car")
