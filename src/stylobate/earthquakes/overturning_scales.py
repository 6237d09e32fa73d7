"""The cases of a spectrum; and the overturning intervals of each: a scan, bisection of its edges, and their table.

`stylobate.earthquakes.spectrum_study` declares the study.
"""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated, Any, Self, Unpack, get_args, get_type_hints

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.combined import members_of
from stylobate.base_motions.declared import frequency_of
from stylobate.engine.parameters import own_numbers, with_parameters
from stylobate.errors import Interrupted, Most, ParameterError, require_positive, require_whole
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of
from stylobate.progress import report_of
from stylobate.provenance import provenance_of_run
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import RunOptions
from stylobate.studies.checks import remark_on_lengths, require_values
from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.study import RunsOfOwnLength, options_of
from stylobate.studies.sweeps import Sweep, run_sweep
from stylobate.studies.sweeps.designs import OF_A_RUN, Floats, check_quantities, checked_values

Integers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


_TAIL = 40.0
"""Free-vibration time after the end of the base motion, over 1/p.

Near the edge of an overturning interval a column stays near its unstable equilibrium, and leaves it as e^(pt). After
20/p it is still near within about 10⁻⁶ of the edge; after 40/p, within 10⁻¹².
"""

_MOTION = "motion"
# Quantities that normalize a spectrum, for each case.
_NUMBERS: Mapping[str, Mapping[str, str]] = {
    "frequency_parameter": {"units": "rad s-1", "long_name": "frequency parameter p"},
    "tipping_angle": {"units": "rad", "long_name": "tipping angle α_c"},
    "rim_distance": {"units": "m", "long_name": "distance R of the centre of mass from the rim"},
    "acceleration_ratio": {"units": "1", "long_name": "peak base acceleration / (c g), at scale 1"},
    "frequency_ratio": {"units": "1", "long_name": "angular frequency of the base motion / p"},
    "motion_end": {"units": "s", "long_name": "end of the base motion"},
}


@dataclass(frozen=True, slots=True, eq=False)
class Cases:
    """Model, base motion and parameter values of the runs of a spectrum.

    `axes` has the requested parameters with their values; `values` has the parameters that ensembles vary and `numbers`
    the normalizing quantities, both flat over the cases.
    """

    model: Model
    motion: BaseMotion
    axes: Mapping[str, Floats]
    values: Mapping[str, Floats]
    numbers: Mapping[str, Floats]

    @classmethod
    def of(
        cls, model: Model, motion: BaseMotion, over: Mapping[str, npt.ArrayLike] | None, *, scaled: bool = False
    ) -> Self:
        """Create the cases `over` these values.

        Parameters
        ----------
        scaled
            Whether `over` may name the scale.

        Raises
        ------
        ParameterError
            If a name cannot vary here, or has no values.
        UnsupportedError
            If the motion lacks a number that is to vary.
        """
        if not isinstance(model, Model):
            raise ParameterError(f"model must be a model such as Slender(column), got {model!r}")
        if not isinstance(motion, BaseMotion):
            raise ParameterError(f"motion must be a base motion such as Pulse.one_sine(...), got {motion!r}")
        over = _checked_names(model, motion, {} if over is None else over, scaled=scaled)
        own = own_numbers(model, motion)
        axes = {name: checked_values("over", name, values, own) for name, values in over.items()}
        meshes = np.meshgrid(*axes.values(), indexing="ij") if axes else []
        values = {name: mesh.ravel() for name, mesh in zip(axes, meshes, strict=True)}
        return cls(model, motion, axes, values, _numbers(model, motion, values))

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes."""
        return tuple(axis.size for axis in self.axes.values())

    @property
    def count(self) -> int:
        """Number of cases."""
        return math.prod(self.shape)

    def durations(self, duration: float | None, tail: float | None) -> Floats:
        """Return the duration of each case [s]: to `tail` [s] after the end of its motion, or the given `duration`.

        Raises
        ------
        ParameterError
            If an argument is not positive, or the motion never ends and there is no `duration`.
        """
        if duration is not None:
            return np.full(self.count, require_positive("duration", duration, "s"))
        usual = _TAIL / self.numbers["frequency_parameter"]
        ends = self.numbers["motion_end"] + (usual if tail is None else require_positive("tail", tail, "s"))
        if not np.all(np.isfinite(ends)):
            raise ParameterError(
                f"duration must be given, in s, for a base motion that never ends; got None with {self.motion!r}"
            )
        return ends

    def sweep(self, case: Integers, durations: Floats, scale: Floats | None, **options: Unpack[RunOptions]) -> Sweep:
        """Build the sweep of these cases, each with its duration and, if given, its `scale`."""
        at = {name: values[case] for name, values in self.values.items()}
        scaled = {} if scale is None else {"scale": scale}
        return Sweep.points(self.model, self.motion, at={**at, **scaled, "duration": durations[case]}, **options)

    def over_axes(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Reshape the first dimension of `values` from cases to the axes."""
        return values.reshape(self.shape + values.shape[1:])

    def coordinates(self) -> dict[str, xr.Variable]:
        """Return the axes, the normalizing quantities over them, and the names of motions."""
        dims = tuple(self.axes)
        found = {name: xr.Variable((name,), axis, attributes_of(name)) for name, axis in self.axes.items()}
        for name, attributes in _NUMBERS.items():
            if np.all(np.isfinite(self.numbers[name])):
                found[name] = xr.Variable(dims, self.over_axes(self.numbers[name]), dict(attributes))
        if _MOTION in self.axes:
            found["motion_name"] = xr.Variable((_MOTION,), _names(self.motion, self.axes[_MOTION]))
        return found


