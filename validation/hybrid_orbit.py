"""A periodic orbit of a rocking block with two impacts, by a general code for hybrid systems, beside `sb.orbits`.

MapPy, by Yuu Miino, composes the Poincaré map of a hybrid system from modes, with the derivatives of flow, borders and
jumps. Its distribution `mappy-ds` 0.2.0 could not be installed from the index; this runs version 0.0.7 from its
repository, with SymPy:

    git clone https://github.com/Yuu-Miino/MapPy
    STYLOBATE_MAPPY=MapPy python -m validation hybrid_orbit
"""

import math
import os
import sys
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import stylobate as sb

from .finding import Finding, Kind

VARIABLE = "STYLOBATE_MAPPY"
"""Environment variable with the folder of the clone."""

COLUMN = sb.Column.dimensionless(slenderness=0.1)
MODEL = sb.PlanarRocking(COLUMN, damping=0.1, restitution=0.9)
AMPLITUDE, FREQUENCIES = 0.2, (6.0, 5.4)
"""Acceleration [g], and angular frequencies of the orbit and of the end of its continuation [ω0]."""
_ALLOWED = 1e-8
# MapPy has a relative tolerance only; SciPy's absolute one is 1e-6, which this unit of the tilt makes small [rad].
_UNIT, _RTOL = 1e-6, 1e-12
_POINTS = 6


def findings() -> Iterator[Finding]:
    """Yield state and multipliers of the orbit, if MapPy is at hand."""
    folder = os.environ.get(VARIABLE)
    if not folder:
        print(f"hybrid_orbit: left out; name the folder of a clone of github.com/Yuu-Miino/MapPy in ${VARIABLE}")
        return
    sys.path.insert(0, folder)
    import mappy
    from mappy.fundamentals import _fundamentals
    from mappy.root import trace_cycle

    _fundamentals.numpy = _OlderNumPy()
    first = orbit(FREQUENCIES[0])
    start, side = first.state / _UNIT, "right" if first.state[0] > 0.0 else "left"
    numbers = {"frequency": FREQUENCIES[0], "amplitude": AMPLITUDE}
    # Newton's method begins 1 % off the orbit.
    traced = trace_cycle(
        poincare_map(mappy), 1.01 * start, numbers, "frequency", FREQUENCIES[1], resolution=_POINTS, m0=f"begin {side}"
    )
    source = f"MapPy {mappy.__version__} (234de99)"
    for state, at, more in (traced[0], traced[-1]):
        ours = orbit(at["frequency"], _UNIT * state)
        theirs, multiplier = _UNIT * state, max(more["eigvals"], key=lambda one: one.imag)
        own = max(ours.multipliers, key=lambda one: one.imag)
        for text, there, here in (
            ("tilt at t = 0 [rad]", theirs[0], ours.state[0]),
            ("rate of the tilt at t = 0 [rad ω0]", theirs[1], ours.state[1]),
            ("modulus of its multipliers", abs(multiplier), abs(own)),
            ("angle of its multipliers [rad]", np.angle(multiplier), np.angle(own)),
        ):
            compared = f"block with two impacts in a period, Ω/ω0 = {at['frequency']:g}: {text}"
            yield Finding(source, compared, float(there), float(here), Kind.CODE, allowed=_ALLOWED)


def orbit(frequency: float, guess: np.ndarray | None = None) -> sb.orbits.PeriodicOrbit:
    """Return the orbit by `sb.orbits`, from a state or from a run that has settled."""
    line = sb.Harmonic.straight(acceleration=AMPLITUDE, angular_frequency=frequency)
    if guess is None:
        settled = sb.simulate(MODEL, line, tilt=(0.02, 0.0), duration=300.0, rtol=1e-10)
        return sb.orbits.periodic_orbit(MODEL, line, guess=settled)
    return sb.orbits.periodic_orbit(MODEL, line, guess=[guess[0], 0.0, guess[1], 0.0])


def acceleration(tilt: Any, rate: Any, base: Any, side: float, functions: Any = math) -> Any:
    """Return the tilt acceleration of the block that leans to a side (±1) under a base acceleration [g]."""
    c, sin, cos = COLUMN.slenderness, functions.sin(side * tilt), functions.cos(side * tilt)
    moment = -side * (c * cos - sin) - (cos + c * sin) * base - MODEL.damping * rate
    return moment / (1.0 + COLUMN.inertia_ratio * c * c)


def poincare_map(mappy: Any) -> Any:
    """Return the map over one period of the base motion, composed of the two sides, impacts and the section."""
    import sympy

    continuous, discrete = mappy.ContinuousMode, mappy.DiscreteMode

    def leaning(side: float) -> Callable[..., Any]:
        @continuous.function(3, ["frequency", "amplitude"])
        def rates(state: Any, numbers: Any) -> Any:
            tilt, rate, phase = state
            base = numbers["amplitude"] * sympy.cos(phase)
            turning = acceleration(tilt * _UNIT, rate * _UNIT, base, side, sympy)
            return np.array([rate, turning / _UNIT, numbers["frequency"]])

        return rates

    def vertical(direction: int) -> Callable[..., Any]:
        return continuous.border(direction)(lambda state, _: state[0])

    section = continuous.border(1)(lambda state, _: state[2] - 2.0 * np.pi)
    impact = discrete.function(3, 3)(
        lambda state, _: np.array([state[0], MODEL.impact_restitution * state[1], state[2]])
    )
    begin = discrete.function(2, 3)(lambda state, _: np.append(state, 0))
    end = discrete.function(3, 2)(lambda state, _: state[0:2])
    modes, after = [], {}
    for name, other, side in (("right", "left", 1), ("left", "right", -1)):
        modes += [
            continuous(name, leaning(float(side)), [vertical(-side), section]),
            discrete(f"impact from {name}", impact),
            discrete(f"begin {name}", begin),
            discrete(f"end {name}", end),
        ]
        after |= {
            f"begin {name}": name,
            name: [f"impact from {name}", f"end {name}"],
            f"impact from {name}": other,
            f"end {name}": f"begin {name}",
        }
    return mappy.PoincareMap(tuple(modes), after, ["begin right", "begin left"], rtol=_RTOL)


class _OlderNumPy:
    """NumPy as MapPy 0.0.7 expects it: its abstract type of floating-point numbers makes an array of doubles."""

    floating = float

    def __getattr__(self, name: str) -> Any:
        return getattr(np, name)
