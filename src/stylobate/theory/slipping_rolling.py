"""Steady rolling with slip of a rigid column on a circularly moving base."""

from dataclasses import dataclass

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
from stylobate.theory.finite_tilt import Rows, eigenvalues
from stylobate.theory.rigid_body import Numbers, RigidBody
from stylobate.theory.slipping_balance import STATES, Forced, Resistances, rates, solutions


@dataclass(frozen=True, slots=True, kw_only=True)
class SlippingRolling:
    """All branches of steady rolling with slip: arrays of the broadcast shape and a last axis for the branches.

    The branches are in the order of increasing tilt. The axis has the maximum number of branches, at least 1; NaN (and
    False) where there are fewer. The normal force equals the weight in all branches.

    Parameters
    ----------
    amplitude
        Tilt angle θ [rad], between 0 and π/2.
    phase
        Phase ψ by which the contact point leads the base acceleration [rad], in (−π, π].
    spin
        Axial angular velocity w3, in units of ω0.
    slip_along, slip_across
        Velocity of the contact point of the body on the base, along the lean and across it, in units of hω0.
    slip_power
        Power dissipated by slip, including pivoting on a patch, over m g h ω0; positive.
    exists
        Whether there is such a solution.
    stable
        Whether all deviations decay; with slip friction alone, all except the deviation of the spin, which is
        arbitrary.
    eigenvalues
        Eigenvalues of the Jacobian, complex, along one more axis of length 7 after that of the branches; with infinite
        `zeta` six, and −∞.
    """

    amplitude: FloatArray
    phase: FloatArray
    spin: FloatArray
    slip_along: FloatArray
    slip_across: FloatArray
    slip_power: FloatArray
    exists: BoolArray
    stable: BoolArray
    eigenvalues: ComplexArray


