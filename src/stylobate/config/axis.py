"""Describe the values of one quantity: evenly spaced, or listed."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from pydantic import Field, ValidationInfo, field_validator, model_validator

from stylobate.config.description import Config
from stylobate.errors import ParameterError, require_finite, require_positive, require_whole
from stylobate.parameter_quantities import known_names, quantity_of
from stylobate.text import did_you_mean
from stylobate.units import has_unit, read_all


class Axis(Config):
    """Values of one quantity, evenly spaced or listed.

    Parameters
    ----------
    name
        Name of the quantity, such as "acceleration" or "tilt_x".
    from
        First value; needed without `values`.
    to
        Last value; needed without `values`.
    number
        Number of values; needed without `values`.
    spacing
        Spacing of the values between `from` and `to`.
    values
        The values themselves, in place of `from`, `to` and `number`.
    """

    name: str
    first: float | None = Field(default=None, alias="from")
    last: float | None = Field(default=None, alias="to")
    number: int | None = None
    spacing: Literal["linear", "log"] = "linear"
    listed: tuple[float, ...] | None = Field(default=None, alias="values")

    @model_validator(mode="before")
    @classmethod
    def _know_the_quantity(cls, values: Any) -> Any:
        """Refuse values with a unit of an unknown quantity, which has no unit to convert them to."""
        name = str(values.get("name", "")).replace("-", "_") if isinstance(values, Mapping) else ""
        if name and name not in known_names() and any(map(has_unit, values.values())):
            raise ValueError(f"{name} is not known here, so its unit cannot be converted; {_remedy(name)}")
        return values

    @field_validator("first", "last", "listed", mode="before")
    @classmethod
    def _read_units(cls, value: Any, info: ValidationInfo) -> Any:
        """Read values with a unit, such as "5 deg", in the unit of the quantity of this name."""
        return read_all(value, quantity_of(info.data.get("name", "")).unit)

    @field_validator("name")
    @classmethod
    def _written_as_in_python(cls, name: str) -> str:
        return name.replace("-", "_")

    def build(self) -> npt.NDArray[np.float64]:
        """Compute the values, shape (n,).

        Raises
        ------
        ParameterError
            If the values are missing, given in both ways, or invalid.
        """
        spaced = {"from": self.first, "to": self.last, "number": self.number}
        missing = [name for name, value in spaced.items() if value is None]
        if self.listed is not None and len(missing) == len(spaced):
            return self._listed(self.listed)
        if self.listed is not None or missing:
            got = [name for name, value in {**spaced, "values": self.listed}.items() if value is not None]
            raise ParameterError(
                f"{self.name} needs from, to and number, or values; got {', '.join(got) or 'none of them'}"
            )
        return self._spaced()

    def _listed(self, values: tuple[float, ...]) -> npt.NDArray[np.float64]:
        if not values:
            raise ParameterError(f"{self.name} must have at least one value, got none")
        return np.array([require_finite("values", value) for value in values])

    def _spaced(self) -> npt.NDArray[np.float64]:
        first, last, number = _known(self.first), _known(self.last), _known(self.number)
        number = require_whole("number", number, least=1)
        if self.spacing == "log":
            return np.geomspace(require_positive("from", first), require_positive("to", last), number)
        return np.linspace(require_finite("from", first), require_finite("to", last), number)


class Scales(Axis):
    """Factors of the base motion, spaced or listed."""

    name: str = "scale"
    spacing: Literal["linear", "log"] = "log"


def _remedy(name: str) -> str:
    return did_you_mean(name, known_names()) or "use a name of the column, model, base motion or start"


def _known(value: Any) -> Any:
    assert value is not None
    return value
