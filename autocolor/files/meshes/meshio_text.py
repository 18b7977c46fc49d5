"""Texts of Abaqus, Nastran and Medit, looked over before meshio reads them.

meshio skips what it does not know: a file with placed parts or local coordinate systems would be read
wrongly. Such keywords are refused here by name. Of the rest a plain text is made: all nodes first, elements
by the name of their shape, no comments, no elements without faces. This module imports no library.
"""

from __future__ import annotations

import io
import re
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Indices
from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.files.meshes.foreign_mesh import ForeignRefusal
from autocolor.files.paths import path_within
from autocolor.files.reading import opened

INCLUDE: Final = {
    "abaqus": re.compile(r"\s*\*\s*include\s*,\s*input\s*=(.*)", re.I),
    "nastran": re.compile(r"\s*include\s+(.*)", re.I),
}

MOST_FILES: Final = 100
"""Limit: files that a text includes, and that these include; a file may include itself."""


class PlainText(NamedTuple):
    """A text that meshio reads, what was skipped, and the rows of elements in each set, if any."""

    lines: list[str]
    sentences: list[str]
    sets: dict[str, Indices] | None = None


class _Line(NamedTuple):
    place: str
    text: str


def size_of_text(kind: str) -> Callable[[Path], int]:
    """A function that gives the letters of a text of INCLUDE and of the files that it includes."""
    return lambda path: sum(len(line.text) + 1 for line in _lines(path, kind, []))


def _lines(path: Path, kind: str, files: list[Path]) -> Iterator[_Line]:
    """The lines of a text of INCLUDE, and of the files that it includes, which are added to `files`.

    Raises InputError for an included file that is not in the folder of the first file.
    """
    files.append(path)
    main = files[0]
    if len(files) > MOST_FILES:
        raise InputError(f"{main.name}: it must include at most {MOST_FILES} files, not more; join them")
    with opened(path) as (file, _), io.TextIOWrapper(file, "utf-8-sig", "replace") as lines:
        for number, line in enumerate(lines, 1):
            place = f"line {number}" if path == main else f"{path.name}, line {number}"
            if match := INCLUDE[kind].match(line):
                problems: list[str] = []
                included = path_within(problems, main.parent, match[1].strip().strip("'\""))
                if included is None:
                    raise InputError(f"{main.name}, {place}: an included file {problems[0]}")
                yield from _lines(included, kind, files)
            else:
                yield _Line(place, line.strip("\n"))


# Abaqus: blocks of a keyword with parameters, and lines of data.

GENERATING: Final = frozenset(
    ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "IMPORT", "PARAMETER", "SYMMETRIC MODEL GENERATION")
)
"""Keywords that make or move nodes and elements."""

FLAT: Final = re.compile(
    r"(?:S|STRI|DS|M3D|SFM3D|R3D|CPS|CPE|CPEG|CAX|CGAX|DC2D|DCAX|DCC2D|DCCAX|AC2D|ACAX|COH2D|COHAX)([34689])"
)
SOLID: Final = re.compile(r"(?:C3D|DC3D|DCC3D|AC3D|EC3D|EMC3D|Q3D|COH3D|SC|CSS)(\d+)")
"""Types of elements; the number is the number of nodes."""

FLATS: Final = {"3": "S3", "4": "S4", "6": "STRI65", "8": "S8R", "9": "S9R5"}
SOLIDS: Final = {"4": "C3D4", "6": "C3D6", "8": "C3D8", "10": "C3D10", "15": "C3D15", "20": "C3D20"}
"""Types that meshio knows, by the number of nodes."""

FACELESS: Final = re.compile(
    r"(?P<springs>SPRING)|(?P<masses>MASS|ROTARYI|HEATCAP)|(?P<dashpots>DASHPOT)|(?P<trusses>T[23]D\d)"
    r"|(?P<connectors>CONN[23]D|JOINTC|GAP|DCOUP)|(?P<beams>B[23]\d|PIPE\d|ELBOW\d|FRAME[23]D)"
    r"|(?P<lines>R2D2|RB[23]D2|RAX2|[MS]AX[12]|[DA]C1D)"
)


