"""Steady rolling on a base that moves in a circle, in closed form for each model that states one."""

import math

import numpy as np
import numpy.typing as npt

from stylobate import theory
from stylobate.column import Column
from stylobate.models import Model
from stylobate.models.closed_form import ClosedForm, RollingLaw
from stylobate.models.inheritance import closed_form_of


def rolling_form_of(model: Model) -> ClosedForm | None:
    """Return the closed form of the steady rolling without slip of `model`, or None."""
    form = closed_form_of(model)
    return None if form is None or form.law is RollingLaw.SLIPPING else form


def steady_rolling_of(
    form: ClosedForm, column: Column, nu: float, acceleration: float, branch: str = "upper"
) -> tuple[float, float, float]:
    """Return tilt [rad], phase to the base acceleration [rad] and spin [ω0] of steady rolling; NaN without it.

    Parameters
    ----------
    form
        Result of `rolling_form_of` for a model that meets its requirement.
    column
        The column.
    nu
        Frequency of the base [ω0], which moves anticlockwise.
    acceleration
        Acceleration of the base [g].
    branch
        "upper" or "lower"; at finite tilt "upper" is the stable branch or, if none is, that of the phase nearest to 0.
        For slender rolling only the upper branch is known.
    """
    c, eta, zeta = column.slenderness, form.eta, form.zeta
    shape = {"inertia_ratio": column.inertia_ratio, "axial_ratio": column.axial_ratio}
    if form.law is RollingLaw.SLENDER:
        steady = theory.steady_rolling(nu, acceleration, c=c, eta=eta)
        chosen = steady.upper if branch == "upper" else steady.lower
        return float(chosen.amplitude), float(chosen.phase), 0.0
    if form.law is RollingLaw.FREE_TWIST:
        free = theory.free_twist_rolling(nu, acceleration, c=c, eta=eta, zeta=zeta, **shape)
        return float(free.amplitude), float(free.phase), float(free.spin)
    if form.law is RollingLaw.WOBBLING:
        found = theory.wobbling_rolling(nu, acceleration, c=c, eta=eta, **shape)
    else:
        found = theory.full_rolling(nu, acceleration, c=c, eta=eta, zeta=zeta, **shape)
    index = _index_of(found.phase, found.stable, found.exists, branch)
    if index is None:
        return math.nan, math.nan, math.nan
    return float(found.amplitude[index]), float(found.phase[index]), float(found.spin[index])


def _index_of(
    phase: npt.NDArray[np.float64], stable: npt.NDArray[np.bool_], exists: npt.NDArray[np.bool_], branch: str
) -> int | None:
    """Return the index of a branch: upper, the stable one or that of the phase nearest to 0; lower, the farthest."""
    order = sorted(np.flatnonzero(exists).tolist(), key=lambda index: (not stable[index], abs(phase[index])))
    if branch == "upper":
        return order[0] if order else None
    return max(order[1:], key=lambda index: abs(phase[index]), default=None)
