"""A row with a rule between its columns, and what messages it gives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import pytest

from autocolor.scene.columns import Column, Problem, Row, RowError, Tier
from autocolor.scene.kinds import Number, Text


@dataclass(frozen=True)
class Span(Row):
    """A row with a rule between its columns, and alternatives."""

    noun: ClassVar[str] = "span"
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (("end",), ("length",))

    name: Annotated[str, Column(Text(), Tier.NOTHING, "What it is called.")]
    begin: Annotated[float, Column(Number(), Tier.LIGHT, "Where it begins.")] = 0.0
    end: Annotated[float | None, Column(Number(), Tier.LIGHT, "Where it ends.")] = None
    length: Annotated[float | None, Column(Number(at_least=0), Tier.MIX, "How long it is.")] = None

    def rules(self) -> Iterator[Problem]:
        if self.end is not None and self.length is not None:
            yield Problem((), "it must have an end or a length, not both")
        if self.end is not None and self.begin > self.end:
            yield Problem(("begin",), f"must not be above the end, not {self.begin:g}")


def sentences(make: Any) -> tuple[str, ...]:
    with pytest.raises(RowError) as caught:
        make()
    return caught.value.problems
