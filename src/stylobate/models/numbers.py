"""Declared numbers that several models share. A number of one model is declared in its class."""

from typing import Annotated

from stylobate.column import Column
from stylobate.quantities import QUARTER_TURN, Quantity

# Coulomb friction above this is not resolved; use a model without slip.
_MOST_FRICTION = 1e8

Damping = Annotated[
    float,
    Quantity(
        symbol="η",
        text="damping of tilting",
        ge=0.0,
        slider=(0.0, 0.5),
        dissipates=True,
        by_word={"housner": Column.housner_damping},
    ),
]
SpinDamping = Annotated[float, Quantity(symbol="ζ", text="damping of spin", ge=0.0, slider=(0.0, 2.0), dissipates=True)]
RollingResistance = Annotated[
    float, Quantity(symbol="μ_r", text="rolling resistance", ge=0.0, slider=(0.0, 0.05), dissipates=True)
]
Restitution = Annotated[
    float,
    Quantity(
        symbol="e",
        text="fraction of the tilt rate left after a passage near the vertical",
        ge=0.0,
        le=1.0,
        note="1 for no loss",
        slider=(0.0, 1.0),
        dissipates=True,
        lossless=1.0,
    ),
]
NormalRestitution = Annotated[
    float,
    Quantity(
        symbol="e_n",
        text="fraction of the normal speed left after an impact",
        ge=0.0,
        le=1.0,
        note="1 for no loss",
        slider=(0.0, 1.0),
        dissipates=True,
        lossless=1.0,
    ),
]
PassageTilt = Annotated[
    float, Quantity(unit="rad", text="tilt below which the vertical is passed", ge=0.0, le=QUARTER_TURN)
]
FrictionCoefficient = Annotated[
    float,
    Quantity(
        symbol="μ",
        text="friction coefficient of the sliding contact",
        ge=0.0,
        le=_MOST_FRICTION,
        note="Rolling is the model that never slips",
        slider=(0.02, 1.2),
    ),
]
StaticFrictionCoefficient = Annotated[
    float,
    Quantity(
        symbol="μ_s",
        text="friction coefficient of the contact at rest",
        ge=0.0,
        le=_MOST_FRICTION,
        note="Rolling is the model that never slips",
        slider=(0.02, 1.5),
    ),
]
