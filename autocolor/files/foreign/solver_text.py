"""The nodes and elements of the texts of Abaqus and Nastran.

meshio skips in silence what it does not know of these formats, such as placed parts and coordinate systems;
here they are refused by name. This module imports no library.
"""

from __future__ import annotations

import io
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.files.foreign.cells import CORNERS
from autocolor.files.foreign.mesh import ForeignRefusal
from autocolor.files.paths import path_within
from autocolor.files.reading import opened

Record = tuple[str, str, str, list[str]]
"""A node or an element of a text: its place, kind, name and words.

A "node" has its number and coordinates as words. An element has its shape as its kind, the name of its part,
and the numbers of its nodes, corners first; without faces, it is "skipped", and its name is its type.
"""

Elements = tuple[str, Indices, list[str]]
"""Elements of one shape: the shape, the rows of their nodes, (elements, nodes), and the part of each."""


def assembled(records: Iterable[Record], skipped: Counter[str]) -> tuple[Floats, Iterable[Elements]]:
    """The nodes, (nodes, 3), and the elements of a text; those without faces are counted in `skipped`.

    Raises ForeignRefusal.
    """
    nodes, parts = dict[int, list[float]](), defaultdict[tuple[str, int], list[str]](list)
    elements = defaultdict[tuple[str, int], list[list[int]]](list)
    for place, kind, name, words in records:
        try:
            if kind == "skipped":
                skipped[f"elements of type {name}"] += 1
            elif kind == "node":
                nodes[int(words[0])] = [_number(word) for word in [*words[1:], "", "", ""][:3]]
            else:
                elements[kind, len(words)].append([int(word) for word in words])
                parts[kind, len(words)].append(name)
        except ValueError as error:
            raise ForeignRefusal(f"nodes and elements must be given by numbers ({place}: {error})") from None
    row_of = {number: row for row, number in enumerate(nodes)}
    try:
        blocks = [
            (key[0], np.array([[row_of[node] for node in each] for each in numbers]), parts[key])
            for key, numbers in elements.items()
        ]
    except KeyError as error:
        raise ForeignRefusal(f"elements must have nodes of the file, and there is no node {error}") from None
    return np.array([*nodes.values()]).reshape(-1, 3), blocks


def _number(word: str) -> float:
    """A real number, whose exponent may be written as in FORTRAN: 1.5D3 or 1.5-3. Raises ValueError."""
    try:
        return float(word or 0)
    except ValueError:
        return float(re.sub(r"(?<=[\d.])(?=[-+])|D", "E", word.upper()))


INCLUDE: Final = re.compile(r"\s*(?:\*\s*include\s*,\s*input\s*=|include\s)(.*)", re.I)


def size_of_text(path: Path) -> int:
    """The letters of a text and of the files that it includes. Raises InputError."""
    return sum(len(line) + 1 for _, line in _lines(path, []))


def _lines(path: Path, files: list[Path]) -> Iterator[tuple[str, str]]:
    """The places and lines of a text, and of the files that it includes, added to `files`.

    Raises InputError for an included file that is not in the folder of the first file.
    """
    files.append(path)
    main = files[0]
    if len(files) > 100:
        # A file may include itself.
        raise InputError(f"{main.name}: it must include at most 100 files, not more; join them")
    with opened(path) as (file, _), io.TextIOWrapper(file, "utf-8-sig", "replace") as lines:
        for number, line in enumerate(lines, 1):
            place, problems = f"line {number}" if path == main else f"{path.name}, line {number}", list[str]()
            if match := INCLUDE.match(line):
                included = path_within(problems, main.parent, match[1].strip().strip("'\""))
                if included is None:
                    raise InputError(f"{main.name}, {place}: an included file {problems[0]}")
                yield from _lines(included, files)
            else:
                yield place, line.strip("\n")


GENERATING: Final = re.compile(
    r"\*(?:NGEN|NFILL|NCOPY|NMAP|ELGEN|ELCOPY|IMPORT|PARAMETER|SYMMETRIC MODEL GENERATION)(?:,|$)"
    r"|\*(?:NODE|ELEMENT),.*\b(?:INPUT|SYSTEM) *="
)
"""Keywords that make or move nodes and elements."""

TYPE: Final = re.compile(
    r"(?P<skipped>SPRING|MASS|ROTARYI|HEATCAP|DASHPOT|T[23]D|CONN[23]D|JOINTC|GAP|DCOUP|B[23]|PIPE|ELBOW"
    r"|FRAME[23]D|R2D2|RB[23]D2|RAX2|[MS]AX[12]|[DA]C1D)"
    r"|(?:S|STRI|DS|M3D|SFM3D|R3D|CPS|CPEG?|CG?AX|D?C?C2D|DC?CAX|AC2D|ACAX|COH2D|COHAX)"
    r"(?:(?P<triangle>[36])|(?P<quad>[489]))"
    r"|(?:C3D|DC3D|DCC3D|AC3D|EC3D|EMC3D|Q3D|COH3D|SC|CSS)"
    r"(?:(?P<tetra>4|10)|(?P<pyramid>5|13)|(?P<wedge>6|15)|(?P<hexahedron>8|20|27))(?!\d)"
)
"""Types of elements by shape; the number of nodes is matched."""


def _keywords(path: Path) -> Iterator[tuple[str, list[str], list[list[str]]]]:
    """The place, words and rows of each keyword, without comments and empty lines."""
    place, keyword, rows = "", [""], list[list[str]]()
    for here, line in _lines(path, []):
        words = [word.strip() for word in line.split(",")]
        if not line.strip() or line.lstrip().startswith("**"):
            continue
        if keyword[1:] and not keyword[-1] and not rows:
            # The line before ended with a comma.
            keyword[-1:] = words
        elif words[0].startswith("*"):
            yield place, keyword, rows
            place, keyword, rows = here, words, []
        else:
            rows.append(words)
    yield place, keyword, rows


