"""Part of an ensemble: the table that kernels read and write, and its computation by the kernels."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from stylobate.compiler.kept import runs_plain
from stylobate.engine.ensembles.beginnings import (
    beginning,
    fill_looks,
    fill_setup,
    line_of_switching,
    looks_needed,
    number_of_looks,
)
from stylobate.engine.ensembles.model_columns import ModelColumns
from stylobate.engine.ensembles.run_columns import MotionColumns, MotionPlan
from stylobate.engine.ensembles.runs import EnsembleRuns
from stylobate.engine.kernel.columns import (
    EVENTS_AT,
    LOG,
    NOTE,
    ORBIT,
    PAIRS,
    STATE,
    Log,
    Orbit,
    Setup,
)
from stylobate.engine.kernel.driver.events import RunStatus, event_numbers
from stylobate.engine.kernel.driver.loop import CERTAIN, NEAR
from stylobate.engine.kernel.expansion import series_integrals
from stylobate.engine.kernel.kernels import kernel_of
from stylobate.engine.kernel.shape import ANY_KIND, Shape
from stylobate.engine.starts import cannot_depart, out_of_plane, refuse_spin
from stylobate.engine.verdict import FINER_PASSAGE, FINER_REST, other_tolerance
from stylobate.models import Model
from stylobate.results import OutcomeRules
from stylobate.results.known_orbits import OrbitsOfRuns
from stylobate.run_arguments import EnsembleOptions

Floats = npt.NDArray[np.float64]

Halt = npt.NDArray[np.uint8]


def _nothing(_steps: float, _time: float) -> None:
    """Ignore a pause."""


WIDTH = 24
"""Lanes of a kernel: three AVX-512 vectors, whose latencies overlap; the buffer still fits the first-level cache."""

SWITCHING_WIDTH = 8
"""Lanes of a kernel that changes between kinds of contact; its lanes have many more rows."""


@dataclass(frozen=True)
class Plan:
    """Settings that all runs of an ensemble share.

    `rest_share` is a factor of the energy below which a column comes to rest if the base motion can uplift it, and
    `passage_share` a factor of the tilt below which a passage of the vertical loses energy.
    `traces` is the number of trace entries in the table, 0 for none. `plain` means that kernels run as plain Python,
    one run at a time, for a model that cannot be compiled. `orbits` is the number of known orbits of each run.
    """

    model: Model
    motion: MotionPlan
    options: EnsembleOptions
    rest_share: float = 1.0
    passage_share: float = 1.0
    traces: int = 0
    plain: bool = False
    orbits: int = 0

    @property
    def rules(self) -> OutcomeRules:
        """Thresholds that classify a motion."""
        return self.options["rules"] or OutcomeRules()

    @property
    def samples(self) -> int:
        """Number of samples of each history."""
        return self.options["samples"] or 0

    def repeated(self) -> "Plan":
        """Return the plan to repeat runs in doubt: finer thresholds, another tolerance, no samples or traces."""
        own = self.options
        rtol, atol = other_tolerance(own["rtol"]), own["atol"]
        atol = None if atol is None else atol * (rtol / own["rtol"])
        finer: EnsembleOptions = {**own, "rtol": rtol, "atol": atol}
        options: EnsembleOptions = {**finer, "samples": None, "strobes": 0, "recheck": False}
        return replace(self, options=options, rest_share=FINER_REST, passage_share=FINER_PASSAGE, traces=0)

    def shape(self, *, planar: bool) -> Shape:
        """Return the shape of the kernel for planar or three-dimensional motion."""
        states, parameters = len(self.model.state_names), len(self.model.parameters)
        forcing = self.motion.source(planar=planar)
        by_series = self.options["method"] == "taylor" and not planar  # planar equations are linear between events
        vertical = "az" in forcing.components
        return Shape(
            states=states,
            parameters=parameters,
            planar=planar,
            forcing=forcing,
            width=self._width,
            series=series_integrals(type(self.model), states, parameters, vertical=vertical) if by_series else (),
            demands=self.options["demands"],
            guards=len(self.model.guard_names),
            slip=self.model.slip_states,
            kept=self.model.kept_states,
            groups=self._groups(planar=planar),
            orbits=self.orbits,
        )

    def _groups(self, *, planar: bool) -> tuple[tuple[int, int], ...]:
        """Return the groups of lanes: those of single kinds of contact, and the one for all others."""
        states = len(self.model.state_names)
        own = tuple((int(kind), number) for kind, number in self.model.moving_states.items())
        return *own, (ANY_KIND, 2 if planar else states - len(self.model.kept_states))

    @property
    def _width(self) -> int:
        if self.plain or runs_plain():
            return 1
        return SWITCHING_WIDTH if self.model.switches else WIDTH

    @cached_property
    def layout(self) -> Shape:
        """Shape that defines the columns of the table of a batch, the same for both kernels."""
        return self.shape(planar=False)


@dataclass(frozen=True, slots=True)
class Batch:
    """Runs in the units of their models.

    `planar` marks runs that begin with planar motion and, after the computation, runs that end with it. `first_tilt` is
    the tilt at the start [rad]. `traces` holds the trace entries of a single run.
    """

    plan: Plan
    models: ModelColumns
    motions: MotionColumns
    planar: npt.NDArray[np.bool_]
    first_tilt: Floats
    table: Floats
    orbits: OrbitsOfRuns | None = None
    traces: list[Floats] = field(default_factory=list)

    @classmethod
    def of(cls, plan: Plan, runs: EnsembleRuns) -> "Batch":
        """Return the batch of these runs, ready for computation.

        Raises
        ------
        ParameterError
            If a value is out of range.
        """
        models = ModelColumns.of(plan.model, runs.values, len(runs))
        motions = MotionColumns.of(plan.motion, runs.values, models)
        shape, end = plan.layout, runs.duration / models.time_scale
        looks = number_of_looks(plan.rules) if np.any(looks_needed(end, motions.period, plan.rules)) else 0
        table = _empty_table(plan, shape, len(runs), motions.breaks.shape[1], looks)
        _fill_setup(table, plan, runs, models, motions)
        fill_looks(table.T, end, motions.period, plan.rules)
        planar, leans = _fill_starts(table, plan.model, runs, models, motions)
        if runs.orbits is not None:
            fill_orbits(table, shape.orbits_at, runs.orbits, motions.period, models.time_scale, plan.rules)
        table[:, shape.parameters_at : shape.motion_at] = models.parameters
        table[:, shape.motion_at : shape.breaks_at] = motions.columns
        table[:, shape.breaks_at : shape.breaks_at + motions.breaks.shape[1]] = motions.breaks
        return cls(plan, models, motions, planar, leans, table, runs.orbits)

    @property
    def rest_energy(self) -> Floats:
        """Energy below which each column comes to rest, see `Setup`."""
        return self.table[:, Setup.REST_ENERGY]

    def log(self, column: Log) -> Floats:
        """Return a column of the log of all runs."""
        return self.table[:, LOG + column]

    @property
    def converged(self) -> "OrbitReached | None":
        """Runs that have converged to a known orbit, and the orbit of each; None if no run has."""
        runs = np.flatnonzero(self.log(Log.STATUS) == RunStatus.CONVERGED)
        if self.orbits is None or not runs.size:
            return None
        return orbit_reached(self.table, self.plan.layout.orbits_at, self.orbits, runs)

    def notes(self, *, strobes: bool) -> Floats:
        """Return the (stroboscopic) samples, shape (n, number, 5): tilt vector, its rate, time; NaN if missing."""
        kept, of_phase = self.plan.samples, self.plan.options["strobes"]
        return self._notes(kept, of_phase) if strobes else self._notes(0, kept)

    @property
    def looks_at(self) -> int:
        """Column of the first look; pairs follow the looks."""
        return self._notes_at(self.plan.samples + self.plan.options["strobes"])

    @property
    def places(self) -> Floats:
        """Footprint and twist at the stroboscopic samples, shape (n, number, 3); NaN if missing."""
        strobes = self.plan.options["strobes"]
        return self._notes(int(self.table[0, Setup.NOTES]) - strobes, strobes)[..., :3]

    def _notes(self, before: int, count: int) -> Floats:
        first = self._notes_at(before)
        return self.table[:, first : first + NOTE * count].reshape(len(self.table), count, NOTE)

    def _notes_at(self, before: int) -> int:
        return self.plan.layout.breaks_at + int(self.motions.breaks.shape[1]) + NOTE * before

    def advance(self, halt: Halt, paused: Callable[[float, float], None] = _nothing) -> bool:
        """Compute the runs to their ends; return False if `halt[0]` was set before.

        If there is a trace, `paused(steps, time [s])` is called whenever the trace is full.
        """
        finished = self._through(halt, paused, planar=False, chosen=~self.planar)
        released = self.log(Log.STATUS) == RunStatus.TO_PLANE
        if released.any():
            self._to_plane(released)
            self.planar[released] = True
        return self._through(halt, paused, planar=True, chosen=self.planar) and finished

    def _through(
        self, halt: Halt, paused: Callable[[float, float], None], *, planar: bool, chosen: npt.NDArray[np.bool_]
    ) -> bool:
        if not chosen.any():
            return True
        every_run = bool(chosen.all())
        table = self.table if every_run else np.ascontiguousarray(self.table[chosen])
        kernel = kernel_of(type(self.plan.model), self.plan.shape(planar=planar))
        buffer = kernel.buffer()
        pieces, plain = self.plan.motion.pieces, self.plan.plain
        while not (finished := kernel.advance(table, pieces, halt, buffer, plain=plain)) and not halt[0]:
            self._take_trace(table)
            paused(table[0, LOG + Log.STEPS], table[0, LOG + Log.TIME] * self.models.time_scale[0])
        self._take_trace(table)
        if not every_run:
            self.table[chosen] = table
        if np.any(self.log(Log.STATUS) == RunStatus.CANNOT_DEPART):
            raise cannot_depart(self.plan.model)
        return finished

    def _take_trace(self, table: Floats) -> None:
        """Move the trace entries of the only run from the `table` to `traces`."""
        if self.plan.traces:
            width = self.plan.layout.trace_width
            at = table.shape[1] - self.plan.traces * width
            count = int(table[0, LOG + Log.NEXT_TRACE])
            self.traces.append(table[0, at : at + count * width].reshape(count, width).copy())
            table[0, at:] = table[0, LOG + Log.NEXT_TRACE] = 0.0

    def _to_plane(self, chosen: npt.NDArray[np.bool_]) -> None:
        """Replace the three-dimensional state of these runs by tilt and rate along their line."""
        part = self.table[chosen]
        states = len(self.plan.model.state_names)
        leans = self.plan.model.tilt_of(*part[:, STATE : STATE + states].T, *self.models.parameters[chosen].T)
        line = part[:, Setup.LINE_X], part[:, Setup.LINE_Y]
        x, y, vx, vy = leans
        part[:, STATE] = x * line[0] + y * line[1]
        part[:, STATE + 1] = vx * line[0] + vy * line[1]
        part[:, LOG + Log.STATUS] = RunStatus.WAITING
        self.table[chosen] = part


def _empty_table(plan: Plan, shape: Shape, count: int, breaks: int, looks: int) -> Floats:
    samples = plan.samples + plan.options["strobes"]
    notes, places = shape.breaks_at + breaks, plan.options["strobes"] if plan.model.switches else 0
    number = samples + (looks + PAIRS if looks else 0) + places
    table = np.zeros((count, notes + NOTE * number + plan.traces * shape.trace_width))
    table[:, notes : notes + NOTE * samples] = np.nan
    table[:, notes + NOTE * (number - places) : notes + NOTE * number] = np.nan
    table[:, Setup.NOTES] = number
    table[:, Setup.LOOKS] = looks
    for column in (Log.FIRST_AZIMUTH, Log.LAST_AZIMUTH):
        table[:, LOG + column] = np.nan
    for column in (Log.MINIMUM_TILT, Log.CLOSEST_PASSAGE, Log.NORMAL):
        table[:, LOG + column] = np.inf
    return table


def _fill_setup(table: Floats, plan: Plan, runs: EnsembleRuns, models: ModelColumns, motions: MotionColumns) -> None:
    options = plan.options
    fill_setup(
        table.T,
        models.body,
        motions.bounds,
        runs.duration,
        plan.rules,
        rtol=options["rtol"],
        atol=options["atol"],
        rest_energy=options["rest_energy"],
        max_steps=options["max_steps"],
        rest_share=plan.rest_share,
        passage_share=plan.passage_share,
    )
    table[:, Setup.BREAKS] = motions.breaks.shape[1]
    table[:, Setup.SAMPLES] = plan.samples
    table[:, Setup.STROBES] = options["strobes"]
    table[:, Setup.TRACES] = plan.traces
    for column, values in event_numbers(options, models.time_scale).items():
        table[:, EVENTS_AT + column] = values


def _fill_starts(
    table: Floats, model: Model, runs: EnsembleRuns, models: ModelColumns, motions: MotionColumns
) -> tuple[npt.NDArray[np.bool_], Floats]:
    """Set states and lines; return which runs begin with planar motion, and the tilts at the start."""
    directions = [(vector[:, 0], vector[:, 1]) for vector in motions.directions.transpose(1, 0, 2)]
    begun = beginning(
        (runs.tilt[:, 0], runs.tilt[:, 1]),
        (runs.tilt_rate[:, 0], runs.tilt_rate[:, 1]),
        runs.spin,
        models.time_scale,
        models.slenderness,
        directions,
        has_plane=model.planar_rates is not None,
    )
    _check_starts(model, runs, begun.stands, begun.in_a_plane)
    line = begun.line
    if model.switches:
        given = [one.velocity[:2] for one in runs.turning or ()] or [(0.0, 0.0)] * len(runs)
        slip_x, slip_y = np.array(given).T
        line = line_of_switching(begun, directions, [*models.slope.T], (slip_x, slip_y), runs.spin)
    table[:, Setup.LINE_X], table[:, Setup.LINE_Y] = line
    table[:, LOG + Log.STANDS] = table[:, LOG + Log.REACHED_VERTICAL] = begun.stands
    moves = ~begun.stands[:, np.newaxis]
    states = models.starts(np.stack(begun.lean, axis=1), runs.tilt_rate * moves, runs.spin)
    if model.contact_kinds is not None:  # a standing column begins as sliding; the reset map decides its contact
        states[begun.stands, -1] = model.contact_kinds["SLIDING"]
        turning = runs.turning or ()
        for changed, chosen in models.models.each() if turning else ():
            for k in np.arange(len(runs))[chosen]:
                states[k] = turning[k].begun(changed, states[k])
    table[:, STATE : STATE + states.shape[1]] = states
    planar = np.asarray(begun.planar)
    if planar.any():
        (x, y), (vx, vy), (ux, uy) = begun.tilt, begun.rate, begun.line
        table[planar, STATE] = (x * ux + y * uy)[planar]
        table[planar, STATE + 1] = (vx * ux + vy * uy)[planar]
    return planar, np.hypot(*begun.lean)


def _check_starts(
    model: Model, runs: EnsembleRuns, stands: npt.NDArray[np.bool_], in_a_plane: npt.NDArray[np.bool_]
) -> None:
    """Raise ParameterError for a spin that the model does not support, or a start out of the plane that it needs."""
    spinning = runs.spin != 0.0
    if spinning.any():
        refuse_spin(model, float(runs.spin[spinning][0]), standing=bool(np.any(spinning & stands)))
    aside = ~in_a_plane
    if model.planar_only and aside.any():
        tilt, rate = runs.tilt[aside][0].tolist(), runs.tilt_rate[aside][0].tolist()
        raise out_of_plane(model, tilt, rate)


# Minimum number of periods in a window, over which the oscillations of complex multipliers average out.
LEAST_WINDOW = 4
# Factor by which the distance from the orbit must fall in a window.
FALL_OF_WINDOW = 0.5


def fill_orbits(
    table: Floats, first: int, orbits: OrbitsOfRuns, period: Floats, time_scale: Floats, rules: OutcomeRules
) -> None:
    """Set the columns of the known orbits, which begin at column `first`; `period` is in the units of the models.

    A run that is too short is not compared with an orbit, because the latest time for its approach is before its start.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        decay = -np.log(orbits.multiplier)
        window = np.fmax(LEAST_WINDOW, np.ceil(math.log(1.0 / FALL_OF_WINDOW) / decay))
        turning = 2.0 * math.pi / period[:, np.newaxis]
        judged = table[:, [Setup.END]] - (rules.periods + 1.0) * period[:, np.newaxis]
        latest = judged - math.log(NEAR / (CERTAIN * rules.repeat_tolerance)) / decay * period[:, np.newaxis]
        columns = {
            Orbit.X: orbits.tilt[..., 0],
            Orbit.Y: orbits.tilt[..., 1],
            Orbit.VX: orbits.tilt_rate[..., 0] * time_scale[:, np.newaxis],
            Orbit.VY: orbits.tilt_rate[..., 1] * time_scale[:, np.newaxis],
            Orbit.SPIN: orbits.spin * time_scale[:, np.newaxis],
            Orbit.SIZE: np.where(np.isnan(decay), np.nan, orbits.mean_tilt),
            Orbit.RATE: orbits.mean_tilt * turning,
            Orbit.WINDOW: window,
            Orbit.FALL: np.exp(-decay * window),
            Orbit.DECAY: decay * turning / (2.0 * math.pi),
            Orbit.LATEST: np.where(np.isfinite(latest) & (period[:, np.newaxis] > 0.0), latest, -np.inf),
            Orbit.REPEATS: np.broadcast_to(rules.repeat_tolerance, decay.shape),
        }
    for k in range(decay.shape[1]):
        for column, values in columns.items():
            table[:, first + k * ORBIT + column] = values[:, k]


@dataclass(frozen=True, slots=True)
class OrbitReached:
    """Runs that have converged to a known orbit, and the numbers of `KnownOrbit` for each of these runs."""

    runs: npt.NDArray[np.intp]
    tilt: Floats
    tilt_rate: Floats
    turns: Floats
    mean_tilt: Floats


def orbit_reached(table: Floats, first: int, orbits: OrbitsOfRuns, runs: npt.NDArray[np.intp]) -> OrbitReached:
    """Return the orbits to which these `runs` have converged."""
    places = first + ORBIT * np.arange(orbits.turns.shape[1]) + Orbit.REACHED
    chosen = np.argmax(table[np.ix_(runs, places)], axis=1)
    of_runs = (getattr(orbits, name)[runs, chosen] for name in OrbitReached.__slots__[1:])
    return OrbitReached(runs, *of_runs)
