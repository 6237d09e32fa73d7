"""The numbers of the models: declarations that several share, and all of them by name."""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Annotated

from stylobate.column import Column
from stylobate.column.shapes import SHAPES
from stylobate.kinds import Kinds
from stylobate.quantities import QUARTER_TURN, Quantity, parameters_of

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


MODELS = Kinds(
    "model",
    "stylobate.models.model:Model",
    {
        "slender": "stylobate.models.slender:Slender",
        "slender_rolling": "stylobate.models.slender_rolling:SlenderRolling",
        "wobbling": "stylobate.models.wobbling:Wobbling",
        "rolling": "stylobate.models.rolling:Rolling",
        "sliding": "stylobate.models.sliding.model:Sliding",
        "planar_rocking": "stylobate.models.planar_rocking:PlanarRocking",
    },
)
"""The models of the package, by their kind in files and on the command line."""


@cache
def column_quantities() -> Mapping[str, Quantity]:
    """Return the quantity of each number by which a column can be described."""
    return {name: one.quantity for make in SHAPES.values() for name, one in parameters_of(make).items()}


@cache
def model_quantities() -> Mapping[str, Quantity]:
    """Return the quantity of each number that a model of the package has; choices between words are left out."""
    return {
        name: parameter.quantity
        for model in MODELS.values()
        for name, parameter in parameters_of(model).items()
        if not parameter.choices
    }


@cache
def dissipation_names() -> tuple[str, ...]:
    """Return the names of the numbers of models that dissipate."""
    return tuple(name for name, quantity in model_quantities().items() if quantity.dissipates)


def name_by_symbol(model: type, symbol: str) -> str:
    """Return the name of the number of a class of models with this symbol; the symbol itself if no number has it."""
    return next((name for name, one in parameters_of(model).items() if one.quantity.symbol == symbol), symbol)


@cache
def dissipation_of(model: Callable[..., object]) -> Mapping[str, Quantity]:
    """Return the quantity of each number of a class of models that dissipates."""
    return {name: one.quantity for name, one in parameters_of(model).items() if one.quantity.dissipates}
