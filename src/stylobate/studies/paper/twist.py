"""What the paper's assumption that the column cannot turn about the vertical is worth."""

import math

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from stylobate import theory
from stylobate.column import Column
from stylobate.engine import simulate
from stylobate.errors import Outcome
from stylobate.models import SlenderRolling
from stylobate.motions import Harmonic
from stylobate.results import Finding, Response, Section, Verdict
from stylobate.studies.paper.setting import CIRCULAR_AMPLITUDES, DAMPING, SLENDERNESS, judged

_C = SLENDERNESS
_A0 = CIRCULAR_AMPLITUDES[1]
_THETA = 3.0
_SPIN_FRICTIONS = (math.inf, 1.0, 0.3, 0.1, 0.03)
"""ζ of the curves drawn."""

_PERIODS, _PERIODS_WITHOUT = 300, 15
_GONE = 0.01
"""Tilt that counts as none [c]."""

# The slowest deviation decays by exp(−0.0254 τ), 1e-7 in all these periods.
_SETTLED = 1e-4


def check_twist() -> Section:
    """Check what the assumption of no rotation about the vertical needs, and what becomes of (8) without it."""
    return Section((_needed(), _with_spin_friction(), _without(), _stability()), {"twist": twist_data()})


def twist_data() -> xr.Dataset:
    """Return steady rolling with a free twist against frequency, for several spin frictions."""
    theta, zeta = np.linspace(0.5, 4.0, 281), np.array(_SPIN_FRICTIONS)
    found = _steady(theta[np.newaxis], zeta[:, np.newaxis])
    dims = ("zeta", "theta")
    fields = {name: (dims, getattr(found, name)) for name in ("amplitude", "spin", "friction_moment", "stable")}
    return xr.Dataset(fields, coords={"zeta": zeta, "theta": theta}, attrs={"a0": _A0, "c": _C})


def _steady(theta: object, zeta: object) -> theory.FreeTwistRolling:
    return theory.free_twist_rolling(theta, _A0, c=_C, eta=DAMPING, zeta=zeta)  # type: ignore[arg-type]


def _run_from_paper(zeta: float, periods: float) -> Response:
    """Return the motion of a column that may turn, begun on the paper's solution (8) without spin."""
    motion = Harmonic.circular(acceleration=_A0, angular_frequency=_THETA)
    model = SlenderRolling(Column.dimensionless(_C), damping=DAMPING, spin_friction=zeta)
    branch = theory.steady_rolling(_THETA, _A0, c=_C, eta=DAMPING).upper
    size, psi = float(branch.amplitude), float(branch.phase)
    x, y = size * math.cos(psi), size * math.sin(psi)
    rate = (-_THETA * y, _THETA * x)
    return simulate(model, motion, tilt=(x, y), tilt_rate=rate, duration=periods * motion.period, rest_energy=0.0)


def _needed() -> Finding:
    held = _steady(_THETA, math.inf)
    moment = float(held.friction_moment)
    expected = DAMPING * _THETA * float(held.amplitude)
    return Finding(
        "before (1)",
        "The column cannot rotate about the vertical.",
        "On (8) the contact must bear the moment m r a_n about the vertical, a_n = g η θ A: at a0 = 0.065, θ = 3 it is "
        f"{100.0 * moment:.2f} % of weight times radius. A small contact patch can give that, a point cannot.",
        judged(math.isclose(moment, expected, rel_tol=1e-12), Verdict.LIMITED),
    )


def _with_spin_friction() -> Finding:
    zeta = 0.1
    known, paper = _steady(_THETA, zeta), _steady(_THETA, math.inf)
    run = _run_from_paper(zeta, _PERIODS)
    tilt = float(np.hypot(*run.data["tilt"].to_numpy()[-1]))
    off = abs(tilt / float(known.amplitude) - 1.0)
    return Finding(
        "(8)",
        "Steady rolling at the tilt A.",
        "With a free twist and spin friction ζ it is (8) with θ² replaced by θ²(1 + η/(ζD)) in a0 cos ψ = A(1+θ²) − c, "
        "D = 1 + i_a − κ: the column spins at σ = −ηθA/(cζκD) and leans less. Solid cylinder, ζ = 0.1, θ = 3: "
        f"A = {float(known.amplitude):.5f} instead of {float(paper.amplitude):.5f}, σ = {float(known.spin):.4f}; "
        f"integration begun on (8) gives A = {tilt:.5f} after {_PERIODS} periods.",
        judged(off < _SETTLED and run.outcome is not Outcome.OVERTURNED, Verdict.LIMITED),
    )


def _without() -> Finding:
    run = _run_from_paper(0.0, _PERIODS_WITHOUT)
    tilt = np.hypot(*run.data["tilt"].to_numpy().T)
    fallen = np.flatnonzero(tilt < _GONE * _C)
    when = float(run.data["time"][fallen[0]]) if fallen.size else math.nan
    spin = float(run.data["spin"][fallen[0]]) if fallen.size else math.nan
    return Finding(
        "(8)",
        "The same without any friction about the vertical.",
        "None is left: what the base gives across the lean spins the column up, and the tilt dies. Begun on (8) at "
        f"a0 = 0.065, θ = 3 it falls below {_GONE:g}c at τ = {when:.1f}, with σ = {spin:.2f}.",
        judged(bool(fallen.size), Verdict.FAILS),
    )


def _stability() -> Finding:
    without, much, little = (_critical(zeta) for zeta in (math.inf, 1.0, 0.1))
    paper = float(theory.critical_frequency(_A0, c=_C, eta=DAMPING))
    same = math.isclose(without, paper, rel_tol=1e-8)
    return Finding(
        "after (8)",
        "Rolling is stable above the critical frequency.",
        f"A free twist lowers it: at a0 = 0.065 from {paper:.4f} to {much:.4f} (ζ = 1) and {little:.4f} (ζ = 0.1), "
        "for the column leans less.",
        judged(same and little < much < paper, Verdict.SHARPENED),
    )


def _critical(zeta: float) -> float:
    """Return the frequency at which the largest real part of the eigenvalues vanishes."""

    def growth(theta: float) -> float:
        return float(_steady(theta, zeta).eigenvalues.real.max())

    grid = np.arange(2.0, 0.6, -0.05)
    unstable = next(theta for theta in grid if growth(float(theta)) > 0.0)
    return float(brentq(growth, unstable, unstable + 0.05, xtol=1e-10))
