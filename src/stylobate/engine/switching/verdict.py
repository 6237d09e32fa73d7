"""What a finished run of a model that changes between kinds of contact amounts to, and what it leaves behind."""

import math
from collections import Counter
from dataclasses import dataclass

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.engine.forcing import Floats
from stylobate.engine.switching.course import SwitchingCourse
from stylobate.engine.switching.following import Reason
from stylobate.engine.switching.guard import Guard
from stylobate.engine.switching.long_term import long_term
from stylobate.engine.verdict import Verdict
from stylobate.errors import Outcome
from stylobate.models import Contact, Model
from stylobate.models.sliding.equations import JAM
from stylobate.results import OutcomeRules

# The end of a whole number of periods is told to this part of the time.
_SLACK = 1e-9

# Nodes of Gauss's rule for the lengths of paths, to each step.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


_ENDINGS = {
    Reason.OVERTURNED: (Outcome.OVERTURNED, "its tilt reached π/2, which counts as overturned"),
    Reason.LIMIT: (Outcome.LIMIT_REACHED, "its tilt reached tilt_limit"),
    Reason.RESTED: (Outcome.AT_REST, "it stands, and the base motion to come can neither tip nor move it"),
}
# What a column that stays upright does, the kinds of contact that it has in it, from few to all.
_UPRIGHT = (
    ({Contact.RESTING}, (Outcome.AT_REST, "it stands at the end of the run")),
    (
        {Contact.RESTING, Contact.SLIDING},
        (Outcome.SLID, "it stands upright, and its base slides on the plane to the end"),
    ),
    (set(Contact), (Outcome.LIFTED_OFF, "it stays upright, and leaves the plane again and again")),
)


def switching_verdict(model: Model, motion: BaseMotion, course: SwitchingCourse, rules: OutcomeRules) -> Verdict:
    """Return what became of the column.

    What it does over the last periods decides, or at the end where there are none or too few: whether it stands, its
    base slides, it hops, or it moves on its rim, which is then judged as for the other models.
    """
    if course.ended is Reason.FAILED:
        return Verdict(Outcome.FAILED, f"the integration stopped: {course.failure}", {})
    if course.ended in _ENDINGS:
        return Verdict(*_ENDINGS[course.ended], {})
    period = None if motion.period is None else motion.period / model.time_scale
    end = course.trajectory.end
    # Periods of which some are no late ones, as in ensembles.
    enough = period is not None and end * (1.0 + _SLACK) >= (rules.periods + 1) * period
    since = end - rules.periods * period if enough and period is not None else end
    late = [number for number, piece in enumerate(course.pieces) if piece.end > since] or [len(course.pieces) - 1]
    kinds = {course.contacts[number] for number in late}
    leans = any(_leans(course, number) for number in late)
    for allowed, verdict in _UPRIGHT:
        if not leans and kinds <= allowed:
            return Verdict(*verdict, {})
    return long_term(model, course.trajectory, period, rules, planar=False)


def _leans(course: SwitchingCourse, number: int) -> bool:
    """Return whether the column has a tilt in the piece of this number."""
    piece = course.pieces[number]
    return bool(np.any(course.model.tilt(piece.states(np.array([piece.start, piece.end])))))


@dataclass(frozen=True, slots=True)
class Account:
    """How long a column was in each kind of contact, where it came to stand, and how far it went.

    Parameters
    ----------
    measures
        `time_resting` … [s]; `residual_displacement` of the centre of its footprint, with its parts along x and y, and
        `walking_distance`, the length of the path of that [m]; `slip_distance`, that of the path of the contact on the
        plane [m]; `residual_twist` [rad]; how often it struck the plane and began to slip; Painlevé's least
        denominator.
    """

    measures: dict[str, float]

    @classmethod
    def of(cls, course: SwitchingCourse) -> "Account":
        """Return the account of a run."""
        model = course.model
        scale, length = model.time_scale, model.column.mass_height
        times = dict.fromkeys(Contact, 0.0)
        for kind, piece in zip(course.contacts, course.pieces, strict=True):
            times[Contact(kind)] += (piece.end - piece.start) * scale
        first, last = course.pieces[0], course.pieces[-1]
        begun = first.states(np.array([first.start]))[:, 0]
        ended = last.states(np.array([last.end]))[:, 0]
        dx, dy = length * (ended[6:8] - begun[6:8])
        walked, slipped, least = _paths(course)
        counts = Counter(event.kind for event in course.events)
        return cls(
            {
                **{f"time_{kind.name.lower()}": times[kind] for kind in Contact if kind is not Contact.JAMMED},
                "residual_displacement": math.hypot(dx, dy),
                "residual_displacement_x": float(dx),
                "residual_displacement_y": float(dy),
                "residual_twist": float(ended[5] - begun[5]),
                "walking_distance": length * walked,
                "slip_distance": length * slipped,
                "impacts": float(counts["land"] + counts["stroke"]),
                "slips": float(course.slips),
                "least_painleve_denominator": least,
            }
        )


def _paths(course: SwitchingCourse) -> tuple[float, float, float]:
    """Return the lengths of the paths of footprint and slip [h], and Painlevé's least denominator."""
    walked, slipped, least = 0.0, 0.0, 1.0
    model = course.model
    for kind, piece, ends in zip(course.contacts, course.pieces, course.times, strict=True):
        if kind == Contact.RESTING:
            continue
        half = 0.5 * np.diff(ends)[:, np.newaxis]
        tau = (0.5 * (ends[:-1] + ends[1:])[:, np.newaxis] + half * _NODES).ravel()
        weights = (half * _WEIGHTS).ravel()
        states = piece.states(tau)
        found = [
            model.rates(*state, *course.forcing.at(time), *model.parameters)[6:8]
            for time, state in zip(tau.tolist(), states.T.tolist(), strict=True)
        ]
        walked += float(weights @ np.hypot(*np.array(found).T))
        if kind in (Contact.SLIDING, Contact.SLIPPING):
            slipped += float(weights @ np.hypot(*states[8:10]))
        if kind == Contact.SLIPPING:
            least = min(least, *(_denominator(course, *place) for place in zip(tau.tolist(), states.T, strict=True)))
    return walked, slipped, least


def _denominator(course: SwitchingCourse, tau: float, state: Floats) -> float:
    guard = Guard(course.model, course.forcing, course.thresholds.rest_energy)
    return guard.guards(tau, state)[course.model.guard_names.index("jam")] + JAM
