"""Steady rolling without slip at finite tilt and with free spin, on a base that moves in a circle."""

from collections.abc import Callable

import numpy as np

from stylobate.theory.arguments import (
    BoolArray,
    ComplexArray,
    FloatArray,
    Real,
    finite,
    not_negative,
    not_negative_or_infinite,
    plain_results,
    positive,
)
from stylobate.theory.finite_tilt import (
    FiniteTiltRolling,
    eigenvalues,
    no_deviation_grows,
    on_branches,
    steady_tilts,
)
from stylobate.theory.full_rolling_rates import STATES, rates
from stylobate.theory.rigid_body import Numbers, RigidBody
from stylobate.theory.zeros import Rows


@plain_results
def full_rolling(
    nu: Real,
    a0: Real,
    *,
    c: Real,
    eta: Real,
    zeta: Real,
    spin: Real = 0.0,
    inertia_ratio: Real = 0.75,
    axial_ratio: Real = 0.5,
) -> FiniteTiltRolling:
    """Compute all branches of steady rolling without slip of a rigid column on a circling base, at any tilt.

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
        Spin damping ζ, a moment against rotation about the vertical. An infinite ζ excludes this rotation. ζ = 0 with
        damping η allows no steady rolling.
    spin
        Axial angular velocity [ω0], used only without any damping, when the spin is arbitrary.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    FiniteTiltRolling
        All branches with a tilt below π/2, for the base acceleration a0 (cos ντ, sin ντ), five eigenvalues each; for
        infinite `zeta` four, and −∞.

    Raises
    ------
    ParameterError
        If `nu` or a number of the body is not positive, no body can have these numbers, `spin` is not finite, or
        another argument is negative.

    See Also
    --------
    free_twist_rolling : the limit of small tilts.
    wobbling_rolling : the same for pure tilting, without rotation about the vertical.

    Notes
    -----
    In steady rolling the balances of the couples about the lean and about the axis give contact force and spin,

        a0 sin ψ = ην sin θ cos θ/p,   w3 = −ν sin θ (sin θ + η/(ζκcΛp))/cos θ,   p = cos θ + c sin θ

    with Λ = 1 + i_a − κ, and the balance of tilting is

        p a0 cos ψ = sin θ − c cos θ + ν² sin θ (κp + (1 − κ) cos θ) − νκc w3 (p + c i_a sin θ).

    The amplitudes are the zeros of (a0 cos ψ)² + (a0 sin ψ)² − a0²: with damping, 100 000 random columns had at most
    two, and one for a0 > c. They differ from the amplitudes of the slender column by a relative amount of order c². A
    column that rolls against its spin may lean beyond its tipping angle and be stable. Infinite spin damping gives the
    spin w3 = −ν sin θ tan θ, since it excludes rotation about the vertical, not about the axis.

    Stability follows from the exact Jacobian of all five states. Without damping and base motion the phase is
    arbitrary.

    Examples
    --------
    >>> rolling = full_rolling(3.0, 0.065, c=0.1, eta=0.1, zeta=0.1)
    >>> print(rolling.amplitude.round(7), rolling.phase.round(4), rolling.spin.round(5), rolling.stable)
    [0.0015903 0.0074953] [3.1343 0.0346] [-0.08481 -0.39964] [False  True]
    """
    body = RigidBody.checked(c, inertia_ratio, axial_ratio)
    numbers = np.broadcast_arrays(
        positive("nu", nu),
        not_negative("a0", a0),
        not_negative("eta", eta),
        not_negative_or_infinite("zeta", zeta),
        finite("spin", spin),
        body.c,
        body.kappa,
        body.axial_ratio,
    )
    shape = numbers[0].shape
    return _branches(shape, *(number.ravel() for number in numbers))


