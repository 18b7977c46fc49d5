"""What a statement may do to a store: read and compute, and change rows where that is asked for."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from typing import Final

FUNCTIONS: Final = frozenset(
    (
        "abs", "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "avg", "cast", "ceil", "ceiling",
        "changes", "char", "coalesce", "concat", "concat_ws", "cos", "cosh", "count", "cume_dist",
        "current_date", "current_time", "current_timestamp", "date", "datetime", "degrees", "dense_rank",
        "exp", "first_value", "floor", "format", "glob", "group_concat", "hex", "ieee754", "ifnull", "iif",
        "instr", "json", "json_array", "json_array_length", "json_each", "json_extract", "json_group_array",
        "json_group_object", "json_object", "json_quote", "json_remove", "json_replace", "json_set",
        "json_tree", "json_type", "json_valid", "julianday", "lag", "last_insert_rowid", "last_value",
        "lead", "length", "like", "likelihood", "likely", "ln", "log", "log10", "log2", "lower", "ltrim",
        "max", "min", "mod", "nth_value", "ntile", "nullif", "percent_rank", "pi", "pow", "power", "printf",
        "quote", "radians", "random", "rank", "replace", "round", "row_number", "rtrim", "sign", "sin",
        "sinh", "sqlite_version", "sqrt", "strftime", "string_agg", "substr", "substring", "sum", "tan",
        "tanh", "time", "timediff", "total", "total_changes", "trim", "trunc", "typeof", "unicode", "unistr",
        "unixepoch", "unlikely", "upper", "->", "->>",
    )
)  # fmt: skip
"""The functions that statements may call: those that compute with their arguments and nothing else."""

READING_PRAGMAS: Final = frozenset(
    (
        "application_id", "data_version", "foreign_key_check", "foreign_key_list", "index_info", "index_list",
        "integrity_check", "page_count", "page_size", "quick_check", "schema_version", "table_info",
        "table_list", "table_xinfo", "user_version",
    )
)  # fmt: skip
"""The pragmas that only tell something; as most take an argument, it must not be a new value."""

SETTABLE: Final = ("application_id", "schema_version", "user_version")

RESTORES: Final = (
    sqlite3.SQLITE_CREATE_TRIGGER,
    sqlite3.SQLITE_CREATE_INDEX,
    sqlite3.SQLITE_REINDEX,
    sqlite3.SQLITE_SELECT,
    sqlite3.SQLITE_READ,
)
"""What it takes to make a trigger or an index again, but for its row in the table of all tables."""

MASTER: Final = "sqlite_master"

READS: Final = (
    sqlite3.SQLITE_SELECT,
    sqlite3.SQLITE_READ,
    sqlite3.SQLITE_RECURSIVE,
    sqlite3.SQLITE_TRANSACTION,
    sqlite3.SQLITE_SAVEPOINT,
)
CHANGES: Final = (sqlite3.SQLITE_INSERT, sqlite3.SQLITE_UPDATE, sqlite3.SQLITE_DELETE)

Authorizer = Callable[[int, str | None, str | None, str | None, str | None], int]


def authorizer(may_change: bool) -> Authorizer:
    """What a statement may do: read, call FUNCTIONS, and, if it `may_change`, change rows of tables."""

    def allowed(
        action: int, first: str | None, second: str | None, database: str | None, inner: str | None
    ) -> int:
        if action == sqlite3.SQLITE_FUNCTION:
            is_allowed = (second or "").lower() in FUNCTIONS
        elif action == sqlite3.SQLITE_PRAGMA:
            name = (first or "").lower()
            is_allowed = name in READING_PRAGMAS and not (second is not None and name in SETTABLE)
        elif action in CHANGES:
            is_allowed = may_change and not (first or "").lower().startswith("sqlite_")
        else:
            is_allowed = action in READS
        return sqlite3.SQLITE_OK if is_allowed else sqlite3.SQLITE_DENY

    return allowed


def restoring(
    action: int, first: str | None, second: str | None, database: str | None, inner: str | None
) -> int:
    """What the text may do that a file keeps of a trigger or an index: make that, and nothing else."""
    if action == sqlite3.SQLITE_FUNCTION:
        is_allowed = (second or "").lower() in FUNCTIONS
    else:
        is_allowed = action in RESTORES or (action in CHANGES[:2] and first == MASTER)
    return sqlite3.SQLITE_OK if is_allowed else sqlite3.SQLITE_DENY
