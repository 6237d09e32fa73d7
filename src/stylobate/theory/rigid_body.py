"""A rigid column of revolution, and its steady rolling on a base at rest.

Moments of inertia are over J0, the moment about a diameter of the base, and lengths over the height h of the centre of
mass; gravity, m g h over J0 ω0², is then 1.
"""

from dataclasses import dataclass
from typing import Any, Self, TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError
from stylobate.quantities import degrees_meant
from stylobate.theory.arguments import (
    BoolArray,
    ComplexArray,
    FloatArray,
    Real,
    Values,
    finite,
    plain_results,
    positive,
)

Numbers: TypeAlias = npt.NDArray[Any]
"""Real numbers, or complex numbers of a complex-step derivative."""

# Relative tolerance of the bound on the inertias, which rounding may violate at equality.
_ROUNDING = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class RigidBody:
    """Slenderness and inertia ratios of a rigid column of revolution, arrays of one shape.

    Parameters
    ----------
    c
        Slenderness r/h.
    kappa
        κ = m h²/J0.
    axial_ratio
        i_a = I_a/(m r²).
    """

    c: FloatArray
    kappa: FloatArray
    axial_ratio: FloatArray

    @classmethod
    def checked(cls, c: Real, inertia_ratio: Real, axial_ratio: Real) -> Self:
        """Return the body, or raise ParameterError if no body of revolution can have these numbers."""
        slender, kappa, axial = np.broadcast_arrays(
            positive("c", c), below_one("inertia_ratio", inertia_ratio), positive("axial_ratio", axial_ratio)
        )
        body = cls(c=slender, kappa=kappa, axial_ratio=axial)
        bad = body.axial > 2.0 * body.transverse * (1.0 + _ROUNDING)
        if bad.any():
            radius, ratio, given = (float(number[bad][0]) for number in (slender, kappa, axial))
            raise ParameterError(
                f"axial_ratio must be at most {2.0 * (1.0 - ratio) / (ratio * radius**2)!r} for a body of revolution "
                f"with c = {radius!r} and inertia_ratio = {ratio!r}, got {given!r}"
            )
        return body

    def __getitem__(self, cells: Any) -> "RigidBody":
        return RigidBody(c=self.c[cells], kappa=self.kappa[cells], axial_ratio=self.axial_ratio[cells])

    @property
    def transverse(self) -> FloatArray:
        """I_t about the centre of mass."""
        return 1.0 - self.kappa

    @property
    def axial(self) -> FloatArray:
        """I_a."""
        return self.kappa * self.axial_ratio * self.c**2

    @property
    def rim(self) -> FloatArray:
        """K about a tangent of the rim."""
        return 1.0 + self.kappa * self.c**2

    @property
    def freedom(self) -> FloatArray:
        """D = 1 + i_a − κ, by which free spin reduces the effect of forces across the lean."""
        return 1.0 + self.axial_ratio - self.kappa

    def reach(self, tilt: Numbers) -> Numbers:
        """Compute ρ/h, the horizontal distance of the centre of mass from the axis of the column at rest."""
        return np.sin(tilt) + self.c * (1.0 - np.cos(tilt))

    def height(self, tilt: Numbers) -> Numbers:
        """Compute ρ'/h = z/h, the height of the centre of mass."""
        return np.cos(tilt) + self.c * np.sin(tilt)

    def overhang(self, tilt: Numbers) -> Numbers:
        """Compute −z'/h, the overhang of the centre of mass over the contact point; negative below α_c."""
        return np.sin(tilt) - self.c * np.cos(tilt)