class _Block(NamedTuple):
    place: str
    keyword: str
    parameters: dict[str, str]
    rows: list[str]


def _blocks(path: Path) -> Iterator[_Block]:
    """The blocks of an Abaqus text, without comments and empty lines."""
    block, continues = _Block("", "", {}, []), False
    for place, line in _lines(path, "abaqus", []):
        text = line.strip()
        if not text or text.startswith("**"):
            continue
        if not text.startswith("*") and not continues:
            block.rows.append(text)
            continue
        words = text.split(",")
        if not continues:
            yield block
            block = _Block(place, " ".join(words.pop(0)[1:].upper().split()), {}, [])
        for word in words:
            key, _, value = word.partition("=")
            block.parameters[key.strip().upper()] = value.strip().strip('"')
        continues = text.endswith(",")
    yield block


def _in_assembly(blocks: list[_Block]) -> Iterator[_Block]:
    """The blocks of nodes, elements and sets that the assembly has. Raises ForeignRefusal.

    An assembly has one instance, which is not moved; its own nodes are points of reference. A file without
    an assembly has one part, or none.
    """
    instances = [block for block in blocks if block.keyword == "INSTANCE"]
    for place, _, _, rows in instances:
        if len(instances) > 1 or rows:
            raise ForeignRefusal(f"an assembly must be one part that is not moved, not *INSTANCE ({place})")
    parts = {block.parameters.get("PART", "").upper() for block in instances}
    scope, scopes = "", set[str]()
    for block in blocks:
        place, keyword, parameters, rows = block
        if keyword in GENERATING or (keyword == "SYSTEM" and rows):
            raise ForeignRefusal(f"nodes and elements must be written out, not made by *{keyword} ({place})")
        if keyword in ("PART", "END PART", "END INSTANCE"):
            scope = parameters.get("NAME", "").upper()
        elif keyword == "INSTANCE":
            scope = parameters.get("PART", "").upper()
        is_used = not instances or scope in parts or "INSTANCE" in parameters
        if keyword not in ("NODE", "ELEMENT", "ELSET") or not is_used:
            continue
        for key in ("INPUT", "FILE", "SYSTEM"):
            if parameters.get(key, "R").upper() != "R":
                raise ForeignRefusal(f"*{keyword} must have no {key}= ({place})")
        scopes |= {scope} if keyword == "NODE" else set()
        if len(scopes) > 1:
            raise ForeignRefusal(f"several *PART must be placed by an *INSTANCE ({place})")
        yield block


def abaqus_text(path: Path) -> PlainText:
    """The nodes and the elements with faces of an Abaqus text. Raises ForeignRefusal and InputError."""
    nodes, elements, ids = ["*NODE"], ["*COMMENT"], [np.empty(0, np.intp)]
    sets: dict[str, list[Indices]] = {}
    skipped: Counter[str] = Counter()
    for place, keyword, parameters, rows in _in_assembly(list(_blocks(path))):
        if keyword == "NODE":
            nodes += [_node(row) for row in rows]
            continue
        words = [word.strip() for word in ",".join(rows).split(",") if word.strip()]
        members = sets.setdefault(parameters.get("ELSET", ""), [])
        if keyword == "ELEMENT":
            kind = parameters.get("TYPE", "").upper()
            if faceless := FACELESS.match(kind):
                skipped[str(faceless.lastgroup)] += len(rows)
                continue
            flat, solid = FLAT.match(kind), SOLID.match(kind)
            count = flat[1] if flat else solid[1] if solid else ""
            shape = (FLATS if flat else SOLIDS).get(count)
            if shape is None:
                raise ForeignRefusal(f"element type {shown(kind)} is not known ({place})")
            if len(words) % (int(count) + 1):
                raise ForeignRefusal(f"elements of type {kind} must have {count} nodes ({place})")
            elements += [f"*ELEMENT, TYPE={shape}", *rows]
            ids.append(_numbers(words, place)[:: int(count) + 1])
            members.append(ids[-1])
        elif "INTERNAL" in parameters:
            continue
        elif "GENERATE" in parameters:
            for row in rows:
                first, last, step = [*_numbers(row.strip(",").split(","), place).tolist(), 1, 1][:3]
                members.append(np.arange(first, last + 1, max(step, 1)))
        else:
            members.append(_numbers([word for word in words if word.isdigit()], place))
            names = {name.upper(): name for name in sets}
            for word in words:
                if word.upper() in names:
                    members += list(sets[names[word.upper()]])
    sets.pop("", None)
    every = np.concatenate(ids)
    cells = {
        name: np.flatnonzero(np.isin(every, np.concatenate([ids[0], *numbers])))
        for name, numbers in sets.items()
    }
    return PlainText([*nodes, *elements], _counted(skipped), cells)


