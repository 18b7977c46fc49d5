"""The keywords of row classes on the page of the Python API, by an extension of griffe for `mkdocs.yml`.

Griffe reads sources without running them, and knows no decorator but `dataclass`. For a class that
`table_row` decorates, this adds the signature, and to the docstring a table of the keywords with their help.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from typing import Any

import griffe

from autocolor.scene.columns import MISSING, Row, fields_of


def table(cls: type[Row]) -> Iterator[str]:
    """The lines of a table in Markdown: each keyword of a row class with its help and its unit."""
    yield "| keyword | what it is |"
    yield "|---|---|"
    for name, column in fields_of(cls).items():
        yield f"| `{name}` | {column.help}{f' In {column.unit}.' if column.unit else ''} |"


class Keywords(griffe.Extension):  # type: ignore[misc]
    """Adds the signature and the keywords of each row class."""

    def on_class(self, *, cls: Any, **_: Any) -> None:
        """Change a class that griffe has loaded, if `table_row` decorates it."""
        if not any(str(decorator.value) == "table_row" for decorator in cls.decorators):
            return
        row_class = pkgutil.resolve_name(f"{cls.module.path}:{cls.name}")
        cls.docstring.value += "\n\n" + "\n".join(table(row_class))
        if "__init__" in cls.members:
            return
        types = {
            name: hint
            for base in row_class.__mro__[::-1]
            for name, hint in vars(base).get("__annotations__", {}).items()
        }
        kind = griffe.ParameterKind.positional_or_keyword
        parameters = [griffe.Parameter("self", kind=kind)]
        for name, column in fields_of(row_class).items():
            default = None if column.default is MISSING else repr(column.default)
            parameters.append(griffe.Parameter(name, annotation=types[name], kind=kind, default=default))
        cls.set_member("__init__", griffe.Function("__init__", parameters=griffe.Parameters(*parameters)))
