"""Overturning intervals of the amplitude, and rocking spectra, over size or other numbers: `stylobate spectrum`."""

import math
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Unpack

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.config.study import Instead, Study
from stylobate.errors import ConfigError, ParameterError, require_whole
from stylobate.models import Model
from stylobate.quantities import Quantity
from stylobate.results.outcomes import NOT_COMPUTED, outcome_label
from stylobate.results.tables import ResultTable, model_named
from stylobate.studies.study import RunsOfOwnLength, options_of, study
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.earthquakes.overturning_scales import Cases
    from stylobate.studies.sweeps import Sweep
    from stylobate.studies.sweeps.designs import Floats
    from stylobate.studies.sweeps.running import Label

_INTERVALS, _ROCKING = "overturning intervals", "rocking spectrum"
# Longer tables show only the cases that overturn first, or rock most.
_ROWS, _FIRST = 40, 12
# Bounds of the ends of intervals.
_ACCURACY = ("width", "scale_step", "resolution")
_SAMPLES = 2001
_TAIL = Quantity(unit="s", text="free vibration time after the base motion; 40/p by default")


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    cases = _intervals(result) if result.attrs["kind"] == _INTERVALS else _peaks(result)
    return {"cases": cases, **{name: result.attrs[name] for name in _ACCURACY if name in result.attrs}}


def _table(result: "xr.Dataset") -> ResultTable:
    return _table_of_intervals(result) if result.attrs["kind"] == _INTERVALS else _table_of_peaks(result)


def _cases(result: "xr.Dataset", name: str) -> list[tuple[dict[str, Any], "xr.Dataset"]]:
    """List the names and values that tell cases apart, and the numbers of each case."""
    dims = [str(dim) for dim in result[name].dims]
    flat = result.stack(case=dims) if dims else result.expand_dims("case")
    cases = [flat.isel(case=place) for place in range(flat.sizes["case"])]
    names = [("motion_name" if dim == "motion" else dim, dim) for dim in dims]
    return [({dim: one[name].item() for name, dim in names}, one) for one in cases]


def _intervals(result: "xr.Dataset") -> list[dict[str, Any]]:
    ends = ("interval_from", "interval_to", "safe_below", "safe_above", "uncertain_below", "uncertain_above")
    return [
        {
            **case,
            "frequency_parameter": one["frequency_parameter"].item(),
            "acceleration_ratio": one["acceleration_ratio"].item(),
            "intervals": [{name: one[name][place].item() for name in ends} for place in range(int(one["intervals"]))],
            "unknown": int(one["unknown"]),
        }
        for case, one in _cases(result, "intervals")
    ]


def _peaks(result: "xr.Dataset") -> list[dict[str, Any]]:
    names = ("rocking_period", "peak_tilt_ratio", "peak_rate_ratio")
    rows = []
    for case, one in _cases(result, "peak_tilt_ratio"):
        label = outcome_label(int(one["outcome"]))
        rows.append({**case, **{name: one[name].item() for name in names}, "outcome": label})
    return rows


def _table_of_intervals(result: "xr.Dataset") -> ResultTable:
    rows = sorted(_intervals(result), key=_least) if result["intervals"].size > _ROWS else _intervals(result)
    dims = [str(dim) for dim in result["intervals"].dims]
    table = [
        (
            *(_written(row[dim]) for dim in dims),
            "; ".join(map(_interval, row["intervals"])) or "never",
            _written(_least(row) * row["acceleration_ratio"]) if row["intervals"] else "",
        )
        for row in (rows[:_FIRST] if len(rows) > _ROWS else rows)
    ]
    header = (*dims, "overturns at scales", "minimum peak acceleration / (g tan α)")
    title = [f"{plural(len(rows), 'case')}, {model_named(result)}"]
    title += [f"the {_FIRST} that overturn first"] if len(rows) > _ROWS else []
    unknown = int(result["unknown"].sum())
    title += [f"{unknown} of {plural(result['outcome'].size, 'run')} without an answer"] if unknown else []
    return ResultTable("; ".join([*title, result.attrs["resolution"]]), header, table)