def below_one(name: str, value: Real) -> FloatArray:
    """Return `value` as an array of floats, or raise ParameterError unless all lie in (0, 1)."""
    array = positive(name, value)
    if np.any(array >= 1.0):
        raise ParameterError(f"{name} = m h²/J0 must be below 1, got {float(np.max(array))!r}")
    return array


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeRolling:
    """Steady rolling at a given tilt and spin: arrays of the broadcast shape and a last axis for the two branches.

    NaN (and False) where the column cannot roll steadily.

    Parameters
    ----------
    rate
        Rolling rate β̇ of the contact point [ω0], the larger first.
    friction_demand
        Horizontal over vertical force of the contact: the coefficient of friction below which the contact slips.
    exists
        Whether there is such a solution.
    stable
        Whether no deviation grows: the tilt then oscillates without decay.
    eigenvalue
        Growth rate of a deviation of the tilt, complex: imaginary where stable (frequency of the nutation), otherwise
        real and positive. The other four eigenvalues are its negative and three zeros.
    """

    rate: FloatArray
    friction_demand: FloatArray
    exists: BoolArray
    stable: BoolArray
    eigenvalue: ComplexArray


@plain_results
def free_rolling(
    tilt: Real, spin: Real = 0.0, *, c: Real, inertia_ratio: Real = 0.75, axial_ratio: Real = 0.5
) -> FreeRolling:
    r"""Compute free steady rolling of a column round its rim from tilt and spin.

    Parameters
    ----------
    tilt
        Tilt angle θ [rad], between 0 and π/2.
    spin
        Axial angular velocity w3 [ω0].
    c
        Slenderness.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    FreeRolling
        The two rolling rates possible.

    Raises
    ------
    ParameterError
        If `tilt` is not between 0 and π/2, `spin` is not finite, a number of the body is not positive, or no body can
        have these numbers.

    See Also
    --------
    free_rolling_spin : the spin from tilt and rolling rate.
    rolling_backbone : the limit of small tilts without spin.

    Notes
    -----
    With p = cos θ + c sin θ the rates are the roots of

        sin θ (κp + (1 − κ) cos θ) β̇² − κc w3 (p + c i_a sin θ) β̇ + sin θ − c cos θ = 0,

    two of opposite sign below the tipping angle. Above the tipping angle the column would fall without spin; if w3 is
    large enough, two roots of its sign exist. Deviations from steady rolling conserve two linear combinations of w1 and
    w3 that depend on the tilt alone. So the tilt moves as on a spring and is stable if the stiffness is positive.

    Examples
    --------
    >>> rolling = free_rolling([0.05, 0.2], [0.0, 20.0], c=0.1)
    >>> print(rolling.rate.round(4), rolling.stable, sep="\n")
    [[ 0.9979 -0.9979]
     [ 7.5963  0.067 ]]
    [[ True  True]
     [ True False]]
    """
    body = RigidBody.checked(c, inertia_ratio, axial_ratio)
    tilt, w3, slender, kappa, axial = np.broadcast_arrays(
        _inclined(tilt), finite("spin", spin), body.c, body.kappa, body.axial_ratio
    )
    body = RigidBody(c=slender, kappa=kappa, axial_ratio=axial)
    square, linear, constant = _coefficients(tilt, body)
    rate = np.stack(_roots(square, -linear * w3, constant), axis=-1)
    exists = np.isfinite(rate)
    wide = body[..., np.newaxis]
    tilt, w3 = tilt[..., np.newaxis], w3[..., np.newaxis]
    stiffness = _stiffness(tilt, rate, w3, wide)
    with np.errstate(invalid="ignore"):
        stable = stiffness >= 0.0
    eigenvalue = np.where(exists, np.sqrt((-stiffness / wide.rim).astype(np.complex128)), np.nan)
    return FreeRolling(
        rate=rate,
        friction_demand=np.abs(wide.kappa * rate * (wide.c * w3 - rate * np.sin(tilt))),
        exists=exists,
        stable=stable,
        eigenvalue=eigenvalue,
    )