@plain_results
def slipping_rolling(
    nu: Real,
    a0: Real,
    *,
    mu: Real,
    c: Real,
    eta: Real,
    zeta: Real,
    patch: Real = 0.0,
    spin: Real = 0.0,
    inertia_ratio: Real = 0.75,
    axial_ratio: Real = 0.5,
) -> SlippingRolling:
    """Compute all branches of steady rolling with slip of a rigid column on a circling base, at any tilt.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a0
        Acceleration amplitude of the base [g].
    mu
        Coefficient of friction μ of the contact, positive.
    c
        Slenderness.
    eta
        Damping η, a couple against the rate of tilt.
    zeta
        Spin damping ζ, a moment against rotation about the vertical. An infinite ζ excludes this rotation. ζ = 0 with
        damping η allows steady rolling only on a patch.
    patch
        Radius of the contact patch, in units of the radius of the base, whose friction resists pivoting (Coulomb and
        Contensou, after Zhuravlev, for Hertz pressure); 0 is a point contact without this resistance.
    spin
        Axial angular velocity [ω0], used only if slip of a point contact is the only resistance and the spin is
        arbitrary.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    SlippingRolling
        All branches with a tilt below π/2, for the base acceleration a0 (cos ντ, sin ντ).

    Raises
    ------
    ParameterError
        If `nu`, `mu` or a number of the body is not positive, no body can have these numbers, `spin` is not finite, or
        another argument is negative.

    See Also
    --------
    full_rolling : the same without slip, with its friction demand.
    rolling_required_friction : this friction demand of a slender column, in closed form.

    Notes
    -----
    The contact bears the weight, and the moments about the centre of mass give the friction force, with p = cos θ + c
    sin θ

        pT_d = sin θ − c cos θ + ν sin θ ((1 − κ)ν cos θ − I_a w3),   pT_n = −ην sin θ cos θ,

    and the moment about the vertical, ηνc sin θ/p, as without slip. For a point contact |T| = μ is an equation for the
    tilt alone: **the tilt does not depend on the base acceleration**. To leading order in c, without damping η,

        θ = (c ± μ)/(1 + (1 − κ)ν²),   T_d = ±μ,

    and the slip velocity is opposite to T, with U = κν|v| and w = c w3 − ν sin θ

        U² + 2Uκνw T_n/μ + (T_d − κνw)² + T_n² = a0².

    One or no such U > 0 exists: a0 must exceed the base acceleration of rolling without slip at that tilt. Without η,
    T_n = 0, the contact point slips along the lean, and the solution with T_d = ±μ exists where its tilt lies between
    those of the two branches without slip, (c ± a0)/(1 + ν²).

    So a branch without slip meets a branch with slip when its `friction_demand` passes μ, for weak η in one of two
    ways.

    * T_d < 0, the contact pulls the column inwards, at high frequency for a0 < κc/(1 − κ): the branch with slip is a
      saddle at *larger* μ and ends on the lower branch without slip. Both vanish at the friction demand. For smaller μ
      no steady rolling exists nearby: the column slips, and all integrated columns landed flat on their base.
    * T_d > 0, the contact pushes outwards, under strong shaking: rolling with slip continues at smaller μ. It begins
      with an oscillatory instability and is stable from some percent, up to a fifth, below the friction demand.

    With c = 0.1, η = 0.1 and a0 = 0.065 rolling without slip and without spin is stable from ν = 1.40 and needs a
    friction of 0.022 at ν = 1.5, 0.047 at 3, 0.057 at 8: for μ = 0.05 it ends at ν = 3.58. With ζ = 0.1 it is stable
    from 1.04 and needs 0.059, 0.076 and 0.081: for μ = 0.05 it ends at 1.23. No rolling with slip is stable in either
    case.

    **Slip isolates.** For a0 ≫ μ and a0 ≫ c the column moves like the paper's column on a base of acceleration μ, but
    turns about its centre of mass: `steady_rolling` with ν√(1 − κ), μ and η/√(1 − κ) for ν, a0 and η. Its critical
    frequency is `critical_frequency` of these values over √(1 − κ). A solid cylinder rolls stably, with θ = (c + μ)/(1
    + ν²/4), from about ν = 2ν*(μ) upwards for any a0, even if rolling without slip would be unstable. At finite a0 slip
    changes its direction as the column moves; without η and without spin, stability begins at ν² = (1 + 2μ/c)/(1 − κ),
    where θ = c/2, for every a0 (found numerically).

    A patch that turns has no threshold of slip: it slips slowly and keeps nearly all of its pivoting moment. Rolling is
    then close to rolling without slip, and stable even for ζ = 0, within two limits of μ. For too large μ the patch
    sticks (`full_rolling` with infinite ζ); below a fold with the slipping branch no such rolling exists.

    On a patch two equations in ω_z and |v| remain, solved by a scan and Newton's method. This may miss a pair of
    solutions next to a fold, for two or three columns in a thousand.

    Examples
    --------
    >>> found = slipping_rolling(3.0, 0.5, mu=0.05, c=0.1, eta=0.1, zeta=float("inf"))
    >>> print(found.amplitude.round(4), found.slip_along.round(3), found.stable)
    [0.0154 0.0456] [ 0.216 -0.118] [False  True]
    """
    body = RigidBody.checked(c, inertia_ratio, axial_ratio)
    numbers = np.broadcast_arrays(
        positive("nu", nu),
        not_negative("a0", a0),
        positive("mu", mu),
        not_negative("eta", eta),
        not_negative_or_infinite("zeta", zeta),
        not_negative("patch", patch) * body.c,
        finite("spin", spin),
        body.c,
        body.kappa,
        body.axial_ratio,
    )
    shape = numbers[0].shape
    nu, a0, mu, eta, free, radius, spin, c, kappa, axial = (number.ravel() for number in numbers)
    frictions = Resistances(eta=eta, zeta=free, mu=mu, patch=radius)
    forced = Forced(nu, a0, spin, frictions, RigidBody(c=c, kappa=kappa, axial_ratio=axial))
    return _described(shape, forced, *solutions(forced))


