"""Whole motions of the column that slips, flies and lands, against the body with a quaternion: events and states.

Both follow the same laws from event to event, by equations, integrators and searches of their own.
"""

import math

import numpy as np
import pytest
from tests.reference.forcing import Forcing
from tests.reference.resting import departure_lapse

import stylobate as sb
from stylobate.models.sliding.equations import STILL
from stylobate.models.sliding.rim_and_base import REST_SPEED

from .sliding_events import follow
from .sliding_starts import place_and_motion, place_and_motion_told, random_start
from .sliding_track import Limits

pytestmark = pytest.mark.long

RTOL = 1e-10
# Slip begins with, and ends at, some STILL; that and errors of steps grow at most as fast as the column falls, e^τ.
# Slip that fades slower than FADES [h ω0²] is none of these cases; so the times of events are known to this less well.
LASTS, FADES = 2.5, 0.01
POINT, PATCH = 10.0 * STILL * math.exp(LASTS), 1e-8 * math.exp(LASTS)

# What the body calls a change; the package has more to say.
ENDS = ("flat", "fallen")


def compared(start, within):
    scale, length = start.model.time_scale, start.model.column.mass_height
    limits = Limits(
        rtol=RTOL, atol=1e-3 * RTOL, still=1e-2 * STILL * length / scale, resting=REST_SPEED * length / scale
    )
    track = follow(start.body, start.state, duration=LASTS * scale, acceleration=start.push, times=[], limits=limits)
    known = [event for event in track.events if event.kind not in ENDS]
    end = track.time[-1] if track.phase[-1] != "ended" else 0.999 * track.time[-1]
    run = sb.simulate(start.model, start.motion, **start.given, duration=end, rtol=RTOL)
    # Slip that begins with the motion is an event of the package only.
    later = [event for event in run.events if event.time > 0.0]
    assert [event.kind for event in later] == [event.kind for event in known]
    times = [event.time / scale for event in known]
    assert [event.time / scale for event in later] == pytest.approx(times, abs=within / FADES)
    if end == track.time[-1]:
        found = place_and_motion_told(run, end, start.model.column)
        np.testing.assert_allclose(found, place_and_motion(start.body, track.state[-1]), rtol=0.0, atol=within)
    return {event.kind for event in known}


def at_once(start):
    """What a slip that begins with a jump of friction is known to, the cube of the lapse of its onset."""
    return POINT + departure_lapse(Forcing.of(start.model, start.motion)) ** 3 * math.exp(LASTS)


def test_a_point_slips_and_sticks_as_the_body_does():
    seen = set().union(*(compared(random_start(seed), POINT) for seed in range(1, 7)))
    assert seen >= {"slip", "stick"}


@pytest.mark.parametrize(
    ("seed", "static"),
    [
        *[(0, 1.0), (3, 1.3), (8, 1.0), (9, 1.3)],
        *[pytest.param(*case, marks=pytest.mark.slow) for case in ((0, 1.3), (3, 1.0), (8, 1.3), (9, 1.0))],
    ],
)
def test_a_point_slips_at_once_as_the_body_does(seed, static):
    # The first slips from the beginning, held far less than it would have to be.
    start = random_start(seed, static=static)
    compared(start, at_once(start))


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_it_lands_and_bounces_as_the_body_does(restitution):
    # An impact passes on an error, and adds that of its own time.
    starts = (random_start(seed, airborne=True, restitution=restitution) for seed in range(3))
    assert "land" in set().union(*(compared(start, 2.0 * at_once(start)) for start in starts))


@pytest.mark.parametrize("seed", [0, 1])
def test_a_patch_slips_and_creeps_as_the_body_does(seed):
    compared(random_start(seed, patch=0.1), PATCH)