def abaqus(path: Path) -> Iterator[Record]:
    """The nodes and elements of an Abaqus text; each ELSET of *ELEMENT is a part.

    The text must have a single part, which its *INSTANCE, if there is one, must not move. The nodes of the
    assembly itself are points of reference. Raises ForeignRefusal and InputError.
    """
    counts, in_assembly = Counter[str](), False
    for place, words, rows in _keywords(path):
        name, pairs = " ".join(words[0][1:].upper().split()), [word.partition("=") for word in words[1:]]
        parameters = {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
        text = ", ".join([f"*{name}", *words[1:]]).upper()
        if GENERATING.match(text) or (name == "SYSTEM" and rows):
            raise ForeignRefusal(
                f"nodes and elements must be written out, not made by {shown(text)} ({place})"
            )
        counts[name] += 1
        if name in ("PART", "INSTANCE") and (rows or counts[name] > 1):
            raise ForeignRefusal(f"there must be one part, which no *INSTANCE moves, not *{name} ({place})")
        if name in ("ASSEMBLY", "INSTANCE", "END INSTANCE"):
            in_assembly = name != "INSTANCE"
        elif name == "NODE" and not in_assembly:
            yield from ((place, "node", "", row) for row in rows)
        elif name == "ELEMENT":
            type_, words = parameters.get("TYPE", "").upper(), list[str]()
            match = TYPE.match(type_)
            shape = (match and match.lastgroup) or ""
            if match is None or (in_assembly and shape != "skipped"):
                raise ForeignRefusal(
                    f"elements must be in a part and of a known type, not as {shown(type_)} ({place})"
                )
            for row in rows:
                words += filter(None, row)
                if shape == "skipped" or len(words) == int(match[shape]) + 1:
                    yield (
                        place,
                        shape,
                        type_ if shape == "skipped" else parameters.get("ELSET", ""),
                        words[1:],
                    )
                    words = []
            if words:
                raise ForeignRefusal(f"elements of type {type_} must have {match[shape]} nodes ({place})")


CARD: Final = re.compile(
    r"C(?:(?P<triangle>TRI(?:A3|AR|A6|AX)|TRAX3)|(?P<quad>QUAD[4R8]?|QUADX[48]?|SHEAR)|(?P<tetra>TETRA)"
    r"|(?P<pyramid>PYRAM?)|(?P<wedge>PENTA)|(?P<hexahedron>HEXA))"
    r"|(?P<skipped>C(?:BAR|BEAM3?|ROD|ONROD|TUBE|BEND|ELAS\d|BUSH\w*|DAMP\d|MASS\d|ONM\d|GAP|VISC|FAST|WELD"
    r"|SEAM)|RBE\d|RBAR1?|RROD|PLOTEL)"
    r"|(?P<unknown>C(?:TRI|TRA|QUAD|TET|PYR|PEN|HEX|IHEX|IF|PLST|WEDGE|TWIST|RAC|CONE|DUM|HAC|AABSF|HBDY)\w*)"
)
"""The names of elements by shape."""


def _cards(path: Path) -> Iterator[tuple[str, str, list[str]]]:
    """The place, name and fields of each card of a text: fields are free, or of 8 or 16 letters."""
    place, name, fields, mark, is_open = "", "", list[str](), "", False
    for here, line in _lines(path, []):
        text = line.split("$")[0].expandtabs(8).rstrip().upper()
        if text.startswith("ENDDATA"):
            is_open = False
            break
        if text.split() == ["BEGIN", "BULK"]:
            is_open = True
        elif text.startswith(("BEGIN", "=")):
            raise ForeignRefusal(f"bulk data must be one list of whole cards, not {shown(text)} ({here})")
        elif text:
            start = text.split(",")[0] if "," in text else text[:8]
            count = 4 if "*" in start else 8
            words = text.split(",")[1:] if "," in text else re.findall(f".{{1,{64 // count}}}", text[8:])
            words = [word.strip() for word in [*words, *[""] * 9]]
            start = start.strip()
            if start and start[0] not in "+*":
                yield place, name, fields
                place, name, fields = here, start.strip("* "), []
            elif start.strip("+* ") and mark and start.strip("+* ") != mark:
                raise ForeignRefusal(f"a line that continues a card must follow it ({here})")
            fields += words[:count]
            mark = words[count].strip("+* ")
    if is_open:
        raise ForeignRefusal("bulk data must end with ENDDATA; the file is cut short")
    yield place, name, fields


def nastran(path: Path) -> Iterator[Record]:
    """The nodes and elements of a Nastran text; the elements of each property are a part.

    Raises ForeignRefusal and InputError.
    """
    for place, name, fields in _cards(path):
        match = CARD.fullmatch(name)
        kind = match and match.lastgroup
        if name in ("GRID", "GRDSET") and fields[1].strip("0"):
            system = f"the coordinate system {fields[1]}"
            raise ForeignRefusal(f"{name} {fields[0]} must be in the basic system, not in {system} ({place})")
        if kind == "unknown":
            raise ForeignRefusal(f"element type {shown(name)} is not known ({place})")
        if name == "GRID":
            yield place, "node", "", [fields[0], *fields[2:5]]
        elif kind:
            part = name if kind == "skipped" else f"part {fields[1] or fields[0]}"
            yield place, kind, part, [*fields[2:], *[""] * 8][: CORNERS.get(kind, 0)]
