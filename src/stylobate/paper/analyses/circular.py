"""Circular base motion: exact rolling (8), its stability and critical frequency, and exact periodic orbits."""

import math

import numpy as np
import xarray as xr

from stylobate import theory
from stylobate.base_motions import Harmonic
from stylobate.engine import simulate
from stylobate.orbits import Bifurcation, BifurcationKind, Branch, continue_branch, periodic_orbit, switch_branch
from stylobate.paper.analyses.setting import CIRCULAR_AMPLITUDES, DAMPING, SLENDERNESS, judged, paper_model
from stylobate.paper.analyses.straight import AMPLITUDES
from stylobate.results.findings import ClaimStatus, Finding, PaperSection
from stylobate.studies.responses.exact_response import exact_response
from stylobate.studies.responses.response_curves import steady_start
from stylobate.studies.responses.stability_boundary import stability_boundary
from stylobate.theory.averaging import circular_components, rotating_frame_rates

_PARAMETERS = {"c": SLENDERNESS, "eta": DAMPING}
_PERIODS = 50


def check_circular() -> PaperSection:
    """Check the paper's section on circular base motion."""
    findings = (
        _solution(),
        _phase(),
        _stays(),
        _lower_branch(),
        _criteria_agree(),
        _critical_frequencies(),
        _undamped_limit(),
    )
    return PaperSection(findings, {"response": response_data(), "critical": critical_data()})


def response_data() -> xr.Dataset:
    """Compute the curves of Figs. 2 and 3: amplitude and phase of both branches against ν, and the backbone (5)."""
    nu = np.linspace(0.02, 4.0, 1600)
    steady = [theory.steady_rolling(nu, a0, **_PARAMETERS) for a0 in CIRCULAR_AMPLITUDES]
    dims = ("a0", "branch", "nu")
    fields = {
        name: (dims, np.array([[getattr(s.lower, name), getattr(s.upper, name)] for s in steady]))
        for name in ("amplitude", "phase", "stable")
    }
    return xr.Dataset(
        {**fields, "backbone": ("nu", theory.rolling_backbone(nu, SLENDERNESS))},
        coords={"nu": nu, "a0": list(CIRCULAR_AMPLITUDES), "branch": ["lower", "upper"]},
        attrs={**_PARAMETERS},
    )


def critical_data() -> xr.Dataset:
    """Compute ν* against a0 for several values of the damping, and its closed form without damping."""
    a0 = np.linspace(1e-4, 0.3, 400)
    etas = [0.1, 0.3, 0.5, 1.0]
    nu = np.array([theory.critical_frequency(a0, c=SLENDERNESS, eta=eta) for eta in etas])
    closed = theory.undamped_critical_frequency(a0, c=SLENDERNESS)
    return xr.Dataset(
        {"nu": (("eta", "a0"), nu), "undamped": ("a0", closed)},
        coords={"a0": a0, "eta": etas},
        attrs={"c": SLENDERNESS},
    )


def _grid() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    nu, a0, eta = np.meshgrid(
        np.linspace(0.05, 6.0, 120), np.linspace(0.002, 0.3, 60), [0.01, 0.1, 0.3, 1.0], indexing="ij"
    )
    return nu.ravel(), a0.ravel(), eta.ravel()


def _solution() -> Finding:
    nu, a0, eta = _grid()
    steady = theory.steady_rolling(nu, a0, c=SLENDERNESS, eta=eta)
    worst = 0.0
    for branch in (steady.upper, steady.lower):
        tilt, phase = branch.amplitude[branch.exists], branch.phase[branch.exists]
        state = np.stack([np.zeros_like(tilt), nu[branch.exists], tilt, phase])
        rates = rotating_frame_rates(state, nu[branch.exists], a0[branch.exists], c=SLENDERNESS, eta=eta[branch.exists])
        worst = max(worst, float(np.abs(rates[0]).max()), float(np.abs(tilt * rates[1]).max()))
    return Finding(
        "(7), (8)",
        "Circular base motion has an exact steady rolling: constant tilt, contact point turning with the base.",
        f"(8) satisfies (7) with residuals of θ̈ and θβ̈ below {worst:.0e} on {nu.size} points of (ν, a0, η).",
        judged(worst < 1e-13),  # noqa: PLR2004  a few hundred units of rounding
    )


