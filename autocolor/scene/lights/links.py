"""The links of a light: which surfaces and parts it shines on.

Departs: the paper's lights shine on everything. A point is lit if its surface is one that the light shines
on, and its part is, too.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
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

    @property
    def depend_on_parts(self) -> bool:
        """Whether it depends on the part if a point is lit."""
        return self.only_parts is not None or self.except_parts is not None

    def shines_on_surface(self, surface: str) -> bool:
        """Whether the light shines on the surface of that name."""
        return bool(_meant([surface], self.only_surfaces, self.except_surfaces))

    def lit_parts(self, parts: Iterable[str]) -> set[str]:
        """Those of the parts of these names that the light shines on, as far as their surfaces are lit."""
        return _meant(parts, self.only_parts, self.except_parts)

    def within(self, surfaces: Collection[str], parts: Collection[str]) -> Links:
        """The links without the names that are not among some surfaces and parts.

        Assumed: where none of the names of a list is left, there is no list: a light for what is not there
        shines on everything, as no picture would show a light that shines on nothing.
        """
        kept = {
            field: _kept(names, known)
            for known, fields in (
                (surfaces, ("only_surfaces", "except_surfaces")),
                (parts, ("only_parts", "except_parts")),
            )
            for field in fields
            if (names := vars(self)[field])
        }
        return changed(self, kept) if any(kept[field] != vars(self)[field] for field in kept) else self


def _meant(names: Iterable[str], only: Names | None, excepted: Names | None) -> set[str]:
    """Those of the names that are among `only`, or not among the excepted ones."""
    # A mesh may have many thousands of parts: no name is looked for in a list.
    return (set(names) if only is None else set(names).intersection(only)).difference(excepted or ())


def _kept(names: Names, known: Collection[str]) -> Names | None:
    """The names that are known; None if there is none."""
    return tuple(name for name in names if name in known) or None
