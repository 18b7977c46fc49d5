"""Examples and keywords on the pages of public names, by an extension of griffe for `mkdocs.yml`.

To the docstring of each public name it adds the name's first example in docs/api.md.

Griffe reads sources without running them, and knows no decorator but `dataclass`. For a class that
`table_row` decorates, this adds the signature, and to the docstring a table of the keywords with their help.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from typing import Any

import griffe

from autocolor.scene.columns import MISSING, Row, fields_of
from docs.generate.site import EXAMPLES, value_of


def table(cls: type[Row]) -> Iterator[str]:
    """The lines of a table in Markdown: each keyword of a row class with its help and its unit."""
    yield "| keyword | what it is |"
    yield "|---|---|"
    for name, column in fields_of(cls).items():
        yield f"| `{name}` | {column.help}{f' In {column.unit}.' if column.unit else ''} |"


class Keywords(griffe.Extension):  # type: ignore[misc]
    """Adds the signature and the keywords of each row class, and the examples of public names."""

    def __init__(self) -> None:
        self._examples = {
            f"{getattr(value_of(name), '__module__', 'ramtek_emu')}.{name.split('.')[1]}": example
            for name, example in EXAMPLES.items()
        }

    def on_object(self, *, obj: Any, **_: Any) -> None:
        """Change an object that griffe has loaded."""
        if obj.is_class and any(str(decorator.value) == "table_row" for decorator in obj.decorators):
            add_keywords(obj)
        if example := self._examples.get(obj.path):
            text = f"{obj.docstring.value}\n\n" if obj.docstring else ""
            obj.docstring = griffe.Docstring(f"{text}Example:\n\n```python\n{example}```", parent=obj)


def add_keywords(cls: Any) -> None:
    """Add the signature and the keywords of a row class to the class as griffe has loaded it."""
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