def _phase() -> Finding:
    steady = theory.steady_rolling(2.0, CIRCULAR_AMPLITUDES[0], **_PARAMETERS)
    up, low = float(steady.upper.phase), float(steady.lower.phase)
    return Finding(
        "(8)",
        "The phase follows from tan ψ alone.",
        f"The tangent leaves the quadrant open. With a0 cos ψ and a0 sin ψ taken together, ν = 2, a0 = 0.02: "
        f"ψ = {up:.4f} on the upper branch, {low:.4f} (near π) on the lower.",
        judged(abs(up) < math.pi / 2 < abs(low), ClaimStatus.SHARPENED),
    )


def _stays() -> Finding:
    cases = ((1.5, 0.065), (3.0, 0.065), (1.2, 0.02))
    model = paper_model()
    worst = 0.0
    for nu, a0 in cases:
        motion = Harmonic.circular(acceleration=a0, angular_frequency=nu)
        start = steady_start(model, motion)
        run = simulate(model, motion, **start, duration=_PERIODS * motion.period, rtol=1e-11)
        tilt = math.hypot(*start["tilt"])
        worst = max(worst, float(np.abs(run.data["amplitude"] - tilt).max()))
    return Finding(
        "section 3",
        "Where steady rolling is stable the column keeps rolling.",
        f"Started on (8) and integrated over {_PERIODS} periods at (ν, a0) = (1.5, 0.065), (3, 0.065), (1.2, 0.02), "
        f"the tilt stays within {worst:.0e} rad of it.",
        judged(worst < 1e-10),  # noqa: PLR2004  ten times the integrator's tolerance
    )


def _lower_branch() -> Finding:
    nu, a0, eta = _grid()
    lower = theory.steady_rolling(nu, a0, c=SLENDERNESS, eta=eta).lower
    growth = lower.eigenvalues[lower.exists].real.max(axis=-1)
    return Finding(
        "Figs. 2, 3",
        "Curves 2 and 4 (lower branch, phase near π) are unstable at all frequencies.",
        f"On all {growth.size} points with a lower branch an eigenvalue is positive (least {growth.min():.2g}). Proof: "
        "the constant coefficient of the characteristic polynomial is (1+ν²)² + η²ν² − (1+ν²)c/θ, negative below the "
        "fold: the lower branch is a saddle.",
        judged(bool(growth.min() > 0.0), ClaimStatus.SHARPENED),
    )


def _criteria_agree() -> Finding:
    nu, a0, eta = _grid()
    upper = theory.steady_rolling(nu, a0, c=SLENDERNESS, eta=eta).upper
    growth = upper.eigenvalues[upper.exists].real.max(axis=-1)
    same = int(np.sum((growth < 0.0) == upper.stable[upper.exists]))
    return Finding(
        "matrix after (8)",
        "Stability follows from the Routh-Hurwitz criterion on the printed matrix.",
        f"Routh-Hurwitz and computed eigenvalues agree on {same} of {growth.size} points. The criterion reduces to a "
        "bound on the tilt, θ < c[1 + √(1 + 4/w)]/4 with w = 4ν² + η², which gives the boundary in closed form for "
        "any damping.",
        judged(same == growth.size, ClaimStatus.SHARPENED),
    )


def _critical_frequencies() -> Finding:
    first, second = (float(theory.critical_frequency(a0, **_PARAMETERS)) for a0 in CIRCULAR_AMPLITUDES)
    rising = theory.critical_frequency(np.linspace(0.01, 0.5, 200), **_PARAMETERS)
    return Finding(
        "Figs. 2, 3",
        "Curves 3 and 5 (upper branch) are unstable below and stable above a boundary that moves right with amplitude.",
        f"ν* = {first:.10f} at a0 = 0.02 and {second:.10f} at a0 = 0.065, and ν* rises with a0 throughout. A complex "
        "pair of eigenvalues crosses the imaginary axis there.",
        judged(bool(np.all(np.diff(rising) > 0.0))),
    )


