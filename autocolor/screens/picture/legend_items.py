"""The legend of a scalar as items of a page."""

from __future__ import annotations

from collections.abc import Sequence

from autocolor.mapping.legend import GROUND, INK, Legend
from autocolor.widgets.areas import Area
from autocolor.widgets.items import Item, filled, text


def legend_items(legend: Legend | None) -> Sequence[Item]:
    """The items that draw a legend; none without one."""
    if legend is None:
        return ()
    areas = [filled(Area(*swatch[:4]), swatch.word) for swatch in legend.swatches]
    return [*areas, *(text(each.text, each.left, each.top, INK, GROUND) for each in legend.labels)]
