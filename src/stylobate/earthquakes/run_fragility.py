"""Fragility from an incremental dynamic analysis: `fit_fragility` with the record and sample of each run."""

from typing import Any

import numpy as np
import xarray as xr

from stylobate.earthquakes.fragility.fit import fit_fragility
from stylobate.earthquakes.fragility.observations import Counting
from stylobate.errors import ParameterError
from stylobate.results.random_numbers import Rng

# For fixed values of these dimensions and a fixed record, the intensity depends on the scale only.
_SERIES = ("rotation", "vertical", "property_sample")


def fragility_of_runs(
    runs: xr.Dataset,
    *,
    counting: Counting = Counting.AS_COMPUTED,
    confidence: float = 0.95,
    resamples: int = 0,
    rng: Rng | None = None,
) -> xr.Dataset:
    """Fit fragility curves to an incremental dynamic analysis, one for each limit state.

    Parameters
    ----------
    runs
        From `incremental_dynamic_analysis`, complete or partial; after an interruption some runs are not known.
    counting
        How runs above the first that reached the limit state count, if the column survives there.
    confidence, resamples, rng
        As for `fit_fragility`. Without `resamples` the intervals treat runs as independent.

    Returns
    -------
    xarray.Dataset
        As from `fit_fragility`, with `record` and `property_sample` set from the runs: rotations, choices of the
        vertical component and property samples are series of their own within a record.

    Raises
    ------
    ParameterError
        If `runs` are of another kind, or an argument is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> from stylobate.earthquakes import incremental_dynamic_analysis
    >>> model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.02)
    >>> pulses = [sb.Pulse.one_sine(acceleration=1.0, angular_frequency=w) for w in (4.0, 5.0, 6.0, 8.0)]
    >>> runs = incremental_dynamic_analysis(model, pulses, scales=np.linspace(1.2, 4.2, 7))
    >>> found = fragility_of_runs(runs)
    >>> fallen = found.sel(limit_state="overturning")
    >>> int(fallen["runs"]), int(fallen["runs_reached"])
    (28, 16)
    """
    if not isinstance(runs, xr.Dataset) or runs.attrs.get("kind") != "incremental dynamic analysis":
        got = runs.attrs.get("kind") if isinstance(runs, xr.Dataset) else repr(runs)
        raise ParameterError(f"runs must be an incremental dynamic analysis, got {got}")
    reached: Any = runs["reached"]
    series = [name for name in _SERIES if name in reached.dims]
    sample = xr.DataArray(0)
    for name in series:
        sample = sample * reached.sizes[name] + xr.DataArray(np.arange(reached.sizes[name]), dims=name)
    plain = reached.drop_vars([name for name in reached.coords if name not in ("record", "limit_state")])
    return fit_fragility(
        runs["intensity"].drop_vars(list(runs["intensity"].coords)),
        plain.drop_vars("record"),
        record=runs["record"].drop_vars("record") if "record" in runs.coords else None,
        property_sample=sample if series else None,
        counting=counting,
        confidence=confidence,
        resamples=resamples,
        rng=rng,
    ).assign_attrs(provenance=runs.attrs["provenance"])
