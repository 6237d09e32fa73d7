"""Small variations of a case: what is never known exactly of a column, its base and a record, with distributions."""

import math
import zlib
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

import numpy as np

from stylobate.base_motions import BASE_AT_REST
from stylobate.earthquakes.property_spreads import Choice, LognormalSpread, LogUniformSpread, NormalSpread, Spread
from stylobate.engine.parameters import COLUMN_NAMES, model_names, present_value
from stylobate.errors import ParameterError
from stylobate.models import Model
from stylobate.models.declared import dissipation_of
from stylobate.results import verdict
from stylobate.studies.sweeps.quantities import Floats
from stylobate.text import did_you_mean

_ANY: Final = -math.inf

VARIATIONS: Mapping[str, Spread] = MappingProxyType(
    {
        "scale": LognormalSpread(0.02),
        "clock": LognormalSpread(0.001),
        "lowpass": Choice((math.inf, 40.0, 25.0, 15.0)),
        "rotation": NormalSpread(math.radians(3.0), least=_ANY),
        "slope_x": NormalSpread(math.radians(0.07), least=_ANY),
        "slope_y": NormalSpread(math.radians(0.07), least=_ANY),
        "start_x": NormalSpread(1e-4, least=_ANY),
        "start_y": NormalSpread(1e-4, least=_ANY),
        "size": LognormalSpread(0.01),
        "slenderness": LognormalSpread(0.01),
        "dissipation": LogUniformSpread(0.5, 2.0),
        "tolerance": Choice((1.0, 0.01)),
    }
)
"""Default variations of a verdict; all are independent.

scale
    Factor of the record: 2 %, the calibration of an instrument.
clock
    Factor of the time of the record: 0.1 %.
lowpass
    Corner of a low-pass filter of a record [Hz]: none, or one of three; a corner above its Nyquist frequency does
    nothing.
rotation
    Rotation of the record about the vertical [rad]: 3°, the orientation of an instrument.
slope_x, slope_y
    Slope of the base [rad]: 0.07° each, together a tenth of a degree.
start_x, start_y
    Initial tilt over α_c: 10⁻⁴ each, ambient vibration. A column that already rocks by 10⁻³ is another case: it needs
    no acceleration above its threshold to leave rest, and overturns far more often.
size
    Factor of all lengths: 1 %.
slenderness
    Slenderness r/h: 1 %.
dissipation
    Factor of all dissipation parameters (of the loss, 1 − restitution, at impacts): half to twice, the levels that an
    assessment recommends.
tolerance
    Factor of the tolerance of the integration.
"""

LABELS = verdict.LABELS
"""Names of variations in figures and sentences; another variation has the name of its parameter."""

# Value of a variation that is not a parameter of column or model, before it is varied.
_NEUTRAL: Mapping[str, float] = {
    "scale": 1.0,
    "clock": 1.0,
    "lowpass": math.inf,
    "rotation": 0.0,
    "slope_x": 0.0,
    "slope_y": 0.0,
    "start_x": 0.0,
    "start_y": 0.0,
    "dissipation": 1.0,
    "tolerance": 1.0,
}


def chosen_variations(changes: Mapping[str, Spread | None] | None) -> dict[str, Spread]:
    """Return the default variations with these changes: another distribution, or None to leave a variation out.

    Raises
    ------
    ParameterError
        If `changes` does not map names to distributions.
    """
    if changes is not None and not isinstance(changes, Mapping):
        raise ParameterError(
            f'variations: must map names to distributions (got {changes!r}). Pass {{"scale": LognormalSpread(0.05)}}.'
        )
    for name, spread in (changes or {}).items():
        if spread is not None and not hasattr(spread, "draw"):
            raise ParameterError(
                f"variations[{name!r}]: must be a distribution or None (got {spread!r}). Pass one such as "
                "LognormalSpread(0.05)."
            )
    return {name: spread for name, spread in {**VARIATIONS, **(changes or {})}.items() if spread is not None}


def check_variations(models: tuple[Model, ...], variations: Mapping[str, Spread]) -> None:
    """Raise ParameterError if a variation is neither one of `VARIATIONS` nor a parameter of column and models."""
    for name in variations:
        known = [{*_NEUTRAL, *COLUMN_NAMES, *model_names(model)} for model in models]
        if not any(name in some for some in known):
            remedy = did_you_mean(name, set().union(*known)) or f"use one of {', '.join((*VARIATIONS, 'damping'))} …"
            raise ParameterError(f"variations: {name} is no variation of a {models[0].name} column; {remedy}")


def drawn(name: str, spread: Spread, model: Model, *, runs: int, seed: int) -> Floats:
    """Draw the values of one variation, shape (runs,).

    The values depend on the name, its distribution and the seed only: a further variation changes no other, and more
    runs begin with the same.
    """
    return spread.draw(nominal_of(model, name), shares_of(name, runs=runs, seed=seed))


def shares_of(name: str, *, runs: int, seed: int) -> Floats:
    """Return independent uniform numbers between 0 and 1 for a variation, shape (runs,)."""
    return np.random.default_rng([seed, zlib.crc32(name.encode())]).random(runs)


def nominal_of(model: Model, name: str) -> float:
    """Return the value of a variation in the given case; NaN for a parameter that the model does not have."""
    if name in _NEUTRAL:
        return _NEUTRAL[name]
    if name in COLUMN_NAMES or name in model_names(model):
        return present_value(model, BASE_AT_REST, name)
    return math.nan


def scaled_dissipation(model: Model, factors: Floats, stated: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the dissipation parameters of a model times `factors`; of a restitution, the loss 1 − e.

    A parameter that the model does not use, or whose values are `stated`, is left out.
    """
    values = {}
    for name, quantity in dissipation_of(type(model)).items():
        value, lossless = getattr(model, name), quantity.lossless
        # Without a stated restitution the model uses that of the impact.
        value = getattr(model, f"impact_{name}", lossless) if value is None else value
        if name not in stated and value != lossless:
            values[name] = np.maximum(0.0, lossless - factors * (lossless - float(value)))
    return values