def _checked_names(
    model: Model, motion: BaseMotion, over: Mapping[str, npt.ArrayLike], *, scaled: bool
) -> Mapping[str, npt.ArrayLike]:
    if not isinstance(over, Mapping):
        raise ParameterError(f'over must name parameters with their values, such as {{"size": […]}}; got {over!r}')
    refused = {"duration": "give duration or tail", **({} if scaled else {"scale": "give scales"})}
    for name, remedy in refused.items():
        if name in over:
            raise ParameterError(f"over cannot name {name}: {remedy}")
    if over:
        check_quantities("over", model, over, motion)
    require_values("over", over)
    remark_on_lengths("over", over)
    return over


def _numbers(model: Model, motion: BaseMotion, values: Mapping[str, Floats]) -> dict[str, Floats]:
    rows = []
    count = next(iter(values.values())).size if values else 1
    for case in range(count):
        chosen = {name: float(array[case]) for name, array in values.items() if name not in OF_A_RUN}
        changed, moved = with_parameters(model, motion, **chosen)
        column = changed.column
        rows.append(
            (
                column.frequency_parameter,
                column.tipping_angle,
                column.rim_distance,
                moved.peak_horizontal(0.0) / (column.gravity * column.slenderness),
                frequency_of(moved) / column.frequency_parameter,
                moved.duration,
            )
        )
    return dict(zip(_NUMBERS, np.array(rows).T, strict=True))


def _names(motion: BaseMotion, numbers: Floats) -> list[str]:
    members = members_of(motion)
    return [str(getattr(members[int(number)], "name", "") or f"motion {int(number)}") for number in numbers]


def provenance_of_spectrum(
    cases: Cases, run: RunsOfOwnLength, *, tail: float | None, duration: float | None, **own: float
) -> str:
    """Return model, motion, options and length of the runs, in JSON."""
    chosen: dict[str, Any] = dict(options_of(run))
    chosen["rules"] = asdict(chosen["rules"] or OutcomeRules())
    length = {"tail": tail if tail is None else float(tail)} if duration is None else {"duration": float(duration)}
    return json.dumps({**provenance_of_run(cases.model, cases.motion, **chosen), **length, **own})