def _branches(
    shape: tuple[int, ...],
    nu: FloatArray,
    a0: FloatArray,
    eta: FloatArray,
    zeta: FloatArray,
    spin: FloatArray,
    c: FloatArray,
    kappa: FloatArray,
    axial_ratio: FloatArray,
) -> FiniteTiltRolling:
    bodies = RigidBody(c=c, kappa=kappa, axial_ratio=axial_ratio)
    with np.errstate(divide="ignore", invalid="ignore"):
        lag = np.where(eta > 0.0, eta / (zeta * bodies.freedom), 0.0)
    undecided = (eta == 0.0) & (zeta == 0.0)

    def spin_at(tilt: FloatArray, rows: Rows) -> FloatArray:
        body = bodies[rows]
        slide = lag[rows] / (body.kappa * body.c * body.height(tilt))
        settled = -nu[rows] * np.sin(tilt) * (np.sin(tilt) + slide) / np.cos(tilt)
        return np.where(undecided[rows], spin[rows], settled)

    def balance(tilt: FloatArray, rows: Rows) -> tuple[FloatArray, FloatArray]:
        body, rate = bodies[rows], nu[rows]
        s, cosine, height = np.sin(tilt), np.cos(tilt), body.height(tilt)
        turning = body.kappa * body.c * spin_at(tilt, rows) * (height + body.c * body.axial_ratio * s)
        fling = rate**2 * s * (body.kappa * height + body.transverse * cosine)
        along = (body.overhang(tilt) + fling - rate * turning) / height
        return along, eta[rows] * rate * s * cosine / height

    scale = np.where(np.isfinite(lag), c / (1.0 + nu**2 * (1.0 + lag)), np.nan)
    tilts = steady_tilts(balance, a0, scale, eta == 0.0)
    exists = np.isfinite(tilts)
    rows, tilt = np.nonzero(exists)[0], tilts[exists]
    along, across = balance(tilt, rows)
    phase, w3, body = np.arctan2(across, along), spin_at(tilt, rows), bodies[rows]
    moved = kappa[rows] * nu[rows] * (body.c * w3 - nu[rows] * np.sin(tilt))
    state = np.stack([np.zeros_like(tilt), nu[rows], tilt, phase, w3])
    growth = _eigenvalues(state, nu[rows], a0[rows], eta[rows], zeta[rows], body)
    stable = np.zeros(exists.shape, dtype=np.bool_)
    stable[exists] = no_deviation_grows(growth, eta[rows])
    return FiniteTiltRolling(
        amplitude=on_branches(shape, exists, tilt),
        phase=on_branches(shape, exists, phase),
        spin=on_branches(shape, exists, w3),
        friction_demand=on_branches(shape, exists, np.hypot(along + moved, across)),
        friction_moment=on_branches(shape, exists, across / np.cos(tilt)),
        exists=exists.reshape(*shape, -1),
        stable=stable.reshape(*shape, -1),
        eigenvalues=on_branches(shape, exists, growth),
    )


def _eigenvalues(
    state: FloatArray, nu: FloatArray, a0: FloatArray, eta: FloatArray, zeta: FloatArray, body: RigidBody
) -> ComplexArray:
    """Return the five eigenvalues of each state; four, and −∞ for the spin, where it follows the rolling at once."""

    def rates_of(chosen: BoolArray) -> Callable[[Numbers], Numbers]:
        some, of = body[chosen], tuple(number[chosen] for number in (nu, a0, eta, zeta))
        return lambda x: rates(x, of[0], of[1], of[2], of[3], some)

    out = np.full((state.shape[1], STATES), -np.inf, dtype=np.complex128)
    held = np.isinf(zeta)
    if not held.all():
        out[~held] = eigenvalues(rates_of(~held), state[:, ~held])
    if held.any():
        with_spin = rates_of(held)

        def without_spin(reduced: Numbers) -> Numbers:
            _, omega, tilt, _ = reduced
            spin = -omega * np.sin(tilt) * np.tan(tilt)  # ω·Z = 0
            return with_spin(np.concatenate([reduced, spin[np.newaxis]]))[:-1]

        out[held, :-1] = eigenvalues(without_spin, state[:-1, held])
    return out
