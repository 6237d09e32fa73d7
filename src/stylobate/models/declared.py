"""The declared numbers of all models by name, for studies that vary them and for controls that set them."""

from collections.abc import Callable, Mapping
from functools import cache

from stylobate.column import SHAPES
from stylobate.kinds import Kinds
from stylobate.quantities import Quantity, parameters_of

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
