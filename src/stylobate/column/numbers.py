"""The numbers by which a column is described, declared once for its class and its named constructors."""

from typing import Annotated, Literal

from stylobate.quantities import Quantity

STANDARD_GRAVITY = 9.80665
"""Standard gravity [m/s²]."""

LIGHTEST, DENSEST = 10.0, 25_000.0
"""Densities between which a body is not questioned [kg/m³]: from light foam to osmium."""

# Beyond the towers and tanks that exist; the tower of Pisa has a radius of 7.8 m and a height of 57 m.
Radius = Annotated[float, Quantity(symbol="r", unit="m", text="radius of the base", gt=0.0, unlikely_above=25.0)]
Height = Annotated[float, Quantity(symbol="H", unit="m", text="height of the body", gt=0.0, unlikely_above=150.0)]
Mass = Annotated[float, Quantity(symbol="m", unit="kg", text="mass", gt=0.0)]
Density = Annotated[
    float,
    Quantity(symbol="ρ", unit="kg/m³", text="density", gt=0.0, unlikely_above=DENSEST, unlikely_below=LIGHTEST),
]
Gravity = Annotated[
    float, Quantity(symbol="g", unit="m/s²", text="acceleration of gravity", gt=0.0, slider=(0.5, 15.0))
]

Sides = Annotated[int, Quantity(symbol="n", text="number of sides", ge=3, le=1000, whole=True)]
Side = Annotated[float, Quantity(symbol="b", unit="m", text="length of a side", gt=0.0, unlikely_above=50.0)]
Circle = Annotated[Literal["inscribed", "circumscribed"], Quantity(text="circle in place of the polygon")]
WallThickness = Annotated[float, Quantity(unit="m", text="thickness of the wall", gt=0.0)]
FloorThickness = Annotated[float, Quantity(unit="m", text="thickness of the floor", gt=0.0)]
LiquidDepth = Annotated[float, Quantity(symbol="H_l", unit="m", text="depth of the liquid", gt=0.0)]
Liquid = Annotated[Literal["frozen", "impulsive", "level"], Quantity(text="motion of the liquid")]

TopRadius = Annotated[float, Quantity(symbol="r_t", unit="m", text="radius of the top", gt=0.0)]
MassHeight = Annotated[float, Quantity(symbol="h", unit="m", text="height of the centre of mass", gt=0.0)]
FrequencyScale = Annotated[
    float, Quantity(symbol="ω0", unit="rad/s", text="√(m g h/J0), the unit of dimensionless frequency")
]
Slenderness = Annotated[float, Quantity(symbol="c", text="slenderness r/h", gt=0.0, slider=(0.02, 0.5))]
