"""All overturning intervals of the amplitude of a base motion: overturning spectra."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.earthquakes.spectra.cases import Cases
from stylobate.earthquakes.spectra.edges import Edges, Ends, Integers, joined
from stylobate.earthquakes.spectra.interval_table import interval_table
from stylobate.earthquakes.spectra.provenance import provenance_of_spectrum
from stylobate.errors import Interrupted, Most, ParameterError, require_positive, require_whole
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import RunOptions
from stylobate.studies.checks import require_no_tilt_limit
from stylobate.studies.sweeps import Executor, run_sweep
from stylobate.studies.sweeps.quantities import Floats, checked_values

# Scales that differ by less than this fraction count as equal.
_SAME_SCALE = 1e-9
# Smallest relative width of an edge; below it the ends differ by rounding only.
_NARROWEST = 1e-9
_FINEST = Most(1_000_000, "since each scale is a run")


@shows_progress("overturning intervals")
def overturning_intervals(
    model: Model,
    motion: BaseMotion,
    *,
    scales: npt.ArrayLike,
    over: Mapping[str, npt.ArrayLike] | None = None,
    width: float = 1e-3,
    fine_scales: int = 0,
    tail: float | None = None,
    duration: float | None = None,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Find all overturning intervals of the amplitude of a base motion, over any parameters.

    Overturning is not monotonic: a column may survive a scale above one that overturns it. So each case is run at all
    `scales`. Every change between neighbours, from overturned to not, or from decided to undecided, is bisected until
    its ends agree to `width`. So is every pair that overturns in opposite directions, because the column may survive
    between them. Over the size, or the frequency of a pulse, the result is the overturning spectrum of the motion.

    Parameters
    ----------
    model, motion
        The column and the base motion, such as a `Pulse`, a `Record` or a `OneOf` several.
    scales
        Factors of the base motion: positive, increasing, two or more.
    over
        Parameters with their values, as for `overturning_map`: size (all lengths times it at one density), slenderness,
        damping, rotation [rad], …; angular_frequency [rad/s], here of a pulse too, whose other numbers stay; `motion`,
        the places of the motions in a `OneOf`. By default one case.
    width
        Relative width, high/low − 1, to which edges are bisected.
    fine_scales
        Number of scales, evenly spaced in their logarithm over the range of `scales`, of a finer scan; only those below
        the smallest overturning scale of a case are run, where the column rocks. Isolated intervals far narrower than a
        step are common there, and a scan misses them by chance.
    tail
        Free-vibration time after the end of the base motion [s]; by default 40/p of each case. A column that has not
        overturned by then counts as surviving. Within about 10⁻⁶ of an edge that may be wrong after 20/p, within 10⁻¹²
        after 40/p.
    duration
        Instead of `tail`, the length of all runs [s]; required for a motion that never ends.
    store, executor, resume, progress
        As in `run_sweep`; the store keeps the runs at the edges too.
    **options
        Options of all runs: tilt, tilt_rate, rtol, rules …

    Returns
    -------
    xarray.Dataset
        Of kind "overturning intervals": the runs over the names and `scale`, with `outcome`, `uncertain` and all that
        ensembles hold; and over the names and `interval`, from the weakest on, NaN beyond the last:

        * `interval_from`, `interval_to`: the smallest and the largest scale of the interval that overturned;
        * `safe_below`, `safe_above`: the nearest scales outside that did not; NaN if the interval is `open_below` or
          `open_above`, reaching the first or last scale, or an undecided run, for which `undecided_below` or
          `undecided_above` is True;
        * `uncertain_below`, `uncertain_above`: a run at that edge is numerically uncertain (rounding or the rest
          threshold could alter it) or undecided.

        A run that failed or lifted off is undecided: it ended before it showed whether the column overturns. No
        interval extends across it. Over the names and `stretch`: `undecided_from` and `undecided_to`, the nearest
        decided scales on both sides, or the ends of the scan. `intervals` counts intervals; `reversals` the changes of
        direction in them without a surviving scale between; `unknown` the undecided runs of the scan; `decided_to` is
        the largest scale up to which every run was decided. Coordinates normalize: `frequency_parameter` p,
        `tipping_angle` α_c, `rim_distance` R, `acceleration_ratio` (peak horizontal base acceleration over g tan α, at
        scale 1) and, of pulses and harmonic motions, `frequency_ratio` ω/p.

    Raises
    ------
    ParameterError
        If an argument is out of range, or `tilt_limit` is given: a run stopped there may or may not overturn.
    UnsupportedError
        If the motion lacks a number that is to vary.
    Interrupted
        On Ctrl-C; `partial` has the intervals found so far.

    Warns
    -----
    UnlikelyInputWarning
        If `over` names a length of the column, such as its radius, and neither its mass nor its inertia: `size` makes a
        larger column.

    See Also
    --------
    reached_intervals : intervals of existing runs, as fine as their scales.

    Notes
    -----
    An interval narrower than the step between two scales may be missed. So may a gap on both sides of which the column
    overturns in nearly one direction.

    Survival above an overturning amplitude is described in Zhang and Makris, "Rocking response of free-standing blocks
    under cycloidal pulses", J. Eng. Mech. 127 (2001), and for records in Yim, Chopra and Penzien, "Rocking response of
    rigid blocks to earthquakes", Earthquake Eng. Struct. Dyn. 8 (1980).

    Without dissipation a three-dimensional motion may overturn later than any `tail`.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> pulse = sb.Pulse.one_sine(acceleration=0.1, angular_frequency=5.0)
    >>> found = sb.earthquakes.overturning_intervals(model, pulse, scales=np.geomspace(1.0, 20.0, 21))
    >>> print(found["interval_from"].values.round(2), found["interval_to"].values.round(2), found["open_above"].values)
    [2.57 7.72] [ 6.9 20. ] [False  True]
    """
    require_no_tilt_limit(options)
    cases = Cases.of(model, motion, over)
    search = _Search(
        cases=cases,
        durations=cases.durations(duration, tail),
        scales=_checked_scales(scales),
        width=_checked_width(width),
        fine_scales=require_whole("fine_scales", fine_scales, least=0, most=_FINEST),
        options=options,
        provenance=provenance_of_spectrum(
            model, motion, options, tail=tail, duration=duration, width=float(width), fine_scales=int(fine_scales)
        ),
        store=None if store is None else Path(store),
        how={"executor": executor, "resume": resume},
        progress=report_of(progress),
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
    options: RunOptions
    provenance: str
    store: Path | None
    how: Mapping[str, Any]
    progress: Report
    done: list[int] = field(default_factory=list)

    def result(self) -> xr.Dataset:
        case = np.repeat(np.arange(self.cases.count), self.scales.size)
        scale = np.tile(self.scales, self.cases.count)
        try:
            runs = self._runs(case, scale, self.store, case.size)
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
        return None if self.store is None else self.store / name

    def _runs(self, case: Integers, scale: Floats, store: Path | None, total: int) -> xr.Dataset:
        before = sum(self.done)

        def progress(done: int, _: int) -> None:
            self.progress(before + done, max(total, before + case.size))

        sweep = self.cases.sweep(case, self.durations, scale, **self.options)
        runs = run_sweep(sweep, store=store, progress=progress, **self.how)
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


def _checked_scales(scales: npt.ArrayLike) -> Floats:
    values = checked_values("scales", "scale", scales)
    if values.size < 2 or not (values[0] > 0.0 and np.all(np.diff(values) > 0.0)):  # noqa: PLR2004  an interval
        raise ParameterError(f"scales must be two or more positive numbers, increasing; got {values.tolist()}")
    return values


def _checked_width(width: float) -> float:
    if require_positive("width", width) < _NARROWEST:
        raise ParameterError(
            f"width must be at least {_NARROWEST:g}, because rounding errors are larger; got {width!r}"
        )
    return float(width)
