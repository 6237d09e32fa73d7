"""Steady rolling of a slender column with free spin.

The paper excludes rotation about the vertical. Damping makes a column with free spin lag behind the base. The lag
leaves a component of the base acceleration across the lean, which spins the column up until the spin damping ζ balances
it. The equations describe rolling without slip in the limit of small tilts, in the frame that turns with the base.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import (
    BoolArray,
    ComplexArray,
    FloatArray,
    Real,
    Truths,
    Values,
    not_negative,
    not_negative_or_infinite,
    plain_results,
    positive,
)
from stylobate.theory.finite_tilt import no_deviation_grows
from stylobate.theory.rolling import rolling_amplitudes
from stylobate.theory.rotating_frame import rotating_frame_jacobian

_STATES = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeTwistRolling:
    """Steady rolling with free spin, arrays of one shape; NaN (and False) where there is none.

    Parameters
    ----------
    amplitude
        Tilt angle θ [rad].
    phase
        Phase ψ by which the contact point leads the base acceleration [rad].
    spin
        Axial angular velocity σ, in units of ω0.
    friction_moment
        Moment of the spin damping about the vertical, over m g r; with infinite `zeta` the moment that excludes
        rotation.
    exists
        Whether there is such a solution.
    stable
        Whether all deviations decay; without damping, whether none grows.
    eigenvalues
        The five eigenvalues of the Jacobian, complex, along a last axis of length 5. For infinite `zeta` the spin
        follows at once: the four eigenvalues of the paper's column, and −∞.
    """

    amplitude: Values
    phase: Values
    spin: Values
    friction_moment: Values
    exists: Truths
    stable: Truths
    eigenvalues: ComplexArray


@plain_results
def free_twist_rolling(
    nu: Real,
    a0: Real,
    *,
    c: Real,
    eta: Real,
    zeta: Real,
    inertia_ratio: Real = 0.75,
    axial_ratio: Real = 0.5,
) -> FreeTwistRolling:
    """Compute steady rolling with free spin on a base that moves in a circle, upper branch.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η, a couple against the rate of tilt.
    zeta
        Spin damping ζ, a moment about the vertical by which a free spin decays at the rate ζω0. An infinite ζ excludes
        the rotation, as the paper does. ζ = 0 with damping η allows no steady rolling.
    inertia_ratio
        κ = m h²/J0; ¾ for a solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    FreeTwistRolling
        Arrays of the broadcast shape, for the base acceleration a0 (cos ντ, sin ντ).

    Raises
    ------
    ParameterError
        If `nu`, `c`, `inertia_ratio` or `axial_ratio` is not positive, `inertia_ratio` is 1 or more, or another is
        negative.

    See Also
    --------
    steady_rolling : the same without spin.

    Notes
    -----
    With Λ = 1 + i_a − κ, the three balances, along the lean, across it and about the axis, give

        a0 cos ψ = θ(1 + ν²(1 + η/(ζΛ))) − c,   a0 sin ψ = ηνθ,   σ = −ηνθ/(cζκΛ):

    the paper's solution (8) with ν² replaced by ν²(1 + η/(ζΛ)) in the first balance. The column rolls at a smaller tilt
    and spins against its rolling. The contact bears the moment m r a_n about the vertical, where a_n = g ηνθ is the
    base acceleration across the lean. At η = ζ = 0 the spin is arbitrary and set to 0.

    Examples
    --------
    >>> rolling = free_twist_rolling(3.0, 0.065, c=0.1, eta=0.1, zeta=[0.1, 1.0, float("inf")])
    >>> print(rolling.amplitude.round(7), rolling.spin.round(5))
    [0.0074982 0.0147187 0.0164812] [-0.39991 -0.0785   0.     ]
    """
    numbers = checked_numbers(nu, a0, c, eta, zeta, inertia_ratio, axial_ratio)
    nu, a0, c, eta, zeta, ratio, axial = numbers
    freedom = 1.0 + axial - ratio  # Λ
    with np.errstate(divide="ignore", invalid="ignore"):
        lag = np.where(eta > 0.0, eta / (zeta * freedom), 0.0)
    exists = np.isfinite(lag)
    k, drag = 1.0 + nu**2 * (1.0 + np.where(exists, lag, 0.0)), eta * nu
    scaled, _, _ = rolling_amplitudes(k, drag, a0 / c)
    scaled = np.where(exists, scaled, np.nan)
    exists = np.isfinite(scaled)
    phase = np.arctan2(drag * scaled, k * scaled - 1.0)
    spin = np.where(exists, -lag * nu * scaled / ratio + 0.0, np.nan)
    state = np.stack([np.zeros_like(scaled), nu, c * scaled, phase, spin])
    eigenvalues = _eigenvalues(state, exists, numbers)
    with np.errstate(invalid="ignore"):  # NaN, where there is no rolling, passes through
        stable = no_deviation_grows(eigenvalues, eta)
    return FreeTwistRolling(
        amplitude=c * scaled,
        phase=phase,
        spin=spin,
        friction_moment=c * drag * scaled,
        exists=exists,
        stable=stable & exists,
        eigenvalues=eigenvalues,
    )


def free_twist_jacobian(
    state: Real, a0: Real, *, c: Real, eta: Real, zeta: Real, inertia_ratio: Real = 0.75, axial_ratio: Real = 0.5
) -> FloatArray:
    """Evaluate the Jacobian of rolling with free spin at any state, in the frame that turns with the base motion.

    Parameters
    ----------
    state
        Tilt rate θ̇, rolling rate β̇, tilt angle θ > 0 [rad], phase ψ = β − ντ and spin σ [ω0], along the first axis:
        shape (5, ...).
    a0, c, eta, zeta, inertia_ratio, axial_ratio
        As for `free_twist_rolling`; `zeta` finite.

    Returns
    -------
    numpy.ndarray
        Matrices along the last two axes, shape (..., 5, 5). ν does not enter.

    Raises
    ------
    ParameterError
        If the first axis of `state` does not have five entries.

    Notes
    -----
    With Λ = 1 + i_a − κ:

        θ̈ = θ(1 + β̇²) − c − ηθ̇ − a0 cos ψ − cκσβ̇
        θβ̈ = −2θ̇β̇ − η(1 + i_a)θβ̇/Λ + a0 sin ψ i_a/Λ − cκζσ
        σ̇ = −a0 sin ψ (1 − κ)/(cκΛ) − ηθβ̇/(cΛ) − ζσ
    """
    mu, omega, tilt, psi, spin = _components(state)
    a, slender, friction, decay, kappa, i_a = _arrays(a0, c, eta, zeta, inertia_ratio, axial_ratio)
    push, drive = a * np.cos(psi), a * np.sin(psi)
    freedom = 1.0 + i_a - kappa
    drag = friction * (1.0 + i_a) / freedom
    by_tilt = (2.0 * mu * omega - drive * i_a / freedom + slender * kappa * decay * spin) / tilt**2
    rows = (
        (-friction, 2.0 * tilt * omega - slender * kappa * spin, 1.0 + omega**2, drive, -slender * kappa * omega),
        (
            -2.0 * omega / tilt,
            -2.0 * mu / tilt - drag,
            by_tilt,
            push * i_a / (freedom * tilt),
            -slender * kappa * decay / tilt,
        ),
        (1.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 1.0, 0.0, 0.0, 0.0),
        (
            0.0,
            -friction * tilt / (slender * freedom),
            -friction * omega / (slender * freedom),
            -push * (1.0 - kappa) / (slender * kappa * freedom),
            -decay,
        ),
    )
    entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
    matrices = np.stack(entries, axis=-1)
    return matrices.reshape(*matrices.shape[:-1], _STATES, _STATES)


def checked_numbers(
    nu: Real, a0: Real, c: Real, eta: Real, zeta: Real, ratio: Real, axial: Real
) -> tuple[FloatArray, ...]:
    """Return the arguments of `free_twist_rolling` as arrays of one shape, or raise ParameterError."""
    kappa = positive("inertia_ratio", ratio)
    if np.any(kappa >= 1.0):
        message = f"inertia_ratio = m h²/J0 must be below 1, got {np.max(kappa)!r}"
        raise ParameterError(message)
    arrays = (
        positive("nu", nu),
        not_negative("a0", a0),
        positive("c", c),
        not_negative("eta", eta),
        not_negative_or_infinite("zeta", zeta),
        kappa,
        positive("axial_ratio", axial),
    )
    return tuple(np.broadcast_arrays(*arrays))


def _eigenvalues(state: FloatArray, exists: BoolArray, numbers: tuple[FloatArray, ...]) -> ComplexArray:
    """Return the eigenvalues of each solution, NaN elsewhere; −∞ for a spin that follows at once."""
    _, a0, c, eta, zeta, ratio, axial = numbers
    out = np.full((*exists.shape, _STATES), np.nan, dtype=np.complex128)
    held = np.isinf(zeta)
    free = exists & ~held
    if free.any():
        same = {"c": c, "eta": eta, "zeta": zeta, "inertia_ratio": ratio, "axial_ratio": axial}
        chosen = {name: values[free] for name, values in same.items()}
        out[free] = np.linalg.eigvals(free_twist_jacobian(state[:, free], a0[free], **chosen))
    fixed = exists & held
    if fixed.any():
        mu, omega, tilt, psi, _ = (part[fixed] for part in state)
        from_paper = rotating_frame_jacobian(np.stack([mu, omega, tilt, psi]), a0[fixed], eta=eta[fixed])
        out[fixed, : _STATES - 1] = np.linalg.eigvals(from_paper)
        out[fixed, _STATES - 1] = -np.inf
    return out


def _arrays(*values: Real) -> tuple[FloatArray, ...]:
    return tuple(np.asarray(value, dtype=np.float64) for value in values)


def _components(state: Real) -> tuple[FloatArray, ...]:
    array = np.asarray(state, dtype=np.float64)
    if array.ndim == 0 or len(array) != _STATES:
        message = f"state must have the five entries (θ̇, β̇, θ, ψ, σ) along its first axis, got the shape {array.shape}"
        raise ParameterError(message)
    return tuple(array)
