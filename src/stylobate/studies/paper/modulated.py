"""Below the critical frequency: modulated rolling, against conclusion 3."""

import math

import numpy as np
import xarray as xr

from stylobate import theory
from stylobate.engine import simulate
from stylobate.errors import Outcome
from stylobate.motions import Harmonic
from stylobate.studies.paper.findings import (
    CIRCULAR_AMPLITUDES,
    DAMPING,
    SLENDERNESS,
    Finding,
    Section,
    Verdict,
    judged,
    paper_model,
)
from stylobate.studies.starts import steady_start

_C = SLENDERNESS
_A0 = CIRCULAR_AMPLITUDES[1]
_FREQUENCIES = (1.36, 1.32)
_SEED = 20


def check_modulated() -> Section:
    """Check conclusion 3 of the paper."""
    return Section((_supercritical(), _third_kind(), _followed_down(), _survivors()), {"modulated": modulated_data()})


def modulated_data() -> xr.Dataset:
    """Return the limit cycles of (7) below θ*: tilt over one period and the path in the (A cos ψ, A sin ψ) plane."""
    fields = {}
    for k, theta in enumerate(_FREQUENCIES):
        cycle = theory.modulated_rolling(theta, _A0, c=_C, eta=DAMPING)
        steady = float(theory.steady_rolling(theta, _A0, c=_C, eta=DAMPING).upper.amplitude)
        fields[f"tau_{k}"] = (f"point_{k}", np.append(cycle.tau, cycle.period))
        for name, values in (("amplitude", cycle.amplitude / steady), ("phase", cycle.phase)):
            fields[f"{name}_{k}"] = (f"point_{k}", np.append(values, values[0]))
        fields[f"steady_phase_{k}"] = ((), float(theory.steady_rolling(theta, _A0, c=_C, eta=DAMPING).upper.phase))
    return xr.Dataset(fields, attrs={"theta": list(_FREQUENCIES), "a0": _A0})


def _supercritical() -> Finding:
    values = theory.first_lyapunov_coefficient(np.array(CIRCULAR_AMPLITUDES), c=_C, eta=DAMPING)
    crossing = theory.crossing_frequency(np.array(CIRCULAR_AMPLITUDES), c=_C, eta=DAMPING)
    return Finding(
        "after (8)",
        "Below the boundary the rolling is unstable.",
        f"It is lost in a Hopf bifurcation at the frequency {crossing[0]:.4f} (a0 = 0.02) and {crossing[1]:.4f} "
        f"(a0 = 0.065), not slow; first Lyapunov coefficient {values[0]:.2f} and {values[1]:.2f} (state μ/c, ω, A/c, "
        "ψ): supercritical, so a stable modulated rolling takes over below θ*.",
        judged(bool(np.all(values < 0.0)), Verdict.SHARPENED),
    )


def _third_kind() -> Finding:
    theta = _FREQUENCIES[0]
    motion = Harmonic.circular(acceleration=_A0, angular_frequency=theta)
    model = paper_model()
    start = steady_start(model, motion)
    tilt = (1.02 * start["tilt"][0], 1.02 * start["tilt"][1])
    run = simulate(model, motion, tilt=tilt, tilt_rate=start["tilt_rate"], duration=250.0 * motion.period, rtol=1e-7)
    steady = math.hypot(*start["tilt"])
    low, high = (run.measures.get(name, math.nan) / steady for name in ("least_tilt_late", "largest_tilt_late"))
    ranges = [theory.modulated_rolling(f, _A0, c=_C, eta=DAMPING).amplitude_range for f in _FREQUENCIES]
    return Finding(
        "conclusion 3",
        "At low frequencies there are only two outcomes: the column stands, or it overturns.",
        f"a0 = 0.065, θ = 1.36 < θ*: started 2 % off (8), after 250 periods the outcome is {run.outcome.name}, A/A+ "
        f"between {low:.2f} and {high:.2f}; as a limit cycle of (7) {ranges[0][0]:.2f} to {ranges[0][1]:.2f}, at "
        f"θ = 1.32 {ranges[1][0]:.2f} to {ranges[1][1]:.2f}. A third kind of motion: the conclusion fails.",
        judged(run.outcome is Outcome.MODULATED, Verdict.FAILS),
    )


def _followed_down() -> Finding:
    found = [float(theta) for theta in np.arange(1.39, 1.30, -0.002) if _has_cycle(float(theta))]
    lowest = min(found, default=math.nan)
    return Finding(
        "conclusion 3",
        "The same, how far down.",
        f"Followed down in steps of 0.002 at a0 = 0.065, the stable modulated rolling lives to θ = {lowest:.3f} "
        f"(θ* = {float(theory.critical_frequency(_A0, c=_C, eta=DAMPING)):.4f}); below, the column overturns or comes "
        "to rest.",
        judged(lowest < _FREQUENCIES[1], Verdict.FAILS),
    )


def _has_cycle(theta: float) -> bool:
    cycle = theory.modulated_rolling(theta, _A0, c=_C, eta=DAMPING)
    return bool(cycle.found and cycle.stable)


def _survivors() -> Finding:
    rng = np.random.default_rng(_SEED)
    model = paper_model()
    outcomes: dict[str, int] = {}
    for theta in (0.5, 0.9, 1.25):
        motion = Harmonic.circular(acceleration=_A0, angular_frequency=theta)
        for _ in range(12):
            x, y, vx, vy = rng.uniform(-0.8 * _C, 0.8 * _C, 4)
            run = simulate(
                model, motion, tilt=(x, y), tilt_rate=(vx, vy), duration=40.0 * motion.period, rtol=1e-5, rest_energy=1e-3
            )
            outcomes[run.outcome.value] = outcomes.get(run.outcome.value, 0) + 1
    told = ", ".join(f"{count} {name}" for name, count in sorted(outcomes.items(), key=lambda item: -item[1]))
    return Finding(
        "conclusion 3",
        "Whether anything else survives lower.",
        f"36 random starts at θ = 0.5, 0.9, 1.25 (a0 = 0.065, c = η = 0.1): {told}. A sample, no proof.",
        judged(set(outcomes) <= {"overturned", "at rest"}),
    )