def _undamped_limit() -> Finding:
    closed = theory.undamped_critical_frequency(np.array(CIRCULAR_AMPLITUDES), c=SLENDERNESS)
    small = theory.critical_frequency(np.array(CIRCULAR_AMPLITUDES), c=SLENDERNESS, eta=1e-4)
    gap = float(np.abs(small - closed).max())
    return Finding(
        "conclusions",
        "The critical frequency depends on the parameters of the problem.",
        "Without damping it is (1+√s)/√(4 − (1+√s)²) with s = a0/(a0+c): "
        f"{closed[0]:.5f} and {closed[1]:.5f}; at η = 1e-4 the boundary differs from it by {gap:.0e}.",
        judged(gap < 1e-6, ClaimStatus.SHARPENED),  # noqa: PLR2004  the correction is of the order η²
    )


_C = SLENDERNESS
_BOUNDS = (0.8, 8.0)
_ELLIPSE = (0.08, 0.04)


def check_exact() -> PaperSection:
    """Check the paper's averaged results against exact orbits."""
    straight = {a1: _branch(Harmonic.straight(acceleration=a1, angular_frequency=3.0)) for a1 in AMPLITUDES}
    data = {
        "exact": exact_response(
            paper_model(),
            Harmonic.straight(acceleration=AMPLITUDES[1], angular_frequency=3.0),
            angular_frequency=(_BOUNDS[0], 4.0),
        ),
        "boundary": stability_boundary(
            paper_model(),
            Harmonic.straight(acceleration=AMPLITUDES[1], angular_frequency=2.0),
            bounds=(0.012, 0.3),
            angular_frequency=(0.7, 2.4),
            values=[AMPLITUDES[1]],
        ),
    }
    findings = (_circular(), _boundaries(straight), _bifurcating(straight), _error(straight))
    return PaperSection(findings, {name: _plain(found) for name, found in data.items()})


def _plain(found: xr.Dataset) -> xr.Dataset:
    """Convert data for netCDF, without truth values."""
    return found.assign({name: one.astype("int8") for name, one in found.data_vars.items() if one.dtype == bool})


def _branch(motion: Harmonic) -> Branch:
    return continue_branch(periodic_orbit(paper_model(), motion), "angular_frequency", bounds=_BOUNDS)


def _lost(branch: Branch) -> Bifurcation:
    """Return the bifurcation at which stability is lost with decreasing frequency."""
    return max((one for one in branch.bifurcations if one.supercritical is not None), key=lambda one: one.parameter)


def _circular() -> Finding:
    a0 = 0.065
    errors = []
    for angular_frequency in (1.2, 1.5, 2.0, 3.0, 5.0):
        motion = Harmonic.circular(acceleration=a0, angular_frequency=angular_frequency)
        orbit = periodic_orbit(paper_model(), motion)
        exact = theory.steady_rolling(angular_frequency, a0, c=_C, eta=DAMPING).upper.eigenvalues
        multipliers = np.exp(2.0 * math.pi * np.asarray(exact) / angular_frequency)
        gaps = np.abs(multipliers[:, np.newaxis] - orbit.multipliers)
        errors.append(float(gaps.min(axis=1).max()))
    lost = _lost(_branch(Harmonic.circular(acceleration=a0, angular_frequency=3.0)))
    critical = float(theory.critical_frequency(a0, c=_C, eta=DAMPING))
    gap = abs(lost.parameter - critical)
    return Finding(
        "(7), (8)",
        "Circular motion has an exact rolling solution, stable above a critical frequency.",
        f"Periodic orbits of (1), found without (7), have Floquet multipliers that equal exp(2πλ/ν) of its exact "
        f"eigenvalues within {max(errors):.0e}; followed over ν at a0 = {a0:g} they lose stability in a "
        f"{lost.kind.value} bifurcation at ν = {lost.parameter:.9f}, {gap:.0e} from the closed form; supercritical: "
        "a stable modulated motion bifurcates.",
        judged(
            max(errors) < 1e-8  # noqa: PLR2004
            and gap < 1e-7  # noqa: PLR2004
            and lost.kind is BifurcationKind.NEIMARK_SACKER
            and bool(lost.supercritical),
            ClaimStatus.SHARPENED,
        ),
    )