def _counted(skipped: Counter[str]) -> list[str]:
    return [f"skipped: {noun} ({count:,})" for noun, count in skipped.items()]


def _node(row: str) -> str:
    """A line of a node as meshio reads it: its number and three coordinates."""
    words = [word.strip() or "0" for word in row.upper().replace("D", "E").split(",")[:4]]
    return ",".join(words + ["0"] * (4 - len(words)))


def _numbers(words: list[str], place: str) -> Indices:
    try:
        return np.array(words, np.intp) if words else np.empty(0, np.intp)
    except (ValueError, OverflowError) as error:
        raise ForeignRefusal(f"numbers of elements and nodes must be whole ({place}: {error})") from None


# Nastran: cards of a name and fields, on one or several lines.

SHAPED: Final = re.compile(
    r"C(?:(TRIA3|TRIAR|TRIA6|TRIAX6?|TRAX3)|(QUAD[4R8]?|QUADX[48]?|SHEAR)|(TETRA)|(PYRAM?)|(PENTA)|(HEXA))"
)
SHAPES: Final = (("CTRIA3", 3), ("CQUAD4", 4), ("CTETRA", 4), ("CPYRAM", 5), ("CPENTA", 6), ("CHEXA", 8))
"""The shape that meshio knows, and the number of corners, for each group of SHAPED."""

UNKNOWN: Final = re.compile(r"C(TRI|TRA|QUAD|TET|PYR|PENT|HEX|IHEX|PLST|WEDGE|TWIST)")
WITHOUT_FACES: Final = re.compile(
    r"C(BAR|BEAM3?|ROD|ONROD|TUBE|BEND|ELAS\d|BUSH\w*|DAMP\d|MASS\d|ONM\d|GAP|VISC|FAST|WELD|SEAM)"
    r"|RBE\d|RBAR1?|RROD|PLOTEL"
)


class _Card(NamedTuple):
    place: str
    name: str
    fields: list[str]


