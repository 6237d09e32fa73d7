"""What a kernel would have noted of a run that was followed alone: put into its row of the table of a batch.

So all that is told of a run is told by `summaries`, whoever followed it.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize_scalar

from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.lanes.columns import (
    BEFORE,
    LATE,
    LOG,
    LOOKS,
    SLACK,
    STATE,
    Change,
    Log,
    Setup,
    Status,
    Window,
)
from stylobate.engine.switching.course import SwitchingCourse
from stylobate.engine.trajectory import Piece
from stylobate.engine.watch import Reason
from stylobate.models import Contact

Floats = npt.NDArray[np.float64]

_STATUS = {
    Reason.STOP: Status.STOPPED,
    Reason.RESTED: Status.RESTED,
    Reason.OVERTURNED: Status.OVERTURNED,
    Reason.LIMIT: Status.LIMIT,
    Reason.FAILED: Status.STEP_LIMIT,
}

_ON_BASE, _ON_RIM = (Contact.RESTING, Contact.SLIDING), (Contact.ROLLING, Contact.SLIPPING)

# Nodes of Gauss's rule for the integrals over the last periods, and of the search for extremes, to each step.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)
_PARTS = np.linspace(0.0, 1.0, 9)[:-1]


def note(batch: Batch, number: int, course: SwitchingCourse) -> None:
    """Put what became of the run of this number into the table of its batch."""
    noted = _Noted(batch.table[number], course, len(batch.plan.model.state_names))
    noted.end()
    noted.switches()
    noted.extremes()
    if course.ended is Reason.STOP and noted.setup(Setup.PERIOD) > 0.0:
        noted.last_periods(batch.plan.options.rules.periods)
    noted.leans_at(batch.notes(strobes=False)[number], _sample_times(noted))
    noted.leans_at(batch.notes(strobes=True)[number], _strobe_times(noted, batch.plan.options.strobes))


@dataclass(frozen=True, slots=True)
class _Noted:
    """A row of the table, and the course that goes into it; `order` is the number of states."""

    row: Floats
    course: SwitchingCourse
    order: int

    def setup(self, column: Setup) -> float:
        return float(self.row[column])

    def log(self, column: Log, value: float) -> None:
        self.row[LOG + column] = value

    def change(self, column: Change, value: float) -> None:
        self.row[STATE + self.order + column] = value

    def end(self) -> None:
        """Note how it ended: its state, and the kind of contact."""
        course, end = self.course, self.course.trajectory.end
        contact = course.switches[-1].after if course.switches else int(course.left[-1])
        self.row[STATE : STATE + self.order] = course.left
        self.row[STATE + self.order - 1] = contact
        rested = course.ended is Reason.RESTED
        self.log(Log.STATUS, Status.JAMMED if contact == Contact.JAMMED else _STATUS[course.ended])
        self.log(Log.TIME, end)
        self.log(Log.DECIDED, course.pieces[-1].start if rested else end)
        self.log(Log.STANDS, contact == Contact.RESTING)
        self.log(Log.STEPS, course.trajectory.steps)

    def switches(self) -> None:
        """Note how long each kind of contact lasted, and how often they changed."""
        times, since = self.times_until(math.inf)
        for kind in Contact:
            if kind is not Contact.JAMMED:
                self.change(Change[f"TIME_{kind.name}"], times[kind])
        self.change(Change.SINCE, since)
        changes = [(switch.margin, switch.before, switch.after) for switch in self.course.switches]
        met = [change for change in changes if change[0] >= 0]
        stroke = len(self.course.model.guard_names) - 1
        rests = [place for place, (_, before, after) in enumerate(met) if after == Contact.RESTING != before]
        releases = [place for place, (_, before, after) in enumerate(met) if before == Contact.RESTING != after]
        self.change(Change.IMPACTS, sum(before == Contact.FLYING or number == stroke for number, before, _ in met))
        self.change(Change.SLIPS, self.course.slips)
        self.log(Log.RELEASES, len(releases))
        self.log(Log.RESTS, len(rests))
        self.log(Log.RELEASED_FROM_REST, bool(rests and releases and rests[0] < releases[-1]))
        if any(after in _ON_BASE for _, _, after in changes):
            self.log(Log.TOUCHED_UPRIGHT, 1.0)

    def times_until(self, until: float) -> tuple[dict[Contact, float], float]:
        """Return how long each kind of contact lasted up to a time but for the present one, and since when that did."""
        times, since = dict.fromkeys(Contact, 0.0), 0.0
        for switch in self.course.switches:
            if switch.time > until:
                break
            times[Contact(switch.before)] += switch.time - since
            since = switch.time
        return times, since

    def extremes(self) -> None:
        """Note the largest and the least tilt, and how far the lean travelled round."""
        self.log(Log.IN_SPACE, any(contact != Contact.RESTING for contact in self.course.contacts))
        moving = [
            (piece, times)
            for piece, times, contact in zip(self.course.pieces, self.course.times, self.course.contacts, strict=True)
            if contact not in _ON_BASE
        ]
        if not moving:
            return
        self.log(Log.FIRST_AZIMUTH, moving[0][0].azimuths[0] / (2.0 * math.pi))
        self.log(Log.LAST_AZIMUTH, moving[-1][0].azimuths[-1] / (2.0 * math.pi))
        swings = [_Swing.of(self.course, *part) for part in moving]
        largest, when = max(swing.largest() for swing in swings)
        self.log(Log.LARGEST_TILT, largest)
        self.log(Log.LARGEST_AT, when)
        self.log(Log.LEAST_TILT, min(swing.least() for swing in swings))

    def last_periods(self, periods: int) -> None:
        """Note the looks at the last periods, and what is integrated over them."""
        period, end = self.setup(Setup.PERIOD), self.setup(Setup.END)
        most = end * (1.0 + SLACK)
        if most < (periods + 1) * period:
            return
        span = periods * LOOKS
        last = LOOKS + span * (2 if most >= (2 * periods + 1) * period else 1)
        times = np.maximum(end - np.arange(last, -1, -1) * (period / LOOKS), 0.0)
        looks, azimuths = self.leans(times), self.azimuths(times)
        for first, begin in ((BEFORE, last - 2 * span), (LATE, last - span)):
            if begin >= LOOKS:
                seen = slice(begin, begin + span + 1)
                before = slice(begin - LOOKS, begin + span + 1 - LOOKS)
                window = _window(looks[:, seen], looks[:, before], azimuths[seen], times[seen] / period)
                for column, value in window.items():
                    self.row[first + column] = value
        self.begin_window(float(times[last - span]))
        self.integrals(float(times[last - span]), period)

    def begin_window(self, begin: float) -> None:
        """Note where and how the column is as the last periods begin."""
        times, since = self.times_until(begin)
        state = self.course.trajectory.states(np.array([begin]))[:, 0]
        before = [switch for switch in self.course.switches if switch.time <= begin]
        times[Contact(before[-1].after if before else int(state[-1]))] += begin - since
        names = self.course.model.state_names
        self.change(Change.WINDOW_AT, begin)
        for column, name in (
            (Change.WINDOW_X, "footprint_x"),
            (Change.WINDOW_Y, "footprint_y"),
            (Change.WINDOW_TWIST, "twist"),
        ):
            self.change(column, state[names.index(name)])
        self.change(Change.WINDOW_SLIDING, times[Contact.SLIDING])
        self.change(Change.WINDOW_RIM, sum(times[kind] for kind in _ON_RIM))
        self.change(Change.WINDOW_FLYING, times[Contact.FLYING])

    def integrals(self, begin: float, period: float) -> None:
        """Note the integrals over the last periods of the tilt, and of its parts that turn with the forcing or back."""
        tau, weights = self.nodes(begin)
        x, y, *_ = self.leans(tau)
        turns = 2.0 * math.pi / period * tau
        cos, sin, tilt = np.cos(turns), np.sin(turns), np.hypot(x, y)
        self.log(Log.MEAN_TILT, weights @ tilt)
        self.log(Log.LATE_LEAST, tilt.min())
        self.log(Log.FORWARD_COS, weights @ (x * cos + y * sin))
        self.log(Log.FORWARD_SIN, weights @ (y * cos - x * sin))
        self.log(Log.BACKWARD_COS, weights @ (x * cos - y * sin))
        self.log(Log.BACKWARD_SIN, weights @ (y * cos + x * sin))

    def nodes(self, begin: float) -> tuple[Floats, Floats]:
        """Return times and weights with which an integral from `begin` to the end is summed, step by step."""
        ends = np.unique(np.concatenate([[begin], *(times[times > begin] for times in self.course.times)]))
        half = 0.5 * np.diff(ends)[:, np.newaxis]
        return (0.5 * (ends[:-1] + ends[1:])[:, np.newaxis] + half * _NODES).ravel(), (half * _WEIGHTS).ravel()

    def leans(self, tau: Floats) -> Floats:
        """Return tilt and tilt rate, shape (4, n)."""
        return np.stack(self.course.model.tilt_of(*self.course.trajectory.states(tau), *self.course.model.parameters))

    def azimuths(self, tau: Floats) -> Floats:
        """Return the azimuth of the lean [turns]; the last one known while it stands, 0 before any."""
        trajectory, moving = self.course.trajectory, [piece for piece in self.course.pieces if piece.azimuths.size]
        found = trajectory.azimuth(tau, self.leans(tau)[:2])
        for place in np.flatnonzero(np.isnan(found)):
            known = [piece.azimuths[-1] for piece in moving if piece.end <= tau[place]]
            found[place] = known[-1] if known else 0.0
        return found / (2.0 * math.pi)

    def leans_at(self, rows: Floats, times: Iterable[tuple[int, float]]) -> None:
        """Put the leans at these times into rows of samples or strobes, told by place and time, up to the end."""
        known = [(place, time) for place, time in times if time <= self.course.trajectory.end]
        if known:
            places, tau = (np.array(column) for column in zip(*known, strict=True))
            rows[places] = np.vstack([self.leans(tau), tau]).T


@dataclass(frozen=True, slots=True)
class _Swing:
    """The tilt in a piece, at times near one another."""

    course: SwitchingCourse
    piece: Piece
    tau: Floats
    tilt: Floats

    @classmethod
    def of(cls, course: SwitchingCourse, piece: Piece, times: Floats) -> "_Swing":
        """Look at each of the steps with these ends."""
        tau = np.append((times[:-1, np.newaxis] + np.diff(times)[:, np.newaxis] * _PARTS).ravel(), times[-1])
        return cls(course, piece, tau, np.hypot(*course.model.tilt(piece.states(tau))))

    def largest(self) -> tuple[float, float]:
        """Return the largest tilt, and when it is reached."""
        least, when = self._least(int(np.argmax(self.tilt)), sign=-1.0)
        return -least, when

    def least(self) -> float:
        """Return the least tilt."""
        return self._least(int(np.argmin(self.tilt)), sign=1.0)[0]

    def _least(self, place: int, *, sign: float) -> tuple[float, float]:
        """Return the least value of the tilt with this sign near a place, and when it is reached."""
        low, high = self.tau[max(place - 1, 0)], self.tau[min(place + 1, self.tau.size - 1)]

        def height(time: float) -> float:
            return sign * float(np.hypot(*self.course.model.tilt(self.piece.states(np.array([time]))))[0])

        found = minimize_scalar(height, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)})
        return min((sign * float(self.tilt[place]), float(self.tau[place])), (float(found.fun), float(found.x)))


def _window(looks: Floats, before: Floats, azimuths: Floats, forced: Floats) -> dict[Window, float]:
    """Return what is noted of looks, shape (4, n), at a window, of those one period before, and of the azimuths."""
    change, size = np.abs(looks - before), np.abs(looks)
    weights = np.ones(len(azimuths))
    weights[[0, -1]] = 0.5
    return {
        Window.TILT_CHANGE: float(change[:2].max()),
        Window.RATE_CHANGE: float(change[2:].max()),
        Window.TILT_SIZE: float(size[:2].max()),
        Window.RATE_SIZE: float(size[2:].max()),
        Window.LAG_FORWARD: float(weights @ (azimuths - forced)),
        Window.LAG_BACKWARD: float(weights @ (azimuths + forced)),
        Window.FIRST_AZIMUTH: float(azimuths[0]),
        Window.LAST_AZIMUTH: float(azimuths[-1]),
    }


def _sample_times(noted: _Noted) -> Iterable[tuple[int, float]]:
    count, end = int(noted.setup(Setup.SAMPLES)), noted.setup(Setup.END)
    return enumerate(np.linspace(0.0, end, count).tolist())


def _strobe_times(noted: _Noted, count: int) -> Iterable[tuple[int, float]]:
    """Return the last times at which the base motion has phase zero."""
    period, first, end = noted.setup(Setup.PERIOD), noted.setup(Setup.STROBE), noted.setup(Setup.END)
    if period <= 0.0:
        return ()
    last = math.floor((end * (1.0 + SLACK) - first) / period)
    numbers = ((place, last + 1 - count + place) for place in range(count))
    return ((place, min(first + number * period, end)) for place, number in numbers if number >= 0)
