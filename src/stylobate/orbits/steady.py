"""Steady rolling on a base that moves in a circle, in closed form for each model that has one."""

import math

import numpy as np
import numpy.typing as npt

from stylobate import theory
from stylobate.models import Model, Rolling, Slender, SlenderRolling, Wobbling


def theory_knows(model: Model) -> bool:
    """Return whether steady rolling of `model` is known in closed form; a subclass is another model."""
    if type(model) is SlenderRolling:
        return model.couples == "contact"
    if type(model) is Wobbling or type(model) is Rolling:
        return model.rolling_resistance == 0.0
    return type(model) is Slender


def steady_rolling_of(
    model: Model, theta: float, acceleration: float, branch: str = "upper"
) -> tuple[float, float, float]:
    """Return tilt [rad], phase to the base acceleration [rad] and spin [ω0] of steady rolling; NaN where there is none.

    Parameters
    ----------
    model
        One that `theory_knows`.
    theta
        Frequency of the base [ω0], which moves anticlockwise.
    acceleration
        Of the base [g].
    branch
        "upper" or "lower"; at finite tilt "upper" is the stable branch or, if none is, that of the phase nearest to 0.
        Of slender rolling only the upper one is known.
    """
    column = model.column
    c, shape = column.slenderness, {"inertia_ratio": column.inertia_ratio, "axial_ratio": column.axial_ratio}
    if isinstance(model, Slender):
        steady = theory.steady_rolling(theta, acceleration, c=c, eta=model.damping)
        chosen = steady.upper if branch == "upper" else steady.lower
        return float(chosen.amplitude), float(chosen.phase), 0.0
    if isinstance(model, SlenderRolling):
        free = theory.free_twist_rolling(theta, acceleration, c=c, eta=model.damping, zeta=model.spin_damping, **shape)
        return float(free.amplitude), float(free.phase), float(free.spin)
    found = _at_finite_tilt(model, theta, acceleration)
    index = _place(found.phase, found.stable, found.exists, branch)
    if index is None:
        return math.nan, math.nan, math.nan
    return float(found.amplitude[index]), float(found.phase[index]), float(found.spin[index])


def _at_finite_tilt(model: Model, theta: float, acceleration: float) -> theory.FiniteTiltRolling:
    column = model.column
    shape = {"c": column.slenderness, "inertia_ratio": column.inertia_ratio, "axial_ratio": column.axial_ratio}
    if isinstance(model, Wobbling):
        if model.constraint == "rubber":  # no rotation about the vertical, as an infinite spin damping has it
            return theory.full_rolling(theta, acceleration, eta=model.damping, zeta=math.inf, **shape)
        return theory.wobbling_rolling(theta, acceleration, eta=model.damping, **shape)
    assert isinstance(model, Rolling)
    return theory.full_rolling(theta, acceleration, eta=model.damping, zeta=model.spin_damping, **shape)


def _place(
    phase: npt.NDArray[np.float64], stable: npt.NDArray[np.bool_], exists: npt.NDArray[np.bool_], branch: str
) -> int | None:
    """Return the place of the upper branch, stable or else of the phase nearest to 0; of the lower, the farthest."""
    order = sorted(np.flatnonzero(exists).tolist(), key=lambda index: (not stable[index], abs(phase[index])))
    if branch == "upper":
        return order[0] if order else None
    return max(order[1:], key=lambda index: abs(phase[index]), default=None)