def _boundaries(straight: dict[float, Branch]) -> Finding:
    lost = {f"a1 = {a1:g}": (_lost(branch), a1 / 2.0) for a1, branch in straight.items()}
    ellipse = Harmonic.elliptic(amplitude=_ELLIPSE, phase=-math.pi / 2.0, angular_frequency=3.0)
    p, _ = circular_components(*_ELLIPSE, -math.pi / 2.0)
    lost[f"ellipse {_ELLIPSE[0]:g} × {_ELLIPSE[1]:g}"] = (_lost(_branch(ellipse)), float(abs(p)))
    lines, higher = [], []
    for name, (one, part) in lost.items():
        averaged = float(theory.critical_frequency(part, c=_C, eta=DAMPING))
        lines.append(f"{name}: {one.parameter:.6f} (averaged {averaged:.4f})")
        higher.append(one.parameter > averaged)
    pitchforks = all(one.kind is BifurcationKind.PITCHFORK and one.supercritical for one, _ in lost.values())
    return Finding(
        "conclusion 4",
        "Averaging gives the frequency above which rolling is stable under straight-line motion.",
        f"The exact orbit is stable above another ν*: {'; '.join(lines)}. "
        "Stability is lost in a pitchfork, not by an oscillation: a real multiplier leaves the unit circle through +1, "
        "and the orbit loses its symmetry (the opposite lean half a period later).",
        judged(pitchforks and all(higher), ClaimStatus.LIMITED),
    )


def _bifurcating(straight: dict[float, Branch]) -> Finding:
    lines, soft = [], []
    for a1, branch in straight.items():
        one = _lost(branch)
        family = switch_branch(one, bounds=_BOUNDS)
        first = family.bifurcations[0]
        lines.append(f"a1 = {a1:g}: from {one.parameter:.4f} down to {first.parameter:.6f}, {first.kind.value}")
        soft.append(bool(np.abs(family.path[1].multipliers[0]) < 1.0))
    return Finding(
        "conclusion 3",
        "Below the critical frequency the column only stands or overturns.",
        "Under straight-line motion the bifurcation is supercritical: two mirror-image rolling motions without the "
        f"symmetry are stable below ν*. {'; '.join(lines)}. They end in doublings or modulated motion, and soon after "
        "in overturning.",
        judged(all(soft), ClaimStatus.DOES_NOT_HOLD),
    )


def _error(straight: dict[float, Branch]) -> Finding:
    parts = []
    for a1, branch in straight.items():
        for angular_frequency in (3.0, 6.0):
            (orbit,) = branch.orbits_at(angular_frequency)
            averaged = theory.averaged_rolling(angular_frequency, a1, 0.0, 0.0, c=_C, eta=DAMPING).forward.upper
            parts.append(orbit.mean_tilt / float(averaged.amplitude) - 1.0)
    small, large = np.array(parts).reshape(2, 2)
    order = math.log(large[0] / small[0]) / math.log(AMPLITUDES[1] / AMPLITUDES[0])
    return Finding(
        "(9), (10)",
        "Averaging is good at high frequency, its small parameters being η/2ν, a1/4ν, θ̇/2ν, (β̇ − ν)/2ν.",
        f"The mean tilt of the exact orbit is larger than the averaged one by {100 * small[0]:.2f} % at a1 = 0.04 and "
        f"{100 * large[0]:.2f} % at a1 = 0.13, at ν = 3, and by {100 * small[1]:.2f} % and {100 * large[1]:.2f} % at "
        f"ν = 6: the error does not fall with ν; between these amplitudes it grows as the power {order:.2f} of a1/c.",
        judged(abs(small[1] / small[0] - 1.0) < 0.1 and abs(order - 2.0) < 0.2, ClaimStatus.LIMITED),  # noqa: PLR2004
    )
