"""Verification problems: closed forms beside runs, from still base to rolling, impact and slip."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.polynomial import Polynomial

import stylobate as sb
from stylobate.column.numbers import STANDARD_GRAVITY

from .cylinders import frequency_parameter
from .finding import Finding, Kind
from .rolling_rim import cases

_C, _ETA, _DRIVE, _NU = 0.1, 0.1, 0.065, 3.0
_IMPACTS, _RESTITUTION, _START = 5, 0.9, 0.5
_SOLID = "solid cylinder, r = 0.2 m, height 2 m, 2700 kg/m³"
_FRICTION, _PEAK, _CORNERS = 0.2, 0.5, (0.0, 0.1, 0.4, 0.5)


def findings() -> Iterator[Finding]:
    """Yield all problems of this part."""
    yield _uplift()
    yield from _impacts()
    yield _energy()
    yield _turn()
    yield _precession()
    yield _steady_rolling()
    yield _slip()
    yield frequency_parameter()


def _solid() -> sb.Column:
    return sb.Column.solid(radius=0.2, height=2.0, density=2700.0)


def _uplift() -> Finding:
    """A base acceleration that grows linearly lifts the column as it reaches g tan α."""
    column, growth = _solid(), 4.0
    times = np.arange(0.0, 1.0, 0.01)
    samples = np.column_stack([growth * times, 0.0 * times, 0.0 * times])
    run = sb.simulate(sb.Wobbling(column), sb.Record(samples=samples, step=0.01), duration=0.6, rtol=1e-11)
    begun = next(event.time for event in run.events if event.kind == "uplift")
    strength = STANDARD_GRAVITY * column.slenderness
    compared = f"time of uplift under {growth:g} m/s³ [s]"
    source = "balance of moments: a = g tan α"
    return Finding(source, compared, strength / growth, begun, Kind.MATHEMATICS, remark=_SOLID)


def _impacts() -> Iterator[Finding]:
    """A slender block rocks freely; each impact leaves the share e of its angular velocity."""
    block = sb.PlanarRocking.block(width=2e-4, height=2.0, density=2000.0, restitution=_RESTITUTION)
    alpha, p = block.column.tipping_angle, block.column.frequency_parameter
    run = sb.simulate(block, tilt=(_START * alpha, 0.0), duration=8.0, rtol=1e-12, atol=1e-18)
    impacts = [event.time for event in run.events if event.kind == "impact"]
    share, elapsed = _START, math.acosh(1.0 / (1.0 - _START)) / p
    for _ in range(_IMPACTS - 1):
        share = 1.0 - math.sqrt(1.0 - _RESTITUTION**2 * (1.0 - (1.0 - share) ** 2))
        elapsed += 2.0 * math.acosh(1.0 / (1.0 - share)) / p
    source = "G. W. Housner, Bull. Seism. Soc. Am. 53 (1963)"
    compared = f"block 2 m high, 0.2 mm wide, released at α/2, e = 0.9: time of impact {_IMPACTS} [s]"
    yield Finding(source, compared, elapsed, impacts[_IMPACTS - 1], Kind.MATHEMATICS)
    between = 0.5 * (impacts[_IMPACTS - 1] + impacts[_IMPACTS])
    left = float(run.data["energy"].interp(time=between)) / float(run.data["energy"][0])
    compared = f"the same: energy left after {_IMPACTS} impacts"
    yield Finding(source, compared, _RESTITUTION ** (2 * _IMPACTS), left, Kind.MATHEMATICS)


def _energy() -> Finding:
    """Without loss the energy of a wobbling column stays."""
    column = _solid()
    start = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.05)}
    run = sb.simulate(sb.Wobbling(column), **start, duration=60.0, rtol=1e-12)
    energy = run.data["energy"].to_numpy()
    compared = "free wobbling for 60 s: energy at the end over that at the start"
    remark = f"{_SOLID}; from the tilt 0.04 rad with a rate of 0.05 rad/s across it"
    ends = float(energy[-1] / energy[0])
    return Finding("conservation of energy", compared, 1.0, ends, Kind.MATHEMATICS, remark=remark)


def _turn() -> Finding:
    """A column that rocks almost through the vertical turns by its closed form; runs are extrapolated to no offset."""
    # solid, with h = g = 1
    column = sb.Column(
        mass=1.0, radius=_C, mass_height=1.0, transverse_inertia=_C**2 / 4 + 1 / 3, axial_inertia=_C**2 / 2, gravity=1.0
    )
    turns = []
    for offset in (2e-6, 1e-6):
        rate = (0.0, 0.05 * offset * column.frequency_scale)
        run = sb.simulate(
            sb.Wobbling(column), tilt=(0.05, 0.0), tilt_rate=rate, duration=3.0578, rtol=1e-12, atol=1e-17
        )
        turns.append(float(run.data["azimuth"][-1]))
    theirs = math.degrees(sb.theory.angle_of_turn(column.slenderness, inertia_ratio=column.inertia_ratio))
    ours = math.degrees(2.0 * turns[1] - turns[0])
    return Finding(
        source="M. Srinivasan and A. Ruina, Phys. Rev. E 78 (2008)",
        compared="angle of turn of a solid cylinder, c = 0.1 [°]",
        theirs=theirs,
        ours=ours,
        kind=Kind.MATHEMATICS,
        allowed=2e-6,
        remark="from the tilt 0.05 rad, with rates across it of 1e-7 and 5e-8 times √(g/h), extrapolated to none",
    )


def _precession() -> Finding:
    """A cylinder without spin rolls steadily round its rim."""
    case = cases()["rolling"]
    compared = "steady rolling round the rim at the tilt 0.1 rad: rate of precession [rad/s]"
    source = "M. Srinivasan and A. Ruina, Phys. Rev. E 78 (2008)"
    body = f"solid cylinder, r = {case.column.radius:g} m, h = {case.column.mass_height:g} m"
    return Finding(source, compared, case.turning, case.exact, Kind.MATHEMATICS, remark=body)


def _steady_rolling() -> Finding:
    """On a circling base, a run that starts on steady rolling stays on it."""
    model = sb.Slender(sb.Column.dimensionless(slenderness=_C), damping=_ETA)
    circle = sb.Harmonic.circular(acceleration=_DRIVE, angular_frequency=_NU)
    theirs = float(sb.theory.steady_rolling(_NU, _DRIVE, c=_C, eta=_ETA).upper.amplitude)
    start = sb.studies.steady_start(model, circle)
    run = sb.simulate(model, circle, **start, duration=50.0 * circle.period, rtol=1e-12)
    compared = "steady rolling on a circling base, tilt after 50 periods"
    tilt, remark = float(run.data["amplitude"][-1]), f"c = {_C}, η = {_ETA}, a0 = {_DRIVE} g, Ω = {_NU} √(g/h)"
    return Finding("the source paper, corrected", compared, theirs, tilt, Kind.MATHEMATICS, remark=remark)


def _slip() -> Finding:
    """A stocky column slips under a trapezoidal pulse: ẇ = a − µg while w > 0, integrated piece by piece."""
    column = sb.Column.solid(radius=0.5, height=0.5, density=2700.0)
    peak, strength = _PEAK * STANDARD_GRAVITY, _FRICTION * STANDARD_GRAVITY
    times = np.arange(0.0, 3.0, 0.1)
    samples = np.zeros((len(times), 3))
    samples[:, 0] = np.interp(times, _CORNERS, [0.0, peak, peak, 0.0], right=0.0)
    model = sb.Sliding(column, friction_coefficient=_FRICTION)
    run = sb.simulate(model, sb.Record(samples=samples, step=0.1), duration=2.5, rtol=1e-11)
    begun = _CORNERS[1] * strength / peak
    speed = distance = 0.0
    for begin, end in zip((begun, *_CORNERS[1:-1]), _CORNERS[1:], strict=True):
        first, last = (float(np.interp(at, _CORNERS, [0.0, peak, peak, 0.0])) for at in (begin, end))
        rate = Polynomial([first - strength, (last - first) / (end - begin)])
        gained = rate.integ(k=speed)
        distance += float(gained.integ()(end - begin))
        speed = float(gained(end - begin))
    distance += speed**2 / (2.0 * strength)
    compared = "column that only slips, µ = 0.2; pulse of 0.5 g from 0.1 s to 0.4 s with ramps of 0.1 s: distance [m]"
    source = "N. M. Newmark, Géotechnique 15 (1965)"
    slipped, remark = float(run.measures["slip_distance"]), "solid cylinder, r = 0.5 m, height 0.5 m"
    return Finding(source, compared, distance, slipped, Kind.MATHEMATICS, remark=remark)
