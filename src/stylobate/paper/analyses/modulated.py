"""Modulated rolling below the critical frequency, which contradicts conclusion 3."""

import math
from typing import Any

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from stylobate import theory
from stylobate.base_motions import Harmonic
from stylobate.engine import simulate
from stylobate.errors import Outcome
from stylobate.paper.analyses.setting import CIRCULAR_AMPLITUDES, DAMPING, SLENDERNESS, judged, paper_model
from stylobate.results.findings import ClaimStatus, Finding, PaperSection
from stylobate.studies.responses.response_curves import steady_start

_C = SLENDERNESS
_A0 = CIRCULAR_AMPLITUDES[1]
_FREQUENCIES = (1.38, 1.36, 1.33)
"""ν of the plotted cycles, all stable."""

_BEYOND_DOUBLING = 1.318
_SEED = 20


def check_modulated() -> PaperSection:
    """Check conclusion 3 of the paper."""
    return PaperSection(
        (_supercritical(), _third_kind(), _followed_down(), _survivors()), {"modulated": modulated_data()}
    )


def modulated_data() -> xr.Dataset:
    """Compute the limit cycles of (7) below ν*: tilt over one period and the path in the (θ cos ψ, θ sin ψ) plane."""
    fields: dict[str, Any] = {}
    for k, nu in enumerate(_FREQUENCIES):
        cycle = theory.modulated_rolling(nu, _A0, c=_C, eta=DAMPING)
        steady = float(theory.steady_rolling(nu, _A0, c=_C, eta=DAMPING).upper.amplitude)
        fields[f"tau_{k}"] = (f"point_{k}", np.append(cycle.tau, cycle.period))
        for name, values in (("amplitude", cycle.amplitude / steady), ("phase", cycle.phase)):
            fields[f"{name}_{k}"] = (f"point_{k}", np.append(values, values[0]))
        fields[f"steady_phase_{k}"] = ((), float(theory.steady_rolling(nu, _A0, c=_C, eta=DAMPING).upper.phase))
    return xr.Dataset(fields, attrs={"nu": list(_FREQUENCIES), "a0": _A0})


def _supercritical() -> Finding:
    values = theory.first_lyapunov_coefficient(np.array(CIRCULAR_AMPLITUDES), c=_C, eta=DAMPING)
    crossing = theory.crossing_frequency(np.array(CIRCULAR_AMPLITUDES), c=_C, eta=DAMPING)
    return Finding(
        "after (8)",
        "Below the boundary the rolling is unstable.",
        "It is lost in a Hopf bifurcation: the tilt begins to oscillate, at a frequency near that of the base, "
        f"{crossing[0]:.4f} (a0 = 0.02) or {crossing[1]:.4f} (a0 = 0.065). The first Lyapunov coefficient is "
        f"{values[0]:.2f} and {values[1]:.2f} (state θ̇/c, β̇, θ/c, ψ): supercritical, so a stable modulated rolling "
        "exists below ν*.",
        judged(bool(np.all(values < 0.0)), ClaimStatus.SHARPENED),
    )


def _third_kind() -> Finding:
    nu = _FREQUENCIES[1]
    motion = Harmonic.circular(acceleration=_A0, angular_frequency=nu)
    model = paper_model()
    start = steady_start(model, motion)
    tilt = (1.02 * start["tilt"][0], 1.02 * start["tilt"][1])
    run = simulate(model, motion, tilt=tilt, tilt_rate=start["tilt_rate"], duration=150.0 * motion.period, rtol=1e-7)
    steady = math.hypot(*start["tilt"])
    low, high = (run.measures.get(name, math.nan) / steady for name in ("minimum_tilt_late", "peak_tilt_late"))
    ranges = [theory.modulated_rolling(nu, _A0, c=_C, eta=DAMPING).amplitude_range]
    return Finding(
        "conclusion 3",
        "At low frequencies there are only two outcomes: the column stands, or it overturns.",
        f"a0 = 0.065, ν = 1.36 < ν*: started 2 % off (8), after 150 periods the outcome is {run.outcome.name}, θ/θ+ "
        f"between {low:.2f} and {high:.2f}; as a limit cycle of (7) {ranges[0][0]:.2f} to {ranges[0][1]:.2f}. "
        "This is a third kind of motion, so the conclusion does not hold.",
        judged(run.outcome is Outcome.MODULATED, ClaimStatus.DOES_NOT_HOLD),
    )


