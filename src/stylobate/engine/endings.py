"""Outcome, event and reason of runs that end in their kernel; other outcomes follow from the last periods of a run."""

from collections.abc import Mapping
from typing import NamedTuple

from stylobate.engine.kernel.columns import Status
from stylobate.errors import Outcome


class Ending(NamedTuple):
    """End of a run in its kernel.

    Parameters
    ----------
    outcome
        Outcome of the run.
    event
        Name of the event at the end; "" for none.
    reason
        Reason in words; "" if it depends on the run, see `reasons`.
    """

    outcome: Outcome
    event: str = ""
    reason: str = ""


ENDINGS: Mapping[Status, Ending] = {
    Status.RESTED: Ending(Outcome.AT_REST),
    Status.OVERTURNED: Ending(
        Outcome.OVERTURNED, "overturned", "its tilt grows beyond the tilt from which it could come back"
    ),
    Status.LIMIT: Ending(Outcome.LIMIT_REACHED, "limit", "its tilt reached tilt_limit"),
    Status.LIFTED: Ending(Outcome.LIFTED_OFF, "lifted", "the base accelerates downwards faster than gravity"),
    Status.STEP_LIMIT: Ending(Outcome.FAILED, "failed"),
    Status.STEP_TOO_SMALL: Ending(Outcome.FAILED, "failed", "its step became smaller than the rounding of the time"),
    Status.UNSEEN: Ending(Outcome.FAILED, "failed"),
    Status.ENDLESS: Ending(Outcome.FAILED, "failed"),
    Status.JAMMED: Ending(
        Outcome.FAILED,
        reason=(
            "its contact jams: with friction as large as this no motion of a rigid body follows (Painlevé's paradox)"
        ),
    ),
}
"""Ending by status."""
