"""Single runs from random starts, friction realistic and small, against the body with a quaternion. Slow: 200 runs."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.models.sliding.equations import STILL
from stylobate.models.sliding.rim_and_base import REST_SPEED

from .sliding_events import follow
from .sliding_starts import place_and_motion, place_and_motion_told, random_start
from .sliding_track import Limits

# As `test_sliding_motions`: errors of steps, and of the slip with which slip begins, grow as fast as the column falls.
LASTS, TOLERANCES = 1.5, 3.0
RTOLS = (1e-6, 1e-8)


def apart(seed):
    """Return, by rtol, how far a run and the track of the body lie apart at the end; None for those that end flat."""
    rng = np.random.default_rng([seed, 77])
    airborne = bool(rng.integers(0, 2)) and seed % 4 == 0
    little = float(10.0 ** rng.uniform(-7.0, -1.0)) if seed % 2 else None
    start = random_start(seed, airborne=airborne, static=float(rng.choice([1.0, 1.3])), friction=little)
    model, body = start.model, start.body
    scale, length = model.time_scale, model.column.mass_height
    limits = Limits(rtol=1e-11, atol=1e-14, still=1e-2 * STILL * length / scale, resting=REST_SPEED * length / scale)
    track = follow(body, start.state, duration=LASTS * scale, acceleration=start.push, times=[], limits=limits)
    if track.phase[-1] == "ended":  # flat, where the package goes on by rules of its own
        return None
    end, exact = track.time[-1], place_and_motion(body, track.state[-1])
    found = {}
    for rtol in RTOLS:
        run = sb.simulate(model, start.motion, **start.given, duration=end, rtol=rtol)
        found[rtol] = float(np.abs(place_and_motion_told(run, end, model.column) - exact).max())
    return found


@pytest.mark.slow
def test_random_runs_are_those_of_the_body():
    found = {seed: apart(seed) for seed in range(100, 200)}
    compared = {seed: value for seed, value in found.items() if value is not None}
    assert len(compared) > 60
    bounds = {rtol: TOLERANCES * rtol * math.exp(LASTS) for rtol in RTOLS}
    assert {seed: value for seed, value in compared.items() if any(value[r] > bounds[r] for r in RTOLS)} == {}