def _least(row: Mapping[str, Any]) -> float:
    return min((float(interval["interval_from"]) for interval in row["intervals"]), default=float("inf"))


def _interval(interval: Mapping[str, Any]) -> str:
    sure = "?" if interval["uncertain_below"] or interval["uncertain_above"] else ""
    low = "" if math.isfinite(interval["safe_below"]) else "below "
    high = f"to {interval['interval_to']:.4g}" if math.isfinite(interval["safe_above"]) else "and beyond"
    return f"{low}{interval['interval_from']:.4g} {high}{sure}"


def _table_of_peaks(result: "xr.Dataset") -> ResultTable:
    rows = _peaks(result)
    if len(rows) > _ROWS:
        rows = sorted(rows, key=lambda row: -row["peak_tilt_ratio"] if row["outcome"] != "overturned" else -1e9)[
            :_FIRST
        ]
    dims = [str(dim) for dim in result["peak_tilt_ratio"].dims]
    names = ("rocking_period", "outcome", "peak_tilt_ratio", "peak_rate_ratio")
    table = [tuple(_written(row[name]) for name in (*dims, *names)) for row in rows]
    shown = f"; the {len(rows)} that rock most" if len(rows) < result["outcome"].size else ""
    header = (*dims, "2π/p [s]", "outcome", "peak tilt / α", "peak rate of tilt / p")
    return ResultTable(f"{plural(result['outcome'].size, 'case')}, {model_named(result)}{shown}", header, table)


def _written(value: Any) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.4g}" if math.isfinite(value) else ""


def _arguments(config: Any, setup: Any) -> Mapping[str, Any]:
    if config.instead and not setup.options["over"]:
        raise ConfigError(["spectrum.x is missing. State a quantity that varies, such as size."])
    return {}