def _followed_down() -> Finding:
    doubling = brentq(_least_multiplier, _BEYOND_DOUBLING, _FREQUENCIES[-1], xtol=1e-6)
    lost, lowest = _lost_below(_FREQUENCIES[-1])
    critical = float(theory.critical_frequency(_A0, c=_C, eta=DAMPING))
    return Finding(
        "conclusion 3",
        "The same: how far below the boundary.",
        f"Followed down from ν* = {critical:.4f} at a0 = 0.065: at ν = {doubling:.4f} a multiplier of the cycle passes "
        "−1 and its period doubles; the doubled and then irregular modulation, followed by integration in steps of "
        f"0.002, persists at ν = {lowest:.3f} and is lost at {lost:.3f}, where the column overturns.",
        judged(lost < doubling, ClaimStatus.DOES_NOT_HOLD),
    )


def _least_multiplier(nu: float) -> float:
    """Return the minimum real part of the cycle's multipliers plus one: zero at the period doubling."""
    return float(theory.modulated_rolling(nu, _A0, c=_C, eta=DAMPING).multipliers.real.min()) + 1.0


def _lost_below(nu: float) -> tuple[float, float]:
    """Return the overturning frequency of a slow descent from `nu`, and the last frequency without overturning."""
    model = paper_model()
    cycle = theory.modulated_rolling(nu, _A0, c=_C, eta=DAMPING)
    tilt, psi, mu, omega = (
        float(part[0]) for part in (cycle.amplitude, cycle.phase, cycle.tilt_rate, cycle.rolling_rate)
    )
    ux, uy = math.cos(psi), math.sin(psi)
    state = (tilt * ux, tilt * uy), (mu * ux - tilt * omega * uy, mu * uy + tilt * omega * ux)
    lowest = math.nan
    for frequency in np.arange(nu, nu - 0.03, -0.002):
        motion = Harmonic.circular(acceleration=_A0, angular_frequency=float(frequency))
        run = simulate(model, motion, tilt=state[0], tilt_rate=state[1], duration=100.0 * motion.period, rtol=1e-7)
        if run.outcome is Outcome.OVERTURNED:
            return float(frequency), lowest
        lowest = float(frequency)
        end = run.data.isel(time=-1)
        state = tuple(end["tilt"].to_numpy()), tuple(end["tilt_rate"].to_numpy())
    return math.nan, lowest


def _survivors() -> Finding:
    rng = np.random.default_rng(_SEED)
    model = paper_model()
    cases = ((0.02, 0.5), (0.02, 0.8), (0.065, 0.9), (0.065, 1.25))
    outcomes: dict[str, int] = {}
    for a0, nu in cases:
        motion = Harmonic.circular(acceleration=a0, angular_frequency=nu)
        for _ in range(8):
            x, y, vx, vy = rng.uniform(-0.5 * _C, 0.5 * _C, 4)
            run = simulate(
                model,
                motion,
                tilt=(x, y),
                tilt_rate=(vx, vy),
                duration=50.0 * motion.period,
                rtol=1e-5,
                rest_energy=1e-3,
            )
            outcomes[run.outcome.label] = outcomes.get(run.outcome.label, 0) + 1
    counts_text = ", ".join(f"{count} {name}" for name, count in sorted(outcomes.items(), key=lambda item: -item[1]))
    return Finding(
        "conclusion 3",
        "The same at lower frequencies, where no third motion was found.",
        f"32 random starts at (a0, ν) = (0.02, 0.5), (0.02, 0.8), (0.065, 0.9), (0.065, 1.25), c = η = 0.1: "
        f"{counts_text}. "
        "This is a sample, not a proof.",
        judged(set(outcomes) <= {"overturned", "at rest"}),
    )