@dataclass(frozen=True, slots=True, eq=False)
class Ends:
    """Outcomes of runs at these values of `scale`, as arrays of equal shape.

    `state` is 1 if the column overturned, towards the azimuth `direction` [rad]; 0 if it did not; negative if the run
    is undecided.
    """

    scale: Floats
    state: Integers
    direction: Floats
    uncertain: Flags

    @classmethod
    def of(cls, runs: xr.Dataset, scale: Floats) -> Self:
        """Collect the outcomes of `runs` at these scales, in the same order."""
        direction, uncertain = (runs[name].to_numpy().reshape(scale.shape) for name in ("direction", "uncertain"))
        return cls(scale, overturned_or_not(runs).reshape(scale.shape), direction, uncertain.astype(bool))

    def __getitem__(self, chosen: Any) -> "Ends":
        return Ends(*(array[chosen] for array in (self.scale, self.state, self.direction, self.uncertain)))

    def reshaped(self, shape: tuple[int, ...]) -> "Ends":
        """Return the same outcomes as arrays of another shape."""
        scale, state, direction, uncertain = self.scale, self.state, self.direction, self.uncertain
        return Ends(scale.reshape(shape), state.reshape(shape), direction.reshape(shape), uncertain.reshape(shape))

    @property
    def decided(self) -> Flags:
        """Whether each run is decided."""
        return self.state >= 0

    def differ(self, other: "Ends") -> Flags:
        """Flag pairs with different states (undecided is one state) or overturning more than a right angle apart."""
        apart = np.cos(self.direction - other.direction) < 0.0
        unlike = np.maximum(self.state, -1) != np.maximum(other.state, -1)
        return np.asarray(unlike | ((self.state == 1) & apart))


