"""Planar rocking: backbone of a parallelepiped against a round column, and loss of planar motion."""

import math

import numpy as np
import xarray as xr

from stylobate import theory
from stylobate.base_motions import Harmonic
from stylobate.engine import simulate
from stylobate.paper.analyses.setting import DAMPING, SLENDERNESS, judged, paper_model
from stylobate.results.findings import ClaimStatus, Finding, PaperSection
from stylobate.theory.planar import planar_kick_slope

_C = SLENDERNESS
_NU, _A1 = 3.0, 0.13
_PLANAR_A1, _ROLLING_A0 = 0.008, 0.008
"""Small amplitudes, so that each forced curve is close to its backbone."""


def check_planar() -> PaperSection:
    """Check the paper's statements on motion in the plane of excitation."""
    kicks = kick_data()
    return PaperSection(
        (_two_curves(), _planar_response(), _planar_loss(kicks)), {"backbones": backbone_data(), "kicks": kicks}
    )


def backbone_data() -> xr.Dataset:
    """Compute both backbones with a forced response near each: planar rocking and rolling."""
    nu = np.linspace(0.2, 4.0, 800)
    rolling = theory.steady_rolling(nu, _ROLLING_A0, c=_C, eta=DAMPING)
    planar = theory.planar_forced_response(nu, _PLANAR_A1, c=_C, eta=DAMPING)
    orbits = {"fast": planar.fast, "slow": planar.slow}
    return xr.Dataset(
        {
            "rolling_backbone": ("nu", theory.rolling_backbone(nu, _C)),
            "planar_backbone": ("nu", theory.planar_backbone(nu, _C)),
            "rolling": (("branch", "nu"), np.stack([rolling.lower.amplitude, rolling.upper.amplitude])),
            "rolling_stable": (("branch", "nu"), np.stack([rolling.lower.stable, rolling.upper.stable])),
            "planar": (("orbit", "nu"), np.stack([orbit.amplitude for orbit in orbits.values()])),
            "planar_stable": (("orbit", "nu"), np.stack([orbit.stable_in_plane for orbit in orbits.values()])),
        },
        coords={"nu": nu, "branch": ["lower", "upper"], "orbit": list(orbits)},
        attrs={"c": _C, "a0": _ROLLING_A0, "a1": _PLANAR_A1},
    )


def kick_data() -> xr.Dataset:
    """Compute the sideways kick Δẏ/y0 of one passage near the vertical against the offset y0, and its exact slope."""
    orbit = theory.planar_forced_response(_NU, _A1, c=_C, eta=DAMPING).fast
    _, speed, phase = (float(value) for value in orbit.start())
    offsets = np.logspace(-13.0, -7.0, 13)
    motion = Harmonic.straight(acceleration=_A1, angular_frequency=_NU, start_phase=phase)
    kicks = [_kick(motion, speed, float(offset)) for offset in offsets]
    return xr.Dataset(
        {"kick": ("offset", kicks)},
        coords={"offset": offsets},
        attrs={"slope": float(planar_kick_slope(speed, _C)), "nu": _NU, "a1": _A1, "c": _C},
    )


def _kick(motion: Harmonic, speed: float, offset: float) -> float:
    # From just before to just after the passage: the same short time for every offset.
    before = 2e-3
    ahead = motion.delayed(-(motion.period - before))
    run = simulate(
        paper_model(),
        ahead,
        tilt=(-speed * before, offset),
        tilt_rate=(speed, 0.0),
        duration=2.0 * before,
        rtol=1e-11,
        atol=1e-22,
    )
    at_upright = float(run.sample(before)["tilt"].sel(axis="y")[0])
    return float(run.data["tilt_rate"].sel(axis="y")[-1]) / at_upright


def _two_curves() -> Finding:
    data = backbone_data()
    nu = data["nu"].to_numpy()
    planar, rolling = data["planar_backbone"].to_numpy(), data["rolling_backbone"].to_numpy()
    gap = np.abs(planar / rolling - 1.0)
    series = theory.planar_backbone(50.0, _C) / theory.rolling_backbone(50.0, _C)
    return Finding(
        "conclusion 6",
        "The curves of a round column follow (5), those of a parallelepiped (3); they look similar and are different.",
        f"For 0.2 ≤ ν ≤ 4 the backbones differ by {100 * gap.min():.0f} to {100 * gap.max():.0f} % of (5), "
        f"most at ν = {nu[int(np.argmax(gap))]:.1f}; for large ν their ratio tends to π²/8 ({float(series):.4f} at "
        "ν = 50, π²/8 = 1.2337).",
        judged(abs(float(series) - math.pi**2 / 8.0) < 0.01),  # noqa: PLR2004  the next term is of the order 1/ν²
    )


def _planar_response() -> Finding:
    nu, a1 = 2.0, 0.02
    orbit = theory.planar_forced_response(nu, a1, c=_C, eta=DAMPING)
    stable = orbit.fast if bool(orbit.fast.stable_in_plane) else orbit.slow
    _, speed, phase = (float(value) for value in stable.start())
    motion = Harmonic.straight(acceleration=a1, angular_frequency=nu, start_phase=phase)
    run = simulate(paper_model(), motion, tilt_rate=(speed, 0.0), duration=10.0 * motion.period, rtol=1e-11)
    end = run.sample(10.0 * motion.period)
    gap = max(abs(float(end["tilt"][0, 0])), abs(float(end["tilt_rate"][0, 0]) - speed))
    return Finding(
        "section 4",
        "Forced rocking in the plane of excitation is a solution, known from the parallelepiped.",
        "Symmetric rocking at the forcing period has a closed form, stable in its plane on one branch: at ν = 2, "
        f"a1 = 0.02 the integration returns to it after 10 periods within {gap:.0e}.",
        judged(gap < 1e-8 and run.planar, ClaimStatus.SHARPENED),  # noqa: PLR2004
    )


def _planar_loss(kicks: xr.Dataset) -> Finding:
    slope = float(np.polyfit(np.log(kicks["offset"]), kicks["kick"], 1)[0])
    exact = kicks.attrs["slope"]
    offset, left = _slow_rocking_left()
    return Finding(
        "conclusion 5",
        "Motion in one plane is unstable (shown for free motion without friction).",
        "With forcing and damping it can be lost faster still: one passage of the vertical at speed v with the offset "
        "y0 kicks the column sideways by Δẏ = −(2c/v) y0 (ln 1/|y0| + O(1)), relatively the more the smaller the "
        f"offset; measured slope of Δẏ/y0 against ln|y0|: {slope:.4f}, 2c/v = {exact:.4f} (ν = 3, a1 = 0.13, η = 0.1). "
        "But not every planar motion is lost: large rocking at a fifth of the forcing frequency (ν = 6, a1 = 0.15) "
        f"attracts the column back into its plane, from an offset of {offset:.0e} rad to {left:.1e} in 100 periods.",
        judged(
            abs(slope / exact - 1.0) < 0.01 and left < 0.1 * offset,  # noqa: PLR2004
            ClaimStatus.LIMITED,
        ),
    )


def _slow_rocking_left() -> tuple[float, float]:
    """Return initial and final offset [rad] from planar rocking at a fifth of the forcing frequency."""
    offset = 1e-5
    motion = Harmonic.straight(acceleration=0.15, angular_frequency=6.0)
    run = simulate(
        paper_model(),
        motion,
        tilt=(0.01258970636, offset),
        tilt_rate=(-0.07418059564, 0.0),
        duration=100.0 * motion.period,
    )
    last = run.data["tilt"].sel(axis="y").where(run.data["time"] > 95.0 * motion.period)
    return offset, float(abs(last).max())