def _described(
    shape: tuple[int, ...], forced: Forced, rows: Rows, tilt: FloatArray, turn: FloatArray, speed: FloatArray
) -> SlippingRolling:
    here, count = forced[rows], len(forced.nu)
    w3 = here.axial_spin(tilt, turn)
    t_d, t_n = here.force(tilt, turn)
    size = np.hypot(t_d, t_n)
    v_d, v_n = -speed * t_d / size, -speed * t_n / size
    slid = here.body.kappa * here.nu
    phase = np.arctan2(slid * v_d - t_n, t_d - here.carried(tilt, turn) + slid * v_n)
    state = np.stack([np.zeros_like(tilt), here.nu, tilt, phase, w3, v_d, v_n])
    growth = _eigenvalues(state, here)
    held = np.isinf(here.friction.zeta)
    pivoting = np.where(held, 0.0, here.moment(tilt) + np.where(held, 0.0, here.resistance) * turn)
    exists, place = _placed(rows, count)

    def spread(values: Numbers) -> Numbers:
        ordered = np.full((*exists.shape, *values.shape[1:]), np.nan, dtype=values.dtype)
        ordered[rows, place] = values
        return ordered.reshape(*shape, *ordered.shape[1:])

    stable = np.zeros(exists.shape, dtype=np.bool_)
    stable[rows, place] = _decays(growth, here.undecided)
    return SlippingRolling(
        amplitude=spread(tilt),
        phase=spread(phase),
        spin=spread(w3),
        slip_along=spread(v_d),
        slip_across=spread(v_n),
        slip_power=spread(size * speed - pivoting * turn),
        exists=exists.reshape(*shape, -1),
        stable=stable.reshape(*shape, -1),
        eigenvalues=spread(growth),
    )


def _placed(rows: Rows, count: int) -> tuple[BoolArray, Rows]:
    """Return the mask of solutions among the branches, and the index of each solution in its row."""
    many = np.bincount(rows, minlength=count)
    place = np.arange(len(rows)) - (np.cumsum(many) - many)[rows]
    exists: BoolArray = np.arange(max(1, int(many.max(initial=0)))) < many[:, np.newaxis]
    return exists, place


def _decays(growth: ComplexArray, undecided: BoolArray) -> BoolArray:
    """Return whether all deviations decay, except the deviation of an arbitrary spin, whose growth is next to zero."""
    order = np.argsort(np.abs(growth), axis=-1)
    parts = np.take_along_axis(growth.real, order, axis=-1)
    parts[undecided, 0] = -1.0
    return np.asarray(parts.max(axis=-1, initial=-np.inf) < 0.0)


_SPIN = 4


def _eigenvalues(state: FloatArray, forced: Forced) -> ComplexArray:
    """Return the seven eigenvalues of each state; six, and −∞ for the spin, where it follows the rolling at once."""
    out = np.full((state.shape[1], STATES), -np.inf, dtype=np.complex128)
    held = np.isinf(forced.friction.zeta)
    if not held.all():
        free = forced[np.flatnonzero(~held)]
        out[~held] = eigenvalues(lambda x: rates(x, free.nu, free.a0, free.friction, free.body), state[:, ~held])
    if held.any():
        some = forced[np.flatnonzero(held)]

        def without_spin(reduced: Numbers) -> Numbers:
            spin = -reduced[1] * np.sin(reduced[2]) * np.tan(reduced[2])  # ω·Z = 0
            whole = np.concatenate([reduced[:_SPIN], spin[np.newaxis], reduced[_SPIN:]])
            return np.delete(rates(whole, some.nu, some.a0, some.friction, some.body), _SPIN, axis=0)

        out[held, :-1] = eigenvalues(without_spin, np.delete(state[:, held], _SPIN, axis=0))
    return out
