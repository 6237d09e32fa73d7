"""Rocking spectra: peak tilt and peak tilt rate over size and slenderness."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.earthquakes.spectra.cases import Cases
from stylobate.earthquakes.spectra.peak_rate import peak_tilt_rate
from stylobate.earthquakes.spectra.provenance import provenance_of_spectrum
from stylobate.errors import ParameterError, require_whole
from stylobate.models import Model
from stylobate.progress import Progress, shows_progress
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import RunOptions
from stylobate.studies.checks import require_no_tilt_limit
from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.labelled import labelled_sweep

_SAMPLES = 2001
# Histories; the result keeps only the peak rate of them.
_HISTORIES = ("sample_time", "sampled_tilt", "sampled_tilt_rate")


@shows_progress("rocking spectrum")
def rocking_spectrum(
    model: Model,
    motion: BaseMotion,
    *,
    over: Mapping[str, npt.ArrayLike] | None = None,
    tail: float | None = None,
    duration: float | None = None,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
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
    store, executor, resume, progress, **options
        As for `overturning_intervals`; the peak rate is taken over `samples` (2001 by default) at equal times of each
        run. Its error is of the second order of the time between two. Peak tilts do not depend on it.

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

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.solid(radius=0.5, height=5.0, density=2000.0), damping=0.05)
    >>> pulse = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)
    >>> found = sb.earthquakes.rocking_spectrum(model, pulse, over={"size": [0.2, 1.0, 5.0]})
    >>> print(found["peak_tilt_ratio"].values.round(3))
    [  nan   nan 0.113]
    """
    require_no_tilt_limit(options)
    cases = Cases.of(model, motion, over, scaled=True)
    if not cases.axes:
        raise ParameterError(f'over must name a parameter with its values, such as {{"size": […]}}; got {over!r}')
    options["samples"] = require_whole("samples", options.get("samples") or _SAMPLES, least=2)
    durations = cases.durations(duration, tail)
    sweep = cases.sweep(np.arange(cases.count), durations, None, **options)
    provenance = provenance_of_spectrum(model, motion, options, tail=tail, duration=duration)
    label = partial(_spectrum, cases=cases, provenance=provenance)
    return labelled_sweep(sweep, label, store=store, executor=executor, resume=resume, progress=progress)


def _spectrum(runs: xr.Dataset, cases: Cases, provenance: str) -> xr.Dataset:
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