def joined(*parts: Ends) -> Ends:
    """Concatenate outcomes."""
    names = ("scale", "state", "direction", "uncertain")
    return Ends(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Changes of the outcome along the scale between the runs `low` and `high`, in order of case and scale.

    At an edge overturning begins or ends, or decided runs end or begin, or the direction of overturning reverses; a
    reversal may hide a safe gap.
    """

    case: Integers
    low: Ends
    high: Ends

    @classmethod
    def between(cls, case: Integers, runs: Ends) -> Self:
        """Find the edges between successive runs of each case; flat arrays, in order of case and scale."""
        place = np.flatnonzero((case[:-1] == case[1:]) & runs[:-1].differ(runs[1:]))
        return cls(case[place], runs[place], runs[place + 1])

    @property
    def middle(self) -> Floats:
        """Geometric means of the ends."""
        return np.asarray(np.sqrt(self.low.scale * self.high.scale))

    @property
    def turns(self) -> Flags:
        """Whether the column overturns on both sides of an edge."""
        return np.asarray((self.low.state == 1) & (self.high.state == 1))

    def wide(self, width: float) -> Flags:
        """Flag the edges that are wider than this fraction of their scale."""
        return np.asarray(self.high.scale > self.low.scale * (1.0 + width))

    def halvings(self, width: float) -> int:
        """Return the number of runs that bisect all edges to this width, if no further edges are found."""
        wide = self.wide(width)
        ratio = np.log(self.high.scale[wide] / self.low.scale[wide]) / np.log1p(width)
        return int(np.ceil(np.log2(ratio)).sum())

    def halved(self, chosen: Flags, middle: Ends) -> "Edges":
        """Cut the `chosen` edges at the runs `middle`; keep the halves whose ends differ."""
        case, low, high = self.case[chosen], self.low[chosen], self.high[chosen]
        below, above = low.differ(middle), middle.differ(high)
        cases = np.concatenate([self.case[~chosen], case[below], case[above]])
        lower = joined(self.low[~chosen], low[below], middle[above])
        upper = joined(self.high[~chosen], middle[below], high[above])
        order = np.lexsort((lower.scale, cases))
        return Edges(cases[order], lower[order], upper[order])


# Each annotation has the type of a field and its long name, an attribute of the result.
@dataclass(frozen=True, slots=True)
class _Interval:
    interval_from: Annotated[float, "smallest scale of the interval that overturned"]
    interval_to: Annotated[float, "largest scale of the interval that overturned"]
    safe_below: Annotated[float, "largest scale below the interval that did not overturn"] = np.nan
    safe_above: Annotated[float, "smallest scale above the interval that did not overturn"] = np.nan
    open_below: Annotated[bool, "the interval may begin lower: it reaches the first scale or an undecided run"] = False
    open_above: Annotated[bool, "the interval may end higher: it reaches the last scale or an undecided run"] = False
    undecided_below: Annotated[bool, "the next run below the interval is undecided"] = False
    undecided_above: Annotated[bool, "the next run above the interval is undecided"] = False
    uncertain_below: Annotated[bool, "a run at the lower edge is numerically uncertain or undecided"] = False
    uncertain_above: Annotated[bool, "a run at the upper edge is numerically uncertain or undecided"] = False


@dataclass(frozen=True, slots=True)
class _Stretch:
    undecided_from: Annotated[float, "largest decided scale below undecided runs, or the first scale"]
    undecided_to: Annotated[float, "smallest decided scale above undecided runs, or the last scale"]


def interval_table(cases: Cases, scan: Ends, edges: Edges) -> xr.Dataset:
    """Tabulate the overturning intervals and undecided stretches of each case.

    Returns
    -------
    xarray.Dataset
        Over the axes and `interval`, NaN beyond the last: the intervals. Over the axes and `stretch`: `undecided_from`
        and `undecided_to`. Over the axes: the numbers of intervals, `reversals` and undecided runs, and `decided_to`.
    """
    own = [np.flatnonzero((edges.case == case) & ~edges.turns) for case in range(cases.count)]
    intervals = [_intervals_of(scan[case], edges, chosen) for case, chosen in enumerate(own)]
    stretches = [_stretches_of(scan[case], edges, chosen) for case, chosen in enumerate(own)]
    dims = tuple(cases.axes)
    counts = {
        "intervals": ([len(row) for row in intervals], "overturning intervals"),
        "reversals": (
            np.bincount(edges.case[edges.turns], minlength=cases.count),
            "changes of direction within the intervals, without a safe gap as wide as an edge",
        ),
        "unknown": (np.count_nonzero(~scan.decided, axis=1), "undecided runs of the scan"),
    }
    table: dict[str, xr.Variable] = {}
    for dim, kind, rows in (("interval", _Interval, intervals), ("stretch", _Stretch, stretches)):
        for name, declared in get_type_hints(kind, include_extras=True).items():
            of, long_name = get_args(declared)
            attributes = {"long_name": long_name} if of is bool else {"units": "1", "long_name": long_name}
            table[name] = xr.Variable((*dims, dim), cases.over_axes(_column(rows, name, of)), attributes)
    for name, (count, long_name) in counts.items():
        attributes = {"units": "1", "long_name": long_name}
        table[name] = xr.Variable(dims, cases.over_axes(np.array(count, dtype=np.int64)), attributes)
    first = [row[0].undecided_from if row else float(scan.scale[case, -1]) for case, row in enumerate(stretches)]
    decided = np.where(scan.decided[:, 0], first, np.nan)
    about = {"units": "1", "long_name": "largest scale up to which every run was decided"}
    table["decided_to"] = xr.Variable(dims, cases.over_axes(decided), about)
    return xr.Dataset(table)


def _column(rows: Sequence[Sequence[_Interval]] | Sequence[Sequence[_Stretch]], name: str, of: type) -> Any:
    values: npt.NDArray[Any] = np.full(
        (len(rows), max(1, *(len(row) for row in rows))), False if of is bool else np.nan, dtype=of
    )
    for case, row in enumerate(rows):
        values[case, : len(row)] = [getattr(one, name) for one in row]
    return values


def _intervals_of(scan: Ends, edges: Edges, own: Integers) -> list[_Interval]:
    """Return the overturning intervals of one case from its `own` edges; an interval ends at an undecided run."""
    intervals: list[_Interval] = []
    begun: dict[str, Any] = {}
    if scan.state[0] == 1:
        begun = {"interval_from": float(scan.scale[0]), "open_below": True}
    for edge in own:
        low, high = edges.low[edge], edges.high[edge]
        unsure = bool(low.uncertain | high.uncertain)
        if low.state == 1:
            outside = _outside("above", high, unsure=unsure)
            intervals.append(_Interval(**begun, interval_to=float(low.scale), **outside))
        if high.state == 1:
            begun = {"interval_from": float(high.scale), **_outside("below", low, unsure=unsure)}
    if scan.state[-1] == 1:
        intervals.append(_Interval(**begun, interval_to=float(scan.scale[-1]), open_above=True))
    return intervals


def _outside(side: str, run: Ends, *, unsure: bool) -> dict[str, Any]:
    """Return the fields for the run on one side of an interval: it survived, or it is undecided."""
    if run.decided:
        return {f"safe_{side}": float(run.scale), f"uncertain_{side}": unsure}
    return {f"open_{side}": True, f"undecided_{side}": True, f"uncertain_{side}": True}


def _stretches_of(scan: Ends, edges: Edges, own: Integers) -> list[_Stretch]:
    """Return the undecided stretches of one case, each between decided runs or ends of the scan."""
    begins = [edge for edge in own if edges.high.state[edge] < 0]
    ends = [edge for edge in own if edges.low.state[edge] < 0]
    first = [] if scan.decided[0] else [float(scan.scale[0])]
    last = [] if scan.decided[-1] else [float(scan.scale[-1])]
    starts = first + [float(edges.low.scale[edge]) for edge in begins]
    stops = [float(edges.high.scale[edge]) for edge in ends] + last
    return [_Stretch(*pair) for pair in zip(starts, stops, strict=True)]


# Scales that differ by less than this fraction count as equal.
_SAME_SCALE = 1e-9
# Smallest relative width of an edge; below it the ends differ by rounding only.
_NARROWEST = 1e-9
_FINEST = Most(1_000_000, "since each scale is a run")


def find_intervals(
    cases: Cases,
    run: RunsOfOwnLength,
    *,
    scales: npt.ArrayLike,
    width: float,
    fine_scales: int,
    tail: float | None,
    duration: float | None,
) -> xr.Dataset:
    """Find the intervals of these cases; the arguments are those of `overturning_intervals`.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    Interrupted
        On Ctrl-C; `partial` has the intervals found so far.
    """
    durations = cases.durations(duration, tail)
    factors = checked_values("scales", "scale", scales)
    if factors.size < 2 or not (factors[0] > 0.0 and np.all(np.diff(factors) > 0.0)):  # noqa: PLR2004  an interval
        raise ParameterError(f"scales must be two or more positive numbers, increasing; got {factors.tolist()}")
    if require_positive("width", width) < _NARROWEST:
        raise ParameterError(
            f"width must be at least {_NARROWEST:g}, because rounding errors are larger; got {width!r}"
        )
    fine_scales = require_whole("fine_scales", fine_scales, least=0, most=_FINEST)
    own = {"width": float(width), "fine_scales": fine_scales}
    search = _Search(
        cases=cases,
        durations=durations,
        scales=factors,
        run=run,
        width=float(width),
        fine_scales=fine_scales,
        provenance=provenance_of_spectrum(cases, run, tail=tail, duration=duration, **own),
    )
    return search.result()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Search:
    """A scan, and rounds of bisection of its edges; each round is a sweep, stored inside the store of the scan."""

    cases: Cases
    durations: Floats
    scales: Floats
    width: float
    fine_scales: int
    run: RunsOfOwnLength
    provenance: str
    done: list[int] = field(default_factory=list)

    def result(self) -> xr.Dataset:
        case = np.repeat(np.arange(self.cases.count), self.scales.size)
        scale = np.tile(self.scales, self.cases.count)
        try:
            runs = self._runs(case, scale, self.run["store"], case.size)
        except Interrupted as stop:
            scan = Ends.of(stop.partial, scale)
            edges = Edges.between(case, scan)
            raise Interrupted(str(stop), self._as_dataset(stop.partial, scan, edges)) from None
        scan = Ends.of(runs, scale)
        edges, number = Edges.between(case, scan), 0
        try:
            case, found = self._refined(case, scan, runs)
            edges = Edges.between(case, found)
            total = case.size + edges.halvings(self.width)
            while (wide := edges.wide(self.width)).any():
                number += 1
                middle = edges.middle[wide]
                cut = self._runs(edges.case[wide], middle, self._folder(f"edges {self.width:g} {number}"), total)
                edges = edges.halved(wide, Ends.of(cut, middle))
        except Interrupted as stop:
            raise Interrupted(str(stop), self._as_dataset(runs, scan, edges)) from None
        return self._as_dataset(runs, scan, edges)

    def _refined(self, case: Integers, scan: Ends, runs: xr.Dataset) -> tuple[Integers, Ends]:
        """Add the runs of the finer scan below the smallest overturning scale of each case, if the column rocks there.

        A column rocks at a scale between two of the scan if it rocks at the upper one.
        """
        fine = np.geomspace(self.scales[0], self.scales[-1], self.fine_scales) if self.fine_scales else np.empty(0)
        above = np.searchsorted(self.scales, fine * (1.0 - _SAME_SCALE))  # a fine scale may be one of the scan
        own = np.abs(self.scales[np.minimum(above, self.scales.size - 1)] / fine - 1.0) > _SAME_SCALE
        fine, above = fine[own], above[own]
        shape = (self.cases.count, self.scales.size)
        first = np.where(scan.state == 1, scan.scale, np.inf).reshape(shape).min(axis=1)
        rocks = runs["peak_tilt"].to_numpy().reshape(shape)[:, above] > 0.0
        chosen, place = np.nonzero(rocks & (fine < first[:, np.newaxis]))
        if chosen.size == 0:
            return case, scan
        more, total = fine[place], case.size + chosen.size
        added = Ends.of(self._runs(chosen, more, self._folder(f"fine {self.fine_scales}"), total), more)
        found, cases = joined(scan, added), np.concatenate([case, chosen])
        order = np.lexsort((found.scale, cases))
        return cases[order], found[order]

    def _folder(self, name: str) -> Path | None:
        return None if self.run["store"] is None else Path(self.run["store"]) / name

    def _runs(self, case: Integers, scale: Floats, store: str | Path | None, total: int) -> xr.Dataset:
        before, report = sum(self.done), report_of(self.run["progress"])

        def progress(done: int, _: int) -> None:
            report(before + done, max(total, before + case.size))

        sweep = self.cases.sweep(case, self.durations, scale, **options_of(self.run))
        executor, resume = self.run["executor"], self.run["resume"]
        runs = run_sweep(sweep, store=store, executor=executor, resume=resume, progress=progress)
        self.done.append(case.size)
        return runs.load()

    def _as_dataset(self, runs: xr.Dataset, scan: Ends, edges: Edges) -> xr.Dataset:
        dims, shape = (*self.cases.axes, "scale"), (*self.cases.shape, self.scales.size)
        kept = {
            name: xr.Variable((*dims, *value.dims[1:]), value.to_numpy().reshape(*shape, *value.shape[1:]), value.attrs)
            for name, value in runs.data_vars.items()
        }
        computed = int((runs["outcome"] != NOT_COMPUTED).sum())
        step = float((self.scales[1:] / self.scales[:-1]).max())
        return (
            interval_table(self.cases, scan.reshaped((self.cases.count, self.scales.size)), edges)
            .assign({**kept, "computed": ((), computed, {"units": "1", "long_name": "runs of the scan computed"})})
            .assign_coords(
                {
                    **self.cases.coordinates(),
                    "scale": ("scale", self.scales, attributes_of("scale")),
                    "axis": runs["axis"],
                }
            )
            .assign_attrs(
                kind="overturning intervals",
                provenance=self.provenance,
                width=self.width,
                scale_step=step - 1.0,
                resolution=_resolution(step, self.scales[-1] / self.scales[0], self.fine_scales),
                runs=sum(self.done) or computed,
            )
        )


def _resolution(step: float, span: float, fine_scales: int) -> str:
    """State which intervals a scan with steps of this factor may have missed."""
    fine = span ** (1.0 / (fine_scales - 1)) if fine_scales > 1 else step
    finer = f", or {fine:.4g} below the smallest overturning scale," if fine < step else ","
    return f"intervals and gaps narrower than the step of the scan, a factor {step:.4g}{finer} may be missed"
