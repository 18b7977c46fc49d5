"""Completion in bash, which takes a word apart at each "=": `ambient=0.2` comes as three words.

Click takes them for three arguments, so that nothing would be completed after `--set KEY=`. Here they are put
together again, and candidates are told without what stands before the last "=", since bash keeps that.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from typing import Any, ClassVar, Final

from click.shell_completion import BashComplete, CompletionItem, split_arg_string

SCRIPT: Final = """\
%(complete_func)s() {
    local kind value
    COMPREPLY=()
    while IFS=, read -r kind value; do
        case $kind in
            dir) compopt -o dirnames ;;
            file) compopt -o default ;;
            plain) COMPREPLY+=("$value") ;;
        esac
    done < <(
        IFS=$'\\n'
        env COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD %(complete_var)s=bash_complete "$1"
    )
    if [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *[=./] ]]; then
        compopt -o nospace
    fi
}

complete -o nosort -F %(complete_func)s %(prog_name)s
"""
"""What bash runs: a candidate that goes on after "=", "." or "/" gets no space."""


class WholeWords(BashComplete):
    """The completion of click for bash, with words as they are typed."""

    source_template: ClassVar[str] = SCRIPT
    _kept: str = ""
    """The start of all candidates that bash keeps."""

    def get_completion_args(self) -> tuple[list[str], str]:
        """The whole words before the cursor, and the incomplete one there."""
        count = int(os.environ["COMP_CWORD"]) + 1
        # An empty word at the cursor is not among them.
        words = split_arg_string(os.environ["COMP_WORDS"])[:count]
        typed = joined(words)
        incomplete = typed.pop() if len(words) == count else ""
        self._kept = "" if words[-1:] == [incomplete] else kept(incomplete)
        return typed[1:], incomplete

    def format_completion(self, item: CompletionItem[Any]) -> str:
        """A candidate for the script, in quotes that bash takes off again."""
        value = str(item.value)
        if item.type == "plain":
            value = re.sub(r"([^\w@%+=:,./-])", r"\\\1", value.removeprefix(self._kept))
        return f"{item.type},{value}"


def joined(words: Sequence[str]) -> list[str]:
    """Words with those that bash took apart put together.

    >>> joined(["render", "--set", "ambient", "=", "0.2", "-o", "x.png"])
    ['render', '--set', 'ambient=0.2', '-o', 'x.png']
    """
    found: list[str] = []
    follows = False
    for word in words:
        is_sign = bool(word) and not word.strip("=")
        if found and (is_sign or follows):
            found[-1] += word
        else:
            found.append(word)
        follows = is_sign
    return found


def kept(word: str) -> str:
    """The part of an incomplete word that bash keeps and that candidates have, too: an option is not.

    >>> kept("scaling=ob"), kept("--set=scaling=ob"), kept("--set=sc")
    ('scaling=', 'scaling=', '')
    """
    value = word.partition("=")[2] if word.startswith("-") else word
    return value[: value.rfind("=") + 1]