@plain_results
def free_rolling_spin(
    tilt: Real, rate: Real, *, c: Real, inertia_ratio: Real = 0.75, axial_ratio: Real = 0.5
) -> Values:
    """Compute the spin of free steady rolling from tilt and rolling rate.

    Parameters
    ----------
    tilt
        Tilt angle θ [rad], between 0 and π/2.
    rate
        Rolling rate β̇ of the contact point [ω0].
    c, inertia_ratio, axial_ratio
        As for `free_rolling`.

    Returns
    -------
    numpy.ndarray
        Axial angular velocity w3 [ω0], of the broadcast shape; NaN at zero rate.

    Raises
    ------
    ParameterError
        If `tilt` is not between 0 and π/2, `rate` is not finite, a number of the body is not positive, or no body can
        have these numbers.

    Examples
    --------
    >>> print(free_rolling_spin([0.05, 0.2], [2.0, 7.5963], c=0.1).round(3))
    [ 0.997 20.   ]
    """
    body = RigidBody.checked(c, inertia_ratio, axial_ratio)
    square, linear, constant = _coefficients(_inclined(tilt), body)
    rate = finite("rate", rate)
    with np.errstate(divide="ignore", invalid="ignore"):
        spin = (square * rate**2 + constant) / (linear * rate)
    return np.asarray(np.where(rate == 0.0, np.nan, spin))


def _inclined(tilt: Real) -> FloatArray:
    array = finite("tilt", tilt)
    bad = array[(array <= 0.0) | (array >= 0.5 * np.pi)]
    if bad.size:
        worst = float(bad[0])
        raise ParameterError(f"tilt must lie between 0 and π/2, got {worst!r} rad. {degrees_meant(worst)}".rstrip())
    return array


def _coefficients(tilt: FloatArray, body: RigidBody) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the coefficients of β̇² and of −w3 β̇, and the constant, in the balance of tilting."""
    s, cosine, height = np.sin(tilt), np.cos(tilt), body.height(tilt)
    square = s * (body.kappa * height + body.transverse * cosine)
    return square, body.kappa * body.c * (height + body.c * body.axial_ratio * s), body.overhang(tilt)


def _roots(square: FloatArray, linear: FloatArray, constant: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the larger and the smaller real root; the one of smaller modulus from their product."""
    discriminant = linear**2 - 4.0 * square * constant
    root = np.sqrt(np.where(discriminant >= 0.0, discriminant, np.nan))
    far = -0.5 * (linear + np.where(linear < 0.0, -root, root))
    with np.errstate(divide="ignore", invalid="ignore"):
        near = np.where(far == 0.0, 0.0, constant / far)
    first, second = far / square, np.where(np.isnan(far), np.nan, near)
    return np.maximum(first, second), np.minimum(first, second)


_STEP = 1e-30


def _stiffness(tilt: FloatArray, rate: FloatArray, spin: FloatArray, body: RigidBody) -> FloatArray:
    """Return −K dθ̈/dθ, where w1 and w3 change with the tilt as without couples."""
    s, cosine = np.sin(tilt), np.cos(tilt)
    w1 = -rate * s
    inertia = body.axial / body.transverse
    force = body.kappa * (inertia * spin - body.c * w1) * body.transverse * body.axial_ratio / body.freedom
    w1_slope = rate * cosine - inertia * spin + force / body.transverse
    spin_slope = body.c * force / body.axial
    return -_tilting(
        tilt + 1.0j * _STEP, w1 + 1.0j * _STEP * w1_slope, spin + 1.0j * _STEP * spin_slope, body
    ).imag / _STEP  # fmt: skip


def _tilting(tilt: Numbers, w1: Numbers, spin: Numbers, body: RigidBody) -> Numbers:
    """Return K θ̈ on a base at rest."""
    s = np.sin(tilt)
    forward = body.kappa * body.height(tilt) * (body.c * spin + w1) / s
    return body.overhang(tilt) + w1 * (forward + body.transverse * w1 * np.cos(tilt) / s + body.axial * spin)
