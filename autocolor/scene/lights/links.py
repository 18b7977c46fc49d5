"""The links of a light: which surfaces and parts it shines on.

Departs: the paper's lights shine on everything. A point is lit if its surface is one that the light shines
on, and its part is, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar, Unpack

from autocolor.scene.changes import LinksChanges
from autocolor.scene.columns.column import Column, Row, Tier
from autocolor.scene.columns.problems import Problem
from autocolor.scene.columns.reference_kinds import References
from autocolor.scene.columns.rows import changed

Names = tuple[str, ...]


@dataclass(frozen=True, repr=False)
class Links(Row):
    """The names of surfaces and of parts; None where all are meant."""

    noun: ClassVar[str] = "links"

    only_surfaces: Annotated[
        Names | None,
        Column(References("surfaces"), Tier.MIX, "The surfaces that it shines on; if absent, on all."),
    ] = None
    except_surfaces: Annotated[
        Names | None,
        Column(References("surfaces"), Tier.MIX, "The surfaces that it does not shine on."),
    ] = None
    only_parts: Annotated[
        Names | None,
        Column(References("parts"), Tier.LIGHT, "The parts that it shines on; if absent, on all."),
    ] = None
    except_parts: Annotated[
        Names | None,
        Column(References("parts"), Tier.LIGHT, "The parts that it does not shine on."),
    ] = None

    def rules(self) -> Iterator[Problem]:
        """Surfaces are named or excepted, not both, and parts as well."""
        for what in ("surfaces", "parts"):
            only, excepted = (vars(self)[f"{which}_{what}"] for which in ("only", "except"))
            if only is not None and excepted is not None:
                yield Problem(
                    (f"except_{what}",), f"must not come with only_{what}, not with both; leave one out"
                )

    def replace(self, /, **changes: Unpack[LinksChanges]) -> Links:
        """The links with some fields changed."""
        return changed(self, changes)
