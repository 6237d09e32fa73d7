"""Steady rolling of a rigid column without twist at any tilt: the paper's column beyond small angles.

The constraint ω·(e3 + Z) = 0, for the axis e3 and the vertical Z, excludes twist: a rotation about a horizontal line
takes the upright column to its position. The circle of the upright base stays fixed.
"""

import numpy as np

from stylobate.theory.arguments import FloatArray, Real, not_negative, plain_results, positive
from stylobate.theory.finite_tilt import (
    FiniteTiltRolling,
    Rows,
    eigenvalues,
    no_deviation_grows,
    on_branches,
    steady_tilts,
)
from stylobate.theory.rigid_body import Numbers, RigidBody


@plain_results
def wobbling_rolling(
    nu: Real, a0: Real, *, c: Real, eta: Real, inertia_ratio: Real = 0.75, axial_ratio: Real = 0.5
) -> FiniteTiltRolling:
    r"""Compute all branches of steady rolling of a column without twist on a circling base, at any tilt.

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
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    FiniteTiltRolling
        All branches with a tilt below π/2, for the base acceleration a0 (cos ντ, sin ντ), four eigenvalues each.

    Raises
    ------
    ParameterError
        If `nu` or a number of the body is not positive, no body can have these numbers, or another argument is
        negative.

    See Also
    --------
    steady_rolling : the limit of small tilts.
    full_rolling : the same with free spin.

    Notes
    -----
    The balances along and across the lean are, with P = sin θ + c(1 − cos θ), p = dP/dθ and
    M = κP² + (1 − κ) sin²θ + κ i_a c²(1 − cos θ)²,

        p a0 cos ψ = ½ν² dM/dθ + sin θ − c cos θ,   P a0 sin ψ = ην sin²θ,

    with the paper's solution (8) as the limit; the amplitudes differ by a relative amount of order c². Wobbling rotates
    the column about its axis, at w3 = −ν(1 − cos θ), but does not let it twist.

    Examples
    --------
    >>> rolling = wobbling_rolling([1.3, 1.5], 0.065, c=0.1, eta=0.1)
    >>> print(rolling.amplitude.round(6), rolling.stable, sep="\n")
    [[0.012976 0.061037]
     [0.010745 0.050536]]
    [[False False]
     [False  True]]
    """
    body = RigidBody.checked(c, inertia_ratio, axial_ratio)
    numbers = np.broadcast_arrays(
        positive("nu", nu),
        not_negative("a0", a0),
        not_negative("eta", eta),
        body.c,
        body.kappa,
        body.axial_ratio,
    )
    shape = numbers[0].shape
    return _branches(shape, *(number.ravel() for number in numbers))


def rates(state: Numbers, nu: FloatArray, a0: FloatArray, eta: FloatArray, body: RigidBody) -> Numbers:
    """Evaluate the right-hand side of pure tilting at finite tilt, in the frame of the circular base motion.

    Parameters
    ----------
    state
        Tilt rate θ̇, rolling rate β̇, tilt angle θ > 0 [rad] and phase ψ = β − ντ, real or complex, along the first
        axis: shape (4, ...).
    nu, a0, eta
        As for `wobbling_rolling`.
    body
        The column.

    Returns
    -------
    numpy.ndarray
        Rates of the state in the same order, shape (4, ...). Not defined at θ = 0.

    See Also
    --------
    rotating_frame_rates : the limit of small tilts, (7).

    Notes
    -----
    Lagrange's equations over J0, in the notation of `wobbling_rolling`:

        K θ̈ = ½β̇² dM/dθ + sin θ − c cos θ − p a0 cos ψ − ηθ̇
        M β̈ = −θ̇β̇ dM/dθ + P a0 sin ψ − ηβ̇ sin²θ
    """
    mu, omega, tilt, psi = state
    inertia, slope = _about_vertical(tilt, body)
    tilting = 0.5 * slope * omega**2 + body.overhang(tilt) - body.height(tilt) * a0 * np.cos(psi) - eta * mu
    rolling = body.reach(tilt) * a0 * np.sin(psi) - slope * mu * omega - eta * np.sin(tilt) ** 2 * omega
    return np.stack(np.broadcast_arrays(tilting / body.rim, rolling / inertia, mu, omega - nu))


def _about_vertical(tilt: Numbers, body: RigidBody) -> tuple[Numbers, Numbers]:
    """Return M, the moment of inertia of a change of the azimuth, and dM/dθ."""
    s, fall, reach = np.sin(tilt), 1.0 - np.cos(tilt), body.reach(tilt)
    inertia = body.kappa * reach**2 + body.transverse * s**2 + body.axial * fall**2
    slope = body.kappa * reach * body.height(tilt) + body.transverse * s * np.cos(tilt) + body.axial * fall * s
    return inertia, 2.0 * slope


def _branches(
    shape: tuple[int, ...],
    nu: FloatArray,
    a0: FloatArray,
    eta: FloatArray,
    c: FloatArray,
    kappa: FloatArray,
    axial_ratio: FloatArray,
) -> FiniteTiltRolling:
    bodies = RigidBody(c=c, kappa=kappa, axial_ratio=axial_ratio)

    def balance(tilt: FloatArray, rows: Rows) -> tuple[FloatArray, FloatArray]:
        body, rate = bodies[rows], nu[rows]
        _, slope = _about_vertical(tilt, body)
        along = (0.5 * slope * rate**2 + body.overhang(tilt)) / body.height(tilt)
        return along, eta[rows] * rate * np.sin(tilt) ** 2 / body.reach(tilt)

    tilts = steady_tilts(balance, a0, c / (1.0 + nu**2), eta == 0.0)
    exists = np.isfinite(tilts)
    rows, tilt = np.nonzero(exists)[0], tilts[exists]
    along, across = balance(tilt, rows)
    phase, body = np.arctan2(across, along), bodies[rows]
    moved = -kappa[rows] * nu[rows] ** 2 * body.reach(tilt)
    state = np.stack([np.zeros_like(tilt), nu[rows], tilt, phase])
    growth = eigenvalues(lambda x: rates(x, nu[rows], a0[rows], eta[rows], body), state)
    stable = np.zeros(exists.shape, dtype=np.bool_)
    stable[exists] = no_deviation_grows(growth, eta[rows])
    return FiniteTiltRolling(
        amplitude=on_branches(shape, exists, tilt),
        phase=on_branches(shape, exists, phase),
        spin=on_branches(shape, exists, -nu[rows] * (1.0 - np.cos(tilt))),
        friction_demand=on_branches(shape, exists, np.hypot(along + moved, across)),
        friction_moment=on_branches(shape, exists, across),
        exists=exists.reshape(*shape, -1),
        stable=stable.reshape(*shape, -1),
        eigenvalues=on_branches(shape, exists, growth),
    )
