"""The tables of a scene file as pydantic models: which keys there are, which must be there, and their types.

A field's description is its rule, and the end of the sentence when something else stands in the file. Types
are strict: no text for a number, no true or false for a number; whole numbers serve as numbers. What the
values must be beyond that is checked where they are made: in lights, views, tables and scenes.
Importing this module imports pydantic, which takes a while; it is imported when a scene file is read.
"""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

POINT: Final = "must be three finite numbers [x, y, z]"
FLAP: Final = "must be a table of minimum, maximum and on"

Number = Annotated[float | None, Field(description="must be a finite number")]
Switch = Annotated[bool | None, Field(description="must be true or false")]
Text = Annotated[str | None, Field(description="must be a text in quotes")]
Vector = Annotated[list[float] | None, Field(min_length=3, max_length=3, description=POINT)]
Color = Annotated[str | list[int] | None, Field(description='must be a color as in "#b01020"')]
AnyTable = dict[str, Any] | None
AnyTables = list[Any] | None


class Table(BaseModel):
    """A table that refuses keys it does not know."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


class SceneKeys(Table):
    """The keys outside of all tables, and the names of the tables, which are read one by one."""

    ambient: Number = None
    scaling: Text = None
    mapping: Annotated[Any, Field(description="must be a name in quotes or points [x, y]")] = None
    contrast: Text = None
    background: Color = None
    view: Annotated[AnyTable, Field(description="must be a table, written [view]")] = None
    mesh: Annotated[AnyTables, Field(description="must be tables, each written [[mesh]]")] = None
    lights: Annotated[AnyTables, Field(description="must be tables, each written [[lights]]")] = None
    parts: Annotated[AnyTable, Field(description="must be tables written [parts.NAME]")] = None
    surfaces: Annotated[AnyTable, Field(description="must be tables written [surfaces.NAME]")] = None


class ViewKeys(Table):
    """`[view]`."""

    eye: Annotated[list[float], Field(min_length=3, max_length=3, description=POINT)]
    direction: Vector = None
    target: Vector = None
    angle: Number = None
    field_of_view: Number = None


class MeshKeys(Table):
    """`[[mesh]]`: a file, or a node table and a polygon table."""

    file: Text = None
    nodes: Text = None
    polygons: Text = None
    up: Annotated[Literal["x", "y", "z"], Field(description='must be "x", "y" or "z"')] = "z"
    crease_angle: Annotated[
        Number, Field(ge=0, le=180, description="must be a number of degrees from 0 to 180")
    ] = None


class PartKeys(Table):
    """`[parts.NAME]`."""

    surface: Annotated[str, Field(description="must be a text in quotes")]


class SurfaceKeys(Table):
    """`[surfaces.NAME]`."""

    diffuse: Number = None
    specular: Number = None
    exponent: Number = None
    object_color: Color = None
    light_color: Color = None
    blend: Number = None
    light_percentage: Number = None
    two_sided: Switch = None
    levels: Annotated[int | None, Field(description="must be a whole number of at least 2")] = None


class FlapKeys(Table):
    """One flap of a light."""

    minimum: Number = None
    maximum: Number = None
    on: Switch = None


class FlapsKeys(Table):
    """`flaps` of a light; each axis is read by itself."""

    x: Annotated[AnyTable, Field(description=FLAP)] = None
    y: Annotated[AnyTable, Field(description=FLAP)] = None
    z: Annotated[AnyTable, Field(description=FLAP)] = None


class LightKeys(Table):
    """`[[lights]]`."""

    name: Annotated[str, Field(min_length=1, description="must be a text of at least one letter")]
    position: Annotated[list[float], Field(min_length=3, max_length=3, description=POINT)]
    intensity: Number = None
    on: Switch = None
    direction: Vector = None
    aim: Vector = None
    concentration: Number = None
    cone_angle: Number = None
    flaps: Annotated[AnyTable, Field(description="must be a table of x, y and z")] = None