def _repeated(provenance: Mapping[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """Return the values that repeat a spectrum, whose provenance has its numbers beside those of its runs."""
    own = {name: provenance[name] for name in ("width", "fine_scales", "tail") if provenance.get(name) is not None}
    return {**values, "spectrum": {**values["spectrum"], **own}}


@study(
    "overturning intervals",
    Study(
        name="spectrum",
        source="TOML description, or a saved spectrum (.nc) to show or repeat",
        help="""Compute overturning intervals of the amplitude, or rocking spectra.

    A base motion overturns a column at the scales in these intervals; above one of them the column may survive again.
    One or two numbers vary: size, slenderness, damping, angular-frequency of a pulse, rotation … Without --x, the
    result is of one column. With --rocking, the result holds peak tilts and tilt rates over --x. Examples:

    stylobate spectrum --slenderness 0.1 --damping 0.1 --motion one-sine --x angular-frequency 1 9 41
    --scales 0.1 2 40 --figure spectrum.png

    stylobate spectrum --radius 0.5 --height 5 --density 2000 --damping 0.05 --sample-record "el centro 1940"
    --x size 0.2 4 12 --x-spacing log --rocking --output rocking.nc
    """,
        axes=("x?", "y?"),
        scales=True,
        instead=Instead(
            key="rocking",
            text="peak tilts and tilt rates instead",
            place="stylobate.earthquakes:rocking_spectrum",
            kind=_ROCKING,
        ),
        without={
            "periods": "",
            "tilt_limit": "a run stopped at it is not known to overturn or not. Remove it.",
        },
        renamed={"tail": "free_tail"},
        kinds=(_INTERVALS, _ROCKING),
        arguments=_arguments,
        repeated=_repeated,
        table=_table,
        summary=_summary,
    ),
)
def overturning_intervals(
    model: Model,
    motion: BaseMotion,
    *,
    scales: npt.ArrayLike,
    over: Mapping[str, npt.ArrayLike] | None = None,
    width: Annotated[float, Quantity(text="relative width to which the ends of intervals are located")] = 1e-3,
    fine_scales: Annotated[int, Quantity(text="number of scales of a finer scan below the first overturning one")] = 0,
    tail: Annotated[float | None, _TAIL] = None,
    duration: float | None = None,
    **run: Unpack[RunsOfOwnLength],
) -> "xr.Dataset":
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
    **run

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
    from stylobate.earthquakes.overturning_scales import Cases, find_intervals
    from stylobate.studies.checks import require_no_limits

    require_no_limits(options_of(run))
    own: dict[str, Any] = {"width": width, "fine_scales": fine_scales, "tail": tail, "duration": duration}
    return find_intervals(Cases.of(model, motion, over), run, scales=scales, **own)


@study("rocking spectrum")
def rocking_spectrum(
    model: Model,
    motion: BaseMotion,
    *,
    over: Mapping[str, npt.ArrayLike] | None = None,
    tail: Annotated[float | None, _TAIL] = None,
    duration: float | None = None,
    **run: Unpack[RunsOfOwnLength],
) -> "tuple[Sweep, Label]":
    """Compute the peak tilt and the peak rate of tilt of columns of many sizes under one base motion.

    The rocking spectrum of Makris and Konstantinidis, "The rocking spectrum and the limitations of practical design
    methodologies", Earthquake Eng. Struct. Dyn. 32 (2003), defines it for Housner's block, `PlanarRocking`; it
    works for any model here.

    Parameters
    ----------
    model, motion
        The column and the base motion: a `Pulse`, a `Record`, or a `OneOf` several.
    over
        Parameters with their values, one at least, as for `overturning_intervals`, and `scale`: size, which sets
        p ~ 1/√size, and slenderness, motion, angular_frequency …
    tail, duration
        As for `overturning_intervals`.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "rocking spectrum", over the names: `peak_tilt_ratio`, peak tilt over α_c; `peak_rate_ratio`, peak rate
        of the tilt vector over p [rad]; both NaN if the column overturned or the run is undecided, see `outcome`;
        and all variables of ensembles. Coordinates as for `overturning_intervals`, and `rocking_period` 2π/p [s].

    Raises
    ------
    ParameterError, UnsupportedError, Interrupted
        As `overturning_intervals`.

    Notes
    -----
    The peak rate is taken over `samples` (2001 by default) at equal times of each run. Its error is of the second order
    of the time between two. Peak tilts do not depend on it.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.solid(radius=0.5, height=5.0, density=2000.0), damping=0.05)
    >>> pulse = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)
    >>> found = sb.earthquakes.rocking_spectrum(model, pulse, over={"size": [0.2, 1.0, 5.0]})
    >>> print(found["peak_tilt_ratio"].values.round(3))
    [  nan   nan 0.113]
    """
    from stylobate.earthquakes.overturning_scales import Cases, provenance_of_spectrum
    from stylobate.studies.checks import require_no_limits

    require_no_limits(options_of(run))
    cases = Cases.of(model, motion, over, scaled=True)
    if not cases.axes:
        raise ParameterError(f'over must name a parameter with its values, such as {{"size": […]}}; got {over!r}')
    run["samples"] = require_whole("samples", run["samples"] or _SAMPLES, least=2)
    sweep = cases.sweep(np.arange(cases.count), cases.durations(duration, tail), None, **options_of(run))
    provenance = provenance_of_spectrum(cases, run, tail=tail, duration=duration)
    return sweep, partial(_peaks_of_runs, cases=cases, provenance=provenance)


# Histories; the result keeps only the peak rate of them.
_HISTORIES = ("sample_time", "sampled_tilt", "sampled_tilt_rate")


def _peaks_of_runs(runs: "xr.Dataset", cases: "Cases", provenance: str) -> "xr.Dataset":
    """Make the rocking spectrum of the runs of these cases, which have histories."""
    import xarray as xr

    from stylobate.studies.maps.uncertainty_exponent import overturned_or_not

    runs = runs.load()
    dims = tuple(cases.axes)
    safe = overturned_or_not(runs) == 0
    rate = peak_tilt_rate(*(runs[name].to_numpy() for name in _HISTORIES))
    ratios = {
        "peak_tilt_ratio": (runs["peak_tilt"].to_numpy() / cases.numbers["tipping_angle"], "1", "peak tilt / α_c"),
        "peak_rate_ratio": (rate / cases.numbers["frequency_parameter"], "rad", "peak rate of tilt / p"),
    }
    kept = {
        name: xr.Variable((*dims, *value.dims[1:]), cases.over_axes(value.to_numpy()), value.attrs)
        for name, value in runs.drop_vars(_HISTORIES).data_vars.items()
    }
    peaks = {
        name: xr.Variable(
            dims, cases.over_axes(np.where(safe, values, np.nan)), {"units": unit, "long_name": long_name}
        )
        for name, (values, unit, long_name) in ratios.items()
    }
    period = cases.over_axes(2.0 * np.pi / cases.numbers["frequency_parameter"])
    computed = int((runs["outcome"] != NOT_COMPUTED).sum())
    return xr.Dataset(
        {**peaks, **kept, "computed": ((), computed, {"units": "1", "long_name": "runs computed"})},
        coords={
            **cases.coordinates(),
            "rocking_period": xr.Variable(dims, period, {"units": "s", "long_name": "period 2π/p"}),
            "axis": runs["axis"],
        },
        attrs={"kind": "rocking spectrum", "provenance": provenance},
    )


def peak_tilt_rate(time: "Floats", tilt: "Floats", tilt_rate: "Floats") -> "Floats":
    """Compute the peak of |d(tilt)/dt| of each run, to second order in the step between samples.

    The tilt rate of a rocking column peaks just before or after it passes the vertical, and has a corner there. So the
    rate is extrapolated to a passage from the samples on both sides of it.

    Parameters
    ----------
    time
        Times of the samples, shape (..., s) [s].
    tilt, tilt_rate
        Shape (..., s, 2) [rad], [rad/s]; NaN outside the run.

    Returns
    -------
    numpy.ndarray
        Shape (...,) [rad/s]; NaN if a run has no samples.
    """
    before = _largest(time, tilt, tilt_rate)
    after = _largest(-time[..., ::-1], tilt[..., ::-1, :], -tilt_rate[..., ::-1, :])
    return np.fmax(before, after)


def _largest(time: "Floats", tilt: "Floats", tilt_rate: "Floats") -> "Floats":
    """Return the largest rate of the samples and of the extrapolations from samples before a passage to the passage.

    The square of the rate is extrapolated linearly in the tilt, because the potential energy depends on the tilt.
    """
    square, angle = (tilt_rate**2).sum(axis=-1), np.linalg.norm(tilt, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        until = -(tilt * tilt_rate).sum(axis=-1) / square
        across = tilt[..., 0] * tilt_rate[..., 1] - tilt[..., 1] * tilt_rate[..., 0]
        nearest = np.abs(across) / np.sqrt(square)  # smallest tilt on the tangent of the path
        passed = (until[..., 1:-1] > 0.0) & (until[..., 1:-1] < np.diff(time)[..., 1:])
        passed &= np.diff(angle)[..., :-1] < 0.0
        slope = np.diff(square)[..., :-1] / np.diff(angle)[..., :-1]
        continued = square[..., 1:-1] + slope * (nearest - angle)[..., 1:-1]
    continued = np.where(passed, np.fmax(continued, 0.0), np.nan)
    return np.asarray(np.sqrt(np.fmax.reduce(np.concatenate([square, continued], axis=-1), axis=-1)))
