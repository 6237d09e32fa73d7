"""Numbers that others computed and published: overturning amplitudes, energies and a rolling coin."""

import math
from collections.abc import Callable, Iterator

import numpy as np

import stylobate as sb
from stylobate.column.numbers import STANDARD_GRAVITY

from .finding import Finding, Kind

_PULSE = "Numerics-in-Motion/blocks: under-this-pulse (ea6f9a5)"
_SIZES = {0.25: 1.2618896, 0.5: 1.4584424, 1.0: 2.1637842, 2.0: 5.1549268, 4.0: math.inf}
"""First overturning amplitude by R [m]; the largest block does not overturn up to 6."""
_ENERGIES = {0.25: 2.676938615047, 0.5: 1.711093884306, 1.0: 0.924523403127, 2.0: 0.476920339315, 4.0: 0.241823713076}
"""Energy at the end of the pulse over that of the balance, at the amplitude 2, by R [m]."""
_ALPHA, _TIME, _GRAVITY = 0.2, 0.5, STANDARD_GRAVITY
_WIDTH = 4.9e-6
_MODES = "J. Zhang and N. Makris, J. Eng. Mech. 127 (2001), numbers from memory"


def findings() -> Iterator[Finding]:
    """Yield all comparisons of this part."""
    yield from _under_a_sine()
    yield from _two_modes()
    yield _coin()


def _block(half_diagonal: float, alpha: float, gravity: float, restitution: float | None = None) -> sb.PlanarRocking:
    return sb.PlanarRocking.block(
        width=2.0 * half_diagonal * math.sin(alpha),
        height=2.0 * half_diagonal * math.cos(alpha),
        density=2700.0,
        restitution=restitution,
        gravity=gravity,
    )


def _edge(overturns: Callable[[float], bool], low: float, high: float) -> float:
    """Bisect to the amplitude at which the outcome changes."""
    begins = overturns(high)
    for _ in range(26):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if overturns(middle) == begins else (middle, high)
    return 0.5 * (low + high)


def _overturns(model: sb.PlanarRocking, unit: float, omega: float) -> Callable[[float], bool]:
    def tried(amplitude: float) -> bool:
        pulse = sb.Pulse.one_sine(acceleration=amplitude * unit, angular_frequency=omega)
        return sb.simulate(model, pulse, rtol=1e-11).outcome is sb.Outcome.OVERTURNED

    return tried


def _under_a_sine() -> Iterator[Finding]:
    omega, unit = 2.0 * math.pi / _TIME, _GRAVITY * math.tan(_ALPHA)
    amplitudes, same, back = np.round(np.arange(1.0, 6.005, 0.01), 2), 0, 0
    for size, theirs in _SIZES.items():
        model = _block(size, _ALPHA, _GRAVITY)
        if math.isfinite(theirs):
            ours = _edge(_overturns(model, unit, omega), theirs - 0.01, theirs + 0.01)
            compared = f"first overturning amplitude a/(g tan α) of a block, R = {size:g} m"
            yield Finding(_PULSE, compared, theirs, ours, Kind.MATHEMATICS, allowed=_WIDTH, scale=1.0)
        pulse = sb.Pulse.one_sine(acceleration=unit, angular_frequency=omega)
        length = _TIME + 20.0 / model.column.frequency_parameter
        runs = sb.simulate_ensemble(model, pulse, parameters={"acceleration": amplitudes * unit}, duration=length)
        overturned = runs["outcome"].to_numpy() == sb.Outcome.OVERTURNED
        passed = overturned | (runs["peak_tilt"].to_numpy() >= model.column.tipping_angle)
        same += int((passed == (amplitudes > theirs)).sum())
        back += int((passed & ~overturned).sum())
        end = sb.simulate(model, pulse.scaled(2.0), duration=_TIME, rtol=1e-12).data.isel(time=-1)
        column = model.column
        balance = column.mass * column.gravity * (column.rim_distance - column.mass_height)
        compared = f"energy at the end of the pulse over that of the balance, amplitude 2, R = {size:g} m"
        yield Finding(_PULSE, compared, _ENERGIES[size], float(end["energy"]) / balance, Kind.MATHEMATICS, allowed=1e-9)
    compared = "equal outcomes at the points of the scan, as its transitions imply them (five sizes, 1.00 to 6.00)"
    remark = f"{back} of these blocks are pushed back by the end of the pulse and survive"
    yield Finding(_PULSE, compared, 5 * amplitudes.size, same, Kind.MATHEMATICS, remark=remark)


def _two_modes() -> Iterator[Finding]:
    alpha, p, e = 0.349, 2.14, 0.9
    model = _block(0.75 * STANDARD_GRAVITY / p**2, alpha, STANDARD_GRAVITY, restitution=e)
    overturns = _overturns(model, alpha * STANDARD_GRAVITY, 5.0 * p)
    slender = (
        *sb.theory.one_sine_overturning_after_impact(5.0, 1.0, restitution=e),
        sb.theory.one_sine_overturning_without_impact(5.0, 1.0),
    )
    texts = ("overturns after an impact from", "survives again from", "overturns without an impact from")
    finite = (_edge(overturns, 2.8, 3.3), _edge(overturns, 6.5, 7.4), _edge(overturns, 7.4, 8.2))
    for theirs, text, limit, here in zip((3.01, 6.32, 7.18), texts, slender, finite, strict=True):
        compared = f"one sine, ω/p = 5, e = 0.9, slender block: {text} a/(α g)"
        remark = f"{here:.3f} at the finite angle α = {alpha:g}"
        yield Finding(_MODES, compared, theirs, float(limit), Kind.MATHEMATICS, scale=1.0, allowed=0.015, remark=remark)


def _coin() -> Finding:
    radius, tilt, turning = 0.01, math.radians(89.0), 10.0 * math.pi
    coin = sb.Column(
        radius=radius,
        mass_height=1e-9 * radius,
        mass=1.0,
        transverse_inertia=0.25 * radius**2,
        axial_inertia=0.5 * radius**2,
        gravity=9.81,
    )
    run = sb.simulate(
        sb.Rolling(coin),
        tilt=(-tilt, 0.0),
        tilt_rate=(0.0, -tilt * turning),
        spin=turning * math.cos(tilt),
        duration=0.5,
        rtol=1e-12,
    )
    along = run.data["contact_point"].isel(axis=0).to_numpy()
    return Finding(
        "Exudyn, TestModels/rollingCoinTest.py",
        "coin on its rim, spun about the vertical: x of the contact after 0.5 s [m]",
        0.002004099927,
        float(along[-1] - along[0]),
        Kind.CODE,
        remark="generalised-α steps of 0.5 ms there",
    )
