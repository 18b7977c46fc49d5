"""The lines of a journal as Python statements: calls of names with plain values, which are never run."""

from __future__ import annotations

import ast
import warnings
from typing import Any, Final, NamedTuple, NoReturn

from autocolor.checks import shown
from autocolor.errors import InputError, UsageError

LONGEST_LINE: Final = 1 << 20
"""Assumed: characters; a step that changes some thousand rows."""


class Called(NamedTuple):
    """A call in a line: what is called, its arguments, those with a keyword apart."""

    name: str
    arguments: list[ast.expr]
    keywords: dict[str, ast.expr]


def value_of(line: str, name: str) -> ast.expr:
    """The value that a line assigns to a name."""
    statement = _statement(line)
    if not isinstance(statement, ast.Assign) or [ast.unparse(each) for each in statement.targets] != [name]:
        refuse(line)
    return statement.value


def expression_of(line: str) -> ast.expr:
    """The expression that a line is."""
    statement = _statement(line)
    if not isinstance(statement, ast.Expr):
        refuse(line)
    return statement.value


def _statement(line: str) -> ast.stmt:
    """The one statement of a line."""
    if len(line) > LONGEST_LINE:
        raise InputError(f"it must be at most {LONGEST_LINE:,} characters, not {len(line):,}; remove it")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            (statement,) = ast.parse(line).body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        refuse(line)
    return statement


def called(node: ast.expr, line: str) -> Called:
    """The call that an expression is, of a name with dots, without * and **."""
    if not isinstance(node, ast.Call) or any(keyword.arg is None for keyword in node.keywords):
        refuse(line)
    if any(isinstance(argument, ast.Starred) for argument in node.args):
        refuse(line)
    keywords = {str(keyword.arg): keyword.value for keyword in node.keywords}
    return Called(dotted(node.func, line), node.args, keywords)


def dotted(node: ast.expr, line: str) -> str:
    """The name with dots that an expression is."""
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    if not isinstance(node, ast.Name):
        refuse(line)
    return ".".join([node.id, *reversed(parts)])


def plain_value(node: ast.expr, line: str) -> Any:
    """The plain value of an argument."""
    try:
        return ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError, RecursionError, MemoryError):
        refuse(line)


def refuse(line: str) -> NoReturn:
    """Raise UsageError: a line is nothing that a journal has."""
    raise UsageError(
        f"it must be a call that autocolor writes, with plain values, not {shown(line)}; remove it"
    )
