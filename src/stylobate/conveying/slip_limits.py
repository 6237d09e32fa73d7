"""Slip limits of steady rolling under circular base motion: onset of slip, and rolling with slip."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate import theory
from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.errors import Named, ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.models.declared import name_by_symbol
from stylobate.models.model import ClosedForm, RollingLaw, closed_form_of
from stylobate.parameter_quantities import attributes_of
from stylobate.provenance import provenance_of_run
from stylobate.quantities import cf_attributes
from stylobate.results.outcomes import flag_attributes
from stylobate.studies.checks import require_rising_frequencies
from stylobate.studies.known_rolling import RollingFrame
from stylobate.studies.sweeps.designs import checked_values
from stylobate.theory.averaging import circular_components

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]
Predicate = Callable[[Floats, Floats], Flags]
Variables = dict[str, tuple[tuple[str, ...], npt.NDArray[Any], dict[str, str]]]

_PLANE = ("friction_coefficient", "angular_frequency")

# Bisections of a frequency step that contains a border.
_HALVINGS = 30
# Relative tolerance of equal axes and a quarter turn between them, for a circle.
_ROUND = 1e-9


class RollingRegime(Named, IntEnum):
    """Steady rolling at one friction coefficient and one frequency."""

    NONE = 0
    """No steady rolling exists."""
    UNSTABLE = 1
    """Steady rolling exists, with or without slip, but is unstable."""
    WITHOUT_SLIP = 2
    """Rolling without slip is stable."""
    WITH_SLIP = 3
    """Rolling with a contact that always slips is stable."""
    BOTH = 4
    """Rolling without slip and rolling with slip are both stable."""


STEADY_ROLLING = ("no steady rolling", "none stable", "stable without slip", "stable with slip", "both stable")
"""Names of the regimes, in the order of their codes."""


def slipping_boundary(
    model: Model, motion: BaseMotion, *, friction_coefficient: npt.ArrayLike, angular_frequency: Sequence[float]
) -> xr.Dataset:
    """Compute the stability of steady rolling with and without slip over friction coefficient and frequency.

    Parameters
    ----------
    model
        `Sliding` or `Rolling`, which can spin, or `Wobbling` with the constraint "rubber", which cannot. The model
        needs damping, a point contact and a level plane. Its own friction coefficient is not used.
    motion
        A horizontal circular motion; its acceleration is used, its frequency is replaced.
    friction_coefficient
        Increasing values of μ, kinetic and static.
    angular_frequency
        Increasing angular frequencies [rad/s].

    Returns
    -------
    xarray.Dataset
        Of kind "slipping boundary", exact at any tilt.

        * Over `angular_frequency` and `branch`: `rolling_amplitude` [rad], `rolling_stable` and `required_friction` of
          steady rolling without slip.
        * Over `friction_coefficient`, `angular_frequency` and `branch`: `slips`, whether rolling needs more friction
          than available.
        * With `slipping_branch` instead: `slipping_amplitude` [rad], `slip_speed` [m/s], `slip_power` [W] and
          `slipping_stable` of steady rolling with slip, NaN without such rolling.
        * Over the two: `steady_rolling`: which steady rolling exists and is stable, without slip, with slip or both.
        * Over `friction_coefficient`: `rolling_from`, `rolling_to`, `slipping_from` and `slipping_to` [rad/s], the
          lowest and the highest frequency at which rolling without and with slip is stable. They are NaN if rolling is
          stable nowhere, and the end of the given frequencies if rolling is stable there. A stable interval between two
          neighbouring frequencies is missed.

    Raises
    ------
    ParameterError
        If friction coefficients or frequencies are not increasing positive numbers. If the model has no damping, or can
        spin and has no spin damping, since no steady rolling is then asymptotically stable.
    UnsupportedError
        If the theory does not cover steady rolling with slip for the model, or the motion is not circular.

    See Also
    --------
    stylobate.theory.slipping_rolling, stylobate.theory.full_rolling : the equations.
    stylobate.studies.stability_boundary : stability of rolling without slip under any harmonic motion.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> model = sb.Wobbling(sb.Column.dimensionless(slenderness=0.1), damping=0.1, constraint="rubber")
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.0)
    >>> found = sb.conveying.slipping_boundary(
    ...     model, motion, friction_coefficient=[0.04, 0.05, 0.1], angular_frequency=np.linspace(0.5, 8.0, 100)
    ... )
    >>> print(found["rolling_from"].values.round(3), found["rolling_to"].values.round(3))
    [1.398 1.398 1.398] [2.325 3.576 8.   ]
    """
    case = _Case.of(model, motion)
    friction = _rising_frictions(friction_coefficient)
    frequency = require_rising_frequencies(angular_frequency)
    nu = frequency * model.time_scale
    held, slipping = case.held(nu), case.slipping(nu, friction[:, np.newaxis])
    slips = held.friction_demand > friction[:, np.newaxis, np.newaxis]
    sticks = held.exists & ~slips
    rolls, slides = _any(sticks & held.stable), _any(slipping.stable)
    exists = _any(sticks) | _any(slipping.exists)
    ends = {
        **_ends("rolling", rolls, nu, friction, case.rolls),
        **_ends("slipping", slides, nu, friction, case.slips),
    }
    flags = flag_attributes("steady rolling", [kind.name for kind in RollingRegime])
    return xr.Dataset(
        {
            **_without_slip(held),
            "slips": ((*_PLANE, "branch"), slips, cf_attributes("1", "needs more friction than available")),
            **_with_slip(slipping, model),
            "steady_rolling": (_PLANE, _classes(exists, rolls, slides), flags),
            **{
                name: (
                    "friction_coefficient",
                    edge / model.time_scale,
                    cf_attributes("rad s-1", name.replace("_", " ")),
                )
                for name, edge in ends.items()
            },
        },
        coords={
            "friction_coefficient": ("friction_coefficient", friction, cf_attributes("1", "friction coefficient")),
            "angular_frequency": ("angular_frequency", frequency, attributes_of("angular_frequency")),
            "class_name": np.array(STEADY_ROLLING),
        },
        attrs={
            "kind": "slipping boundary",
            "slenderness": model.column.slenderness,
            "acceleration": case.a0 * model.column.gravity,
            "provenance": json.dumps(provenance_of_run(model, motion)),
        },
    )


def _without_slip(held: theory.FiniteTiltRolling) -> Variables:
    over = ("angular_frequency", "branch")
    return {
        "rolling_amplitude": (over, held.amplitude, cf_attributes("rad", "tilt of rolling without slip")),
        "rolling_stable": (over, held.stable, cf_attributes("1", "rolling without slip is stable")),
        "required_friction": (over, held.friction_demand, cf_attributes("1", "friction required without slip")),
    }


def _with_slip(slipping: theory.SlippingRolling, model: Model) -> Variables:
    over, column = (*_PLANE, "slipping_branch"), model.column
    unit = column.mass_height / model.time_scale  # of velocity, h ω0
    speed = unit * np.hypot(slipping.slip_along, slipping.slip_across)
    power = unit * column.mass * column.gravity * slipping.slip_power
    return {
        "slipping_amplitude": (over, slipping.amplitude, cf_attributes("rad", "tilt of rolling with slip")),
        "slip_speed": (over, speed, cf_attributes("m s-1", "speed of slip")),
        "slip_power": (over, power, cf_attributes("W", "power dissipated by slip")),
        "slipping_stable": (over, slipping.stable, cf_attributes("1", "rolling with slip is stable")),
    }


@dataclass(frozen=True, slots=True)
class _Case:
    """Column and circular base motion in the units of the theory, for any frequency and friction."""

    a0: float
    column: dict[str, float]

    @classmethod
    def of(cls, model: Model, motion: BaseMotion) -> "_Case":
        """Create the case, or raise an error unless the theory covers steady rolling with slip of the model."""
        form = _closed_form(model)
        if not isinstance(motion, Harmonic) or not _is_circle(motion):
            raise UnsupportedError(
                f"motion must be a horizontal circular motion, such as Harmonic.circular(...), got {motion!r}"
            )
        column = model.column
        return cls(
            RollingFrame.of(model, motion).drive,
            {
                "c": column.slenderness,
                "eta": form.eta,
                "zeta": form.zeta,
                "inertia_ratio": column.inertia_ratio,
                "axial_ratio": column.axial_ratio,
            },
        )

    def held(self, nu: Floats) -> theory.FiniteTiltRolling:
        return theory.full_rolling(nu, self.a0, **self.column)

    def slipping(self, nu: Floats, mu: Floats) -> theory.SlippingRolling:
        return theory.slipping_rolling(nu, self.a0, mu=mu, **self.column)

    def rolls(self, nu: Floats, mu: Floats) -> Flags:
        """Return whether rolling without slip is stable."""
        found = self.held(nu)
        return _any(found.stable & (found.friction_demand <= mu[..., np.newaxis]))

    def slips(self, nu: Floats, mu: Floats) -> Flags:
        """Return whether rolling with slip is stable."""
        return _any(self.slipping(nu, mu).stable)


def _closed_form(model: Model) -> ClosedForm:
    """Return the closed form of steady rolling with slip for a model, or raise an error if none applies."""
    form = closed_form_of(model)
    if form is None or form.law not in (RollingLaw.SLIPPING, RollingLaw.FULL):
        raise UnsupportedError(
            'steady rolling with slip is known of Sliding, Rolling and Wobbling(constraint="rubber"), got model '
            f"{getattr(model, 'name', model)!s}"
        )
    if form.requires is not None:
        name, value = form.requires
        raise UnsupportedError(
            f"{name} must be {value!r} for a closed form of steady rolling with slip, got {getattr(model, name)!r}"
        )
    for symbol, value in (("η", form.eta), ("ζ", form.zeta)):
        if not value > 0.0:
            name = name_by_symbol(type(model), symbol)
            raise ParameterError(f"{name} must be above zero, got {value!r}: without it no steady rolling is decided")
    return form


def _is_circle(motion: Harmonic) -> bool:
    (a1, a2, a3), (phi1, phi2, _) = motion.amplitude, motion.phase
    parts = sorted(abs(complex(part)) for part in circular_components(a1, a2, phi2 - phi1))
    return a3 == 0.0 and parts[0] <= _ROUND * parts[1]


def _rising_frictions(given: npt.ArrayLike) -> Floats:
    values = checked_values("friction_coefficient", "friction_coefficient", given, scalar=True)
    if not values.size or np.any(np.diff(values) <= 0.0):
        raise ParameterError(f"friction_coefficient must be one or more rising numbers, got {given!r}")
    return values


def _classes(exists: Flags, rolls: Flags, slips: Flags) -> npt.NDArray[np.int8]:
    classes = np.where(exists, RollingRegime.UNSTABLE, RollingRegime.NONE)
    for where, kind in (
        (rolls, RollingRegime.WITHOUT_SLIP),
        (slips, RollingRegime.WITH_SLIP),
        (rolls & slips, RollingRegime.BOTH),
    ):
        classes = np.where(where, kind, classes)
    return classes.astype(np.int8)


def _ends(name: str, inside: Flags, nu: Floats, mu: Floats, predicate: Predicate) -> dict[str, Floats]:
    """Return the lowest and highest ν of the predicate for each μ; `inside` is the predicate on the grid."""
    return {
        f"{name}_from": _first(inside, nu, mu, predicate),
        f"{name}_to": _first(inside[:, ::-1], nu[::-1], mu, predicate),
    }


def _first(inside: Flags, nu: Floats, mu: Floats, predicate: Predicate) -> Floats:
    """Return the first ν inside for each μ, bisected between the first grid value and the one before; NaN for none."""
    first = inside.argmax(axis=1)
    within, beyond = nu[first], nu[np.maximum(first - 1, 0)]
    for _ in range(_HALVINGS):
        middle = 0.5 * (within + beyond)
        holds = predicate(middle, mu)
        within, beyond = np.where(holds, middle, within), np.where(holds, beyond, middle)
    # A grid that begins inside needs no bisection.
    return np.where(inside.any(axis=1), np.where(first > 0, within, nu[0]), np.nan)


def _any(branches: Flags) -> Flags:
    """Return whether any branch fulfils the condition."""
    return np.asarray(branches.any(axis=-1))