def _cards(path: Path) -> Iterator[_Card]:
    """The cards of the bulk data of a Nastran text: free fields, or fields of 8 or 16 letters."""
    lines = [
        _Line(place, text.split("$")[0].expandtabs(8).rstrip().upper())
        for place, text in _lines(path, "nastran", [])
    ]
    begins = [row for row, line in enumerate(lines) if line.text.startswith("BEGIN")]
    card, mark, ends = _Card("", "", []), "", not begins
    for place, text in lines[begins[0] if begins else 0 :]:
        if text.startswith("ENDDATA"):
            ends = True
            break
        if not text or text.split() == ["BEGIN", "BULK"]:
            continue
        if text.startswith(("BEGIN", "=")):
            raise ForeignRefusal(f"bulk data must be one list of whole cards, not {shown(text)} ({place})")
        name = text.split(",")[0] if "," in text else text[:8]
        count = 4 if "*" in name else 8
        if "," in text:
            fields = text.split(",")[1:]
        else:
            fields = [text[at : at + 64 // count] for at in range(8, 72, 64 // count)] + [text[72:80]]
        fields = [*(field.strip() for field in fields), *[""] * 9]
        name = name.strip()
        if name and name[0] not in "+*":
            yield card
            card = _Card(place, name.strip("* "), fields[:count])
        elif name.strip("+* ") != mark and name.strip("+* ") and mark:
            raise ForeignRefusal(f"a line that continues a card must follow it ({place})")
        else:
            card.fields.extend(fields[:count])
        mark = fields[count].strip("+* ")
    if not ends:
        raise ForeignRefusal("bulk data must end with ENDDATA; the file is cut short")
    yield card


def nastran_text(path: Path) -> PlainText:
    """The nodes and the elements with faces of a Nastran text. Raises ForeignRefusal."""
    nodes: list[str] = []
    elements: list[str] = []
    systems: dict[str, str] = {}
    placed: list[tuple[str, str, str]] = []
    skipped: Counter[str] = Counter()
    default = ""
    for place, name, fields in _cards(path):
        if name == "GRID":
            coordinates = [field.replace("D", "E") or "0." for field in [*fields, ""][2:5]]
            nodes.append(",".join(["GRID", fields[0], "", *coordinates]))
            placed.append((fields[1], fields[0], place))
        elif name == "GRDSET":
            default = fields[1]
        elif name.startswith("CORD"):
            systems[fields[0]] = name
        elif shaped := SHAPED.fullmatch(name):
            shape, count = SHAPES[(shaped.lastindex or 1) - 1]
            # The nodes of CTRIAX6 go around the triangle, corners and middles of sides in turns.
            corners = fields[2:7:2] if name == "CTRIAX6" else fields[2 : 2 + count]
            if len(corners) < count or not all(corner.isdigit() for corner in corners):
                raise ForeignRefusal(f"{name} {fields[0]} must have {count} corners ({place})")
            elements.append(",".join([shape, fields[0], fields[1] or fields[0], *corners[:6]]))
            if count > 6:
                elements.append(",".join(["+", *corners[6:]]))
        elif UNKNOWN.match(name):
            raise ForeignRefusal(f"element type {shown(name)} is not known ({place})")
        elif WITHOUT_FACES.fullmatch(name):
            skipped[name] += 1
    for system, node, place in placed:
        system = system or default or "0"
        if system != "0":
            kind = f"{systems.get(system, 'a coordinate system')} {system}"
            raise ForeignRefusal(
                f"node {node} must be in the basic coordinate system, not in {kind} ({place})"
            )
    return PlainText(["BEGIN BULK", *nodes, *elements, "ENDDATA"], _counted(skipped))


# Medit: keywords, each with numbers.

MEDIT: Final = re.compile(r"(?<!\S)([A-Za-z]\w*)((?:\s+[-+.\d]\S*)*)")
CELLS: Final = re.compile("Edges|Triangles|Quadrilaterals|Tetrahedra|Prisms|Pyramids|Hexah?edra")


def medit_text(path: Path) -> str:
    """The nodes and cells of a Medit text, each keyword and count on its line. Raises ForeignRefusal."""
    text = re.sub("#.*", "", path.read_text(encoding="latin-1"))
    sections = []
    for keyword, numbers in MEDIT.findall(text):
        if keyword == "MeshVersionFormatted":
            # Later versions differ in binary files only.
            sections.append(f"{keyword} 2")
        elif keyword == "Dimension":
            sections.append(f"{keyword} {numbers.strip()}")
        elif keyword == "Vertices" or CELLS.fullmatch(keyword):
            sections += [keyword, *numbers.split(None, 1)]
        elif CELLS.match(keyword):
            raise ForeignRefusal(f"cells must be of the first order, not {keyword}")
    return "\n".join([*sections, "End", ""])
